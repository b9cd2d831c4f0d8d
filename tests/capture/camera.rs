//! The left chessboard set against OpenCV's `calibrateCamera`.

use std::fs;

use glam::DVec2;
use photopic::capture::Photo;
use photopic::capture::camera::{View, calibrate, find_corners};

use crate::common::{rows, shared};

/// OpenCV's result from its own corners, with the digits that the issue of this feature quotes.
const OPENCV: [(f64, f64); 9] = [
    (518.621, 5e-4),
    (518.935, 5e-4),
    (315.593, 5e-4),
    (249.282, 5e-4),
    (-0.05716, 5e-6),
    (0.09202, 5e-6),
    (-0.00025, 5e-6),
    (0.00228, 5e-6),
    (-0.01908, 5e-6),
];
/// Its rms, pixels.
const OPENCV_RMS_PX: f64 = 0.15264;

#[test]
fn opencvs_corners_give_opencvs_camera() {
    let Some(path) = shared("capture/chessboard_left/opencv_corners.csv") else { return };
    let mut views: Vec<View> = Vec::new();
    for row in rows(&path) {
        let number = |key: &str| row[key].parse::<f64>().expect("a number");
        if views.last().is_none_or(|v| v.name != row["view"]) {
            views.push(View { name: row["view"].clone(), board: Vec::new(), seen: Vec::new() });
        }
        let view = views.last_mut().expect("just pushed");
        view.board.push(DVec2::new(number("X"), number("Y")));
        view.seen.push(DVec2::new(number("u"), number("v")));
    }
    let found = calibrate(&views).expect("a camera");
    assert!(found.converged && found.outliers().is_empty(), "{found:?}");
    assert!((found.rms_px - OPENCV_RMS_PX).abs() < 5e-6, "{}", found.rms_px);
    for (value, (expected, half_a_digit)) in found.parameters().into_iter().zip(OPENCV) {
        assert!((value - expected).abs() <= half_a_digit, "{value} {expected}");
    }
    // A view whose corners are given a pixel of noise (a fixed pattern) is named.
    for (n, seen) in views[7].seen.iter_mut().enumerate() {
        *seen += DVec2::new(if n % 2 == 0 { 1.0 } else { -1.0 }, if n % 3 == 0 { 1.0 } else { -0.5 });
    }
    assert_eq!(calibrate(&views).expect("a camera").outliers(), [7]);
    assert!(calibrate(&views[..2]).is_err());
}

#[test]
fn own_corners_fit_no_worse_than_opencvs() {
    let Some(folder) = shared("capture/chessboard_left") else { return };
    let view = |n: usize| {
        let name = format!("left{n:02}.jpg");
        let photo = Photo::decode(&fs::read(folder.join(&name)).expect("a photograph")).expect("a JPEG");
        find_corners(&name, &photo, [9, 6], 1.0).expect("the whole board")
    };
    let views: Vec<View> = (1..=25).map(view).collect();
    let found = calibrate(&views).expect("a camera");
    assert!(found.rms_px <= OPENCV_RMS_PX, "{}", found.rms_px);
}

/// Rms, pixels, of `calibrateCamera` from the corners of `findChessboardCornersSB` in the twelve synthetic boards (OpenCV 5.0.0, without flags).
const OPENCV_SB_RMS_PX: f64 = 0.07919;
/// The focal length of the camera that they were computed with: that of `scene.json`'s field of view.
const FOCAL_PX: f64 = 1712.936;

#[test]
fn own_corners_of_synthetic_boards_fit_no_worse_than_opencvs_and_tell_the_camera() {
    let Some(folder) = shared("capture/synthetic_camera") else { return };
    let view = |n: usize| {
        let name = format!("board_{n:02}.png");
        let photo = Photo::decode(&fs::read(folder.join(&name)).expect("a photograph")).expect("a PNG");
        find_corners(&name, &photo, [9, 6], 1.0).expect("the whole board")
    };
    let views: Vec<View> = (0..12).map(view).collect();
    let found = calibrate(&views).expect("a camera");
    assert!(found.rms_px <= OPENCV_SB_RMS_PX, "{}", found.rms_px);
    let intrinsics = found.camera.intrinsics;
    for (value, sigma) in [(intrinsics.fx, found.standard_errors[0]), (intrinsics.fy, found.standard_errors[1])] {
        assert!((value - FOCAL_PX).abs() < 3.0 * sigma, "{value} ± {sigma}");
    }
}
