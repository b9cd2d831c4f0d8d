//! Balls, lights and camera at once: the least sum of squared disagreements, each over its standard error.
//!
//! | observation | residual |
//! |---|---|
//! | a point of an outline | its distance from the ball's silhouette, pixels |
//! | a stated centre | its offset, in thousandths of the radius |
//! | a highlight | the angle between the reflected ray and the light, in turns of the ray per pixel |
//! | shading | the angle between its direction and the light, in its spread |
//! | the stated camera | the relative change of its focal length in hundredths, its turn in hundredths of a radian, its shift in hundredths of the distance to the first ball; only where a stated ball has an outline too |
//!
//! The camera's seven numbers are adjusted where a ball whose place is stated has an outline: without one they are a matter of the frame. One
//! such ball tells three combinations of them, two at most six, more of them all seven; what they do not tell stays as stated, with
//! that uncertainty in the lights, and [`CameraFound`] says how many they tell and which two cannot be told apart.
//!
//! With one mirror ball every light is told by two numbers and nothing can disagree; a second ball, shading or a stated centre makes the sum
//! mean something.

use glam::{DVec2, DVec3};
use nalgebra::{DMatrix, DVector, SymmetricEigen};

use super::angle_deg;
use super::outline::Outline;
use super::view::{Ball, View};
use crate::capture::Error;
use crate::capture::setup::Place;
use crate::geometry::direction::tangents;
use crate::math::least_squares::{Limits, Linearised, Problem, invert, minimise};

/// Standard error of a place that was rounded to pixels.
const ROUNDING_PX: f64 = 0.288_675_134_594_812_9;
/// Of a stated centre, parts of the radius.
const STATED: f64 = 1e-3;
/// Of a stated focal length, relative.
const FOCAL: f64 = 0.01;
/// Of a stated orientation of the camera, rad.
const TURN: f64 = 0.01;
/// Of a stated place of the camera, parts of its distance to the first ball.
const SHIFT: f64 = 0.01;
/// Numbers of the camera: focal length, three turns, three of its place.
const CAMERA: usize = 7;
/// Of an uncertainty as stated, the part that is left of a number that the balls tell.
const TOLD: f64 = 0.5;
/// Points of an outline that are used at most.
const POINTS: usize = 90;

/// A ball as it starts.
#[derive(Debug, Clone, PartialEq)]
pub struct Start {
    /// Where it is thought to be.
    pub ball: Ball,
    /// Its outline in the pictures.
    pub outline: Option<Outline>,
    /// Whether its centre is stated.
    pub stated: bool,
}

/// What tells a light.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Evidence {
    /// The lamp in a mirror ball, pixels.
    Highlight(DVec2),
    /// The direction that shading tells from the middle of a ball, and its standard error, rad.
    Shading(DVec3, f64),
}

/// An observation of a light in a ball.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Observation {
    /// Number of the light.
    pub light: usize,
    /// Number of the ball.
    pub ball: usize,
    /// What was seen.
    pub evidence: Evidence,
}

/// Where everything came to rest.
#[derive(Debug, Clone, PartialEq)]
pub struct Adjusted {
    /// The balls.
    pub balls: Vec<Ball>,
    /// The lights.
    pub lights: Vec<Place>,
    /// Their standard errors seen from the first ball, degrees, for the stated errors of the observations.
    pub errors_deg: Vec<f64>,
    /// The camera, where a stated ball tells of it.
    pub camera: Option<CameraFound>,
    /// Disagreement of each observation with the whole, degrees.
    pub off_deg: Vec<f64>,
    /// The same over its standard error.
    pub off_sigma: Vec<f64>,
    /// √(Σ/degrees of freedom): 1 where the stated errors are right; `None` without a degree of freedom among the lights.
    pub disagreement: Option<f64>,
    /// Whether it came to rest.
    pub converged: bool,
}

/// A camera against how it is stated. Its seven numbers: relative change of the focal lengths; turn about its axes to the right, downwards and
/// forward, rad; shift along these, m.
#[derive(Debug, Clone, PartialEq)]
pub struct CameraFound {
    /// What changed.
    pub moved: [f64; CAMERA],
    /// Standard errors of that.
    pub errors: [f64; CAMERA],
    /// What they were taken as before: those of the statement.
    pub stated: [f64; CAMERA],
    /// How many combinations of the seven the balls tell to better than half of that.
    pub told: usize,
    /// Correlations of the seven.
    pub correlations: [[f64; CAMERA]; CAMERA],
}

struct Network<'a> {
    view: View,
    starts: &'a [Start],
    places: &'a [Place],
    observations: &'a [Observation],
    moves: bool,
}

/// Adjusts all that is told.
///
/// # Errors
/// [`Error::Singular`] where an observation has no meaning, such as a highlight beside its ball, or without a ball.
pub fn adjust(view: View, starts: &[Start], places: &[Place], observations: &[Observation]) -> Result<Adjusted, Error> {
    let wrong = Error::Singular { what: "balls and lights" };
    if starts.is_empty() {
        return Err(wrong);
    }
    let moves = view.camera.is_some() && starts.iter().any(|s| s.stated && s.outline.is_some());
    let network = Network { view, starts, places, observations, moves };
    let start = vec![0.0; network.unknowns()];
    let limits = Limits { iterations: 100, step: 1e-9, gain: 1e-12 };
    let (low, high) = (vec![f64::NEG_INFINITY; start.len()], vec![f64::INFINITY; start.len()]);
    let found = minimise(&network, &start, &low, &high, &limits).ok_or_else(|| wrong.clone())?;
    let (view, balls, lights) = network.unpack(&found.x);
    let all: Vec<usize> = (0..start.len()).collect();
    let inverse = invert(&found.at.normal, &all).matrix;
    let mut residuals = Vec::new();
    network.residuals(&found.x, &mut residuals).ok_or(wrong)?;
    let told = &residuals[residuals.len() - 2 * observations.len()..];
    let off_sigma: Vec<f64> = told.chunks_exact(2).map(|r| r[0].hypot(r[1])).collect();
    let off_deg = observations.iter().zip(&off_sigma).map(|(o, off)| {
        let sigma = network.sigma(o, &view, &balls).unwrap_or(f64::NAN);
        (off * sigma).to_degrees()
    });
    let off_deg = off_deg.collect();
    // Light by light: what one light has to spare tells nothing of another that its observations do not determine.
    let freedom: usize = (places.iter().enumerate())
        .map(|(k, p)| (2 * observations.iter().filter(|o| o.light == k).count()).saturating_sub(network.numbers(p)))
        .sum();
    let square: f64 = told.iter().map(|r| r * r).sum();
    let errors_deg = (0..places.len()).map(|k| network.error_deg(&found.x, &inverse, k)).collect();
    Ok(Adjusted {
        camera: network.camera(&found.x, &inverse),
        balls,
        lights,
        errors_deg,
        off_deg,
        off_sigma,
        disagreement: (freedom > 0).then(|| (square / freedom as f64).sqrt()),
        converged: found.converged,
    })
}

impl Network<'_> {
    /// Numbers of a light: three of a near one, two of a direction.
    fn numbers(&self, place: &Place) -> usize {
        if matches!(place, Place::Near(_)) { 3 } else { 2 }
    }

    fn unknowns(&self) -> usize {
        self.first(self.places.len())
    }

    /// Numbers of the camera at `x`: ln of the focal lengths over those stated, turn, shift over the distance to the first ball.
    fn of_camera(&self, x: &[f64]) -> [f64; CAMERA] {
        let first = 3 * self.starts.len();
        if self.moves { std::array::from_fn(|k| x[first + k]) } else { [0.0; CAMERA] }
    }

    /// Length of a shift of 1, m.
    fn reach(&self) -> f64 {
        self.view.distance(self.starts[0].ball.centre)
    }

    /// What became of the camera.
    fn camera(&self, x: &[f64], inverse: &DMatrix<f64>) -> Option<CameraFound> {
        if !self.moves {
            return None;
        }
        let first = 3 * self.starts.len();
        let covariance = inverse.view((first, first), (CAMERA, CAMERA));
        let unit = |k: usize| if k < 4 { 1.0 } else { self.reach() };
        let x = self.of_camera(x);
        let correlation = |i: usize, j: usize| covariance[(i, j)] / (covariance[(i, i)] * covariance[(j, j)]).sqrt();
        let over_stated = DMatrix::from_fn(CAMERA, CAMERA, |i, j| covariance[(i, j)] / (PRIOR[i] * PRIOR[j]));
        let left = SymmetricEigen::new(over_stated).eigenvalues;
        Some(CameraFound {
            moved: std::array::from_fn(|k| if k == 0 { x[0].exp_m1() } else { x[k] * unit(k) }),
            errors: std::array::from_fn(|k| covariance[(k, k)].sqrt() * unit(k)),
            stated: std::array::from_fn(|k| PRIOR[k] * unit(k)),
            told: left.iter().filter(|v| **v < TOLD * TOLD).count(),
            correlations: std::array::from_fn(|i| std::array::from_fn(|j| correlation(i, j))),
        })
    }

    /// Where the numbers of a light begin.
    fn first(&self, light: usize) -> usize {
        let before: usize = self.places[..light].iter().map(|p| self.numbers(p)).sum();
        3 * self.starts.len() + if self.moves { CAMERA } else { 0 } + before
    }

    /// View, balls and lights at `x`, which is 0 at the start: lengths over the radius of the ball, angles in rad, distances relative.
    fn unpack(&self, x: &[f64]) -> (View, Vec<Ball>, Vec<Place>) {
        let ball = |(s, x): (&Start, &[f64])| {
            let r = s.ball.radius;
            match self.view.camera {
                Some(_) => Ball { centre: s.ball.centre + r * DVec3::from_slice(x), radius: r },
                // Of parallel rays depth has no meaning; the radius does.
                None => Ball { centre: s.ball.centre + r * DVec3::new(x[0], x[1], 0.0), radius: r * (1.0 + x[2]) },
            }
        };
        let balls = self.starts.iter().zip(x.chunks_exact(3)).map(ball).collect();
        let light = |(k, place): (usize, &Place)| {
            let x = &x[self.first(k)..];
            match place {
                Place::Distant(d) => {
                    let d = DVec3::from_array(*d).normalize();
                    let (t, b) = tangents(d);
                    Place::Distant((d + x[0] * t + x[1] * b).normalize().to_array())
                }
                Place::Near(p) => {
                    let p = DVec3::from_array(*p);
                    let away = p - self.starts[0].ball.centre;
                    let (t, b) = tangents(away.normalize());
                    let moved = away.normalize() * x[2] + x[0] * t + x[1] * b;
                    Place::Near((p + away.length() * moved).to_array())
                }
            }
        };
        let [zoom, a, b, c, right, down, forward] = self.of_camera(x);
        let shift = self.reach() * DVec3::new(right, down, forward);
        let view = self.view.moved(zoom.exp(), DVec3::new(a, b, c), shift);
        (view, balls, self.places.iter().enumerate().map(light).collect())
    }

    /// Standard error of an observation as an angle, rad.
    fn sigma(&self, o: &Observation, view: &View, balls: &[Ball]) -> Option<f64> {
        match o.evidence {
            Evidence::Highlight(pixel) => Some(ROUNDING_PX * balls[o.ball].turn_per_pixel(view, pixel)?),
            Evidence::Shading(_, sigma) => Some(sigma),
        }
    }

    /// All residuals, those of the observations last; `None` where one has no meaning.
    fn residuals(&self, x: &[f64], out: &mut Vec<f64>) -> Option<()> {
        let (view, balls, lights) = self.unpack(x);
        out.clear();
        for (start, ball) in self.starts.iter().zip(&balls) {
            if let Some(outline) = &start.outline {
                let step = outline.points.len().div_ceil(POINTS).max(1);
                let sigma = outline.rms.max(ROUNDING_PX);
                for p in outline.points.iter().step_by(step) {
                    out.push(self.off_silhouette(&view, ball, *p)? / sigma);
                }
            }
            if start.stated {
                let off = (ball.centre - start.ball.centre) / (STATED * start.ball.radius);
                out.extend_from_slice(&off.to_array());
            }
        }
        if self.moves {
            out.extend(self.of_camera(x).iter().zip(PRIOR).map(|(x, prior)| x / prior));
        }
        for o in self.observations {
            let ball = &balls[o.ball];
            let (from, seen) = match o.evidence {
                Evidence::Highlight(pixel) => {
                    let ray = ball.reflected(view.ray(pixel)?)?;
                    (ray.origin, ray.towards)
                }
                Evidence::Shading(direction, _) => (ball.centre, direction),
            };
            let expected = towards(&lights[o.light], from);
            let (t, b) = tangents(seen);
            let sigma = self.sigma(o, &view, &balls)?;
            // The angle, split into two: right also for large ones.
            let angle = angle_deg(expected, seen).to_radians();
            let across = DVec2::new(t.dot(expected), b.dot(expected)).normalize_or_zero();
            out.extend_from_slice(&[angle * across.x / sigma, angle * across.y / sigma]);
        }
        out.iter().all(|r| r.is_finite()).then_some(())
    }

    /// Distance of a place in the picture from the silhouette of a ball, pixels.
    fn off_silhouette(&self, view: &View, ball: &Ball, pixel: DVec2) -> Option<f64> {
        let ray = view.ray(pixel)?;
        let to_centre = ball.centre - ray.origin;
        match view.camera {
            None => Some(ray.towards.cross(to_centre).length() - ball.radius),
            Some(camera) => {
                let angle = angle_deg(ray.towards, to_centre).to_radians();
                let half = (ball.radius / to_centre.length()).asin();
                Some((angle - half) * camera.intrinsics.fx)
            }
        }
    }

    /// Standard error of a light's direction from the first ball, degrees.
    fn error_deg(&self, x: &[f64], inverse: &DMatrix<f64>, light: usize) -> f64 {
        let of = |x: &[f64]| {
            let (_, balls, lights) = self.unpack(x);
            towards(&lights[light], balls[0].centre)
        };
        let middle = of(x);
        let (t, b) = tangents(middle);
        let columns: Vec<DVec2> = (0..x.len())
            .map(|k| {
                let mut moved = x.to_vec();
                moved[k] += DIFFERENCE;
                let d = (of(&moved) - middle) / DIFFERENCE;
                DVec2::new(t.dot(d), b.dot(d))
            })
            .collect();
        let mut variance = 0.0;
        for (i, a) in columns.iter().enumerate() {
            for (j, b) in columns.iter().enumerate() {
                variance += inverse[(i, j)] * a.dot(*b);
            }
        }
        // Of the two ways across: the root of their mean.
        (0.5 * variance).sqrt().to_degrees()
    }
}

/// Towards a light from a point, of length 1.
fn towards(place: &Place, from: DVec3) -> DVec3 {
    match place {
        Place::Near(p) => (DVec3::from_array(*p) - from).normalize(),
        Place::Distant(d) => DVec3::from_array(*d).normalize(),
    }
}

/// What the numbers of a stated camera are off by.
const PRIOR: [f64; CAMERA] = [FOCAL, TURN, TURN, TURN, SHIFT, SHIFT, SHIFT];

/// Step of the differences: unknowns are of the order of 1e-3.
const DIFFERENCE: f64 = 1e-6;

impl Problem for Network<'_> {
    fn cost(&self, x: &[f64]) -> Option<f64> {
        let mut residuals = Vec::new();
        self.residuals(x, &mut residuals)?;
        Some(residuals.iter().map(|r| r * r).sum())
    }

    fn linearise(&self, x: &[f64]) -> Option<Linearised> {
        let mut residuals = Vec::new();
        self.residuals(x, &mut residuals)?;
        let (mut moved, mut other) = (x.to_vec(), Vec::new());
        let mut jacobian = DMatrix::zeros(residuals.len(), x.len());
        for k in 0..x.len() {
            let mut column = |h: f64| {
                moved[k] = x[k] + h;
                let sound = self.residuals(&moved, &mut other);
                moved[k] = x[k];
                sound.map(|()| DVector::from_column_slice(&other))
            };
            let ahead = column(DIFFERENCE)?;
            let behind = column(-DIFFERENCE)?;
            jacobian.set_column(k, &((ahead - behind) / (2.0 * DIFFERENCE)));
        }
        let r = DVector::from_vec(residuals);
        Some(Linearised { cost: r.norm_squared(), normal: jacobian.tr_mul(&jacobian), gradient: jacobian.tr_mul(&r) })
    }
}
