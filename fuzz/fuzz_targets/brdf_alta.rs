#![no_main]

use photopic::brdf::format::Format;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| photopic_fuzz::brdf(bytes, Some(Format::Alta)));
