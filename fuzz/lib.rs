//! What all targets hold a reader to: no panic, and what it reads is a spectrum that stands every further step.

use photopic::spectrum::format::{Format, ReadOptions, read};

/// Reads as one format and resolves whatever comes out.
pub fn format(bytes: &[u8], format: Format) {
    with(bytes, &ReadOptions { format: Some(format), ..ReadOptions::default() });
}

/// Reads as the content tells.
pub fn detected(bytes: &[u8]) {
    with(bytes, &ReadOptions::default());
}

fn with(bytes: &[u8], options: &ReadOptions) {
    match read(bytes, options) {
        Ok(file) => {
            assert!(!file.value.entries.is_empty());
            for entry in &file.value.entries {
                assert!(entry.spectrum.values().iter().all(|v| v.is_finite()));
                let _ = entry.resolve(None, None);
            }
        }
        Err(error) => assert!(error.location().line.is_some() && error.to_string().contains("; expected "), "{error}"),
    }
}
