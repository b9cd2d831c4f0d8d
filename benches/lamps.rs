//! Reading luminaire files held in memory: `cargo bench --bench lamps`.
//!
//! `plain` has the numbers of ordinary files (up to seven characters), `long` what programs print in full (17 digits).

use divan::counter::BytesCount;
use divan::{Bencher, black_box};
use photopic::luminaire::format::ies::{self, ReadOptions, Version};

fn main() {
    divan::main();
}

/// A file of 721 × 1441 angles, 6 MB and more.
fn big(digits: usize) -> String {
    file(721, 1441, digits)
}

fn file(rows: i32, planes: i32, digits: usize) -> String {
    let mut out = format!(
        "IESNA:LM-63-2002\r\n[TEST] bench\r\n[TESTLAB] none\r\n[ISSUEDATE] 2025\r\n[MANUFAC] none\r\nTILT=NONE\r\n1 -1 1 {rows} {planes} 1 2 .5 .5 0\r\n1 1 100\r\n"
    );
    let mut list = |values: &mut dyn Iterator<Item = String>| {
        for (i, value) in values.enumerate() {
            out.push_str(&value);
            out.push_str(if i % 20 == 19 { "\r\n" } else { " " });
        }
        out.push_str("\r\n");
    };
    let (down, around) = (180.0 / f64::from(rows - 1), 360.0 / f64::from(planes - 1));
    list(&mut (0..rows).map(|v| format!("{}", f64::from(v) * down)));
    list(&mut (0..planes).map(|h| format!("{}", f64::from(h) * around)));
    for plane in 0..planes {
        let swing = 1.0 + 0.1 * (f64::from(plane) * around).to_radians().sin();
        list(&mut (0..rows).map(|row| {
            let v = 12_345.678 * swing * (0.5 + 0.5 * (f64::from(row) * down).to_radians().cos()).powi(3);
            format!("{v:.digits$}")
        }));
    }
    out
}

mod lm63 {
    use super::*;

    #[divan::bench(args = [("plain", 1), ("decimals", 4), ("long", 13)])]
    fn parse(bencher: Bencher<'_, '_>, (_, digits): (&str, usize)) {
        let text = big(digits);
        bencher.counter(BytesCount::of_str(&text)).bench(|| {
            let raw = ies::parse(black_box(text.as_bytes())).expect("a file").value;
            assert_eq!(raw.candela.len(), 721 * 1441);
            raw
        });
    }

    /// A file of ordinary size, 37 × 25 angles: what a directory of thousands is made of.
    #[divan::bench]
    fn ordinary(bencher: Bencher<'_, '_>) {
        let text = file(37, 25, 1);
        bencher
            .counter(BytesCount::of_str(&text))
            .bench(|| ies::read(black_box(text.as_bytes()), ReadOptions::default()).expect("a file").value);
    }

    /// With the bridge to the model and its checks.
    #[divan::bench(args = [("plain", 1), ("long", 13)])]
    fn read(bencher: Bencher<'_, '_>, (_, digits): (&str, usize)) {
        let text = big(digits);
        bencher
            .counter(BytesCount::of_str(&text))
            .bench(|| ies::read(black_box(text.as_bytes()), ReadOptions::default()).expect("a file").value);
    }

    #[divan::bench]
    fn write(bencher: Bencher<'_, '_>) {
        let text = big(1);
        let lamp = ies::read(text.as_bytes(), ReadOptions::default()).expect("a file").value;
        bencher
            .counter(BytesCount::of_str(&text))
            .bench(|| ies::write(black_box(&lamp), Version::Lm63_2019).expect("text").value);
    }
}
