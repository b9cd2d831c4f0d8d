#![no_main]

use std::io::Cursor;

use photopic::image::format::radiance::{open, parse_header};
use photopic::image::{Memory, Source};

/// Samples that a run of eight bytes may claim; beyond them only the header is read.
const MOST: usize = 1 << 22;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let size = parse_header(bytes).map_or(0, |header| header.value.width.saturating_mul(header.value.height));
    if size > MOST {
        return;
    }
    match open(Cursor::new(bytes)) {
        Ok(mut opened) => {
            assert_eq!(opened.value.description().pixels(), size);
            Memory::load(&mut opened.value).expect("what was opened is read");
        }
        Err(error) => assert!(error.to_string().contains("expected "), "{error}"),
    }
});
