//! Decimal numbers in a file's text, fast and exact.
//!
//! A number of at most 19 digits is an integer m divided by a power of ten. Up to m = 2⁵³ that is a single correctly rounded
//! division (Clinger 1990). A longer m is multiplied by the 64-bit reciprocal of the power, which leaves the quotient known to
//! two units of its 64th bit; only where these decide the rounding to 53 bits, twice in a thousand numbers, and for everything
//! else, [`str::parse`] is asked. So the value is the same to the last bit in every case.

/// Exact powers of ten.
const POWERS: [f64; 20] =
    [1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19];

/// ⌊2^(63 + b) / 10^d⌋ for d decimals, where b is the number of bits of 10^d − 1: in [2⁶³, 2⁶⁴]; and b.
const RECIPROCALS: [(u64, i32); 20] = {
    let mut out = [(1 << 63, 0); 20];
    let mut power = 1_u64;
    let mut d = 1;
    while d < 20 {
        power *= 10;
        let bits = 64 - (power - 1).leading_zeros();
        out[d] = (((1_u128 << (63 + bits)) / power as u128) as u64, bits as i32);
        d += 1;
    }
    out
};

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
    i = digits(bytes, i, &mut mantissa);
    let mut count = i - start;
    let mut decimals = 0;
    if bytes.get(i) == Some(&b'.') {
        i += 1;
        let point = i;
        while let Some(eight) = eight_digits(bytes, i) {
            mantissa = mantissa.wrapping_mul(100_000_000).wrapping_add(eight);
            i += 8;
        }
        i = digits(bytes, i, &mut mantissa);
        decimals = i - point;
        count += decimals;
    }
    let ended = bytes.get(i).is_none_or(|&b| is_delimiter(b));
    // 19 digits never overflow 64 bits; with them, at most 19 decimals: within the tables.
    if ended && count.wrapping_sub(1) < 19 {
        let value =
            if mantissa <= EXACT { Some(mantissa as f64 / POWERS[decimals]) } else { quotient(mantissa, decimals) };
        if let Some(value) = value {
            return Some((if negative { -value } else { value }, i));
        }
    }
    slowly(bytes, at)
}

/// Appends the digits from `at` on to a mantissa, one by one; the offset behind them.
#[inline]
fn digits(bytes: &[u8], at: usize, mantissa: &mut u64) -> usize {
    let mut i = at;
    while let Some(digit) = bytes.get(i).map(|b| b.wrapping_sub(b'0')).filter(|d| *d < 10) {
        *mantissa = mantissa.wrapping_mul(10).wrapping_add(u64::from(digit));
        i += 1;
    }
    i
}

/// The integer that eight digits make, in one word: pairs, then fours, then all.
#[inline]
fn eight_digits(bytes: &[u8], at: usize) -> Option<u64> {
    let word = u64::from_le_bytes(*bytes.get(at..)?.first_chunk()?);
    // A byte is a digit where its high half is 3, and still is with 6 added.
    let high =
        (word & 0xf0f0_f0f0_f0f0_f0f0) | ((word.wrapping_add(0x0606_0606_0606_0606) & 0xf0f0_f0f0_f0f0_f0f0) >> 4);
    if high != 0x3333_3333_3333_3333 {
        return None;
    }
    let ones = word & 0x0f0f_0f0f_0f0f_0f0f;
    let pairs = (ones.wrapping_mul(10 * 256 + 1) >> 8) & 0x00ff_00ff_00ff_00ff;
    let fours = (pairs.wrapping_mul(100 * 65_536 + 1) >> 16) & 0x0000_ffff_0000_ffff;
    Some(fours.wrapping_mul(10_000 * (1 << 32) + 1) >> 32)
}

/// mantissa / 10^decimals to the nearest double, where 64 bits of the quotient decide it.
#[inline]
fn quotient(mantissa: u64, decimals: usize) -> Option<f64> {
    let (reciprocal, bits) = RECIPROCALS[decimals];
    let zeros = mantissa.leading_zeros() as i32;
    // mantissa · 2^zeros · 2^(63 + bits) / 10^decimals lies in [high, high + 2) · 2⁶⁴: the reciprocal is short of less than 1.
    let high = ((u128::from(mantissa << zeros) * u128::from(reciprocal)) >> 64) as u64;
    let surplus = 11 - high.leading_zeros();
    let (rest, half) = (high & ((1 << surplus) - 1), 1 << (surplus - 1));
    if rest == half || rest + 1 == half {
        return None;
    }
    let rounded = (high >> surplus) + u64::from(rest > half);
    let exponent = 1 + surplus as i32 - zeros - bits;
    Some(rounded as f64 * f64::from_bits(((1023 + exponent) as u64) << 52))
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
            // Halves between two doubles go to the even one: 2⁵³ + 1, + 3.
            ("9007199254740993", 9_007_199_254_740_992.0),
            ("9007199254740995", 9_007_199_254_740_996.0),
            ("9007199254740993.000", 9_007_199_254_740_992.0),
            ("9007199254740993.001", 9_007_199_254_740_994.0),
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

        /// As many digits as 64 bits hold, the point anywhere among them.
        #[test]
        fn long_numbers_are_rounded_to_the_nearest(m in (1_u64 << 53)..10_000_000_000_000_000_000, decimals in 0_usize..20) {
            let digits = format!("{m:019}");
            let text = format!("{}.{}", &digits[..19 - decimals], &digits[19 - decimals..]);
            prop_assert_eq!(value(&text).map(f64::to_bits), text.parse::<f64>().ok().map(f64::to_bits));
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
