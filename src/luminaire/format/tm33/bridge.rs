//! From [`Tm33`] to the model.

use super::super::error::{Error, ErrorKind};
use super::super::plausible;
use super::{Emitter, IntensityTable, Tm33, planes};
use crate::finding::{Checked, Finding, Location};
use crate::luminaire::{AngularSpectra, Distribution, Kind, LampSet, Luminaire, transform};
use crate::spectrum::Spectrum;

/// More emitters than this are a negative number that went through 32 bits, or nonsense.
const MOST_EMITTERS: f64 = 1e6;

/// Nested elements that are fields of the emitter.
const TAKEN: [&str; 3] = ["ColorTemperature/FixedCCT", "ColorRendering/CIE_CRI/Ra", "ColorRendering/Ra"];

/// Keywords of the model for elements of the header: those of LM-63 where it has the same.
const HEADER: [(&str, &str); 4] =
    [("ReportNumber", "TEST"), ("Laboratory", "TESTLAB"), ("IssueDate", "ISSUEDATE"), ("TestDate", "TESTDATE")];

impl Tm33 {
    /// The luminaire by intensities of one kind: tables of that kind, else the sum over wavelength of angular spectra.
    ///
    /// # Errors
    /// [`ErrorKind::Unexpected`] where no emitter has them; [`ErrorKind::Contradiction`], [`ErrorKind::Table`] where planes and
    /// symmetry do not fit.
    pub fn luminaire(&self, kind: Kind) -> Result<Checked<Luminaire>, Error> {
        let mut findings = Vec::new();
        let tables = self.tables(kind, &mut findings)?;
        let mut parts = Vec::new();
        for table in &tables {
            if table.multiplier != 1.0 {
                let message = format!("the intensities were multiplied by {}", table.multiplier);
                findings.push(Finding::info("L311", message).at(table.location.clone()));
            }
            parts.push(planes::distribution(table, self.goniometer, &mut findings)?);
        }
        let Some(distribution) = transform::sum(&parts).map_err(|error| Error::new(Location::default(), error))? else {
            let kind = ErrorKind::Unexpected {
                found: "no intensity".to_owned(),
                expected: format!("{} in an emitter", kind_words(kind)),
            };
            return Err(Error::new(Location::default(), kind));
        };
        if parts.len() > 1 {
            let message = format!("the intensities of {} emitters were added up", parts.len());
            findings.push(Finding::info("L306", message));
        }
        let stated = tables.iter().find_map(|t| t.absolute);
        let rated = self.emitters.iter().any(|e| e.rated_lumens.is_some_and(|lm| lm > 0.0));
        let absolute = stated.unwrap_or(!rated);
        let watts: f64 = self.emitters.iter().filter_map(|e| e.input_power_w).sum();
        let scale = self.unit(&mut findings);
        let angular_spectra = self.angular_spectra(&mut findings)?;
        let text = |name: &str| self.header(name).unwrap_or_default().to_owned();
        let luminaire = Luminaire {
            name: text("Description"),
            manufacturer: text("Manufacturer"),
            catalogue_number: text("CatalogNumber"),
            kind,
            declared_flux: declared(&tables, &self.emitters, kind),
            distribution,
            absolute,
            lamps: together(self.emitters.iter().map(|e| lamp_set(e, absolute, &mut findings)).collect()),
            input_power_w: (watts > 0.0).then_some(watts),
            declared_output_ratio: None,
            declared_downward_fraction: None,
            opening: self.opening(scale),
            housing: self.housing(scale),
            spectrum: self.spectrum(angular_spectra.as_ref(), &mut findings),
            angular_spectra,
            keywords: self.keywords(),
        };
        self.compare(&luminaire, &mut findings);
        findings.extend(self.not_in_the_model());
        findings.extend(plausible::check(&luminaire));
        Ok(Checked { value: luminaire, findings })
    }

    /// Whether an emitter has intensities of a kind, as a table or in its angular spectra.
    #[must_use]
    pub fn has(&self, kind: Kind) -> bool {
        self.emitters.iter().any(|e| e.angular_spectral.is_some() || e.intensities.iter().any(|t| t.kind == kind))
    }

    fn tables(&self, kind: Kind, findings: &mut Vec<Finding>) -> Result<Vec<IntensityTable>, Error> {
        let mut tables = Vec::new();
        for (i, emitter) in self.emitters.iter().enumerate() {
            let own = emitter.intensities.iter().find(|t| t.kind == kind);
            let summed = emitter.angular_spectral.as_ref().map(|spectral| {
                spectral.summed(kind).map_err(|error| {
                    let kind = ErrorKind::OutOfRange {
                        found: error.to_string(),
                        field: "<AngularSpectral>".to_owned(),
                        expected: "ascending wavelengths".to_owned(),
                    };
                    Error::new(spectral.location.clone(), kind)
                })
            });
            match (own, summed.transpose()?) {
                (Some(own), Some(summed)) => {
                    let total = |t: &IntensityTable| -> Result<f64, Error> {
                        Ok(planes::distribution(t, self.goniometer, &mut Vec::new())?.total_flux())
                    };
                    let (a, b) = (total(own)?, total(&summed)?);
                    if (b / a - 1.0).abs() > 0.05 && own.wavelength_range_nm.is_none() {
                        let message = format!(
                            "the angular spectra of emitter {} make {b:.6}, its {} {a:.6} of flux",
                            i + 1,
                            kind_words(kind)
                        );
                        findings.push(Finding::warning("L314", message).at(summed.location.clone()));
                    }
                    tables.push(own.clone());
                }
                (Some(own), None) => tables.push(own.clone()),
                (None, Some(summed)) => tables.push(summed),
                (None, None) => {
                    let message = format!("emitter {} has no {}; it is not in the sum", i + 1, kind_words(kind));
                    findings.push(Finding::warning("L306", message));
                }
            }
        }
        Ok(tables)
    }

    /// The spectrum of all emitters, if there is one or they can be added up; else the sum of the angular spectra.
    fn spectrum(&self, angular: Option<&AngularSpectra>, findings: &mut Vec<Finding>) -> Option<Spectrum> {
        let spectra: Vec<_> = self.emitters.iter().flat_map(|e| &e.spectra).collect();
        let Some((first, rest)) = spectra.split_first() else { return angular.and_then(|a| a.power().ok()) };
        let first = &first.spectrum;
        if rest.is_empty() && self.emitters.len() == 1 {
            return Some(first.clone());
        }
        let absolute = spectra.iter().all(|s| s.normalized == Some(false));
        let alike = rest.iter().all(|s| s.spectrum.wavelengths_nm() == first.wavelengths_nm());
        if !(rest.is_empty() || absolute && alike) {
            let message = format!(
                "{} spectra that are relative or of different wavelengths cannot be added up; none was taken",
                spectra.len()
            );
            findings.push(Finding::warning("L313", message));
            return None;
        }
        let mut values = vec![0.0; first.values().len()];
        for part in &spectra {
            values.iter_mut().zip(part.spectrum.values()).for_each(|(sum, v)| *sum += v);
        }
        Spectrum::new(first.grid().clone(), values, first.sampling()).ok()
    }

    fn keywords(&self) -> Vec<(String, String)> {
        let mut out: Vec<(String, String)> = Vec::new();
        for (name, text) in self.header.iter().filter(|(_, text)| super::is_known(text)) {
            match name.as_str() {
                "Description" | "Manufacturer" | "CatalogNumber" => {}
                "Comment" | "Comments" => {
                    out.push(labelled(text).unwrap_or_else(|| ("OTHER".to_owned(), text.clone())))
                }
                "ReportDate" if self.header("IssueDate").is_none() => out.push(("ISSUEDATE".to_owned(), text.clone())),
                _ => {
                    let label = HEADER.iter().find(|(own, _)| own == name).map(|(_, label)| (*label).to_owned());
                    out.push((label.unwrap_or_else(|| format!("_{}", name.to_uppercase())), text.clone()));
                }
            }
        }
        out
    }

    /// Emitters rated otherwise whose intensities make 1000 lm: cd per klm that nobody has scaled.
    fn compare(&self, luminaire: &Luminaire, findings: &mut Vec<Finding>) {
        let rated: f64 = self.emitters.iter().filter_map(|e| e.rated_lumens).sum();
        let total = luminaire.distribution.total_flux();
        let whole = |d: &Distribution| (d.total_flux() / 1000.0 - 1.0).abs() < 0.01;
        if luminaire.kind == Kind::Luminous
            && whole(&luminaire.distribution)
            && rated > 0.0
            && (rated / 1000.0 - 1.0).abs() > 0.05
            && luminaire.declared_flux.is_none_or(|f| (f / total - 1.0).abs() > 0.05)
        {
            let message = format!(
                "the intensities integrate to {total:.2} lm, the emitters are rated {rated} lm: they look like cd per 1000 lm; they were taken as cd"
            );
            let hint = "scale the luminaire to its lumens if the file was converted from EULUMDAT";
            findings.push(Finding::warning("L307", message).hint(hint));
        }
    }

    fn not_in_the_model(&self) -> Option<Finding> {
        let mut parts: Vec<String> = Vec::new();
        let mut note = |part: &str| {
            if !parts.iter().any(|p| p == part) {
                parts.push(part.to_owned());
            }
        };
        for (path, _) in
            self.emitters.iter().flat_map(|e| &e.others).filter(|(path, _)| !TAKEN.contains(&path.as_str()))
        {
            note(path.split('/').next().unwrap_or(path));
        }
        // The type is in the angles already.
        if self.equipment.iter().any(|(path, _)| !path.ends_with("/Type") && !path.ends_with("/GoniometerType")) {
            note("Equipment");
        }
        for (name, _) in &self.custom {
            note(&format!("CustomData {name}"));
        }
        (!parts.is_empty()).then(|| Finding::info("L309", format!("the model has no place for: {}", parts.join(", "))))
    }
}

/// The bridge: luminous intensity where there is one, else radiant, photon, else the luminous sum of angular spectra.
impl TryFrom<&Tm33> for Checked<Luminaire> {
    type Error = Error;

    fn try_from(file: &Tm33) -> Result<Self, Error> {
        let given: Vec<Kind> = [Kind::Luminous, Kind::Radiant, Kind::Photon]
            .into_iter()
            .filter(|kind| file.emitters.iter().any(|e| e.intensities.iter().any(|t| t.kind == *kind)))
            .collect();
        let Some(kind) = given.first().copied() else {
            let luminous = file.luminaire(Kind::Luminous)?;
            // Angular spectra of ultraviolet or infrared alone have no luminous sum.
            let dark = luminous.value.distribution.values().iter().all(|v| *v == 0.0);
            return if dark { file.luminaire(Kind::Radiant) } else { Ok(luminous) };
        };
        let mut luminaire = file.luminaire(kind)?;
        if given.len() > 1 {
            let words: Vec<&str> = given.iter().map(|k| kind_words(*k)).collect();
            let message = format!("the file has {}; {} was taken", words.join(", "), words[0]);
            luminaire.findings.push(Finding::info("L312", message));
        }
        Ok(luminaire)
    }
}

fn kind_words(kind: Kind) -> &'static str {
    match kind {
        Kind::Luminous => "luminous intensity",
        Kind::Radiant => "radiant intensity",
        Kind::Photon => "photon intensity",
    }
}

/// `[LABEL] text`, as [`write`](super::write) puts keywords into comments.
fn labelled(text: &str) -> Option<(String, String)> {
    let (label, rest) = text.strip_prefix('[')?.split_once(']')?;
    let sound = !label.is_empty() && label.chars().all(|c| c.is_ascii_alphanumeric() || c == '_' || c == '-');
    sound.then(|| (label.to_owned(), rest.trim().to_owned()))
}

/// The flux that all emitters declare.
fn declared(tables: &[IntensityTable], emitters: &[Emitter], kind: Kind) -> Option<f64> {
    let stated: Option<f64> = tables.iter().map(|t| t.flux).sum();
    let measured: Option<f64> = emitters.iter().map(|e| e.measured_lumens.filter(|lm| *lm > 0.0)).sum();
    stated.filter(|f| *f > 0.0).or(measured.filter(|_| kind == Kind::Luminous))
}

/// The lamps of all emitters, which shine at once, as the one set that the model has for them: numbers, fluxes and powers add up
/// where each is known, texts stand side by side.
fn together(sets: Vec<LampSet>) -> Vec<LampSet> {
    if sets.len() < 2 {
        return sets;
    }
    let joined = |text: fn(&LampSet) -> &str| {
        let mut texts: Vec<&str> = sets.iter().map(text).filter(|t| !t.is_empty()).collect();
        texts.dedup();
        texts.join(" + ")
    };
    vec![LampSet {
        count: sets.iter().map(|s| s.count).sum(),
        name: joined(|s| &s.name),
        flux_lm: sets.iter().map(|s| s.flux_lm).sum(),
        colour: joined(|s| &s.colour),
        rendering: joined(|s| &s.rendering),
        power_w: sets.iter().map(|s| s.power_w).sum(),
    }]
}

fn lamp_set(emitter: &Emitter, absolute: bool, findings: &mut Vec<Finding>) -> LampSet {
    let sound = |q: &f64| (1.0..=MOST_EMITTERS).contains(q);
    if let Some(quantity) = emitter.quantity.filter(|q| !sound(q)) {
        let message = format!("a quantity of {quantity} emitters; taken as not known");
        findings.push(Finding::warning("L308", message));
    }
    let words = |value: Option<f64>| value.filter(|v| *v > 0.0).map(|v| v.to_string()).unwrap_or_default();
    LampSet {
        count: emitter.quantity.filter(sound),
        name: if super::is_known(&emitter.description) { emitter.description.clone() } else { String::new() },
        flux_lm: emitter.rated_lumens.filter(|lm| *lm > 0.0 && !absolute),
        colour: words(emitter.cct_k),
        rendering: words(emitter.ra),
        power_w: emitter.input_power_w.filter(|w| *w > 0.0),
    }
}
