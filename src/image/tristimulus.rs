//! Plans for images that hold colours instead of spectra: RGB of stated primaries, XYZ, or luminance alone.
//!
//! | from | to | value |
//! |---|---|---|
//! | RGB, white luminance W | XYZ, luminance | W · (primaries' matrix of SMPTE RP 177) · linear RGB |
//! | RGB | RGB of another space | through XYZ, adapted from white to white (Bradford by default) where the whites differ |
//! | XYZ | RGB | the inverse matrix, not adapted: XYZ names no white |
//! | luminance | luminance | as it is |
//!
//! Whatever needs a spectrum (scotopic and α-opic quantities, other observers and efficiency functions) is refused. Without a
//! white luminance, by the file or by the user, results are relative to white and have no unit.

use glam::{DMat3, DVec3};

use super::description::{Description, Meaning, RgbSpace};
use super::kernel::Weights;
use super::plan::{Plan, PlanError, Settings, made_of};
use super::target::Target;
use crate::colorimetry::Observer;
use crate::colorimetry::adaptation::Transform;
use crate::colorimetry::chromaticity::xyz_of_xy;
use crate::colorimetry::rgb::{Encoding, Space, same_xy};
use crate::finding::{Checked, Finding, Severity};
use crate::photometry::luminous::{Efficacy, Efficiency};

/// What the planes of an image are.
#[derive(Debug, Clone, PartialEq)]
enum Planes {
    Rgb(RgbSpace),
    Xyz(Observer),
    Luminance(Efficiency),
}

impl Planes {
    /// The planes of an image and their channels; XYZ before RGB before luminance, where there are several.
    fn of(image: &Description) -> Option<(Self, Vec<usize>)> {
        let three = |meaning: fn(u8) -> Meaning| (0..3).map(|k| image.find(meaning(k))).collect::<Option<Vec<_>>>();
        // What a plan of ours has written says of what observer it is; anything else is of the CIE's of 1931 and 1924.
        let stated = image.attribute("photopic:target").and_then(|t| t.strip_suffix(')')?.split_once(" ("));
        if let Some(channels) = three(Meaning::Tristimulus) {
            let observer = stated.and_then(|(_, name)| name.parse().ok()).unwrap_or_default();
            return Some((Self::Xyz(observer), channels));
        }
        if let (Some(channels), Some(rgb)) = (three(Meaning::Primary), &image.rgb) {
            return Some((Self::Rgb(rgb.clone()), channels));
        }
        let efficiency = stated.and_then(|(_, name)| name.parse().ok()).unwrap_or_default();
        image.find(Meaning::Photopic).map(|channel| (Self::Luminance(efficiency), vec![channel]))
    }

    fn name(&self) -> String {
        match self {
            Self::Rgb(rgb) => format!("{} {}", if rgb.encoded { "encoded" } else { "linear" }, rgb.space.name),
            Self::Xyz(observer) => format!("XYZ ({observer})"),
            Self::Luminance(efficiency) => format!("luminance ({efficiency})"),
        }
    }

    /// Whether a target follows from the planes: false where it needs a spectrum.
    fn lead_to(&self, target: &Target) -> bool {
        match (self, target) {
            (Self::Rgb(_), Target::Xyz(observer)) => *observer == Observer::Cie1931,
            (Self::Xyz(own), Target::Xyz(observer)) => own == observer,
            (Self::Rgb(_), Target::Rgb { .. }) => true,
            (Self::Xyz(own), Target::Rgb { .. }) => *own == Observer::Cie1931,
            (Self::Rgb(_), Target::Luminance(efficiency)) => *efficiency == Efficiency::Cie1924,
            (Self::Xyz(own), Target::Luminance(efficiency)) => *efficiency == of_y(*own),
            (Self::Luminance(own), Target::Luminance(efficiency)) => own == efficiency,
            _ => false,
        }
    }

    /// Factor to an absolute unit, and that unit, as far as the file states them.
    fn unit(&self, image: &Description, first: usize) -> Option<(f64, String)> {
        let white = image.rgb.as_ref().and_then(|rgb| rgb.white_luminance);
        match (self, image.channels[first].unit.as_str()) {
            (Self::Rgb(_), _) | (_, "") => white.map(|white| (white, "cd/m²".to_owned())),
            (_, unit) => Some((1.0, unit.to_owned())),
        }
    }
}

/// The efficiency function that an observer's ȳ is.
fn of_y(observer: Observer) -> Efficiency {
    match observer {
        Observer::Cie1931 => Efficiency::Cie1924,
        Observer::Cie1964 => Efficiency::Cie1964,
        Observer::Cie2015Two => Efficiency::Cie2008Two,
        Observer::Cie2015Ten => Efficiency::Cie2008Ten,
    }
}

/// Compiles a conversion of an image without bands.
pub(super) fn plan(image: &Description, target: &Target, settings: &Settings) -> Result<Checked<Plan>, PlanError> {
    let Some((planes, channels)) = Planes::of(image) else {
        let channels = image.channels.iter().map(|c| c.name.as_str()).collect::<Vec<_>>().join(", ");
        return Err(PlanError::NoBands { channels });
    };
    if settings.illuminant.is_some() {
        return Err(PlanError::Illuminant);
    }
    if let Some(setting) = about_spectra(settings) {
        return Err(PlanError::AboutSpectra { setting, held: planes.name() });
    }
    if !planes.lead_to(target) {
        return Err(PlanError::NoSpectrum { held: planes.name(), target: target.to_string() });
    }
    let mut findings = Vec::new();
    let stated = planes.unit(image, channels[0]);
    let scale = Scale::new(&planes, stated, target, settings)?;
    if scale.unit.is_empty() {
        let message = format!("nobody states the luminance of white: {target} is relative to it");
        // RGB is looked at as it is; a luminance is taken for one.
        let severity = if matches!(target, Target::Rgb { .. }) { Severity::Info } else { Severity::Warning };
        findings.push(Finding::new("I100", severity, message).hint("say --white-luminance for cd/m²"));
    }
    let from = match &planes {
        Planes::Rgb(rgb) => Some(rgb.space),
        Planes::Xyz(_) | Planes::Luminance(_) => None,
    };
    let matrix = matrix(from, target, settings.adaptation)?;
    if let Some(message) = &matrix.adapted {
        findings.push(Finding::info("I101", message.clone()).hint("--adaptation none keeps X, Y, Z"));
    }
    let factor = scale.factor / scale.white;
    let rows = [matrix.value.row(0), matrix.value.row(1), matrix.value.row(2)].map(|row| (row * factor).to_array());
    let columns: Vec<Vec<f64>> = match target {
        _ if channels.len() == 1 => vec![vec![factor]],
        Target::Luminance(_) => vec![rows[1].to_vec()],
        _ => rows.iter().map(|row| row.to_vec()).collect(),
    };
    let unit = if matches!(target, Target::Rgb { .. }) { "" } else { scale.unit.as_str() };
    let mut description = made_of(image, target, unit);
    description.set_attribute("photopic:from", planes.name());
    if matrix.adapted.is_some() {
        description.set_attribute("photopic:adaptation", settings.adaptation.to_string());
    }
    let mut encoding = Encoding::Linear;
    if let Target::Rgb { space, encoded } = target {
        let white_luminance = (!scale.unit.is_empty()).then_some(scale.white);
        description.rgb = Some(RgbSpace { space: *space, encoded: *encoded, white_luminance });
        encoding = description.rgb.as_ref().map_or(encoding, RgbSpace::encoding);
    }
    if let Some(white) = settings.white_luminance {
        description.set_attribute("photopic:white_luminance_cd_per_m2", white.to_string());
    }
    let decoding = if let Planes::Rgb(rgb) = &planes { rgb.encoding() } else { Encoding::Linear };
    Ok(Checked { value: Plan { channels, decoding, weights: Weights::new(&columns), encoding, description }, findings })
}

/// The first setting that has no meaning here.
fn about_spectra(settings: &Settings) -> Option<&'static str> {
    let (rule, range) = (settings.contract.rule.is_some(), settings.contract.range_nm.is_some());
    let constants = settings.efficacy != Efficacy::default();
    [
        (rule, "the rule of integration"),
        (range, "the range of integration"),
        (settings.quantity.is_some(), "the quantity of the samples"),
        (settings.unit.is_some(), "the unit of the samples"),
        (constants, "the luminous efficacy"),
    ]
    .into_iter()
    .find_map(|(set, name)| set.then_some(name))
}

/// From the numbers that are read to units, and on to the white that comes out.
struct Scale {
    /// To `unit`.
    factor: f64,
    /// Empty for relative values.
    unit: String,
    /// What becomes 1 in RGB, in `unit`; 1 for other targets.
    white: f64,
}

impl Scale {
    fn new(
        planes: &Planes,
        stated: Option<(f64, String)>,
        target: &Target,
        settings: &Settings,
    ) -> Result<Self, PlanError> {
        let Target::Rgb { encoded, .. } = target else {
            let (factor, unit) = match (stated, settings.white_luminance) {
                (Some((_, unit)), Some(_)) => return Err(PlanError::WhiteStated { unit }),
                (Some(stated), None) => stated,
                (None, Some(white)) => (white, "cd/m²".to_owned()),
                (None, None) => (1.0, String::new()),
            };
            return Ok(Self { factor, unit, white: 1.0 });
        };
        Ok(match (stated, settings.white_luminance) {
            (Some((factor, unit)), Some(white)) => Self { factor, unit, white },
            // RGB keeps its white; X, Y, Z have none.
            (Some((factor, unit)), None) if matches!(planes, Planes::Rgb(_)) => Self { factor, unit, white: factor },
            (Some(_), None) if *encoded => return Err(PlanError::NoWhite),
            (Some((factor, unit)), None) => Self { factor, unit, white: 1.0 },
            (None, Some(white)) => Self { factor: white, unit: "cd/m²".to_owned(), white },
            (None, None) => Self { factor: 1.0, unit: String::new(), white: 1.0 },
        })
    }
}

/// A matrix, and how its white was adapted.
struct Matrix {
    value: DMat3,
    adapted: Option<String>,
}

/// From RGB of a space (or XYZ) to the target's three, both in units of their white.
fn matrix(from: Option<Space>, target: &Target, transform: Transform) -> Result<Matrix, PlanError> {
    let degenerate = |space: &Space| PlanError::Degenerate { space: space.name.to_owned() };
    let to = if let Target::Rgb { space, .. } = target { Some(*space) } else { None };
    let alike = |a: &Space, b: &Space| a.primaries == b.primaries && a.white == b.white;
    if let (Some(from), Some(to)) = (&from, &to)
        && alike(from, to)
    {
        return Ok(Matrix { value: DMat3::IDENTITY, adapted: None });
    }
    let mut out = Matrix { value: DMat3::IDENTITY, adapted: None };
    if let Some(from) = &from {
        out.value = from.to_xyz().ok_or_else(|| degenerate(from))?;
    }
    let Some(to) = &to else { return Ok(out) };
    if let Some(from) = &from
        && !same_xy(from.white, to.white)
        && transform != Transform::None
    {
        let white = |space: &Space| xyz_of_xy(space.white).ok_or_else(|| degenerate(space));
        out.value = transform.matrix(white(from)?, white(to)?).ok_or_else(|| degenerate(to))? * out.value;
        let message = format!(
            "white is adapted from that of {} ({}) to that of {} ({}) by {transform}, which changes X, Y, Z",
            from.name, from.white_name, to.name, to.white_name
        );
        out.adapted = Some(message);
    }
    out.value = to.from_xyz().ok_or_else(|| degenerate(to))? * out.value;
    Ok(out)
}

/// Luminance of linear RGB (1, 0, 0), (0, 1, 0), (0, 0, 1) of a space, relative to white. `None` for degenerate primaries.
#[must_use]
pub fn luminance_weights(space: &Space) -> Option<[f64; 3]> {
    space.to_xyz().map(|m| DVec3::to_array(&m.row(1)))
}
