//! What becomes of a luminaire's other facts.

use super::super::keyword;
use super::super::model::{Body, Luminaire, Shape};
use super::Turn;
use crate::finding::Finding;

/// Angles of whole quarter turns are met this well, degrees.
const QUARTER_DEG: f64 = 1e-9;
/// Extents that differ by less than this share are equal.
const SAME: f64 = 1e-6;

/// Turns the opening and the housing, and drops what held only as the luminaire stood.
pub(super) fn turned(luminaire: &mut Luminaire, turn: &Turn, findings: &mut Vec<Finding>) {
    for (name, body) in [("luminous opening", &mut luminaire.opening), ("housing", &mut luminaire.housing)] {
        let Some(given) = *body else { continue };
        *body = turned_body(&given, turn);
        if body.is_none() {
            let message = format!("the {name} is not known any more: turned like this it is no body along C0 and C90");
            findings.push(Finding::warning("L403", message));
        }
    }
    let heights = luminaire.keywords.iter().position(|(label, _)| label == keyword::HEIGHTS);
    let mut dropped = Vec::new();
    if let Some(at) = heights {
        match turned_heights(&luminaire.keywords[at].1, turn) {
            Some(text) => luminaire.keywords[at].1 = text,
            None => dropped.push(keyword::HEIGHTS),
        }
    }
    if turn.tilt_deg != 0.0 {
        dropped.extend([keyword::DIRECT_RATIOS, keyword::TILT_DEG, keyword::LAMP_TILT]);
    }
    let mut lost = drop_keywords(luminaire, |label| dropped.contains(&label));
    if turn.tilt_deg != 0.0 && luminaire.declared_downward_fraction.take().is_some() {
        lost.push("the downward fraction declared".to_owned());
    }
    said(&lost, findings);
}

/// Takes the spectra by direction out where they are not those of the new table.
pub(super) fn drop_angular_spectra(luminaire: &mut Luminaire, findings: &mut Vec<Finding>) {
    if luminaire.angular_spectra.take().is_some() {
        let message = "the spectra by direction were left out: they are not those of the new table";
        findings.push(Finding::warning("L404", message));
    }
}

/// Takes keywords out; their labels.
pub(super) fn drop_keywords(luminaire: &mut Luminaire, gone: impl Fn(&str) -> bool) -> Vec<String> {
    let mut lost = Vec::new();
    luminaire.keywords.retain(|(label, _)| {
        let drop = gone(label);
        if drop {
            lost.push(label.clone());
        }
        !drop
    });
    lost
}

/// Says in the file-generation code of LM-63-2019 what was done to a table that was measured: the third decimal tells angles
/// interpolated, the one behind it lumens scaled. Codes of files that no laboratory made stay.
pub(super) fn generated(luminaire: &mut Luminaire, interpolated: bool, scaled: bool) {
    let Some((_, text)) = luminaire.keywords.iter_mut().find(|(label, _)| label == keyword::FILE_GENERATION) else {
        return;
    };
    let Ok(code) = text.parse::<f64>() else { return };
    let mut code = (code * 1e5).round() as u64;
    if !code.is_multiple_of(100) {
        return;
    }
    for (done, unit) in [(interpolated, 1000), (scaled, 100)] {
        if done && (code / unit).is_multiple_of(10) {
            code += unit;
        }
    }
    *text = format!("{:.5}", code as f64 / 1e5);
}

/// The finding about facts that were left out.
pub(super) fn said(lost: &[String], findings: &mut Vec<Finding>) {
    if !lost.is_empty() {
        let message = format!("left out, for it does not hold any more: {}", lost.join(", "));
        findings.push(Finding::info("L404", message));
    }
}

/// Whole quarter turns about the vertical axis, 0 to 3, where there is no tilt.
fn quarters(turn: &Turn) -> Option<usize> {
    let quarters = turn.about_axis_deg / 90.0;
    let whole = (quarters - quarters.round()).abs() * 90.0 <= QUARTER_DEG && turn.tilt_deg == 0.0;
    whole.then(|| quarters.round().rem_euclid(4.0) as usize)
}

/// A body turned; `None` where the result has no extents along C0, C90 and the vertical.
pub(super) fn turned_body(body: &Body, turn: &Turn) -> Option<Body> {
    let same = |a: f64, b: f64| (a - b).abs() <= SAME * (a + b);
    let round = same(body.length_m, body.width_m);
    match (quarters(turn), body.shape) {
        (_, Shape::Point) => Some(*body),
        (Some(0 | 2), _) => Some(*body),
        (Some(_), shape) => {
            let shape = match shape {
                Shape::CylinderAlongC0 => Shape::CylinderAlongC90,
                Shape::CylinderAlongC90 => Shape::CylinderAlongC0,
                other => other,
            };
            Some(Body { shape, length_m: body.width_m, width_m: body.length_m, height_m: body.height_m })
        }
        (None, Shape::Round) if round && turn.tilt_deg == 0.0 => Some(*body),
        (None, Shape::Sphere) if round && (turn.tilt_deg == 0.0 || same(body.width_m, body.height_m)) => Some(*body),
        _ => None,
    }
}

/// The four heights at C0, C90, C180, C270 after whole quarter turns.
fn turned_heights(text: &str, turn: &Turn) -> Option<String> {
    let mut heights: Vec<&str> = text.split_whitespace().collect();
    let by = quarters(turn)?;
    if heights.len() != 4 {
        return None;
    }
    heights.rotate_right(by);
    Some(heights.join(" "))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quarter_turns_keep_bodies_and_others_only_round_ones() {
        let box_ = Body { shape: Shape::Rectangle, length_m: 1.2, width_m: 0.3, height_m: 0.1 };
        let by = |about_axis_deg: f64, tilt_deg: f64| Turn { about_axis_deg, tilt_deg, tilt_towards_deg: 0.0 };
        assert_eq!(turned_body(&box_, &by(180.0, 0.0)), Some(box_));
        let across = turned_body(&box_, &by(-90.0, 0.0)).expect("a box");
        assert_eq!((across.length_m, across.width_m, across.height_m), (0.3, 1.2, 0.1));
        assert_eq!(turned_body(&box_, &by(45.0, 0.0)), None);
        let tube = Body { shape: Shape::CylinderAlongC0, length_m: 0.1, width_m: 1.5, height_m: 0.1 };
        let across = turned_body(&tube, &by(90.0, 0.0)).expect("a cylinder");
        assert_eq!((across.shape, across.length_m), (Shape::CylinderAlongC90, 1.5));
        let disc = Body { shape: Shape::Round, length_m: 0.2, width_m: 0.2, height_m: 0.0 };
        assert_eq!(turned_body(&disc, &by(45.0, 0.0)), Some(disc));
        assert_eq!(turned_body(&disc, &by(0.0, 10.0)), None);
        // The side at C0 comes to lie at C90.
        assert_eq!(turned_heights("1 2 3 4", &by(90.0, 0.0)).as_deref(), Some("4 1 2 3"));
        assert_eq!(turned_heights("1 2 3 4", &by(30.0, 0.0)), None);
    }

    #[test]
    fn the_file_generation_says_what_was_done() {
        // LM-63-2019, table 2.
        let mut lamp = crate::luminaire::format::ies::read(
            b"IES:LM-63-2019\nTILT=NONE\n1 -1 1 2 1 1 2 0 0 0\n1 1.10000 10\n0 90\n0\n1 0\n",
            crate::luminaire::format::ies::ReadOptions::default(),
        )
        .expect("a file")
        .value;
        let code = |lamp: &Luminaire| lamp.keywords.iter().find(|(l, _)| l == keyword::FILE_GENERATION).cloned();
        for (interpolated, scaled, expected) in
            [(false, true, "1.10100"), (true, false, "1.11100"), (true, true, "1.11100")]
        {
            generated(&mut lamp, interpolated, scaled);
            assert_eq!(code(&lamp).expect("a code").1, expected);
        }
        let at = lamp.keywords.iter().position(|(l, _)| l == keyword::FILE_GENERATION).expect("a code");
        lamp.keywords[at].1 = "1.00010".to_owned();
        generated(&mut lamp, true, true);
        assert_eq!(code(&lamp).expect("a code").1, "1.00010");
    }
}
