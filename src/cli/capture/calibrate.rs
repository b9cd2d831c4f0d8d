//! `capture calibrate`: the camera from photographs of a chessboard.

use std::path::PathBuf;

use clap::Args;
use glam::DVec2;
use rayon::prelude::*;
use serde_json::json;

use super::photos::{Form, Given, Photos, is_manifest};
use crate::capture::camera::{View, calibrate as adjust, find_corners};
use crate::capture::manifest::Board;
use crate::cli::{Failure, Talk};
use crate::finding::{Finding, Location};
use crate::report::capture as report;

/// The board, its photographs and the form of the answer.
#[derive(Debug, Args)]
#[command(after_long_help = "\
Examples:
  photopic capture calibrate capture.toml
  photopic capture calibrate left*.jpg --board 9x6 --json
  photopic capture calibrate --board 9x6 --corners corners.csv left01.jpg")]
pub(in crate::cli) struct CalibrateArgs {
    #[command(flatten)]
    given: Given,
    /// Inner corners along a row and rows of them, instead of the manifest's.
    #[arg(long, value_name = "COLUMNSxROWS", value_parser = size)]
    board: Option<[usize; 2]>,
    /// Corners found already, as CSV with the columns view, X, Y (places on the board) and u, v (pixels): no photograph is searched.
    #[arg(long, value_name = "CSV")]
    corners: Option<PathBuf>,
    #[command(flatten)]
    form: Form,
    /// Write to a file instead of standard output.
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
}

fn size(text: &str) -> Result<[usize; 2], String> {
    let both = text.split_once(['x', '×']).and_then(|(a, b)| Some([a.parse().ok()?, b.parse().ok()?]));
    both.filter(|b: &[usize; 2]| b.iter().all(|n| *n >= 2))
        .ok_or_else(|| format!("`{text}`; expected two numbers of inner corners such as 9x6"))
}

pub(super) fn calibrate(a: &CalibrateArgs, talk: Talk) -> Result<(), Failure> {
    let mut photos = Photos::open("capture calibrate", &a.given, talk)?;
    let described = photos.manifest.board.clone();
    let square = described.as_ref().and_then(|b| b.square_m).unwrap_or(1.0);
    let file = a.corners.as_ref().map(|p| p.display().to_string());
    let file = file.or_else(|| described.as_ref().and_then(|b| b.corners_file.as_ref()).map(|f| photos.path(f)));
    let views = match file {
        Some(path) => {
            let bytes = photos.bytes(&path)?;
            table(&path, &bytes, square)?
        }
        None => search(&mut photos, a, described.as_ref(), square)?,
    };
    let found = adjust(&views).map_err(|e| {
        photos.notes.print(&photos.findings);
        Failure::Message(e.to_string())
    })?;
    for n in found.outliers() {
        let message = format!(
            "fits with an rms of {:.3} px, far worse than the others ({:.3} px over all)",
            found.views[n].1, found.rms_px
        );
        let place = Location::default().of_item(&views[n].name);
        photos.findings.push(Finding::warning("K005", message).hint("leave it out, or photograph it again").at(place));
    }
    if !found.converged {
        photos.findings.push(Finding::warning("K006", "the adjustment did not come to rest"));
    }
    let settings = json!({"board": a.board.or(described.map(|b| b.corners)), "square": square});
    let result = report::calibration(&views, &found);
    let text = report::calibration_text(&views, &found);
    photos.print(&settings, &[result], &text, a.form.json, a.output.as_deref())
}

/// Finds the board in all photographs; those without are left out.
fn search(
    photos: &mut Photos,
    a: &CalibrateArgs,
    described: Option<&Board>,
    square: f64,
) -> Result<Vec<View>, Failure> {
    let direct = !a.given.files.iter().any(|f| is_manifest(f));
    let files: Vec<String> = match described {
        _ if direct => a.given.files.clone(),
        Some(board) => board.views.clone(),
        None => Vec::new(),
    };
    let corners = a.board.or(described.map(|b| b.corners));
    let corners = corners.ok_or_else(|| {
        let message = "found no size of the board; expected [board] in the manifest or --board such as 9x6";
        Failure::Message(message.to_owned())
    })?;
    if files.is_empty() {
        let message = "found no photographs of a board; expected `views` in [board] of the manifest, or photographs";
        return Err(Failure::Message(message.to_owned()));
    }
    Ok(find_views(photos, &files, corners, square))
}

/// Finds the board in photographs; those without are left out.
pub(super) fn find_views(photos: &mut Photos, files: &[String], corners: [usize; 2], square: f64) -> Vec<View> {
    let mut views = Vec::new();
    // As many as are looked at together: of cameras with many megapixels all would not fit.
    for files in files.chunks(rayon::current_num_threads()) {
        let mut decoded = Vec::new();
        for file in files {
            match photos.photo(file) {
                Ok(photo) => decoded.push((file, photo)),
                Err(failure) => photos.left_out(file, &failure),
            }
        }
        let found: Vec<_> =
            decoded.par_iter().map(|(file, photo)| (file, find_corners(file, photo, corners, square))).collect();
        for (file, view) in found {
            match view {
                Ok(view) => views.push(view),
                Err(error) => photos.left_out(file, &Failure::Message(error.to_string())),
            }
        }
    }
    views
}

/// Reads a table of corners; views are named by what the column says.
fn table(path: &str, bytes: &[u8], square: f64) -> Result<Vec<View>, Failure> {
    let wrong = |line: usize, found: String| {
        Failure::Message(format!("{path}:{line}:1: found {found}; expected a table with columns view, X, Y, u, v"))
    };
    let mut reader = csv::Reader::from_reader(bytes);
    let headers = reader.headers().map_err(|e| wrong(1, e.to_string()))?.clone();
    let column = |name: &str| {
        headers.iter().position(|h| h.trim() == name).ok_or_else(|| wrong(1, format!("no column `{name}`")))
    };
    let name = column("view")?;
    let numbers = [column("X")?, column("Y")?, column("u")?, column("v")?];
    let mut views: Vec<View> = Vec::new();
    for (n, row) in reader.records().enumerate() {
        let row = row.map_err(|e| wrong(n + 2, e.to_string()))?;
        let mut values = [0.0; 4];
        for (value, column) in values.iter_mut().zip(numbers) {
            let cell = row.get(column).unwrap_or_default();
            let parsed = cell.trim().parse::<f64>().ok().filter(|v| v.is_finite());
            *value = parsed.ok_or_else(|| wrong(n + 2, format!("`{cell}`")))?;
        }
        let view = row.get(name).unwrap_or_default();
        let at = views.iter().position(|v| v.name == view).unwrap_or_else(|| {
            views.push(View { name: view.to_owned(), board: Vec::new(), seen: Vec::new() });
            views.len() - 1
        });
        views[at].board.push(DVec2::new(values[0], values[1]) * square);
        views[at].seen.push(DVec2::new(values[2], values[3]));
    }
    Ok(views)
}
