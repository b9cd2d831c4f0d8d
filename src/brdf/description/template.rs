//! Materials with open parameters, for a fit to find: the text form with `?` in the place of a value.
//!
//! ```text
//! lambert + ggx(alpha=?0.2, f0=?)        all of Lambert's; alpha, from 0.2 on; f0
//! ?*ward(ks=1, alpha=?, form=duer)       a weight and a roughness, one form
//! ```
//!
//! `?` is open, `?0.2` open with a value to start from. Inside parentheses what has no default and is not given is open, what has one
//! keeps it. A model without parentheses has all of its numbers open, in the customary choice of them: one roughness `alpha`, one
//! exponent `nu`, Schlick's `f0`.

use std::fmt;
use std::str::FromStr;

use super::{Argument, Bands, Error, Material, Part, Place, Raw, parse};
use crate::brdf::parameter::{Kind, Model, Parameter};

/// The weight of a model in a sum.
const WEIGHT: Parameter = Parameter::spectral("weight", 0.0, f64::INFINITY, "weight in the sum");

/// An open parameter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Open {
    /// Which model of the sum, from 0.
    pub part: usize,
    /// The model's name.
    pub model: &'static str,
    /// The parameter; `weight` for the model's weight.
    pub parameter: Parameter,
    /// Where to start, if that was given.
    pub start: Option<f64>,
    /// Where it stands.
    pub place: Place,
}

/// A material with open parameters.
#[derive(Debug, Clone)]
pub struct Template {
    material: Material,
    open: Vec<Open>,
}

impl FromStr for Template {
    type Err = Error;

    fn from_str(text: &str) -> Result<Self, Error> {
        let material = parse::template(text)?;
        let mut open = Vec::new();
        for (part, p) in material.parts.iter().enumerate() {
            if let Raw::Open(start) = p.weight {
                open.push(Open { part, model: p.model.name, parameter: WEIGHT, start, place: p.place });
            }
            for a in &p.arguments {
                if let Raw::Open(start) = a.value {
                    open.push(Open { part, model: p.model.name, parameter: *a.parameter, start, place: a.place });
                }
            }
        }
        Ok(Self { material, open })
    }
}

impl fmt::Display for Template {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.material.fmt(f)
    }
}

impl Template {
    /// The open parameters in the order in which they stand.
    #[must_use]
    pub fn open(&self) -> &[Open] {
        &self.open
    }

    /// The value of a parameter of a model where it was given: of each band, or one for all of them.
    #[must_use]
    pub fn given(&self, part: usize, name: &str) -> Option<&[f64]> {
        let argument = self.material.parts[part].arguments.iter().find(|a| a.parameter.name == name)?;
        match &argument.value {
            Raw::Number(v) => Some(std::slice::from_ref(v)),
            Raw::Channels(v) => Some(v),
            _ => None,
        }
    }

    /// The word given for a choice of a model.
    #[must_use]
    pub fn word(&self, part: usize, name: &str) -> Option<&str> {
        let argument = self.material.parts[part].arguments.iter().find(|a| a.parameter.name == name)?;
        if let Raw::Word(word) = &argument.value { Some(word) } else { None }
    }

    /// The material with the open parameters set: for each one value, or one per band.
    ///
    /// # Panics
    /// Where there are fewer values than open parameters, or another number of them than bands.
    #[must_use]
    pub fn fill(&self, values: &[Vec<f64>], bands: Bands<'_>) -> Material {
        let raw = |values: &[f64]| match (values, bands) {
            ([one], _) => Raw::Number(*one),
            (many, Bands::Channels(n)) => {
                assert_eq!(many.len(), n, "one value per channel");
                Raw::Channels(many.to_vec())
            }
            (many, Bands::Wavelengths(nm)) => {
                assert_eq!(many.len(), nm.len(), "one value per wavelength");
                let mut pairs: Vec<[f64; 2]> = nm.iter().zip(many).map(|(x, y)| [*x, *y]).collect();
                pairs.sort_by(|a, b| a[0].total_cmp(&b[0]));
                Raw::Spectrum(pairs)
            }
        };
        let mut material = self.material.clone();
        let mut values = values.iter();
        let mut next = || raw(values.next().expect("a value for each open parameter"));
        for part in &mut material.parts {
            if let Raw::Open(_) = part.weight {
                part.weight = next();
            }
            for argument in part.arguments.iter_mut().filter(|a| matches!(a.value, Raw::Open(_))) {
                argument.value = next();
            }
        }
        material
    }
}

/// Opens what was not given. `bare`: the model stood without parentheses.
pub(super) fn complete(part: &mut Part, bare: bool) {
    let open = |p: &&'static Parameter| {
        let numeric = matches!(p.kind, Kind::Number | Kind::Spectral);
        let given = part.arguments.iter().any(|a| a.parameter.name == p.name);
        numeric && !given && (bare || p.default.is_none()) && customary(part, p.name)
    };
    let missing: Vec<&'static Parameter> = part.model.parameters.iter().filter(open).collect();
    let place = part.place;
    part.arguments.extend(missing.into_iter().map(|parameter| Argument { parameter, value: Raw::Open(None), place }));
}

/// Whether a parameter is meant where it is not named: of those that say the same thing one is.
fn customary(part: &Part, name: &str) -> bool {
    let given = |names: &[&str]| part.arguments.iter().any(|a| names.contains(&a.parameter.name));
    match name {
        "alpha" => !given(&["alpha_x", "alpha_y"]),
        "alpha_x" | "alpha_y" => given(&["alpha_x", "alpha_y"]),
        "nv" => false,
        // The models with an interface: Schlick's unless another one was named.
        "eta" | "k" | "reflectance" if has_interface(part.model) => false,
        "f0" if has_interface(part.model) => !given(&["medium", "eta", "reflectance"]),
        _ => true,
    }
}

fn has_interface(model: &Model) -> bool {
    model.parameters.iter().any(|p| p.kind == Kind::Medium)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn opened(text: &str) -> String {
        text.parse::<Template>().unwrap_or_else(|e| panic!("{text}: {e}")).to_string()
    }

    #[test]
    fn what_is_not_given_is_open() {
        for (text, expected) in [
            ("lambert", "lambert(reflectance=?)"),
            ("ggx", "ggx(alpha=?, f0=?)"),
            ("ggx()", "ggx(alpha=?, f0=?)"),
            ("ggx(eta=?1.5)", "ggx(eta=?1.5, alpha=?)"),
            ("ggx(medium=Au)", "ggx(medium=Au, alpha=?)"),
            ("ggx(alpha_x=?, reflectance=1)", "ggx(alpha_x=?, reflectance=1, alpha_y=?)"),
            ("ward", "ward(kd=?, ks=?, alpha=?)"),
            // With parentheses what has a default keeps it.
            ("ward(form=duer)", "ward(form=duer, ks=?, alpha=?)"),
            ("ashikhmin-shirley", "ashikhmin-shirley(rd=?, rs=?, nu=?)"),
            ("blinn", "blinn(n=?, f0=?)"),
            ("abc", "abc(kd=?, a=?, b=?, c=?, eta=?)"),
            ("?0.5*blinn-phong(ks=1) + lambert", "?0.5*blinn-phong(ks=1, n=?) + lambert(reflectance=?)"),
        ] {
            assert_eq!(opened(text), expected, "{text}");
        }
        assert_eq!("sgd".parse::<Template>().expect("all eleven").open().len(), 11);
    }

    #[test]
    fn values_fill_the_open_places() {
        let template: Template = "?*lambert(reflectance=1) + ggx(alpha=?)".parse().expect("a template");
        let names: Vec<&str> = template.open().iter().map(|o| o.parameter.name).collect();
        assert_eq!(names, ["weight", "alpha", "f0"]);
        let values = [vec![0.5], vec![0.1], vec![0.9, 0.8]];
        let filled = template.fill(&values, Bands::Channels(2));
        assert_eq!(filled.to_string(), "0.5*lambert(reflectance=1) + ggx(alpha=0.1, f0=[0.9, 0.8])");
        // Wavelengths in any order.
        let filled = template.fill(&values, Bands::Wavelengths(&[600.0, 500.0]));
        assert!(filled.to_string().ends_with("f0=[[500.0, 0.8], [600.0, 0.9]])"), "{filled}");
    }

    #[test]
    fn only_a_template_has_open_places() {
        let error = "lambert(reflectance=?)".parse::<Material>().expect_err("open").to_string();
        assert_eq!(error, "1:21: found `?`; expected a number, a word or a list");
        let error = "ggx(alpha=?, medium=?)".parse::<Template>().expect_err("a word").to_string();
        assert!(error.starts_with("1:21: found `?` for `medium`; expected the name of a substance"), "{error}");
        let error = "ggx(alpha=?2)".parse::<Template>().expect_err("outside").to_string();
        assert!(error.starts_with("1:11: `alpha` is 2; expected a number from 1e-6 to 1"), "{error}");
    }
}
