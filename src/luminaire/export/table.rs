//! Tables with all planes: symmetric ones written out, and Types A and B sampled at the angles of Type C.

use crate::luminaire::{Distribution, Error, Symmetry, System};

/// Angles nearer than this are the same.
const SAME_DEG: f64 = 1e-6;
/// Width of the step by which a table ends that does not end in darkness: what 32-bit angles near 180° still tell apart.
const EDGE_DEG: f64 = 1e-3;
/// Coarsest and finest steps of a sampled table.
const STEPS_DEG: (f64, f64) = (1.0, 0.25);

/// Intensities over all planes, plane by plane.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Table {
    pub(super) horizontal_deg: Vec<f64>,
    pub(super) vertical_deg: Vec<f64>,
    pub(super) values: Vec<f64>,
}

impl Table {
    /// The table with its mirrored planes written out: 0° to 360° for Type C (90° to 270° about C90 becomes the same), −H to H
    /// for Types A and B. A rotational table keeps its one plane. Values are those given, and interpolated for C0 alone where
    /// a table about C90 has no plane of 180°.
    pub(super) fn unfolded(d: &Distribution) -> Self {
        let mut planes: Vec<(f64, Option<usize>)> = Vec::new();
        for (i, &a) in d.horizontal_deg().iter().enumerate() {
            let images: &[f64] = match (d.system(), d.symmetry()) {
                (System::TypeC, Symmetry::Quadrant) => &[a, 180.0 - a, 180.0 + a, 360.0 - a],
                (System::TypeC, Symmetry::BilateralC0) => &[a, 360.0 - a],
                (System::TypeC, Symmetry::BilateralC90) if a > 180.0 => &[a, 540.0 - a],
                (System::TypeC, Symmetry::BilateralC90) if a < 180.0 => &[a, 180.0 - a],
                (System::TypeC, Symmetry::BilateralC90) => &[0.0, a, 360.0],
                (_, Symmetry::Quadrant) => &[-a, a],
                _ => &[a],
            };
            planes.extend(images.iter().map(|image| (*image + 0.0, Some(i))));
        }
        if (d.system(), d.symmetry()) == (System::TypeC, Symmetry::BilateralC90) {
            planes.extend([(0.0, None), (360.0, None)]);
        }
        // Of equal angles, the one that has a plane comes first and stays.
        planes.sort_by(|a, b| a.0.total_cmp(&b.0).then(b.1.is_some().cmp(&a.1.is_some())));
        planes.dedup_by(|later, kept| later.0 - kept.0 <= SAME_DEG);
        let rows = d.vertical_deg();
        let mut values = Vec::with_capacity(planes.len() * rows.len());
        for (angle, plane) in &planes {
            match plane {
                Some(i) => values.extend_from_slice(d.plane(*i)),
                None => values.extend(rows.iter().map(|row| d.at(*angle, *row))),
            }
        }
        Self { horizontal_deg: planes.into_iter().map(|p| p.0).collect(), vertical_deg: rows.to_vec(), values }
    }

    /// A table of Type A or B at the angles of Type C, by direction: the planes 0° to 360°, γ 0° to 180°, in steps as fine as
    /// the finest of the table, from 1° down to 0.25°; and the step.
    pub(super) fn sampled(d: &Distribution) -> (Self, f64) {
        let finest = |angles: &[f64]| angles.windows(2).map(|w| w[1] - w[0]).fold(STEPS_DEG.0, f64::min);
        // A whole number of steps in a degree, so that 90° and 180° are among the angles.
        let per_degree = (1.0 / finest(d.horizontal_deg()).min(finest(d.vertical_deg())).max(STEPS_DEG.1)).ceil();
        let steps = |to: f64| (0..=(to * per_degree) as usize).map(|i| i as f64 / per_degree).collect::<Vec<f64>>();
        let (horizontal_deg, mut vertical_deg) = (steps(360.0), steps(180.0));
        // Tables of Types A and B end at the plane across the axis.
        let across = vertical_deg.partition_point(|g| *g <= 90.0);
        vertical_deg.insert(across, 90.0 + EDGE_DEG);
        let mut values = Vec::with_capacity(horizontal_deg.len() * vertical_deg.len());
        for c in &horizontal_deg {
            let (sin_c, cos_c) = c.to_radians().sin_cos();
            for g in &vertical_deg {
                let (sin_g, cos_g) = g.to_radians().sin_cos();
                // Of the quadrant's rounding nothing is left: 90° is in front.
                let forward = if *g == 90.0 { 0.0 } else { cos_g };
                values.push(d.towards(glam::DVec3::new(sin_g * cos_c, sin_g * sin_c, -forward)));
            }
        }
        (Self { horizontal_deg, vertical_deg, values }, 1.0 / per_degree)
    }

    /// The same table over γ from 0° to 180°, dark where it had no rows; it falls to darkness within a thousandth of a degree.
    pub(super) fn to_the_poles(&self) -> Self {
        let rows = &self.vertical_deg;
        let (first, last) = (rows[0], rows[rows.len() - 1]);
        let mut before = Vec::new();
        if first > EDGE_DEG {
            before.extend([0.0, first - EDGE_DEG]);
        } else if first > 0.0 {
            before.push(0.0);
        }
        let mut after = Vec::new();
        if last < 180.0 - EDGE_DEG {
            after.extend([last + EDGE_DEG, 180.0]);
        } else if last < 180.0 {
            after.push(180.0);
        }
        let mut values = Vec::new();
        for plane in self.values.chunks(rows.len()) {
            values.extend(std::iter::repeat_n(0.0, before.len()));
            values.extend_from_slice(plane);
            values.extend(std::iter::repeat_n(0.0, after.len()));
        }
        let vertical_deg = [before.as_slice(), rows, &after].concat();
        Self { horizontal_deg: self.horizontal_deg.clone(), vertical_deg, values }
    }

    /// Whether there is light below or above the horizon, by the interpolated values; the step of an end does not count.
    pub(super) fn shines(&self, above: bool) -> bool {
        let count = self.vertical_deg.len();
        let counts =
            |low: f64, high: f64| if above { high > 90.0 + 2.0 * EDGE_DEG } else { low < 90.0 - 2.0 * EDGE_DEG };
        (0..count - 1).filter(|j| counts(self.vertical_deg[*j], self.vertical_deg[j + 1])).any(|j| {
            let rows = self.values.chunks(count).map(|plane| &plane[j..=j + 1]);
            rows.flatten().any(|v| *v > 0.0)
        })
    }

    /// The table as a distribution of Type C.
    pub(super) fn distribution(&self) -> Result<Distribution, Error> {
        let symmetry = if self.horizontal_deg.len() == 1 { Symmetry::Rotational } else { Symmetry::None };
        let (horizontal, vertical) = (self.horizontal_deg.clone(), self.vertical_deg.clone());
        Distribution::new(System::TypeC, symmetry, horizontal, vertical, self.values.clone())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table(system: System, symmetry: Symmetry, horizontal: &[f64]) -> Distribution {
        let rows = [0.0, 40.0, 90.0];
        let values = horizontal.iter().flat_map(|h| rows.map(|r| 1.0 + h * r)).collect();
        Distribution::new(system, symmetry, horizontal.to_vec(), rows.to_vec(), values).expect("a table")
    }

    #[test]
    fn planes_written_out_are_those_of_the_symmetry() {
        for (symmetry, planes) in [
            (Symmetry::Quadrant, &[0.0, 22.5, 37.3, 90.0][..]),
            (Symmetry::BilateralC0, &[0.0, 37.3, 180.0]),
            (Symmetry::BilateralC90, &[90.0, 100.1, 180.0, 270.0]),
            (Symmetry::BilateralC90, &[90.0, 100.1, 200.7, 270.0]),
            (Symmetry::None, &[0.0, 100.0, 230.0, 360.0]),
        ] {
            let d = table(System::TypeC, symmetry, planes);
            let all = Table::unfolded(&d);
            assert_eq!((all.horizontal_deg[0], all.horizontal_deg.last()), (0.0, Some(&360.0)), "{symmetry:?}");
            let back = all.distribution().expect("a table");
            assert!((back.total_flux() / d.total_flux() - 1.0).abs() < 1e-14, "{symmetry:?}");
            for c in [0.0, 12.0, 101.0, 179.0, 181.5, 268.0, 333.3] {
                for g in [0.0, 13.0, 71.0, 90.0] {
                    assert!((back.at(c, g) / d.at(c, g) - 1.0).abs() < 1e-13, "{symmetry:?} {c} {g}");
                }
            }
        }
        let b = Table::unfolded(&table(System::TypeB, Symmetry::Quadrant, &[0.0, 30.0]));
        assert_eq!(b.horizontal_deg, [-30.0, 0.0, 30.0]);
        assert_eq!(b.values[..3], b.values[6..]);
    }

    #[test]
    fn a_table_grows_to_the_poles_in_darkness() {
        let d = Distribution::new(System::TypeC, Symmetry::Rotational, vec![0.0], vec![30.0, 60.0], vec![5.0, 7.0]);
        let whole = Table::unfolded(&d.expect("a table")).to_the_poles();
        assert_eq!(whole.vertical_deg, [0.0, 30.0 - EDGE_DEG, 30.0, 60.0, 60.0 + EDGE_DEG, 180.0]);
        assert_eq!(whole.values, [0.0, 0.0, 5.0, 7.0, 0.0, 0.0]);
    }

    #[test]
    fn a_side_shines_if_the_interpolated_light_reaches_it() {
        for (rows, values, below, above) in [
            // Straight lines from darkness at nadir to light at the horizon.
            ([0.0, 90.0, 180.0], [0.0, 5.0, 5.0], true, true),
            ([60.0, 80.0, 90.0], [0.0, 5.0, 5.0], true, false),
            ([90.0, 100.0, 180.0], [5.0, 5.0, 0.0], false, true),
            ([0.0, 90.0, 180.0], [0.0, 0.0, 5.0], false, true),
            ([0.0, 90.0, 180.0], [0.0, 0.0, 0.0], false, false),
        ] {
            let d = Distribution::new(System::TypeC, Symmetry::Rotational, vec![0.0], rows.to_vec(), values.to_vec());
            let table = Table::unfolded(&d.expect("a table")).to_the_poles();
            assert_eq!((table.shines(false), table.shines(true)), (below, above), "{rows:?} {values:?}");
        }
    }
}
