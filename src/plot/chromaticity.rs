//! The chromaticity panel: what it takes, its axes and points.

use super::axis::{self, AXIS_TEXT, BELOW, MARGIN, Scale, TICK_TEXT};
use super::clip;
use super::horseshoe::{self, Map};
use super::inset::{self, Inset};
use super::labels::{Labels, Manner};
use super::sheet::{Align, DARK, FRAME, Point, Rect, SOFT, Sheet, WHITE};

/// Which chromaticity diagram.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[non_exhaustive]
pub enum Diagram {
    /// CIE 1976 UCS diagram, u′ and v′.
    #[default]
    Cie1976,
    /// CIE 1931 diagram, x and y.
    Cie1931,
}

/// A monochromatic stimulus on the spectral locus.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct LocusPoint {
    /// Wavelength in nanometres.
    pub wavelength_nm: f64,
    /// CIE 1931 x.
    pub x: f64,
    /// CIE 1931 y.
    pub y: f64,
}

/// A point of the Planckian locus.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct PlanckPoint {
    /// Temperature in kelvins; may be infinite.
    pub temperature_k: f64,
    /// CIE 1931 x.
    pub x: f64,
    /// CIE 1931 y.
    pub y: f64,
}

/// A chromaticity to be shown.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct MarkedPoint {
    /// Written beside the point; may be empty.
    pub name: String,
    /// CIE 1931 x.
    pub x: f64,
    /// CIE 1931 y.
    pub y: f64,
    /// Draw it hollow, as something to compare with.
    pub reference: bool,
}

/// Points in a chromaticity diagram, with the spectral locus and the Planckian locus.
///
/// All chromaticities are given as CIE 1931 x and y, whichever diagram is drawn. Points near the Planckian locus are
/// shown a second time in an enlarged part.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ChromaticityPanel {
    /// Above the drawing; may be empty.
    pub title: String,
    /// u′v′ or xy.
    pub diagram: Diagram,
    /// The spectral locus by rising wavelength, at steps of 5 nm or finer.
    pub locus: Vec<LocusPoint>,
    /// The Planckian locus, from about 1000 K to infinity in steps that are small in 1/T.
    pub planck: Vec<PlanckPoint>,
    /// The chromaticities to show.
    pub points: Vec<MarkedPoint>,
    /// Outlines of tolerances, as closed lines of x and y.
    pub regions: Vec<Vec<(f64, f64)>>,
}

/// Size of the labels of points.
pub(super) const POINT_TEXT: f64 = 14.0;
const RADIUS: f64 = 5.0;
/// More points than this get labels only where there is room right beside them.
const CROWD: usize = 14;

impl ChromaticityPanel {
    pub(super) fn draw(&self, sheet: &mut Sheet, area: Rect) {
        let top = axis::title(sheet, area, &self.title) + 6.0;
        // The spectral locus, and the pixels around it that the wavelengths need.
        let (low, high) = match self.diagram {
            Diagram::Cie1976 => ((0.0, 0.015), (0.624, 0.588)),
            Diagram::Cie1931 => ((0.0, 0.0), (0.735, 0.835)),
        };
        let (before, after) = ((44.0, 28.0), (34.0, 30.0));
        let left = area.x0 + MARGIN + AXIS_TEXT + 20.0 + 24.0;
        let room = Rect::new(left, top, area.x1 - MARGIN - 6.0, area.y1 - MARGIN - BELOW);
        let enlarged = inset::window(self);
        // Where the panel is wide, the enlarged part stands beside the diagram, otherwise in its empty corner.
        let beside = enlarged.is_some() && room.width() > 1.4 * room.height();
        let column = if beside { (0.33 * room.width()).max(150.0) } else { 0.0 };
        let zoom = ((room.width() - column - before.0 - after.0) / (high.0 - low.0))
            .min((room.height() - before.1 - after.1) / (high.1 - low.1))
            .max(1.0);
        let low = (low.0 - before.0 / zoom, low.1 - before.1 / zoom);
        let high = (high.0 + after.0 / zoom, high.1 + after.1 / zoom);
        let spare = (room.width() - zoom * (high.0 - low.0), room.height() - zoom * (high.1 - low.1));
        // Fill the room with a little more of the plane, rather than leave a gap.
        let more = (if beside { 0.0 } else { (spare.0 / zoom).min(0.1) / 2.0 }, (spare.1 / zoom).min(0.1) / 2.0);
        let (low, high) = ((low.0 - more.0, low.1 - more.1), (high.0 + more.0, high.1 + more.1));
        let (width, height) = (zoom * (high.0 - low.0), zoom * (high.1 - low.1));
        let x0 = if beside { left } else { left + (room.width() - width) / 2.0 };
        let plot = Rect::new(x0, room.y1 - height, x0 + width, room.y1);
        let x = Scale::new(low.0, high.0, plot.x0, plot.x1);
        let y = Scale::new(low.1, high.1, plot.y1, plot.y0);
        let map = Map { diagram: self.diagram, x, y };

        let spacing = (0.09 * zoom).max(42.0);
        let (x_ticks, y_ticks) = (x.ticks(spacing), y.ticks(spacing));
        axis::grid(sheet, plot, (x, &x_ticks), (y, &y_ticks));
        let mut labels = Labels::new(plot.grown(-3.0));
        horseshoe::draw(sheet, self, &map, &mut labels);
        regions(sheet, self, &map, plot);
        let place = match (beside, self.diagram) {
            (true, _) => {
                let height = plot.height().min(1.35 * (room.x1 - plot.x1 - 16.0));
                Rect::new(plot.x1 + 16.0, plot.y0, room.x1, plot.y0 + height)
            }
            (_, Diagram::Cie1976) => Rect::new(x.at(0.425), y.at(0.195), plot.x1 - 10.0, plot.y1 - 24.0),
            (_, Diagram::Cie1931) => Rect::new(x.at(0.49), plot.y0 + 10.0, plot.x1 - 12.0, y.at(0.585)),
        };
        let inset = enlarged.and_then(|window| Inset::new(window, place, &map));
        if let Some(inset) = &inset {
            labels.block(inset.room.grown(4.0));
            labels.block(inset.outline.grown(1.0));
        }
        for point in &self.points {
            labels.block(around(map.place((point.x, point.y))));
        }
        horseshoe::temperatures(sheet, self, &map, plot, &mut labels, inset.as_ref().map(|i| i.outline));
        let mut silent = inset.as_ref().map_or(0, |inset| inset.draw(sheet, self));
        let note = Rect::new(plot.x0, plot.y1 - 26.0, plot.x0 + 190.0, plot.y1);
        labels.block(note);
        silent += self.points(sheet, &map, plot, &mut labels, inset.as_ref().map(|i| i.outline.grown(-2.3)));
        if silent > 0 {
            let text = format!("{silent} more without a label");
            sheet.text((plot.x0 + 8.0, plot.y1 - 9.0), &text, TICK_TEXT, SOFT, Align::Start);
        }
        sheet.frame(plot, 1.2, FRAME);
        let (x_name, y_name) = match self.diagram {
            Diagram::Cie1976 => ("u′", "v′"),
            Diagram::Cie1931 => ("x", "y"),
        };
        axis::below(sheet, plot, x, &x_ticks, x_name);
        axis::left(sheet, plot, y, &y_ticks, y_name, plot.x0 - 20.0 - y_ticks.width());
    }

    /// Marks for all points, and labels for those that the enlarged part does not name; gives the number without one.
    fn points(&self, sheet: &mut Sheet, map: &Map, plot: Rect, labels: &mut Labels, shown: Option<Rect>) -> usize {
        let inner = plot.grown(-RADIUS - 3.0);
        let mut placed: Vec<(Point, &MarkedPoint, bool)> = Vec::new();
        for point in &self.points {
            let at = map.place((point.x, point.y));
            if at.0.is_finite() && at.1.is_finite() {
                let held = (at.0.clamp(inner.x0, inner.x1), at.1.clamp(inner.y0, inner.y1));
                placed.push((held, point, plot.contains(at)));
            }
        }
        for &(at, point, inside) in &placed {
            if inside {
                mark(sheet, at, point.reference);
            } else {
                arrow(sheet, at, ((plot.x0 + plot.x1) / 2.0, (plot.y0 + plot.y1) / 2.0));
            }
            labels.block(around(at));
        }
        let mut silent = self.points.len() - placed.len();
        for (at, point, inside) in placed {
            if inside && shown.is_some_and(|window| window.contains(at)) {
                continue;
            }
            let name = if inside { point.name.clone() } else { format!("{} (off the diagram)", point.name) };
            if !name.is_empty() && !labels.place(sheet, at, &name, manner(self.points.len())) {
                silent += 1;
            }
        }
        silent
    }
}

/// The outlines of tolerances.
pub(super) fn regions(sheet: &mut Sheet, panel: &ChromaticityPanel, map: &Map, plot: Rect) {
    for region in &panel.regions {
        let line: Vec<Point> = region.iter().map(|p| map.place(*p)).collect();
        for part in clip::line(&line, plot) {
            sheet.stroke(part, 1.0, DARK);
        }
    }
}

/// How points are labelled.
pub(super) fn manner(count: usize) -> Manner {
    let leader = count <= CROWD;
    Manner { size: POINT_TEXT, ink: DARK, clearance: RADIUS + 1.0, towards: (1.0, -0.25), plate: true, leader }
}

pub(super) fn around((x, y): Point) -> Rect {
    Rect::new(x, y, x, y).grown(RADIUS + 1.0)
}

/// A dot with a white rim, hollow for references.
pub(super) fn mark(sheet: &mut Sheet, at: Point, hollow: bool) {
    sheet.disc(at, RADIUS + 1.5, WHITE);
    sheet.disc(at, RADIUS, DARK);
    if hollow {
        sheet.disc(at, RADIUS - 2.0, WHITE);
    }
}

/// A wedge at the edge of the diagram, pointing away from its middle.
fn arrow(sheet: &mut Sheet, (x, y): Point, middle: Point) {
    let length = (x - middle.0).hypot(y - middle.1).max(1e-9);
    let (dx, dy) = ((x - middle.0) / length, (y - middle.1) / length);
    let tip = (x + 7.0 * dx, y + 7.0 * dy);
    sheet.fill(
        vec![
            tip,
            (x - 5.0 * dx - 6.0 * dy, y - 5.0 * dy + 6.0 * dx),
            (x - 5.0 * dx + 6.0 * dy, y - 5.0 * dy - 6.0 * dx),
        ],
        DARK,
    );
}
