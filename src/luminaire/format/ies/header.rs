//! The lines before the numbers: version, keywords or labels, TILT.

use super::super::error::{Error, ErrorKind};
use super::super::text::{Line, Text};
use super::version::{KEYWORDS, Version, VersionLine, version_line};
use super::{Keyword, Tilt};
use crate::finding::{Finding, Location};

/// What stands before the numbers.
pub(super) struct Header {
    pub(super) version: Version,
    pub(super) version_line: Option<String>,
    pub(super) keywords: Vec<Keyword>,
    pub(super) tilt: Tilt,
    /// Offset of the first number.
    pub(super) numbers: usize,
}

/// Reads the lines up to and with `TILT=`.
pub(super) fn header(text: &Text<'_>, findings: &mut Vec<Finding>) -> Result<Header, Error> {
    let mut lines = text.lines();
    let mut header =
        Header { version: Version::Lm63_1986, version_line: None, keywords: Vec::new(), tilt: Tilt::None, numbers: 0 };
    let mut oddities = Oddities::default();
    let mut first = true;
    loop {
        let Some(line) = lines.next() else {
            let kind = ErrorKind::Unexpected {
                found: "the end of the file".into(),
                expected: "a line TILT=NONE, TILT=INCLUDE or TILT=<file name>".into(),
            };
            let place = Location::line(text.lines().last().map_or(1, |l| l.number));
            return Err(Error::new(place, kind)
                .with_hint("an LM-63 file without its TILT line cannot be told apart from others"));
        };
        if let Some((value, at)) = tilt_value(line.text) {
            if first {
                findings.push(no_version_line(&line));
            }
            header.tilt = tilt(&line, value, at, lines.offset(), &mut header.numbers, findings)?;
            break;
        }
        let trimmed = line.text.trim();
        if first && !trimmed.is_empty() {
            first = false;
            if read_version(&mut header, &line, findings) {
                continue;
            }
        }
        keyword_line(&mut header.keywords, &line, &mut oddities);
        if line.text.chars().count() > header.version.line_length() {
            oddities.long.push(line.number);
        }
    }
    while header.keywords.last().is_some_and(|k| k.name.is_empty() && k.text.is_empty()) {
        header.keywords.pop();
    }
    oddities.report(&header, findings);
    Ok(header)
}

fn no_version_line(line: &Line<'_>) -> Finding {
    Finding::info("L001", "no version line; read by the rules of LM-63-1986, the edition that has none")
        .at(Location::line(line.number))
}

/// Takes the first line for the version line, if it is one.
fn read_version(header: &mut Header, line: &Line<'_>, findings: &mut Vec<Finding>) -> bool {
    let exact = match version_line(line.text) {
        VersionLine::Missing => {
            findings.push(no_version_line(line));
            return false;
        }
        VersionLine::Unknown => {
            header.version = Version::Lm63_2002;
            let message = format!("`{}` is no known edition; read by the rules of LM-63-2002", line.text.trim());
            findings.push(Finding::warning("L002", message).at(Location::line(line.number)));
            true
        }
        VersionLine::Is(version, exact) => {
            header.version = version;
            exact
        }
    };
    if !exact || line.number > 1 {
        let expected = header.version.line().unwrap_or("no version line");
        let after = if line.number > 1 { ", after blank lines" } else { "" };
        let message =
            format!("the version line reads `{}`{after}; the standard's first line is `{expected}`", line.text);
        findings.push(Finding::info("L003", message).at(Location::line(line.number)));
    }
    header.version_line = Some(line.text.trim().to_owned());
    true
}

/// What follows `TILT=`, with its byte offset in the line, where the line is that line.
fn tilt_value(line: &str) -> Option<(&str, usize)> {
    let start = line.trim_start();
    let word = start.get(..4).filter(|word| word.eq_ignore_ascii_case("tilt"))?;
    let value = start[word.len()..].trim_start().strip_prefix('=')?;
    Some((value, line.len() - value.len()))
}

fn tilt(
    line: &Line<'_>,
    value: &str,
    at: usize,
    next_line: usize,
    numbers: &mut usize,
    findings: &mut Vec<Finding>,
) -> Result<Tilt, Error> {
    let word = value.split_whitespace().next().unwrap_or_default();
    let behind = line.offset + at + (value.len() - value.trim_start().len()) + word.len();
    *numbers = next_line;
    let tilt = match word.to_ascii_uppercase().as_str() {
        "" => {
            let kind = ErrorKind::Unexpected {
                found: "TILT= and nothing behind it".into(),
                expected: "NONE, INCLUDE or a file name".into(),
            };
            return Err(Error::new(line.at(at), kind));
        }
        "NONE" => {
            *numbers = behind;
            Tilt::None
        }
        "INCLUDE" => {
            *numbers = behind;
            Tilt::Include(super::TiltTable::default())
        }
        _ => {
            let name = value.trim().trim_matches('"').to_owned();
            let message = format!(
                "the lamp's output over luminaire tilt is in another file, `{name}`; the intensities hold for the position that was tested"
            );
            findings.push(Finding::info("L005", message).at(line.at(at)));
            return Ok(Tilt::File(name));
        }
    };
    if line.text.trim_end() != format!("TILT={}", word.to_ascii_uppercase()) {
        let message =
            format!("the TILT line reads `{}`; the standard has no blanks or small letters in it", line.text.trim());
        findings.push(Finding::info("L004", message).at(line.at(0)));
    }
    Ok(tilt)
}

fn keyword_line(keywords: &mut Vec<Keyword>, line: &Line<'_>, oddities: &mut Oddities) {
    let text = line.text.trim();
    let Some((name, value)) = text.strip_prefix('[').and_then(|t| t.split_once(']')) else {
        if !text.is_empty() {
            oddities.bare.push(line.number);
            keywords.push(Keyword { name: String::new(), text: text.to_owned(), line: line.number });
        }
        return;
    };
    let (name, value) = (name.trim().to_ascii_uppercase(), value.trim());
    if name == "MORE" {
        match keywords.last_mut() {
            Some(last) => {
                last.text.push('\n');
                last.text.push_str(value);
                return;
            }
            None => oddities.more.push(line.number),
        }
    }
    if !name.starts_with('_') && !KEYWORDS.contains(&name.as_str()) {
        oddities.unknown.push((name.clone(), line.number));
    }
    keywords.push(Keyword { name, text: value.to_owned(), line: line.number });
}

/// Deviations that are reported once each, however many lines have them.
#[derive(Default)]
struct Oddities {
    bare: Vec<u64>,
    more: Vec<u64>,
    unknown: Vec<(String, u64)>,
    long: Vec<u64>,
}

impl Oddities {
    fn report(&self, header: &Header, findings: &mut Vec<Finding>) {
        let version = header.version;
        let missing: Vec<&str> = (version.required().iter().copied())
            .filter(|name| !header.keywords.iter().any(|k| k.name == *name && !k.text.is_empty()))
            .collect();
        if !missing.is_empty() {
            let message = format!("{version} requires [{}], missing or empty here", missing.join("], ["));
            findings.push(Finding::info("L008", message));
        }
        if let (Some(&(_, line)), true) = (self.unknown.first(), header.version_line.is_some()) {
            let names: Vec<&str> = self.unknown.iter().map(|(name, _)| name.as_str()).collect();
            let message = format!("[{}]: no keyword of LM-63, whose own begin with `_`; kept", names.join("], ["));
            findings.push(Finding::info("L009", message).at(Location::line(line)));
        }
        if let (Some(&line), true) = (self.bare.first(), version.has_keywords()) {
            let message = format!("{} without a [KEYWORD] before TILT; kept as text", lines(self.bare.len()));
            findings.push(Finding::info("L010", message).at(Location::line(line)));
        }
        if let Some(&line) = self.more.first() {
            findings.push(Finding::info("L010", "[MORE] continues nothing; kept").at(Location::line(line)));
        }
        if let (Some(&line), true) = (self.long.first(), header.version_line.is_some()) {
            let most = version.line_length();
            let message = format!("{} longer than the {most} characters of {version}", lines(self.long.len()));
            findings.push(Finding::info("L011", message).at(Location::line(line)));
        }
    }
}

fn lines(count: usize) -> String {
    if count == 1 { "a line".to_owned() } else { format!("{count} lines") }
}
