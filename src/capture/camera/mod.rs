//! The camera: intrinsics and distortion from views of a plane board with known corners.
//!
//! ```text
//! X_c = R X + t,   (x, y) = (X_c/Z_c, Y_c/Z_c),   (x_d, y_d) = lens(x, y),   u = f_x x_d + c_x,   v = f_y y_d + c_y
//! ```
//!
//! The lens is [`Distortion`]; R is given as a rotation vector, its axis times the angle in radians. As in OpenCV, Z points forward.
//!
//! References: Z. Zhang, *A flexible new technique for camera calibration*, IEEE PAMI 22 (2000); D. C. Brown (1966), see
//! [`crate::geometry::lens`].

mod adjust;
mod board;
mod edge;
mod start;

use glam::{DMat3, DVec2, DVec3};

use crate::geometry::lens::Distortion;
use crate::uncertainty::{COVERAGE_FACTOR_95, Stated};

pub use adjust::{calibrate, calibrate_lean};
pub use board::find_corners;
pub use edge::{Edge, fit_to_sphere};

/// Focal lengths and principal point, pixels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Intrinsics {
    /// Focal length along x.
    pub fx: f64,
    /// Focal length along y.
    pub fy: f64,
    /// Column of the principal point; 0 is the centre of the first pixel.
    pub cx: f64,
    /// Row of the principal point.
    pub cy: f64,
}

/// A camera with its lens.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Camera {
    /// Focal lengths and principal point.
    pub intrinsics: Intrinsics,
    /// The lens.
    pub distortion: Distortion,
}

impl Camera {
    /// The pixel of a point in the camera's frame; meaningless behind it.
    #[must_use]
    pub fn project(&self, point: DVec3) -> DVec2 {
        let i = &self.intrinsics;
        let d = self.distortion.distort(point.truncate() / point.z);
        DVec2::new(i.fx * d.x + i.cx, i.fy * d.y + i.cy)
    }

    /// The direction that a pixel sees, in the camera's frame with z = 1; `None` where the lens model has none.
    #[must_use]
    pub fn direction(&self, pixel: DVec2) -> Option<DVec3> {
        let i = &self.intrinsics;
        let distorted = DVec2::new((pixel.x - i.cx) / i.fx, (pixel.y - i.cy) / i.fy);
        self.distortion.undistort(distorted).map(|d| d.extend(1.0))
    }
}

/// Where a board stands before the camera.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pose {
    /// Rotation vector, radians.
    pub rotation: DVec3,
    /// Translation, in the unit of the board.
    pub translation: DVec3,
}

impl Pose {
    /// The rotation as a matrix.
    #[must_use]
    pub fn matrix(&self) -> DMat3 {
        let angle = self.rotation.length();
        if angle == 0.0 { DMat3::IDENTITY } else { DMat3::from_axis_angle(self.rotation / angle, angle) }
    }

    /// A point of the board in the camera's frame.
    #[must_use]
    pub fn transform(&self, point: DVec2) -> DVec3 {
        self.matrix() * point.extend(0.0) + self.translation
    }
}

/// One photograph of the board.
#[derive(Debug, Clone, PartialEq)]
pub struct View {
    /// Its name.
    pub name: String,
    /// Places on the board, in squares or m.
    pub board: Vec<DVec2>,
    /// Where each was seen, pixels.
    pub seen: Vec<DVec2>,
}

/// What calibration found.
#[derive(Debug, Clone, PartialEq)]
pub struct Calibration {
    /// The camera.
    pub camera: Camera,
    /// Standard errors of f_x, f_y, c_x, c_y, k₁, k₂, p₁, p₂, k₃.
    pub standard_errors: [f64; 9],
    /// Root of the mean squared distance between corners seen and projected, pixels.
    pub rms_px: f64,
    /// Per view: pose and rms, in the order given.
    pub views: Vec<(Pose, f64)>,
    /// Whether the adjustment came to rest.
    pub converged: bool,
}

impl Calibration {
    /// Standard errors and intervals of 95 % of the nine numbers; the corners are so many that they are normally distributed.
    #[must_use]
    pub fn stated(&self) -> [Stated; 9] {
        let (values, errors) = (self.parameters(), self.standard_errors);
        std::array::from_fn(|i| Stated::of_mean(values[i], errors[i], COVERAGE_FACTOR_95))
    }
}

/// Names of the nine numbers of a camera, in the order of [`Calibration::standard_errors`].
pub const PARAMETERS: [&str; 9] = ["fx", "fy", "cx", "cy", "k1", "k2", "p1", "p2", "k3"];

/// A view is an outlier where its rms is above so many times the median of all.
const OUTLYING: f64 = 2.5;

impl Calibration {
    /// The nine numbers of the camera.
    #[must_use]
    pub fn parameters(&self) -> [f64; 9] {
        let (i, d) = (&self.camera.intrinsics, &self.camera.distortion);
        [i.fx, i.fy, i.cx, i.cy, d.k1, d.k2, d.p1, d.p2, d.k3]
    }

    /// Numbers of the views that fit far worse than the others: rms above 2.5 times the median.
    #[must_use]
    pub fn outliers(&self) -> Vec<usize> {
        let mut all: Vec<f64> = self.views.iter().map(|(_, rms)| *rms).collect();
        all.sort_by(f64::total_cmp);
        let median = all.get(all.len() / 2).copied().unwrap_or(0.0);
        (0..self.views.len()).filter(|i| self.views[*i].1 > OUTLYING * median).collect()
    }
}
