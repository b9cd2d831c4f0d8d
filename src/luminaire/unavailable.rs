//! Why a figure of a luminaire could not be given.

/// Why a figure could not be given. A figure that does not apply is no failure of the file: callers leave it out, saying why.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, thiserror::Error)]
#[non_exhaustive]
pub enum Unavailable {
    /// The figure is defined in zones about the vertical axis and the table is of Type A or B.
    #[error("the figure is defined for Type C tables; convert the luminaire first")]
    NotTypeC,
    /// The figure is one of light and the intensities are radiometric or photons.
    #[error("the figure is defined for luminous intensities")]
    NotLuminous,
    /// The file names no luminous opening, or one without area.
    #[error("the luminous opening has no known area")]
    NoOpening,
    /// The flux, or the intensity that the figure is relative to, is zero or negative.
    #[error("no light in the directions that the figure is made of")]
    Dark,
}
