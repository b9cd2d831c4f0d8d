//! Reading files: `format/read/…` whole, `format/stream/…` a table of one spectrum per row in batches.

mod samples;

fn main() {
    divan::main();
}

mod format {
    use std::fmt::Write;

    use crate::samples::{SAMPLES, rows};

    /// Two columns, 380–780 nm by 1 nm, values in scientific notation as instruments write them.
    fn columns() -> String {
        let mut text = "wavelength (nm),irradiance (W/m2/nm)\n".to_owned();
        let coarse = rows(1);
        for i in 0..=400 {
            let value = coarse[i / 5] * (1.0 + 1e-4 * i as f64);
            writeln!(text, "{}.0,{value:.6e}", 380 + i).expect("memory");
        }
        text
    }

    /// One spectrum per row, 380–780 nm by 5 nm, with a name in front and seven digits.
    fn table(count: usize) -> String {
        let mut text = "name".to_owned();
        (0..SAMPLES).for_each(|k| write!(text, ",{}", 380 + 5 * k).expect("memory"));
        for (i, row) in rows(count).chunks_exact(SAMPLES).enumerate() {
            write!(text, "\nled {i}").expect("memory");
            row.iter().for_each(|v| write!(text, ",{v:.7}").expect("memory"));
        }
        text.push('\n');
        text
    }

    mod read {
        use divan::counter::BytesCount;
        use divan::{Bencher, black_box};
        use photopic::spectrum::format::{ReadOptions, read};

        /// A CSV of two columns and 401 rows.
        #[divan::bench]
        fn csv_401(bencher: Bencher) {
            let text = super::columns();
            bencher.counter(BytesCount::of_str(&text)).bench_local(|| {
                let file = read(black_box(text.as_bytes()), &ReadOptions::default()).expect("a table");
                assert_eq!(file.value.entries.len(), 1);
                assert_eq!(file.value.entries[0].spectrum.wavelengths_nm()[400], 780.0);
            });
        }
    }

    mod stream {
        use divan::counter::{BytesCount, ItemsCount};
        use divan::{Bencher, black_box};
        use photopic::spectrum::format::{Opened, ReadOptions, open};

        use crate::samples::{SAMPLES, rows};

        const COUNT: usize = 20_000;

        /// Opens and parses all rows, in batches of 4096.
        #[divan::bench(args = [1, 2], sample_count = 20)]
        fn rows_on_threads(bencher: Bencher, threads: usize) {
            let text = super::table(COUNT);
            let want = rows(COUNT);
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
            bencher.counter(BytesCount::of_str(&text)).counter(ItemsCount::new(COUNT)).bench_local(|| {
                pool.install(|| {
                    let opened = open(black_box(text.as_bytes()), &ReadOptions::default()).expect("a table");
                    let Opened::Stream(mut stream) = opened else { panic!("expected a stream of rows") };
                    let mut count = 0;
                    while let Some(batch) = stream.next_batch(4096).expect("memory does not fail") {
                        for row in batch {
                            let row = row.expect("numbers");
                            // Seven decimals were written.
                            assert!((row.values[40] - want[count * SAMPLES + 40]).abs() < 6e-8);
                            count += 1;
                        }
                    }
                    assert_eq!(count, COUNT);
                });
            });
        }
    }
}
