//! From the model to a EULUMDAT file.

use super::super::error::{Error, ErrorKind};
use super::planes::{PlaneSet, plane_set, step};
use crate::finding::{Checked, Finding, Location};
use crate::luminaire::transform::{Resampling, Turn, turn};
use crate::luminaire::{Body, Distribution, Kind, Luminaire, Shape, Symmetry, System, keyword};

/// Characters that a line of text may have.
const LONGEST: usize = 78;
/// Half a unit of the last digit of an intensity, relative to the smaller of peak and mean: flux and peak survive.
const ROUNDING: f64 = 5e-7;
/// Lamps may give this much less than their luminaire: rounding of catalogues and of the table.
const MOST_OUTPUT: f64 = 1.005;

/// A file with CR LF line ends: equidistant planes and γ with their distance, others with 0; all intensities with as many digits
/// that flux and peak change by less than 1e-6; LORL and DFF from the integrated flux. Findings L290 say what is not carried.
///
/// Direct ratios, which follow from a room method and not from the luminaire alone, are written where the model has them from
/// a EULUMDAT file, else as 0. Tables of Types A and B, which the format does not have, are sampled as Type C (finding L401).
///
/// # Errors
/// [`ErrorKind::Unexpected`] for radiant or photon intensity, which the format does not have.
pub fn write(luminaire: &Luminaire) -> Result<Checked<String>, Error> {
    if luminaire.kind != Kind::Luminous {
        let kind = ErrorKind::Unexpected {
            found: "radiant or photon intensity".to_owned(),
            expected: "luminous intensity, the only one that EULUMDAT has".to_owned(),
        };
        return Err(Error::new(Location::default(), kind).with_hint("write TM-33-23, which has all three"));
    }
    let Checked { value: luminaire, findings } =
        turn(luminaire, &Turn::default(), System::TypeC, &Resampling::default())
            .map_err(|error| Error::new(Location::default(), error))?;
    let luminaire = &luminaire;
    let table = &luminaire.distribution;
    let mut file = Writer { lines: Vec::new(), findings };
    let set = plane_set(table);
    if set.added > 0 {
        let message = format!(
            "{} planes were interpolated: Isym 3 asks for the same planes in each quadrant; no value changes",
            set.added
        );
        file.findings.push(Finding::info("L290", message));
    }
    let scaling = file.scaling(luminaire);
    file.identification(luminaire, &set);
    file.bodies(luminaire);
    file.photometry(luminaire, &scaling);
    file.table(table, &set, scaling.flux_lm);
    file.not_carried(luminaire);
    let mut text = file.lines.join("\r\n");
    text.push_str("\r\n");
    Ok(Checked { value: text, findings: file.findings })
}

/// How the intensities are scaled.
struct Scaling {
    absolute: bool,
    /// By which 1000 lm the intensities are divided.
    flux_lm: f64,
}

struct Writer {
    lines: Vec<String>,
    findings: Vec<Finding>,
}

impl Writer {
    fn number(&mut self, value: f64) {
        self.lines.push(digits(value, 6));
    }

    fn text(&mut self, field: &str, value: &str) {
        let line: String = value.split(|c: char| c.is_control()).collect::<Vec<_>>().join(" ");
        let line = line.trim();
        if line.chars().count() > LONGEST {
            let message = format!("{field} was cut to the {LONGEST} characters that the format allows: `{line}`");
            self.findings.push(Finding::info("L290", message));
        }
        self.lines.push(line.chars().take(LONGEST).collect());
    }

    fn scaling(&mut self, luminaire: &Luminaire) -> Scaling {
        let total = luminaire.distribution.total_flux();
        let lamps = luminaire.lamps.first().and_then(|set| set.flux_lm).filter(|flux| *flux > 0.0);
        if let Some(flux_lm) = lamps.filter(|_| !luminaire.absolute) {
            if total <= MOST_OUTPUT * flux_lm {
                return Scaling { absolute: false, flux_lm };
            }
            let message = format!(
                "the lamps' {flux_lm} lm are less than the luminaire's {total:.6} lm; written as absolute photometry"
            );
            self.findings.push(Finding::warning("L290", message));
        }
        let near = |flux: &f64| total > 0.0 && (flux / total - 1.0).abs() <= MOST_OUTPUT - 1.0;
        let flux_lm = match luminaire.declared_flux.filter(near) {
            Some(declared) => declared,
            None if total > 0.0 => significant(total, 6),
            None => 1000.0,
        };
        Scaling { absolute: true, flux_lm }
    }

    fn identification(&mut self, luminaire: &Luminaire, set: &PlaneSet) {
        self.text("the manufacturer", &luminaire.manufacturer);
        let kept = keyword_of(luminaire, keyword::TYPE).and_then(|t| t.parse::<u8>().ok());
        let ityp = match (kept, set.symmetry) {
            (Some(2), _) => 2,
            (Some(1 | 3) | None, super::Isym::Vertical) => 1,
            _ => 3,
        };
        self.number(f64::from(ityp));
        self.number(f64::from(set.symmetry.number()));
        let gamma = luminaire.distribution.vertical_deg();
        self.number(set.angles_deg.len() as f64);
        self.number(step(&set.angles_deg, Some(360.0)));
        if set.symmetry == super::Isym::Vertical {
            // One plane has no distance.
            self.lines.pop();
            self.number(0.0);
        }
        self.number(gamma.len() as f64);
        self.number(step(gamma, None));
        let keyword = |label: &str| keyword_of(luminaire, label).unwrap_or_default().to_owned();
        self.text("the report number", &keyword(keyword::REPORT));
        self.text("the luminaire's name", &luminaire.name);
        self.text("the catalogue number", &luminaire.catalogue_number);
        self.text("the file name", &keyword(keyword::FILE));
        let date = Some(keyword(keyword::DATE_USER)).filter(|t| !t.is_empty()).unwrap_or_else(|| keyword("ISSUEDATE"));
        self.text("the date", &date);
    }

    fn bodies(&mut self, luminaire: &Luminaire) {
        let mut flat = |name: &str, body: Option<Body>| -> [f64; 3] {
            let Some(body) = body else { return [0.0; 3] };
            let mm = |m: f64| (m * 1e6).round() / 1e3;
            let [length, width, height] = [mm(body.length_m), mm(body.width_m), mm(body.height_m)];
            let mut lost = |as_what: &str| {
                let message = format!("{name}: the shape {} was written as {as_what}", body.shape.name());
                self.findings.push(Finding::info("L290", message));
            };
            match body.shape {
                Shape::Point => [0.0; 3],
                Shape::Rectangle => [length, width, height],
                Shape::Round if (length - width).abs() < 1e-3 => [length, 0.0, height],
                Shape::Sphere if (length - width).abs() < 1e-3 => {
                    lost("a circle of its diameter");
                    [length, 0.0, height]
                }
                _ => {
                    lost("the rectangle around it");
                    [length, width, height]
                }
            }
        };
        let opening = flat("luminous opening", luminaire.opening);
        let mut housing = flat("housing", luminaire.housing.or(luminaire.opening));
        let enlarged = [0, 1].map(|i| housing[i] > 0.0 && opening[i] > housing[i] + 0.5);
        for i in [0, 1] {
            if enlarged[i] {
                let message =
                    format!("the housing ({} mm) was enlarged to the luminous opening ({} mm)", housing[i], opening[i]);
                self.findings.push(Finding::info("L290", message));
                housing[i] = opening[i];
            }
        }
        let kept = keyword_of(luminaire, keyword::HEIGHTS).and_then(numbers::<4>);
        let heights =
            kept.filter(|h| (h.iter().sum::<f64>() / 4.0 - opening[2]).abs() < 1e-2).unwrap_or([opening[2]; 4]);
        for value in housing.into_iter().chain([opening[0], opening[1]]).chain(heights) {
            self.number(value);
        }
    }

    fn photometry(&mut self, luminaire: &Luminaire, scaling: &Scaling) {
        let table = &luminaire.distribution;
        let total = table.total_flux();
        let down = if total > 0.0 { table.flux_between(0.0, 90.0) / total } else { 0.0 };
        let output = if scaling.absolute { 1.0 } else { total / scaling.flux_lm };
        for share in [down, output] {
            self.lines.push(digits(100.0 * share.clamp(0.0, 1.0), 3));
        }
        self.number(1.0);
        self.number(keyword_of(luminaire, keyword::TILT_DEG).and_then(|t| t.parse().ok()).unwrap_or(0.0));
        let none = [crate::luminaire::LampSet::default()];
        let sets = if luminaire.lamps.is_empty() { &none[..] } else { &luminaire.lamps[..] };
        let (written, dropped): (Vec<_>, Vec<_>) =
            sets.iter().enumerate().partition(|(i, set)| *i == 0 || set.flux_lm.is_some_and(|flux| flux > 0.0));
        if !dropped.is_empty() {
            let message = format!("{} sets of lamps without flux were left out", dropped.len());
            self.findings.push(Finding::info("L290", message));
        }
        self.number(written.len() as f64);
        for (i, set) in written {
            let count = set.count.filter(|n| *n > 0.0).unwrap_or(1.0);
            self.number(if i == 0 && scaling.absolute { -count } else { count });
            self.text("the type of lamps", &set.name);
            let flux = if i == 0 { scaling.flux_lm } else { set.flux_lm.unwrap_or(0.0) };
            self.lines.push(flux.to_string());
            self.text("the colour", &set.colour);
            self.text("the colour rendering", &set.rendering);
            self.number(set.power_w.or(luminaire.input_power_w.filter(|_| i == 0)).unwrap_or(0.0));
        }
        let kept = keyword_of(luminaire, keyword::DIRECT_RATIOS).and_then(numbers::<10>);
        let sound = |r: &[f64; 10]| r.iter().all(|v| (0.0..=1.0).contains(v)) && r.windows(2).all(|w| w[1] >= w[0]);
        for ratio in kept.filter(sound).unwrap_or_default() {
            self.number(ratio);
        }
    }

    fn table(&mut self, table: &Distribution, set: &PlaneSet, flux_lm: f64) {
        for angle in set.angles_deg.iter().chain(table.vertical_deg()) {
            self.number(*angle);
        }
        let per_klm = 1000.0 / flux_lm;
        let mean = (table.total_flux() / (4.0 * std::f64::consts::PI)).abs();
        let smaller = [table.peak().0.abs(), mean].into_iter().filter(|v| *v > 0.0).fold(f64::INFINITY, f64::min);
        let unit = 2.0 * ROUNDING * smaller * per_klm;
        let decimals = if unit.is_finite() { (-unit.log10()).ceil().clamp(0.0, 17.0) as usize } else { 0 };
        for value in set.rows.iter().flatten() {
            self.lines.push(digits(value * per_klm, decimals));
        }
    }

    fn not_carried(&mut self, luminaire: &Luminaire) {
        if luminaire.spectrum.is_some() {
            let message = "the spectral distribution is not carried: EULUMDAT has no place for it";
            self.findings.push(Finding::warning("L290", message));
        }
        if luminaire.angular_spectra.is_some() {
            let message = "the angular spectra are not carried: EULUMDAT has no place for them";
            self.findings.push(Finding::warning("L290", message).hint("TM-33 can carry them"));
        }
        let carried = [
            keyword::REPORT,
            keyword::FILE,
            keyword::DATE_USER,
            keyword::TYPE,
            keyword::TILT_DEG,
            keyword::HEIGHTS,
            keyword::DIRECT_RATIOS,
        ];
        let lost: Vec<&str> = (luminaire.keywords.iter().map(|(label, _)| label.as_str()))
            .filter(|label| !carried.contains(label))
            .collect();
        if !lost.is_empty() {
            let message = format!("not carried, for want of a place: {}", lost.join(", "));
            self.findings.push(Finding::info("L290", message));
        }
        if luminaire.distribution.symmetry() == Symmetry::Rotational
            && luminaire.distribution.horizontal_deg()[0].abs() > 1e-9
        {
            let message = "the angle of the single plane is not carried; it stands for all";
            self.findings.push(Finding::info("L290", message));
        }
    }
}

fn keyword_of<'l>(luminaire: &'l Luminaire, label: &str) -> Option<&'l str> {
    luminaire.keywords.iter().find(|(key, _)| key == label).map(|(_, value)| value.as_str())
}

/// Exactly N numbers, separated by blanks.
fn numbers<const N: usize>(text: &str) -> Option<[f64; N]> {
    let values: Vec<f64> = text.split_whitespace().map(|t| t.parse().ok()).collect::<Option<_>>()?;
    values.try_into().ok()
}

/// A number with at most so many decimals, without zeros at its end.
fn digits(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    let text = if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

/// Rounded to so many significant digits.
fn significant(value: f64, count: i32) -> f64 {
    let unit = 10f64.powi(count - 1 - value.abs().log10().floor() as i32);
    (value * unit).round() / unit
}
