//! Axes: round tick values, their labels, and the way from a value to a place.

use super::font;
use super::sheet::{Align, DARK, FRAME, GRID, Rect, Sheet};

/// Size of tick labels.
pub(super) const TICK_TEXT: f64 = 13.0;
/// Size of axis titles.
pub(super) const AXIS_TEXT: f64 = 14.0;
/// Size of panel titles.
pub(super) const TITLE_TEXT: f64 = 18.0;
/// Empty border of a panel.
pub(super) const MARGIN: f64 = 14.0;

/// A linear scale from values to pixels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Scale {
    pub low: f64,
    pub high: f64,
    pub start: f64,
    pub end: f64,
}

impl Scale {
    pub(super) fn new(low: f64, high: f64, start: f64, end: f64) -> Self {
        Self { low, high, start, end }
    }

    pub(super) fn at(&self, value: f64) -> f64 {
        self.start + (value - self.low) / (self.high - self.low) * (self.end - self.start)
    }

    /// Pixels per unit, never negative.
    pub(super) fn density(&self) -> f64 {
        ((self.end - self.start) / (self.high - self.low)).abs()
    }

    /// Round values within the scale, about one every `spacing` pixels.
    pub(super) fn ticks(&self, spacing: f64) -> Ticks {
        let count = ((self.end - self.start).abs() / spacing).max(1.0);
        Ticks::new(self.low, self.high, count)
    }

    /// Multiples of a whole `step` within the scale.
    pub(super) fn ticks_every(&self, step: f64) -> Ticks {
        let (first, last) = ((self.low / step - 1e-9).ceil(), (self.high / step + 1e-9).floor());
        let mut values = vec![first * step];
        while values.len() as f64 <= last - first {
            values.push((first + values.len() as f64) * step);
        }
        Ticks { values, decimals: 0 }
    }
}

/// Round values and the number of decimals that they need.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Ticks {
    pub values: Vec<f64>,
    decimals: usize,
}

impl Ticks {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "small whole numbers")]
    fn new(low: f64, high: f64, count: f64) -> Self {
        let rough = (high - low) / count;
        let power = rough.log10().floor() as i32;
        let unit = 10f64.powi(power);
        let factor = [1.0, 2.0, 5.0, 10.0].into_iter().find(|f| f * unit >= rough * 0.999).unwrap_or(10.0);
        let step = factor * unit;
        let (first, last) = ((low / step - 1e-9).ceil() as i64, (high / step + 1e-9).floor() as i64);
        let decimals = if factor == 10.0 { -power - 1 } else { -power };
        Self { values: (first..=last).map(|i| i as f64 * step).collect(), decimals: decimals.max(0) as usize }
    }

    /// Whole multiples of a whole `step` from `low` to `high`.
    #[expect(clippy::cast_possible_truncation, reason = "small whole numbers")]
    pub(super) fn multiples(low: f64, high: f64, step: f64) -> Self {
        let (first, last) = ((low / step - 1e-9).ceil() as i64, (high / step + 1e-9).floor() as i64);
        Self { values: (first..=last).map(|i| i as f64 * step).collect(), decimals: 0 }
    }

    pub(super) fn label(&self, value: f64) -> String {
        number(value, self.decimals)
    }

    /// Width of the widest label.
    pub(super) fn width(&self) -> f64 {
        self.values.iter().map(|&v| font::width(&self.label(v), TICK_TEXT)).fold(0.0, f64::max)
    }
}

/// A number with a real minus sign, and none before a zero.
pub(super) fn number(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    match text.strip_prefix('-') {
        Some(digits) if digits.chars().all(|c| c == '0' || c == '.') => digits.to_owned(),
        Some(digits) => format!("−{digits}"),
        None => text,
    }
}

/// The power of ten by which an axis up to `largest` is divided so that its labels are short; 0 for handy numbers.
#[expect(clippy::cast_possible_truncation, reason = "a logarithm of a double is below 400")]
pub(super) fn exponent(largest: f64) -> i32 {
    if !largest.is_finite() || largest <= 0.0 {
        return 0;
    }
    let power = largest.log10().floor() as i32;
    if (-2..=4).contains(&power) { 0 } else { power }
}

/// `value` divided by ten to the `power`, without leaving the range of doubles on the way.
pub(super) fn divided(value: f64, power: i32) -> f64 {
    let half = power / 2;
    value / 10f64.powi(half) / 10f64.powi(power - half)
}

/// `×10⁻⁵`
pub(super) fn power_of_ten(power: i32) -> String {
    let digit = |c: char| match c {
        '-' => '⁻',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        c => char::from_u32(0x2070 + c.to_digit(10).unwrap_or(0)).unwrap_or(c),
    };
    format!("×10{}", power.to_string().chars().map(digit).collect::<String>())
}

/// A level without needless zeros, three digits.
pub(super) fn plain(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return "0".to_owned();
    }
    let decimals = (2.0 - value.abs().log10().floor()).clamp(0.0, 12.0);
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 12")]
    let text = format!("{value:.*}", decimals as usize);
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

/// The title of a panel, shrunk and then cut if it is too long; gives the y below it.
pub(super) fn title(sheet: &mut Sheet, area: Rect, title: &str) -> f64 {
    if title.trim().is_empty() {
        return area.y0 + MARGIN;
    }
    let room = area.width() - 2.0 * MARGIN;
    let size = (TITLE_TEXT * room / font::width(title, TITLE_TEXT)).clamp(11.5, TITLE_TEXT);
    let text = font::fit(title, size, room);
    sheet.text((area.x0 + MARGIN, area.y0 + MARGIN + 15.0), &text, size, DARK, Align::Start);
    area.y0 + MARGIN + 15.0 + 9.0
}

/// Grid lines, ticks, labels and title of a horizontal axis below `plot`.
pub(super) fn below(sheet: &mut Sheet, plot: Rect, scale: Scale, ticks: &Ticks, name: &str) {
    for &v in &ticks.values {
        let x = scale.at(v);
        sheet.line((x, plot.y1), (x, plot.y1 + 5.0), 1.0, FRAME);
        sheet.text((x, plot.y1 + 9.0 + 0.73 * TICK_TEXT), &ticks.label(v), TICK_TEXT, DARK, Align::Middle);
    }
    let middle = ((plot.x0 + plot.x1) / 2.0, plot.y1 + 27.0 + 0.73 * AXIS_TEXT);
    sheet.text(middle, &font::fit(name, AXIS_TEXT, plot.width() + 40.0), AXIS_TEXT, DARK, Align::Middle);
}

/// Height that [`below`] needs under the plot.
pub(super) const BELOW: f64 = 42.0;

/// Ticks, labels and title of a vertical axis left of `plot`; the title stands at `title_x`.
pub(super) fn left(sheet: &mut Sheet, plot: Rect, scale: Scale, ticks: &Ticks, name: &str, title_x: f64) {
    for &v in &ticks.values {
        let y = scale.at(v);
        sheet.line((plot.x0 - 5.0, y), (plot.x0, y), 1.0, FRAME);
        sheet.text((plot.x0 - 9.0, y + 0.36 * TICK_TEXT), &ticks.label(v), TICK_TEXT, DARK, Align::End);
    }
    upright(sheet, plot, name, title_x);
}

/// An axis title written upwards, shrunk to the height of the plot where it must be.
pub(super) fn upright(sheet: &mut Sheet, plot: Rect, name: &str, x: f64) {
    let room = plot.height() + 30.0;
    let size = (AXIS_TEXT * room / font::width(name, AXIS_TEXT).max(1.0)).clamp(11.0, AXIS_TEXT);
    let name = font::fit(name, size, room);
    sheet.text_up((x, (plot.y0 + plot.y1) / 2.0), &name, size, DARK, Align::Middle);
}

/// Faint lines across `plot` at the ticks of both axes.
pub(super) fn grid(sheet: &mut Sheet, plot: Rect, (x, xs): (Scale, &Ticks), (y, ys): (Scale, &Ticks)) {
    for &v in &xs.values {
        sheet.line((x.at(v), plot.y0), (x.at(v), plot.y1), 1.0, GRID);
    }
    for &v in &ys.values {
        sheet.line((plot.x0, y.at(v)), (plot.x1, y.at(v)), 1.0, GRID);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_numbers() {
        let labels = |low, high, count| {
            let t = Ticks::new(low, high, count);
            t.values.iter().map(|&v| t.label(v)).collect::<Vec<_>>()
        };
        assert_eq!(labels(380.0, 780.0, 8.0), ["400", "450", "500", "550", "600", "650", "700", "750"]);
        assert_eq!(labels(-0.3, 0.31, 4.0), ["−0.2", "0.0", "0.2"]);
        assert_eq!(labels(0.0, 1.08, 5.0), ["0.0", "0.5", "1.0"]);
        assert_eq!(labels(0.0, 40.0, 4.0), ["0", "10", "20", "30", "40"]);
    }

    #[test]
    fn powers_of_ten_are_written_as_people_write_them() {
        assert_eq!(power_of_ten(-30), "×10⁻³⁰");
        assert_eq!(power_of_ten(125), "×10¹²⁵");
        assert_eq!(
            (exponent(0.05), exponent(0.005), exponent(99_999.0), exponent(1e30), exponent(0.0)),
            (0, -3, 0, 30, 0)
        );
        assert!((divided(3e-320, -320) - 3.0).abs() < 0.01);
        assert!((divided(1e308, 308) - 1.0).abs() < 1e-12);
    }

    #[test]
    fn minus_signs_are_minus_signs() {
        assert_eq!((number(-0.2, 1), number(-0.04, 1)), ("−0.2".into(), "0.0".into()));
    }
}
