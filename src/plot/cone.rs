//! The cone diagram: what a beam makes at distances along its axis.

use super::axis::{self, MARGIN, number};
use super::sheet::{Align, DARK, FRAME, GRID, Ink, Point, Rect, SOFT, Sheet, clean};
use super::{angular, font};

/// The beam at one distance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ConeStep {
    /// Distance along the axis, m.
    pub distance_m: f64,
    /// Illuminance (or irradiance) on the axis, in the unit of the panel.
    pub on_axis: f64,
    /// Width of the beam in both planes, m; `None` where it has no end.
    pub width_m: [Option<f64>; 2],
}

/// A beam drawn from its apex downwards, with a row of figures for each distance.
///
/// The drawing is true to scale; where the beam is too wide for that its width is shortened, and the panel says so.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ConePanel {
    /// Above the drawing; may be empty.
    pub title: String,
    /// By rising distance.
    pub steps: Vec<ConeStep>,
    /// Unit of [`ConeStep::on_axis`], such as `lx`.
    pub unit: String,
    /// Names of the two planes and their full beam angles in degrees.
    pub planes: [(String, Option<f64>); 2],
    /// Both planes are the same: the first stands for both.
    pub round: bool,
}

const TEXT: f64 = 13.0;
const HEAD: f64 = 12.0;
const LIT: Ink = Ink::rgb([255, 240, 200]);

impl ConePanel {
    pub(super) fn draw(&self, sheet: &mut Sheet, area: Rect) {
        let top = axis::title(sheet, area, &self.title);
        let Some(last) = self.steps.last() else { return };
        let shown = if self.round { &self.planes[..1] } else { &self.planes[..] };
        let columns = self.columns(shown.len());
        let widths: Vec<f64> = columns.iter().map(|c| widest(c) + 16.0).collect();
        let left = area.x0 + MARGIN + widths[0];
        let right = area.x1 - MARGIN - widths[1..].iter().sum::<f64>();
        let apex_y = top + 3.0 * HEAD + 8.0;
        let bottom = area.y1 - MARGIN - 2.4 * HEAD;
        let down = (bottom - apex_y) / last.distance_m;
        let reach = shown.iter().enumerate().filter_map(|(i, _)| last.width_m[i]).fold(0.0, f64::max) / 2.0;
        let room = (right - left) / 2.0 - 6.0;
        let across = down.min(room / reach.max(1e-9));
        let apex = ((left + right) / 2.0, apex_y);
        let at = |half_width: f64, distance: f64| (apex.0 + across * half_width, apex.1 + down * distance);

        if let Some(width) = last.width_m[0] {
            sheet.fill(vec![at(-width / 2.0, last.distance_m), apex, at(width / 2.0, last.distance_m)], LIT);
        }
        for step in &self.steps {
            let y = at(0.0, step.distance_m).1;
            sheet.line((left, y), (right, y), 1.0, GRID);
        }
        sheet.dashed(&[apex, at(0.0, last.distance_m)], &[10.0, 3.0, 2.0, 3.0], 1.0, FRAME);
        for i in 0..shown.len() {
            self.outline(sheet, i, at);
        }
        sheet.fill(
            vec![
                (apex.0 - 11.0, apex.1),
                (apex.0 - 7.0, apex.1 - 8.0),
                (apex.0 + 7.0, apex.1 - 8.0),
                (apex.0 + 11.0, apex.1),
            ],
            FRAME,
        );
        self.table(sheet, &columns, &widths, (area.x0 + MARGIN, right), top, |d| at(0.0, d).1);
        let mut foot: Vec<String> = shown
            .iter()
            .filter_map(|(name, angle)| angle.map(|a| (name, a)))
            .map(|(name, a)| format!("{} {}°", clean(name), number(a, 1)))
            .collect();
        if !foot.is_empty() {
            foot[0] = format!("half-peak beam: {}", foot[0]);
        }
        if across < 0.999 * down {
            foot.push("width not to scale".to_owned());
        }
        let foot = font::fit(&foot.join(", "), HEAD, area.width() - 2.0 * MARGIN);
        sheet.text(((area.x0 + area.x1) / 2.0, area.y1 - MARGIN), &foot, HEAD, SOFT, Align::Middle);
    }

    /// The sides of the beam in one plane, and its width at each distance.
    fn outline(&self, sheet: &mut Sheet, plane: usize, at: impl Fn(f64, f64) -> Point) {
        let Some(last) = self.steps.last() else { return };
        let Some(width) = last.width_m[plane] else { return };
        for side in [-0.5, 0.5] {
            angular::trace(sheet, plane, &[at(0.0, 0.0), at(side * width, last.distance_m)]);
        }
        for step in &self.steps {
            let Some(width) = step.width_m[plane] else { continue };
            for side in [-0.5, 0.5] {
                let (x, y) = at(side * width, step.distance_m);
                sheet.line((x, y - 4.0), (x, y + 4.0), 1.6, angular::ink(plane));
            }
        }
    }

    /// Heads and cells, column by column: the distance, the value on the axis, the widths.
    fn columns(&self, planes: usize) -> Vec<Vec<String>> {
        let column = |head: [String; 2], cell: &dyn Fn(&ConeStep) -> String| -> Vec<String> {
            head.into_iter().chain(self.steps.iter().map(cell)).collect()
        };
        let mut out = vec![
            column(["distance".into(), "[m]".into()], &|s| short(s.distance_m)),
            column(["on axis".into(), format!("[{}]", clean(&self.unit))], &|s| short(s.on_axis)),
        ];
        for plane in 0..planes {
            let name = if self.round { "Ø".to_owned() } else { format!("Ø {}", clean(&self.planes[plane].0)) };
            out.push(column([name, "[m]".into()], &|s| s.width_m[plane].map_or("–".to_owned(), short)));
        }
        out
    }

    fn table(
        &self,
        sheet: &mut Sheet,
        columns: &[Vec<String>],
        widths: &[f64],
        (left, right): (f64, f64),
        top: f64,
        y_of: impl Fn(f64) -> f64,
    ) {
        let mut x = right;
        for (i, (cells, width)) in columns.iter().zip(widths).enumerate() {
            let end = if i == 0 {
                left + width - 12.0
            } else {
                x += width;
                x
            };
            let ink = if i < 2 || self.round { DARK } else { angular::ink(i - 2) };
            for (row, cell) in cells.iter().enumerate() {
                let (y, size, ink) = match row {
                    0 => (top + HEAD, HEAD, SOFT),
                    1 => (top + 2.2 * HEAD, HEAD, SOFT),
                    row => (y_of(self.steps[row - 2].distance_m) + 0.36 * TEXT, TEXT, ink),
                };
                sheet.text((end, y), cell, size, ink, Align::End);
            }
        }
    }
}

fn widest(cells: &[String]) -> f64 {
    cells.iter().map(|c| font::width(c, TEXT)).fold(0.0, f64::max)
}

/// Three significant digits, as datasheets have them; whole numbers from 100.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped")]
fn short(value: f64) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    let power = axis::exponent(value.abs());
    if power != 0 && !(-3..=6).contains(&power) {
        return format!("{}{}", number(axis::divided(value, power), 2), axis::power_of_ten(power));
    }
    let decimals = (2.0 - value.abs().log10().floor()).clamp(0.0, 6.0) as usize;
    let text = number(value, decimals);
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figures_are_short() {
        let all = [0.0, 2.0, 0.2534, 1234.6, 12.345, 3.2e-9, 4.5e9].map(short);
        assert_eq!(all, ["0", "2", "0.253", "1235", "12.3", "3.20×10⁻⁹", "4.50×10⁹"]);
    }
}
