//! The curves of a spectrum panel: areas in the colours of the wavelengths, lines, sticks, and the weighting curve.

use super::axis::{self, AXIS_TEXT, Scale};
use super::png::mix;
use super::sheet::{Align, DARK, Ink, Point, Rect, Sheet, Text, WHITE, clean};
use super::spectrum::{Curve, CurveKind, SpectrumPanel, Weighting};
use super::{clip, font};

/// The weighting curve and its axis.
pub(super) const WEIGHTING: Ink = Ink::grey(60);
/// Under a curve without colours.
const PLAIN: [u8; 3] = [205; 3];
/// Colours that people with any colour vision tell apart (after Okabe and Ito 2008, darkened for white paper).
const PALETTE: [[u8; 3]; 8] = [
    [0, 98, 168],
    [205, 84, 0],
    [0, 138, 100],
    [172, 52, 124],
    [30, 30, 30],
    [58, 160, 214],
    [196, 138, 0],
    [132, 82, 62],
];
type Dash = Option<[f64; 2]>;

/// Colour and dashes of the curve at `index` among `count`.
pub(super) fn style(index: usize, count: usize) -> (Ink, Dash) {
    if count < 2 {
        return (DARK, None);
    }
    let dash = [None, Some([9.0, 4.0]), Some([3.0, 3.0]), Some([14.0, 3.0])][index / PALETTE.len() % 4];
    (Ink::rgb(PALETTE[index % PALETTE.len()]), dash)
}

/// A line, dashed or not.
pub(super) fn trace(sheet: &mut Sheet, points: &[Point], width: f64, ink: Ink, dash: Dash) {
    match dash {
        Some(pattern) => sheet.dashed(points, &pattern, width, ink),
        None => sheet.stroke(points.to_vec(), width, ink),
    }
}

/// All curves, the first lowest.
pub(super) fn draw(sheet: &mut Sheet, panel: &SpectrumPanel, plot: Rect, x: Scale, y: Scale, power: i32) {
    let single = panel.curves.len() == 1;
    let mut colours: Vec<(f64, [u8; 3])> = panel.colours.iter().copied().filter(|c| c.0.is_finite()).collect();
    colours.sort_by(|a, b| a.0.total_cmp(&b.0));
    colours.dedup_by(|a, b| a.0 == b.0);
    for (i, curve) in panel.curves.iter().enumerate() {
        let (ink, dash) = style(i, panel.curves.len());
        match curve.kind {
            CurveKind::Density => {
                for run in runs(curve, x, y, power) {
                    if single {
                        area(sheet, &run, plot, x, y.at(0.0), &colours);
                    }
                    if let [only] = run[..] {
                        mark(sheet, only, plot, y.at(0.0), ink);
                    }
                    for part in clip::line(&run, plot) {
                        trace(sheet, &part, if single { 1.8 } else { 2.0 }, ink, dash);
                    }
                }
            }
            CurveKind::Lines => {
                for (nm, point) in places(curve, x, y, power).filter(|p| p.1.1.is_finite()) {
                    let core = if single { Ink::rgb(colour_at(&colours, nm)) } else { ink };
                    stick(sheet, point, plot, y.at(0.0), core, single);
                }
            }
        }
    }
}

fn places(curve: &Curve, x: Scale, y: Scale, power: i32) -> impl Iterator<Item = (f64, Point)> {
    curve.samples().into_iter().map(move |(nm, v)| (nm, (x.at(nm), y.at(axis::divided(v, power)))))
}

/// Unbroken stretches of a density, thinned to what the sheet can show.
fn runs(curve: &Curve, x: Scale, y: Scale, power: i32) -> Vec<Vec<Point>> {
    let points: Vec<Point> = places(curve, x, y, power).map(|p| p.1).collect();
    points.split(|p| !p.1.is_finite()).filter(|run| !run.is_empty()).map(thinned).collect()
}

/// First, lowest, highest and last point of each half pixel, where there are more.
fn thinned(run: &[Point]) -> Vec<Point> {
    let column = |p: &Point| (p.0 * 2.0).floor();
    let mut out = Vec::new();
    for group in run.chunk_by(|a, b| column(a) == column(b)) {
        if group.len() <= 4 {
            out.extend_from_slice(group);
            continue;
        }
        let by = |best: fn(f64, f64) -> bool| {
            (1..group.len()).fold(0, |k, i| if best(group[i].1, group[k].1) { i } else { k })
        };
        let mut keep = [0, by(|a, b| a < b), by(|a, b| a > b), group.len() - 1];
        keep.sort_unstable();
        out.extend(keep.iter().enumerate().filter(|(n, i)| *n == 0 || keep[n - 1] != **i).map(|(_, &i)| group[i]));
    }
    out
}

fn area(sheet: &mut Sheet, run: &[Point], plot: Rect, x: Scale, zero: f64, colours: &[(f64, [u8; 3])]) {
    let (Some(first), Some(last)) = (run.first(), run.last()) else { return };
    let mut outline = vec![(first.0, zero)];
    outline.extend_from_slice(run);
    outline.push((last.0, zero));
    let outline = clip::polygon(&outline, plot);
    if outline.len() < 3 || first.0 == last.0 {
        return;
    }
    if colours.is_empty() {
        sheet.fill(outline, Ink::rgb(PLAIN));
        return;
    }
    // One stop every few pixels, so that colours given at each nanometre do not swell the file.
    let mut stops: Vec<(f64, [u8; 3])> = Vec::new();
    let count = (plot.width() / 6.0).ceil();
    for i in 0..=(count as i32) {
        let at = plot.x0 + plot.width() * f64::from(i) / count;
        let nm = x.low + (at - x.start) / (x.end - x.start) * (x.high - x.low);
        stops.push((at, colour_at(colours, nm)));
    }
    // Stops that continue an unchanging stretch add nothing.
    let same = |i: usize| i > 0 && i + 1 < stops.len() && stops[i - 1].1 == stops[i].1 && stops[i].1 == stops[i + 1].1;
    let stops = (0..stops.len()).filter(|&i| !same(i)).map(|i| stops[i]).collect();
    sheet.ops.push(super::sheet::Op::Gradient { outline, stops });
}

fn colour_at(colours: &[(f64, [u8; 3])], nm: f64) -> [u8; 3] {
    let after = colours.partition_point(|c| c.0 <= nm);
    match (after.checked_sub(1).map(|i| colours[i]), colours.get(after)) {
        (Some((a, from)), Some(&(b, to))) => mix(from, to, (nm - a) / (b - a)),
        (Some((_, c)), None) | (None, Some(&(_, c))) => c,
        (None, None) => PLAIN,
    }
}

/// A single sample: a dot on a thin stalk.
fn mark(sheet: &mut Sheet, at: Point, plot: Rect, zero: f64, ink: Ink) {
    if plot.grown(0.5).contains(at) {
        sheet.line((at.0, zero), at, 1.2, ink);
        sheet.disc(at, 4.0, ink);
    }
}

fn stick(sheet: &mut Sheet, (x, y): Point, plot: Rect, zero: f64, core: Ink, outlined: bool) {
    if !(plot.x0 - 0.5..=plot.x1 + 0.5).contains(&x) || y == zero {
        return;
    }
    let (y, zero) = (y.clamp(plot.y0, plot.y1), zero.clamp(plot.y0, plot.y1));
    if outlined {
        let cap = if y < zero { -1.0 } else { 1.0 };
        sheet.line((x, zero), (x, y + cap), 5.0, DARK);
        sheet.line((x, zero), (x, y), 3.0, core);
    } else {
        sheet.line((x, zero), (x, y), 2.4, core);
    }
}

/// Highest ink of the curves (least y) in each pixel column of the plot.
pub(super) fn outline_heights(panel: &SpectrumPanel, plot: Rect, x: Scale, y: Scale, power: i32) -> Vec<f64> {
    let mut out = vec![plot.y1; plot.width().max(1.0).ceil() as usize + 1];
    for curve in &panel.curves {
        match curve.kind {
            CurveKind::Density => {
                for pair in runs(curve, x, y, power).iter().flat_map(|run| run.windows(2)) {
                    let (a, b) = (pair[0], pair[1]);
                    let (from, to) = ((a.0 - plot.x0).max(0.0) as usize, (b.0 - plot.x0).max(0.0) as usize);
                    for (i, height) in out.iter_mut().enumerate().take(to.saturating_add(1)).skip(from) {
                        let t = ((plot.x0 + i as f64 - a.0) / (b.0 - a.0).max(1e-9)).clamp(0.0, 1.0);
                        *height = height.min(a.1 + t * (b.1 - a.1));
                    }
                }
            }
            CurveKind::Lines => {
                for (_, p) in places(curve, x, y, power).filter(|p| p.1.1.is_finite() && p.1.0 >= plot.x0 - 4.0) {
                    let from = (p.0 - 4.0 - plot.x0).max(0.0) as usize;
                    out.iter_mut().skip(from).take(9).for_each(|h| *h = h.min(p.1));
                }
            }
        }
    }
    out
}

/// The weighting curve, dashed, with its name where it covers least.
pub(super) fn weighting(sheet: &mut Sheet, w: &Weighting, plot: Rect, x: Scale, scale: Scale, taken: &[f64]) {
    let mut samples: Vec<(f64, f64)> =
        w.samples.iter().copied().filter(|s| s.0.is_finite() && s.1.is_finite()).collect();
    samples.sort_by(|a, b| a.0.total_cmp(&b.0));
    let points: Vec<Point> = samples.iter().map(|s| (x.at(s.0), scale.at(s.1))).collect();
    let parts = clip::line(&thinned(&points), plot);
    for part in &parts {
        sheet.stroke(part.clone(), 3.6, WHITE.alpha(0.75));
    }
    for part in &parts {
        sheet.dashed(part, &[7.0, 4.0], 1.6, WEIGHTING);
    }
    let name = clean(&w.name);
    let room = plot.width() / 3.0;
    let name = font::fit(&name, AXIS_TEXT, room);
    let text = |at, align| Text { at, text: name.clone(), size: AXIS_TEXT, ink: WEIGHTING, align, turned: false };
    let all: Vec<Point> = parts.concat();
    let highest = all.iter().map(|p| p.1).fold(f64::INFINITY, f64::min);
    let peak = all.iter().position(|p| p.1 == highest).unwrap_or(0);
    let best = all
        .iter()
        .enumerate()
        .filter(|(_, p)| (0.12..0.9).contains(&((p.1 - plot.y1) / (highest - plot.y1))))
        .map(|(i, p)| {
            if i > peak { text((p.0 + 8.0, p.1 + 2.0), Align::Start) } else { text((p.0 - 8.0, p.1 + 2.0), Align::End) }
        })
        .filter(|t| plot.grown(-3.0).holds(&t.bounds()))
        .map(|t| (covered(&t.bounds(), plot, taken, &all) + 0.04 * (t.at.1 - plot.y0), t))
        .min_by(|a, b| a.0.total_cmp(&b.0));
    if let Some((_, text)) = best {
        if covered(&text.bounds(), plot, taken, &all) > 0.0 {
            let plate = text.bounds().grown(2.0);
            sheet.fill(plate.corners().to_vec(), WHITE.alpha(0.8));
        }
        sheet.write(text);
    }
}

/// How much of a label lies on the curves below `taken`, or on the line `own`.
fn covered(label: &Rect, plot: Rect, taken: &[f64], own: &[Point]) -> f64 {
    let from = (label.x0 - 10.0 - plot.x0).max(0.0) as usize;
    let count = (label.width() + 20.0) as usize;
    let depth: f64 = taken.iter().skip(from).take(count).map(|y| (label.y1 + 8.0 - y).clamp(0.0, label.height())).sum();
    let touched = own.windows(2).filter(|w| !clip::line(w, label.grown(1.0)).is_empty()).count();
    depth / label.height() + 20.0 * touched as f64
}
