//! The closed-form start of a calibration: homographies, focal lengths, poses (Zhang 2000, section 3.1, with the principal point in
//! the middle of what was seen).

use glam::{DMat3, DVec2, DVec3};
use nalgebra::{Matrix2, Matrix3, SMatrix, SymmetricEigen, Vector2};

use super::{Intrinsics, Pose, View};
use crate::capture::Error;

/// Intrinsics without distortion, and a pose per view.
pub(super) fn start(views: &[View]) -> Result<(Intrinsics, Vec<Pose>), Error> {
    let all = || views.iter().flat_map(|v| v.seen.iter().copied());
    let low = all().fold(DVec2::INFINITY, DVec2::min);
    let high = all().fold(DVec2::NEG_INFINITY, DVec2::max);
    let centre = (low + high) / 2.0;
    let homographies: Option<Vec<DMat3>> = views.iter().map(|v| homography(&v.board, &v.seen, centre)).collect();
    let flat = Error::Views { found: "views whose corners lie on a line".to_owned(), expected: "corners of a board" };
    let homographies = homographies.ok_or(flat)?;
    let parallel = Error::Views {
        found: "views that all face the board alike".to_owned(),
        expected: "boards tilted by 20 to 50 degrees in different directions",
    };
    let (fx, fy) = focal_lengths(&homographies).ok_or(parallel)?;
    let poses = homographies.iter().map(|h| pose(h, fx, fy)).collect();
    Ok((Intrinsics { fx, fy, cx: centre.x, cy: centre.y }, poses))
}

/// The homography from the board to pixels less `centre`, by the normalised direct linear transform.
fn homography(board: &[DVec2], seen: &[DVec2], centre: DVec2) -> Option<DMat3> {
    let (a, from) = normalise(board)?;
    let (b, to) = normalise(seen)?;
    let mut normal = SMatrix::<f64, 9, 9>::zeros();
    for (p, q) in from.iter().zip(&to) {
        let rows = [
            [p.x, p.y, 1.0, 0.0, 0.0, 0.0, -q.x * p.x, -q.x * p.y, -q.x],
            [0.0, 0.0, 0.0, p.x, p.y, 1.0, -q.y * p.x, -q.y * p.y, -q.y],
        ];
        for row in rows {
            let row = SMatrix::<f64, 9, 1>::from(row);
            normal += row * row.transpose();
        }
    }
    let eigen = SymmetricEigen::new(normal);
    let least = eigen.eigenvalues.imin();
    let h = eigen.eigenvectors.column(least);
    let h = DMat3::from_cols_array(&[h[0], h[3], h[6], h[1], h[4], h[7], h[2], h[5], h[8]]);
    let whole = DMat3::from_translation(-centre) * b.inverse() * h * a;
    (whole.is_finite() && whole.determinant() != 0.0).then_some(whole)
}

/// A similarity that puts points about 0 at a mean distance of √2, and the points so moved.
fn normalise(points: &[DVec2]) -> Option<(DMat3, Vec<DVec2>)> {
    let count = points.len() as f64;
    let mean = points.iter().sum::<DVec2>() / count;
    let spread = points.iter().map(|p| p.distance(mean)).sum::<f64>() / count;
    (spread > 0.0 && spread.is_finite()).then(|| {
        let scale = std::f64::consts::SQRT_2 / spread;
        let matrix = DMat3::from_scale(DVec2::splat(scale)) * DMat3::from_translation(-mean);
        (matrix, points.iter().map(|p| (*p - mean) * scale).collect())
    })
}

/// From h₁ᵀ B h₂ = 0 and h₁ᵀ B h₁ = h₂ᵀ B h₂ with B = diag(1/f_x², 1/f_y², 1), least squares over all views.
fn focal_lengths(homographies: &[DMat3]) -> Option<(f64, f64)> {
    let (mut normal, mut right) = (Matrix2::zeros(), Vector2::zeros());
    for h in homographies {
        let (a, b) = (h.x_axis, h.y_axis);
        // Of unit length: a view far away does not count less.
        let size = a.length() * b.length();
        for (row, constant) in [
            ([a.x * b.x, a.y * b.y], a.z * b.z),
            ([a.x * a.x - b.x * b.x, a.y * a.y - b.y * b.y], a.z * a.z - b.z * b.z),
        ] {
            let row = Vector2::from(row) / size;
            normal += row * row.transpose();
            right -= row * (constant / size);
        }
    }
    let inverse = normal.try_inverse()?;
    let squares = inverse * right;
    let lengths = squares.map(|s| 1.0 / s.sqrt());
    lengths.iter().all(|f| f.is_finite() && *f > 0.0).then_some((lengths[0], lengths[1]))
}

/// The pose that a homography shows: its columns are r₁, r₂ and t up to a factor.
fn pose(h: &DMat3, fx: f64, fy: f64) -> Pose {
    let scale = DVec3::new(1.0 / fx, 1.0 / fy, 1.0);
    let (a, b, t) = (h.x_axis * scale, h.y_axis * scale, h.z_axis * scale);
    // The board stands before the camera.
    let factor = t.z.signum() * 2.0 / (a.length() + b.length());
    let (a, b, t) = (a * factor, b * factor, t * factor);
    let c = a.cross(b);
    let near = Matrix3::from_columns(&[a, b, c].map(|v| nalgebra::Vector3::new(v.x, v.y, v.z)));
    let svd = near.svd(true, true);
    let rotation = match (svd.u, svd.v_t) {
        (Some(u), Some(v)) => u * v,
        _ => near,
    };
    let columns: Vec<f64> = rotation.iter().copied().collect();
    let rotation = DMat3::from_cols_slice(&columns);
    let (axis, angle) = glam::DQuat::from_mat3(&rotation).to_axis_angle();
    Pose { rotation: axis * angle, translation: t }
}
