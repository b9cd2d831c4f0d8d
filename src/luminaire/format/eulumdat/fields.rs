//! One value per line: the cursor over the lines, and numbers with what may stand around them.

use super::super::error::{Error, ErrorKind};
use super::super::text::{Line, Text};
use crate::finding::{Finding, Location};

/// Units that writers put behind a number, though the format has none.
const UNITS: [&str; 7] = ["mm", "%", "w", "watt", "lm", "°", "deg"];

/// A number line's text, decoded.
pub(super) enum Number {
    /// A finite number; `comma` where its decimal sign is a comma.
    Value { value: f64, comma: bool },
    /// NaN or infinite.
    NotFinite,
    /// Anything else.
    Text,
}

/// A number with decimal point or comma, exponent with E or D.
pub(super) fn number(text: &str) -> Number {
    // What `parse` takes besides digits ("inf", "nan", "infinity") is no finite number.
    if let Ok(value) = text.parse::<f64>() {
        return if value.is_finite() { Number::Value { value, comma: false } } else { Number::NotFinite };
    }
    if text.len() > 64 || !text.bytes().all(|b| b.is_ascii_digit() || b"+-.,eEdD".contains(&b)) {
        return Number::Text;
    }
    let comma = text.contains(',');
    if comma && (text.contains('.') || text.matches(',').count() > 1) {
        return Number::Text;
    }
    match text.replace(',', ".").replace(['d', 'D'], "e").parse::<f64>() {
        Ok(value) if value.is_finite() => Number::Value { value, comma },
        Ok(_) => Number::NotFinite,
        Err(_) => Number::Text,
    }
}

/// The lines of a file, taken one by one.
pub(super) struct Fields<'t> {
    lines: Vec<Line<'t>>,
    next: usize,
    pub(super) findings: Vec<Finding>,
    comma: Option<u64>,
    pub(super) repair: bool,
    /// Lines on which a repair found several numbers, and the first of them.
    several: (usize, u64),
}

impl<'t> Fields<'t> {
    pub(super) fn new(text: &'t Text<'_>, repair: bool) -> Self {
        let mut lines: Vec<Line<'t>> = text.lines().collect();
        let mut findings: Vec<Finding> = text.finding.clone().into_iter().collect();
        let blank = |line: &Line<'_>| line.text.trim().is_empty();
        // Line 2 is a digit in every file; where it and all even lines are blank, a transfer has doubled the line ends.
        if lines.len() > 4 && lines.iter().skip(1).step_by(2).all(blank) && !lines.iter().skip(2).step_by(2).all(blank)
        {
            lines = lines.into_iter().step_by(2).collect();
            findings.push(Finding::info("L205", "every second line is blank and was left out"));
        }
        Self { lines, next: 0, findings, comma: None, repair, several: (0, 0) }
    }

    /// The line that is next, or the one behind the last.
    pub(super) fn here(&self) -> Location {
        Location::line(self.lines.get(self.next).or(self.lines.last()).map_or(1, |line| line.number))
    }

    /// The place of the line taken last.
    pub(super) fn last(&self) -> Location {
        Location::line(self.lines.get(self.next.saturating_sub(1)).map_or(1, |line| line.number))
    }

    fn take(&mut self, field: &str) -> Result<&'t str, Error> {
        let Some(line) = self.lines.get(self.next) else {
            return Err(Error::new(
                self.here(),
                ErrorKind::Unexpected {
                    found: format!("the end of the file after {} lines", self.lines.len()),
                    expected: field.to_owned(),
                },
            )
            .with_hint(
                "the file is cut off; a EULUMDAT file has 26 lines, 6 per set of lamps, 10 direct ratios and its table",
            ));
        };
        self.next += 1;
        Ok(line.text.trim())
    }

    /// A line of text.
    pub(super) fn text(&mut self, field: &str) -> Result<String, Error> {
        self.take(field).map(ToOwned::to_owned)
    }

    fn accept(&mut self, text: &str, field: &str) -> Result<f64, Error> {
        match number(text) {
            Number::Value { value, comma } => {
                if comma && self.comma.is_none() {
                    self.comma = self.last().line;
                }
                Ok(value)
            }
            Number::NotFinite => {
                Err(Error::new(self.last(), ErrorKind::NotFinite { found: shown(text), field: field.to_owned() }))
            }
            Number::Text => {
                Err(Error::new(self.last(), ErrorKind::NotANumber { found: shown(text), field: field.to_owned() })
                    .with_hint("each line of a EULUMDAT file has one value; a line may be missing or doubled above"))
            }
        }
    }

    /// A number on which the light or the reading of the table depends.
    pub(super) fn needed(&mut self, field: &str) -> Result<f64, Error> {
        let text = self.take(field)?;
        self.accept(text, field)
    }

    /// A number that describes only: an empty line is 0, a unit may follow.
    pub(super) fn described(&mut self, field: &str) -> Result<f64, Error> {
        let text = self.take(field)?;
        if text.is_empty() {
            let message = format!("the line of {field} is empty; 0 taken");
            self.findings.push(Finding::info("L201", message).at(self.last()));
            return Ok(0.0);
        }
        match split_unit(text) {
            Some((digits, unit)) => {
                let message = format!("{field} has its unit `{unit}` behind it");
                self.findings.push(Finding::info("L203", message).at(self.last()));
                self.accept(digits, field)
            }
            None => self.accept(text, field),
        }
    }

    /// A number that may be missing or text: the power of a set of lamps.
    pub(super) fn optional(&mut self, field: &str) -> Result<Option<f64>, Error> {
        let text = self.take(field)?;
        let digits = split_unit(text).map_or(text, |(digits, _)| digits);
        match number(digits) {
            Number::Text if text.is_empty() => Ok(None),
            Number::Text => {
                let message = format!("`{}` for {field} is no number; none taken", shown(text));
                self.findings.push(Finding::warning("L204", message).at(self.last()));
                Ok(None)
            }
            _ => self.accept(digits, field).map(Some),
        }
    }

    /// A whole number of a range.
    pub(super) fn count(&mut self, field: &str, low: u64, high: u64) -> Result<usize, Error> {
        let value = self.needed(field)?;
        if value.fract() != 0.0 || value < low as f64 {
            let expected = format!("a whole number of {low} or more");
            return Err(Error::new(
                self.last(),
                ErrorKind::OutOfRange { found: value.to_string(), field: field.to_owned(), expected },
            ));
        }
        if value > high as f64 {
            return Err(Error::new(
                self.last(),
                ErrorKind::TooLarge { found: value.to_string(), field: field.to_owned(), limit: high },
            ));
        }
        Ok(value as usize)
    }

    /// `count` numbers from as many lines; blank lines between are left out.
    pub(super) fn list(&mut self, field: &str, count: usize) -> Result<Vec<f64>, Error> {
        let mut out = Vec::new();
        while out.len() < count {
            let Some(line) = self.lines.get(self.next) else {
                let kind = ErrorKind::TooFew { found: out.len(), expected: count, field: field.to_owned() };
                return Err(Error::new(self.here(), kind)
                    .with_hint("the file is cut off, or Mc (line 4), Ng (line 6) or Isym (line 3) is wrong"));
            };
            self.next += 1;
            let text = line.text.trim();
            if text.is_empty() {
                continue;
            }
            let several = text.split_whitespace().nth(1).is_some()
                && text.split_whitespace().all(|t| matches!(number(t), Number::Value { .. }));
            if several && self.repair && out.len() + text.split_whitespace().count() <= count {
                self.several = (self.several.0 + 1, if self.several.1 == 0 { line.number } else { self.several.1 });
                for word in text.split_whitespace() {
                    out.push(self.accept(word, field)?);
                }
                continue;
            }
            if several {
                let found = format!("{} numbers on one line", text.split_whitespace().count());
                return Err(Error::new(
                    Location::line(line.number),
                    ErrorKind::Unexpected { found, expected: format!("one number per line for {field}") },
                )
                .with_hint("EULUMDAT has one value per line; --repair takes them in the order of reading"));
            }
            out.push(self.accept(text, field)?);
        }
        Ok(out)
    }

    /// How many lines with a number follow from here, up to a line of text or the end; blank lines are left out, but end the
    /// count once it has reached `enough`.
    pub(super) fn numbers_ahead(&self, enough: &[usize]) -> usize {
        let mut count = 0;
        for line in &self.lines[self.next.min(self.lines.len())..] {
            let text = line.text.trim();
            if text.is_empty() {
                if enough.contains(&count) {
                    break;
                }
            } else if !matches!(number(text), Number::Text) {
                count += 1;
            } else if self.repair && text.split_whitespace().all(|t| !matches!(number(t), Number::Text)) {
                count += text.split_whitespace().count();
            } else {
                break;
            }
        }
        count
    }

    /// What is left over, and the finding on decimal commas.
    pub(super) fn finish(mut self) -> Vec<Finding> {
        if let Some(line) = self.comma {
            let message = "numbers with decimal commas were read; the format has decimal points";
            self.findings.push(Finding::info("L202", message).at(Location::line(line)));
        }
        if self.several.0 > 0 {
            let message =
                format!("repaired: {} lines with several numbers were read from left to right", self.several.0);
            self.findings.push(Finding::warning("L232", message).at(Location::line(self.several.1)));
        }
        let rest: Vec<&Line<'_>> = self.lines[self.next..].iter().filter(|l| !l.text.trim().is_empty()).collect();
        if let Some(first) = rest.first() {
            let message = format!(
                "{} line{} behind the last intensity not read: `{}`",
                rest.len(),
                if rest.len() == 1 { "" } else { "s" },
                shown(first.text.trim())
            );
            self.findings.push(Finding::info("L206", message).at(Location::line(first.number)));
        }
        self.findings
    }
}

/// Digits and the unit behind them.
fn split_unit(text: &str) -> Option<(&str, &str)> {
    let at = text.rfind(|c: char| c.is_ascii_digit() || c == '.')? + 1;
    let (digits, unit) = (text[..at].trim_end(), text[at..].trim());
    UNITS.contains(&unit.to_lowercase().as_str()).then_some((digits, unit))
}

/// A text, cut to a length that fits a message.
pub(super) fn shown(text: &str) -> String {
    match text.char_indices().nth(40) {
        Some((at, _)) => format!("{}…", &text[..at]),
        None => text.to_owned(),
    }
}
