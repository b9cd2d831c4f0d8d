//! The numbers of a file: lamp line, ballast line, angles, candela; and what each may be.

use super::super::error::{Error, ErrorKind};
use super::super::text::place;
use super::header::Header;
use super::scan::{Numbers, rest};
use super::version::file_generation;
use super::{RawIes, ReadOptions, Tilt, TiltTable, Units, Version, angles};
use crate::finding::Finding;
use crate::luminaire::System;

/// The most angles in either direction. The standard has no limit; the finest goniophotometers step 0.01°.
const MOST_ANGLES: u64 = 100_000;

/// The field that a lamp line's number fills, in order.
const LAMP_LINE: [&str; 10] = [
    "number of lamps",
    "lumens per lamp",
    "candela multiplier",
    "number of vertical angles",
    "number of horizontal angles",
    "photometric type",
    "units type",
    "luminous opening width",
    "luminous opening length",
    "luminous opening height",
];
const BALLAST_LINE: [&str; 3] = ["ballast factor", "ballast-lamp photometric factor", "input watts"];
const BALLAST_HINT: &str = "the line with ballast factor, photometric factor and input watts may be missing";

/// Reads the numbers, and collects what is odd about them.
pub(super) struct Reader<'t> {
    text: &'t str,
    options: ReadOptions,
    pub(super) findings: Vec<Finding>,
}

/// A number with the offset where it stands.
#[derive(Clone, Copy)]
struct At {
    value: f64,
    offset: usize,
}

impl<'t> Reader<'t> {
    pub(super) fn new(text: &'t str, options: ReadOptions) -> Self {
        Self { text, options, findings: Vec::new() }
    }

    /// The file whose lines up to TILT are `header`.
    pub(super) fn file(&mut self, header: &Header) -> Result<RawIes, Error> {
        let mut numbers = Numbers::new(self.text, header.numbers);
        let tilt = match &header.tilt {
            Tilt::Include(_) => {
                let at = numbers.peek();
                let table = TiltTable::take(self.text, &mut numbers)?;
                self.findings.extend(table.findings(place(self.text, at)));
                Tilt::Include(table)
            }
            other => other.clone(),
        };
        let [lamps, lumens, multiplier, nv, nh, system, units, width, length, height] =
            self.line(&mut numbers, LAMP_LINE, "the lamp line")?;
        let lumens_per_lamp = self.lumens(lamps, lumens)?;
        let multiplier = self.positive(multiplier, "candela multiplier", None)?;
        let nv = self.count(nv, LAMP_LINE[3])?;
        let nh = self.count(nh, LAMP_LINE[4])?;
        let system = match system.value {
            1.0 => System::TypeC,
            2.0 => System::TypeB,
            3.0 => System::TypeA,
            _ => return Err(self.out_of_range(system, "photometric type", "1 (Type C), 2 (Type B) or 3 (Type A)")),
        };
        let units = match units.value {
            1.0 => Units::Feet,
            2.0 => Units::Metres,
            _ => return Err(self.out_of_range(units, "units type", "1 (feet) or 2 (metres)")),
        };
        let [ballast, photometric, watts] = self.line(&mut numbers, BALLAST_LINE, "the ballast line")?;
        let ballast_factor = self.positive(ballast, BALLAST_LINE[0], Some(BALLAST_HINT))?;
        let photometric_factor = self.photometric(header.version, photometric)?;
        self.watts(watts);
        let verticals = numbers.peek();
        let vertical_deg = self.short(numbers.take("vertical angles", nv))?;
        let horizontals = numbers.peek();
        let horizontal_deg = self.short(numbers.take("horizontal angles", nh))?;
        let table = numbers.take("candela values", nv.saturating_mul(nh));
        if table.as_ref().is_err_and(|e| !matches!(e.kind(), ErrorKind::TooFew { .. })) {
            // Wrong counts shift everything behind them: the angles tell it better than the last number does.
            self.angles(system, (&vertical_deg, verticals), (&horizontal_deg, horizontals))?;
        }
        let candela = self.short(table)?;
        self.angles(system, (&vertical_deg, verticals), (&horizontal_deg, horizontals))?;
        self.rest(numbers.offset(), nv, nh)?;
        let mut raw = RawIes {
            version: header.version,
            version_line: header.version_line.clone(),
            keywords: header.keywords.clone(),
            tilt,
            lamps: lamps.value,
            lumens_per_lamp,
            multiplier,
            system,
            units,
            opening: [width.value, length.value, height.value],
            ballast_factor,
            photometric_factor,
            input_watts: watts.value,
            vertical_deg,
            horizontal_deg,
            candela,
        };
        self.nadir(&mut raw, verticals);
        Ok(raw)
    }

    fn line<const N: usize>(&self, numbers: &mut Numbers<'_>, fields: [&str; N], line: &str) -> Result<[At; N], Error> {
        let mut out = [At { value: 0.0, offset: 0 }; N];
        for (index, field) in fields.iter().enumerate() {
            let offset = numbers.peek();
            let value = if offset < self.text.len() {
                numbers.next(field, 0, 1)?
            } else {
                numbers.next(&format!("{line} ({field})"), index, N)?
            };
            out[index] = At { value, offset };
        }
        Ok(out)
    }

    fn out_of_range(&self, found: At, field: &str, expected: &str) -> Error {
        let kind =
            ErrorKind::OutOfRange { found: found.value.to_string(), field: field.into(), expected: expected.into() };
        Error::new(place(self.text, found.offset), kind)
    }

    fn count(&self, count: At, field: &str) -> Result<usize, Error> {
        if count.value.fract() != 0.0 || count.value < 1.0 {
            return Err(self.out_of_range(count, field, "a whole number of 1 or more"));
        }
        if count.value > MOST_ANGLES as f64 {
            let kind = ErrorKind::TooLarge { found: count.value.to_string(), field: field.into(), limit: MOST_ANGLES };
            return Err(Error::new(place(self.text, count.offset), kind));
        }
        Ok(count.value as usize)
    }

    /// A factor above 0; one of 0 would load an empty distribution.
    fn positive(&mut self, factor: At, field: &str, hint: Option<&'static str>) -> Result<f64, Error> {
        if factor.value > 0.0 {
            return Ok(factor.value);
        }
        if factor.value == 0.0 && self.options.repair {
            self.findings.push(
                Finding::warning("L032", format!("repaired: the {field} of 0 was taken as 1"))
                    .at(place(self.text, factor.offset)),
            );
            return Ok(1.0);
        }
        let error = self.out_of_range(factor, field, "a number above 0");
        Err(match hint {
            Some(hint) => error.with_hint(hint),
            None => error,
        })
    }

    fn photometric(&mut self, version: Version, factor: At) -> Result<f64, Error> {
        let value = factor.value;
        let at = place(self.text, factor.offset);
        match version {
            Version::Lm63_2019 => {
                if file_generation(value).is_none() {
                    let message =
                        format!("{value} is no file-generation code of LM-63-2019; it does not scale anything");
                    self.findings.push(Finding::info("L014", message).at(at));
                }
            }
            Version::Lm63_2002 if value != 1.0 => {
                let what = if value == 0.0 { "ignored" } else { "applied, as the earlier editions have it" };
                if value < 0.0 {
                    return Err(self.out_of_range(factor, BALLAST_LINE[1], "1"));
                }
                let message = format!(
                    "{value} stands where LM-63-2002 reserves a field and asks for 1 (ballast-lamp photometric factor); {what}"
                );
                self.findings.push(Finding::warning("L013", message).at(at));
            }
            Version::Lm63_2002 => {}
            _ => return self.positive(factor, BALLAST_LINE[1], Some(BALLAST_HINT)),
        }
        Ok(value)
    }

    fn lumens(&mut self, lamps: At, lumens: At) -> Result<Option<f64>, Error> {
        if lamps.value < 0.0 {
            return Err(self.out_of_range(lamps, LAMP_LINE[0], "0 or more"));
        }
        if lumens.value == -1.0 {
            return Ok(None);
        }
        if lumens.value < 0.0 {
            return Err(self.out_of_range(lumens, LAMP_LINE[1], "−1 (absolute photometry) or more than 0"));
        }
        if lumens.value == 0.0 || lamps.value == 0.0 {
            let message = format!("{} lamps of {} lm: the lamps' flux is not known", lamps.value, lumens.value);
            self.findings.push(
                Finding::warning("L015", message)
                    .at(place(self.text, lamps.offset))
                    .hint("absolute photometry is written as 1 lamp of −1 lm"),
            );
        }
        Ok(Some(lumens.value))
    }

    fn watts(&mut self, watts: At) {
        let at = place(self.text, watts.offset);
        if watts.value == 0.0 {
            self.findings.push(Finding::info("L016", "input watts of 0: not known").at(at));
        } else if watts.value < 0.0 {
            let message = format!("input watts of {}: not used", watts.value);
            self.findings.push(Finding::warning("L016", message).at(at));
        }
    }

    /// A list that ends exactly three numbers early lacks the ballast line.
    fn short<T>(&self, taken: Result<T, Error>) -> Result<T, Error> {
        taken.map_err(|error| match error.kind() {
            ErrorKind::TooFew { found, expected, .. } if *found + 3 == *expected => error.with_hint(BALLAST_HINT),
            ErrorKind::TooFew { .. } => {
                error.with_hint("the file may be cut off, or the counts of angles in the lamp line are wrong")
            }
            _ => error,
        })
    }

    fn angles(&mut self, system: System, vertical: (&[f64], usize), horizontal: (&[f64], usize)) -> Result<(), Error> {
        let (text, findings) = (self.text, &mut self.findings);
        angles::check("vertical", vertical.0, angles::vertical_range(system), text, vertical.1, findings)?;
        angles::check("horizontal", horizontal.0, angles::horizontal_range(system), text, horizontal.1, findings)?;
        let mut sorted = horizontal.0.to_vec();
        sorted.sort_by(f64::total_cmp);
        if let Err(expected) = angles::planes(system, &sorted) {
            let kind = ErrorKind::OutOfRange {
                found: format!("{}° to {}°", sorted[0], sorted[sorted.len() - 1]),
                field: "horizontal angles".into(),
                expected: expected.into(),
            };
            return Err(Error::new(place(text, horizontal.1), kind));
        }
        Ok(())
    }

    fn rest(&mut self, offset: usize, nv: usize, nh: usize) -> Result<(), Error> {
        let rest = rest(self.text, offset);
        if let Some((count, at)) = rest.numbers {
            let place = place(self.text, at);
            if !self.options.repair {
                let kind = ErrorKind::Unexpected {
                    found: format!("{count} more numbers"),
                    expected: format!("the end of the table after {nh} × {nv} candela values"),
                };
                return Err(Error::new(place, kind)
                    .with_hint("the counts of angles may be wrong; a repair leaves the numbers out"));
            }
            let message = format!("repaired: {count} numbers after the table of {nh} × {nv} were left out");
            self.findings.push(Finding::warning("L030", message).at(place));
        }
        if let Some(at) = rest.text {
            let line: String = self.text[at..].lines().next().unwrap_or_default().chars().take(40).collect();
            let message = format!("text after the table was not read: `{line}`");
            self.findings.push(Finding::info("L007", message).at(place(self.text, at)));
        }
        Ok(())
    }

    /// Angles that do not begin and end where the standard asks; with repair, a nadir row before the first one.
    fn nadir(&mut self, raw: &mut RawIes, offset: usize) {
        let (down, n) = (angles::descending(&raw.vertical_deg), raw.vertical_deg.len());
        let (first, last) = (raw.vertical_deg[0], raw.vertical_deg[n - 1]);
        let (low, high) = if down { (last, first) } else { (first, last) };
        let is = |a: f64, allowed: &[f64]| allowed.iter().any(|b| angles::near(a, *b));
        let (lows, highs): (&[f64], &[f64]) =
            if raw.system == System::TypeC { (&[0.0, 90.0], &[90.0, 180.0]) } else { (&[-90.0, 0.0], &[90.0]) };
        if is(low, lows) && is(high, highs) {
            return;
        }
        let at = place(self.text, offset);
        let step = if n > 1 { (raw.vertical_deg[1] - raw.vertical_deg[0]).abs() } else { 0.0 };
        let repairable = raw.system == System::TypeC && !down && low > 0.0 && low <= step * 2.0;
        if self.options.repair && repairable {
            let planes = raw.horizontal_deg.len();
            let mean = raw.candela.iter().step_by(n).sum::<f64>() / planes as f64;
            raw.candela = raw.candela.chunks(n).flat_map(|p| std::iter::once(mean).chain(p.iter().copied())).collect();
            raw.vertical_deg.insert(0, 0.0);
            let message = format!("repaired: a nadir row of {mean}, the mean at {low}°, was added");
            self.findings.push(Finding::warning("L031", message).at(at));
            return;
        }
        let asked = if raw.system == System::TypeC { "0° or 90° to 90° or 180°" } else { "−90° or 0° to 90°" };
        let message = format!(
            "vertical angles from {low}° to {high}°, where the standard asks for {asked}; no light outside of them"
        );
        self.findings.push(Finding::warning("L021", message).at(at));
    }
}
