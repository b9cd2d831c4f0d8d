//! Scan lines: four bytes per pixel, plain or run-length encoded in one of two ways.

use std::io::{self, BufRead};

use crate::image::error::{Error, ErrorKind};

/// Lengths that are encoded by component.
pub(super) const ENCODED: std::ops::RangeInclusive<usize> = 8..=0x7fff;
/// The shortest run worth a code.
const SHORTEST_RUN: usize = 4;
/// The longest run, and the longest stretch without one.
const LONGEST_RUN: usize = 127;
const LONGEST_PLAIN: usize = 128;

/// One pixel as stored.
pub(super) type Pixel = [u8; 4];

fn damaged(number: usize, found: &str, expected: &str) -> Error {
    let found = format!("{found} in scan line {}", number + 1);
    ErrorKind::Unexpected { found, expected: expected.to_owned() }.into()
}

/// Bytes of a reader, counted, and an end of file told by its scan line.
struct Bytes<'a, R> {
    input: &'a mut R,
    line: usize,
    count: u64,
}

impl<R: BufRead> Bytes<'_, R> {
    fn read(&mut self, out: &mut [u8]) -> Result<(), Error> {
        self.input.read_exact(out).map_err(|error| match error.kind() {
            io::ErrorKind::UnexpectedEof => damaged(self.line, "the end of the file", "all scan lines: it is cut off"),
            _ => error.into(),
        })?;
        self.count += out.len() as u64;
        Ok(())
    }

    fn pixel(&mut self) -> Result<Pixel, Error> {
        let mut pixel = [0; 4];
        self.read(&mut pixel)?;
        Ok(pixel)
    }
}

/// Reads scan line `number` (from 0) into `line` and returns the bytes it took. `planes` is room for its components.
///
/// # Errors
/// Where the file ends in it, or a run leads beyond it.
pub(super) fn read<R: BufRead>(
    input: &mut R,
    number: usize,
    line: &mut [Pixel],
    planes: &mut Vec<u8>,
) -> Result<u64, Error> {
    let mut bytes = Bytes { input, line: number, count: 0 };
    let first = bytes.pixel()?;
    let length = line.len();
    if ENCODED.contains(&length) && first[..2] == [2, 2] && first[2] < 128 {
        let stated = usize::from(first[2]) << 8 | usize::from(first[3]);
        if stated != length {
            return Err(damaged(
                number,
                &format!("a length of {stated}"),
                &format!("{length} pixels, as in the header"),
            ));
        }
        planes.resize(4 * length, 0);
        for plane in planes.chunks_exact_mut(length) {
            component(&mut bytes, plane)?;
        }
        for (x, pixel) in line.iter_mut().enumerate() {
            *pixel = [planes[x], planes[length + x], planes[2 * length + x], planes[3 * length + x]];
        }
    } else {
        old(&mut bytes, first, line)?;
    }
    Ok(bytes.count)
}

/// One component: a code above 128 is a run of one value, another one that many values.
fn component<R: BufRead>(bytes: &mut Bytes<'_, R>, plane: &mut [u8]) -> Result<(), Error> {
    let mut at = 0;
    while at < plane.len() {
        let mut code = [0];
        bytes.read(&mut code)?;
        let run = code[0] > 128;
        let count = usize::from(code[0] & if run { 127 } else { 255 });
        if count == 0 || count > plane.len() - at {
            let found = format!("a run of {count} where {} pixels are left", plane.len() - at);
            return Err(damaged(bytes.line, &found, "runs inside the line"));
        }
        let out = &mut plane[at..at + count];
        if run {
            let mut value = [0];
            bytes.read(&mut value)?;
            out.fill(value[0]);
        } else {
            bytes.read(out)?;
        }
        at += count;
    }
    Ok(())
}

/// Plain pixels; 1 1 1 n repeats the one before n times, and several such in a row are the digits of a number to base 256.
fn old<R: BufRead>(bytes: &mut Bytes<'_, R>, first: Pixel, line: &mut [Pixel]) -> Result<(), Error> {
    let (mut at, mut shift) = (0, 0);
    let mut next = Some(first);
    while at < line.len() {
        let pixel = match next.take() {
            Some(pixel) => pixel,
            None => bytes.pixel()?,
        };
        if pixel[..3] != [1, 1, 1] {
            line[at] = pixel;
            (at, shift) = (at + 1, 0);
            continue;
        }
        let count = usize::from(pixel[3]).checked_shl(shift).unwrap_or(usize::MAX);
        let left = line.len() - at;
        if at == 0 || shift > 24 || count > left {
            let found = format!("{count} repetitions after {at} pixels");
            return Err(damaged(bytes.line, &found, "repetitions of a pixel inside the line"));
        }
        let before = line[at - 1];
        line[at..at + count].fill(before);
        (at, shift) = (at + count, shift + 8);
    }
    Ok(())
}

/// Appends a scan line, by component where its length allows.
pub(super) fn write(line: &[Pixel], out: &mut Vec<u8>) {
    if !ENCODED.contains(&line.len()) {
        line.iter().for_each(|pixel| out.extend(pixel));
        return;
    }
    let [.., high, low] = (line.len() as u64).to_be_bytes();
    out.extend([2, 2, high, low]);
    let mut plane = Vec::with_capacity(line.len());
    for k in 0..4 {
        plane.clear();
        plane.extend(line.iter().map(|pixel| pixel[k]));
        encode(&plane, out);
    }
}

/// One component as runs and stretches without.
fn encode(plane: &[u8], out: &mut Vec<u8>) {
    let plain = |values: &[u8], out: &mut Vec<u8>| {
        for part in values.chunks(LONGEST_PLAIN) {
            out.push(u8::try_from(part.len()).unwrap_or(0));
            out.extend(part);
        }
    };
    let (mut at, mut start) = (0, 0);
    while at < plane.len() {
        let run = plane[at..].iter().take(LONGEST_RUN).take_while(|v| **v == plane[at]).count();
        if run >= SHORTEST_RUN {
            plain(&plane[start..at], out);
            out.extend([128 | u8::try_from(run).unwrap_or(0), plane[at]]);
            start = at + run;
        }
        at += run;
    }
    plain(&plane[start..], out);
}

/// The value of each component: (m + ½)/256 · 2^(e − 128), exact in `f64`.
pub(super) fn value([a, b, c, exponent]: Pixel) -> [f64; 3] {
    if exponent == 0 {
        return [0.0; 3];
    }
    let scale = f64::powi(2.0, i32::from(exponent) - 128 - 8);
    [a, b, c].map(|m| (f64::from(m) + 0.5) * scale)
}

/// The pixel of three values, cut off below; negative ones become 0. `None` where the largest does not fit.
pub(super) fn pixel(values: [f64; 3]) -> Option<Pixel> {
    let largest = values.into_iter().fold(0.0, f64::max);
    if largest < SMALLEST {
        return Some([0; 4]);
    }
    if largest >= LARGEST {
        return None;
    }
    // The exponent that brings the largest to [½, 1): values are normal doubles.
    let exponent = i32::try_from(largest.to_bits() >> 52).unwrap_or(0) - 1022;
    let scale = f64::powi(2.0, 8 - exponent);
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "mantissas are cut off, as Radiance does"
    )]
    let [a, b, c] = values.map(|v| (v.max(0.0) * scale) as u8);
    Some([a, b, c, u8::try_from(exponent + 128).unwrap_or(0)])
}

/// The smallest value that is not black: Radiance's own limit (`setcolr`), and above the smallest exponent.
const SMALLEST: f64 = 1e-32;
/// What no exponent reaches: 2^127.
pub(super) const LARGEST: f64 = 1.701_411_834_604_692_3e38;

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn values_are_those_of_radiance() {
        // Radiance, src/common/color.c: (m + .5) · 2^(e − 136).
        assert_eq!(value([128, 0, 255, 128]), [128.5 / 256.0, 0.5 / 256.0, 255.5 / 256.0]);
        assert_eq!(value([9, 9, 9, 0]), [0.0; 3]);
        assert_eq!(pixel([1.0, 0.5, 0.25]), Some([128, 64, 32, 129]));
        assert_eq!(pixel([0.99, -1.0, 0.0]), Some([253, 0, 0, 128]));
        assert_eq!(pixel([0.0; 3]), Some([0; 4]));
        assert_eq!(pixel([LARGEST, 0.0, 0.0]), None);
        assert!(pixel([LARGEST.next_down(), 0.0, 0.0]).is_some());
        assert_eq!(pixel([1.01e-32, 0.0, 0.0]).map(|p| p[0] >= 128), Some(true));
    }

    #[test]
    fn damaged_lines_are_refused() {
        let mut line = [[0; 4]; 8];
        for (bytes, want) in [
            (&[2, 2, 0, 9, 136, 1][..], "a length of 9"),
            (&[2, 2, 0, 8, 137, 1], "a run of 9"),
            (&[2, 2, 0, 8, 0, 1], "a run of 0"),
            (&[2, 2, 0, 8, 136], "the end of the file"),
            (&[1, 1, 1, 3], "3 repetitions after 0 pixels"),
            (&[5, 5, 5, 5, 1, 1, 1, 8], "8 repetitions after 1 pixels"),
            (&[5, 5, 5, 5], "the end of the file"),
        ] {
            let error = read(&mut &*bytes, 3, &mut line, &mut Vec::new()).expect_err("refused");
            assert!(error.to_string().contains(want) && error.to_string().contains("scan line 4"), "{error}");
        }
    }

    #[test]
    fn old_runs_count_by_digits() {
        let mut line = [[0; 4]; 260];
        // 3 + 1 · 256 repetitions of the one pixel before.
        let bytes = [7, 8, 9, 130, 1, 1, 1, 3, 1, 1, 1, 1];
        assert_eq!(read(&mut &bytes[..], 0, &mut line, &mut Vec::new()).expect("whole"), 12);
        assert!(line.iter().all(|p| *p == [7, 8, 9, 130]));
    }

    proptest! {
        #[test]
        fn lines_come_back(line in prop::collection::vec((prop::array::uniform4(0_u8..4), 1_usize..200), 1..12)) {
            let line: Vec<Pixel> = line.iter().flat_map(|(p, n)| std::iter::repeat_n([p[0] + 2, p[1], p[2], p[3]], *n)).collect();
            let (mut bytes, mut back) = (Vec::new(), vec![[0; 4]; line.len()]);
            write(&line, &mut bytes);
            let taken = read(&mut bytes.as_slice(), 0, &mut back, &mut Vec::new()).expect("whole");
            prop_assert_eq!(taken, bytes.len() as u64);
            prop_assert_eq!(back, line);
        }

        /// Truncation loses less than a unit of the largest component's mantissa, and half of it comes back.
        #[test]
        fn values_come_back(values in prop::array::uniform3(1e-6_f64..1e6)) {
            let largest = values.into_iter().fold(0.0, f64::max);
            let back = value(pixel(values).expect("in range"));
            for (got, want) in back.into_iter().zip(values) {
                prop_assert!((got - want).abs() <= largest / 256.0, "{got} {want}");
            }
        }
    }
}
