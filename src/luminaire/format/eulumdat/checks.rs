//! What a file declares, against what its table says.

use super::{Eulumdat, Isym, Stored};
use crate::finding::{Finding, Location};
use crate::luminaire::{Distribution, Symmetry};

/// Findings of this format; those of every format are [`plausible`](super::super::plausible)'s.
pub(super) fn check(file: &Eulumdat, table: &Distribution, set: usize) -> Vec<Finding> {
    let mut out = Vec::new();
    header(file, set, &mut out);
    planes(file, table, &mut out);
    out
}

fn header(file: &Eulumdat, set: usize, out: &mut Vec<Finding>) {
    let ityp = file.type_indicator;
    if !(0..=3).contains(&ityp) {
        let message = format!("Ityp is {ityp}; defined are 1, 2, 3 (and 0)");
        out.push(Finding::info("L211", message).at(Location::line(2)));
    } else if ityp == 1 && file.symmetry != Isym::Vertical && file.stored_plane_count() > 1 {
        let message = format!(
            "Ityp 1 says symmetric about the vertical axis, Isym {} does not; Isym was followed",
            file.symmetry.number()
        );
        out.push(Finding::info("L211", message).at(Location::line(2)));
    }
    let sets = &file.lamp_sets;
    if sets.len() > 1 {
        let others: Vec<String> =
            sets.iter().enumerate().filter(|(i, _)| *i != set).map(|(_, s)| format!("{} lm", s.flux_lm)).collect();
        let message = format!(
            "{} sets of lamps; set {} ({} lm) scales the intensities, the others ({}) are alternatives",
            sets.len(),
            set + 1,
            sets[set].flux_lm,
            others.join(", ")
        );
        out.push(Finding::info("L212", message).at(Location::line(26)));
    }
    if sets[set].number == 0.0 {
        let message = "the number of lamps is 0; their flux was taken as stated";
        out.push(Finding::warning("L218", message).at(Location::line(27 + 6 * set as u64)));
    }
    let percent = file.light_output_ratio_percent;
    if percent > 100.5 {
        let message = format!("the light output ratio LORL is {percent} %; more than 100 % cannot be");
        out.push(Finding::warning("L214", message).at(Location::line(23)));
    }
    if file.conversion_factor != 1.0 {
        let message = format!("the intensities were multiplied by the conversion factor {}", file.conversion_factor);
        out.push(Finding::info("L213", message).at(Location::line(24)));
    }
    let heights = file.opening_heights_mm;
    let lengths =
        [file.length_mm, file.width_mm, file.height_mm, file.opening_length_mm, file.opening_width_mm].into_iter();
    if let Some((i, mm)) = lengths.chain(heights).enumerate().find(|(_, mm)| *mm < 0.0) {
        let message = format!("a dimension of {mm} mm; taken as 0");
        out.push(Finding::warning("L217", message).at(Location::line(13 + i as u64)));
    }
    let larger = |inner: f64, outer: f64| inner > 0.0 && outer > 0.0 && inner > outer + 0.5;
    for (line, inner, outer) in
        [(16, file.opening_length_mm, file.length_mm), (17, file.opening_width_mm, file.width_mm)]
    {
        if larger(inner, outer) {
            let message = format!("the luminous area ({inner} mm) is larger than its luminaire ({outer} mm)");
            out.push(Finding::warning("L217", message).at(Location::line(line)));
        }
    }
    let ratios = &file.direct_ratios;
    let wrong = ratios.iter().find(|r| !(0.0..=1.0).contains(*r)).map(|r| format!("{r} is outside of 0 to 1"));
    let falling = ratios.windows(2).find(|w| w[1] < w[0]).map(|w| format!("{} follows {}", w[1], w[0]));
    if let Some(what) = wrong.or(falling) {
        let message = format!("direct ratios: {what}; expected 0 to 1, rising with the room index");
        out.push(Finding::warning("L215", message).at(Location::line(27 + 6 * sets.len() as u64)));
    }
}

fn planes(file: &Eulumdat, table: &Distribution, out: &mut Vec<Finding>) {
    let gamma = table.vertical_deg();
    if table.symmetry() == Symmetry::None && file.stored == Stored::All {
        let mut gaps: Vec<f64> = table.horizontal_deg().windows(2).map(|w| w[1] - w[0]).collect();
        gaps.sort_by(f64::total_cmp);
        if let [.., next, widest] = gaps[..]
            && widest > 3.0 * next
        {
            let message = format!(
                "a gap of {widest}° between C-planes, where the next widest is {next}°: the file may have a part of its planes only"
            );
            out.push(Finding::warning("L216", message));
        }
    }
    let (first, last) = (gamma[0], gamma[gamma.len() - 1]);
    if (last < 90.0 && last > 0.0) || (first > 0.0 && first < 90.0) {
        let message = format!("γ runs from {first}° to {last}°; zero intensity is assumed beyond");
        out.push(Finding::info("L219", message));
    }
}
