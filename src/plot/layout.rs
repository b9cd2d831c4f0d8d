//! Where the panels of a picture stand.

use super::Panel;
use super::sheet::{GRID, Rect, Sheet};

/// Text is not shrunk below this part of its natural size before the room around it has shrunk to [`TIGHTEST`].
const SMALLEST: f64 = 0.8;
/// Least part of its natural width and height that a layout still fits.
const TIGHTEST: f64 = 0.72;

/// Width and height in pixels where the caller names none.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "limited to the allowed sides")]
pub(super) fn default_size(panels: &[Panel]) -> (u32, u32) {
    let (width, height) = natural(panels);
    let most = super::SIDES.1;
    ((width as u32).min(most), (height as u32).min(most))
}

/// Width of a picture of several panels.
const SHEET: f64 = 1200.0;

fn natural(panels: &[Panel]) -> (f64, f64) {
    match panels {
        [Panel::ColourAngle(_)] => (1000.0, 720.0),
        [Panel::Spectrum(_) | Panel::Cartesian(_) | Panel::Budget(_)] => (1000.0, 600.0),
        [Panel::Level(p)] => (1000.0, p.height()),
        [Panel::Figures(f)] => (1000.0, f.height(1000.0)),
        [Panel::Isolux(p)] => p.natural(),
        [Panel::FalseColour(p)] => p.natural(),
        [_] => (800.0, 800.0),
        _ => (SHEET, rows(panels).iter().map(|r| r.height).sum()),
    }
}

/// Panels side by side.
struct Row<'a> {
    panels: Vec<&'a Panel>,
    height: f64,
}

/// Key figures as the head of the sheet, spectra alone, the others in pairs.
fn rows(panels: &[Panel]) -> Vec<Row<'_>> {
    let mut out = Vec::new();
    for panel in panels {
        if let Panel::Figures(f) = panel {
            out.push(Row { panels: vec![panel], height: f.height(SHEET) });
        }
    }
    let spectrum = |p: &&Panel| matches!(p, Panel::Spectrum(_));
    out.extend(panels.iter().filter(spectrum).map(|p| Row { panels: vec![p], height: 420.0 }));
    let others: Vec<&Panel> = panels.iter().filter(|p| !spectrum(p) && !matches!(p, Panel::Figures(_))).collect();
    out.extend(others.chunks(2).map(|pair| Row { panels: pair.to_vec(), height: 480.0 }));
    out
}

/// Lay the panels out for a picture of `size` pixels.
pub(super) fn compose(panels: &[Panel], size: (u32, u32)) -> Sheet {
    let (natural_width, natural_height) = natural(panels);
    let (width, height) = (f64::from(size.0), f64::from(size.1));
    let mut zoom = (width / natural_width).min(height / natural_height);
    zoom = zoom.max(SMALLEST).min(width / (TIGHTEST * natural_width)).min(height / (TIGHTEST * natural_height));
    let mut sheet = Sheet::new(width / zoom, height / zoom);
    let rows = rows(panels);
    let total: f64 = rows.iter().map(|r| r.height).sum();
    let mut y = 0.0;
    for row in &rows {
        let bottom = y + sheet.height * row.height / total;
        let several = row.panels.len() > 1;
        let weight = |p: &Panel| if several && matches!(p, Panel::ColourVector(_)) { 0.74 } else { 1.0 };
        let sum: f64 = row.panels.iter().map(|p| weight(p)).sum();
        let mut x = 0.0;
        for panel in &row.panels {
            let right = x + sheet.width * weight(panel) / sum;
            panel.draw(&mut sheet, Rect::new(x, y, right, bottom));
            x = right;
        }
        y = bottom;
        if y < sheet.height - 1.0 {
            let edge = sheet.width - 14.0;
            sheet.line((14.0, y), (edge, y), 1.0, GRID);
        }
    }
    let titles: Vec<&str> = panels.iter().map(Panel::title).filter(|t| !t.is_empty()).collect();
    sheet.title = titles.join(" – ");
    sheet
}

impl Panel {
    fn title(&self) -> &str {
        match self {
            Self::Spectrum(p) => &p.title,
            Self::Chromaticity(p) => &p.title,
            Self::ColourVector(p) => &p.title,
            Self::ColourAngle(p) => &p.title,
            Self::Polar(p) => &p.title,
            Self::Cartesian(p) => &p.title,
            Self::Web(p) => &p.title,
            Self::Isocandela(p) => &p.title,
            Self::Cone(p) => &p.title,
            Self::Figures(p) => &p.title,
            Self::Isolux(p) => &p.title,
            Self::Lobe(p) => &p.title,
            Self::Curves(p) => &p.title,
            Self::Dots(p) => &p.title,
            Self::Trade(p) => &p.title,
            Self::Raster(p) => &p.title,
            Self::Surface(p) => &p.title,
            Self::FalseColour(p) => &p.title,
            Self::Budget(p) => &p.title,
            Self::Level(p) => &p.title,
        }
    }

    fn draw(&self, sheet: &mut Sheet, area: Rect) {
        match self {
            Self::Spectrum(p) => p.draw(sheet, area),
            Self::Chromaticity(p) => p.draw(sheet, area),
            Self::ColourVector(p) => p.draw(sheet, area),
            Self::ColourAngle(p) => p.draw(sheet, area),
            Self::Polar(p) => p.draw(sheet, area),
            Self::Cartesian(p) => p.draw(sheet, area),
            Self::Web(p) => p.draw(sheet, area),
            Self::Isocandela(p) => p.draw(sheet, area),
            Self::Cone(p) => p.draw(sheet, area),
            Self::Figures(p) => p.draw(sheet, area),
            Self::Isolux(p) => p.draw(sheet, area),
            Self::Lobe(p) => p.draw(sheet, area),
            Self::Curves(p) => p.draw(sheet, area),
            Self::Dots(p) => p.draw(sheet, area),
            Self::Trade(p) => p.draw(sheet, area),
            Self::Raster(p) => p.draw(sheet, area),
            Self::Surface(p) => p.draw(sheet, area),
            Self::FalseColour(p) => p.draw(sheet, area),
            Self::Budget(p) => p.draw(sheet, area),
            Self::Level(p) => p.draw(sheet, area),
        }
    }
}
