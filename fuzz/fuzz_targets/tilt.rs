#![no_main]

use photopic::luminaire::format::ies::TiltTable;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    if let Ok(table) = TiltTable::parse(bytes) {
        assert_eq!(table.angles_deg.len(), table.factors.len());
        assert!(table.factors.iter().all(|f| f.is_finite() && *f >= 0.0));
    }
});
