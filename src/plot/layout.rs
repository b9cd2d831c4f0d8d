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

fn natural(panels: &[Panel]) -> (f64, f64) {
    match panels {
        [Panel::Spectrum(_)] => (1000.0, 600.0),
        [_] => (800.0, 800.0),
        _ => {
            let spectra = panels.iter().filter(|p| matches!(p, Panel::Spectrum(_))).count();
            let rows = (panels.len() - spectra).div_ceil(2);
            (1200.0, 420.0 * spectra as f64 + 480.0 * rows as f64)
        }
    }
}

/// Lay the panels out for a picture of `size` pixels.
pub(super) fn compose(panels: &[Panel], size: (u32, u32)) -> Sheet {
    let (natural_width, natural_height) = natural(panels);
    let (width, height) = (f64::from(size.0), f64::from(size.1));
    let mut zoom = (width / natural_width).min(height / natural_height);
    zoom = zoom.max(SMALLEST).min(width / (TIGHTEST * natural_width)).min(height / (TIGHTEST * natural_height));
    let mut sheet = Sheet::new(width / zoom, height / zoom);
    let (spectra, others): (Vec<_>, Vec<_>) = panels.iter().partition(|p| matches!(p, Panel::Spectrum(_)));
    let rows: Vec<Vec<&Panel>> =
        spectra.into_iter().map(|p| vec![p]).chain(others.chunks(2).map(<[&Panel]>::to_vec)).collect();
    let heights: Vec<f64> =
        rows.iter().map(|r| if matches!(r[0], Panel::Spectrum(_)) { 420.0 } else { 480.0 }).collect();
    let total: f64 = heights.iter().sum();
    let mut y = 0.0;
    for (row, share) in rows.iter().zip(heights) {
        let bottom = y + sheet.height * share / total;
        let weights: Vec<f64> =
            row.iter().map(|p| if matches!(p, Panel::ColourVector(_)) && row.len() > 1 { 0.74 } else { 1.0 }).collect();
        let sum: f64 = weights.iter().sum();
        let mut x = 0.0;
        for (panel, weight) in row.iter().zip(weights) {
            let right = x + sheet.width * weight / sum;
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
            Self::Lobe(p) => &p.title,
            Self::Curves(p) => &p.title,
            Self::Raster(p) => &p.title,
            Self::Surface(p) => &p.title,
        }
    }

    fn draw(&self, sheet: &mut Sheet, area: Rect) {
        match self {
            Self::Spectrum(p) => p.draw(sheet, area),
            Self::Chromaticity(p) => p.draw(sheet, area),
            Self::ColourVector(p) => p.draw(sheet, area),
            Self::Lobe(p) => p.draw(sheet, area),
            Self::Curves(p) => p.draw(sheet, area),
            Self::Raster(p) => p.draw(sheet, area),
            Self::Surface(p) => p.draw(sheet, area),
        }
    }
}
