//! How values look in a document.

/// Significant digits of intensities and dimensions: far more than any instrument's, without the noise of binary fractions.
const DIGITS: usize = 10;

/// Text without what XML reserves or forbids.
pub(super) fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.trim().chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '\t' | '\n' | '\r' => out.push(' '),
            c if c.is_control() || matches!(c, '\u{fffe}' | '\u{ffff}') => {}
            c => out.push(c),
        }
    }
    out
}

pub(super) fn digits(value: f64) -> String {
    rounded(value, DIGITS)
}

/// So many significant digits, without exponent: the schema's `xs:decimal` has none.
pub(super) fn rounded(value: f64, count: usize) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    // Printed and read again, the number has no digits beyond the last one wanted.
    let shortened: f64 = format!("{value:.*e}", count - 1).parse().unwrap_or(value);
    shortened.to_string()
}

/// The number that a text begins with.
pub(super) fn leading(text: &str) -> Option<f64> {
    let text = text.trim();
    let end = text.find(|c: char| !(c.is_ascii_digit() || c == '.')).unwrap_or(text.len());
    text[..end].parse().ok()
}

/// `xs:date` of the usual ways to write one: year-month-day with `-`, `/` or `.`, day.month.year; more text may follow.
pub(super) fn date(text: &str) -> Option<String> {
    let word = text.split(|c: char| c.is_whitespace() || c == 'T').next()?;
    let parts: Vec<u32> = word.split(['-', '/', '.']).map(|p| p.parse().ok()).collect::<Option<_>>()?;
    let (year, month, day) = match parts[..] {
        [year, month, day] if year > 999 => (year, month, day),
        // Day before month is certain only with points between them.
        [day, month, year] if year > 999 && word.contains('.') => (year, month, day),
        _ => return None,
    };
    ((1..=12).contains(&month) && (1..=31).contains(&day) && year < 10_000)
        .then(|| format!("{year:04}-{month:02}-{day:02}"))
}
