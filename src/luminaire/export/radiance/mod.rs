//! A light source for Radiance: `.rad` with the opening's surfaces, `.dat` with the intensities, oriented as by ies2rad.
//!
//! The `.dat` file is a table over the azimuth `src_phi` = C and the polar angle `src_theta` = γ of Radiance's `source.cal` (θ
//! from −z, φ from +x towards +y), which Radiance interpolates linearly in both; a rotational lamp has γ alone. It holds W/sr:
//! candela ÷ 179 lm/W, Radiance's efficacy of white light, so that irradiance × 179 is illuminance again. The function of
//! `source.cal` named beside it makes radiance of it by dividing through the area that the surfaces show, so that at a distance the
//! intensity is the lamp's, whatever surfaces stand for its opening:
//!
//! | surfaces | function | divides by |
//! |---|---|---|
//! | polygon or ring, lower and upper side as there is light | `flatcorr` | area · cosine |
//! | box | `boxcorr` | projected area of the box |
//! | sphere | `corr` | π r² |

mod opening;

use super::notes::{AXES, Units, checked_stem, heading, negative, not_carried, other_kind, sampled, type_letter};
use super::table::Table;
use super::{ExportFile, Exported};
use crate::finding::{Checked, Finding};
use crate::luminaire::{Kind, Luminaire, Symmetry, System};
use opening::Surfaces;

/// Radiance's luminous efficacy of white light, lm/W (`WHTEFFICACY` in its `color.h`).
pub const LUMENS_PER_WATT: f64 = 179.0;

/// Writes the scene (`STEM.rad`, which names `STEM.dat`) and the data.
///
/// # Errors
/// [`Error::Name`](super::Error::Name).
pub fn write(luminaire: &Luminaire, stem: &str) -> Exported {
    checked_stem(stem)?;
    let d = &luminaire.distribution;
    let mut findings = not_carried(luminaire, "Radiance", true);
    let table = if d.system() == System::TypeC {
        Table::unfolded(d)
    } else {
        let (table, step) = Table::sampled(d);
        let message = format!(
            "a table of Type {} was sampled at the angles of Type C, every {step}°, which Radiance has",
            type_letter(d.system())
        );
        findings.push(Finding::info("L506", message));
        if let Ok(sampled_table) = table.distribution() {
            findings.push(sampled(luminaire, sampled_table.total_flux(), &format!("every {step}°")));
        }
        table
    }
    .to_the_poles();
    let (surfaces, replaced) = Surfaces::of(luminaire.opening.as_ref(), table.shines(false), table.shines(true));
    findings.extend(replaced.map(|message| Finding::info("L505", message)));
    findings.extend(negative(luminaire));
    findings.extend(other_kind(luminaire));
    let files = vec![
        ExportFile { suffix: ".rad".to_owned(), bytes: scene(luminaire, stem, &surfaces).into_bytes() },
        ExportFile { suffix: ".dat".to_owned(), bytes: data(&table, per_unit(luminaire.kind)).into_bytes() },
    ];
    Ok(Checked { value: files, findings })
}

/// What an intensity is multiplied by in the data.
fn per_unit(kind: Kind) -> f64 {
    if kind == Kind::Luminous { 1.0 / LUMENS_PER_WATT } else { 1.0 }
}

fn scene(luminaire: &Luminaire, stem: &str, surfaces: &Surfaces) -> String {
    let units = Units::of(luminaire.kind);
    // Identifiers are words of plain characters.
    let id: String =
        stem.chars().map(|c| if c.is_ascii_alphanumeric() || "-_.".contains(c) { c } else { '_' }).collect();
    let mut out: String = heading(luminaire, "light source for Radiance").iter().map(|l| format!("# {l}\n")).collect();
    out.push_str(&format!(
        "# {AXES}\n\
         # C = azimuth from +x towards +y, gamma = angle from -z, as ies2rad has them.\n\
         # Dimensions in meters. To place the lamp: !xform -rz 90 -t 0 0 3 \"{stem}.rad\"\n"
    ));
    out.push_str(&match luminaire.kind {
        Kind::Luminous => format!(
            "# The data are W/sr = cd / {LUMENS_PER_WATT} (Radiance's lm/W): irradiance * {LUMENS_PER_WATT} is illuminance in {}.\n",
            units.arriving
        ),
        _ => format!("# The data are {}: irradiance is in {}.\n", units.intensity, units.arriving),
    });
    let (function, arguments) = surfaces.correction();
    let rotational =
        luminaire.distribution.symmetry() == Symmetry::Rotational && luminaire.distribution.system() == System::TypeC;
    let (count, angles) = if rotational { (4, "src_theta") } else { (5, "src_phi src_theta") };
    let numbers: Vec<String> = arguments.iter().map(f64::to_string).collect();
    out.push_str(&format!(
        "\nvoid brightdata {id}_dist\n{count} {function} \"{stem}.dat\" source.cal {angles}\n0\n{} {}\n\
         \n{id}_dist light {id}_light\n0\n0\n3 1 1 1\n",
        numbers.len(),
        numbers.join(" ")
    ));
    out.push_str(&surfaces.to_rad(&id));
    out
}

/// A Radiance data file: number of dimensions, each with its angles, then the values, γ running fastest.
fn data(table: &Table, per_unit: f64) -> String {
    let rotational = table.horizontal_deg.len() == 1;
    let mut out = format!("{}\n", if rotational { 1 } else { 2 });
    if !rotational {
        axis(&mut out, &table.horizontal_deg);
    }
    axis(&mut out, &table.vertical_deg);
    for plane in table.values.chunks(table.vertical_deg.len()) {
        for row in plane.chunks(8) {
            // Radiance keeps 32 bits; these are all their digits.
            let words: Vec<String> = row.iter().map(|v| ((v.max(0.0) * per_unit) as f32).to_string()).collect();
            out.push_str(&words.join("\t"));
            out.push('\n');
        }
    }
    out
}

/// `begin end count` for even steps, else `0 0 count` and the angles.
fn axis(out: &mut String, angles: &[f64]) {
    let (first, last, count) = (angles[0], angles[angles.len() - 1], angles.len());
    let step = (last - first) / (count - 1) as f64;
    if angles.iter().enumerate().all(|(i, a)| (first + step * i as f64 - a).abs() < 1e-9) {
        out.push_str(&format!("{first} {last} {count}\n"));
        return;
    }
    out.push_str(&format!("0 0 {count}\n"));
    for row in angles.chunks(12) {
        out.push_str(&row.iter().map(f64::to_string).collect::<Vec<_>>().join("\t"));
        out.push('\n');
    }
}
