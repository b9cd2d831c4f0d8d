//! Radiometric LM-63 files: makers of far-UV lamps publish mW/sr in a format that knows candela only. Such files are
//! recognised by what they say, never by their values.

use super::super::error::{Error, ErrorKind};
use super::{Keyword, RawIes};
use crate::finding::{Finding, Location};
use crate::luminaire::Kind;

/// Words that say the intensities of the file are meant, besides a unit.
const MEANT: [&str; 6] = ["radiometric", "candela", "lumens->", "lumens=", "intensityunit", "radiantintensity"];

/// Words of ultraviolet or radiometry in keywords (their names) or text.
const ULTRAVIOLET: [&str; 6] = ["radiometric", "radiationtype", "uvc222", "uv-c", "far-uv", "germicidal"];

/// What the intensities are, the factor to the unit of [`Kind`], and what to say about it. Two units are a contradiction.
pub(super) fn kind(raw: &RawIes) -> Result<(Kind, f64, Option<Finding>), Error> {
    let mut mention = None;
    let mut stated: Option<(&Keyword, Unit)> = None;
    for keyword in &raw.keywords {
        for unit in stated_units(&keyword.name, &keyword.text) {
            match stated {
                None => stated = Some((keyword, unit)),
                Some((_, first)) if first == unit => {}
                Some((_, first)) => {
                    let kind =
                        ErrorKind::Contradiction { first: first.symbol.to_owned(), second: unit.symbol.to_owned() };
                    return Err(Error::new(Location::line(keyword.line), kind)
                        .with_hint("the file gives two units of radiant intensity; leave the right one"));
                }
            }
        }
        let line = format!("{} {}", keyword.name, keyword.text).to_lowercase();
        let bare = squeeze(&line);
        let spoken = ULTRAVIOLET.iter().any(|w| bare.contains(w)) || words(&line).any(|w| w == "uvc");
        if mention.is_none() && (spoken || is_uv_name(&keyword.name)) {
            mention = Some(keyword);
        }
    }
    if let Some((keyword, unit)) = stated {
        let message = format!(
            "radiometric file: `{}` says that the values are in {}; intensities are in W/sr, fluxes in W",
            excerpt(keyword),
            unit.symbol
        );
        let finding = Finding::info("L025", message).at(Location::line(keyword.line));
        return Ok((Kind::Radiant, unit.watts_per_sr, Some(finding)));
    }
    let finding = mention.map(|keyword| {
        let message = format!(
            "`{}` speaks of ultraviolet or radiometry, but no line gives a unit of intensity; taken as candela",
            excerpt(keyword)
        );
        Finding::warning("L026", message)
            .at(Location::line(keyword.line))
            .hint("a line `[_INTENSITYUNITS] mW/sr` would settle it")
    });
    Ok((Kind::Luminous, 1.0, finding))
}

/// A unit of radiant intensity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Unit {
    pub(super) symbol: &'static str,
    pub(super) watts_per_sr: f64,
}

/// What makers of far-UV lamps use.
pub(super) const MILLIWATTS: Unit = Unit { symbol: "mW/sr", watts_per_sr: 1e-3 };

/// The units that a keyword's line gives the file's intensities.
pub(super) fn stated_units(name: &str, text: &str) -> Vec<Unit> {
    let line = format!("{name} {text}").to_lowercase();
    let bare = squeeze(&line);
    if MEANT.iter().any(|word| bare.contains(word)) { units(&line) } else { Vec::new() }
}

/// The units of radiant intensity in a text of small letters.
fn units(text: &str) -> Vec<Unit> {
    let spread: Vec<&str> = text.split_whitespace().collect();
    let mut text = spread.join(" ").replace(" per ", "/").replace(" /", "/").replace("/ ", "/");
    for (word, symbol) in [("watts/", "w/"), ("watt/", "w/"), ("/steradian", "/sr")] {
        text = text.replace(word, symbol);
    }
    let mut found = Vec::new();
    for (at, _) in text.match_indices("w/sr") {
        let prefix_at = text[..at].rfind(|c: char| !c.is_alphabetic()).map_or(0, |i| i + after(&text, i));
        let (symbol, watts_per_sr) = match &text[prefix_at..at] {
            "" => ("W/sr", 1.0),
            "m" | "milli" => ("mW/sr", 1e-3),
            "u" | "µ" | "μ" | "micro" => ("µW/sr", 1e-6),
            "n" | "nano" => ("nW/sr", 1e-9),
            "k" | "kilo" => ("kW/sr", 1e3),
            _ => continue,
        };
        // `W/sr/nm` and `W/sr·m²` are other quantities.
        let other = |c: char| c.is_alphanumeric() || matches!(c, '/' | '·' | '*' | '^' | '-' | '⁻');
        if !text[at + 4..].starts_with(other) {
            found.push(Unit { symbol, watts_per_sr });
        }
    }
    found
}

/// Bytes of the character at an offset.
fn after(text: &str, at: usize) -> usize {
    text[at..].chars().next().map_or(0, char::len_utf8)
}

fn words(text: &str) -> impl Iterator<Item = &str> {
    text.split(|c: char| !c.is_alphanumeric())
}

fn is_uv_name(name: &str) -> bool {
    name == "_UV" || name.starts_with("_UV_") || name.starts_with("_UVC") || name.ends_with("_UV")
}

fn squeeze(text: &str) -> String {
    let bare: String = text.chars().filter(|c| !c.is_whitespace() && *c != '_').collect();
    // How ordinary lamps are measured.
    bare.replace("spectroradiometric", "")
}

fn excerpt(keyword: &Keyword) -> String {
    let text: String = keyword.text.split_whitespace().collect::<Vec<_>>().join(" ");
    let short: String = text.chars().take(60).collect();
    let more = if short.len() < text.len() { "…" } else { "" };
    if keyword.name.is_empty() { format!("{short}{more}") } else { format!("[{}] {short}{more}", keyword.name) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_in_the_spellings_of_makers() {
        let symbols = |text: &str| units(&text.to_lowercase()).iter().map(|u| u.symbol).collect::<Vec<_>>();
        for (text, expected) in [
            ("Lumens-> mW, lux-> mW/m^2, candela-> mW/sr", vec!["mW/sr"]),
            ("values in mW / sr.", vec!["mW/sr"]),
            ("Milliwatts per steradian", vec!["mW/sr"]),
            ("W/sr", vec!["W/sr"]),
            ("µW/sr or uW/sr", vec!["µW/sr", "µW/sr"]),
            ("mW/sr/nm", vec![]),
            ("lm/W, cd/klm", vec![]),
            ("raw/src", vec![]),
        ] {
            assert_eq!(symbols(text), expected, "{text}");
        }
    }
}
