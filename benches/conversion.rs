//! The whole conversion: `conversion/convert/…` per spectrum on a grid already met, `conversion/compile/…` for a new grid.

mod samples;

fn main() {
    divan::main();
}

mod conversion {
    use std::sync::Arc;

    use photopic::conversion::{Converter, Groups, Settings};
    use photopic::spectrum::{Grid, Quantity, Spectrum};

    use crate::samples::{SAMPLES, rows};

    fn converter(groups: Groups) -> Converter {
        Converter::new(Settings { groups, ..Settings::default() })
    }

    fn spectra(grid: &Arc<Grid>, count: usize) -> Vec<Spectrum> {
        let spectrum = |row: &[f64]| Spectrum::density(Arc::clone(grid), row.to_vec()).expect("finite");
        rows(count).chunks_exact(SAMPLES).map(spectrum).collect()
    }

    /// Converts and returns the luminance, K_m ∫ S V dλ.
    fn luminance(converter: &Converter, spectrum: &Spectrum) -> f64 {
        let done = converter.convert("", Quantity::Radiance, spectrum).expect("converts");
        done.value.absolute[0].photopic
    }

    mod convert {
        use divan::counter::ItemsCount;
        use divan::{Bencher, black_box};
        use photopic::constants::K_M;
        use photopic::conversion::Groups;

        use super::{converter, luminance, spectra};
        use crate::samples::{MEAN_XYZ, assert_mean, grid};

        const COUNT: usize = 1000;

        fn bench(bencher: Bencher, groups: Groups) {
            let spectra = spectra(&grid(), COUNT);
            let converter = converter(groups);
            let mut out = vec![0.0; COUNT];
            luminance(&converter, &spectra[0]);
            bencher.counter(ItemsCount::new(COUNT)).bench_local(|| {
                for (spectrum, out) in black_box(&spectra).iter().zip(&mut out) {
                    *out = luminance(&converter, spectrum);
                }
                // The mean of the first 1000 is that of the 100 000 to 0.1 %.
                assert_mean(&out, K_M * MEAN_XYZ[1], 1e-3 * K_M * MEAN_XYZ[1]);
            });
        }

        /// Every group of figures.
        #[divan::bench]
        fn all(bencher: Bencher) {
            bench(bencher, Groups::ALL);
        }

        /// Luminous figures, XYZ, chromaticity and CCT.
        #[divan::bench]
        fn colour(bencher: Bencher) {
            bench(bencher, Groups { colour: true, ..Groups::NONE });
        }
    }

    mod compile {
        use divan::{Bencher, black_box};
        use photopic::conversion::Groups;
        use photopic::conversion::{Converter, Settings};
        use photopic::spectrum::integrate::{Contract, Rule};
        use photopic::spectrum::{Grid, Spectrum};

        use super::{converter, luminance, spectra};
        use crate::samples::{grid, rows};

        /// All plans for 81 samples by 5 nm, and one conversion.
        #[divan::bench]
        fn all_81(bencher: Bencher) {
            let spectrum = &spectra(&grid(), 1)[0];
            let want = luminance(&converter(Groups::ALL), spectrum);
            bencher.bench_local(|| {
                assert_eq!(luminance(&converter(Groups::ALL), black_box(spectrum)), want);
            });
        }

        /// All plans for 401 samples by 1 nm under the exact rule, and one conversion.
        #[divan::bench]
        fn all_401_exact(bencher: Bencher) {
            let coarse = rows(1);
            let fine = Grid::uniform(380.0, 1.0, 401).expect("ascending");
            let values = (0..401_u16).map(|i| {
                let (k, t) = (usize::from(i / 5), f64::from(i % 5) / 5.0);
                let (a, b) = (coarse[k], coarse[(k + 1).min(80)]);
                a + t * (b - a)
            });
            let spectrum = Spectrum::density(fine, values.collect()).expect("finite");
            let contract = Contract { rule: Some(Rule::Exact), range_nm: None };
            let new = || Converter::new(Settings { contract, ..Settings::default() });
            let want = luminance(&new(), &spectrum);
            bencher.bench_local(|| assert_eq!(luminance(&new(), black_box(&spectrum)), want));
        }
    }
}
