//! The planes of a table: unfolded to the whole turn, turned about the axis, and folded again where they are symmetric. All of
//! it exact for the bilinear intensity, which is linear between planes: a plane put between two others changes no value.

use super::super::Error;
use super::super::distribution::{Distribution, SAME_DEG, Symmetry, System};

/// Values that differ by less than this share of the peak are equal: the rounding of sines and sums.
const SAME_VALUE: f64 = 1e-12;

/// An angle without the rounding of sums.
pub(super) fn snapped(angle_deg: f64) -> f64 {
    let rounded = (angle_deg * 1e9).round() / 1e9;
    // Also −0.
    if rounded == 0.0 { 0.0 } else { rounded }
}

/// Angles ascending, each once.
pub(super) fn ascending(mut angles: Vec<f64>) -> Vec<f64> {
    angles.sort_by(f64::total_cmp);
    angles.dedup_by(|a, b| (*a - *b).abs() <= SAME_DEG);
    angles
}

/// All planes that a table stands for: 0° to 360° for Type C, both signs of the horizontal angle for Types A and B.
pub(super) fn all_planes(d: &Distribution) -> Vec<f64> {
    let own = d.horizontal_deg();
    let images = |axis: f64, angles: &[f64]| -> Vec<f64> {
        angles.iter().flat_map(|a| [*a, snapped((2.0 * axis - a).rem_euclid(360.0))]).collect()
    };
    match (d.system(), d.symmetry()) {
        (System::TypeC, symmetry) => {
            let mut all = match symmetry {
                Symmetry::Quadrant => images(0.0, &images(90.0, own)),
                Symmetry::BilateralC0 => images(0.0, own),
                Symmetry::BilateralC90 => images(90.0, own),
                Symmetry::Rotational => vec![0.0, 90.0, 180.0, 270.0],
                Symmetry::None => own.to_vec(),
            };
            all.extend([0.0, 360.0]);
            ascending(all)
        }
        (_, Symmetry::Quadrant) => ascending(own.iter().flat_map(|a| [snapped(-a), *a]).collect()),
        _ => own.to_vec(),
    }
}

/// A table of the values that a function has at the angles.
pub(super) fn tabulated(
    (system, symmetry): (System, Symmetry),
    horizontal_deg: Vec<f64>,
    vertical_deg: &[f64],
    value: impl Fn(f64, f64) -> f64,
) -> Result<Distribution, Error> {
    let mut values = Vec::with_capacity(horizontal_deg.len() * vertical_deg.len());
    for h in &horizontal_deg {
        values.extend(vertical_deg.iter().map(|v| value(*h, *v)));
    }
    Distribution::new(system, symmetry, horizontal_deg, vertical_deg.to_vec(), values)
}

/// A Type C table turned about the vertical axis: what was at C is at C + `by_deg`.
pub(super) fn rotated(d: &Distribution, by_deg: f64) -> Result<Distribution, Error> {
    if by_deg.rem_euclid(360.0) == 0.0 {
        return Ok(d.clone());
    }
    folded(&rotated_planes(d, by_deg)?)
}

/// The same without looking for symmetries, so that tables of the same angles keep the same angles.
pub(super) fn rotated_planes(d: &Distribution, by_deg: f64) -> Result<Distribution, Error> {
    if d.symmetry() == Symmetry::Rotational || by_deg.rem_euclid(360.0) == 0.0 {
        return Ok(d.clone());
    }
    let mut planes: Vec<f64> = all_planes(d).iter().map(|c| snapped((c + by_deg).rem_euclid(360.0))).collect();
    planes.extend([0.0, 360.0]);
    let at = |c: f64, g: f64| d.at(snapped(c - by_deg), g);
    let turned = tabulated((System::TypeC, Symmetry::None), ascending(planes), d.vertical_deg(), at)?;
    Ok(turned.with_interpolation(d.interpolation()))
}

/// The images of a C-plane in a symmetry, itself among them.
pub(super) fn images(symmetry: Symmetry, c_deg: f64) -> Vec<f64> {
    let all = match symmetry {
        Symmetry::Quadrant => vec![c_deg, 180.0 - c_deg, 180.0 + c_deg, -c_deg],
        Symmetry::BilateralC0 => vec![c_deg, -c_deg],
        Symmetry::BilateralC90 => vec![c_deg, 180.0 - c_deg],
        Symmetry::None | Symmetry::Rotational => vec![c_deg],
    };
    all.into_iter().map(|c| snapped(c.rem_euclid(360.0))).collect()
}

/// The first and the last plane that a symmetry needs.
pub(super) fn range(symmetry: Symmetry) -> (f64, f64) {
    match symmetry {
        Symmetry::Quadrant => (0.0, 90.0),
        Symmetry::BilateralC0 => (0.0, 180.0),
        Symmetry::BilateralC90 => (90.0, 270.0),
        Symmetry::None | Symmetry::Rotational => (0.0, 360.0),
    }
}

/// The planes of a table and their images in a symmetry, as far as the symmetry needs them.
pub(super) fn symmetric_planes(d: &Distribution, symmetry: Symmetry) -> Vec<f64> {
    let (low, high) = range(symmetry);
    let mut planes: Vec<f64> = all_planes(d).iter().flat_map(|c| images(symmetry, *c)).collect();
    planes.extend([low, high]);
    planes.retain(|c| *c >= low && *c <= high);
    ascending(planes)
}

/// The same intensity with as much symmetry as its values have to rounding.
pub(super) fn folded(d: &Distribution) -> Result<Distribution, Error> {
    if d.symmetry() != Symmetry::None {
        return Ok(d.clone());
    }
    let tolerance = SAME_VALUE * d.values().iter().fold(0.0_f64, |a, v| a.max(v.abs()));
    let same = |a: f64, b: f64| (a - b).abs() <= tolerance;
    let (h, v) = (d.horizontal_deg(), d.vertical_deg());
    let made = if d.system() == System::TypeC {
        let like_first = |plane: usize| d.plane(plane).iter().zip(d.plane(0)).all(|(a, b)| same(*a, *b));
        if (1..h.len()).all(like_first) {
            tabulated((System::TypeC, Symmetry::Rotational), vec![0.0], v, |c, g| d.at(c, g))
        } else {
            let holds = |symmetry: Symmetry| {
                h.iter()
                    .all(|c| images(symmetry, *c).iter().all(|i| v.iter().all(|g| same(d.at(*c, *g), d.at(*i, *g)))))
            };
            let known = [Symmetry::Quadrant, Symmetry::BilateralC0, Symmetry::BilateralC90];
            let Some(symmetry) = known.into_iter().find(|s| holds(*s)) else { return Ok(d.clone()) };
            tabulated((System::TypeC, symmetry), symmetric_planes(d, symmetry), v, |c, g| d.at(c, g))
        }
    } else {
        let mirrored = h.iter().all(|h| v.iter().all(|v| same(d.at(*h, *v), d.at(-h, *v))));
        if !mirrored {
            return Ok(d.clone());
        }
        let half = h.iter().map(|h| h.abs()).chain([0.0]).collect();
        tabulated((d.system(), Symmetry::Quadrant), ascending(half), v, |h, v| d.at(h, v))
    };
    made.map(|table| table.with_interpolation(d.interpolation()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_unfolded_folds_again() {
        let v = [0.0, 40.0, 90.0];
        let f = |c: f64, g: f64| 5.0 + g * c.to_radians().cos().abs();
        for (symmetry, planes) in [
            (Symmetry::Quadrant, vec![0.0, 20.0, 90.0]),
            (Symmetry::BilateralC0, vec![0.0, 20.0, 100.0, 180.0]),
            (Symmetry::BilateralC90, vec![90.0, 100.0, 230.0, 270.0]),
        ] {
            let d = tabulated((System::TypeC, symmetry), planes, &v, f).expect("sound");
            let whole =
                tabulated((System::TypeC, Symmetry::None), all_planes(&d), &v, |c, g| d.at(c, g)).expect("sound");
            assert!((whole.total_flux() / d.total_flux() - 1.0).abs() < 1e-14, "{symmetry:?}");
            let again = folded(&whole).expect("sound");
            assert_eq!(again.symmetry(), symmetry);
            for c in (0..360).step_by(7).map(f64::from) {
                assert!((again.at(c, 33.0) - d.at(c, 33.0)).abs() < 1e-12, "{symmetry:?} C{c}");
            }
        }
    }

    #[test]
    fn a_quarter_turn_exchanges_the_mirrors() {
        // With a plane at C90, which becomes C180 and its own mirror image.
        let planes = vec![0.0, 60.0, 90.0, 180.0];
        let d = tabulated((System::TypeC, Symmetry::BilateralC0), planes, &[0.0, 90.0], |c, g| c + g).expect("sound");
        let quarter = rotated(&d, 90.0).expect("sound");
        let expected = [90.0, 150.0, 180.0, 270.0];
        assert_eq!((quarter.symmetry(), quarter.horizontal_deg()), (Symmetry::BilateralC90, &expected[..]));
        assert_eq!(rotated(&quarter, -90.0).expect("sound"), d);
        // Six planes around the turn, and one more at C0, which closes it at 360°.
        let odd = rotated(&d, 7.0).expect("sound");
        assert_eq!((odd.symmetry(), odd.horizontal_deg().len()), (Symmetry::None, 8));
        assert!((odd.at(67.0, 45.0) - d.at(60.0, 45.0)).abs() < 1e-12);
        assert!((odd.total_flux() / d.total_flux() - 1.0).abs() < 1e-14);
    }
}
