//! Images opened to be looked at: with the way to their photopic quantity and XYZ.

use serde_json::{Value, json};

use super::convert::MeaningArgs;
use super::open::{Reading, Watched, open};
use crate::cli::Failure;
use crate::cli::notes::Notes;
use crate::finding::{Checked, Finding, Location};
use crate::image::{Description, Photometric, PlanError, Settings, Source};
use crate::report::envelope::Input;

/// An image ready to be looked at.
pub(super) struct Seen {
    pub source: Watched,
    pub luminance: Option<Photometric>,
    pub xyz: Option<Photometric>,
    /// Why there is no luminance.
    pub without: Option<PlanError>,
    /// What was noticed on opening and planning.
    pub findings: Vec<Finding>,
    /// The files, with checksums where they were asked for.
    pub inputs: Vec<Input>,
    pub path: String,
}

/// How it is opened.
pub(super) struct Look<'a> {
    pub reading: &'a Reading,
    pub meaning: &'a MeaningArgs,
    pub settings: &'a Settings,
    /// Checksums are wanted.
    pub checksums: bool,
}

impl Seen {
    pub(super) fn open(paths: &[String], look: &Look<'_>, notes: &Notes) -> Result<Self, Failure> {
        let opened = open(paths, look.reading)?;
        let path = opened.path.as_str();
        let inputs = if look.checksums { opened.inputs()? } else { Vec::new() };
        let source = Watched { source: opened.source, progress: notes.progress.clone() };
        let mut findings = opened.findings;
        let place = Location::default().in_file(path);
        let image = source.description();
        let (luminance, without) = planned(
            Photometric::luminance(image, look.meaning.efficiency, look.settings),
            path,
            &mut findings,
            &place,
        )?;
        // What was noticed is the same for both.
        let (xyz, _) =
            planned(Photometric::xyz(image, look.meaning.observer, look.settings), path, &mut Vec::new(), &place)?;
        Ok(Self { source, luminance, xyz, without, findings, inputs, path: opened.path })
    }

    pub(super) fn image(&self) -> &Description {
        self.source.description()
    }

    /// The way to the luminance, where nothing can be done without it.
    pub(super) fn luminance(&self) -> Result<&Photometric, Failure> {
        match (&self.luminance, &self.without) {
            (Some(luminance), _) => Ok(luminance),
            (None, Some(why)) => Err(Failure::Message(format!("{}: {why}", self.path))),
            (None, None) => {
                Err(Failure::Message(format!("{}: found no luminance; expected an image of light", self.path)))
            }
        }
    }

    /// What was noticed, pixels included.
    pub(super) fn noticed(&mut self) -> Vec<Finding> {
        let mut findings = std::mem::take(&mut self.findings);
        findings.extend(self.source.findings());
        findings
    }
}

/// A way, or why there is none; what is wrong with the user's words is an error.
fn planned(
    way: Result<Checked<Photometric>, PlanError>,
    path: &str,
    findings: &mut Vec<Finding>,
    place: &Location,
) -> Result<(Option<Photometric>, Option<PlanError>), Failure> {
    match way {
        Ok(way) => {
            findings.extend(way.findings.into_iter().map(|f| f.at(place.clone())));
            Ok((Some(way.value), None))
        }
        Err(why @ (PlanError::NoBands { .. } | PlanError::Outside { .. } | PlanError::NoIlluminant { .. })) => {
            Ok((None, Some(why)))
        }
        Err(error) => Err(Failure::Message(format!("{path}: {error}"))),
    }
}

/// What decides the photometric figures, for `settings` in JSON.
pub(super) fn settings_json(meaning: &MeaningArgs, settings: &Settings) -> Value {
    json!({
        "quantity": settings.quantity.map(|q| q.word()),
        "unit": settings.unit.as_ref().map(|u| &u.text),
        "illuminant": settings.illuminant.as_ref().map(|(name, _)| name),
        "white_luminance_cd_per_m2": settings.white_luminance,
        "efficiency": meaning.efficiency.to_string(),
        "observer": meaning.observer.to_string(),
        "rule": settings.contract.rule.map(|r| r.word()),
        "range_nm": settings.contract.range_nm.map(|(low, high)| [low, high]),
        "k_m_lm_per_w": settings.efficacy.k_m,
    })
}
