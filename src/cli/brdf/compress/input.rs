//! Materials on the bins of a basis: tables as they are, all else resampled.

use std::fs;
use std::io::{self, Read};
use std::path::Path;

use sha2::{Digest, Sha256};

use crate::brdf::description::{Bands, Material, toml};
use crate::brdf::format;
use crate::brdf::table::{Channel, HalfAngle, Known, Resolution, Table, resample};
use crate::finding::{Finding, Location};
use crate::report::envelope::Input;

/// A material read.
pub(super) struct Loaded {
    pub input: Input,
    /// The table and the findings of its file, or the message of what went wrong.
    pub table: Result<(HalfAngle, Vec<Finding>), String>,
}

/// Reads a file's bytes, `-` being standard input.
pub(super) fn bytes_of(argument: &str) -> io::Result<Vec<u8>> {
    if argument != "-" {
        return fs::read(argument);
    }
    let mut bytes = Vec::new();
    io::stdin().read_to_end(&mut bytes).map(|_| bytes)
}

pub(super) fn hex(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().map(|b| format!("{b:02x}")).collect()
}

/// Reads a material: a measured table, a description in TOML, or the description itself.
pub(super) fn load(argument: &str, resolution: Resolution, wavelengths_nm: &[f64]) -> Loaded {
    let mut input = Input { path: argument.to_owned(), sha256: None };
    let table = (|| {
        if argument != "-" && !Path::new(argument).exists() {
            if !argument.contains('(') {
                let hint = "expected a file, or a description such as 'lambert(reflectance=0.5)'";
                return Err(format!("{argument}: there is no such file; {hint}"));
            }
            let material = argument.parse::<Material>().map_err(|e| format!("{argument}: {e}"))?;
            return described(argument, &material, resolution, wavelengths_nm);
        }
        let bytes = bytes_of(argument).map_err(|e| format!("{argument}: cannot be read: {e}; expected a material"))?;
        input.sha256 = Some(hex(&bytes));
        if format::detect(&bytes).is_some() {
            return measured(argument, &bytes, resolution);
        }
        let text = std::str::from_utf8(&bytes).ok().filter(|t| !t.trim().is_empty());
        match text.map(toml::read) {
            Some(Ok(named)) => described(argument, &named.material, resolution, wavelengths_nm),
            Some(Err(error)) => Err(format!("{argument}:{error}")),
            // Of what is neither table nor text the readers of tables know best what it is.
            None => measured(argument, &bytes, resolution),
        }
    })();
    Loaded { input, table }
}

fn described(
    argument: &str,
    material: &Material,
    resolution: Resolution,
    wavelengths_nm: &[f64],
) -> Result<(HalfAngle, Vec<Finding>), String> {
    let bands = material.channels().map_or(Bands::Wavelengths(wavelengths_nm), Bands::Channels);
    let brdf = material.prepare(bands).map_err(|e| format!("{argument}: {e}"))?;
    if !brdf.is_isotropic() {
        return Err(format!("{argument}: found an anisotropic material; expected an isotropic one"));
    }
    if brdf.has_delta() {
        return Err(format!("{argument}: found a Dirac lobe, which no bin can hold; expected a material without"));
    }
    let channels = match bands {
        Bands::Wavelengths(nm) => nm.iter().map(|w| Channel::Wavelength(*w)).collect(),
        Bands::Channels(3) => Channel::rgb(),
        Bands::Channels(n) => (1..=n).map(|i| Channel::Named(format!("channel {i}"))).collect(),
    };
    let at = |i, o, values: &mut [f64]| {
        brdf.evaluate(i, o, values);
        true
    };
    Ok((resample(resolution, channels, at), Vec::new()))
}

fn measured(argument: &str, bytes: &[u8], resolution: Resolution) -> Result<(HalfAngle, Vec<Finding>), String> {
    let read = format::open(bytes, None).map_err(|e| e.in_file(argument).to_string())?;
    let findings = read.findings.into_iter().map(|f| f.at(Location::default().in_file(argument))).collect();
    let table = match read.value.table {
        // Of other bins: the collection says so, for its bins are not ours to invent.
        Table::HalfAngle(table) => table,
        table if table.is_isotropic() => {
            let at = |i, o, values: &mut [f64]| table.value(i, o, values) == Known::Measured;
            resample(resolution, table.channels().to_vec(), at)
        }
        _ => return Err(format!("{argument}: found an anisotropic table; expected an isotropic one")),
    };
    Ok((table, findings))
}
