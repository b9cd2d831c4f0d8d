//! Why photographs could not be measured.

/// What is wrong with a set of photographs.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// Not a photograph that can be decoded.
    #[error(
        "found no photograph that can be read ({reason}); expected PNG or JPEG of 8 or 16 bits, linear EXR or TIFF"
    )]
    Undecodable {
        /// The decoder's word.
        reason: String,
    },
    /// Photographs of one set differ in size or number of channels.
    #[error("found {found} of {name}; expected {expected}, as of the first of its stack")]
    Size {
        /// Which photograph.
        name: String,
        /// Its size.
        found: String,
        /// That of the others.
        expected: String,
    },
    /// No exposure time, neither stated nor in the file.
    #[error(
        "found no exposure time for {name}; expected `time_s` in the manifest, a row of --times, or EXIF ExposureTime"
    )]
    NoTime {
        /// Which photograph.
        name: String,
    },
    /// A time that is none.
    #[error("found an exposure time of {time_s} s for {name}; expected a number above 0")]
    Time {
        /// Which photograph.
        name: String,
        /// What was stated.
        time_s: f64,
    },
    /// Fewer exposures than a response takes.
    #[error("found {count} exposure time(s) in {stack}; expected two or more different ones")]
    TooFew {
        /// Which stack.
        stack: String,
        /// Different times there.
        count: usize,
    },
    /// A channel in which no pixel is exposed within the range twice.
    #[error("found no pixel that two exposures show within their range ({what}); expected overlapping exposures")]
    NothingShared {
        /// What the photographs are instead.
        what: &'static str,
    },
    /// A longer exposure that is darker than a shorter one.
    #[error(
        "found {longer} ({longer_s} s) darker than {shorter} ({shorter_s} s) at {percent:.0} % of the pixels; expected longer \
         exposures to be brighter: were two photographs or their times swapped?"
    )]
    Order {
        /// The longer exposure.
        longer: String,
        /// Its time, s.
        longer_s: f64,
        /// The shorter one.
        shorter: String,
        /// Its time, s.
        shorter_s: f64,
        /// Share of the pixels.
        percent: f64,
    },
    /// Normal equations without a solution.
    #[error("the equations of the {what} have no solution; expected more varied photographs")]
    Singular {
        /// Of what.
        what: &'static str,
    },
    /// Too few views or corners.
    #[error("found {found}; expected {expected}")]
    Views {
        /// What there is.
        found: String,
        /// What it takes.
        expected: &'static str,
    },
    /// A photograph whose codes are not radiance.
    #[error("found codes of unknown response; expected linear EXR or 16-bit TIFF: `photopic capture merge` makes EXR")]
    NotLinear,
    /// A part of the geometry that is not stated, or cannot be.
    #[error("found {found}; expected {expected}")]
    Setup {
        /// What is wrong.
        found: String,
        /// What it takes.
        expected: &'static str,
    },
    /// A stack without a sample to use.
    #[error("found no usable pixel in {stack}: {why}")]
    Nothing {
        /// Which stack.
        stack: String,
        /// What became of its pixels.
        why: String,
    },
    /// A mirror ball without a lamp in it.
    #[error("found no highlight of a lamp in {name}: {why}")]
    Highlight {
        /// Which photograph.
        name: String,
        /// What there is instead.
        why: String,
    },
    /// A diffuse ball whose shading tells no light.
    #[error("found no shading by one distant lamp in {name}: {why}")]
    Shading {
        /// Which photograph.
        name: String,
        /// What there is instead.
        why: &'static str,
    },
}
