#![no_main]

use std::io::Cursor;

use photopic::image::format::envi::{Options, open};
use photopic::image::{Memory, Source};

// The bytes are a header and, behind the first NUL, the numbers.
libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let at = bytes.iter().position(|b| *b == 0).unwrap_or(bytes.len());
    let (header, data) = bytes.split_at(at);
    match open(header, Cursor::new(data), Options::default()) {
        Ok(mut opened) => {
            let d = opened.value.description();
            assert!(d.pixels() * d.channels.len() <= data.len(), "samples are in the file");
            Memory::load(&mut opened.value).expect("a file of the right size is read");
        }
        Err(error) => assert!(error.to_string().contains("expected "), "{error}"),
    }
});
