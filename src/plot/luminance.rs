//! From a picture of a photometric quantity to its drawing in false colours.

use super::colour_map::ColourMap;
use super::falsecolour::{ColourRange, FalseColourPanel, Level};
use crate::image::Picture;
use crate::math::contour::contours;
use crate::math::order::quantiles;
use crate::units::significant;

/// Decades below the largest value that a logarithmic scale shows where nothing is asked for.
const DECADES: f64 = 6.0;
/// A scale is logarithmic by default where the brightest thousandth has more than this many times the median.
const STEEP: f64 = 20.0;
/// Contour lines, about.
const LINES: f64 = 8.0;

/// One end of the colours.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum End {
    /// A value.
    Value(f64),
    /// A percentile of the picture's values, those above 0 for a logarithmic scale.
    Percentile(f64),
}

/// How values become colours.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct FalseColour {
    /// Lower end; by default the smallest value, of a logarithmic scale at most six decades below the largest.
    pub low: Option<End>,
    /// Upper end; by default the largest value.
    pub high: Option<End>,
    /// Logarithmic or linear; by default logarithmic where the brightest thousandth of the values above 0 begins at more than 20
    /// times their median.
    pub logarithmic: Option<bool>,
    /// The colours.
    pub map: ColourMap,
    /// Contour lines: none, at round values (an empty list), or at these.
    pub contours: Option<Vec<f64>>,
}

/// Why there are no colours for the values.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RangeError {
    /// Nothing to show.
    #[error("found no value{}; expected an image with some", if *.logarithmic { " above 0, which a logarithmic scale needs" } else { "" })]
    NoValue {
        /// The scale is logarithmic.
        logarithmic: bool,
    },
    /// The ends are not in order, or not above 0.
    #[error("found the range {low} to {high}; expected {expected}")]
    Ends {
        /// Lower end.
        low: f64,
        /// Upper end.
        high: f64,
        /// What it would be.
        expected: &'static str,
    },
}

impl FalseColour {
    /// What the colours of a picture stand for.
    ///
    /// # Errors
    /// [`RangeError`].
    pub fn range(&self, picture: &Picture) -> Result<ColourRange, RangeError> {
        let finite = || picture.values.iter().copied().filter(|v| v.is_finite());
        let positive = || finite().filter(|v| *v > 0.0);
        let logarithmic = self.logarithmic.unwrap_or_else(|| {
            let found = quantiles(positive(), &[0.5, 0.999]);
            found[1] > STEEP * found[0]
        });
        let values = || finite().filter(move |v| !logarithmic || *v > 0.0);
        let fixed = |end: Option<End>| matches!(end, Some(End::Value(_)));
        if values().next().is_none() && !(fixed(self.low) && fixed(self.high)) {
            return Err(RangeError::NoValue { logarithmic });
        }
        let percentile = |p: f64| quantiles(values(), &[p / 100.0])[0];
        let end = |end: End| match end {
            End::Value(v) => v,
            End::Percentile(p) => percentile(p),
        };
        let high = end(self.high.unwrap_or(End::Percentile(100.0)));
        let low = match self.low {
            Some(low) => end(low),
            None if logarithmic => percentile(0.0).max(high * 10f64.powf(-DECADES)),
            None => percentile(0.0),
        };
        // An even picture has no range of its own.
        let even = low == high && !(fixed(self.low) && fixed(self.high));
        let (low, high) = match (even, logarithmic) {
            (true, true) => (low / 10.0, high),
            (true, false) => (low.min(0.0), if high > 0.0 { high } else { 0.0_f64.max(high + 1.0) }),
            (false, _) => (low, high),
        };
        let refused = |expected| Err(RangeError::Ends { low, high, expected });
        match (low < high && low.is_finite() && high.is_finite(), logarithmic && low <= 0.0) {
            (false, _) => refused("the lower value first"),
            (true, true) => refused("values above 0 for a logarithmic scale"),
            (true, false) => Ok(ColourRange { low, high, logarithmic }),
        }
    }

    /// The drawing of a picture.
    ///
    /// # Errors
    /// [`RangeError`].
    pub fn panel(&self, title: &str, picture: &Picture, unit: &str) -> Result<FalseColourPanel, RangeError> {
        let range = self.range(picture)?;
        let levels = match &self.contours {
            None => Vec::new(),
            Some(levels) if levels.is_empty() => range.ticks(LINES),
            Some(levels) => levels.clone(),
        };
        Ok(FalseColourPanel {
            title: title.to_owned(),
            figures: figures(picture, unit),
            columns: picture.width,
            rows: picture.height,
            values: picture.values.clone(),
            unit: unit.to_owned(),
            range,
            map: self.map,
            levels: lines(picture, &levels),
            below: None,
        })
    }
}

fn figures(picture: &Picture, unit: &str) -> String {
    let s = &picture.statistics;
    let Some(mean) = s.mean() else { return "no value".to_owned() };
    let show = |v: f64| significant(v, 4);
    let (min, max) = (show(f64::from(s.min)), show(f64::from(s.max)));
    format!("min {min}, mean {}, max {max} {unit}", show(mean)).trim_end().to_owned()
}

/// The contour lines of a picture; values stand in the middles of its pixels.
fn lines(picture: &Picture, levels: &[f64]) -> Vec<Level> {
    if levels.is_empty() {
        return Vec::new();
    }
    let middles = |n: usize| (0..n).map(|i| i as f64 + 0.5).collect::<Vec<_>>();
    let (x, y) = (middles(picture.width), middles(picture.height));
    let values: Vec<f64> = picture.values.iter().map(|v| f64::from(*v)).collect();
    levels.iter().map(|value| Level { value: *value, lines: contours(&x, &y, &values, *value) }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image::{Channel, Description, Meaning, Memory};

    fn picture(samples: Vec<f32>) -> Picture {
        let channels = vec![Channel::new("Y", "cd/m²", Meaning::Photopic)];
        let description = Description::planes(samples.len(), 1, channels);
        Picture::of(&mut Memory::new(description, samples), 0, 10_000, 1).expect("memory does not fail")
    }

    #[test]
    fn the_range_is_that_of_the_values_unless_said_otherwise() {
        let even = picture((0..=100).map(|i| i as f32).collect());
        let range = |f: &FalseColour, p: &Picture| f.range(p).map(|r| (r.low, r.high, r.logarithmic));
        assert_eq!(range(&FalseColour::default(), &even), Ok((0.0, 100.0, false)));
        let log = FalseColour { logarithmic: Some(true), ..FalseColour::default() };
        assert_eq!(range(&log, &even), Ok((1.0, 100.0, true)));
        let ends =
            FalseColour { low: Some(End::Percentile(5.0)), high: Some(End::Value(50.0)), ..FalseColour::default() };
        assert_eq!(range(&ends, &even), Ok((5.0, 50.0, false)));
        // One lamp in a dark room, black parts and a hole.
        let mut room = vec![1.0; 90];
        room.extend([0.0, f32::NAN, 1e-9, 5000.0, 5000.0]);
        assert_eq!(range(&FalseColour::default(), &picture(room)), Ok((5000.0 * 10f64.powf(-6.0), 5000.0, true)));
        assert_eq!(range(&FalseColour::default(), &picture(vec![3.0; 4])), Ok((0.0, 3.0, false)));
        assert_eq!(range(&FalseColour::default(), &picture(vec![0.0; 4])), Ok((0.0, 1.0, false)));
        assert!(range(&log, &picture(vec![0.0, -1.0])).is_err());
        assert!(range(&FalseColour::default(), &picture(vec![f32::NAN])).is_err());
        let wrong = FalseColour { low: Some(End::Value(0.0)), high: Some(End::Value(9.0)), ..log };
        assert!(range(&wrong, &even).is_err());
    }

    #[test]
    fn contour_lines_pass_between_the_middles_of_pixels() {
        let two_rows = Picture { width: 2, height: 2, values: vec![0.0, 10.0, 0.0, 10.0], ..picture(vec![0.0]) };
        let panel = FalseColour { contours: Some(vec![5.0]), ..FalseColour::default() };
        let panel = panel.panel("", &two_rows, "lx").expect("a range");
        assert_eq!(panel.levels[0].lines, [[(1.0, 0.5), (1.0, 1.5)]]);
    }
}
