//! One model of a luminaire, to which every file format is a bridge.

use super::angular::AngularSpectra;
use super::distribution::Distribution;
use crate::spectrum::Spectrum;

/// What the intensities are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Kind {
    /// Candela.
    Luminous,
    /// W/sr (radiometric files, as far-UV makers publish them).
    Radiant,
    /// µmol/(s·sr).
    Photon,
}

/// The luminous opening's shape.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Shape {
    /// No extent.
    Point,
    /// Rectangle, or box where it has a height.
    Rectangle,
    /// Circle or ellipse, or upright cylinder where it has a height.
    Round,
    /// Sphere or ellipsoid.
    Sphere,
    /// Cylinder whose axis lies along C0–C180 (x); across it, it is a circle or ellipse.
    CylinderAlongC0,
    /// Cylinder whose axis lies along C90–C270 (y).
    CylinderAlongC90,
}

impl Shape {
    /// Its name in reports.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Point => "point",
            Self::Rectangle => "rectangle",
            Self::Round => "round",
            Self::Sphere => "sphere",
            Self::CylinderAlongC0 => "cylinder_along_c0",
            Self::CylinderAlongC90 => "cylinder_along_c90",
        }
    }
}

/// A body: the luminous opening, or the housing; metres. The axes are the luminaire's, whatever a format calls them: EULUMDAT's
/// length lies along C90–C270 as here, LM-63's along C0–C180.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Body {
    /// Shape.
    pub shape: Shape,
    /// Extent along C90–C270 (y), m: EULUMDAT's length, LM-63's width.
    pub length_m: f64,
    /// Extent along C0–C180 (x), m: EULUMDAT's width, LM-63's length.
    pub width_m: f64,
    /// Extent along the vertical, m.
    pub height_m: f64,
}

impl Body {
    /// Height of a sphere or a lying cylinder, m: without one a cylinder is as high as it is wide across its axis, a sphere as its
    /// shorter side.
    pub(super) fn round_height_m(&self) -> f64 {
        match self.shape {
            _ if self.height_m > 0.0 => self.height_m,
            Shape::CylinderAlongC0 => self.length_m,
            Shape::CylinderAlongC90 => self.width_m,
            _ => self.width_m.min(self.length_m),
        }
    }
}

/// One set of lamps.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct LampSet {
    /// Number of lamps; `None` where the file does not say.
    pub count: Option<f64>,
    /// Type of lamp.
    pub name: String,
    /// Luminous flux of all lamps of the set, lm; `None` for absolute photometry.
    pub flux_lm: Option<f64>,
    /// Colour appearance or temperature, as written.
    pub colour: String,
    /// Colour rendering group or index, as written.
    pub rendering: String,
    /// Power of the set with ballast, W.
    pub power_w: Option<f64>,
}

/// A luminaire.
#[derive(Debug, Clone, PartialEq)]
pub struct Luminaire {
    /// Luminaire name or description.
    pub name: String,
    /// Maker.
    pub manufacturer: String,
    /// Catalogue number.
    pub catalogue_number: String,
    /// What the intensities are.
    pub kind: Kind,
    /// The intensities in cd, W/sr or µmol/(s·sr), all factors of the file applied.
    pub distribution: Distribution,
    /// Absolute photometry: the intensities are the luminaire's own and not per 1000 lm of its lamps.
    pub absolute: bool,
    /// Sets of lamps: the one that belongs to the intensities first, then those that may take its place.
    pub lamps: Vec<LampSet>,
    /// Electrical input power, W.
    pub input_power_w: Option<f64>,
    /// Flux of the luminaire that the file declares for itself (absolute photometry, or lamps × LORL), lm or W.
    pub declared_flux: Option<f64>,
    /// Light output ratio (LORL) that the file declares, 0 to 1.
    pub declared_output_ratio: Option<f64>,
    /// Downward flux fraction that the file declares, 0 to 1.
    pub declared_downward_fraction: Option<f64>,
    /// Luminous opening.
    pub opening: Option<Body>,
    /// Housing.
    pub housing: Option<Body>,
    /// Spectral distribution, relative or absolute, where the file has one.
    pub spectrum: Option<Spectrum>,
    /// Spectral intensity by direction, W/(sr·nm), where the file has one.
    pub angular_spectra: Option<AngularSpectra>,
    /// Every other labelled fact of the file, in order: what a conversion may carry along.
    pub keywords: Vec<(String, String)>,
}

impl Luminaire {
    /// A luminaire of which nothing is known but its own luminous intensities, cd.
    #[must_use]
    pub fn of(distribution: Distribution) -> Self {
        Self {
            name: String::new(),
            manufacturer: String::new(),
            catalogue_number: String::new(),
            kind: Kind::Luminous,
            distribution,
            absolute: true,
            lamps: Vec::new(),
            input_power_w: None,
            declared_flux: None,
            declared_output_ratio: None,
            declared_downward_fraction: None,
            opening: None,
            housing: None,
            spectrum: None,
            angular_spectra: None,
            keywords: Vec::new(),
        }
    }
}
