//! `uncertainty/evaluate/all`: 10 000 trials with all figures, CRI and TM-30 included, of 401 samples by 1 nm.

fn main() {
    divan::main();
}

mod uncertainty {
    mod evaluate {
        use divan::{Bencher, black_box};
        use photopic::conversion::{Converter, Settings};
        use photopic::spectrum::{Grid, Quantity, Spectrum};
        use photopic::uncertainty::budget::Budget;
        use photopic::uncertainty::{Measurand, evaluate};

        const BUDGET: &str = "\
noise = [{ relative = 0.003, of_peak = 0.001 }]
calibration = [{ relative = 0.01, correlation_length_nm = 50 }]
wavelength = { offset_nm = 0.2 }
scale = [{ relative = 0.01 }]
monte_carlo = { trials = 10000 }
";

        #[divan::bench(sample_count = 5)]
        fn all(bencher: Bencher) {
            let grid = Grid::uniform(380.0, 1.0, 401).expect("ascending");
            let part = |w: f64, at: f64, width: f64| (-((w - at) / width).powi(2)).exp();
            let values = grid
                .wavelengths_nm()
                .iter()
                .map(|w| 1e-3 * (part(*w, 450.0, 12.0) + 0.7 * part(*w, 570.0, 75.0)))
                .collect();
            let spectrum = Spectrum::density(grid, values).expect("finite");
            let budget = Budget::parse(BUDGET, |_| unreachable!("no table is named")).expect("a budget");
            let converter = Converter::new(Settings::default());
            bencher.bench_local(|| {
                let found =
                    evaluate(&converter, &budget, Quantity::Irradiance, black_box(&spectrum)).expect("evaluates");
                // The factor alone makes 1 % of the lux; nothing can lower it.
                let lux = found.value.figure(Measurand::Photopic).expect("an irradiance has one");
                assert!(lux.stated.is_some_and(|s| s.standard > 0.01 * lux.value));
            });
        }
    }
}
