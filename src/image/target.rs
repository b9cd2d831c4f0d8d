//! What the bands of an image are weighted to.

use std::fmt;

use crate::colorimetry::Observer;
use crate::colorimetry::rgb::Space;
use crate::photometry::alpha_opic;
use crate::photometry::luminous::Efficiency;
use crate::spectrum::integrate::Weighting;

/// The planes that a conversion makes.
#[derive(Debug, Clone, PartialEq)]
pub enum Target {
    /// The photopic quantity of the image: luminance (cd/m²) of radiance, illuminance (lx) of irradiance …
    Luminance(Efficiency),
    /// The scotopic one.
    Scotopic,
    /// X, Y, Z; of light K_m times the integrals, so that with the CIE 1931 observer Y is the photopic quantity.
    Xyz(Observer),
    /// R, G, B of a space, from the CIE 1931 observer that it is defined with.
    Rgb {
        /// The space.
        space: Space,
        /// Encoded with the curve of the space; otherwise linear.
        encoded: bool,
    },
    /// An α-opic quantity of CIE S 026.
    AlphaOpic {
        /// Number in [`alpha_opic::RECEPTORS`].
        receptor: usize,
        /// The equivalent daylight (D65) quantity (cd/m² or lx) instead of the α-opic one (W/(m²·sr) or W/m²).
        equivalent_daylight: bool,
    },
    /// ∫ S w dλ with a weighting of the user's, in the unit of the samples times nm.
    Weighting {
        /// Name of the channel.
        name: String,
        /// The weighting.
        weighting: Weighting,
    },
}

impl Target {
    /// Names of the planes, in order.
    #[must_use]
    pub fn channel_names(&self) -> Vec<String> {
        match self {
            Self::Luminance(_) => vec!["Y".to_owned()],
            Self::Scotopic => vec!["scotopic".to_owned()],
            Self::Xyz(_) => ["X", "Y", "Z"].map(str::to_owned).to_vec(),
            Self::Rgb { .. } => ["R", "G", "B"].map(str::to_owned).to_vec(),
            Self::AlphaOpic { receptor, equivalent_daylight } => {
                let suffix = if *equivalent_daylight { "-edi" } else { "" };
                vec![format!("{}{suffix}", alpha_opic::RECEPTORS[*receptor])]
            }
            Self::Weighting { name, .. } => vec![name.clone()],
        }
    }
}

impl fmt::Display for Target {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Luminance(efficiency) => write!(f, "luminance ({efficiency})"),
            Self::Scotopic => f.write_str("scotopic (cie-1951-v-prime)"),
            Self::Xyz(observer) => write!(f, "XYZ ({observer})"),
            Self::Rgb { space, encoded } => write!(f, "{} {}", if *encoded { "encoded" } else { "linear" }, space.name),
            Self::AlphaOpic { .. } | Self::Weighting { .. } => f.write_str(&self.channel_names()[0]),
        }
    }
}
