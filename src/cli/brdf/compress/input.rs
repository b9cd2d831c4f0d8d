//! Materials on the bins of a basis: tables as they are, all else resampled.

use crate::brdf::description::{Bands, Material};
use crate::brdf::table::{Channel, HalfAngle, Known, Resolution, Table, resample};
use crate::cli::brdf::load::{self, Subject, in_file};
use crate::finding::Finding;
use crate::report::envelope::Input;

/// A material read.
pub(super) struct Loaded {
    /// The material's file and those of its spectra.
    pub inputs: Vec<Input>,
    /// The table and the findings of its file, or the message of what went wrong.
    pub table: Result<(HalfAngle, Vec<Finding>), String>,
}

/// Reads a material as the other verbs do, and puts it on the bins.
pub(super) fn load(argument: &str, resolution: Resolution, wavelengths_nm: &[f64]) -> Loaded {
    let material = load::load(argument, None);
    let table = material.subject.and_then(|read| {
        let table = match read.value {
            Subject::Described(material) => described(argument, &material, resolution, wavelengths_nm),
            Subject::Measured(file) => measured(argument, file.table, resolution),
        };
        Ok((table?, read.findings))
    });
    Loaded { inputs: std::iter::once(material.input).chain(material.spectra).collect(), table }
}

fn described(
    argument: &str,
    material: &Material,
    resolution: Resolution,
    wavelengths_nm: &[f64],
) -> Result<HalfAngle, String> {
    let bands = material.channels().map_or(Bands::Wavelengths(wavelengths_nm), Bands::Channels);
    let brdf = material.prepare(bands).map_err(|e| in_file(argument, &e))?;
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
    Ok(resample(resolution, channels, at))
}

fn measured(argument: &str, table: Table, resolution: Resolution) -> Result<HalfAngle, String> {
    match table {
        // Of other bins: the collection says so, for its bins are not ours to invent.
        Table::HalfAngle(table) => Ok(table),
        table if table.is_isotropic() => {
            let at = |i, o, values: &mut [f64]| table.value(i, o, values) == Known::Measured;
            Ok(resample(resolution, table.channels().to_vec(), at))
        }
        _ => Err(format!("{argument}: found an anisotropic table; expected an isotropic one")),
    }
}
