//! The colour vector graphic of ANSI/IES TM-30: how hue and chroma shift from the reference light to the test light.

use std::f64::consts::TAU;

use super::axis::{self, MARGIN, number};
use super::background;
use super::font;
use super::sheet::{Align, DARK, FRAME, Ink, Point, Rect, SOFT, Sheet, WHITE};

/// Sixteen arrows from the circle of the reference light to the test light.
///
/// The hue colours are our own, chosen from the hue angle; TM-30 prescribes the geometry.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ColourVectorPanel {
    /// Above the drawing; may be empty.
    pub title: String,
    /// For the hue bins 1 to 16: the reference point on the unit circle, and the test point, as (a′, b′) scaled by the
    /// reference chroma of the bin.
    pub vectors: [([f64; 2], [f64; 2]); 16],
    /// Fidelity index Rf.
    pub fidelity: f64,
    /// Gamut index Rg.
    pub gamut: f64,
    /// Correlated colour temperature in kelvins.
    pub cct_k: Option<f64>,
    /// Distance from the Planckian locus in u, v, positive above it.
    pub duv: Option<f64>,
}

const TEST: Ink = Ink::rgb([196, 30, 30]);
const BIN_TEXT: f64 = 12.0;
const INDEX_TEXT: f64 = 26.0;
const CORNER_TEXT: f64 = 15.0;

impl ColourVectorPanel {
    pub(super) fn draw(&self, sheet: &mut Sheet, area: Rect) {
        let top = axis::title(sheet, area, &self.title);
        let room = Rect::new(area.x0 + MARGIN, top + 2.0, area.x1 - MARGIN, area.y1 - MARGIN);
        let side = room.width().min(room.height());
        let centre = ((room.x0 + room.x1) / 2.0, (room.y0 + room.y1) / 2.0);
        let plot = Rect::new(centre.0, centre.1, centre.0, centre.1).grown(side / 2.0);
        let reach = self.reach();
        let scale = side / 2.0 / reach;
        let at = |p: [f64; 2]| (centre.0 + scale * p[0], centre.1 - scale * p[1]);

        backdrop(sheet, plot, centre, scale, reach);
        // Text is smaller in a small drawing, so that it stays clear of the circle.
        let text = (side / 420.0).clamp(0.7, 1.0);
        self.circles(sheet, centre, scale, text);
        Self::legend(sheet, centre, scale, text);
        self.arrows(sheet, at, scale);
        self.numbers(sheet, centre, scale, text);
        self.corners(sheet, plot, text);
        sheet.frame(plot, 1.2, FRAME);
    }

    /// Half the side of the drawing in units of the reference circle.
    fn reach(&self) -> f64 {
        let far = self.vectors.iter().map(|v| v.1[0].abs().max(v.1[1].abs())).filter(|d| d.is_finite());
        (far.fold(0.0, f64::max) + 0.12).clamp(1.5, 4.0)
    }

    /// The reference circle and those of 20 % more and less chroma.
    fn circles(&self, sheet: &mut Sheet, centre: Point, scale: f64, text_scale: f64) {
        let size = BIN_TEXT * text_scale;
        for bin in 0..16 {
            let (s, c) = (TAU * f64::from(bin) / 16.0).sin_cos();
            let ray = |r: f64| (centre.0 + r * scale * c, centre.1 - r * scale * s);
            sheet.dashed(&[ray(0.08), ray(1.42)], &[2.0, 4.0], 0.9, Ink::grey(150));
        }
        for (radius, text) in [(0.8, "−20 %"), (1.2, "+20 %")] {
            sheet.dashed(&ring(centre, radius * scale), &[6.0, 4.0], 1.1, Ink::grey(105));
            let place = (centre.0, centre.1 + radius * scale);
            let label = super::sheet::Text {
                at: (place.0, place.1 + 0.36 * size),
                text: text.to_owned(),
                size,
                ink: SOFT,
                align: Align::Middle,
                turned: false,
            };
            sheet.fill(label.bounds().grown(1.0).corners().to_vec(), WHITE.alpha(0.75));
            sheet.write(label);
        }
        sheet.stroke(ring(centre, scale), 2.0, DARK);
        for (dx, dy) in [(6.0, 0.0), (0.0, 6.0)] {
            sheet.line((centre.0 - dx, centre.1 - dy), (centre.0 + dx, centre.1 + dy), 1.2, SOFT);
        }
    }

    /// The test gamut, and an arrow in the colour of its hue for each bin.
    fn arrows(&self, sheet: &mut Sheet, at: impl Fn([f64; 2]) -> Point, scale: f64) {
        let limit = |p: [f64; 2]| p.map(|v| v.clamp(-3.9, 3.9));
        let known = |v: &&([f64; 2], [f64; 2])| v.0.iter().chain(&v.1).all(|c| c.is_finite());
        let mut gamut: Vec<Point> = self.vectors.iter().filter(known).map(|v| at(limit(v.1))).collect();
        if gamut.len() > 2 {
            gamut.extend([gamut[0], gamut[1]]);
            sheet.stroke(gamut.clone(), 3.8, WHITE.alpha(0.7));
            sheet.stroke(gamut, 2.0, TEST);
        }
        for (bin, (from, to)) in self.vectors.iter().enumerate() {
            if known(&&(*from, *to)) {
                let ink = Ink::rgb(background::of_hue(bin_angle(bin), 0.56, 1.0));
                arrow(sheet, at(limit(*from)), at(limit(*to)), ink, scale);
            }
        }
    }

    fn numbers(&self, sheet: &mut Sheet, centre: Point, scale: f64, text_scale: f64) {
        let size = (BIN_TEXT + 1.0) * text_scale;
        let far = |bin: usize| {
            // Beyond the outer circle, or beyond an arrow that passes it.
            let (s, c) = bin_angle(bin).sin_cos();
            let to = self.vectors[bin].1;
            let along = to[0] * c + to[1] * s;
            if along.is_finite() { (along + 0.12).max(1.33) } else { 1.33 }
        };
        for bin in 0..16 {
            let (s, c) = bin_angle(bin).sin_cos();
            let r = far(bin).min(self.reach() - 0.07) * scale;
            let place = (centre.0 + r * c, centre.1 - r * s + 0.36 * size);
            let ink = Ink::rgb(background::of_hue(bin_angle(bin), 0.42, 1.0));
            sheet.text(place, &format!("{}", bin + 1), size, ink, Align::Middle);
        }
    }

    fn corners(&self, sheet: &mut Sheet, plot: Rect, text_scale: f64) {
        let (large, small) = (INDEX_TEXT * text_scale, CORNER_TEXT * text_scale);
        let inset = 12.0 * text_scale;
        let (left, right) = (plot.x0 + inset, plot.x1 - inset);
        let (top, bottom) = (plot.y0 + inset, plot.y1 - inset);
        let index = |v: f64| if v.is_finite() { number(v, 0) } else { "–".to_owned() };
        for (name, value, x, align) in
            [("Rf", self.fidelity, left, Align::Start), ("Rg", self.gamut, right, Align::End)]
        {
            let y = top + 0.75 * large;
            sheet.text((x, y), &index(value), large, DARK, align);
            sheet.text((x, y + 1.35 * small), name, small, SOFT, align);
        }
        let upper = bottom - 1.35 * small;
        if let Some(cct) = self.cct_k.filter(|t| t.is_finite()) {
            sheet.text((left, upper), &format!("{} K", number(cct, 0)), small, DARK, Align::Start);
            sheet.text((left, bottom), "CCT", small, SOFT, Align::Start);
        }
        if let Some(duv) = self.duv.filter(|d| d.is_finite()) {
            let sign = if duv >= 0.000_05 { "+" } else { "" };
            sheet.text((right, upper), &format!("{sign}{}", number(duv, 4)), small, DARK, Align::End);
            sheet.text((right, bottom), "Duv", small, SOFT, Align::End);
        }
    }

    /// Which line is which light, in the empty middle.
    fn legend(sheet: &mut Sheet, centre: Point, scale: f64, text_scale: f64) {
        let size = BIN_TEXT * text_scale;
        let (dash, gap) = (1.8 * size, 0.5 * size);
        let width = dash + gap + font::width("reference", size);
        let (left, top) = (centre.0 - width / 2.0, centre.1 + 0.28 * scale);
        let plate = Rect::new(left, top, left + width, top + 2.6 * size).grown(0.4 * size);
        sheet.fill(plate.corners().to_vec(), WHITE.alpha(0.75));
        for (name, ink, y) in [("reference", DARK, top + 0.9 * size), ("test", TEST, top + 2.3 * size)] {
            sheet.line((left, y - 0.3 * size), (left + dash, y - 0.3 * size), 2.0, ink);
            sheet.text((left + dash + gap, y), name, size, SOFT, Align::Start);
        }
    }
}

/// The middle of a hue bin.
fn bin_angle(bin: usize) -> f64 {
    TAU * (bin as f64 + 0.5) / 16.0
}

/// Pale hues, stronger outwards.
fn backdrop(sheet: &mut Sheet, plot: Rect, centre: Point, scale: f64, reach: f64) {
    let colour = |(x, y): Point| {
        let (a, b) = ((x - centre.0) / scale, (centre.1 - y) / scale);
        background::of_hue(b.atan2(a), 0.955, 0.42 * (a.hypot(b) / reach).min(1.0))
    };
    sheet.ops.push(background::picture(plot.grown(4.0), 4.0, plot.corners().to_vec(), colour));
}

fn ring(centre: Point, radius: f64) -> Vec<Point> {
    let place = |i: i32| {
        let (s, c) = (TAU * f64::from(i) / 180.0).sin_cos();
        (centre.0 + radius * c, centre.1 + radius * s)
    };
    (0..=181).map(place).collect()
}

/// An arrow; the head shrinks with short arrows.
fn arrow(sheet: &mut Sheet, from: Point, to: Point, ink: Ink, scale: f64) {
    let length = (to.0 - from.0).hypot(to.1 - from.1);
    if length < 0.5 {
        sheet.disc(to, 2.5, ink);
        return;
    }
    let head = (0.065 * scale).min(0.62 * length).max(3.0);
    let (dx, dy) = ((to.0 - from.0) / length, (to.1 - from.1) / length);
    let neck = (to.0 - head * dx, to.1 - head * dy);
    let half = (0.45 * head).max(2.4);
    sheet.line(from, neck, 2.8, ink);
    sheet.fill(vec![to, (neck.0 - half * dy, neck.1 + half * dx), (neck.0 + half * dy, neck.1 - half * dx)], ink);
}
