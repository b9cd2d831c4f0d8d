//! From bytes to [`Eulumdat`].

use super::super::error::{Error, ErrorKind};
use super::super::text::{Text, decode};
use super::fields::Fields;
use super::layout::layout;
use super::{Eulumdat, Isym, LampSetLines};
use crate::finding::{Checked, Finding, Location};

/// More planes or γ than this are no table: tenths of a degree of the full turn.
const MOST_ANGLES: u64 = 3601;
/// More sets of lamps than this are none.
const MOST_LAMP_SETS: u64 = 100;
/// Angles nearer than this are the same, °.
pub(super) const SAME_DEG: f64 = 1e-6;

/// How to read.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct ReadOptions {
    /// Repair what can be repaired safely, and list each repair: a conversion factor of 0 is taken as 1, numbers behind the
    /// table are left out, several numbers on a line are read from left to right. Without it such files are refused.
    pub repair: bool,
}

/// Reads a EULUMDAT file as it stands.
///
/// # Errors
/// As [`parse_with`].
pub fn parse(bytes: &[u8]) -> Result<Checked<Eulumdat>, Error> {
    parse_with(bytes, ReadOptions::default())
}

/// Reads a EULUMDAT file with options.
///
/// # Errors
/// [`Error`] with line, field, found and expected where the file is cut off, a number is missing, not finite or out of range,
/// or counts contradict the table.
pub fn parse_with(bytes: &[u8], options: ReadOptions) -> Result<Checked<Eulumdat>, Error> {
    parse_text(&decode(bytes)?, options)
}

/// The same from text.
pub(in super::super) fn parse_text(text: &Text<'_>, options: ReadOptions) -> Result<Checked<Eulumdat>, Error> {
    let mut fields = Fields::new(text, options.repair);
    let company = fields.text("company (line 1)")?;
    let type_indicator = fields.described("Ityp (line 2)")?;
    if type_indicator.fract() != 0.0 || type_indicator.abs() > 99.0 {
        return Err(out_of_range(&fields, type_indicator, "Ityp (line 2)", "0, 1, 2 or 3"));
    }
    let isym = fields.needed("Isym (line 3)")?;
    let symmetry = [Isym::None, Isym::Vertical, Isym::C0C180, Isym::C90C270, Isym::Both]
        .into_iter()
        .find(|s| f64::from(s.number()) == isym)
        .ok_or_else(|| out_of_range(&fields, isym, "Isym (line 3)", "0, 1, 2, 3 or 4"))?;
    let plane_count = fields.count("Mc, the number of C-planes (line 4)", 1, MOST_ANGLES)?;
    let plane_step_deg = fields.described("Dc, the distance of C-planes (line 5)")?;
    let gamma_count = fields.count("Ng, the number of intensities in a plane (line 6)", 1, MOST_ANGLES)?;
    let gamma_step_deg = fields.described("Dg, the distance of γ (line 7)")?;
    let report_number = fields.text("measurement report number (line 8)")?;
    let luminaire_name = fields.text("luminaire name (line 9)")?;
    let luminaire_number = fields.text("luminaire number (line 10)")?;
    let file_name = fields.text("file name (line 11)")?;
    let date_user = fields.text("date and user (line 12)")?;
    let length_mm = fields.described("length of the luminaire (line 13)")?;
    let width_mm = fields.described("width of the luminaire (line 14)")?;
    let height_mm = fields.described("height of the luminaire (line 15)")?;
    let opening_length_mm = fields.described("length of the luminous area (line 16)")?;
    let opening_width_mm = fields.described("width of the luminous area (line 17)")?;
    let mut opening_heights_mm = [0.0; 4];
    for (i, height) in opening_heights_mm.iter_mut().enumerate() {
        *height = fields.described(&format!("height of the luminous area at C{} (line {})", 90 * i, 18 + i))?;
    }
    let downward_flux_percent = fields.described("DFF, downward flux fraction (line 22)")?;
    let light_output_ratio_percent = fields.described("LORL, light output ratio (line 23)")?;
    let mut conversion_factor = fields.needed("conversion factor (line 24)")?;
    if conversion_factor == 0.0 && options.repair {
        conversion_factor = 1.0;
        let message = "repaired: a conversion factor of 0 was taken as 1";
        fields.findings.push(Finding::warning("L230", message).at(fields.last()));
    }
    if conversion_factor <= 0.0 {
        return Err(out_of_range(&fields, conversion_factor, "conversion factor (line 24)", "a number above 0")
            .with_hint("write 1 where the intensities need no conversion"));
    }
    let tilt_deg = fields.described("tilt (line 25)")?;
    let sets = fields.count("number of sets of lamps (line 26)", 1, MOST_LAMP_SETS)?;
    let lamp_sets = (1..=sets).map(|set| lamp_set(&mut fields, set)).collect::<Result<Vec<_>, _>>()?;
    let mut direct_ratios = [0.0; 10];
    for (ratio, k) in direct_ratios.iter_mut().zip(super::ROOM_INDICES) {
        *ratio = fields.described(&format!("direct ratio for room index {k}"))?;
    }
    let planes_at = fields.here();
    let plane_angles_deg = fields.list("the C-angles (Mc of them)", plane_count)?;
    let gamma_at = fields.here();
    let gamma_angles_deg = fields.list("the γ angles (Ng of them)", gamma_count)?;
    in_range("C-angle", &plane_angles_deg, (-360.0, 360.0), &planes_at)?;
    in_range("γ angle", &gamma_angles_deg, (0.0, 180.0), &gamma_at)?;
    monotonic(&gamma_angles_deg, &gamma_at)?;
    for (field, line, step, angles, whole) in [
        ("Dc", 5, plane_step_deg, &plane_angles_deg, symmetry != Isym::Vertical),
        ("Dg", 7, gamma_step_deg, &gamma_angles_deg, true),
    ] {
        let uneven = angles.windows(2).map(|w| (w[1] - w[0]).abs()).find(|s| (s - step).abs() > 0.011);
        if let Some(other) = uneven.filter(|_| step != 0.0 && whole) {
            let message =
                format!("{field} is {step}°, but the list of angles has a step of {other}°; the list was taken");
            fields.findings.push(Finding::warning("L208", message).at(Location::line(line)));
        }
    }
    let (stored, planes) =
        layout(symmetry, &plane_angles_deg, gamma_count, |enough| fields.numbers_ahead(enough), &planes_at).map(
            |checked| {
                fields.findings.extend(checked.findings);
                checked.value
            },
        )?;
    let intensities_cd_per_klm = fields.list("the intensities", planes * gamma_count)?;
    let over = fields.numbers_ahead(&[0]);
    if over > 0 && options.repair {
        let message = format!("repaired: {over} numbers behind the table were left out");
        fields.findings.push(Finding::warning("L231", message).at(fields.here()));
    } else if over > 0 {
        return Err(Error::new(
            fields.here(),
            ErrorKind::Contradiction {
                first: format!("{} intensities", planes * gamma_count + over),
                second: format!(
                    "Isym {}, Mc {plane_count} and Ng {gamma_count}, which make {}",
                    symmetry.number(),
                    planes * gamma_count
                ),
            },
        )
        .with_hint("correct Isym (line 3), Mc (line 4) or Ng (line 6), or remove the numbers behind the table"));
    }
    let value = Eulumdat {
        company,
        type_indicator: type_indicator as i64,
        symmetry,
        plane_count,
        plane_step_deg,
        gamma_count,
        gamma_step_deg,
        report_number,
        luminaire_name,
        luminaire_number,
        file_name,
        date_user,
        length_mm,
        width_mm,
        height_mm,
        opening_length_mm,
        opening_width_mm,
        opening_heights_mm,
        downward_flux_percent,
        light_output_ratio_percent,
        conversion_factor,
        tilt_deg,
        lamp_sets,
        direct_ratios,
        plane_angles_deg,
        gamma_angles_deg,
        stored,
        intensities_cd_per_klm,
    };
    Ok(Checked { value, findings: fields.finish() })
}

fn lamp_set(fields: &mut Fields<'_>, set: usize) -> Result<LampSetLines, Error> {
    let named = |what: &str| format!("{what} of set {set} of lamps");
    let number = fields.described(&named("number of lamps"))?;
    let lamp_type = fields.text(&named("type of lamps"))?;
    let field = named("luminous flux");
    let flux_lm = fields.needed(&field)?;
    if flux_lm <= 0.0 {
        return Err(out_of_range(fields, flux_lm, &field, "a flux above 0 lm, by which the intensities are scaled")
            .with_hint("absolute photometry is told by a negative number of lamps, with the luminaire's flux here"));
    }
    Ok(LampSetLines {
        number,
        lamp_type,
        flux_lm,
        colour: fields.text(&named("colour"))?,
        rendering: fields.text(&named("colour rendering"))?,
        power_w: fields.optional(&named("power"))?,
    })
}

fn out_of_range(fields: &Fields<'_>, found: f64, field: &str, expected: &str) -> Error {
    let kind =
        ErrorKind::OutOfRange { found: found.to_string(), field: field.to_owned(), expected: expected.to_owned() };
    Error::new(fields.last(), kind)
}

fn in_range(field: &str, angles: &[f64], (low, high): (f64, f64), from: &Location) -> Result<(), Error> {
    match angles.iter().position(|a| *a < low - SAME_DEG || *a > high + SAME_DEG) {
        Some(i) => Err(Error::new(
            from.clone(),
            ErrorKind::OutOfRange {
                found: format!("{}° as angle {} of {}", angles[i], i + 1, angles.len()),
                field: format!("the {field}s"),
                expected: format!("{low}° to {high}°"),
            },
        )
        .with_hint("Mc (line 4) or Ng (line 6) may not fit the lists")),
        None => Ok(()),
    }
}

/// γ has to ascend or to descend strictly.
fn monotonic(angles: &[f64], from: &Location) -> Result<(), Error> {
    let down = angles.len() > 1 && angles[1] < angles[0];
    let wrong = angles.windows(2).position(|w| if down { w[1] >= w[0] } else { w[1] <= w[0] });
    match wrong {
        Some(i) => Err(Error::new(
            from.clone(),
            ErrorKind::OutOfRange {
                found: format!("{}° after {}°", angles[i + 1], angles[i]),
                field: format!("γ angle {} of {}", i + 2, angles.len()),
                expected: "angles that ascend strictly".to_owned(),
            },
        )
        .with_hint("Mc (line 4) or Ng (line 6) may not fit the lists")),
        None => Ok(()),
    }
}
