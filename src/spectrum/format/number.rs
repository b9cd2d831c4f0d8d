//! Numbers as files write them.

/// What a cell holds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Cell {
    /// A finite number.
    Number(f64),
    /// Nothing, or a word for nothing.
    Missing,
    /// NaN, infinity, or digits beyond the range of a double.
    NotFinite,
    /// Anything else.
    Text,
}

impl Cell {
    pub(super) fn number(self) -> Option<f64> {
        match self {
            Self::Number(value) => Some(value),
            _ => None,
        }
    }
}

/// Longest number with a decimal comma; the longest exact decimal expansion of a double is longer than any file prints.
const LONGEST: usize = 64;

/// Reads a trimmed cell. A decimal comma is never a thousands mark: `1,234` is 1.234 with `decimal` `,` and text with `.`.
#[inline]
pub(super) fn parse(text: &str, decimal: char) -> Cell {
    let value = if decimal == ',' { parse_comma(text) } else { text.parse::<f64>().ok() };
    match value {
        Some(value) if value.is_finite() => Cell::Number(value),
        Some(_) => Cell::NotFinite,
        None => classify(text),
    }
}

fn parse_comma(text: &str) -> Option<f64> {
    let mut buffer = [0u8; LONGEST];
    let bytes = text.as_bytes();
    let buffer = buffer.get_mut(..bytes.len())?;
    for (to, &from) in buffer.iter_mut().zip(bytes) {
        *to = match from {
            b',' => b'.',
            b'.' => return None,
            other => other,
        };
    }
    std::str::from_utf8(buffer).ok()?.parse().ok()
}

#[cold]
fn classify(text: &str) -> Cell {
    const MISSING: [&str; 10] = ["", "-", "--", "---", "na", "n/a", "#n/a", "null", "none", "*"];
    const NOT_FINITE: [&str; 8] = ["#div/0!", "#num!", "1.#inf", "-1.#inf", "1.#qnan", "-1.#ind", "1.#ind", "#value!"];
    let word = text.to_ascii_lowercase();
    if MISSING.contains(&word.as_str()) {
        Cell::Missing
    } else if NOT_FINITE.contains(&word.as_str()) {
        Cell::NotFinite
    } else {
        Cell::Text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_are_told_apart() {
        assert_eq!(parse("380.5", '.'), Cell::Number(380.5));
        assert_eq!(parse("-1e-3", '.'), Cell::Number(-1e-3));
        assert_eq!(parse("380,5", ','), Cell::Number(380.5));
        assert_eq!(parse("1,5E2", ','), Cell::Number(150.0));
        assert_eq!(parse("1,234", '.'), Cell::Text);
        assert_eq!(parse("1.234,5", ','), Cell::Text);
        assert_eq!(parse("1,2,3", ','), Cell::Text);
        for missing in ["", "NA", "n/a", "-", "---", "null"] {
            assert_eq!(parse(missing, '.'), Cell::Missing, "{missing}");
        }
        for not_finite in ["NaN", "nan", "inf", "-Infinity", "1e999", "#DIV/0!"] {
            assert_eq!(parse(not_finite, '.'), Cell::NotFinite, "{not_finite}");
        }
    }
}
