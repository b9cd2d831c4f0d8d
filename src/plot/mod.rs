//! Drawings as SVG or PNG: spectra, chromaticity diagrams and colour vector graphics; the diagrams of luminaires.
//!
//! Plain numbers in, bytes of a file out. Nothing is computed here that a report would print: key figures, loci,
//! colours of wavelengths and luminous efficiency all come from the caller, and this module imports no other.
//!
//! ```
//! use photopic::plot::{Curve, Format, Panel, SpectrumPanel, draw};
//!
//! let wavelengths_nm: Vec<f64> = (380..=780).step_by(5).map(f64::from).collect();
//! let values = wavelengths_nm.iter().map(|w| (-((w - 550.0) / 60.0).powi(2)).exp()).collect();
//! let panel = SpectrumPanel {
//!     title: "a green light".into(),
//!     curves: vec![Curve::density("sample 1", wavelengths_nm, values)],
//!     value_label: "spectral irradiance [W/(m²·nm)]".into(),
//!     figures: vec!["500 lx".into()],
//!     ..SpectrumPanel::default()
//! };
//! let svg = draw(&[Panel::Spectrum(panel)], None, Format::Svg)?;
//! assert!(String::from_utf8(svg).is_ok_and(|text| text.contains("a green light")));
//! # Ok::<(), photopic::plot::Error>(())
//! ```
//!
//! A drawing is first laid out on a sheet of about a thousand pixels and then written at the size asked for: twice the
//! size gives the same drawing twice as sharp. The typeface is embedded, in the program and in every SVG file, so that
//! a drawing looks the same on a machine without fonts. The same input gives the same bytes.
//!
//! plotters draws; its charts do not (they round to whole pixels, and know neither a second unit on one
//! axis, nor equal scales, nor labels that avoid each other).

mod angular;
mod axis;
mod background;
pub mod brdf;
pub mod brdf_fit;
mod budget;
pub mod capture;
mod cartesian;
mod chromaticity;
mod clip;
pub mod colour_angle;
mod colour_map;
mod colour_vector;
mod cone;
pub mod conversion;
mod curves;
mod dots;
mod falsecolour;
mod figures;
mod font;
pub mod grid;
mod horseshoe;
mod inset;
mod isocandela;
mod isolux;
mod labels;
mod layout;
mod level;
mod lobe;
pub mod luminaire;
pub mod luminance;
mod png;
mod polar;
mod raster;
mod sheet;
mod spectrum;
mod spectrum_curves;
mod surface;
mod svg;
pub mod terminal;
mod trade;
pub mod uncertainty;
mod web;

pub use angular::{AngularCurve, MOST_ANGULAR_CURVES};
pub use budget::{BudgetBar, BudgetPanel};
pub use cartesian::{CartesianPanel, IntensityLevel};
pub use chromaticity::{ChromaticityPanel, Diagram, LocusPoint, MarkedPoint, PlanckPoint};
pub use colour_angle::{ColourAnglePanel, ColourPlane, ColourPoint};
pub use colour_map::ColourMap;
pub use colour_vector::ColourVectorPanel;
pub use cone::{ConePanel, ConeStep};
pub use curves::{CurvesPanel, NamedCurve};
pub use dots::{DotsPanel, Series};
pub use falsecolour::{ColourRange, FalseColourPanel, Kind, Level};
pub use figures::FiguresPanel;
pub use isocandela::{IsocandelaPanel, Isoline, Web};
pub use isolux::{IsoluxLine, IsoluxPanel, LuminaireMark};
pub use level::{LevelFigure, LevelPanel};
pub use lobe::{Lobe, LobePanel};
pub use polar::PolarPanel;
pub use raster::RasterPanel;
pub use spectrum::{Curve, CurveKind, SpectrumPanel, Weighting};
pub use surface::SurfacePanel;
pub use trade::{TradePanel, trade_panel};
pub use web::WebPanel;

/// The kind of file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Format {
    /// Scalable Vector Graphics, with the typeface embedded; text stays text.
    Svg,
    /// Portable Network Graphics, 8-bit sRGB.
    Png,
}

/// One drawing, alone or as a part of a picture.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Panel {
    /// Spectral curves or lines.
    Spectrum(SpectrumPanel),
    /// A chromaticity diagram with points.
    Chromaticity(ChromaticityPanel),
    /// A colour vector graphic after ANSI/IES TM-30.
    ColourVector(Box<ColourVectorPanel>),
    /// Colour temperature and Δu′v′ over angle.
    ColourAngle(ColourAnglePanel),
    /// Intensity around a luminaire's axis.
    Polar(PolarPanel),
    /// Intensity over the angle from a luminaire's axis.
    Cartesian(CartesianPanel),
    /// The intensity solid of a luminaire.
    Web(WebPanel),
    /// Lines of equal intensity.
    Isocandela(IsocandelaPanel),
    /// A beam at distances along its axis.
    Cone(ConePanel),
    /// Key figures in columns.
    Figures(FiguresPanel),
    /// Lines of equal illuminance on a plane.
    Isolux(Box<IsoluxPanel>),
    /// Reflection in the plane of incidence, polar.
    Lobe(LobePanel),
    /// Curves over an angle.
    Curves(CurvesPanel),
    /// Data against a model.
    Dots(DotsPanel),
    /// Error over time of settings.
    Trade(TradePanel),
    /// A picture.
    Raster(RasterPanel),
    /// A lobe in space.
    Surface(SurfacePanel),
    /// A false-colour picture with its legend.
    FalseColour(FalseColourPanel),
    /// What makes the uncertainty of figures.
    Budget(BudgetPanel),
    /// A figure among reference values.
    Level(LevelPanel),
}

macro_rules! panels {
    ($($variant:ident: $panel:ty),*) => {$(
        impl From<$panel> for Panel {
            fn from(panel: $panel) -> Self {
                Self::$variant(panel)
            }
        }
    )*};
}

panels! {
    Spectrum: SpectrumPanel,
    Chromaticity: ChromaticityPanel,
    ColourAngle: ColourAnglePanel,
    Polar: PolarPanel,
    Cartesian: CartesianPanel,
    Web: WebPanel,
    Isocandela: IsocandelaPanel,
    Cone: ConePanel,
    Figures: FiguresPanel,
    Lobe: LobePanel,
    Curves: CurvesPanel,
    Dots: DotsPanel,
    Trade: TradePanel,
    Raster: RasterPanel,
    Surface: SurfacePanel,
    FalseColour: FalseColourPanel,
    Budget: BudgetPanel,
    Level: LevelPanel
}

impl From<ColourVectorPanel> for Panel {
    fn from(panel: ColourVectorPanel) -> Self {
        Self::ColourVector(Box::new(panel))
    }
}

impl From<IsoluxPanel> for Panel {
    fn from(panel: IsoluxPanel) -> Self {
        Self::Isolux(Box::new(panel))
    }
}

/// Why there is no drawing.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// No panel was given.
    #[error("there is nothing to draw: no panel was given")]
    Empty,
    /// The size asked for is too small to read or too large to hold.
    #[error("a picture of {width} × {height} pixels cannot be drawn: each side must be {least} to {most} pixels", least = SIDES.0, most = SIDES.1)]
    Size {
        /// Width asked for, in pixels.
        width: u32,
        /// Height asked for, in pixels.
        height: u32,
    },
    /// The embedded typeface could not be read.
    #[error("the embedded typeface could not be read")]
    Font,
    /// The drawing library failed.
    #[error("the drawing could not be made: {0}")]
    Drawing(String),
    /// The PNG could not be encoded.
    #[error("the PNG could not be encoded")]
    Encoding(#[from] image::ImageError),
}

/// Smallest and largest width or height of a picture in pixels.
pub const SIDES: (u32, u32) = (240, 8192);

/// A file as a data URI (RFC 2397), to be put into a page.
#[must_use]
pub fn data_uri(file: &[u8], format: Format) -> String {
    let kind = match format {
        Format::Svg => "svg+xml",
        Format::Png => "png",
    };
    format!("data:image/{kind};base64,{}", font::base64(file))
}

/// Draw one panel, or several as one picture: spectra above each other over the full width, the others side by side
/// below, key figures at the head.
///
/// `size` is width and height in pixels; without it a spectrum or a Cartesian diagram gets 1000 × 600, another single panel
/// 800 × 800, and several panels 1200 pixels in width. Larger sizes enlarge the drawing.
///
/// # Errors
///
/// [`Error::Empty`] without panels, [`Error::Size`] for sides outside [`SIDES`]; the others do not occur in a sound
/// build.
pub fn draw(panels: &[Panel], size: Option<(u32, u32)>, format: Format) -> Result<Vec<u8>, Error> {
    if panels.is_empty() {
        return Err(Error::Empty);
    }
    let (width, height) = size.unwrap_or_else(|| layout::default_size(panels));
    let allowed = SIDES.0..=SIDES.1;
    if !allowed.contains(&width) || !allowed.contains(&height) {
        return Err(Error::Size { width, height });
    }
    let sheet = layout::compose(panels, (width, height));
    match format {
        Format::Svg => svg::write(&sheet, (width, height)),
        Format::Png => png::write(&sheet, (width, height)),
    }
}
