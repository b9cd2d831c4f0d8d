//! Materials from the command line: descriptions, or files that hold one.

use std::fs;
use std::io::{self, Read};
use std::path::Path;
use std::str::FromStr;

use clap::Args;
use sha2::{Digest, Sha256};

use crate::brdf::Brdf;
use crate::brdf::description::{Bands, Error, Material, toml};
use crate::report::envelope::Input;

/// Where the materials come from and on which bands they are wanted.
#[derive(Debug, Args)]
pub(super) struct MaterialArgs {
    /// Materials: a description such as 'ggx(alpha=0.1, medium=Au)', a TOML file, or `-`.
    ///
    /// Models: lambert, oren-nayar, mirror, dielectric, conductor, phong, blinn-phong, ward, ashikhmin-shirley, ggx,
    /// beckmann, blinn, abc, sgd; `0.3*MODEL(…) + MODEL(…)` is a sum. A wrong parameter is answered with the model's list of
    /// them, and `brdf info` prints it.
    #[arg(required = true, value_name = "MATERIAL")]
    pub materials: Vec<String>,
    /// Wavelengths in nm: a list `450,550`, a range `400:700:50`, or both. Materials given per channel keep their channels.
    #[arg(short, long, value_name = "NM")]
    pub wavelength: Option<Numbers>,
}

/// A list of numbers: `0,30,60` or `0:80:10`.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Numbers(pub Vec<f64>);

/// Most numbers that a range may have.
const MOST: f64 = 100_000.0;

impl FromStr for Numbers {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let number = |s: &str| {
            let parsed = s.trim().parse::<f64>().ok().filter(|v| v.is_finite());
            parsed.ok_or_else(|| format!("found `{s}`; expected a number, a list `0,30,60` or a range `0:80:10`"))
        };
        let mut out = Vec::new();
        for item in text.split(',') {
            match item.split(':').collect::<Vec<_>>()[..] {
                [one] => out.push(number(one)?),
                [low, high, step] => {
                    let (low, high, step) = (number(low)?, number(high)?, number(step)?);
                    let steps = ((high - low) / step + 1e-9).floor();
                    if !(0.0..MOST).contains(&steps) {
                        return Err(format!("found `{item}`; expected a range from low to high by a step above 0"));
                    }
                    let mut i = 0.0;
                    while i <= steps {
                        out.push(low + i * step);
                        i += 1.0;
                    }
                }
                _ => return Err(format!("found `{item}`; expected a range `low:high:step`")),
            }
        }
        Ok(Self(out))
    }
}

/// A material read.
pub(super) struct Loaded {
    /// What to call it: the file and the name in it, or the description.
    pub name: String,
    pub input: Input,
    pub material: Result<Material, String>,
}

pub(super) fn load(argument: &str) -> Loaded {
    let is_file = argument == "-" || Path::new(argument).exists();
    if !is_file {
        let input = Input { path: argument.to_owned(), sha256: None };
        let material = if argument.contains('(') {
            argument.parse::<Material>().map_err(|e| format!("{argument}: {e}"))
        } else {
            let hint = "expected a file, or a description such as 'lambert(reflectance=0.5)'";
            Err(format!("{argument}: there is no such file; {hint}"))
        };
        return Loaded { name: argument.to_owned(), input, material };
    }
    let bytes = if argument == "-" {
        let mut bytes = Vec::new();
        io::stdin().read_to_end(&mut bytes).map(|_| bytes)
    } else {
        fs::read(argument)
    };
    let mut name = argument.to_owned();
    let mut input = Input { path: argument.to_owned(), sha256: None };
    let material = match bytes {
        Err(error) => Err(format!("{argument}: cannot be read: {error}; expected a material file")),
        Ok(bytes) => {
            input.sha256 = Some(Sha256::digest(&bytes).iter().map(|b| format!("{b:02x}")).collect());
            let text =
                String::from_utf8(bytes).map_err(|_| format!("{argument}: not UTF-8; expected a material in TOML"));
            text.and_then(|text| toml::read(&text).map_err(|e| in_file(argument, &e))).map(|named| {
                name = named.name.map_or(name.clone(), |n| format!("{argument} [{n}]"));
                named.material
            })
        }
    };
    Loaded { name, input, material }
}

/// `FILE:LINE:COLUMN: …`; for a description the text itself stands for the file.
pub(super) fn in_file(path: &str, error: &Error) -> String {
    let separator = if path.contains('(') { ": " } else { ":" };
    format!("{path}{separator}{error}")
}

/// A material on its channels, or on the wavelengths.
pub(super) fn prepare<'a>(
    path: &str,
    material: &Material,
    wavelengths_nm: &'a [f64],
) -> Result<(Bands<'a>, Box<dyn Brdf>), String> {
    let bands = material.channels().map_or(Bands::Wavelengths(wavelengths_nm), Bands::Channels);
    let brdf = material.prepare(bands).map_err(|e| in_file(path, &e))?;
    Ok((bands, brdf))
}
