//! The isocandela diagram: lines of equal intensity over all directions.

use super::angular::{angle_step, degrees};
use super::axis::{self, AXIS_TEXT, BELOW, MARGIN, Scale, TICK_TEXT, Ticks};
use super::labels::{Labels, Manner};
use super::sheet::{Align, DARK, FRAME, GRID, Ink, Point, Rect, SOFT, Sheet, WHITE, clean};
use super::{clip, font};
use crate::math::contour::contours;

/// The web on which directions are laid out.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Web {
    /// Lambert's azimuthal equal-area projection about the axis: C around it, `sin(γ/2)` outwards, seen from above with C0 to the
    /// right and C90 upwards. For Type C; equal areas are equal solid angles.
    #[default]
    Azimuthal,
    /// H to the right and V upwards in equal degrees, as for floodlights and signal lamps (Types A and B).
    Rectangular,
}

/// One line of equal intensity.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Isoline {
    /// The intensity.
    pub value: f64,
    /// Written on the line, such as `50 %`.
    pub name: String,
    /// Drawn heavier.
    pub major: bool,
}

/// Lines of equal intensity. The values are linear along the edges of the grid's cells.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct IsocandelaPanel {
    /// Above the drawing; may be empty.
    pub title: String,
    /// The web.
    pub web: Web,
    /// C (0 to 360) or H, degrees, ascending.
    pub horizontal_deg: Vec<f64>,
    /// γ or V, degrees, ascending.
    pub vertical_deg: Vec<f64>,
    /// Row by row: `values[vertical * horizontal_deg.len() + horizontal]`.
    pub values: Vec<f64>,
    /// The lines.
    pub levels: Vec<Isoline>,
    /// Where the largest intensity is, in the same angles.
    pub peak_deg: (f64, f64),
    /// Largest γ, or largest |H| and |V|, that is shown, degrees.
    pub reach_deg: f64,
    /// What the levels are relative to, below the drawing.
    pub note: String,
}

const LABEL: f64 = 12.0;
const SCALE: f64 = 11.0;
const LINE: Ink = Ink::rgb([0, 84, 150]);
const PEAK: Ink = Ink::rgb([200, 40, 0]);

impl IsocandelaPanel {
    pub(super) fn draw(&self, sheet: &mut Sheet, area: Rect) {
        let top = axis::title(sheet, area, &self.title);
        let foot = area.y1 - MARGIN;
        let note = font::fit(&clean(&self.note), LABEL, area.width() - 2.0 * MARGIN);
        sheet.text(((area.x0 + area.x1) / 2.0, foot), &note, LABEL, SOFT, Align::Middle);
        let room = Rect::new(area.x0 + MARGIN, top, area.x1 - MARGIN, foot - 1.7 * LABEL);
        if self.values.len() != self.horizontal_deg.len() * self.vertical_deg.len() || self.reach_deg <= 0.0 {
            return;
        }
        match self.web {
            Web::Azimuthal => self.azimuthal(sheet, room),
            Web::Rectangular => self.rectangular(sheet, room),
        }
    }

    fn azimuthal(&self, sheet: &mut Sheet, room: Rect) {
        let centre = ((room.x0 + room.x1) / 2.0, (room.y0 + room.y1) / 2.0);
        let radius = (room.width() / 2.0 - 42.0).min(room.height() / 2.0 - 24.0).max(20.0);
        let most = (0.5 * self.reach_deg).to_radians().sin();
        let at = |(c, gamma): Point| {
            let r = radius * (0.5 * gamma).to_radians().sin() / most;
            let (s, k) = c.to_radians().sin_cos();
            (centre.0 + r * k, centre.1 - r * s)
        };
        let circle = |gamma: f64| -> Vec<Point> { (0..=181).map(|i| at((2.0 * f64::from(i), gamma))).collect() };
        let step = angle_step(self.reach_deg, 6.0);
        let rings = Ticks::multiples(step, self.reach_deg, step).values;
        for gamma in &rings {
            sheet.stroke(circle(*gamma), 1.0, GRID);
        }
        let mut labels = Labels::new(room);
        for ray in 0..24 {
            let c = 15.0 * f64::from(ray);
            let inner = if ray % 2 == 0 { 0.0 } else { step };
            let ink = if ray % 6 == 0 { Ink::grey(180) } else { GRID };
            sheet.line(at((c, inner)), at((c, self.reach_deg)), 1.0, ink);
            if ray % 2 == 0 {
                let (s, k) = c.to_radians().sin_cos();
                let text = if ray % 6 == 0 { format!("C{c}") } else { degrees(c) };
                let half = font::width(&text, LABEL) / 2.0;
                let place =
                    (centre.0 + k * (radius + half + 7.0), centre.1 - s * (radius + 0.5 * LABEL + 6.0) + 0.36 * LABEL);
                sheet.text(place, &text, LABEL, DARK, Align::Middle);
            }
        }
        sheet.stroke(circle(self.reach_deg), 1.2, FRAME);
        // γ along a ray between two of the labelled planes, the outermost first: towards 180° the circles crowd.
        let mut scale: Vec<(Rect, Point, String)> = Vec::new();
        for gamma in rings.iter().rev() {
            let (x, y) = at((285.0, *gamma));
            let text = degrees(*gamma);
            let half = font::width(&text, SCALE) / 2.0 + 2.0;
            let bounds = Rect::new(x - half, y - 6.5, x + half, y + 6.5);
            if !scale.iter().any(|s| s.0.overlaps(&bounds)) {
                labels.block(bounds);
                scale.push((bounds, (x, y), text));
            }
        }
        let lines = self.lines(|p| (p.1 <= self.reach_deg * 1.0001).then(|| at(p)));
        self.strokes(sheet, &lines);
        for (bounds, (x, y), text) in scale {
            sheet.fill(bounds.corners().to_vec(), WHITE.alpha(0.8));
            sheet.text((x, y + 0.36 * SCALE), &text, SCALE, SOFT, Align::Middle);
        }
        self.names(sheet, &mut labels, &lines, at(self.peak_deg));
    }

    fn rectangular(&self, sheet: &mut Sheet, room: Rect) {
        let side = (room.width() - AXIS_TEXT - 66.0).min(room.height() - BELOW - 12.0).max(40.0);
        let x0 = room.x0 + AXIS_TEXT + 56.0 + (room.width() - AXIS_TEXT - 66.0 - side).max(0.0) / 2.0;
        let plot = Rect::new(x0, room.y0 + 8.0, x0 + side, room.y0 + 8.0 + side);
        let x = Scale::new(-self.reach_deg, self.reach_deg, plot.x0, plot.x1);
        let y = Scale::new(-self.reach_deg, self.reach_deg, plot.y1, plot.y0);
        let ticks =
            Ticks::multiples(-self.reach_deg, self.reach_deg, angle_step(2.0 * self.reach_deg, (side / 38.0).floor()));
        axis::grid(sheet, plot, (x, &ticks), (y, &ticks));
        for line in [[(x.at(0.0), plot.y0), (x.at(0.0), plot.y1)], [(plot.x0, y.at(0.0)), (plot.x1, y.at(0.0))]] {
            sheet.line(line[0], line[1], 1.0, Ink::grey(180));
        }
        let at = |(h, v): Point| (x.at(h), y.at(v));
        let lines: Vec<(usize, Vec<Point>)> = self
            .lines(|p| Some(at(p)))
            .into_iter()
            .flat_map(|(level, line)| clip::line(&line, plot).into_iter().map(move |part| (level, part)))
            .collect();
        let mut labels = Labels::new(plot);
        self.strokes(sheet, &lines);
        self.names(sheet, &mut labels, &lines, at(self.peak_deg));
        sheet.frame(plot, 1.2, FRAME);
        axis::below(sheet, plot, x, &ticks, "H [°]");
        axis::left(sheet, plot, y, &ticks, "V [°]", plot.x0 - 16.0 - TICK_TEXT - ticks.width());
    }

    /// The lines of each level as places on the sheet, in parts where `place` has none.
    fn lines(&self, place: impl Fn(Point) -> Option<Point>) -> Vec<(usize, Vec<Point>)> {
        let mut out = Vec::new();
        for (i, level) in self.levels.iter().enumerate() {
            for line in contours(&self.horizontal_deg, &self.vertical_deg, &self.values, level.value) {
                let places: Vec<Option<Point>> = line.into_iter().map(&place).collect();
                let parts =
                    places.split(Option::is_none).map(|part| part.iter().flatten().copied().collect::<Vec<_>>());
                out.extend(parts.filter(|p| p.len() > 1).map(|p| (i, p)));
            }
        }
        out
    }

    fn strokes(&self, sheet: &mut Sheet, lines: &[(usize, Vec<Point>)]) {
        for (level, line) in lines {
            let (width, ink) = if self.levels[*level].major { (2.0, LINE) } else { (1.2, LINE.alpha(0.85)) };
            sheet.stroke(line.clone(), width, ink);
        }
    }

    /// The maximum with its mark, and one name per level.
    fn names(&self, sheet: &mut Sheet, labels: &mut Labels, lines: &[(usize, Vec<Point>)], peak: Point) {
        for (dx, dy) in [(6.0, 0.0), (0.0, 6.0)] {
            sheet.line((peak.0 - dx, peak.1 - dy), (peak.0 + dx, peak.1 + dy), 1.6, PEAK);
        }
        labels.block(Rect::new(peak.0, peak.1, peak.0, peak.1).grown(6.0));
        let manner = Manner { size: LABEL, ink: PEAK, clearance: 6.0, towards: (1.0, -1.0), plate: true, leader: true };
        labels.place(sheet, peak, "max", manner);
        // On its longest line, where it is furthest from the names already there.
        for (i, level) in self.levels.iter().enumerate() {
            let length = |l: &[Point]| l.windows(2).map(|w| (w[1].0 - w[0].0).hypot(w[1].1 - w[0].1)).sum::<f64>();
            let longest = lines.iter().filter(|l| l.0 == i).max_by(|a, b| length(&a.1).total_cmp(&length(&b.1)));
            if let Some((_, line)) = longest {
                labels.on_line(sheet, line, &level.name, LABEL, LINE);
            }
        }
    }
}
