//! Figures of colour: `colorimetry/cct/…`, `colorimetry/cri/…`, `colorimetry/tm30/…`.

mod samples;

fn main() {
    divan::main();
}

mod colorimetry {
    use photopic::colorimetry::chromaticity;
    use photopic::colorimetry::observer::{self, Observer};
    use photopic::constants::SecondRadiation;
    use photopic::spectrum::Sampling;
    use photopic::spectrum::integrate::Contract;

    use crate::samples::{SAMPLES, grid};

    const C2: SecondRadiation = SecondRadiation::Its90;

    fn observer_plan() -> observer::Plan {
        let plan = observer::Plan::new(Observer::Cie1931, &grid(), Sampling::Density, &Contract::default());
        plan.expect("a rule for equal steps")
    }

    fn uv(plan: &observer::Plan, row: &[f64]) -> [f64; 2] {
        chromaticity::uv_1960(plan.xyz(row)).expect("light")
    }

    fn kelvin(plan: &observer::Plan, row: &[f64]) -> f64 {
        photopic::colorimetry::cct::nearest(uv(plan, row), C2).expect("near the locus").kelvin
    }

    mod cct {
        use divan::counter::ItemsCount;
        use divan::{Bencher, black_box};
        use photopic::colorimetry::cct::{Method, correlated};

        use super::{C2, SAMPLES, observer_plan, uv};
        use crate::samples::{MEAN_CCT, assert_mean, rows};

        const COUNT: usize = 10_000;

        fn bench(bencher: Bencher, method: Method, tolerance: f64) {
            let plan = observer_plan();
            let all: Vec<[f64; 2]> = rows(COUNT).chunks_exact(SAMPLES).map(|row| uv(&plan, row)).collect();
            let mut out = vec![0.0; COUNT];
            let solve = |uv: &[f64; 2]| correlated(*uv, method, C2).expect("near the locus").kelvin;
            out[0] = solve(&all[0]);
            bencher.counter(ItemsCount::new(COUNT)).bench_local(|| {
                for (uv, out) in black_box(&all).iter().zip(black_box(&mut out)) {
                    *out = solve(uv);
                }
                assert_mean(&out, MEAN_CCT, tolerance);
            });
        }

        /// By minimisation of the distance.
        #[divan::bench]
        fn exact(bencher: Bencher) {
            bench(bencher, Method::Exact, 1e-4);
        }

        /// By Ohno's table.
        #[divan::bench]
        fn ohno2013(bencher: Bencher) {
            bench(bencher, Method::Ohno2013, 1.0);
        }
    }

    mod cri {
        use divan::counter::ItemsCount;
        use divan::{Bencher, black_box};
        use photopic::colorimetry::cri::Plan;
        use photopic::spectrum::Sampling;
        use photopic::spectrum::integrate::Contract;

        use super::{C2, SAMPLES, kelvin, observer_plan};
        use crate::samples::{MEAN_RA, assert_mean, grid, rows};

        const COUNT: usize = 1000;

        /// XYZ, CCT and R1–R14 of each spectrum.
        #[divan::bench]
        fn plan(bencher: Bencher) {
            let values = rows(COUNT);
            let observer = observer_plan();
            let plan = Plan::new(&grid(), Sampling::Density, &Contract::default(), C2).expect("compiles");
            let mut out = vec![0.0; COUNT];
            kelvin(&observer, &values[..SAMPLES]);
            bencher.counter(ItemsCount::new(COUNT)).bench_local(|| {
                for (row, out) in black_box(&values).chunks_exact(SAMPLES).zip(&mut out) {
                    *out = plan.evaluate(row, kelvin(&observer, row)).expect("light").ra;
                }
                assert_mean(&out, MEAN_RA, 0.2);
            });
        }
    }

    mod tm30 {
        use divan::counter::ItemsCount;
        use divan::{Bencher, black_box};
        use photopic::colorimetry::tm30::Plan;
        use photopic::spectrum::Sampling;
        use photopic::spectrum::integrate::Contract;

        use super::{C2, SAMPLES, kelvin, observer_plan};
        use crate::samples::{MEAN_RF, assert_mean, grid, rows};

        const COUNT: usize = 100;

        /// XYZ, CCT, Rf, Rg and the bins of each spectrum.
        #[divan::bench]
        fn plan(bencher: Bencher) {
            let values = rows(COUNT);
            let observer = observer_plan();
            let plan = Plan::new(&grid(), Sampling::Density, &Contract::default(), C2).expect("compiles");
            let mut out = vec![0.0; COUNT];
            kelvin(&observer, &values[..SAMPLES]);
            bencher.counter(ItemsCount::new(COUNT)).bench_local(|| {
                for (row, out) in black_box(&values).chunks_exact(SAMPLES).zip(&mut out) {
                    *out = plan.evaluate(row, kelvin(&observer, row)).expect("a white light").rf;
                }
                assert_mean(&out, MEAN_RF, 0.02);
            });
        }
    }
}
