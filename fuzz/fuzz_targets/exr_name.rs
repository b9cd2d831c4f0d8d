#![no_main]

use photopic::image::format::exr::{channel_name, parse_name};

// Whatever is read as a name is written and read again as the same.
libfuzzer_sys::fuzz_target!(|text: &str| {
    if let Some(name) = parse_name(text) {
        assert_eq!(parse_name(&channel_name(name)), Some(name), "{text}");
    }
});
