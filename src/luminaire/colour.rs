//! Colour over angle: what angular spectra look like from each direction.

use crate::colorimetry::cct::Cct;
use crate::conversion::Conversion;

/// Directions below this part of the peak luminous intensity do not count for the nonuniformity: their light is too little to
/// be seen, and mostly noise.
pub const COUNTED_FROM: f64 = 0.1;

/// How the nonuniformity is defined.
pub const DEFINITION: &str = "distance in (u′, v′) from the chromaticity of the flux (tristimulus values integrated over the sphere), over the tabulated directions of at least 10 % of the peak luminous intensity: largest (CIE S 025, IES LM-79), and root mean square weighted with the flux";

/// The colour in one direction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DirectionColour {
    /// Correlated colour temperature and Duv, where defined.
    pub cct: Option<Cct>,
    /// u′, v′ (CIE 1931 observer, or the one chosen).
    pub uv_prime: [f64; 2],
    /// Distance from the chromaticity of the flux.
    pub delta_uv_prime: f64,
    /// sRGB components 0 to 1, as bright as a display can show the colour.
    pub srgb: Option<[f64; 3]>,
    /// Whether the direction counts for the nonuniformity.
    pub counted: bool,
}

/// Colour by direction, and how far it departs from that of the whole.
#[derive(Debug, Clone, PartialEq)]
pub struct ColourOverAngle {
    /// u′, v′ of the flux.
    pub mean_uv_prime: [f64; 2],
    /// Largest Δu′v′ of the directions counted.
    pub max_delta_uv_prime: f64,
    /// Index of its direction.
    pub max_direction: usize,
    /// Root mean square of Δu′v′, weighted with the luminous flux that the directions stand for.
    pub rms_delta_uv_prime: f64,
    /// Lowest and highest colour temperature of the directions counted, K.
    pub cct_range_k: Option<(f64, f64)>,
    /// One per tabulated direction; `None` where there is no light.
    pub directions: Vec<Option<DirectionColour>>,
}

impl ColourOverAngle {
    /// Number of directions with light but without a colour temperature.
    #[must_use]
    pub fn without_temperature(&self) -> usize {
        self.directions.iter().flatten().filter(|d| d.cct.is_none()).count()
    }
}

/// The colours of conversions, one per direction, beside that of the flux; `solid_angles_sr` is what each direction stands for.
/// `None` where the flux has no colour.
pub(super) fn over_angle(
    conversions: &[Conversion],
    flux: &Conversion,
    solid_angles_sr: &[f64],
) -> Option<ColourOverAngle> {
    let mean = flux.uv_prime?;
    let candela: Vec<f64> = conversions.iter().map(|c| c.absolute.first().map_or(0.0, |f| f.photopic)).collect();
    let peak = candela.iter().copied().fold(0.0, f64::max);
    let directions: Vec<Option<DirectionColour>> = (conversions.iter().zip(&candela))
        .map(|(c, cd)| {
            let uv_prime = c.uv_prime?;
            Some(DirectionColour {
                cct: c.cct,
                uv_prime,
                delta_uv_prime: (uv_prime[0] - mean[0]).hypot(uv_prime[1] - mean[1]),
                srgb: c.rgb.iter().find(|f| f.key == "srgb").map(|f| f.colour.encoded),
                counted: *cd >= COUNTED_FROM * peak,
            })
        })
        .collect();
    let counted = || (directions.iter().enumerate()).filter_map(|(i, d)| Some((i, d.filter(|d| d.counted)?)));
    let mut out = ColourOverAngle {
        mean_uv_prime: mean,
        max_delta_uv_prime: 0.0,
        max_direction: counted().next()?.0,
        rms_delta_uv_prime: 0.0,
        cct_range_k: None,
        directions: Vec::new(),
    };
    let (mut squares, mut weights) = (0.0, 0.0);
    for (i, d) in counted() {
        if d.delta_uv_prime > out.max_delta_uv_prime {
            (out.max_delta_uv_prime, out.max_direction) = (d.delta_uv_prime, i);
        }
        let weight = candela[i] * solid_angles_sr[i];
        squares += weight * d.delta_uv_prime * d.delta_uv_prime;
        weights += weight;
        if let Some(kelvin) = d.cct.map(|c| c.kelvin) {
            let (low, high) = out.cct_range_k.unwrap_or((kelvin, kelvin));
            out.cct_range_k = Some((low.min(kelvin), high.max(kelvin)));
        }
    }
    out.rms_delta_uv_prime = if weights > 0.0 { (squares / weights).sqrt() } else { 0.0 };
    Some(ColourOverAngle { directions, ..out })
}
