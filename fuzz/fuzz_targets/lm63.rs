#![no_main]

use photopic::luminaire::format::Format;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| photopic_fuzz::lamp(bytes, Some(Format::Ies)));
