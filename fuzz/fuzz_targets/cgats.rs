#![no_main]

use photopic::spectrum::format::Format;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| photopic_fuzz::format(bytes, Format::Cgats));
