//! Colour over angle: colour temperature and Δu′v′ over γ for each plane, and the colours themselves as strips.

use super::axis::{self, AXIS_TEXT, BELOW, MARGIN, Scale, TICK_TEXT};
use super::sheet::{Align, DARK, FRAME, Op, Point, Rect, SOFT, Sheet, clean};
use super::spectrum_curves::{style, trace};
use super::{clip, font};
use crate::luminaire::colour::DirectionColour;
use crate::luminaire::spectral::SpectralLamp;

/// One direction of a plane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ColourPoint {
    /// γ or vertical angle, degrees.
    pub angle_deg: f64,
    /// Colour temperature, K, where there is one.
    pub cct_k: Option<f64>,
    /// Distance from the mean chromaticity in (u′, v′).
    pub delta_uv_prime: f64,
    /// The colour, sRGB.
    pub srgb: [u8; 3],
    /// Whether it counts for the nonuniformity; others are drawn faint.
    pub counted: bool,
}

/// One plane, its directions ascending.
#[derive(Debug, Clone, PartialEq)]
pub struct ColourPlane {
    /// Such as `C90`.
    pub name: String,
    /// The directions that have light.
    pub points: Vec<ColourPoint>,
}

/// Colour temperature and Δu′v′ over γ, and strips of the colours.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ColourAnglePanel {
    /// Above the drawing; may be empty.
    pub title: String,
    /// The planes.
    pub planes: Vec<ColourPlane>,
    /// Lines of key figures in a column on the right.
    pub figures: Vec<String>,
}

/// Planes in one drawing: more cannot be told apart.
const MOST_PLANES: usize = 8;
const FIGURE_TEXT: f64 = 15.0;
const LEGEND_TEXT: f64 = 13.0;
const LINE: f64 = 1.5;
/// Height of a strip, and from one to the next.
const STRIP: (f64, f64) = (15.0, 20.0);

/// The panel of a lamp with angular spectra; `None` where one spectrum holds for all directions, or there is no light.
///
/// Of many planes, those nearest to every 45° are drawn.
#[must_use]
pub fn panel(name: &str, lamp: &SpectralLamp) -> Option<ColourAnglePanel> {
    let colour = lamp.colour.as_ref()?;
    let mut planes: Vec<ColourPlane> = Vec::new();
    let mut planes_deg: Vec<f64> = Vec::new();
    // The plane of 360° is that of 0° again.
    for (d, c) in lamp.directions.iter().zip(&colour.directions).filter(|(d, _)| d.horizontal_deg < 360.0) {
        if planes_deg.last() != Some(&d.horizontal_deg) {
            planes_deg.push(d.horizontal_deg);
            planes.push(ColourPlane { name: format!("C{}", d.horizontal_deg), points: Vec::new() });
        }
        if let (Some(plane), Some(c)) = (planes.last_mut(), c) {
            plane.points.push(point(d.vertical_deg, c));
        }
    }
    if let [only] = &mut planes[..] {
        only.name = "all planes".to_owned();
    }
    if planes.len() > MOST_PLANES {
        let nearest = |to: f64| {
            let distance = |i: &usize| (planes_deg[*i] - to).abs();
            (0..planes_deg.len()).min_by(|a, b| distance(a).total_cmp(&distance(b)))
        };
        let mut chosen: Vec<usize> = (-2..MOST_PLANES as i32).filter_map(|i| nearest(45.0 * f64::from(i))).collect();
        chosen.sort_unstable();
        chosen.dedup();
        planes = chosen.into_iter().take(MOST_PLANES).map(|i| planes[i].clone()).collect();
    }
    let mut figures = vec![
        format!("max Δu′v′ {:.4}", colour.max_delta_uv_prime),
        format!("rms Δu′v′ {:.4}", colour.rms_delta_uv_prime),
    ];
    if let Some((low, high)) = colour.cct_range_k {
        figures.push(format!("{low:.0} K to {high:.0} K"));
    }
    if let Some(cct) = lamp.flux.cct {
        figures.push(format!("flux: {:.0} K", cct.kelvin));
    }
    Some(ColourAnglePanel { title: format!("{name}: colour over angle"), planes, figures })
}

#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to a byte")]
fn point(angle_deg: f64, c: &DirectionColour) -> ColourPoint {
    ColourPoint {
        angle_deg,
        cct_k: c.cct.map(|c| c.kelvin),
        delta_uv_prime: c.delta_uv_prime,
        srgb: c.srgb.map_or([128; 3], |v| v.map(|v| (255.0 * v).round().clamp(0.0, 255.0) as u8)),
        counted: c.counted,
    }
}

impl ColourAnglePanel {
    pub(super) fn draw(&self, sheet: &mut Sheet, area: Rect) {
        let top = axis::title(sheet, area, &self.title) + 8.0;
        let column = self.column_width();
        let strips = STRIP.1 * self.planes.len() as f64 + 24.0;
        let bottom = area.y1 - MARGIN - strips;
        let gap = 16.0;
        let height = bottom - BELOW - top - gap;
        let right = area.x1 - MARGIN - column - 18.0;
        let upper = Rect::new(area.x0 + MARGIN + AXIS_TEXT + 62.0, top, right, top + 0.55 * height);
        let lower = Rect { y0: upper.y1 + gap, y1: bottom - BELOW, ..upper };
        let points = || self.planes.iter().flat_map(|p| &p.points);
        let angles = range(points().map(|p| p.angle_deg)).unwrap_or((0.0, 90.0));
        let x = Scale::new(angles.0, angles.1.max(angles.0 + 1.0), upper.x0, upper.x1);
        let x_ticks = x.ticks(60.0);
        // At least 100 K and 0.002, so that noise does not fill the plot.
        let (low, high) = range(points().filter_map(|p| p.cct_k)).unwrap_or((2000.0, 7000.0));
        let spare = (0.5 * (100.0 - (high - low))).max(0.08 * (high - low));
        let kelvin = Scale::new(low - spare, high + spare, upper.y1, upper.y0);
        let most = range(points().map(|p| p.delta_uv_prime)).map_or(0.002, |(_, high)| high.max(0.002));
        let delta = Scale::new(0.0, 1.08 * most, lower.y1, lower.y0);
        for (plot, y, name) in [(upper, kelvin, "CCT [K]"), (lower, delta, "Δu′v′")] {
            let ticks = y.ticks(34.0);
            axis::grid(sheet, plot, (x, &x_ticks), (y, &ticks));
            axis::left(sheet, plot, y, &ticks, name, area.x0 + MARGIN + AXIS_TEXT);
        }
        for (i, plane) in self.planes.iter().enumerate() {
            curve(sheet, plane, (i, self.planes.len()), upper, |p| Some((x.at(p.angle_deg), kelvin.at(p.cct_k?))));
            curve(sheet, plane, (i, self.planes.len()), lower, |p| {
                Some((x.at(p.angle_deg), delta.at(p.delta_uv_prime)))
            });
        }
        sheet.frame(upper, 1.2, FRAME);
        sheet.frame(lower, 1.2, FRAME);
        axis::below(sheet, lower, x, &x_ticks, "γ [°]");
        self.strips(sheet, x, Rect { y0: bottom + 10.0, y1: area.y1, ..upper });
        self.column(sheet, Rect::new(right + 18.0, top, area.x1 - MARGIN, bottom));
    }

    /// One strip of colours per plane, under the plots on their scale of angles.
    fn strips(&self, sheet: &mut Sheet, x: Scale, area: Rect) {
        for (i, plane) in self.planes.iter().enumerate() {
            let y = area.y0 + STRIP.1 * i as f64;
            let points: Vec<&ColourPoint> = plane.points.iter().filter(|p| p.angle_deg.is_finite()).collect();
            if let (Some(first), Some(last)) = (points.first(), points.last()) {
                // One direction alone still shows.
                let (start, end) = (x.at(first.angle_deg), x.at(last.angle_deg).max(x.at(first.angle_deg) + 2.0));
                let outline = Rect::new(start, y, end, y + STRIP.0).corners().to_vec();
                let mut stops: Vec<(f64, [u8; 3])> = points.iter().map(|p| (x.at(p.angle_deg), p.srgb)).collect();
                if stops.len() == 1 {
                    stops.push((end, first.srgb));
                }
                sheet.ops.push(Op::Gradient { outline, stops });
            }
            let at = (area.x0 - 9.0, y + STRIP.0 - 3.0);
            sheet.text(at, &font::fit(&clean(&plane.name), TICK_TEXT, 66.0), TICK_TEXT, DARK, Align::End);
        }
        let y = area.y0 + STRIP.1 * self.planes.len() as f64 + 10.0;
        let words = "the colours beside D65 white, each as bright as sRGB shows it";
        sheet.text((area.x0, y), words, LEGEND_TEXT, SOFT, Align::Start);
    }

    fn column_width(&self) -> f64 {
        let figures = self.figures.iter().map(|f| font::width(&clean(f), FIGURE_TEXT));
        let names = self.planes.iter().map(|p| font::width(&clean(&p.name), LEGEND_TEXT) + 34.0);
        figures.chain(names).fold(0.0, f64::max)
    }

    fn column(&self, sheet: &mut Sheet, r: Rect) {
        let mut y = r.y0;
        for figure in &self.figures {
            sheet.text((r.x0, y + FIGURE_TEXT), figure, FIGURE_TEXT, DARK, Align::Start);
            y += FIGURE_TEXT * LINE;
        }
        y += 10.0;
        if self.planes.len() > 1 {
            for (i, plane) in self.planes.iter().enumerate() {
                let (ink, dash) = style(i, self.planes.len());
                let middle = y + 0.62 * LEGEND_TEXT;
                trace(sheet, &[(r.x0, middle), (r.x0 + 26.0, middle)], 2.4, ink, dash);
                sheet.text((r.x0 + 34.0, y + LEGEND_TEXT), &plane.name, LEGEND_TEXT, DARK, Align::Start);
                y += LEGEND_TEXT * LINE;
            }
            y += 6.0;
        }
        if self.planes.iter().flat_map(|p| &p.points).any(|p| !p.counted) {
            for line in font::wrap("faint: below 10 % of the peak, not counted", LEGEND_TEXT, r.width()) {
                sheet.text((r.x0, y + LEGEND_TEXT), &line, LEGEND_TEXT, SOFT, Align::Start);
                y += LEGEND_TEXT * LINE;
            }
        }
    }
}

/// A curve in runs of what counts, and faint between and beyond.
fn curve(
    sheet: &mut Sheet,
    plane: &ColourPlane,
    (index, count): (usize, usize),
    plot: Rect,
    place: impl Fn(&ColourPoint) -> Option<Point>,
) {
    let (ink, dash) = style(index, count);
    let place = |p: &ColourPoint| place(p).filter(|(x, y)| x.is_finite() && y.is_finite());
    for pair in plane.points.windows(2) {
        if !(pair[0].counted && pair[1].counted)
            && let (Some(a), Some(b)) = (place(&pair[0]), place(&pair[1]))
        {
            for part in clip::line(&[a, b], plot) {
                sheet.stroke(part, 1.4, ink.alpha(0.3));
            }
        }
    }
    for run in plane.points.split(|p| !p.counted) {
        for part in run.split(|p| place(p).is_none()) {
            let points: Vec<Point> = part.iter().filter_map(place).collect();
            for part in clip::line(&points, plot) {
                trace(sheet, &part, 2.2, ink, dash);
            }
        }
    }
}

fn range(values: impl Iterator<Item = f64>) -> Option<(f64, f64)> {
    values
        .filter(|v| v.is_finite())
        .fold(None, |e, v| Some(e.map_or((v, v), |(a, b): (f64, f64)| (a.min(v), b.max(v)))))
}
