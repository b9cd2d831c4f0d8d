//! The lobe panel: reflection in the plane of incidence as a polar drawing, radius ∝ value.

use super::axis::{self, AXIS_TEXT, MARGIN, TICK_TEXT};
use super::curves::DASHES;
use super::font;
use super::sheet::{Align, DARK, FRAME, GRID, Ink, Point, Rect, SOFT, Sheet};

/// Colours of lobes and curves, one after the other: told apart by most kinds of colour vision (Okabe & Ito 2008).
pub(super) const COLOURS: [[u8; 3]; 6] =
    [[0, 114, 178], [213, 94, 0], [0, 158, 115], [204, 121, 167], [86, 180, 233], [230, 159, 0]];

/// One lobe.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Lobe {
    /// Angle of incidence in degrees: the light comes from the left.
    pub theta_i_deg: f64,
    /// Outgoing angle in degrees, −90 (towards the light) to 90, and value; NaN where it was not measured.
    pub samples: Vec<(f64, f64)>,
    /// Angle and guess where nothing was measured, drawn dashed; NaN elsewhere.
    pub guessed: Vec<(f64, f64)>,
    /// Reflectance of a Dirac lobe in the mirror direction, 0 where there is none.
    pub dirac: f64,
}

/// Lobes over the surface, each relative to its own measured peak, which is written beside it.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct LobePanel {
    /// Above the drawing.
    pub title: String,
    /// The lobes.
    pub lobes: Vec<Lobe>,
    /// Unit of the peaks.
    pub unit: String,
}

impl LobePanel {
    pub(super) fn draw(&self, sheet: &mut Sheet, area: Rect) {
        let top = axis::title(sheet, area, &self.title);
        let legend = 22.0 * self.lobes.len() as f64 + 30.0;
        let radius = ((area.width() - 2.0 * MARGIN - 60.0) / 2.0).min(area.y1 - top - legend - 2.0 * MARGIN - 30.0);
        let centre = ((area.x0 + area.x1) / 2.0, top + 26.0 + radius);
        let at = |theta_deg: f64, r: f64| -> Point {
            let (sin, cos) = theta_deg.to_radians().sin_cos();
            (centre.0 + radius * r * sin, centre.1 - radius * r * cos)
        };
        for r in [0.25, 0.5, 0.75, 1.0] {
            let arc: Vec<Point> = (-90..=90).map(|t| at(f64::from(t), r)).collect();
            sheet.stroke(arc, 1.0, if r == 1.0 { FRAME } else { GRID });
        }
        for t in (-75_i32..=75).step_by(15) {
            let theta = f64::from(t);
            sheet.line(at(theta, 0.0), at(theta, 1.0), 1.0, GRID);
            if t % 30 == 0 {
                let (x, y) = at(theta, 1.0 + 15.0 / radius);
                let label = format!("{}°", t.abs());
                sheet.text((x, y + 0.36 * TICK_TEXT), &label, TICK_TEXT, DARK, Align::Middle);
            }
        }
        sheet.line(at(-90.0, 1.06), at(90.0, 1.06), 2.0, FRAME);
        for (i, lobe) in self.lobes.iter().enumerate() {
            let ink = Ink::rgb(COLOURS[i % COLOURS.len()]);
            let largest = |samples: &[(f64, f64)]| samples.iter().fold(0.0_f64, |m, s| m.max(s.1));
            let (measured_peak, guessed_peak) = (largest(&lobe.samples), largest(&lobe.guessed));
            let peak = if measured_peak > 0.0 { measured_peak } else { guessed_peak };
            // The light, from outside to the surface.
            sheet.dashed(&[at(-lobe.theta_i_deg, 1.0), at(-lobe.theta_i_deg, 0.0)], &[6.0, 4.0], 1.5, ink);
            if peak > 0.0 {
                let runs = |samples: &[(f64, f64)]| -> Vec<Vec<Point>> {
                    // A guess above the peak is cut at the border of the drawing.
                    let place = |(t, v): &(f64, f64)| at(*t, (v.max(0.0) / peak).min(1.0));
                    let runs = samples.split(|s| s.1.is_nan()).filter(|run| !run.is_empty());
                    runs.map(|run| run.iter().map(place).collect()).collect()
                };
                for run in runs(&lobe.samples) {
                    let closed = std::iter::once(centre).chain(run.iter().copied()).chain([centre]).collect();
                    sheet.fill(closed, ink.alpha(0.12));
                    sheet.stroke(run, 2.0, ink);
                }
                for run in runs(&lobe.guessed) {
                    sheet.dashed(&run, &DASHES, 1.5, ink);
                }
            }
            if lobe.dirac > 0.0 {
                sheet.line(at(0.0, 0.0), at(lobe.theta_i_deg, 1.0), 2.0, ink);
            }
            let y = centre.1 + 40.0 + 22.0 * i as f64;
            let x = centre.0 - radius;
            sheet.line((x, y - 5.0), (x + 26.0, y - 5.0), 3.0, ink);
            let mut text = format!("light at {}°", lobe.theta_i_deg);
            if measured_peak > 0.0 {
                text += &format!(", peak {} {}", axis_number(peak), self.unit);
            } else if peak > 0.0 {
                text += ", not measured";
            }
            if lobe.dirac > 0.0 {
                text += &format!(", Dirac lobe of {}", axis_number(lobe.dirac));
            }
            sheet.text((x + 36.0, y), &font::fit(&text, AXIS_TEXT, 2.0 * radius), AXIS_TEXT, DARK, Align::Start);
        }
        let guesses = self.lobes.iter().flat_map(|l| &l.guessed).any(|g| g.1.is_finite());
        let note = if guesses {
            "each relative to its peak; dashed: the light, and curves not measured"
        } else {
            "each lobe relative to its peak; dashed: the light"
        };
        let y = centre.1 + 40.0 + 22.0 * self.lobes.len() as f64;
        sheet.text((centre.0 - radius, y), &font::fit(note, TICK_TEXT, 2.0 * radius), TICK_TEXT, SOFT, Align::Start);
    }
}

/// Three digits, with a power of ten where it is large or small.
fn axis_number(value: f64) -> String {
    let power = axis::exponent(value);
    if power == 0 {
        let decimals = if value >= 100.0 {
            0
        } else if value >= 1.0 {
            2
        } else {
            4
        };
        return axis::number(value, decimals);
    }
    format!("{}{}", axis::number(axis::divided(value, power), 2), axis::power_of_ten(power))
}
