#![no_main]

use photopic::brdf::compress::file::BasisFile;
use sha2::{Digest, Sha256};

/// As it is, and with the checksum that lets a reader look further than at its own.
fn read(bytes: &[u8]) {
    match BasisFile::read(&mut &bytes[..]) {
        Ok((file, _)) => {
            let mut written = Vec::new();
            let checksum = file.write(&mut written).expect("written to memory");
            assert_eq!(BasisFile::read(&mut &written[..]).expect("our own file"), (file, checksum));
        }
        Err(error) => assert!(!error.to_string().is_empty()),
    }
}

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    read(bytes);
    read(&[bytes, &Sha256::digest(bytes)[..]].concat());
});
