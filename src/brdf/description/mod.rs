//! Materials in words: the text of the command line, of material files and of scenes.
//!
//! ```text
//! ggx(alpha=0.1, medium=Au)
//! lambert(reflectance=[[400, 0.05], [700, 0.6]]) + 0.04*blinn-phong(ks=1, n=200)
//! sgd(rho_d=[0.05, 0.03, 0.02], …)                 three channels instead of wavelengths
//! ```
//!
//! A material is a sum of models, each with an optional weight. A parameter is a number; a word; a list `[a, b, c]` of one value
//! per channel (R, G, B); a spectrum `[[nm, value], …]`, linear in between and constant beyond its ends; or the name of a file with
//! one spectrum, `paint.csv`, which has a dot in it ([`Material::with_spectra`]). Where a parameter of the material has channels, the
//! whole material has them, and no wavelengths. A file says the same in TOML ([`toml`]):
//!
//! ```toml
//! model = "ggx"
//! alpha = 0.1
//! medium = "Au"
//! ```
//!
//! [`Material::prepare`] turns it into a [`Brdf`] for the caller's bands. A [`template::Template`] leaves parameters open for a fit.

mod parse;
pub mod template;
pub mod toml;

use std::fmt;

use super::lambert::MODEL as LAMBERT;
use super::medium;
use super::parameter::{self, Arguments, Kind, Model, Parameter, Value};
use super::sum::Sum;
use super::{Brdf, abc, ashikhmin_shirley, microfacet, oren_nayar, phong, sgd, specular, ward};
use crate::spectrum::{Sampling, Spectrum};

/// All models by name.
pub const MODELS: [Model; 14] = [
    LAMBERT,
    oren_nayar::MODEL,
    specular::MIRROR,
    specular::DIELECTRIC,
    specular::CONDUCTOR,
    phong::PHONG,
    phong::BLINN_PHONG,
    ward::MODEL,
    ashikhmin_shirley::MODEL,
    microfacet::GGX,
    microfacet::BECKMANN,
    microfacet::BLINN,
    abc::MODEL,
    sgd::MODEL,
];

/// A place in the text, both from 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Place {
    /// Line.
    pub line: u64,
    /// Column, in characters.
    pub column: u64,
}

/// Why a description is none, and where.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{}:{}: {kind}", place.line, place.column)]
pub struct Error {
    /// Where.
    pub place: Place,
    /// Why.
    pub kind: ErrorKind,
}

/// What is wrong with a description.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ErrorKind {
    /// Something else was expected here.
    #[error("found {found}; expected {expected}")]
    Syntax {
        /// What stands there.
        found: String,
        /// What should.
        expected: String,
    },
    /// No model has this name.
    #[error("no model is called `{name}`; expected one of {}", MODELS.map(|m| m.name).join(", "))]
    Model {
        /// The name.
        name: String,
    },
    /// The model has no such parameter.
    #[error("`{model}` has no parameter `{name}`; expected {known}")]
    Parameter {
        /// The model.
        model: &'static str,
        /// The parameter.
        name: String,
        /// Its parameters with their ranges.
        known: String,
    },
    /// A parameter is given twice.
    #[error("`{name}` is given twice; expected once")]
    Twice {
        /// The parameter.
        name: &'static str,
    },
    /// A value that the model does not take.
    #[error("{0}")]
    Value(#[from] parameter::Error),
    /// A substance that is not known, or not there.
    #[error("{0}")]
    Medium(#[from] medium::Error),
    /// A file of a spectrum that gave none.
    #[error("{message}")]
    File {
        /// Why.
        message: String,
    },
    /// Channels where there are wavelengths, or the other way round.
    #[error("{found}; expected {expected}")]
    Bands {
        /// What the material has.
        found: String,
        /// What fits.
        expected: &'static str,
    },
}

/// What a material is prepared for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Bands<'a> {
    /// Wavelengths in nm.
    Wavelengths(&'a [f64]),
    /// So many channels, as measured.
    Channels(usize),
}

impl Bands<'_> {
    /// Their number.
    #[must_use]
    pub fn count(&self) -> usize {
        match self {
            Self::Wavelengths(w) => w.len(),
            Self::Channels(n) => *n,
        }
    }
}

/// A value as it was written.
#[derive(Debug, Clone, PartialEq)]
enum Raw {
    Number(f64),
    Word(String),
    Channels(Vec<f64>),
    Spectrum(Vec<[f64; 2]>),
    /// Left open, perhaps with a start; only in a [`template::Template`].
    Open(Option<f64>),
}

#[derive(Debug, Clone, PartialEq)]
struct Argument {
    parameter: &'static Parameter,
    value: Raw,
    place: Place,
}

/// One model of a sum.
#[derive(Debug, Clone)]
struct Part {
    weight: Raw,
    model: &'static Model,
    arguments: Vec<Argument>,
    place: Place,
}

/// A described material.
#[derive(Debug, Clone)]
pub struct Material {
    parts: Vec<Part>,
}

impl std::str::FromStr for Material {
    type Err = Error;

    /// Reads a description such as `0.5*lambert(reflectance=0.3) + ggx(alpha=0.1, eta=1.5)`.
    fn from_str(text: &str) -> Result<Self, Error> {
        parse::material(text)
    }
}

impl Material {
    /// The number of channels, where a parameter has them; otherwise the material is for wavelengths.
    #[must_use]
    pub fn channels(&self) -> Option<usize> {
        let values =
            self.parts.iter().flat_map(|p| std::iter::once(&p.weight).chain(p.arguments.iter().map(|a| &a.value)));
        values.into_iter().find_map(|v| if let Raw::Channels(v) = v { Some(v.len()) } else { None })
    }

    /// The models of the sum, in order.
    pub fn models(&self) -> impl Iterator<Item = &'static Model> {
        self.parts.iter().map(|p| p.model)
    }

    /// The material with the spectra of the files that it names, which `read` gives, or says in words why there is none.
    ///
    /// # Errors
    /// [`ErrorKind::File`] where the name stands.
    pub fn with_spectra(mut self, mut read: impl FnMut(&str) -> Result<Spectrum, String>) -> Result<Self, Error> {
        for part in &mut self.parts {
            let spectral = part.arguments.iter_mut().filter(|a| a.parameter.kind == Kind::Spectral);
            let weight = (&mut part.weight, part.place);
            for (value, place) in std::iter::once(weight).chain(spectral.map(|a| (&mut a.value, a.place))) {
                if let Raw::Word(name) = &value
                    && name.contains('.')
                {
                    let wrong = |message| Error { place, kind: ErrorKind::File { message } };
                    let spectrum = read(name).map_err(wrong)?;
                    if spectrum.sampling() == Sampling::Lines {
                        return Err(wrong(format!("{name}: spectral lines; expected a continuous spectrum")));
                    }
                    let pairs = spectrum.wavelengths_nm().iter().zip(spectrum.values());
                    *value = Raw::Spectrum(pairs.map(|(nm, v)| [*nm, *v]).collect());
                }
            }
        }
        Ok(self)
    }

    /// The BRDF on the bands.
    ///
    /// # Errors
    /// [`ErrorKind::Value`] for values outside their ranges, [`ErrorKind::Medium`] for substances, [`ErrorKind::Bands`] where
    /// channels meet wavelengths; all with their place.
    pub fn prepare(&self, bands: Bands<'_>) -> Result<Box<dyn Brdf>, Error> {
        if let [part] = &self.parts[..]
            && part.weight == Raw::Number(1.0)
        {
            return part.prepare(bands);
        }
        let parts = self.parts.iter().map(|part| {
            let weights = spectral(&part.weight, bands).map_err(|kind| Error { place: part.place, kind })?;
            Ok((weights, part.prepare(bands)?))
        });
        let parts = parts.collect::<Result<Vec<_>, Error>>()?;
        let place = self.parts.first().map_or(Place { line: 1, column: 1 }, |p| p.place);
        Ok(Box::new(Sum::new(parts).map_err(|e| Error { place, kind: e.into() })?))
    }
}

impl Part {
    fn prepare(&self, bands: Bands<'_>) -> Result<Box<dyn Brdf>, Error> {
        let values = self.arguments.iter().map(|a| {
            let value = a.value(bands).map_err(|kind| Error { place: a.place, kind })?;
            Ok((a.parameter.name, value))
        });
        let arguments = Arguments { bands: bands.count(), values: values.collect::<Result<_, Error>>()? };
        (self.model.build)(&arguments).map_err(|error| {
            // At the parameter that is to blame; a missing one is the model's.
            let name = match &error {
                parameter::Error::Range { name, .. } | parameter::Error::Bands { name, .. } => Some(*name),
                parameter::Error::Conflict { second, .. } => Some(*second),
                parameter::Error::Missing { .. } => None,
            };
            let blamed = self.arguments.iter().find(|a| Some(a.parameter.name) == name);
            Error { place: blamed.map_or(self.place, |a| a.place), kind: error.into() }
        })
    }
}

impl Argument {
    fn value(&self, bands: Bands<'_>) -> Result<Value, ErrorKind> {
        let unfit = |found: &Raw| ErrorKind::Syntax {
            found: format!("`{found}` for `{}`", self.parameter.name),
            expected: self.parameter.expected(),
        };
        match (self.parameter.kind, &self.value) {
            (Kind::Number, Raw::Number(v)) => Ok(Value::Number(*v)),
            (Kind::Spectral, Raw::Word(_)) => Err(unfit(&self.value)),
            (Kind::Spectral, raw) => Ok(Value::Spectral(spectral(raw, bands)?)),
            (Kind::Choice(words), Raw::Word(word)) => {
                let word = words.iter().find(|w| w.eq_ignore_ascii_case(word)).ok_or_else(|| unfit(&self.value))?;
                Ok(Value::Choice(word))
            }
            (Kind::Medium, Raw::Word(name)) => match bands {
                Bands::Wavelengths(nm) => {
                    let (n, k) = medium::refractive_index(name, nm)?;
                    Ok(Value::Medium(n, k))
                }
                Bands::Channels(_) => Err(ErrorKind::Bands {
                    found: format!("`{name}` needs wavelengths, and the material has channels"),
                    expected: "eta and k per channel instead",
                }),
            },
            (_, raw) => Err(unfit(raw)),
        }
    }
}

/// A value on all bands.
fn spectral(raw: &Raw, bands: Bands<'_>) -> Result<Vec<f64>, ErrorKind> {
    match (raw, bands) {
        (Raw::Number(v), _) => Ok(vec![*v; bands.count()]),
        (Raw::Channels(v), Bands::Channels(n)) if v.len() == n => Ok(v.clone()),
        (Raw::Channels(v), Bands::Channels(n)) => Err(ErrorKind::Bands {
            found: format!("{} channels where another parameter has {n}", v.len()),
            expected: "as many everywhere",
        }),
        (Raw::Channels(v), Bands::Wavelengths(_)) => Err(ErrorKind::Bands {
            found: format!("values of {} channels, without wavelengths", v.len()),
            expected: "a spectrum [[nm, value], …] or one number",
        }),
        (Raw::Spectrum(pairs), Bands::Wavelengths(nm)) => {
            let (xs, ys): (Vec<f64>, Vec<f64>) = pairs.iter().map(|[x, y]| (*x, *y)).unzip();
            Ok(nm.iter().map(|w| medium::linear(&xs, &ys, *w)).collect())
        }
        (Raw::Spectrum(_), Bands::Channels(_)) => Err(ErrorKind::Bands {
            found: "a spectrum, and the material has channels".to_owned(),
            expected: "one value per channel",
        }),
        (Raw::Word(_) | Raw::Open(_), _) => {
            Err(ErrorKind::Syntax { found: format!("`{raw}`"), expected: "a number or spectrum".to_owned() })
        }
    }
}

impl fmt::Display for Raw {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(v) => write!(f, "{v}"),
            Self::Word(w) if !w.is_empty() && w.chars().all(is_of_a_word) => f.write_str(w),
            Self::Word(w) => write!(f, "\"{w}\""),
            Self::Channels(v) => write!(f, "{v:?}"),
            Self::Spectrum(v) => write!(f, "{v:?}"),
            Self::Open(None) => f.write_str("?"),
            Self::Open(Some(start)) => write!(f, "?{start}"),
        }
    }
}

impl fmt::Display for Material {
    /// The description on one line, which reads back as the same material.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, part) in self.parts.iter().enumerate() {
            f.write_str(if i > 0 { " + " } else { "" })?;
            if part.weight != Raw::Number(1.0) {
                write!(f, "{}*", part.weight)?;
            }
            let arguments: Vec<String> =
                part.arguments.iter().map(|a| format!("{}={}", a.parameter.name, a.value)).collect();
            write!(f, "{}({})", part.model.name, arguments.join(", "))?;
        }
        Ok(())
    }
}

/// Whether a character stands in names without quotes.
fn is_of_a_word(c: char) -> bool {
    c.is_alphanumeric() || "_-./".contains(c)
}

/// The model of a name.
fn model(name: &str, place: Place) -> Result<&'static Model, Error> {
    const ALL: &[Model] = &MODELS;
    ALL.iter()
        .find(|m| m.name.eq_ignore_ascii_case(name))
        .ok_or_else(|| Error { place, kind: ErrorKind::Model { name: name.to_owned() } })
}

/// Adds an argument to a model's, if it has such a parameter and not yet.
fn add(
    arguments: &mut Vec<Argument>,
    model: &'static Model,
    name: &str,
    name_place: Place,
    (value, place): (Raw, Place),
) -> Result<(), Error> {
    let Some(parameter) = model.parameters.iter().find(|p| p.name == name) else {
        let known = model.parameters.iter().map(Parameter::to_string).collect::<Vec<_>>().join("; ");
        let kind = ErrorKind::Parameter { model: model.name, name: name.to_owned(), known };
        return Err(Error { place: name_place, kind });
    };
    if arguments.iter().any(|a| a.parameter.name == name) {
        return Err(Error { place: name_place, kind: ErrorKind::Twice { name: parameter.name } });
    }
    if let Raw::Open(start) = value {
        let numeric = matches!(parameter.kind, Kind::Number | Kind::Spectral);
        let found = format!("`{value}` for `{}`", parameter.name);
        let kind = ErrorKind::Syntax { found, expected: parameter.expected() };
        let checked = start.map_or(Ok(()), |s| parameter.check(s).map_err(ErrorKind::from));
        let checked = if numeric { checked } else { Err(kind) };
        checked.map_err(|kind| Error { place, kind })?;
    }
    arguments.push(Argument { parameter, value, place });
    Ok(())
}

/// A list of numbers is channels, a list of pairs with rising wavelengths a spectrum.
fn list(items: Vec<Raw>, place: Place) -> Result<Raw, Error> {
    let numbers: Option<Vec<f64>> =
        items.iter().map(|i| if let Raw::Number(v) = i { Some(*v) } else { None }).collect();
    let pairs: Option<Vec<[f64; 2]>> = (items.iter())
        .map(|i| if let Raw::Channels(v) = i { <[f64; 2]>::try_from(v.as_slice()).ok() } else { None })
        .collect();
    let rising = |p: &Vec<[f64; 2]>| p.windows(2).all(|w| w[0][0] < w[1][0]);
    match (numbers, pairs) {
        (Some(numbers), _) if !numbers.is_empty() => Ok(Raw::Channels(numbers)),
        (_, Some(pairs)) if !pairs.is_empty() && rising(&pairs) => Ok(Raw::Spectrum(pairs)),
        (_, Some(pairs)) if !pairs.is_empty() => Err(Error {
            place,
            kind: ErrorKind::Syntax {
                found: "a spectrum whose wavelengths do not rise".to_owned(),
                expected: "[[nm, value], …] from short to long wavelengths".to_owned(),
            },
        }),
        _ => Err(Error {
            place,
            kind: ErrorKind::Syntax {
                found: "a list of other things".to_owned(),
                expected: "numbers per channel, or pairs [nm, value]".to_owned(),
            },
        }),
    }
}
