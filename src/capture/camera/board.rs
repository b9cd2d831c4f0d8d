//! The corners of a chessboard in a photograph: found and labelled by the crate `calib-targets-chessboard`, then placed here, at the
//! photograph's full depth, in the saddle of the luma around them.
//!
//! A quadratic polynomial is fitted to a disc about a corner, a quarter of the way to the next one, by weights that fall to 0 at its rim; its saddle is the
//! next middle of the disc, until it rests. Black and white are alike to it, and noise is averaged over the disc: on boards with little else
//! than noise, corners scatter by half of what they do where gradients place them.
//!
//! Reference for the placing: S. Placht et al., *ROCHADE: Robust Checkerboard Advanced Detection for Camera Calibration*, ECCV 2014.

use calib_targets_chessboard::{
    ChessboardDetector, ChessboardParams, GrayImageView, default_chess_config, detect_corners,
};
use glam::{DMat2, DVec2};
use nalgebra::{SMatrix, SVector};

use super::View;
use crate::capture::{Error, Photo};

/// Radius of the disc that places a corner, of the distance to the next one, and pixels that it has at least and at most.
const SHARE: f64 = 0.25;
const LEAST_REACH: f64 = 2.0;
const MOST_REACH: f64 = 15.0;
/// Rounds of placing.
const ROUNDS: usize = 40;
/// Movement of a corner, pixels, at which it is placed.
const AT_REST: f64 = 1e-3;
/// Most that placing may move a corner, pixels.
const MOST_MOVED: f64 = 3.0;

/// Finds all `corners` = [along a row, rows] inner corners of a board; places on the board are in units of `square`.
///
/// # Errors
/// [`Error::Views`] where the whole board is not found.
pub fn find_corners(name: &str, photo: &Photo, corners: [usize; 2], square: f64) -> Result<View, Error> {
    let luma = photo.luma();
    let missing =
        |found: String| Error::Views { found, expected: "all inner corners of the board, sharp and lit evenly" };
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "luma is 0 to 255")]
    let bytes: Vec<u8> = luma.iter().map(|l| l.round() as u8).collect();
    let view = GrayImageView { width: photo.width, height: photo.height, data: &bytes };
    let detector = ChessboardDetector::new(ChessboardParams::default());
    let detector = detector.map_err(|e| missing(format!("no detector ({e})")))?;
    let board = detector.detect(&detect_corners(&view, &default_chess_config()));
    let board = board.ok_or_else(|| missing(format!("no board in {name}")))?;
    let extent = |of: fn(&calib_targets_chessboard::ChessboardCorner) -> i32| {
        let (low, high) = board.corners.iter().map(of).fold((i32::MAX, i32::MIN), |(l, h), v| (l.min(v), h.max(v)));
        (low, usize::try_from(high - low + 1).unwrap_or(0))
    };
    let ((u0, columns), (v0, rows)) = (extent(|c| c.grid.u), extent(|c| c.grid.v));
    let turned = [columns, rows] != corners;
    let whole = board.corners.len() == columns * rows;
    if !whole || (turned && [rows, columns] != corners) {
        let found = format!("{} corners on {columns} × {rows} places in {name}", board.corners.len());
        return Err(missing(found));
    }
    let picture = Picture { width: photo.width, height: photo.height, luma: &luma };
    let mut labelled: Vec<([i32; 2], DVec2)> = (board.corners.iter())
        .map(|c| {
            let at = DVec2::new(f64::from(c.position.x), f64::from(c.position.y));
            let grid = [c.grid.u - u0, c.grid.v - v0];
            (if turned { [grid[1], grid[0]] } else { grid }, at)
        })
        .collect();
    labelled.sort_by_key(|(grid, _)| [grid[1], grid[0]]);
    let closest = labelled.windows(2).map(|w| w[0].1.distance(w[1].1)).fold(f64::INFINITY, f64::min);
    let disc = Disc::new((SHARE * closest).clamp(LEAST_REACH, MOST_REACH));
    let disc = disc.ok_or_else(|| missing(format!("no disc about the corners of {name}")))?;
    Ok(View {
        name: name.to_owned(),
        board: labelled.iter().map(|(g, _)| DVec2::new(f64::from(g[0]), f64::from(g[1])) * square).collect(),
        seen: labelled.iter().map(|(_, at)| picture.place(*at, &disc)).collect(),
    })
}

struct Picture<'a> {
    width: usize,
    height: usize,
    luma: &'a [f32],
}

impl Picture<'_> {
    /// Luma between pixels, linear in both directions; the border continues.
    fn at(&self, x: f64, y: f64) -> f64 {
        let (x, y) = (x.clamp(0.0, (self.width - 1) as f64), y.clamp(0.0, (self.height - 1) as f64));
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to the picture")]
        let (i, j) = ((x as usize).min(self.width.max(2) - 2), (y as usize).min(self.height.max(2) - 2));
        let (s, t) = (x - i as f64, y - j as f64);
        let pixel =
            |i: usize, j: usize| f64::from(self.luma[j.min(self.height - 1) * self.width + i.min(self.width - 1)]);
        (1.0 - t) * ((1.0 - s) * pixel(i, j) + s * pixel(i + 1, j))
            + t * ((1.0 - s) * pixel(i, j + 1) + s * pixel(i + 1, j + 1))
    }

    /// The saddle of the luma near a place.
    fn place(&self, start: DVec2, disc: &Disc) -> DVec2 {
        let mut corner = start;
        for _ in 0..ROUNDS {
            let mut q = [0.0; TERMS];
            for (away, solution) in &disc.places {
                let luma = self.at(corner.x + away.x, corner.y + away.y);
                q.iter_mut().zip(solution).for_each(|(q, s)| *q += s * luma);
            }
            // Of q₀x² + q₁xy + q₂y² + q₃x + q₄y + q₅: where its gradient is 0, if that is a saddle.
            let curvature = DMat2::from_cols_array(&[2.0 * q[0], q[1], q[1], 2.0 * q[2]]);
            if curvature.determinant() >= 0.0 {
                return start;
            }
            let step = -(curvature.inverse() * DVec2::new(q[3], q[4]));
            corner += step;
            if step.length() < AT_REST {
                break;
            }
        }
        if corner.distance(start) <= MOST_MOVED { corner } else { start }
    }
}

/// Terms of a quadratic polynomial of two variables.
const TERMS: usize = 6;

/// Pixels about a corner, and what each contributes to the terms of the polynomial.
struct Disc {
    places: Vec<(DVec2, [f64; TERMS])>,
}

impl Disc {
    /// A disc of some radius, with weights that fall as a cone: (MᵀWM)⁻¹ MᵀW. `None` where that has no inverse.
    fn new(reach: f64) -> Option<Self> {
        #[expect(clippy::cast_possible_truncation, reason = "a few pixels")]
        let side = reach.ceil() as i32;
        let all = (-side..=side).flat_map(|y| (-side..=side).map(move |x| DVec2::new(f64::from(x), f64::from(y))));
        let weight = |p: &DVec2| (reach + 1.0 - p.length()).max(0.0);
        let terms = |p: &DVec2| SVector::<f64, TERMS>::from([p.x * p.x, p.x * p.y, p.y * p.y, p.x, p.y, 1.0]);
        let places: Vec<DVec2> = all.filter(|p| weight(p) > 0.0).collect();
        let normal: SMatrix<f64, TERMS, TERMS> =
            places.iter().map(|p| terms(p) * terms(p).transpose() * weight(p)).sum();
        let inverse = normal.try_inverse()?;
        let places = places.into_iter().map(|p| (p, (inverse * terms(&p) * weight(&p)).into()));
        Some(Self { places: places.collect() })
    }
}
