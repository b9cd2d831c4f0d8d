//! Bundle adjustment: the camera and all poses at once, to the least sum of squared distances in pixels.

use glam::{DMat2, DMat3, DVec2, DVec3};
use nalgebra::{DMatrix, DVector};

use super::start::start;
use super::{Calibration, Camera, Intrinsics, PARAMETERS, Pose, View};
use crate::capture::Error;
use crate::geometry::lens::Distortion;
use crate::math::least_squares::{Limits, Linearised, Problem, invert, minimise};

/// Numbers of the camera, which come before the six of each pose.
const OWN: usize = PARAMETERS.len();
/// Numbers of a pose.
const POSE: usize = 6;
/// Views that Zhang's method takes.
const LEAST_VIEWS: usize = 3;

/// The camera that explains the views best, from a closed-form start.
///
/// Standard errors are those of least squares, with the variance of a coordinate from the residuals (2 N − 9 − 6 views degrees of
/// freedom), as OpenCV's `calibrateCameraExtended` gives them.
///
/// # Errors
/// [`Error::Views`] for fewer than three views, fewer than four corners in one, or views that do not tell the focal length.
pub fn calibrate(views: &[View]) -> Result<Calibration, Error> {
    with_lens(views, &[])
}

/// Lens models from the least to the greatest: the numbers of the camera that are held at 0.
const LENSES: [&[usize]; 5] = [&[5, 6, 7, 8], &[6, 7, 8], &[6, 7], &[5, 8], &[8]];

/// The camera with no more lens than the views tell: of k₁ alone, with k₂, with k₂ and k₃, with p₁ and p₂, with k₂ and these, and with all, the
/// one of least N ln(Σr²/N) + k ln N (Schwarz 1978), N coordinates and k free numbers. Where tangential terms say nothing they trade with the
/// principal point, whose standard error grows tenfold. Standard errors of numbers that are held are 0.
///
/// # Errors
/// Those of [`calibrate`].
pub fn calibrate_lean(views: &[View]) -> Result<Calibration, Error> {
    let count = 2.0 * views.iter().map(|v| v.seen.len()).sum::<usize>() as f64;
    let mut best: Option<(f64, Calibration)> = None;
    for held in LENSES.into_iter().chain([[].as_slice()]) {
        let found = with_lens(views, held)?;
        let score = count * (found.rms_px * found.rms_px).ln() - held.len() as f64 * count.ln();
        if best.as_ref().is_none_or(|(least, _)| score < *least) {
            best = Some((score, found));
        }
    }
    best.map(|(_, found)| found).ok_or(Error::Singular { what: "camera" })
}

fn with_lens(views: &[View], held: &[usize]) -> Result<Calibration, Error> {
    if views.len() < LEAST_VIEWS {
        let found = format!("the board in {} view(s)", views.len());
        return Err(Error::Views { found, expected: "three or more, better ten" });
    }
    if let Some(view) = views.iter().find(|v| v.seen.len() < 4 || v.seen.len() != v.board.len()) {
        let found = format!("{} corners in {}", view.seen.len(), view.name);
        return Err(Error::Views { found, expected: "four or more, each with its place on the board" });
    }
    let (intrinsics, poses) = start(views)?;
    let mut x = vec![intrinsics.fx, intrinsics.fy, intrinsics.cx, intrinsics.cy, 0.0, 0.0, 0.0, 0.0, 0.0];
    x.extend(poses.iter().flat_map(|p| p.rotation.to_array().into_iter().chain(p.translation.to_array())));
    let mut high = vec![f64::INFINITY; x.len()];
    held.iter().for_each(|k| high[*k] = 0.0);
    let low: Vec<f64> = high.iter().map(|f| -f).collect();
    let limits = Limits { iterations: 200, step: 1e-12, gain: 1e-16 };
    let found = minimise(&Bundle { views }, &x, &low, &high, &limits);
    let found = found.ok_or(Error::Singular { what: "camera" })?;
    let (camera, poses) = unpack(&found.x);
    let rms = |view: &View, pose: &Pose| {
        let distance = |(p, q): (&DVec2, &DVec2)| camera.project(pose.transform(*p)).distance_squared(*q);
        (view.board.iter().zip(&view.seen).map(distance).sum::<f64>() / view.seen.len() as f64).sqrt()
    };
    let corners: usize = views.iter().map(|v| v.seen.len()).sum();
    let left = (2 * corners).saturating_sub(found.x.len() - held.len()).max(1) as f64;
    let free: Vec<usize> = (0..found.x.len()).filter(|k| !held.contains(k)).collect();
    let inverse = invert(&found.at.normal, &free).matrix;
    let variance = |k: usize| free.iter().position(|f| *f == k).map_or(0.0, |i| inverse[(i, i)]);
    let standard_errors = std::array::from_fn(|k| (variance(k) * found.at.cost / left).sqrt());
    Ok(Calibration {
        camera,
        standard_errors,
        rms_px: (found.at.cost / corners as f64).sqrt(),
        views: views.iter().zip(poses).map(|(v, p)| (p, rms(v, &p))).collect(),
        converged: found.converged,
    })
}

fn unpack(x: &[f64]) -> (Camera, Vec<Pose>) {
    let intrinsics = Intrinsics { fx: x[0], fy: x[1], cx: x[2], cy: x[3] };
    let distortion = Distortion { k1: x[4], k2: x[5], p1: x[6], p2: x[7], k3: x[8] };
    let pose = |p: &[f64]| Pose { rotation: DVec3::from_slice(&p[..3]), translation: DVec3::from_slice(&p[3..]) };
    (Camera { intrinsics, distortion }, x[OWN..].chunks_exact(POSE).map(pose).collect())
}

struct Bundle<'a> {
    views: &'a [View],
}

impl Problem for Bundle<'_> {
    fn cost(&self, x: &[f64]) -> Option<f64> {
        let (camera, poses) = unpack(x);
        let mut cost = 0.0;
        for (view, pose) in self.views.iter().zip(&poses) {
            let matrix = pose.matrix();
            for (p, q) in view.board.iter().zip(&view.seen) {
                let point = matrix * p.extend(0.0) + pose.translation;
                if point.z <= 0.0 {
                    return None;
                }
                cost += camera.project(point).distance_squared(*q);
            }
        }
        cost.is_finite().then_some(cost)
    }

    fn linearise(&self, x: &[f64]) -> Option<Linearised> {
        let (camera, poses) = unpack(x);
        let mut at =
            Linearised { cost: 0.0, normal: DMatrix::zeros(x.len(), x.len()), gradient: DVector::zeros(x.len()) };
        for (n, (view, pose)) in self.views.iter().zip(&poses).enumerate() {
            let matrix = pose.matrix();
            let turning = left_jacobian(pose.rotation);
            let first = OWN + POSE * n;
            let column = |k: usize| if k < OWN { k } else { first + k - OWN };
            for (p, q) in view.board.iter().zip(&view.seen) {
                let turned = matrix * p.extend(0.0);
                let point = turned + pose.translation;
                if point.z <= 0.0 {
                    return None;
                }
                let residual = camera.project(point) - *q;
                let j = derivatives(&camera, point, turned, &turning);
                at.cost += residual.length_squared();
                for (a, da) in j.iter().enumerate() {
                    at.gradient[column(a)] += da.dot(residual);
                    for (b, db) in j.iter().enumerate() {
                        at.normal[(column(a), column(b))] += da.dot(*db);
                    }
                }
            }
        }
        at.cost.is_finite().then_some(at)
    }
}

/// Derivatives of a pixel by the nine numbers of the camera, the rotation vector and the translation.
fn derivatives(camera: &Camera, point: DVec3, turned: DVec3, turning: &DMat3) -> [DVec2; OWN + POSE] {
    let (i, lens) = (&camera.intrinsics, &camera.distortion);
    let ideal = point.truncate() / point.z;
    let distorted = lens.distort(ideal);
    let DVec2 { x, y } = ideal;
    let r2 = ideal.length_squared();
    let focal = DVec2::new(i.fx, i.fy);
    let mut out = [DVec2::ZERO; OWN + POSE];
    out[0] = DVec2::new(distorted.x, 0.0);
    out[1] = DVec2::new(0.0, distorted.y);
    out[2] = DVec2::X;
    out[3] = DVec2::Y;
    out[4] = focal * ideal * r2;
    out[5] = focal * ideal * r2 * r2;
    out[6] = focal * DVec2::new(2.0 * x * y, r2 + 2.0 * y * y);
    out[7] = focal * DVec2::new(r2 + 2.0 * x * x, 2.0 * x * y);
    out[8] = focal * ideal * r2 * r2 * r2;
    let pixel = DMat2::from_diagonal(focal) * lens.jacobian(ideal);
    let by_point = |d: DVec3| pixel * ((d.truncate() - ideal * d.z) / point.z);
    for (k, axis) in DVec3::AXES.into_iter().enumerate() {
        out[OWN + k] = by_point((*turning * axis).cross(turned));
        out[OWN + 3 + k] = by_point(axis);
    }
    out
}

/// How a rotation turns when its vector changes: R(ω + dω) = R(J dω) R(ω) to first order.
fn left_jacobian(rotation: DVec3) -> DMat3 {
    let angle = rotation.length();
    if angle < 1e-8 {
        return DMat3::IDENTITY;
    }
    let axis = rotation / angle;
    let cross = DMat3::from_cols(axis.cross(DVec3::X), axis.cross(DVec3::Y), axis.cross(DVec3::Z));
    let outer = DMat3::from_cols(axis * axis.x, axis * axis.y, axis * axis.z);
    let along = angle.sin() / angle;
    DMat3::IDENTITY * along + cross * ((1.0 - angle.cos()) / angle) + outer * (1.0 - along)
}
