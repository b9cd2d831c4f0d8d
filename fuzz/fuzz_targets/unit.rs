#![no_main]

use photopic::spectrum::SpectralUnit;

libfuzzer_sys::fuzz_target!(|text: &str| {
    if let Ok(unit) = text.parse::<SpectralUnit>() {
        assert!(unit.factor.is_normal() && unit.factor > 0.0);
    }
});
