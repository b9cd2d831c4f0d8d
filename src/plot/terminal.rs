//! A picture in a terminal: two pixels per character.

use std::fmt::Write;

/// Characters of rising ink, for terminals without colour.
const INK: [char; 10] = [' ', '.', ':', '-', '=', '+', '*', '#', '%', '@'];

/// Rows of the half block ▀, each with the colour of an upper pixel before that of the lower one behind it (24-bit SGR
/// sequences), every row ended by a reset.
#[must_use]
pub fn half_blocks(columns: usize, rows: usize, colour: impl Fn(usize, usize) -> [u8; 3]) -> String {
    let mut out = String::new();
    for y in (0..rows).step_by(2) {
        let mut last = None;
        for x in 0..columns {
            let pair = (colour(x, y), (y + 1 < rows).then(|| colour(x, y + 1)));
            // The same colours need not be said again. Writing to a string does not fail.
            if last != Some(pair) {
                let (upper, lower) = pair;
                let [r, g, b] = upper;
                let _ = write!(out, "\x1b[38;2;{r};{g};{b}m");
                match lower {
                    Some([r, g, b]) => {
                        let _ = write!(out, "\x1b[48;2;{r};{g};{b}m");
                    }
                    None => out.push_str("\x1b[49m"),
                }
                last = Some(pair);
            }
            out.push('▀');
        }
        out.push_str("\x1b[0m\n");
    }
    out
}

/// Rows of characters of rising ink, each for two pixels above one another; `share` is 0 to 1 within the scale, below and above
/// it for values outside, NaN for none.
#[must_use]
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to the characters")]
pub fn characters(columns: usize, rows: usize, share: impl Fn(usize, usize) -> f64) -> String {
    let mut out = String::new();
    for y in (0..rows).step_by(2) {
        for x in 0..columns {
            let pair = [share(x, y), if y + 1 < rows { share(x, y + 1) } else { f64::NAN }];
            let (count, sum) =
                pair.iter().filter(|v| !v.is_nan()).fold((0, 0.0), |(n, s), v| (n + 1, s + v.clamp(0.0, 1.0)));
            out.push(match count {
                0 => '?',
                n => INK[((sum / f64::from(n) * INK.len() as f64) as usize).min(INK.len() - 1)],
            });
        }
        out.push('\n');
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_rows_make_one_line() {
        let text = half_blocks(2, 3, |_, y| [y as u8; 3]);
        assert_eq!(text, "\x1b[38;2;0;0;0m\x1b[48;2;1;1;1m▀▀\x1b[0m\n\x1b[38;2;2;2;2m\x1b[49m▀▀\x1b[0m\n");
        assert_eq!(characters(4, 1, |x, _| [0.0, 0.55, 2.0, f64::NAN][x]), " +@?\n");
    }
}
