//! The lights, and what tells their strength: an evenly lit field, a diffuse sphere of known reflectance.

use schemars::JsonSchema;
use serde::Deserialize;

/// A light: near with `position_m`, or distant with `direction`.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(try_from = "Stated")]
pub struct Light {
    /// The name that stacks use.
    pub name: String,
    /// Where it is.
    pub place: Place,
    /// Radiant intensity (near), W/sr, or irradiance of a surface that faces it (distant), W/m²; per band or one for all.
    pub strength: Option<Vec<f64>>,
    /// Of a near light that does not shine alike to all sides: its strength is that along its axis then.
    pub lamp: Option<Lamp>,
}

/// A photometric file, and how the lamp is turned.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Lamp {
    /// An LM-63, EULUMDAT or TM-33 file. Without a stated intensity its own are used, in its unit.
    pub file: String,
    /// A point on its axis (γ = 0), m.
    pub aim_m: [f64; 3],
    /// Towards C0; of lamps that are the same all around their axis it is not needed.
    #[serde(default)]
    pub c0: Option<[f64; 3]>,
}

/// Where a light is.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize, JsonSchema)]
pub enum Place {
    /// A point, m.
    Near([f64; 3]),
    /// Towards it.
    Distant([f64; 3]),
}

/// A light in words.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Stated {
    /// The name that stacks use.
    name: String,
    /// Where a near light is, m.
    #[serde(default)]
    position_m: Option<[f64; 3]>,
    /// Towards a distant light.
    #[serde(default)]
    direction: Option<[f64; 3]>,
    /// Radiant intensity of a near light, W/sr, per band (rising wavelengths) or one for all.
    #[serde(default)]
    intensity_w_per_sr: Option<PerBand>,
    /// Irradiance of a surface that faces a distant light, W/m², per band or one for all.
    #[serde(default)]
    irradiance_w_per_m2: Option<PerBand>,
    /// Of a near light: a photometric file and how the lamp is turned; `intensity_w_per_sr` is that along its axis then.
    #[serde(default)]
    lamp: Option<Lamp>,
}

/// One number, or one per band.
#[derive(Deserialize, JsonSchema)]
#[serde(untagged, expecting = "expected a number, or a list of numbers, one per band")]
enum PerBand {
    One(f64),
    Each(Vec<f64>),
}

impl From<PerBand> for Vec<f64> {
    fn from(value: PerBand) -> Self {
        match value {
            PerBand::One(v) => vec![v],
            PerBand::Each(all) => all,
        }
    }
}

impl TryFrom<Stated> for Light {
    type Error = String;

    fn try_from(s: Stated) -> Result<Self, String> {
        let (place, strength) = match (s.position_m, s.direction) {
            (Some(p), None) if s.irradiance_w_per_m2.is_none() => (Place::Near(p), s.intensity_w_per_sr),
            (None, Some(d)) if s.intensity_w_per_sr.is_none() => (Place::Distant(d), s.irradiance_w_per_m2),
            _ => {
                return Err(format!(
                    "light `{}`; expected `position_m` with `intensity_w_per_sr`, or `direction` with `irradiance_w_per_m2`",
                    s.name
                ));
            }
        };
        let (Place::Near(v) | Place::Distant(v)) = place;
        if !v.iter().all(|v| v.is_finite()) || place == Place::Distant([0.0; 3]) {
            return Err(format!(
                "light `{}` at {v:?}; expected finite numbers, and a direction of some length",
                s.name
            ));
        }
        let strength = strength.map(Vec::from);
        if strength.as_ref().is_some_and(|s| s.is_empty() || s.iter().any(|v| !(*v > 0.0 && v.is_finite()))) {
            return Err(format!("light `{}` with a strength of {strength:?}; expected numbers above 0", s.name));
        }
        if s.lamp.is_some() && matches!(place, Place::Distant(_)) {
            return Err(format!("light `{}` with `lamp` and `direction`; expected `position_m` of the lamp", s.name));
        }
        if s.lamp.iter().flat_map(|l| l.aim_m.iter().chain(l.c0.iter().flatten())).any(|v| !v.is_finite()) {
            return Err(format!("light `{}` with a `lamp` turned to no number; expected finite numbers", s.name));
        }
        Ok(Self { name: s.name, place, strength, lamp: s.lamp })
    }
}

/// The evenly lit field that stacks with shows = "flat" show.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(try_from = "StatedFlat")]
pub struct Flat {
    /// Its radiance at the middle of the picture, W/(m² sr), per band or one for all.
    pub radiance: Vec<f64>,
}

/// The same in words.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct StatedFlat {
    /// Its radiance at the middle of the picture, W/(m² sr), per band or one for all.
    radiance_w_per_m2_sr: PerBand,
}

impl TryFrom<StatedFlat> for Flat {
    type Error = String;

    fn try_from(s: StatedFlat) -> Result<Self, String> {
        let radiance = Vec::from(s.radiance_w_per_m2_sr);
        if radiance.is_empty() || radiance.iter().any(|r| !(*r > 0.0 && r.is_finite())) {
            return Err(format!("a radiance of {radiance:?}; expected numbers above 0"));
        }
        Ok(Self { radiance })
    }
}

/// A diffuse sphere in the place of the object.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(try_from = "StatedReference")]
pub struct Reference {
    /// Its reflectance, per band or one for all.
    pub reflectance: Vec<f64>,
    /// Standard uncertainty of the reflectance, as many numbers; 0 where none was stated.
    pub reflectance_sd: Vec<f64>,
}

/// The same in words.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct StatedReference {
    /// Its reflectance, above 0 to 1, per band or one for all.
    reflectance: PerBand,
    /// Standard uncertainty (k = 1) of the reflectance, as its certificate states it, per band or one for all.
    #[serde(default)]
    reflectance_sd: Option<PerBand>,
}

impl TryFrom<StatedReference> for Reference {
    type Error = String;

    fn try_from(s: StatedReference) -> Result<Self, String> {
        let reflectance = Vec::from(s.reflectance);
        if reflectance.is_empty() || reflectance.iter().any(|r| !(*r > 0.0 && *r <= 1.0)) {
            return Err(format!("a reflectance of {reflectance:?}; expected numbers above 0 to 1"));
        }
        let mut reflectance_sd = s.reflectance_sd.map_or_else(|| vec![0.0], Vec::from);
        if reflectance_sd.len() == 1 {
            reflectance_sd = vec![reflectance_sd[0]; reflectance.len()];
        }
        let sound = reflectance_sd.len() == reflectance.len() && reflectance_sd.iter().all(|u| (0.0..1.0).contains(u));
        if !sound {
            return Err(format!(
                "a `reflectance_sd` of {reflectance_sd:?}; expected numbers from 0 to below 1, one or as many as reflectances"
            ));
        }
        Ok(Self { reflectance, reflectance_sd })
    }
}
