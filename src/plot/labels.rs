//! Labels that find a free place next to what they name.

use super::clip;
use super::sheet::{Align, Ink, Point, Rect, Sheet, Text, WHITE};
use super::{font, sheet};

/// The places already taken on a diagram.
#[derive(Debug)]
pub(super) struct Labels {
    within: Rect,
    boxes: Vec<Rect>,
    lines: Vec<Vec<Point>>,
}

/// How a label is to be set.
#[derive(Debug, Clone, Copy)]
pub(super) struct Manner {
    pub size: f64,
    pub ink: Ink,
    /// Distance from the middle of the marked place to the edge of its mark.
    pub clearance: f64,
    /// The direction to try first.
    pub towards: Point,
    /// Put a white plate under the label.
    pub plate: bool,
    /// Draw a thin line to labels that stand further off; without it they stay near and off all lines, or are left out.
    pub leader: bool,
}

impl Labels {
    /// Labels stay within `within`.
    pub(super) fn new(within: Rect) -> Self {
        Self { within, boxes: Vec::new(), lines: Vec::new() }
    }

    /// Keep labels off this box.
    pub(super) fn block(&mut self, r: Rect) {
        self.boxes.push(r);
    }

    /// Keep labels off this line where possible.
    pub(super) fn avoid(&mut self, line: Vec<Point>) {
        self.lines.push(line);
    }

    /// Write `text` next to `at`; false if there was no free place.
    pub(super) fn place(&mut self, sheet: &mut Sheet, at: Point, text: &str, manner: Manner) -> bool {
        const WAYS: i32 = 24;
        let text = font::fit(&sheet::clean(text), manner.size, 0.6 * self.within.width());
        let (w, h) = (font::width(&text, manner.size), 0.95 * manner.size);
        let length = manner.towards.0.hypot(manner.towards.1).max(1e-9);
        let mut best: Option<(f64, Point, f64)> = None;
        let distances: &[f64] =
            if manner.leader { &[4.0, 8.0, 16.0, 28.0, 44.0, 64.0, 90.0] } else { &[3.0, 6.0, 11.0, 17.0] };
        for &distance in distances {
            for way in 0..WAYS {
                let angle = std::f64::consts::TAU * f64::from(way) / f64::from(WAYS);
                let (dx, dy) = (angle.cos(), angle.sin());
                let reach = manner.clearance + distance;
                let centre = (at.0 + dx * (reach + w / 2.0), at.1 + dy * (reach + h / 2.0));
                let label = around(centre, w, h);
                if !self.within.holds(&label) || self.boxes.iter().any(|b| b.overlaps(&label.grown(1.5))) {
                    continue;
                }
                let crossed = self.lines.iter().filter(|l| !clip::line(l, label.grown(1.5)).is_empty()).count();
                if crossed > 0 && !manner.leader {
                    continue;
                }
                let turned = 1.0 - (dx * manner.towards.0 + dy * manner.towards.1) / length;
                let cost = 40.0 * crossed as f64 + distance + 6.0 * turned;
                if best.is_none_or(|b| cost < b.0) {
                    best = Some((cost, centre, distance));
                }
            }
        }
        let Some((_, centre, distance)) = best else { return false };
        let label = around(centre, w, h);
        if manner.leader && distance > 12.0 {
            let near = (at.0.clamp(label.x0, label.x1), at.1.clamp(label.y0, label.y1));
            sheet.line(at, near, 1.0, manner.ink);
        }
        if manner.plate {
            sheet.fill(label.grown(1.5).corners().to_vec(), WHITE.alpha(0.72));
        }
        self.boxes.push(label);
        let baseline = (centre.0, centre.1 + 0.36 * manner.size);
        sheet.write(Text {
            at: baseline,
            text,
            size: manner.size,
            ink: manner.ink,
            align: Align::Middle,
            turned: false,
        });
        true
    }

    /// Write `text` on a line, on a white plate that breaks it, where no other label is; false if there was no free place.
    pub(super) fn on_line(&mut self, sheet: &mut Sheet, line: &[Point], text: &str, size: f64, ink: Ink) -> bool {
        let text = sheet::clean(text);
        let (w, h) = (font::width(&text, size), 0.95 * size);
        // The place furthest from the labels that are there.
        let room = |at: &Point| {
            let label = around(*at, w, h);
            if !self.within.holds(&label) || self.boxes.iter().any(|b| b.overlaps(&label.grown(3.0))) {
                return None;
            }
            let apart = |b: &Rect| (at.0 - (b.x0 + b.x1) / 2.0).hypot(at.1 - (b.y0 + b.y1) / 2.0);
            Some(self.boxes.iter().map(apart).fold(60.0, f64::min))
        };
        let best = line.iter().filter_map(|p| room(p).map(|r| (r, *p))).max_by(|a, b| a.0.total_cmp(&b.0));
        let Some((_, at)) = best else { return false };
        let label = around(at, w, h);
        sheet.fill(label.grown(1.5).corners().to_vec(), WHITE.alpha(0.85));
        self.boxes.push(label);
        sheet.text((at.0, at.1 + 0.36 * size), &text, size, ink, Align::Middle);
        true
    }
}

fn around((x, y): Point, w: f64, h: f64) -> Rect {
    Rect::new(x - w / 2.0, y - h / 2.0, x + w / 2.0, y + h / 2.0)
}
