//! The layout file of `lamp grid`: many luminaires, each with places and an orientation of its own.
//!
//! ```toml
//! [[luminaire]]
//! file = "panel.ldt"                        # beside the layout file
//! at_m = [[1.2, 1.5, 2.8], [3.6, 1.5, 2.8]] # photometric centres
//! rotate_deg = 90                           # also tilt_deg, tilt_towards_deg, spin_deg
//! dim = 0.8
//!
//! [[luminaire]]
//! file = "spot.ies"
//! at_m = [[0.2, 0.2, 2.6]]
//! aim_m = [2.0, 2.0, 0.0]
//! ```

use std::fs;
use std::path::Path;

use glam::DVec3;
use serde::Deserialize;
use toml::Spanned;

use crate::cli::Failure;
use crate::finding::Location;
use crate::luminaire::placement::{Orientation, Placement};

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Layout {
    luminaire: Vec<Spanned<Entry>>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Entry {
    file: String,
    at_m: Vec<[f64; 3]>,
    aim_m: Option<[f64; 3]>,
    rotate_deg: Option<f64>,
    tilt_deg: Option<f64>,
    #[serde(default)]
    tilt_towards_deg: f64,
    #[serde(default)]
    spin_deg: f64,
    #[serde(default = "full")]
    dim: f64,
}

fn full() -> f64 {
    1.0
}

/// The lamp files of a layout, each once, and every luminaire with the index of its file.
pub(super) struct Laid {
    pub files: Vec<String>,
    pub luminaires: Vec<(usize, Placement)>,
}

/// Reads a layout file.
pub(super) fn read(path: &Path) -> Result<Laid, Failure> {
    let shown = path.display().to_string();
    let text = fs::read_to_string(path).map_err(|e| {
        Failure::Message(format!("{shown}: cannot be read: {e}; expected a layout file of text (`lamp grid --help`)"))
    })?;
    parse(&text, &shown, path.parent().unwrap_or(Path::new("")))
}

fn parse(text: &str, shown: &str, folder: &Path) -> Result<Laid, Failure> {
    let refuse = |offset: usize, message: &str| {
        let (line, column) = line_and_column(text, offset);
        let place = Location::at(line, column).in_file(shown);
        Failure::Message(format!("{place}: {message}"))
    };
    let layout: Layout = toml::from_str(text).map_err(|e| {
        let message = e.message().trim().replace('\n', " ");
        refuse(e.span().map_or(0, |s| s.start), &message)
    })?;
    let mut laid = Laid { files: Vec::new(), luminaires: Vec::new() };
    for entry in &layout.luminaire {
        let (at, entry) = (entry.span().start, entry.get_ref());
        let orientation = match (entry.aim_m, entry.rotate_deg, entry.tilt_deg) {
            (Some(aim), None, None) => Orientation::Aim {
                at_m: DVec3::from(aim),
                towards_c_deg: entry.tilt_towards_deg,
                spin_deg: entry.spin_deg,
            },
            (None, rotate, tilt) => Orientation::Angles {
                rotation_deg: rotate.unwrap_or(0.0),
                tilt_deg: tilt.unwrap_or(0.0),
                towards_c_deg: entry.tilt_towards_deg,
                spin_deg: entry.spin_deg,
            },
            (Some(_), ..) => {
                return Err(refuse(at, "found aim_m beside rotate_deg or tilt_deg; expected one or the other"));
            }
        };
        if entry.at_m.is_empty() {
            return Err(refuse(at, "found an empty at_m; expected one place or more, such as [[0, 0, 2.8]]"));
        }
        let file = folder.join(&entry.file).display().to_string();
        let index = laid.files.iter().position(|f| *f == file).unwrap_or_else(|| {
            laid.files.push(file);
            laid.files.len() - 1
        });
        for place in &entry.at_m {
            let placement = Placement::new(DVec3::from(*place), orientation, entry.dim)
                .map_err(|e| refuse(at, &format!("found {e}")))?;
            laid.luminaires.push((index, placement));
        }
    }
    if laid.luminaires.is_empty() {
        return Err(refuse(0, "found no luminaire; expected [[luminaire]] tables"));
    }
    Ok(laid)
}

/// Line and column of a byte, both from 1, the column in characters.
fn line_and_column(text: &str, offset: usize) -> (u64, u64) {
    let before = text.get(..offset).unwrap_or(text);
    let line = before.matches('\n').count() + 1;
    let column = before.rsplit('\n').next().unwrap_or_default().chars().count() + 1;
    (line as u64, column as u64)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refused(text: &str) -> String {
        match parse(text, "l.toml", Path::new("")) {
            Err(Failure::Message(message)) => message,
            _ => panic!("`{text}` was accepted"),
        }
    }

    #[test]
    fn each_luminaire_has_its_own_places_and_orientation() {
        let text = "[[luminaire]]\nfile = \"a.ies\"\nat_m = [[0, 0, 3], [2, 0, 3.0]]\ndim = 0.5\n\
                    [[luminaire]]\nfile = \"b.ies\"\nat_m = [[1, 1, 2]]\naim_m = [1, 5, 2]\n\
                    [[luminaire]]\nfile = \"a.ies\"\nat_m = [[9, 9, 9]]\ntilt_deg = 90\n";
        let Ok(laid) = parse(text, "l.toml", Path::new("rooms")) else { panic!("a sound layout") };
        let folder = Path::new("rooms");
        assert_eq!(laid.files, ["a.ies", "b.ies"].map(|f| folder.join(f).display().to_string()));
        let (files, placements): (Vec<usize>, Vec<Placement>) = laid.luminaires.into_iter().unzip();
        assert_eq!(files, [0, 0, 1, 0]);
        assert_eq!(placements[1].position_m(), DVec3::new(2.0, 0.0, 3.0));
        assert_eq!((placements[0].dimming(), placements[2].dimming()), (0.5, 1.0));
        // Aimed along +y at its own height; tilted by 90° towards C0, which is +x.
        assert!((placements[2].axis() - DVec3::Y).length() < 1e-12);
        assert!((placements[3].axis() - DVec3::X).length() < 1e-12);
    }

    #[test]
    fn faults_are_told_by_line_and_column() {
        let lamp = "[[luminaire]]\nfile = \"a.ies\"\n";
        assert!(refused(&format!("{lamp}at = [[0, 0, 3]]\n")).starts_with("l.toml:3:1: unknown field `at`"));
        assert!(refused(&format!("{lamp}at_m = [[0, 3]]\n")).starts_with("l.toml:3:"));
        assert!(refused(&format!("{lamp}at_m = [[0, 0, 3]]\ntilt_deg = \"5\"\n")).starts_with("l.toml:4:12: "));
        assert!(refused(&format!("{lamp}at_m = []\n")).contains("empty at_m"));
        let both = refused(&format!("\n{lamp}at_m = [[0, 0, 3]]\naim_m = [0, 0, 0]\ntilt_deg = 5\n"));
        assert!(both.starts_with("l.toml:2:1: ") && both.contains("aim_m beside"), "{both}");
        assert!(refused(&format!("{lamp}at_m = [[0, 0, 3]]\ndim = -1\n")).contains("dimming factor of -1"));
        assert!(refused("").starts_with("l.toml:1:1: missing field `luminaire`"));
        assert!(refused("luminaire = []").contains("found no luminaire"));
    }
}
