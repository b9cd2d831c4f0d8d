//! Zemax `.bsdf` text: a grid about the mirror direction ([`Specular`]) with the total integrated scatter (TIS) that the
//! instrument's program printed for each angle of incidence.
//!
//! Keywords with a count and their angles (`SampleRotation`, `AngleOfIncidence`, `ScatterAzimuth`, `ScatterRadial`), then per
//! channel `DataBegin`, blocks of `TIS value` and one row per azimuth, `DataEnd`. Lines with `#` are comments.
//!
//! The printed TIS is compared with our integral of the same table, once with the file's numbers as they stand, cut at the last
//! radial angle, and once with measured neighbours going on to the horizon ([`Rim`]): what lies between is what nobody measured. A
//! finding gives the angle that fits worst, a warning where the printed TIS lies more than 2 % outside of the two.

use super::error::{Error, ErrorKind};
use super::text::{Word, decode, lines};
use crate::brdf::table::specular::Rim;
use crate::brdf::table::{Channel, Specular};
use crate::finding::{Checked, Finding};

/// A table and what its file says about it.
#[derive(Debug, Clone, PartialEq)]
pub struct Zemax {
    /// The table.
    pub table: Specular,
    /// TIS as printed, per channel, rotation and angle of incidence (the latter fastest).
    pub printed: Vec<f64>,
}

/// More nodes per axis than instruments give.
const MOST: usize = 100_000;

/// The words of a file without comments, and where it ends.
struct Words<'t> {
    words: std::iter::Peekable<Box<dyn Iterator<Item = Word<'t>> + 't>>,
    last: (u64, u64),
}

impl<'t> Words<'t> {
    fn new(text: &'t str) -> Self {
        let words = lines(text).filter(|l| !l.text.trim_start().starts_with('#')).flat_map(|l| l.words());
        let words: Box<dyn Iterator<Item = Word<'t>>> = Box::new(words);
        Self { words: words.peekable(), last: (1, 1) }
    }

    fn next(&mut self, expected: &str) -> Result<Word<'t>, Error> {
        let word = self.words.next();
        let word =
            word.ok_or_else(|| Error::at(self.last.0, self.last.1, ErrorKind::unexpected("the end", expected)))?;
        self.last = (word.line, word.column + word.text.chars().count() as u64);
        Ok(word)
    }

    fn keyword(&mut self, keyword: &str) -> Result<(), Error> {
        let word = self.next(&format!("`{keyword}`"))?;
        if word.text.eq_ignore_ascii_case(keyword) {
            return Ok(());
        }
        let found = format!("`{}`", word.text.chars().take(40).collect::<String>());
        Err(word.error(ErrorKind::unexpected(found, format!("`{keyword}`"))))
    }

    /// A count and as many angles. Nothing is set aside for them before they are there.
    fn angles(&mut self, what: &str) -> Result<Vec<f64>, Error> {
        let word = self.next(what)?;
        let count = word.count(what)?;
        if !(1..=MOST).contains(&count) {
            return Err(word.error(ErrorKind::unexpected(format!("{count} for {what}"), format!("1 to {MOST}"))));
        }
        (0..count).map(|_| self.next(what)?.number(what)).collect()
    }
}

/// Reads a file of `ScatterType BRDF`.
///
/// # Errors
/// [`Error`] with the place of what is missing or no number.
pub fn parse(bytes: &[u8]) -> Result<Checked<Zemax>, Error> {
    let (text, assumed) = decode(bytes);
    let mut words = Words::new(&text);
    let [mut rotations, mut incidences, mut azimuths, mut radials] = [const { None }; 4];
    let mut channels = Vec::new();
    loop {
        let word = words.next("`ScatterRadial` and the other angles, then `DataBegin`")?;
        match word.text.to_ascii_lowercase().as_str() {
            "samplerotation" => rotations = Some(words.angles("SampleRotation")?),
            "angleofincidence" => incidences = Some(words.angles("AngleOfIncidence")?),
            "scatterazimuth" => azimuths = Some(words.angles("ScatterAzimuth")?),
            "scatterradial" => radials = Some(words.angles("ScatterRadial")?),
            "source" | "symmetry" | "spectralcontent" => drop(words.next("its value")?),
            "scattertype" => {
                let value = words.next("`BRDF`")?;
                if !value.text.eq_ignore_ascii_case("BRDF") {
                    let found = format!("ScatterType {}", value.text.chars().take(40).collect::<String>());
                    return Err(value.error(ErrorKind::unexpected(found, "ScatterType BRDF")));
                }
            }
            "databegin" => break,
            _ => channels.push(Channel::Named(word.text.to_owned())),
        }
    }
    let missing =
        |what: &str| Error::at(words.last.0, words.last.1, ErrorKind::unexpected(format!("no `{what}`"), "one"));
    let incidences = incidences.ok_or_else(|| missing("AngleOfIncidence"))?;
    let azimuths = azimuths.ok_or_else(|| missing("ScatterAzimuth"))?;
    let radials = radials.ok_or_else(|| missing("ScatterRadial"))?;
    let rotations = rotations.unwrap_or_else(|| vec![0.0]);
    channels.truncate(1);
    let (mut planes, mut printed) = (Vec::new(), Vec::new());
    loop {
        let mut plane = Vec::new();
        for _ in 0..rotations.len() * incidences.len() {
            words.keyword("TIS")?;
            printed.push(words.next("the TIS")?.number("the TIS")?);
            for _ in 0..azimuths.len() * radials.len() {
                plane.push(words.next("a value")?.number("a value")?);
            }
        }
        words.keyword("DataEnd")?;
        planes.push(plane);
        if words.words.peek().is_none() {
            break;
        }
        channels.push(Channel::Named(words.next("a channel")?.text.to_owned()));
        words.keyword("DataBegin")?;
    }
    if channels.is_empty() {
        channels.push(Channel::Named("Monochrome".to_owned()));
    }
    let values = (0..planes[0].len()).flat_map(|i| planes.iter().map(move |p| p[i])).collect();
    let table = Specular::new([rotations, incidences, azimuths, radials], channels, values)?;
    let mut findings: Vec<Finding> = assumed.into_iter().collect();
    if let (nodes, missing @ 1..) = table.coverage() {
        let words = format!("{missing} of {nodes} places are zero near or below the horizon and count as missing");
        findings.push(Finding::info("B104", words));
    }
    findings.extend(compare(&table, &printed));
    Ok(Checked { value: Zemax { table, printed }, findings })
}

/// The printed TIS against our integrals, first channel, first rotation.
fn compare(table: &Specular, printed: &[f64]) -> Option<Finding> {
    let at = |(&angle, &tis): (&f64, &f64)| {
        let ours = [Rim::Cut, Rim::Filled].map(|rim| table.scatter(angle, rim)[0]);
        (angle, tis, ours)
    };
    // How far the printed value lies outside of what the two treatments of the rim span.
    let outside = |(_, tis, [cut, whole]): &(f64, f64, [f64; 2])| ((cut - tis).max(tis - whole) / tis).max(0.0);
    let all: Vec<_> = table.incidences_deg().iter().zip(printed).filter(|(_, tis)| **tis > 0.0).map(at).collect();
    let worst = all.iter().max_by(|a, b| outside(a).total_cmp(&outside(b)))?;
    let (angle, tis, [cut, whole]) = *worst;
    let words = format!(
        "the file prints a TIS of {tis:.4} at {angle}°; our integral is {cut:.4} of the numbers as they stand and \
         {whole:.4} with measured neighbours going on to the horizon (the angle that fits worst of {})",
        all.len()
    );
    Some(if outside(worst) > 0.02 { Finding::warning("B103", words) } else { Finding::info("B103", words) })
}
