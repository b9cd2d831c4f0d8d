//! Reading lamp files.

use std::fs;
use std::io::{self, Read};

use sha2::{Digest, Sha256};

use crate::finding::{Checked, Finding, Location};
use crate::luminaire::format::{self, File, ReadOptions};
use crate::report::envelope::Input;

/// A file read, with its checksum.
pub(in crate::cli) struct Loaded {
    pub input: Input,
    pub file: Result<Checked<File>, (String, Box<Finding>)>,
}

pub(in crate::cli) fn load(path: &str, repair: bool) -> Loaded {
    let bytes = if path == "-" {
        let mut bytes = Vec::new();
        io::stdin().read_to_end(&mut bytes).map(|_| bytes)
    } else {
        fs::read(path)
    };
    let place = Location::default().in_file(path);
    match bytes {
        Err(error) => {
            let message = format!("cannot be read: {error}; expected a readable lamp file");
            let finding = Finding::error("L000", message.clone()).at(place);
            Loaded {
                input: Input { path: path.to_owned(), sha256: None },
                file: Err((format!("{path}: {message}"), Box::new(finding))),
            }
        }
        Ok(bytes) => {
            let sha256 = Some(Sha256::digest(&bytes).iter().map(|b| format!("{b:02x}")).collect());
            let file = format::open(&bytes, &ReadOptions { format: None, repair }).map_err(|error| {
                let error = error.in_file(path);
                let mut finding = Finding::error("L000", error.kind().to_string()).at(error.location().clone());
                finding.hint = error.hint().map(str::to_owned);
                (error.to_string(), Box::new(finding))
            });
            let file = file.map(|mut checked| {
                for finding in &mut checked.findings {
                    finding.location.path = Some(path.to_owned());
                }
                checked
            });
            Loaded { input: Input { path: path.to_owned(), sha256 }, file }
        }
    }
}
