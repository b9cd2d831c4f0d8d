//! Decimal numbers in a file's text, fast and exact.
//!
//! A number of at most 19 digits whose digits make an integer up to 2⁵³ and whose power of ten is at most 10²² is one
//! exact integer divided by one exact power of ten: a single correctly rounded division (Clinger 1990). Everything else
//! goes to [`str::parse`], so that the value is the same to the last bit in every case.

/// Exact powers of ten.
const POWERS: [f64; 23] = [
    1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20,
    1e21, 1e22,
];

/// The largest integer below which every integer is a double.
const EXACT: u64 = 1 << 53;

/// Whether a byte separates numbers (LM-63: comma, blanks, line end; tabs are common).
#[inline]
pub(super) fn is_delimiter(byte: u8) -> bool {
    matches!(byte, b' ' | b',' | b'\n' | b'\r' | b'\t' | 0x0b | 0x0c)
}

/// The number that begins at `at`, with the offset behind it; `None` where the characters up to the next delimiter are no
/// finite number.
#[inline]
pub(super) fn number_at(bytes: &[u8], at: usize) -> Option<(f64, usize)> {
    let mut i = at;
    let negative = bytes.get(i) == Some(&b'-');
    i += usize::from(negative);
    let start = i;
    let mut mantissa = 0_u64;
    while let Some(digit) = digit(bytes, i) {
        mantissa = mantissa.wrapping_mul(10).wrapping_add(digit);
        i += 1;
    }
    let mut digits = i - start;
    let mut decimals = 0;
    if bytes.get(i) == Some(&b'.') {
        i += 1;
        let point = i;
        while let Some(digit) = digit(bytes, i) {
            mantissa = mantissa.wrapping_mul(10).wrapping_add(digit);
            i += 1;
        }
        decimals = i - point;
        digits += decimals;
    }
    let ended = bytes.get(i).is_none_or(|&b| is_delimiter(b));
    // 19 digits never overflow 64 bits; with them, at most 19 decimals: within the exact powers.
    if ended && digits.wrapping_sub(1) < 19 && mantissa <= EXACT {
        let value = mantissa as f64 / POWERS[decimals];
        return Some((if negative { -value } else { value }, i));
    }
    slowly(bytes, at)
}

#[inline]
fn digit(bytes: &[u8], at: usize) -> Option<u64> {
    let digit = bytes.get(at)?.wrapping_sub(b'0');
    (digit < 10).then_some(u64::from(digit))
}

/// Exponents (also Fortran's D), many digits, a plus sign.
#[cold]
fn slowly(bytes: &[u8], at: usize) -> Option<(f64, usize)> {
    let end = token_end(bytes, at);
    let token = std::str::from_utf8(&bytes[at..end]).ok()?;
    // `str::parse` knows `inf` and `nan`, this must not: digits, point, signs and the letters of an exponent only.
    if !token.bytes().all(|b| b.is_ascii_digit() || matches!(b, b'+' | b'-' | b'.' | b'e' | b'E' | b'd' | b'D')) {
        return None;
    }
    let value: f64 = match token.bytes().position(|b| matches!(b, b'd' | b'D')) {
        None => token.parse().ok()?,
        Some(_) if token.len() > 64 => token.replace(['d', 'D'], "e").parse().ok()?,
        Some(letter) => {
            let mut copy = [0_u8; 64];
            copy[..token.len()].copy_from_slice(token.as_bytes());
            copy[letter] = b'e';
            std::str::from_utf8(&copy[..token.len()]).ok()?.parse().ok()?
        }
    };
    value.is_finite().then_some((value, end))
}

/// The offset behind the characters that begin at `at` and end at the next delimiter.
pub(super) fn token_end(bytes: &[u8], at: usize) -> usize {
    bytes[at..].iter().position(|&b| is_delimiter(b)).map_or(bytes.len(), |n| at + n)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn value(text: &str) -> Option<f64> {
        number_at(text.as_bytes(), 0).map(|(v, _)| v)
    }

    #[test]
    fn numbers_in_every_notation_of_the_files() {
        for (text, expected) in [
            ("1", 1.0),
            ("-1", -1.0),
            ("+2.5", 2.5),
            (".125", 0.125),
            ("-.5", -0.5),
            ("7.", 7.0),
            ("1.5E3", 1500.0),
            ("1.5d+03", 1500.0),
            ("2D-2", 0.02),
            ("12.5,13", 12.5),
            ("9 8", 9.0),
        ] {
            assert_eq!(value(text), Some(expected), "{text}");
        }
        for text in
            ["", "-", ".", "-.", "nan", "NaN", "inf", "1e999", "1,5x".split_at(2).1, "12x", "0x10", "1.2.3", "é"]
        {
            assert_eq!(value(text), None, "{text}");
        }
        let negative_zero = value("-0").expect("a number");
        assert!(negative_zero == 0.0 && negative_zero.is_sign_negative());
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 2000, failure_persistence: None, ..ProptestConfig::default() })]

        /// To the last bit the value of the standard library.
        #[test]
        fn the_value_is_that_of_the_standard_library(text in "[+-]?[0-9]{0,22}\\.?[0-9]{0,24}([eE][+-]?[0-9]{1,3})?") {
            let expected = text.parse::<f64>().ok().filter(|v| v.is_finite());
            prop_assert_eq!(value(&text).map(f64::to_bits), expected.map(f64::to_bits));
        }

        #[test]
        fn doubles_printed_are_read_back(bits in any::<u64>(), digits in 0_usize..18) {
            let v = f64::from_bits(bits);
            prop_assume!(v.is_finite());
            prop_assert_eq!(value(&format!("{v:e}")).map(f64::to_bits), Some(bits));
            let (short, wide) = (format!("{:.digits$}", v % 1e6), format!("{}", v % 1e12));
            for text in [short, wide] {
                prop_assert_eq!(value(&text).map(f64::to_bits), text.parse::<f64>().ok().map(f64::to_bits));
            }
        }
    }
}
