//! Isolux diagram: lines of equal illuminance on a plane at equal scale, alone or over a false-colour picture.

use super::axis::{self, MARGIN, Scale, TICK_TEXT, plain};
use super::background;
use super::clip;
use super::colour_map::viridis;
use super::font;
use super::sheet::{Align, DARK, FRAME, Ink, Point, Rect, SOFT, Sheet, WHITE};

/// A luminaire on the plane, in the plane's coordinates, m.
#[derive(Debug, Clone, PartialEq)]
pub struct LuminaireMark {
    /// The photometric centre.
    pub at: (f64, f64),
    /// Outline of the luminous opening, or nothing.
    pub outline: Vec<(f64, f64)>,
    /// Direction of C0, its length the part of it that lies along the plane (0 to 1).
    pub c0: (f64, f64),
    /// Where a tilted photometric axis meets the plane.
    pub aim: Option<(f64, f64)>,
}

/// One contour line.
#[derive(Debug, Clone, PartialEq)]
pub struct IsoluxLine {
    /// Its value.
    pub level: f64,
    /// Its points in the plane's coordinates, m.
    pub points: Vec<(f64, f64)>,
}

/// Values on a plane, lines of equal value, and luminaires.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct IsoluxPanel {
    /// Title.
    pub title: String,
    /// Key figures in one line below the title.
    pub figures: String,
    /// Names of the axes with units.
    pub axes: [String; 2],
    /// Ends of the plane along both axes, m.
    pub extent_m: [(f64, f64); 2],
    /// Columns and rows of the values, ascending, m.
    pub columns_m: Vec<f64>,
    /// See `columns_m`.
    pub rows_m: Vec<f64>,
    /// Row by row; NaN where there is none.
    pub values: Vec<f64>,
    /// Unit of the values.
    pub unit: String,
    /// Lines of equal value.
    pub lines: Vec<IsoluxLine>,
    /// Luminaires.
    pub luminaires: Vec<LuminaireMark>,
    /// Whether colours are laid under the lines.
    pub filled: bool,
}

/// Width of the colour bar with its labels.
const BAR: f64 = 92.0;
const LINE_TEXT: f64 = 12.5;
const FIGURE_TEXT: f64 = 13.0;
/// Lights are drawn over any colour.
const LAMP: Ink = Ink::rgb([190, 30, 30]);

impl IsoluxPanel {
    /// Width and height at which the plane fills the panel.
    pub(super) fn natural(&self) -> (f64, f64) {
        let [(x0, x1), (y0, y1)] = self.extent_m;
        let ratio = ((y1 - y0) / (x1 - x0)).clamp(0.25, 1.6);
        let plot = 820.0f64.min(900.0 / ratio);
        (plot + 110.0 + self.right(), (plot * ratio + 140.0).max(320.0))
    }

    fn right(&self) -> f64 {
        if self.filled { BAR } else { MARGIN }
    }

    pub(super) fn draw(&self, sheet: &mut Sheet, area: Rect) {
        let mut top = axis::title(sheet, area, &self.title);
        if !self.figures.is_empty() {
            let room = area.width() - 2.0 * MARGIN;
            let text = font::fit(&self.figures, FIGURE_TEXT, room);
            sheet.text((area.x0 + MARGIN, top + 11.0), &text, FIGURE_TEXT, SOFT, Align::Start);
            top += 24.0;
        }
        let [(x0, x1), (y0, y1)] = self.extent_m;
        let box_ = Rect::new(area.x0 + 78.0, top + 4.0, area.x1 - self.right() - 8.0, area.y1 - axis::BELOW - 12.0);
        let per_metre = (box_.width() / (x1 - x0)).min(box_.height() / (y1 - y0));
        if !(per_metre.is_finite() && per_metre > 0.0) {
            return;
        }
        let (w, h) = (per_metre * (x1 - x0), per_metre * (y1 - y0));
        let left = box_.x0 + 0.5 * (box_.width() - w);
        let plot = Rect::new(left, box_.y0, left + w, box_.y0 + h);
        let (x, y) = (Scale::new(x0, x1, plot.x0, plot.x1), Scale::new(y0, y1, plot.y1, plot.y0));
        let (xs, ys) = (x.ticks(80.0), y.ticks(60.0));
        if self.filled {
            self.colours(sheet, plot, x, y);
        } else {
            axis::grid(sheet, plot, (x, &xs), (y, &ys));
        }
        self.contours(sheet, plot, x, y);
        self.lamps(sheet, plot, x, y);
        sheet.frame(plot, 1.0, FRAME);
        axis::below(sheet, plot, x, &xs, &self.axes[0]);
        axis::left(sheet, plot, y, &ys, &self.axes[1], plot.x0 - 16.0 - ys.width() - 8.0);
        if self.filled {
            self.bar(sheet, plot);
        }
    }

    /// Lowest and highest value of the colours: from zero, or over two decades where the values span more.
    fn range(&self) -> (f64, f64) {
        let finite = || self.values.iter().copied().filter(|v| v.is_finite());
        (finite().fold(f64::INFINITY, f64::min), finite().fold(0.0, f64::max))
    }

    /// Place of a value on the colour scale, 0 to 1. Fields that fall below a twentieth of their maximum are shown by the
    /// logarithm over two decades, as the eye sees them; others in proportion.
    fn share(&self, value: f64, (low, high): (f64, f64)) -> f64 {
        if high <= 0.0 {
            0.0
        } else if low > 0.05 * high {
            value / high
        } else {
            1.0 + (value / high).max(1e-9).log10() / 2.0
        }
    }

    fn colours(&self, sheet: &mut Sheet, plot: Rect, x: Scale, y: Scale) {
        let range = self.range();
        let corners = plot.corners().to_vec();
        let back = |s: Scale, p: f64| s.low + (p - s.start) / (s.end - s.start) * (s.high - s.low);
        sheet.ops.push(background::picture(plot, 2.0, corners, |(px, py)| {
            let value = bilinear(&self.columns_m, &self.rows_m, &self.values, (back(x, px), back(y, py)));
            if value.is_finite() { viridis(self.share(value, range)) } else { [128; 3] }
        }));
    }

    fn lamps(&self, sheet: &mut Sheet, plot: Rect, x: Scale, y: Scale) {
        let place = |(a, b): (f64, f64)| (x.at(a), y.at(b));
        let size = if self.luminaires.len() > 60 { 3.0 } else { 4.5 };
        for lamp in &self.luminaires {
            let at = place(lamp.at);
            if let Some(aim) = lamp.aim.map(place) {
                for part in clip::line(&[at, aim], plot) {
                    sheet.dashed(&part, &[5.0, 4.0], 1.0, LAMP);
                }
                if plot.contains(aim) {
                    sheet.line((aim.0 - 4.0, aim.1 - 4.0), (aim.0 + 4.0, aim.1 + 4.0), 1.4, LAMP);
                    sheet.line((aim.0 - 4.0, aim.1 + 4.0), (aim.0 + 4.0, aim.1 - 4.0), 1.4, LAMP);
                }
            }
            if !plot.contains(at) {
                continue;
            }
            let outline: Vec<Point> = lamp.outline.iter().copied().map(place).collect();
            let wide = outline.iter().any(|p| (p.0 - at.0).hypot(p.1 - at.1) > size);
            if wide {
                let mut closed = clip::polygon(&outline, plot);
                sheet.fill(closed.clone(), WHITE.alpha(0.6));
                closed.extend(closed.first().copied());
                sheet.stroke(closed, 1.4, LAMP);
            }
            // A stroke towards C0.
            let length = 15.0 * lamp.c0.0.hypot(lamp.c0.1);
            if length > 1.0 {
                sheet.line(at, (at.0 + 15.0 * lamp.c0.0, at.1 - 15.0 * lamp.c0.1), 1.6, LAMP);
            }
            sheet.disc(at, size, WHITE);
            sheet.disc(at, size - 1.2, LAMP);
        }
    }

    fn contours(&self, sheet: &mut Sheet, plot: Rect, x: Scale, y: Scale) {
        let range = self.range();
        let drawn: Vec<(f64, Vec<Point>)> =
            self.lines.iter().map(|l| (l.level, l.points.iter().map(|p| (x.at(p.0), y.at(p.1))).collect())).collect();
        for (level, points) in &drawn {
            // Dark on light colours, light on dark ones.
            let ink = if self.filled && self.share(*level, range) < 0.55 { WHITE } else { DARK };
            sheet.stroke(points.clone(), 1.2, ink);
        }
        let marked = |l: &LuminaireMark| Rect::new(x.at(l.at.0), y.at(l.at.1), x.at(l.at.0), y.at(l.at.1)).grown(7.0);
        let mut taken: Vec<Rect> = self.luminaires.iter().map(marked).collect();
        for (i, (level, points)) in drawn.iter().enumerate() {
            let text = plain(*level);
            let (w, h) = (font::width(&text, LINE_TEXT), 0.95 * LINE_TEXT);
            if length(points) < 2.5 * w {
                continue;
            }
            let free = |at: &Point| {
                let label = Rect::new(at.0 - w / 2.0, at.1 - h / 2.0, at.0 + w / 2.0, at.1 + h / 2.0).grown(2.0);
                let others = || drawn.iter().enumerate().filter(|(j, _)| *j != i);
                let clear = plot.holds(&label.grown(3.0)) && !taken.iter().any(|t| t.overlaps(&label.grown(3.0)));
                (clear && others().all(|(_, (_, l))| clip::line(l, label).is_empty())).then_some(label)
            };
            if let Some((at, label)) = candidates(points).into_iter().find_map(|at| Some((at, free(&at)?))) {
                sheet.fill(label.corners().to_vec(), WHITE.alpha(if self.filled { 0.8 } else { 1.0 }));
                sheet.text((at.0, at.1 + 0.36 * LINE_TEXT), &text, LINE_TEXT, DARK, Align::Middle);
                taken.push(label);
            }
        }
    }

    /// The colour scale with the levels of the lines.
    fn bar(&self, sheet: &mut Sheet, plot: Rect) {
        let range = self.range();
        let bar = Rect::new(plot.x1 + 16.0, plot.y0 + 18.0, plot.x1 + 34.0, plot.y1);
        sheet.ops.push(background::picture(bar, 2.0, bar.corners().to_vec(), |(_, py)| {
            viridis((bar.y1 - py) / bar.height())
        }));
        sheet.frame(bar, 1.0, FRAME);
        sheet.text((bar.x0, plot.y0 + 9.0), &self.unit, TICK_TEXT, DARK, Align::Start);
        let mut levels: Vec<f64> = self.lines.iter().map(|l| l.level).chain([range.1]).collect();
        levels.sort_by(|a, b| b.total_cmp(a));
        levels.dedup();
        let mut last = f64::NEG_INFINITY;
        for level in levels {
            let at = bar.y1 - self.share(level, range) * bar.height();
            if (bar.y0..=bar.y1).contains(&at) && at - last >= 15.0 {
                sheet.line((bar.x1, at), (bar.x1 + 5.0, at), 1.0, FRAME);
                sheet.text((bar.x1 + 9.0, at + 0.36 * TICK_TEXT), &plain(level), TICK_TEXT, DARK, Align::Start);
                last = at;
            }
        }
    }
}

fn length(points: &[Point]) -> f64 {
    points.windows(2).map(|w| (w[1].0 - w[0].0).hypot(w[1].1 - w[0].1)).sum()
}

/// Places along a line, from its middle outwards.
fn candidates(points: &[Point]) -> Vec<Point> {
    const PLACES: usize = 48;
    let n = points.len();
    let shares = (0..PLACES).map(|k| if k % 2 == 0 { PLACES + k } else { PLACES - k });
    shares.map(|share| points[(share * (n - 1)) / (2 * PLACES)]).collect()
}

/// The value at a place, bilinear between the points of a grid and constant beyond them.
fn bilinear(columns: &[f64], rows: &[f64], values: &[f64], (x, y): Point) -> f64 {
    let locate = |list: &[f64], at: f64| {
        let last = list.len().saturating_sub(1);
        let i = list.partition_point(|v| *v <= at).saturating_sub(1).min(last.saturating_sub(1));
        let j = (i + 1).min(last);
        let t = if j > i { ((at - list[i]) / (list[j] - list[i])).clamp(0.0, 1.0) } else { 0.0 };
        (i, j, t)
    };
    if columns.is_empty() || rows.is_empty() || values.len() != columns.len() * rows.len() {
        return f64::NAN;
    }
    let ((c0, c1, s), (r0, r1, t)) = (locate(columns, x), locate(rows, y));
    let at = |c: usize, r: usize| values[r * columns.len() + c];
    let along = |r: usize| at(c0, r) + s * (at(c1, r) - at(c0, r));
    along(r0) + t * (along(r1) - along(r0))
}
