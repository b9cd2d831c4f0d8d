//! The intensity distribution of a luminaire: a table over two angles with exact symmetry, and its value in any direction.

use glam::DVec3;

use super::Error;
use crate::math::interpolate::pchip_slopes;

/// The angles of a table (IES LM-63, LM-75).
///
/// Directions are unit vectors in the luminaire's own frame: −z is the photometric axis (straight down for a ceiling
/// luminaire), +x is C0, +y is C90.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum System {
    /// Vertical angle V is a latitude about the vertical axis, H a longitude: dω = cos V dV dH. Automotive and signal lamps.
    TypeA,
    /// Horizontal angle H is a latitude about the horizontal axis, V a longitude: dω = cos H dH dV. Floodlights.
    TypeB,
    /// γ from the downward axis, C about it: dω = sin γ dγ dC. General lighting.
    TypeC,
}

/// What the planes of a table stand for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Symmetry {
    /// One plane serves all.
    Rotational,
    /// Planes 0°–90°, mirrored about C0–C180 and C90–C270 (Type A, B: the horizontal angle mirrored about 0).
    Quadrant,
    /// Planes 0°–180°, mirrored about C0–C180.
    BilateralC0,
    /// Planes 90°–270°, mirrored about C90–C270.
    BilateralC90,
    /// All planes.
    None,
}

/// What the intensity is between the entries of a table. No file format says; ours to declare.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Interpolation {
    /// Linear in each angle: what the trade's tools do.
    #[default]
    Bilinear,
    /// Monotone cubic (PCHIP, Fritsch & Butland 1984) along the vertical angle of each plane, then across the planes, around the
    /// turn where it closes and mirrored where the symmetry mirrors. Smooth, exact at the entries, never beyond the entries
    /// around it: never negative where they are not.
    MonotoneCubic,
}

impl Interpolation {
    /// Its name in reports and on the command line.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Bilinear => "bilinear",
            Self::MonotoneCubic => "monotone-cubic",
        }
    }
}

/// A table of intensities over two angles.
///
/// Values between entries are interpolated as declared ([`Interpolation::Bilinear`] unless said otherwise); beyond the tabulated
/// vertical angles the intensity is zero.
#[derive(Debug, Clone, PartialEq)]
pub struct Distribution {
    system: System,
    symmetry: Symmetry,
    horizontal_deg: Vec<f64>,
    vertical_deg: Vec<f64>,
    /// Plane by plane: `values[plane * vertical.len() + row]`.
    values: Vec<f64>,
    interpolation: Interpolation,
    /// Slopes of the values along the vertical angle, per degree, as many; none for a bilinear table.
    slopes: Vec<f64>,
}

/// Angles nearer than this are the same: files print degrees to at most four decimals.
pub(super) const SAME_DEG: f64 = 1e-6;

impl Distribution {
    /// A table: `values` plane by plane (row = horizontal angle or C-plane, column = vertical angle or γ).
    ///
    /// Angles in degrees, ascending. The horizontal angles have to span what the symmetry says: one plane for
    /// [`Symmetry::Rotational`]; 0–90, 0–180, 90–270 for the others of Type C; 0–360 without symmetry, the last plane being
    /// the first again (a table that ends before 360° is closed by repeating its first plane).
    ///
    /// # Errors
    /// [`Error::Angles`], [`Error::Count`], [`Error::Value`].
    pub fn new(
        system: System,
        symmetry: Symmetry,
        mut horizontal_deg: Vec<f64>,
        vertical_deg: Vec<f64>,
        mut values: Vec<f64>,
    ) -> Result<Self, Error> {
        let expected = horizontal_deg.len() * vertical_deg.len();
        if values.len() != expected || expected == 0 {
            return Err(Error::Count { found: values.len(), expected });
        }
        if let Some(at) = values.iter().position(|v| !v.is_finite()) {
            return Err(Error::Value { found: values[at] });
        }
        ascending("horizontal", &horizontal_deg)?;
        ascending("vertical", &vertical_deg)?;
        let (low, high) = (vertical_deg[0], vertical_deg[vertical_deg.len() - 1]);
        let allowed = if system == System::TypeC { (0.0, 180.0) } else { (-90.0, 90.0) };
        if low < allowed.0 - SAME_DEG || high > allowed.1 + SAME_DEG {
            return Err(Error::Angles {
                which: "vertical",
                found: (low, high),
                expected: "0°–180° (Type C) or −90°–90° (Types A, B)",
            });
        }
        let last = horizontal_deg[horizontal_deg.len() - 1];
        let span = (horizontal_deg[0], last);
        let near = |a: f64, b: f64| (a - b).abs() <= SAME_DEG;
        let fits = match (system, symmetry) {
            (_, Symmetry::Rotational) => horizontal_deg.len() == 1,
            (System::TypeC, Symmetry::None) => {
                near(span.0, 0.0) && last <= 360.0 + SAME_DEG && horizontal_deg.len() > 1
            }
            (_, Symmetry::None) => span.0 >= -90.0 - SAME_DEG && last <= 90.0 + SAME_DEG && horizontal_deg.len() > 1,
            (_, Symmetry::Quadrant) => {
                near(span.0, 0.0) && last <= 90.0 + SAME_DEG && (system != System::TypeC || near(last, 90.0))
            }
            (System::TypeC, Symmetry::BilateralC0) => near(span.0, 0.0) && near(last, 180.0),
            (System::TypeC, Symmetry::BilateralC90) => near(span.0, 90.0) && near(last, 270.0),
            _ => false,
        };
        if !fits {
            return Err(Error::Angles {
                which: "horizontal",
                found: span,
                expected: "the range that the symmetry asks for",
            });
        }
        if system == System::TypeC && symmetry == Symmetry::None && !near(last, 360.0) {
            horizontal_deg.push(360.0);
            values.extend_from_within(..vertical_deg.len());
        }
        let interpolation = Interpolation::Bilinear;
        Ok(Self { system, symmetry, horizontal_deg, vertical_deg, values, interpolation, slopes: Vec::new() })
    }

    /// The same table, interpolated as said.
    #[must_use]
    pub fn with_interpolation(mut self, interpolation: Interpolation) -> Self {
        self.interpolation = interpolation;
        self.slopes = match interpolation {
            Interpolation::Bilinear => Vec::new(),
            Interpolation::MonotoneCubic => {
                let planes = self.values.chunks_exact(self.vertical_deg.len());
                planes.flat_map(|plane| pchip_slopes(&self.vertical_deg, plane)).collect()
            }
        };
        self
    }

    /// How the table is interpolated.
    #[must_use]
    pub fn interpolation(&self) -> Interpolation {
        self.interpolation
    }

    /// The angles' system.
    #[must_use]
    pub fn system(&self) -> System {
        self.system
    }

    /// What the planes stand for.
    #[must_use]
    pub fn symmetry(&self) -> Symmetry {
        self.symmetry
    }

    /// Horizontal angles (C-planes), degrees.
    #[must_use]
    pub fn horizontal_deg(&self) -> &[f64] {
        &self.horizontal_deg
    }

    /// Vertical angles (γ), degrees.
    #[must_use]
    pub fn vertical_deg(&self) -> &[f64] {
        &self.vertical_deg
    }

    /// All values, plane by plane.
    #[must_use]
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// The values of one plane, by vertical angle.
    #[must_use]
    pub fn plane(&self, index: usize) -> &[f64] {
        let n = self.vertical_deg.len();
        &self.values[index * n..(index + 1) * n]
    }

    /// The same table with each value multiplied by a factor.
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Self {
        let by = |list: &[f64]| list.iter().map(|v| v * factor).collect();
        Self { values: by(&self.values), slopes: by(&self.slopes), ..self.clone() }
    }

    /// The same table with other values, in the order of [`Distribution::values`].
    ///
    /// # Errors
    /// [`Error::Count`], [`Error::Value`].
    pub fn with_values(&self, values: Vec<f64>) -> Result<Self, Error> {
        if values.len() != self.values.len() {
            return Err(Error::Count { found: values.len(), expected: self.values.len() });
        }
        match values.iter().find(|v| !v.is_finite()) {
            Some(found) => Err(Error::Value { found: *found }),
            None => Ok(Self { values, ..self.clone() }.with_interpolation(self.interpolation)),
        }
    }

    /// Whether two tables have the same system, symmetry and angles, and so the same directions in the same order.
    #[must_use]
    pub fn same_angles(&self, other: &Self) -> bool {
        (self.system, self.symmetry) == (other.system, other.symmetry)
            && self.horizontal_deg == other.horizontal_deg
            && self.vertical_deg == other.vertical_deg
    }

    /// Slopes along the vertical angle of one plane, per degree, of a table that is interpolated cubically.
    pub(super) fn slopes_along(&self, plane: usize) -> &[f64] {
        let n = self.vertical_deg.len();
        &self.slopes[plane * n..(plane + 1) * n]
    }

    /// The largest value and its native angles (horizontal, vertical), degrees; the first of several equal ones. No
    /// interpolation exceeds the entries.
    #[must_use]
    pub fn peak(&self) -> (f64, f64, f64) {
        let n = self.vertical_deg.len();
        let mut best = 0;
        for (i, v) in self.values.iter().enumerate() {
            if *v > self.values[best] {
                best = i;
            }
        }
        (self.values[best], self.horizontal_deg[best / n], self.vertical_deg[best % n])
    }

    /// The value at native angles in degrees: for Type C any C and γ of 0–180, for Types A and B angles of −90–90.
    #[must_use]
    pub fn at(&self, horizontal_deg: f64, vertical_deg: f64) -> f64 {
        let vertical = &self.vertical_deg;
        if vertical_deg < vertical[0] - SAME_DEG || vertical_deg > vertical[vertical.len() - 1] + SAME_DEG {
            return 0.0;
        }
        let (row, t) = locate(vertical, vertical_deg);
        if self.interpolation == Interpolation::MonotoneCubic {
            let Some(folded) = self.fold(horizontal_deg) else { return 0.0 };
            return self.cubic(locate(&self.horizontal_deg, folded), (row, t));
        }
        let along = |plane: usize| {
            let values = self.plane(plane);
            values[row] + t * (values[(row + 1).min(values.len() - 1)] - values[row])
        };
        let Some(folded) = self.fold(horizontal_deg) else { return 0.0 };
        let (plane, s) = locate(&self.horizontal_deg, folded);
        let first = along(plane);
        if s == 0.0 { first } else { first + s * (along((plane + 1).min(self.horizontal_deg.len() - 1)) - first) }
    }

    /// The tabulated horizontal angle that stands for any other by symmetry; `None` beyond a Type A or B table.
    fn fold(&self, horizontal_deg: f64) -> Option<f64> {
        if self.symmetry == Symmetry::Rotational {
            return Some(self.horizontal_deg[0]);
        }
        if self.system != System::TypeC {
            let h = if self.symmetry == Symmetry::Quadrant { horizontal_deg.abs() } else { horizontal_deg };
            let (low, high) = (self.horizontal_deg[0], self.horizontal_deg[self.horizontal_deg.len() - 1]);
            return (h >= low - SAME_DEG && h <= high + SAME_DEG).then_some(h);
        }
        let c = horizontal_deg.rem_euclid(360.0);
        Some(match self.symmetry {
            Symmetry::Quadrant => {
                let half = if c > 180.0 { 360.0 - c } else { c };
                if half > 90.0 { 180.0 - half } else { half }
            }
            Symmetry::BilateralC0 => {
                if c > 180.0 {
                    360.0 - c
                } else {
                    c
                }
            }
            Symmetry::BilateralC90 => match c {
                c if c < 90.0 => 180.0 - c,
                c if c > 270.0 => 540.0 - c,
                c => c,
            },
            Symmetry::None | Symmetry::Rotational => c,
        })
    }

    /// The value in a direction (unit vector in the luminaire's frame).
    #[must_use]
    pub fn towards(&self, direction: DVec3) -> f64 {
        let (h, v) = self.angles(direction);
        self.at(h, v)
    }

    /// Native angles in degrees of a direction.
    ///
    /// Types A and B look along the photometric axis −z, with the horizontal angle towards +x and the vertical one towards +y.
    #[must_use]
    pub fn angles(&self, d: DVec3) -> (f64, f64) {
        let (h, v) = match self.system {
            System::TypeC => (d.y.atan2(d.x).rem_euclid(std::f64::consts::TAU), d.x.hypot(d.y).atan2(-d.z)),
            System::TypeA => (d.x.atan2(-d.z), d.y.atan2(d.x.hypot(d.z))),
            System::TypeB => (d.x.atan2(d.y.hypot(d.z)), d.y.atan2(-d.z)),
        };
        (h.to_degrees(), v.to_degrees())
    }

    /// Unit vector of native angles in degrees.
    #[must_use]
    pub fn direction(&self, horizontal_deg: f64, vertical_deg: f64) -> DVec3 {
        let ((sh, ch), (sv, cv)) = (horizontal_deg.to_radians().sin_cos(), vertical_deg.to_radians().sin_cos());
        match self.system {
            System::TypeC => DVec3::new(sv * ch, sv * sh, -cv),
            System::TypeA => DVec3::new(cv * sh, sv, -cv * ch),
            System::TypeB => DVec3::new(sh, ch * sv, -ch * cv),
        }
    }
}

fn ascending(which: &'static str, angles: &[f64]) -> Result<(), Error> {
    match angles.windows(2).find(|w| !(w[1] > w[0] && w[1].is_finite())) {
        Some(w) => Err(Error::Angles { which, found: (w[0], w[1]), expected: "strictly ascending angles" }),
        None if angles.iter().all(|a| a.is_finite()) => Ok(()),
        None => Err(Error::Angles { which, found: (f64::NAN, f64::NAN), expected: "finite angles" }),
    }
}

/// Index and fraction of an angle in an ascending list; clamped to its ends.
pub(super) fn locate(angles: &[f64], at: f64) -> (usize, f64) {
    if angles.len() == 1 || at <= angles[0] {
        return (0, 0.0);
    }
    let i = angles.partition_point(|&a| a <= at).saturating_sub(1).min(angles.len() - 2);
    (i, ((at - angles[i]) / (angles[i + 1] - angles[i])).min(1.0))
}
