//! From the bands of an image and a target to one weight per band: everything that a conversion decides before the first pixel.

use glam::{DMat3, DVec3};

use super::description::{Channel, Content, Description, Meaning, RgbSpace};
use super::kernel::Weights;
use super::target::Target;
use crate::colorimetry::adaptation::Transform;
use crate::colorimetry::chromaticity::xyz_of_xy;
use crate::colorimetry::rgb::Encoding;
use crate::colorimetry::{Observer, rgb};
use crate::finding::{Checked, Finding, Location};
use crate::photometry::alpha_opic;
use crate::photometry::luminous::{Efficacy, Efficiency, scotopic};
use crate::spectrum::format::Scale;
use crate::spectrum::integrate::{Contract, RuleError, Weighting, dot, weights};
use crate::spectrum::{self, Grid, Quantity, Sampling, SpectralUnit, Spectrum};

/// Everything that decides a value, beside the target.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Settings {
    /// Rule and range of integration.
    pub contract: Contract,
    /// K_m and K′_m.
    pub efficacy: Efficacy,
    /// The user's word on the quantity.
    pub quantity: Option<Quantity>,
    /// The user's word on the unit of the samples.
    pub unit: Option<SpectralUnit>,
    /// Light that falls on a reflectance image, by name, relative or not: only its shape counts.
    pub illuminant: Option<(String, Spectrum)>,
    /// Luminance, cd/m²: of RGB (1, 1, 1) for light, and of 1 in planes whose file does not state it; of the perfect diffuser for
    /// reflectance.
    pub white_luminance: Option<f64>,
    /// Adaptation of RGB from the illuminant of a reflectance image, or the white of another space, to the white of the space.
    pub adaptation: Transform,
}

/// Why an image cannot be converted to a target.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PlanError {
    /// There is nothing in it that could be converted.
    #[error(
        "the image has neither spectral bands nor RGB, XYZ or luminance (its channels are {channels}); expected one of them"
    )]
    NoBands {
        /// The channels there are.
        channels: String,
    },
    /// The bands make no grid.
    #[error("the bands do not make a spectrum: {0}")]
    Grid(#[source] spectrum::Error),
    /// All bands lie outside of the weighting.
    #[error("the bands ({low_nm}–{high_nm} nm) lie outside of the weighting for {target}; expected bands inside it")]
    Outside {
        /// First band.
        low_nm: f64,
        /// Last band.
        high_nm: f64,
        /// What was asked for.
        target: String,
    },
    /// The rule does not fit.
    #[error(transparent)]
    Rule(#[from] RuleError),
    /// Quantity and unit do not fit.
    #[error(transparent)]
    Unit(#[from] spectrum::format::Error),
    /// Reflectance without light on it.
    #[error(
        "the image is one of reflectance, which has no {target} by itself; expected an illuminant (--illuminant D65)"
    )]
    NoIlluminant {
        /// What was asked for.
        target: String,
    },
    /// Light on light.
    #[error("the image is one of light and takes no illuminant; expected one of reflectance")]
    Illuminant,
    /// The illuminant has nothing where it is looked at.
    #[error("the illuminant {name} has no luminous content at the image's bands; expected one that has")]
    Dark {
        /// The illuminant.
        name: String,
    },
    /// Colours have lost the spectrum that the target needs.
    #[error(
        "the image holds {held}, from which {target} does not follow: lights of the same colour differ in it; expected a \
         spectral image"
    )]
    NoSpectrum {
        /// What the planes are.
        held: String,
        /// What was asked for.
        target: String,
    },
    /// A setting that is about spectra, for an image that has none.
    #[error("{setting} is about spectra, and the image holds {held}; expected a spectral image, or no such setting")]
    AboutSpectra {
        /// What was set.
        setting: &'static str,
        /// What the planes are.
        held: String,
    },
    /// The user's white luminance for planes whose unit the file states.
    #[error("the image is in {unit} already; expected a white luminance only for RGB, or for an image without units")]
    WhiteStated {
        /// The unit.
        unit: String,
    },
    /// Encoded values need a white.
    #[error(
        "encoded RGB of light needs the luminance that becomes white; expected --white-luminance (cd/m²), or linear RGB"
    )]
    NoWhite,
    /// The primaries or whites are degenerate.
    #[error("no matrix from XYZ to {space}; expected proper primaries and whites")]
    Degenerate {
        /// The space.
        space: String,
    },
}

/// A conversion compiled for one image.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    /// The channels that are read: those with a weight.
    pub(super) channels: Vec<usize>,
    /// The curve of the samples that are read.
    pub(super) decoding: Encoding,
    pub(super) weights: Weights,
    pub(super) encoding: Encoding,
    /// The image that comes out.
    pub(super) description: Description,
}

/// How the samples of a band become the integrand.
struct Integrand {
    grid: std::sync::Arc<Grid>,
    sampling: Sampling,
    contract: Contract,
    /// To SI per nm, per band.
    factors: Vec<f64>,
    /// The light on a reflectance.
    light: Option<Weighting>,
}

impl Integrand {
    /// ∫ S w dλ as one weight per band.
    fn column(&self, weighting: &Weighting, contract: &Contract) -> Result<Vec<f64>, RuleError> {
        let lit = self.light.as_ref().map(|light| product(weighting, light));
        let column = weights(&self.grid, self.sampling, lit.as_ref().unwrap_or(weighting), contract)?;
        Ok(column.iter().zip(&self.factors).map(|(w, f)| w * f).collect())
    }
}

/// The product of two weightings, straight lines between all entries of both.
fn product(a: &Weighting, b: &Weighting) -> Weighting {
    let (low, high) = (a.range_nm().0.max(b.range_nm().0), a.range_nm().1.min(b.range_nm().1));
    let mut x: Vec<f64> =
        a.wavelengths_nm().iter().chain(b.wavelengths_nm()).copied().filter(|w| (low..=high).contains(w)).collect();
    x.sort_by(f64::total_cmp);
    x.dedup();
    if x.len() < 2 {
        return Weighting::table(vec![low, low + 1.0], vec![0.0, 0.0]);
    }
    let y = x.iter().map(|w| a.at(*w) * b.at(*w)).collect::<Vec<_>>();
    Weighting::table(x, y)
}

impl Plan {
    /// Compiles a conversion of an image to a target.
    ///
    /// | image | value |
    /// |---|---|
    /// | light | K ∫ S w dλ in the quantity's own unit: cd/m² for radiance, lx for irradiance |
    /// | reflectance | ∫ ρ S w dλ / ∫ S ȳ dλ under the illuminant S, same rule and grid for both: the perfect diffuser has Y = 1, or the white luminance where given |
    ///
    /// Every figure of light is the one that [`crate::conversion`] gives for the pixel's spectrum under the same contract.
    ///
    /// An image without bands that has RGB, XYZ or luminance is converted by its primaries: [`super::tristimulus`].
    ///
    /// # Errors
    /// [`PlanError`].
    pub fn new(image: &Description, target: &Target, settings: &Settings) -> Result<Checked<Self>, PlanError> {
        let bands = image.bands();
        let stated = match (&image.content, bands.is_empty()) {
            (Content::Light { quantity, unit }, false) => Some((*quantity, unit.as_ref())),
            (Content::Reflectance, false) => None,
            _ => return super::tristimulus::plan(image, target, settings),
        };
        let grid = image.grid().map_err(PlanError::Grid)?;
        let mut findings = Vec::new();
        let mut quantity = None;
        let integrand = match stated {
            Some(stated) => {
                if settings.illuminant.is_some() {
                    return Err(PlanError::Illuminant);
                }
                let asked = (settings.quantity, settings.unit.as_ref());
                let scale = Scale::new(stated, asked, grid.len(), &Location::default())?;
                findings.extend(scale.findings);
                let Scale { quantity: of, unit, sampling } = scale.value;
                quantity = Some(of);
                let factor = |w: &f64| unit.as_ref().map_or(1.0, |u| u.to_si(*w, 1.0));
                let factors = grid.wavelengths_nm().iter().map(factor).collect();
                Integrand { grid, sampling, contract: settings.contract, factors, light: None }
            }
            None => Self::lit(grid, target, settings)?,
        };
        let mut columns = columns(target, &integrand, settings)?;
        if columns.iter().flatten().all(|w| *w == 0.0) {
            let (low_nm, high_nm) = integrand.grid.range_nm();
            return Err(PlanError::Outside { low_nm, high_nm, target: target.to_string() });
        }
        findings.extend(coverage(target, &integrand));
        // Bands without weight are not read at all.
        let used: Vec<usize> = (0..bands.len()).filter(|i| columns.iter().any(|c| c[*i] != 0.0)).collect();
        for column in &mut columns {
            *column = used.iter().map(|i| column[*i]).collect();
        }
        let encoding = match target {
            Target::Rgb { space, encoded: true } => space.encoding,
            _ => Encoding::Linear,
        };
        let plan = Self {
            channels: used.iter().map(|i| bands[*i].0).collect(),
            decoding: Encoding::Linear,
            weights: Weights::new(&columns),
            encoding,
            description: output(image, target, settings, quantity, &integrand)?,
        };
        Ok(Checked { value: plan, findings })
    }

    /// The integrand of reflectance under the illuminant, scaled so that the perfect diffuser comes out as white.
    fn lit(grid: std::sync::Arc<Grid>, target: &Target, settings: &Settings) -> Result<Integrand, PlanError> {
        let Some((name, light)) = &settings.illuminant else {
            return Err(PlanError::NoIlluminant { target: target.to_string() });
        };
        let light = Weighting::table(light.wavelengths_nm().to_vec(), light.values().to_vec());
        let ones = vec![1.0; grid.len()];
        let mut integrand = Integrand {
            grid,
            sampling: Sampling::Density,
            contract: settings.contract,
            factors: ones.clone(),
            light: Some(light),
        };
        let [_, y, _] = colour_matching(target).colour_matching_functions();
        let white = dot(&integrand.column(&y, &settings.contract)?, &ones);
        let scale = settings.white_luminance.unwrap_or(1.0) / white;
        if !(white > 0.0 && scale.is_finite()) {
            return Err(PlanError::Dark { name: name.clone() });
        }
        integrand.factors.fill(scale);
        Ok(integrand)
    }

    /// Converts one row: the samples of [`Plan::channels`] one channel after the other, to one plane after the other.
    ///
    /// # Panics
    /// Where `row` or `out` is too short.
    #[expect(clippy::cast_possible_truncation, reason = "pixels are f32")]
    pub fn row(&self, row: &[f32], width: usize, out: &mut [f32]) {
        if self.decoding == Encoding::Linear {
            self.weights.apply(row, width, out, width);
        } else {
            let linear: Vec<f32> = row.iter().map(|v| self.decoding.decode(f64::from(*v)) as f32).collect();
            self.weights.apply(&linear, width, out, width);
        }
        if self.encoding != Encoding::Linear {
            out.iter_mut().for_each(|v| *v = self.encoding.encode(f64::from(*v)) as f32);
        }
    }

    /// The image that comes out, without its pixels.
    #[must_use]
    pub fn description(&self) -> &Description {
        &self.description
    }

    /// Numbers of the channels that are read; the others have no weight.
    #[must_use]
    pub fn channels(&self) -> &[usize] {
        &self.channels
    }
}

/// The observer whose ȳ sets the scale of a reflectance image.
fn colour_matching(target: &Target) -> Observer {
    match target {
        Target::Xyz(observer) => *observer,
        _ => Observer::Cie1931,
    }
}

/// One column of weights per plane of the target.
fn columns(target: &Target, integrand: &Integrand, settings: &Settings) -> Result<Vec<Vec<f64>>, PlanError> {
    let lit = integrand.light.is_some();
    // A reflectance image has its scale in the factors already.
    let scaled = |k: f64, w: Weighting| if lit { w } else { w.scaled(k) };
    let contract = &integrand.contract;
    let k_m = settings.efficacy.k_m;
    let one = |w: Weighting| integrand.column(&w, contract).map(|c| vec![c]);
    Ok(match target {
        Target::Luminance(efficiency) => one(scaled(k_m, efficiency.weighting()))?,
        Target::Scotopic => one(scaled(settings.efficacy.k_m_scotopic, scotopic()))?,
        Target::Weighting { weighting, .. } => one(weighting.clone())?,
        Target::AlphaOpic { receptor, equivalent_daylight } => {
            let daylight = if *equivalent_daylight { alpha_opic::daylight_efficacies()[*receptor] } else { 1.0 };
            let action = alpha_opic::action_spectra()[*receptor].scaled(1.0 / daylight);
            vec![integrand.column(&action, &alpha_opic::within_range(contract))?]
        }
        Target::Xyz(observer) => {
            let functions = observer.colour_matching_functions();
            functions.into_iter().map(|w| integrand.column(&scaled(k_m, w), contract)).collect::<Result<_, _>>()?
        }
        Target::Rgb { space, encoded } => {
            let white = match (settings.white_luminance, lit) {
                (Some(white), _) => white,
                (None, true) => 1.0,
                (None, false) if *encoded => return Err(PlanError::NoWhite),
                (None, false) => 1.0,
            };
            let [x, y, z] =
                Observer::Cie1931.colour_matching_functions().map(|w| integrand.column(&scaled(k_m, w), contract));
            let (x, y, z) = (x?, y?, z?);
            let degenerate = || PlanError::Degenerate { space: space.name.to_owned() };
            let mut matrix = space.from_xyz().ok_or_else(degenerate)?;
            if lit {
                let white: DVec3 = [&x, &y, &z].map(|c| c.iter().sum::<f64>()).into();
                matrix *= adaptation(white / white.y, space, settings.adaptation).ok_or_else(degenerate)?;
            }
            let rgb: Vec<DVec3> =
                x.iter().zip(&y).zip(&z).map(|((x, y), z)| matrix * DVec3::new(*x, *y, *z) / white).collect();
            (0..3).map(|k| rgb.iter().map(|c| c[k]).collect()).collect()
        }
    })
}

fn adaptation(white: DVec3, space: &rgb::Space, transform: Transform) -> Option<DMat3> {
    transform.matrix(white.to_array(), xyz_of_xy(space.white)?)
}

/// Says so where the bands end inside the range of a weighting.
fn coverage(target: &Target, integrand: &Integrand) -> Option<Finding> {
    let (low, high) = match target {
        Target::Luminance(efficiency) => efficiency.weighting().range_nm(),
        Target::Scotopic => scotopic().range_nm(),
        Target::Xyz(observer) => observer.colour_matching_functions()[0].range_nm(),
        Target::Rgb { .. } => Efficiency::Cie1924.weighting().range_nm(),
        Target::AlphaOpic { .. } => alpha_opic::RANGE_NM,
        Target::Weighting { weighting, .. } => weighting.range_nm(),
    };
    let (first, last) = integrand.grid.range_nm();
    if integrand.sampling != Sampling::Density || (first <= low && last >= high) {
        return None;
    }
    let message = format!(
        "the bands cover {first}–{last} nm of the {low}–{high} nm of the weighting for {target}; nothing is added for the rest"
    );
    Some(Finding::info("I010", message))
}

/// Attributes that speak of the samples that were read, and not of those that come out.
const OF_SAMPLES: [&str; 6] = [
    "spectralLayoutVersion",
    "emissiveUnits",
    "polarisationHandedness",
    "photopic:samples_unit",
    "photopic:unit",
    "photopic:white_luminance_cd_per_m2",
];

/// The image of other channels that a conversion to a target makes: with all attributes that still hold.
pub(super) fn made_of(image: &Description, target: &Target, unit: &str) -> Description {
    let meaning = |k: u8| match target {
        Target::Luminance(_) => Meaning::Photopic,
        Target::Xyz(_) => Meaning::Tristimulus(k),
        Target::Rgb { .. } => Meaning::Primary(k),
        Target::Scotopic | Target::AlphaOpic { .. } | Target::Weighting { .. } => Meaning::Weighted,
    };
    let channels = (0..).zip(target.channel_names()).map(|(k, name)| Channel::new(name, unit, meaning(k))).collect();
    let mut out = Description::planes(image.width, image.height, channels);
    out.attributes.extend(image.attributes.iter().filter(|(name, _)| !OF_SAMPLES.contains(&name.as_str())).cloned());
    out.set_attribute("photopic:version", env!("CARGO_PKG_VERSION"));
    out.set_attribute("photopic:target", target.to_string());
    out
}

/// The image that comes out: channels with units, and the contract as attributes.
fn output(
    image: &Description,
    target: &Target,
    settings: &Settings,
    quantity: Option<Quantity>,
    integrand: &Integrand,
) -> Result<Description, PlanError> {
    let mut out = made_of(image, target, &unit(target, settings, quantity));
    if let Target::Rgb { space, encoded } = target {
        let white = match quantity {
            Some(Quantity::Relative) => None,
            Some(_) => Some(settings.white_luminance.unwrap_or(1.0)),
            None => settings.white_luminance,
        };
        out.rgb = Some(RgbSpace { space: *space, encoded: *encoded, white_luminance: white });
    }
    let contract = &integrand.contract;
    let (first, last) = integrand.grid.range_nm();
    let (low, high) = contract.range_nm.unwrap_or((first, last));
    let mut set = |name: &str, value: String| out.set_attribute(&format!("photopic:{name}"), value);
    set("rule", contract.rule_on(&integrand.grid, integrand.sampling)?.word().to_owned());
    set("range_nm", format!("{}-{}", first.max(low), last.min(high)));
    if let Some(step) = integrand.grid.step_nm() {
        set("step_nm", step.to_string());
    }
    set("bands", integrand.grid.len().to_string());
    match (quantity, &settings.illuminant) {
        (Some(quantity), _) => set("quantity", quantity.to_string()),
        (None, Some((name, _))) => set("illuminant", name.clone()),
        (None, None) => {}
    }
    match target {
        Target::Luminance(_) | Target::Xyz(_) | Target::Rgb { .. } if quantity.is_some() => {
            set("k_m_lm_per_w", settings.efficacy.k_m.to_string());
        }
        Target::Scotopic if quantity.is_some() => {
            set("k_m_scotopic_lm_per_w", settings.efficacy.k_m_scotopic.to_string());
        }
        _ => {}
    }
    if let Some(white) = settings.white_luminance {
        set("white_luminance_cd_per_m2", white.to_string());
    }
    Ok(out)
}

/// Unit of the planes; empty where they are relative.
fn unit(target: &Target, settings: &Settings, quantity: Option<Quantity>) -> String {
    let Some(quantity) = quantity else {
        return if settings.white_luminance.is_some() { "cd/m²".to_owned() } else { String::new() };
    };
    match target {
        Target::Luminance(_) | Target::Scotopic | Target::Xyz(_) => quantity.luminous_unit(),
        Target::AlphaOpic { equivalent_daylight: true, .. } => quantity.luminous_unit(),
        Target::AlphaOpic { .. } | Target::Weighting { .. } => quantity.unit(),
        Target::Rgb { .. } => "",
    }
    .to_owned()
}
