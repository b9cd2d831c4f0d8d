//! Materials of a scene.

use schemars::JsonSchema;
use serde::Deserialize;
use toml::Spanned;

use super::spectrum::SpectrumSource;

/// A material; one of the kinds.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Material {
    /// Its name, which shapes and mixtures refer to.
    #[schemars(with = "String")]
    pub name: Spanned<String>,
    /// Diffuse (Lambertian) with this reflectance, 0 to 1.
    #[serde(default)]
    #[schemars(with = "Option<SpectrumSource>")]
    pub reflectance: Option<Spanned<SpectrumSource>>,
    /// A description as of `photopic brdf`: `"ggx(alpha=0.1, medium=Au)"`. What rough facets lose is lost.
    #[serde(default)]
    #[schemars(with = "Option<String>")]
    pub brdf: Option<Spanned<String>>,
    /// A measured table, as `photopic brdf` reads it. Where it tells nothing, its best guess; values below 0 are 0.
    #[serde(default)]
    #[schemars(with = "Option<Measured>")]
    pub measured: Option<Spanned<Measured>>,
    /// Metal, polished or rough; light that is scattered several times among its facets is kept.
    #[serde(default)]
    #[schemars(with = "Option<Metal>")]
    pub metal: Option<Spanned<Metal>>,
    /// A surface between two transparent substances: the substance is on the inside of the shape.
    #[serde(default)]
    #[schemars(with = "Option<Dielectric>")]
    pub dielectric: Option<Spanned<Dielectric>>,
    /// A pane of glass without thickness, with all reflections between its faces.
    #[serde(default)]
    #[schemars(with = "Option<Pane>")]
    pub pane: Option<Spanned<Pane>>,
    /// Shares of other materials, which stand before it.
    #[serde(default)]
    #[schemars(with = "Option<Vec<Share>>")]
    pub mixture: Option<Spanned<Vec<Share>>>,
    /// A fluorescent diffuser.
    #[serde(default)]
    #[schemars(with = "Option<Dye>")]
    pub dye: Option<Spanned<Dye>>,
    /// Fields like those of a chessboard, whose factors multiply what the material scatters.
    #[serde(default)]
    #[schemars(with = "Option<Checkerboard>")]
    pub checkerboard: Option<Spanned<Checkerboard>>,
    /// A picture over the shape's texture coordinates, whose factors multiply what the material scatters.
    #[serde(default)]
    #[schemars(with = "Option<Texture>")]
    pub texture: Option<Spanned<Texture>>,
    /// Dark from the inside of shapes (reflectance, brdf, measured, dye); otherwise both sides are alike.
    #[serde(default)]
    pub one_sided: bool,
}

/// A measured table.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Measured {
    /// Beside the scene: MERL, RGL, UTIA, ASTM, Zemax, Klems, ALTA or CSV; its channels are wavelengths, red, green and blue (linear sRGB), or one alone.
    pub file: String,
}

/// Metal.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Metal {
    /// Its name: Ag, Al, Au, Cu.
    pub medium: String,
    /// Roughness of its facets (GGX), 1e-6 to 1; polished without it.
    #[serde(default)]
    pub alpha: Option<f64>,
}

/// A transparent substance; one of the ways to say its refractive index.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Dielectric {
    /// Its name: BK7, SF10, water.
    #[serde(default)]
    pub medium: Option<String>,
    /// Its refractive index.
    #[serde(default)]
    #[schemars(with = "Option<SpectrumSource>")]
    pub index: Option<Spanned<SpectrumSource>>,
    /// Sellmeier's formula: n² = 1 + Σ b λ²/(λ² − c), λ in µm.
    #[serde(default)]
    pub sellmeier: Option<Sellmeier>,
    /// Cauchy's formula: n = A + B/λ² + C/λ⁴, λ in µm.
    #[serde(default)]
    pub cauchy: Option<[f64; 3]>,
    /// The index of what is outside; 1 without it.
    #[serde(default)]
    #[schemars(with = "Option<SpectrumSource>")]
    pub outside: Option<Spanned<SpectrumSource>>,
    /// Roughness of its facets (GGX); polished without it.
    #[serde(default)]
    pub alpha: Option<f64>,
}

/// The terms of Sellmeier's formula.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Sellmeier {
    /// b of every term.
    pub b: Vec<f64>,
    /// c of every term, µm².
    pub c_um2: Vec<f64>,
}

/// A pane; one of the ways to say its refractive index.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Pane {
    /// The name of its substance: BK7, SF10, water.
    #[serde(default)]
    pub medium: Option<String>,
    /// Its refractive index.
    #[serde(default)]
    #[schemars(with = "Option<SpectrumSource>")]
    pub index: Option<Spanned<SpectrumSource>>,
    /// Internal transmittance along the normal; 1 without it.
    #[serde(default)]
    #[schemars(with = "Option<SpectrumSource>")]
    pub transmittance: Option<Spanned<SpectrumSource>>,
}

/// A material's share of a mixture.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Share {
    /// Its name.
    #[schemars(with = "String")]
    pub material: Spanned<String>,
    /// Its share, 0 to 1; all of them at most 1.
    #[schemars(with = "SpectrumSource")]
    pub share: Spanned<SpectrumSource>,
}

/// A fluorescent diffuser with one dye.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Dye {
    /// Reflectance without the dye's light.
    #[schemars(with = "SpectrumSource")]
    pub reflectance: Spanned<SpectrumSource>,
    /// Share of the light that the dye absorbs.
    #[schemars(with = "SpectrumSource")]
    pub absorption: Spanned<SpectrumSource>,
    /// Its emission spectrum, relative, in power per nm.
    #[schemars(with = "SpectrumSource")]
    pub emission: Spanned<SpectrumSource>,
    /// Photons emitted per photon absorbed, 0 to 1.
    pub quantum_yield: f64,
}

/// A chessboard.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Checkerboard {
    /// Factor of the field at the shape's origin, 0 to 1.
    #[schemars(with = "SpectrumSource")]
    pub even: Spanned<SpectrumSource>,
    /// Factor of its neighbours, 0 to 1.
    #[schemars(with = "SpectrumSource")]
    pub odd: Spanned<SpectrumSource>,
    /// Fields along both texture coordinates.
    pub fields: [u32; 2],
}

/// A picture of factors, 0 to 1.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Texture {
    /// A picture, beside the scene: a spectral one of reflectances, or one in colours, whose pixels are those of a surface under D65.
    pub file: String,
    /// How often it is repeated along both texture coordinates; once without it.
    #[serde(default)]
    pub repeat: Option<[f64; 2]>,
}
