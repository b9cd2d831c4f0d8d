//! The corners of a chessboard in a photograph: found and labelled by the crate `calib-targets-chessboard`, then placed here, at the
//! photograph's full depth, where all gradients around them point past them.
//!
//! Reference for the placing: W. Förstner and E. Gülch, *A fast operator for detection and precise location of distinct points, corners
//! and centres of circular features*, ISPRS 1987.

use calib_targets_chessboard::{
    ChessboardDetector, ChessboardParams, GrayImageView, default_chess_config, detect_corners,
};
use glam::{DMat2, DVec2};

use super::View;
use crate::capture::{Error, Photo};

/// Pixels on either side of a corner that place it, at most; fewer where squares are small.
const REACH: usize = 5;
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
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to a few pixels")]
    let reach = (closest / 2.0 - 1.0).clamp(2.0, REACH as f64) as usize;
    Ok(View {
        name: name.to_owned(),
        board: labelled.iter().map(|(g, _)| DVec2::new(f64::from(g[0]), f64::from(g[1])) * square).collect(),
        seen: labelled.iter().map(|(_, at)| picture.place(*at, reach)).collect(),
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

    /// Where Σ w g gᵀ (p − q) = 0 over the surroundings of q: every gradient g is at right angles to the way from the corner to it.
    fn place(&self, start: DVec2, reach: usize) -> DVec2 {
        let mut corner = start;
        for _ in 0..ROUNDS {
            let (mut matrix, mut right) = (DMat2::ZERO, DVec2::ZERO);
            let side = reach as f64;
            for j in 0..=2 * reach {
                for i in 0..=2 * reach {
                    let away = DVec2::new(i as f64 - side, j as f64 - side);
                    let at = corner + away;
                    let g = DVec2::new(
                        self.at(at.x + 1.0, at.y) - self.at(at.x - 1.0, at.y),
                        self.at(at.x, at.y + 1.0) - self.at(at.x, at.y - 1.0),
                    );
                    let w = (-away.length_squared() / side.powi(2)).exp();
                    let outer = DMat2::from_cols(g * g.x, g * g.y) * w;
                    matrix += outer;
                    right += outer * away;
                }
            }
            if matrix.determinant().abs() <= f64::EPSILON * matrix.x_axis.x.max(matrix.y_axis.y).powi(2) {
                return start;
            }
            let step = matrix.inverse() * right;
            corner += step;
            if step.length() < AT_REST {
                break;
            }
        }
        if corner.distance(start) <= MOST_MOVED { corner } else { start }
    }
}
