//! RGB spaces: linear components of XYZ, and what a display can show of them.

use glam::{DMat3, DVec3};
use serde::Serialize;

use super::adaptation::Transform;
use super::chromaticity::xyz_of_xy;

/// The curve between linear light and the stored value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Encoding {
    /// IEC 61966-2-1: 12.92 v below 0.0031308, 1.055 v^(1/2.4) − 0.055 above.
    Srgb,
    /// ITU-R BT.2020: 4.5 v below β, α v^0.45 − (α − 1) above, with the exact α and β of the joining curves.
    Rec2020,
    /// The linear value itself.
    Linear,
}

/// An RGB space.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Space {
    /// Key in the results: `srgb`, `display_p3`, `rec2020`, `acescg`.
    pub key: &'static str,
    /// Usual name.
    pub name: &'static str,
    /// x, y of red, green and blue.
    pub primaries: [[f64; 2]; 3],
    /// x, y of white.
    pub white: [f64; 2],
    /// Name of the white.
    pub white_name: &'static str,
    /// Encoding.
    pub encoding: Encoding,
}

/// IEC 61966-2-1 (ITU-R BT.709 primaries).
pub const SRGB: Space = Space {
    key: "srgb",
    name: "sRGB",
    primaries: [[0.64, 0.33], [0.30, 0.60], [0.15, 0.06]],
    white: [0.3127, 0.3290],
    white_name: "D65",
    encoding: Encoding::Srgb,
};
/// Display P3 (SMPTE EG 432-1 primaries with D65 and the sRGB curve).
pub const DISPLAY_P3: Space = Space {
    key: "display_p3",
    name: "Display P3",
    primaries: [[0.680, 0.320], [0.265, 0.690], [0.150, 0.060]],
    white: [0.3127, 0.3290],
    white_name: "D65",
    encoding: Encoding::Srgb,
};
/// ITU-R BT.2020.
pub const REC2020: Space = Space {
    key: "rec2020",
    name: "Rec. 2020",
    primaries: [[0.708, 0.292], [0.170, 0.797], [0.131, 0.046]],
    white: [0.3127, 0.3290],
    white_name: "D65",
    encoding: Encoding::Rec2020,
};
/// ACEScg (Academy S-2014-004, AP1 primaries).
pub const ACESCG: Space = Space {
    key: "acescg",
    name: "ACEScg",
    primaries: [[0.713, 0.293], [0.165, 0.830], [0.128, 0.044]],
    white: [0.32168, 0.33767],
    white_name: "ACES (≈ D60)",
    encoding: Encoding::Linear,
};

/// Radiance's own primaries with the equal-energy white (`src/common/color.h`: .640 .330, .290 .600, .150 .060): luminance is
/// .265 R + .670 G + .065 B.
pub const RADIANCE: Space = Space {
    key: "radiance",
    name: "Radiance RGB",
    primaries: [[0.640, 0.330], [0.290, 0.600], [0.150, 0.060]],
    // Four digits: only with them do the luminance weights of its source come out.
    white: [0.3333, 0.3333],
    white_name: "E",
    encoding: Encoding::Linear,
};
/// The spaces reported.
pub const SPACES: [Space; 4] = [SRGB, DISPLAY_P3, REC2020, ACESCG];

impl Encoding {
    /// The stored value of a linear one; odd about zero, so that values out of gamut keep their sign.
    #[must_use]
    pub fn encode(self, linear: f64) -> f64 {
        let v = linear.abs();
        let coded = match self {
            Self::Linear => v,
            Self::Srgb if v <= 0.003_130_8 => 12.92 * v,
            Self::Srgb => 1.055 * v.powf(1.0 / 2.4) - 0.055,
            Self::Rec2020 if v < BETA => 4.5 * v,
            Self::Rec2020 => ALPHA * v.powf(0.45) - (ALPHA - 1.0),
        };
        coded.copysign(linear)
    }

    /// The linear value of a stored one, the inverse of [`Encoding::encode`]. IEC 61966-2-1 has its own rounded knee, 0.04045.
    #[must_use]
    pub fn decode(self, coded: f64) -> f64 {
        let v = coded.abs();
        let linear = match self {
            Self::Linear => v,
            Self::Srgb if v <= 0.040_45 => v / 12.92,
            Self::Srgb => ((v + 0.055) / 1.055).powf(2.4),
            Self::Rec2020 if v < 4.5 * BETA => v / 4.5,
            Self::Rec2020 => ((v + (ALPHA - 1.0)) / ALPHA).powf(1.0 / 0.45),
        };
        linear.copysign(coded)
    }
}

/// α and β of ITU-R BT.2020, exact.
const ALPHA: f64 = 1.099_296_826_809_44;
const BETA: f64 = 0.018_053_968_510_807;

/// Chromaticities closer than this are those of one space: half a unit of the fourth decimal, as standards print them.
const SAME_XY: f64 = 5e-5;

/// Whether two chromaticities are the same to the four decimals of the standards.
#[must_use]
pub fn same_xy(a: [f64; 2], b: [f64; 2]) -> bool {
    a.iter().zip(b).all(|(a, b)| (a - b).abs() < SAME_XY)
}

impl Space {
    /// The linear space of primaries and a white that a file states: one that has a name, or a nameless one. Four decimals count.
    #[must_use]
    pub fn of(primaries: [[f64; 2]; 3], white: [f64; 2]) -> Self {
        let named = SPACES.into_iter().chain([RADIANCE]).find(|space| {
            same_xy(space.white, white) && space.primaries.iter().zip(primaries).all(|(a, b)| same_xy(*a, b))
        });
        let nameless = Self {
            key: "chromaticities",
            name: "the file's RGB",
            primaries,
            white,
            white_name: "the file's",
            encoding: Encoding::Linear,
        };
        Self { encoding: Encoding::Linear, ..named.unwrap_or(nameless) }
    }

    /// Linear RGB to XYZ (Y = 1 for white): the matrix whose columns are the primaries scaled to add up to white (SMPTE RP
    /// 177-1993). `None` for degenerate primaries.
    #[must_use]
    pub fn to_xyz(&self) -> Option<DMat3> {
        let [r, g, b] = self.primaries.map(|p| xyz_of_xy(p).map(DVec3::from));
        let white = DVec3::from(xyz_of_xy(self.white)?);
        let columns = DMat3::from_cols(r?, g?, b?);
        let scale = columns.inverse() * white;
        let matrix = columns * DMat3::from_diagonal(scale);
        (matrix.is_finite() && matrix.inverse().is_finite()).then_some(matrix)
    }

    /// XYZ (Y = 1 for white) to linear RGB: the inverse of [`Space::to_xyz`]. `None` for degenerate primaries.
    #[must_use]
    pub fn from_xyz(&self) -> Option<DMat3> {
        self.to_xyz().map(|m| m.inverse())
    }
}

/// A colour in one space.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Colour {
    /// Linear components for XYZ with Y = 1; below zero where the colour is out of the gamut.
    pub linear: [f64; 3],
    /// What a display would be sent: the linear components with negatives cut, divided by the largest, encoded; 0 to 1.
    pub encoded: [f64; 3],
    /// True where a component was negative and had to be cut.
    pub out_of_gamut: bool,
    /// The most negative component over the largest one; 0 inside the gamut.
    pub clipped: f64,
}

/// The colour of light with tristimulus values `xyz` (any scale), for an eye adapted to `white_xyz` (`None`: the space's own
/// white), in a space.
///
/// `None` for black, for tristimulus values that are not finite, and for whites without positive cone signals.
#[must_use]
pub fn colour(xyz: [f64; 3], space: &Space, adaptation: Transform, white_xyz: Option<[f64; 3]>) -> Option<Colour> {
    let unit = DVec3::from(xyz) / xyz[1];
    if !(xyz[1] > 0.0 && unit.is_finite()) {
        return None;
    }
    let own = xyz_of_xy(space.white)?;
    // Y = 1 for the white as well: only its chromaticity counts.
    let adapt = match white_xyz {
        Some(white) => adaptation.matrix(white.map(|v| v / white[1]), own)?,
        None => DMat3::IDENTITY,
    };
    let linear = space.from_xyz()? * (adapt * unit);
    let (largest, smallest) = (linear.max_element(), linear.min_element());
    let shown = linear.max(DVec3::ZERO) / largest;
    // Rounding in the matrices leaves 1e-16 where a primary has zero.
    let out_of_gamut = smallest < -1e-12 * largest;
    Some(Colour {
        linear: linear.to_array(),
        encoded: shown.to_array().map(|v| space.encoding.encode(v)),
        out_of_gamut,
        clipped: if out_of_gamut { smallest / largest } else { 0.0 },
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn srgb_matrix_is_that_of_the_standard() {
        // IEC 61966-2-1 Amd 1:2003, XYZ → linear sRGB, seven decimals as in its annex; the standard's own matrix was derived
        // from four-digit forward coefficients, so the last places differ by up to 3e-4.
        let m = SRGB.from_xyz().expect("proper primaries");
        let want = [
            [3.2406255, -1.5372080, -0.4986286],
            [-0.9689307, 1.8757561, 0.0415175],
            [0.0557101, -0.2040211, 1.0569959],
        ];
        for (r, row) in want.iter().enumerate() {
            for (c, v) in row.iter().enumerate() {
                assert!((m.col(c)[r] - v).abs() < 4e-4, "{r} {c}: {}", m.col(c)[r]);
            }
        }
    }

    #[test]
    fn white_is_white_in_every_space() {
        for space in SPACES {
            let white = xyz_of_xy(space.white).expect("y is not zero");
            let c = colour(white, &space, Transform::Bradford, None).expect("not black");
            assert!(c.encoded.iter().all(|v| (v - 1.0).abs() < 1e-12), "{}: {c:?}", space.name);
            assert!(!c.out_of_gamut);
            // An eye adapted to A sees A as white.
            let a = [1.0985, 1.0, 0.35585];
            let c = colour(a, &space, Transform::Cat16, Some(a)).expect("not black");
            assert!(c.encoded.iter().all(|v| (v - 1.0).abs() < 1e-12), "{}: {c:?}", space.name);
        }
    }

    #[test]
    fn encodings_join_without_a_step() {
        for (encoding, knee) in [(Encoding::Srgb, 0.003_130_8), (Encoding::Rec2020, 0.018_053_968_510_807)] {
            let (below, above) = (encoding.encode(knee - 1e-12), encoding.encode(knee + 1e-12));
            // IEC 61966-2-1 rounds its constants: a step of 3e-8 is in the standard.
            assert!((below - above).abs() < 5e-8, "{encoding:?}");
            assert_eq!(encoding.encode(-0.5), -encoding.encode(0.5));
            assert!((encoding.encode(1.0) - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn decoding_undoes_encoding_and_meets_the_standard() {
        // IEC 61966-2-1: 0.04045 is 0.0031308 to five digits; the mid code 128/255 is 0.215861 (with its constants, by hand:
        // ((0.501961 + 0.055)/1.055)^2.4).
        assert!((Encoding::Srgb.decode(0.040_45) - 0.003_130_8).abs() < 5e-8);
        assert!((Encoding::Srgb.decode(128.0 / 255.0) - 0.215_861).abs() < 5e-7);
        for encoding in [Encoding::Srgb, Encoding::Rec2020, Encoding::Linear] {
            for i in -200..=200 {
                let v = f64::from(i) / 100.0;
                // Between the two knees of IEC 61966-2-1 the branches differ by the rounding of its constants.
                let bound = if encoding == Encoding::Srgb { 5e-8 } else { 1e-14 };
                assert!((encoding.decode(encoding.encode(v)) - v).abs() < bound, "{encoding:?} {v}");
            }
        }
    }

    #[test]
    fn radiance_weighs_its_primaries_as_its_source_does() {
        // Radiance, src/common/color.h: CIE_rf, CIE_gf, CIE_bf of the default primaries, nine decimals.
        let y = RADIANCE.to_xyz().expect("proper primaries").row(1);
        for (got, want) in y.to_array().into_iter().zip([0.265_074_126, 0.670_114_631, 0.064_811_243]) {
            assert!((got - want).abs() < 5.1e-10, "{got} {want}");
        }
        assert_eq!(
            Space::of(RADIANCE.primaries, [0.333, 0.333]).key,
            "chromaticities",
            "three digits are another white"
        );
        assert_eq!(Space::of(SRGB.primaries.map(|p| p.map(|v| f64::from(v as f32))), SRGB.white).key, "srgb");
    }

    #[test]
    fn black_and_laser_light() {
        assert_eq!(colour([0.0; 3], &SRGB, Transform::None, None), None);
        let green = colour([0.0633, 0.71, 0.0782], &SRGB, Transform::None, None).expect("520 nm");
        assert!(green.out_of_gamut && green.clipped < 0.0 && green.encoded[0] == 0.0, "{green:?}");
    }
}
