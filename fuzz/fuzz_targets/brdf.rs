#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| photopic_fuzz::brdf(bytes, None));
