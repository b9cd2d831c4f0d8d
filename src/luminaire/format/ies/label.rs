//! The keyword lines of a file to be written.

use super::Version;
use super::radiometric::{MILLIWATTS, Unit, stated_units};
use super::version::KEYWORDS;
use crate::finding::Finding;
use crate::luminaire::{Kind, Luminaire};

/// A keyword and its text, both ASCII.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Label {
    name: String,
    text: String,
}

impl Label {
    pub(super) fn new(name: &str, text: &str) -> Self {
        Self { name: name.to_owned(), text: text.to_owned() }
    }

    /// `[NAME] text`, continued by `[MORE]` where the line would be too long.
    pub(super) fn write(&self, out: &mut String, most: usize) {
        let mut name = self.name.as_str();
        let mut lines = self.text.lines();
        let mut next = Some(lines.next().unwrap_or_default());
        while let Some(line) = next {
            let mut rest = line.trim();
            loop {
                let room = most - name.len() - 3;
                let end = if rest.len() <= room {
                    rest.len()
                } else {
                    // ASCII: every byte is a character. At a blank, if there is one.
                    rest[..room].rfind(' ').filter(|at| *at > 0).unwrap_or(room)
                };
                out.push('[');
                out.push_str(name);
                out.push_str("] ");
                out.push_str(rest[..end].trim_end());
                out.push_str("\r\n");
                name = "MORE";
                rest = rest[end..].trim_start();
                if rest.is_empty() {
                    break;
                }
            }
            next = lines.next();
        }
    }
}

/// Characters outside ASCII in ASCII, and whether any was replaced.
pub(super) fn ascii(text: &str) -> (String, bool) {
    if text.bytes().all(|b| b == b'\n' || (b' '..=b'~').contains(&b)) {
        return (text.to_owned(), false);
    }
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '\n' | ' '..='~' => out.push(c),
            c if c.is_whitespace() => out.push(' '),
            'ä' | 'æ' => out.push_str("ae"),
            'ö' | 'ø' | 'œ' => out.push_str("oe"),
            'ü' => out.push_str("ue"),
            'Ä' | 'Æ' => out.push_str("Ae"),
            'Ö' | 'Ø' | 'Œ' => out.push_str("Oe"),
            'Ü' => out.push_str("Ue"),
            'ß' => out.push_str("ss"),
            'à'..='å' => out.push('a'),
            'ç' => out.push('c'),
            'è'..='ë' => out.push('e'),
            'ì'..='ï' => out.push('i'),
            'ñ' => out.push('n'),
            'ò'..='õ' => out.push('o'),
            'ù'..='û' => out.push('u'),
            'À'..='Å' => out.push('A'),
            'Ç' => out.push('C'),
            'È'..='Ë' => out.push('E'),
            'µ' | 'μ' => out.push('u'),
            '°' => out.push_str("deg"),
            '²' => out.push('2'),
            '³' => out.push('3'),
            '×' => out.push('x'),
            '±' => out.push_str("+/-"),
            '®' => out.push_str("(R)"),
            '©' => out.push_str("(C)"),
            '™' => out.push_str("(TM)"),
            '‘' | '’' => out.push('\''),
            '“' | '”' => out.push('"'),
            '–' | '—' | '−' => out.push('-'),
            '≥' => out.push_str(">="),
            '≤' => out.push_str("<="),
            '…' => out.push_str("..."),
            c if c.is_control() => out.push(' '),
            _ => out.push('?'),
        }
    }
    (out, true)
}

/// The unit of the intensities to be written: what the keywords already say, or else mW/sr with a keyword that says it;
/// `None` for candela, where keywords that say otherwise have to go.
fn radiometric(labels: &mut Vec<Label>, kind: Kind, findings: &mut Vec<Finding>) -> Option<Unit> {
    let stated = |label: &Label| stated_units(&label.name, &label.text).first().copied();
    if kind == Kind::Radiant {
        if let Some(unit) = labels.iter().find_map(stated) {
            return Some(unit);
        }
        labels.push(Label::new("_INTENSITYUNITS", "mW/sr (lumens -> mW, candela -> mW/sr)"));
        return Some(MILLIWATTS);
    }
    let gone: Vec<String> = labels.iter().filter(|l| stated(l).is_some()).map(|l| l.name.clone()).collect();
    labels.retain(|label| stated(label).is_none());
    if !gone.is_empty() {
        let message =
            format!("[{}] speak of radiant intensity and were left out: the values are candela", gone.join("], ["));
        findings.push(Finding::warning("L040", message));
    }
    None
}

/// All keywords of a luminaire, those that the edition requires among them; and the unit if it is not candela.
pub(super) fn labels(
    luminaire: &Luminaire,
    version: Version,
    findings: &mut Vec<Finding>,
) -> (Vec<Label>, Option<Unit>) {
    let mut labels = Vec::new();
    let mut replaced = Vec::new();
    let mut renamed = Vec::new();
    let mut push = |name: String, text: &str| {
        let (text, changed) = ascii(text);
        if changed {
            replaced.push(name.clone());
        }
        labels.push(Label { name, text });
    };
    // The standard's order: test, then product, then the rest.
    for wanted in ["TEST", "TESTLAB", "TESTDATE", "ISSUEDATE", "DATE"] {
        if let Some((name, text)) = luminaire.keywords.iter().find(|(name, _)| keyword(name) == wanted) {
            push(keyword(name), text);
        }
    }
    let fields =
        [("MANUFAC", &luminaire.manufacturer), ("LUMCAT", &luminaire.catalogue_number), ("LUMINAIRE", &luminaire.name)];
    for (name, text) in fields.into_iter().filter(|(_, text)| !text.is_empty()) {
        push(name.to_owned(), text);
    }
    for lamp in &luminaire.lamps {
        let texts = [("LAMP", &lamp.name), ("_LAMPCOLOR", &lamp.colour), ("_COLORRENDERING", &lamp.rendering)];
        for (name, text) in texts.into_iter().filter(|(_, text)| !text.is_empty()) {
            push(name.to_owned(), text);
        }
    }
    let mut seen = [false; 5];
    for (given, text) in &luminaire.keywords {
        let name = keyword(given);
        if matches!(name.as_str(), "_TILT" | "_FILEGENERATION") {
            continue;
        }
        // The first of each was written above.
        let first = ["TEST", "TESTLAB", "TESTDATE", "ISSUEDATE", "DATE"].iter().position(|known| *known == name);
        if first.is_some_and(|at| !std::mem::replace(&mut seen[at], true)) {
            continue;
        }
        if name != *given {
            renamed.push(format!("{given} as [{name}]"));
        }
        push(name, text);
    }
    let unit = radiometric(&mut labels, luminaire.kind, findings);
    let missing: Vec<&str> = version
        .required()
        .iter()
        .copied()
        .filter(|n| !labels.iter().any(|l| l.name == *n && !l.text.is_empty()))
        .collect();
    for (at, name) in missing.iter().enumerate() {
        labels.retain(|l| l.name != *name);
        labels.insert(at.min(labels.len()), Label::new(name, "unknown"));
    }
    if !missing.is_empty() {
        let message = format!("[{}]: required by {version} and not known; written as `unknown`", missing.join("], ["));
        findings.push(Finding::info("L042", message));
    }
    if !replaced.is_empty() {
        let message = format!("characters outside ASCII in [{}] were replaced", replaced.join("], ["));
        findings.push(Finding::info("L041", message));
    }
    if !renamed.is_empty() {
        let message = format!("keywords that are not LM-63's begin with `_`: {}", renamed.join(", "));
        findings.push(Finding::info("L043", message));
    }
    (labels, unit)
}

/// A name that LM-63 allows: its own, or one that begins with `_`; capitals, digits, `_`, `-` and blanks.
fn keyword(name: &str) -> String {
    let bare: String = ascii(name)
        .0
        .to_ascii_uppercase()
        .chars()
        .map(|c| if c.is_ascii_alphanumeric() || matches!(c, '_' | '-' | ' ') { c } else { '_' })
        .take(40)
        .collect();
    let bare = bare.trim();
    if bare.is_empty() {
        "OTHER".to_owned()
    } else if bare.starts_with('_') || (KEYWORDS.contains(&bare) && bare != "MORE") {
        bare.to_owned()
    } else {
        format!("_{bare}")
    }
}
