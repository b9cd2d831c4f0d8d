//! The polar diagram of a luminaire: intensity as distance from the middle, the axis downwards.

use super::angular::{self, AngularCurve, degrees};
use super::axis::{self, MARGIN};
use super::sheet::{Align, DARK, FRAME, Ink, Point, Rect, SOFT, Sheet, WHITE};
use super::{clip, font};

/// Intensity curves around the axis: γ = 0 points down, positive angles (C0, C90) lie right, negative ones (C180, C270) left.
///
/// The upper or the lower half is left out where no curve goes. Negative values are drawn as zero, and the panel says so.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PolarPanel {
    /// Above the drawing; may be empty.
    pub title: String,
    /// At most [`super::MOST_ANGULAR_CURVES`] stay apart.
    pub curves: Vec<AngularCurve>,
    /// Unit of the values, such as `cd/klm`.
    pub unit: String,
}

const LABEL: f64 = 12.0;
const NOTE: f64 = 12.0;
/// Room for the angles around the outermost circle.
const AROUND: (f64, f64) = (38.0, 24.0);
/// Light in a half below this part of the outermost circle would not be seen.
const VISIBLE: f64 = 0.005;
/// Widest step along a curve, degrees: a straight line in angle and intensity is an arc here.
const SMOOTH_DEG: f64 = 1.0;
const RING: Ink = Ink::grey(198);
const RAY: Ink = Ink::grey(218);

/// Where things are: the middle, pixels per unit, the outermost circle.
struct Frame {
    centre: Point,
    radius: f64,
    most: f64,
}

impl Frame {
    /// The place of a direction at a part of the outermost circle's radius.
    fn ray(&self, angle_deg: f64, part: f64) -> Point {
        let (s, c) = angle_deg.to_radians().sin_cos();
        (self.centre.0 + part * self.radius * s, self.centre.1 + part * self.radius * c)
    }

    fn at(&self, (angle, value): (f64, f64)) -> Point {
        self.ray(angle, value.max(0.0) / self.most)
    }
}

impl PolarPanel {
    pub(super) fn draw(&self, sheet: &mut Sheet, area: Rect) {
        let top = axis::title(sheet, area, &self.title);
        let values = || self.curves.iter().flat_map(AngularCurve::samples);
        let largest = values().map(|s| s.1).fold(0.0, f64::max);
        let power = axis::exponent(largest);
        let (step, count) = rings(if largest > 0.0 { axis::divided(largest, power) } else { 1.0 });
        // In units of ten to the power, so that neither tiny nor huge intensities leave the range of doubles.
        let most = step * f64::from(count);
        let names: Vec<&str> = self.curves.iter().map(|c| c.name.as_str()).collect();
        let unit = if power == 0 { self.unit.clone() } else { format!("{} {}", axis::power_of_ten(power), self.unit) };
        let top = angular::legend(sheet, area, top, &names, &unit);

        let lit =
            |half: fn(f64) -> bool| values().any(|(a, v)| half(a.abs()) && axis::divided(v, power) > VISIBLE * most);
        let (up, down) = (lit(|a| a > 90.0), lit(|a| a < 90.0));
        let halves = if up && down { (true, true) } else { (up, !up) };
        let negative = values().any(|s| s.1 < 0.0);
        let note = if negative { 1.6 * NOTE } else { 0.0 };
        let room = Rect::new(area.x0 + MARGIN, top, area.x1 - MARGIN, area.y1 - MARGIN - note);
        let frame = Self::frame(room, halves, most);
        let web = Web { frame: &frame, halves, step, count };
        web.draw(sheet);
        let lines: Vec<Vec<Point>> = self.curves.iter().map(|c| line(c, &frame, power)).collect();
        web.label_rings(sheet, &lines);
        for (i, line) in lines.iter().enumerate() {
            angular::trace(sheet, i, line);
        }
        if negative {
            let at = ((area.x0 + area.x1) / 2.0, area.y1 - MARGIN);
            sheet.text(at, "negative intensities are drawn as zero", NOTE, SOFT, Align::Middle);
        }
    }

    fn frame(room: Rect, (up, down): (bool, bool), most: f64) -> Frame {
        let across = room.width() / 2.0 - AROUND.0;
        let middle = (room.x0 + room.x1) / 2.0;
        let y = (room.y0 + room.y1) / 2.0;
        let (radius, y) = match (up, down) {
            (true, true) => (across.min(room.height() / 2.0 - AROUND.1), y),
            _ => {
                let radius = across.min(room.height() - 2.0 * AROUND.1);
                (radius, if up { y + radius / 2.0 } else { y - radius / 2.0 })
            }
        };
        Frame { centre: (middle, y), radius: radius.max(20.0), most }
    }
}

/// Round step of the circles and how many, for values up to `largest`.
fn rings(largest: f64) -> (f64, u32) {
    let rough = largest / 6.0;
    let unit = 10f64.powf(rough.log10().floor());
    let step = [1.0, 2.0, 2.5, 5.0, 10.0].map(|f| f * unit).into_iter().find(|s| *s >= rough * 0.999);
    let step = step.unwrap_or(10.0 * unit);
    (step, ((largest / step - 1e-3).ceil() as u32).max(1))
}

/// Decimals that multiples of a round step need.
fn decimals(step: f64) -> usize {
    (0..6).find(|d| (step * 10f64.powi(*d) - (step * 10f64.powi(*d)).round()).abs() < 1e-6).unwrap_or(6) as usize
}

/// The curve as places, with arcs between its entries.
fn line(curve: &AngularCurve, frame: &Frame, power: i32) -> Vec<Point> {
    let samples: Vec<(f64, f64)> = curve.samples().map(|(a, v)| (a, axis::divided(v, power))).collect();
    let mut out: Vec<Point> = samples.first().map(|s| frame.at(*s)).into_iter().collect();
    for pair in samples.windows(2) {
        let ((a, from), (b, to)) = (pair[0], pair[1]);
        let parts = ((b - a) / SMOOTH_DEG).ceil().clamp(1.0, 360.0) as u32;
        for i in 1..=parts {
            let t = f64::from(i) / f64::from(parts);
            let value = if i == parts { to } else { from + t * (to - from) };
            out.push(frame.at((a + t * (b - a), value)));
        }
    }
    out
}

/// Circles, rays and their labels.
struct Web<'a> {
    frame: &'a Frame,
    halves: (bool, bool),
    step: f64,
    count: u32,
}

impl Web<'_> {
    /// First and last whole multiple of 15° that is drawn, on the right.
    fn range(&self) -> (i32, i32) {
        (if self.halves.1 { 0 } else { 6 }, if self.halves.0 { 12 } else { 6 })
    }

    fn draw(&self, sheet: &mut Sheet) {
        let frame = self.frame;
        let (first, last) = self.range();
        for ring in 1..=self.count {
            let part = f64::from(ring) / f64::from(self.count);
            let (ink, width) = if ring == self.count { (FRAME, 1.2) } else { (RING, 1.0) };
            let half = |side: f64| -> Vec<Point> {
                (15 * first..=15 * last).map(|a| frame.ray(side * f64::from(a), part)).collect()
            };
            // From the left end over the bottom (or top) to the right, so that one line makes the circle.
            let mut points = half(-1.0);
            let mut right = half(1.0);
            if self.halves.1 {
                points.reverse();
            } else {
                right.reverse();
            }
            points.extend(right);
            sheet.stroke(points, width, ink);
        }
        for ray in first..=last {
            let angle = f64::from(15 * ray);
            let main = ray % 6 == 0;
            for side in if ray % 12 == 0 { vec![1.0] } else { vec![1.0, -1.0] } {
                let inner = if ray % 2 == 0 { 0.0 } else { 1.0 / f64::from(self.count) };
                let ink = if main { Ink::grey(150) } else { RAY };
                sheet.line(frame.ray(side * angle, inner), frame.ray(side * angle, 1.0), 1.0, ink);
                if ray % 2 == 0 {
                    self.label_ray(sheet, side * angle);
                }
            }
        }
    }

    fn label_ray(&self, sheet: &mut Sheet, angle: f64) {
        let (s, c) = angle.to_radians().sin_cos();
        let text = degrees(angle.abs());
        let half = font::width(&text, LABEL) / 2.0;
        let (x, y) = self.frame.ray(angle, 1.0);
        let at = (x + s * (half + 7.0), y + c * (0.5 * LABEL + 6.0) + 0.36 * LABEL);
        sheet.text(at, &text, LABEL, DARK, Align::Middle);
    }

    /// Values of the circles along the horizontal, on the side where curves are less in the way.
    fn label_rings(&self, sheet: &mut Sheet, curves: &[Vec<Point>]) {
        let decimals = decimals(self.step);
        let text = |ring: u32| axis::number(f64::from(ring) * self.step, decimals);
        let spacing = self.frame.radius / f64::from(self.count);
        let widest = (1..=self.count).map(|r| font::width(&text(r), LABEL)).fold(0.0, f64::max);
        let every = (1..=self.count).find(|e| f64::from(*e) * spacing > widest + 8.0).unwrap_or(self.count);
        let labels = |side: f64| -> Vec<(super::sheet::Text, Rect)> {
            (1..=self.count)
                .filter(|ring| (self.count - ring).is_multiple_of(every))
                .map(|ring| {
                    let x = self.frame.ray(side * 90.0, f64::from(ring) / f64::from(self.count)).0 - 4.0 * side;
                    let above = if self.halves.0 && !self.halves.1 { 1.05 * LABEL } else { -4.0 };
                    let at = (x, self.frame.centre.1 + above);
                    let align = if side > 0.0 { Align::End } else { Align::Start };
                    let text = text(ring);
                    let text = super::sheet::Text { at, text, size: LABEL, ink: DARK, align, turned: false };
                    let bounds = text.bounds();
                    (text, bounds)
                })
                .collect()
        };
        let crossed = |(_, bounds): &(super::sheet::Text, Rect)| {
            curves.iter().filter(|c| !clip::line(c, *bounds).is_empty()).count()
        };
        let [right, left] = [labels(1.0), labels(-1.0)];
        let count = |all: &[(super::sheet::Text, Rect)]| all.iter().map(crossed).sum::<usize>();
        let chosen = if count(&left) < count(&right) { left } else { right };
        for (text, bounds) in chosen {
            sheet.fill(bounds.grown(1.0).corners().to_vec(), WHITE.alpha(0.8));
            sheet.write(text);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn circles_are_round_and_few() {
        for (largest, step, count) in
            [(1.0, 0.2, 5), (437.0, 100.0, 5), (1234.0, 250.0, 5), (600.0, 100.0, 6), (0.9, 0.2, 5)]
        {
            let (s, n) = rings(largest);
            assert!((s - step).abs() < 1e-9 * step && n == count, "{largest}: {s} × {n}");
        }
        assert_eq!((decimals(0.25), decimals(0.2), decimals(100.0)), (2, 1, 0));
    }
}
