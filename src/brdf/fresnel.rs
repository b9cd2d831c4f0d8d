//! Fresnel's reflectance of unpolarised light at an interface, exact for dielectrics and conductors, and Schlick's polynomial.
//!
//! ```text
//! g = √(ñ² − sin²θ),  ñ = n − ik,  c = cosθ
//! r_s = (1 − ñ²)/(c + g)²,   r_p = (ñ² − 1)(c²(ñ² + 1) − 1)/(ñ²c + g)²,   F = (|r_s|² + |r_p|²)/2
//! ```
//!
//! These are the usual (c − g)/(c + g) and (ñ²c − g)/(ñ²c + g), multiplied out so that nothing is subtracted where the two are
//! nearly equal (n near 1, k small). Of √ of a complex number, the part that does not cancel is taken by a square root, the
//! other by division. The error against 50-digit arithmetic is below 1e-14 relative from n = 1 to 1e3, k = 0 to 1e6, θ to
//! 89.9999° (`tests/data/brdf/fresnel.csv`); only next to Brewster's angle, where r_p vanishes, that holds for F and not for r_p.
//!
//! | parameter | range | meaning |
//! |---|---|---|
//! | `medium` | a name of [`medium`](super::medium) | a substance whose n(λ), k(λ) are known |
//! | `eta` | 1 to 1e3, spectral | n, refractive index relative to the medium outside |
//! | `k` | 0 to 1e6, spectral, 0 if not given | extinction coefficient |
//! | `f0` | 0 to 1, spectral | Schlick: reflectance at normal incidence |
//! | `reflectance` | 0 to 1, spectral | the same at every angle |
//!
//! One of `medium`, `eta`, `f0` and `reflectance` is given. Schlick's F = f0 + (1 − f0)(1 − c)⁵ is within a few hundredths
//! for glass, but misses the dip of metals before grazing.
//!
//! References: M. Born & E. Wolf, *Principles of Optics*, 7th ed., §1.5.2 and §14.2; C. Schlick, Comput. Graph. Forum 13 (1994).

use super::parameter::{Arguments, Error, Parameter, same_bands};

/// A substance by name.
pub const MEDIUM: Parameter = Parameter::medium("medium", "a substance whose n and k are known");
/// Refractive index.
pub const ETA: Parameter = Parameter::spectral("eta", 1.0, 1e3, "refractive index relative to outside");
/// Extinction coefficient.
pub const K: Parameter = Parameter::spectral("k", 0.0, 1e6, "extinction coefficient").or(0.0);
/// Reflectance at normal incidence.
pub const F0: Parameter = Parameter::spectral("f0", 0.0, 1.0, "reflectance at normal incidence, after Schlick");
/// The same at every angle.
pub const REFLECTANCE: Parameter = Parameter::spectral("reflectance", 0.0, 1.0, "reflectance at every angle");

/// What becomes of polarised light in one lobe: the shares of power of both components, and of what they have in common.
///
/// With amplitudes r_s, r_p: R_s = |r_s|², R_p = |r_p|² and r_s r_p* (not the mean of anything: of light at 45° it is what stays
/// polarised). The signs are those above, with s = k × n and p = k × s for light that travels along k, before and after.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Components {
    /// Of the component across the plane of incidence.
    pub s: f64,
    /// Of the component in the plane of incidence.
    pub p: f64,
    /// Real part of r_s r_p*.
    pub re: f64,
    /// Imaginary part of r_s r_p*.
    pub im: f64,
}

impl Components {
    /// Of real amplitudes.
    #[must_use]
    pub fn of_amplitudes(s: f64, p: f64) -> Self {
        Self { s: s * s, p: p * p, re: s * p, im: 0.0 }
    }

    /// Of an ideal mirror: both components alike, left and right exchanged.
    #[must_use]
    pub fn of_mirror(reflectance: f64) -> Self {
        Self { s: reflectance, p: reflectance, re: -reflectance, im: 0.0 }
    }

    /// What an interface lets through that absorbs nothing and reflects this.
    #[must_use]
    pub fn transmitted(&self) -> Self {
        Self::of_amplitudes((1.0 - self.s).max(0.0).sqrt(), (1.0 - self.p).max(0.0).sqrt())
    }

    /// The share of unpolarised light.
    #[must_use]
    pub fn mean(&self) -> f64 {
        0.5 * (self.s + self.p)
    }
}

/// Amplitudes of reflection at a dielectric, [r_s, r_p]; `None` under total reflection.
fn amplitudes(cos: f64, eta: f64) -> Option<[f64; 2]> {
    let excess = (eta - 1.0) * (eta + 1.0);
    let g2 = excess + cos * cos;
    if excess == 0.0 {
        return Some([0.0; 2]);
    }
    if g2 <= 0.0 {
        return None;
    }
    let (g, n2) = (g2.sqrt(), eta * eta);
    let s = -excess / ((cos + g) * (cos + g));
    let p = excess * (cos * cos * (n2 + 1.0) - 1.0) / ((n2 * cos + g) * (n2 * cos + g));
    Some([s, p])
}

/// Reflectance of a dielectric of index `eta` > 0 relative to the side of the ray, at the cosine of incidence 0 to 1; 1 under
/// total reflection (`eta` < 1).
#[must_use]
pub fn dielectric(cos: f64, eta: f64) -> f64 {
    amplitudes(cos, eta).map_or(1.0, |[s, p]| (0.5 * (s * s + p * p)).min(1.0))
}

/// The same for polarised light; under total reflection with the difference of phase between the components.
#[must_use]
pub fn dielectric_components(cos: f64, eta: f64) -> Components {
    if let Some([s, p]) = amplitudes(cos, eta) {
        return Components::of_amplitudes(s, p);
    }
    // g = −iγ: r_s = (c + iγ)/(c − iγ), r_p = (n²c + iγ)/(n²c − iγ), and r_s r_p* = z²/|z|² with z = (c + iγ)(n²c − iγ).
    let excess = (eta - 1.0) * (eta + 1.0);
    let gamma = (-excess - cos * cos).max(0.0).sqrt();
    let (a, b) = (eta * eta * cos * cos + gamma * gamma, gamma * cos * excess);
    let length = a * a + b * b;
    if length == 0.0 {
        return Components { s: 1.0, p: 1.0, re: 1.0, im: 0.0 };
    }
    Components { s: 1.0, p: 1.0, re: (a * a - b * b) / length, im: 2.0 * a * b / length }
}

/// What of a conductor's reflectance does not depend on the angle.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Conductor {
    /// Real part of ñ² − 1.
    excess: f64,
    /// Imaginary part of ñ², without its sign.
    imaginary: f64,
    /// |ñ² − 1|².
    contrast: f64,
}

impl Conductor {
    fn new(n: f64, k: f64) -> Self {
        let contrast = ((n - 1.0).powi(2) + k * k) * ((n + 1.0).powi(2) + k * k);
        Self { excess: (n - 1.0) * (n + 1.0) - k * k, imaginary: 2.0 * n * k, contrast }
    }

    fn reflectance(&self, cos: f64) -> f64 {
        self.components(cos).mean().min(1.0)
    }

    fn components(&self, cos: f64) -> Components {
        if self.contrast == 0.0 {
            return Components::default();
        }
        let c2 = cos * cos;
        let t = self.excess + c2;
        let length = (t * t + self.imaginary * self.imaginary).sqrt();
        let large = (0.5 * (length + t.abs())).sqrt();
        // At t = 0 = imaginary part, g is 0.
        let small = if large > 0.0 { 0.5 * self.imaginary / large } else { 0.0 };
        let (a, b) = if t >= 0.0 { (large, small) } else { (small, large) };
        let below_s = (cos + a) * (cos + a) + b * b;
        let s = self.contrast / (below_s * below_s);
        let (re, im) = (c2 * (self.excess + 2.0) - 1.0, c2 * self.imaginary);
        let (below_re, below_im) = ((self.excess + 1.0) * cos + a, self.imaginary * cos + b);
        let below_p = below_re * below_re + below_im * below_im;
        let p = self.contrast * (re * re + im * im) / (below_p * below_p);
        // r_s r_p* = −|ñ² − 1|² (re + i im)/z² with z = (c + g)(ñ²c + g)*; 1/z² = z*²/|z|⁴.
        let (x, y) = ((cos + a) * below_re + b * below_im, (cos + a) * below_im - b * below_re);
        let (z2_re, z2_im) = (x * x - y * y, -2.0 * x * y);
        let scale = -self.contrast / (below_s * below_s * below_p * below_p);
        Components { s, p, re: scale * (re * z2_re - im * z2_im), im: scale * (re * z2_im + im * z2_re) }
    }
}

/// Reflectance of a conductor of index n − ik relative to the side of the ray, at the cosine of incidence 0 to 1; n > 0, k ≥ 0.
#[must_use]
pub fn conductor(cos: f64, n: f64, k: f64) -> f64 {
    Conductor::new(n, k).reflectance(cos)
}

/// Schlick's polynomial.
#[must_use]
pub fn schlick(cos: f64, f0: f64) -> f64 {
    let m = (1.0 - cos).clamp(0.0, 1.0);
    let m2 = m * m;
    f0 + (1.0 - f0) * (m2 * m2 * m)
}

/// An interface, prepared for its bands.
#[derive(Debug, Clone, PartialEq)]
pub struct Fresnel(Kind);

#[derive(Debug, Clone, PartialEq)]
enum Kind {
    Constant(Vec<f64>),
    Dielectric(Vec<f64>),
    Conductor(Vec<Conductor>),
    Schlick(Vec<f64>),
}

impl Fresnel {
    /// The same reflectance (0 to 1) at every angle.
    ///
    /// # Errors
    /// [`Error::Range`].
    pub fn constant(reflectance: Vec<f64>) -> Result<Self, Error> {
        REFLECTANCE.check_all(&reflectance)?;
        Ok(Self(Kind::Constant(reflectance)))
    }

    /// A dielectric of index `eta` (1 to 1e3).
    ///
    /// # Errors
    /// [`Error::Range`].
    pub fn dielectric(eta: Vec<f64>) -> Result<Self, Error> {
        ETA.check_all(&eta)?;
        Ok(Self(Kind::Dielectric(eta)))
    }

    /// A conductor of index `eta` − i`k`; `eta` may be below 1, as it is for silver.
    ///
    /// # Errors
    /// [`Error::Range`], [`Error::Bands`].
    pub fn conductor(eta: &[f64], k: &[f64]) -> Result<Self, Error> {
        K.check_all(k)?;
        same_bands(eta.len(), &[("k", k.len())])?;
        for (n, k) in eta.iter().zip(k) {
            // With absorption n may be anything above zero; without, the outside is taken to be the thinner side.
            if !(n.is_finite() && *n > 0.0 && *n <= ETA.high && (*k > 0.0 || *n >= 1.0)) {
                return Err(Error::Range {
                    name: "eta",
                    value: *n,
                    expected: ETA.expected() + ", or above 0 with k above 0",
                });
            }
        }
        Ok(Self(Kind::Conductor(eta.iter().zip(k).map(|(n, k)| Conductor::new(*n, *k)).collect())))
    }

    /// Schlick's polynomial from `f0` (0 to 1).
    ///
    /// # Errors
    /// [`Error::Range`].
    pub fn schlick(f0: Vec<f64>) -> Result<Self, Error> {
        F0.check_all(&f0)?;
        Ok(Self(Kind::Schlick(f0)))
    }

    /// From the one of `medium`, `eta` (with `k`), `f0` and `reflectance` that was given.
    pub(crate) fn from_arguments(a: &Arguments) -> Result<Self, Error> {
        let given: Vec<&'static str> =
            [MEDIUM, ETA, F0, REFLECTANCE].iter().filter(|p| a.has(p)).map(|p| p.name).collect();
        match given[..] {
            [] => Err(Error::Missing {
                name: "medium",
                expected: "one of medium, eta (with k for a metal), f0, reflectance".to_owned(),
            }),
            [one] if one != ETA.name && a.has(&K) => Err(Error::Conflict { first: one, second: "k" }),
            ["medium"] => {
                let (n, k) = a.medium(&MEDIUM).unwrap_or_default();
                if k.iter().all(|k| *k == 0.0) { Self::dielectric(n) } else { Self::conductor(&n, &k) }
            }
            ["eta"] if a.has(&K) => Self::conductor(&a.spectral(&ETA)?, &a.spectral(&K)?),
            ["eta"] => Self::dielectric(a.spectral(&ETA)?),
            ["f0"] => Self::schlick(a.spectral(&F0)?),
            ["reflectance"] => Self::constant(a.spectral(&REFLECTANCE)?),
            [first, second, ..] => Err(Error::Conflict { first, second }),
            [_] => unreachable!("the four names are matched above"),
        }
    }

    /// The number of bands.
    #[must_use]
    pub fn bands(&self) -> usize {
        match &self.0 {
            Kind::Constant(v) | Kind::Dielectric(v) | Kind::Schlick(v) => v.len(),
            Kind::Conductor(v) => v.len(),
        }
    }

    /// Writes F times `factor` per band, at the cosine of incidence.
    pub fn write(&self, cos: f64, factor: f64, values: &mut [f64]) {
        let cos = cos.clamp(0.0, 1.0);
        match &self.0 {
            Kind::Constant(r) => values.iter_mut().zip(r).for_each(|(v, r)| *v = factor * r),
            Kind::Dielectric(eta) => values.iter_mut().zip(eta).for_each(|(v, n)| *v = factor * dielectric(cos, *n)),
            Kind::Conductor(c) => values.iter_mut().zip(c).for_each(|(v, c)| *v = factor * c.reflectance(cos)),
            Kind::Schlick(f0) => values.iter_mut().zip(f0).for_each(|(v, f)| *v = factor * schlick(cos, *f)),
        }
    }

    /// Writes what polarised light keeps per band, at the cosine of incidence. A reflectance that is only a number or a polynomial
    /// says nothing of polarisation: it is that of an ideal mirror.
    pub fn write_components(&self, cos: f64, values: &mut [Components]) {
        let cos = cos.clamp(0.0, 1.0);
        let each = values.iter_mut();
        match &self.0 {
            Kind::Constant(r) => each.zip(r).for_each(|(v, r)| *v = Components::of_mirror(*r)),
            Kind::Dielectric(eta) => each.zip(eta).for_each(|(v, n)| *v = dielectric_components(cos, *n)),
            Kind::Conductor(c) => each.zip(c).for_each(|(v, c)| *v = c.components(cos)),
            Kind::Schlick(f0) => each.zip(f0).for_each(|(v, f)| *v = Components::of_mirror(schlick(cos, *f))),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn textbook_values() {
        // ((n − 1)/(n + 1))² and its complex form at normal incidence, 1 at grazing incidence.
        assert!((dielectric(1.0, 1.5) - 0.04).abs() < 1e-16);
        assert!((conductor(1.0, 0.2, 3.0) - (0.64 + 9.0) / (1.44 + 9.0)).abs() < 1e-15);
        assert!((dielectric(0.0, 1.5) - 1.0).abs() < 1e-15 && (conductor(0.0, 0.2, 3.0) - 1.0).abs() < 1e-15);
        // Brewster's angle: only r_s is left, ((n² − 1)/(n² + 1))²/2.
        let (n, brewster) = (1.5_f64, 1.5_f64.atan());
        let expected = 0.5 * ((n * n - 1.0) / (n * n + 1.0)).powi(2);
        assert!((dielectric(brewster.cos(), n) - expected).abs() < 1e-15);
        // From inside: total beyond asin(1/n), and Stokes' relation below.
        assert_eq!(dielectric(0.5, 1.0 / 1.5), 1.0);
        let (outside, inside) = (0.6_f64, (1.0 - 0.64 / 2.25_f64).sqrt());
        assert!((dielectric(outside, 1.5) - dielectric(inside, 1.0 / 1.5)).abs() < 1e-15);
        assert_eq!((dielectric(0.0, 1.0), conductor(0.0, 1.0, 0.0)), (0.0, 0.0));
    }

    /// Born & Wolf §1.5.4, eq. (60): tan(δ/2) = cosθ √(sin²θ − n²)/sin²θ, and their example: two total reflections in glass of
    /// n = 1.51 at 54°37′ or 48°37′ delay one component by 45° each (Fresnel's rhomb).
    #[test]
    fn total_reflection_delays_one_component() {
        let n: f64 = 1.0 / 1.51;
        for theta_deg in [45.0_f64, 48.0 + 37.0 / 60.0, 54.0 + 37.0 / 60.0, 75.0, 89.0] {
            let (sin, cos) = theta_deg.to_radians().sin_cos();
            let half = cos * (sin * sin - n * n).sqrt() / (sin * sin);
            let c = dielectric_components(cos, n);
            assert_eq!((c.s, c.p), (1.0, 1.0));
            assert!((c.re.hypot(c.im) - 1.0).abs() < 1e-14);
            assert!((c.im.atan2(c.re).abs() - 2.0 * half.atan()).abs() < 1e-13, "{theta_deg}: {c:?}");
        }
        for minutes in [54.0 * 60.0 + 37.0, 48.0 * 60.0 + 37.0] {
            let c = dielectric_components((minutes / 60.0_f64).to_radians().cos(), n);
            assert!((c.im.atan2(c.re).abs().to_degrees() - 45.0).abs() < 0.02, "{minutes}: {c:?}");
        }
    }

    /// r_s r_p* of a metal against the usual formulas in complex numbers, and continuous with those of glass.
    #[test]
    fn both_components_of_metals_keep_their_phase() {
        let mul = |a: (f64, f64), b: (f64, f64)| (a.0 * b.0 - a.1 * b.1, a.0 * b.1 + a.1 * b.0);
        let div = |a: (f64, f64), b: (f64, f64)| {
            let l = b.0 * b.0 + b.1 * b.1;
            ((a.0 * b.0 + a.1 * b.1) / l, (a.1 * b.0 - a.0 * b.1) / l)
        };
        for (n, k) in [(0.2_f64, 3.0_f64), (1.5, 1e-3), (2.9, 3.0), (1.4, 7.6)] {
            for theta_deg in [0.0_f64, 30.0, 60.0, 80.0, 89.0] {
                let (sin, c) = theta_deg.to_radians().sin_cos();
                let n2 = (n * n - k * k, -2.0 * n * k);
                let (x, y) = (n2.0 - sin * sin, n2.1);
                let length = x.hypot(y);
                let g = ((0.5 * (length + x)).sqrt(), -(0.5 * (length - x)).sqrt());
                let s = div((c - g.0, -g.1), (c + g.0, g.1));
                let p = div((n2.0 * c - g.0, n2.1 * c - g.1), (n2.0 * c + g.0, n2.1 * c + g.1));
                let (re, im) = mul(s, (p.0, -p.1));
                let got = Conductor::new(n, k).components(c);
                assert!((got.re - re).abs() < 1e-12 && (got.im - im).abs() < 1e-12, "{n} {k} {theta_deg}: {got:?}");
                assert!((got.s - s.0 * s.0 - s.1 * s.1).abs() < 1e-12 && (got.p - p.0 * p.0 - p.1 * p.1).abs() < 1e-12);
            }
        }
        for cos in [0.1, 0.5, 0.9] {
            let (metal, glass) = (Conductor::new(1.5, 0.0).components(cos), dielectric_components(cos, 1.5));
            assert!((metal.re - glass.re).abs() < 1e-14 && metal.im.abs() < 1e-14, "{metal:?} {glass:?}");
            let (metal, glass) = (Conductor::new(0.4, 1e-9).components(cos), dielectric_components(cos, 0.4));
            assert!((metal.re - glass.re).abs() < 1e-7 && (metal.im - glass.im).abs() < 1e-7, "{metal:?} {glass:?}");
        }
    }

    #[test]
    fn a_conductor_without_absorption_is_a_dielectric() {
        for cos in [1e-6, 0.1, 0.554_700_196, 0.9, 1.0] {
            for n in [1.0 + 1e-9, 1.5, 1e3] {
                let (a, b) = (dielectric(cos, n), conductor(cos, n, 0.0));
                assert!((a - b).abs() <= 1e-14 * a, "{cos} {n}: {a} {b}");
            }
        }
    }
}
