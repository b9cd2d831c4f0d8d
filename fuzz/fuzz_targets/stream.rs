#![no_main]

use photopic::spectrum::format::{Opened, ReadOptions, open};

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    if let Ok(Opened::Stream(mut stream)) = open(bytes, &ReadOptions::default()) {
        while let Ok(Some(rows)) = stream.next_batch(7) {
            for row in rows.into_iter().flatten() {
                assert_eq!(row.values.len(), stream.grid().len());
            }
        }
    }
});
