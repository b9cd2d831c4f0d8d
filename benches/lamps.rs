//! Reading luminaire files held in memory: `cargo bench --bench lamps`.
//!
//! `plain` has the numbers of ordinary files (up to seven characters), `long` what programs print in full (17 digits).

#[path = "samples/lamp.rs"]
mod lamp;

use divan::counter::BytesCount;
use divan::{Bencher, black_box};
use lamp::{big, file};
use photopic::luminaire::format::ies::{self, ReadOptions, Version};

fn main() {
    divan::main();
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
