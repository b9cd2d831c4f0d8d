//! Spectra to tristimulus values: `spectrum/xyz/…`, 100 000 spectra of 81 samples on one core.

mod samples;

fn main() {
    divan::main();
}

mod spectrum {
    mod xyz {
        use divan::counter::{BytesCount, ItemsCount};
        use divan::{Bencher, black_box};
        use photopic::colorimetry::observer::{self, Observer};
        use photopic::constants::K_M;
        use photopic::photometry::luminous::{self, Efficacy, Efficiency};
        use photopic::spectrum::Sampling;
        use photopic::spectrum::integrate::{Contract, Matrix};

        use crate::samples::{LAST_XYZ, MEAN_XYZ, SAMPLES, grid, rows};

        const COUNT: usize = 100_000;

        fn plans() -> (observer::Plan, luminous::Plan) {
            let (grid, contract) = (grid(), Contract::default());
            let colour = observer::Plan::new(Observer::Cie1931, &grid, Sampling::Density, &contract);
            let (v, k) = (Efficiency::default(), Efficacy::default());
            let luminous = luminous::Plan::new(v, k, &grid, Sampling::Density, &contract);
            (colour.expect("a rule for equal steps"), luminous.expect("a rule for equal steps"))
        }

        /// All are right; for between the runs, since it takes as long as they do.
        fn check(out: &[[f64; 4]]) {
            let mean = |k: usize| out.iter().map(|o| o[k]).sum::<f64>() / out.len() as f64;
            let [x, y, z] = MEAN_XYZ;
            for (k, want) in [x, y, z, K_M * y].into_iter().enumerate() {
                assert!((mean(k) / want - 1.0).abs() < 1e-9, "column {k}: {} {want}", mean(k));
            }
        }

        /// The last is right; for inside a run.
        fn check_last(out: &[[f64; 4]]) {
            let [x, y, z] = LAST_XYZ;
            for (got, want) in out[COUNT - 1].into_iter().zip([x, y, z, K_M * y]) {
                assert!((got / want - 1.0).abs() < 1e-12, "{got} {want}");
            }
        }

        /// X, Y, Z and luminance of all rows in one product of matrices.
        #[divan::bench]
        fn matrix(bencher: Bencher) {
            let values = rows(COUNT);
            let (colour, luminous) = plans();
            let [x, y, z] = colour.weights().each_ref().map(Vec::as_slice);
            let luminance: Vec<f64> = luminous.photopic_weights().iter().map(|w| w * luminous.efficacy().k_m).collect();
            let matrix = Matrix::new([x, y, z, &luminance]);
            let mut out = vec![[0.0; 4]; COUNT];
            bencher.counter(ItemsCount::new(COUNT)).counter(BytesCount::of_slice(&values)).bench_local(|| {
                matrix.integrals(black_box(&values), black_box(&mut out));
                check_last(&out);
            });
            check(&out);
        }

        /// The same one spectrum at a time, as [`photopic::conversion::Converter`] does.
        #[divan::bench]
        fn one_by_one(bencher: Bencher) {
            let values = rows(COUNT);
            let (colour, luminous) = plans();
            let mut out = vec![[0.0; 4]; COUNT];
            bencher.counter(ItemsCount::new(COUNT)).counter(BytesCount::of_slice(&values)).bench_local(|| {
                for (row, out) in black_box(&values).chunks_exact(SAMPLES).zip(&mut out) {
                    let [x, y, z] = colour.xyz(row);
                    *out = [x, y, z, luminous.evaluate(row).photopic];
                }
                check_last(&out);
            });
            check(&out);
        }
    }
}
