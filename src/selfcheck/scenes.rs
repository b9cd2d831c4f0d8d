//! Scenes.

use super::Check;
use crate::render::build::{Kind, NoFiles, build};
use crate::render::description::Description;
use crate::render::estimate::{Figure, REPLICATES};
use crate::render::measure::Board;
use crate::render::spool::Share;

/// 4 L a atan(a) with a = X/√(1 + X²), X = 1/2 and L = 1000 cd/m².
const SQUARE_LX: f64 = 752.274_688_454_107_4;

/// The first meter's reading, with so many samples.
fn read(text: &str, samples: u64) -> Option<Figure> {
    let description = Description::parse(text).ok()?;
    let built = build(text, &description, &NoFiles).ok()?;
    let Kind::Meter(meter) = &built.instruments.first()?.kind else { return None };
    let mut board = Board::new(&built.scene, &built.settings, Share::WHOLE, vec![(0, meter.clone())]);
    board.sample_until(samples.div_ceil(REPLICATES as u64));
    Some(board.estimate(0).figure(&built.quantities.luminous))
}

/// The illuminance from 1000 cd at a distance, times its square.
fn point(distance_m: f64) -> f64 {
    let text = format!(
        "[[light]]\npoint = {{ at = [0, 0, {distance_m:e}], intensity = \"1000 cd\" }}\n[[sensor]]\nname = \"e\"\nilluminance = {{ at = [0, 0, 0] }}\n"
    );
    read(&text, 128).map_or(f64::NAN, |f| f.value * distance_m * distance_m)
}

pub(super) fn checks() -> Vec<Check> {
    let check =
        |case, source, expected, found, allowed| Check { area: "scenes", case, source, expected, found, allowed };
    let mut out = Vec::new();
    for (case, distance_m) in [
        ("1000 cd at 1e-8 m: E d² [cd]", 1e-8),
        ("1000 cd at 1 m: E d² [cd]", 1.0),
        ("1000 cd at 1e8 m: E d² [cd]", 1e8),
    ] {
        out.push(check(case, "the inverse square", 1000.0, point(distance_m), 1e-6));
    }
    let square = "[[shape]]\nname = \"lamp\"\nemission = { radiance = \"1000 cd/m2\" }\n\
        rectangle = { corner = [-0.5, -0.5, 1], edges = [[0, 1, 0], [1, 0, 0]] }\n\
        [[sensor]]\nname = \"e\"\nilluminance = { at = [0, 0, 0] }\n";
    let figure = read(square, 1 << 14);
    // Four standard errors, of which fewer than one in ten thousand runs need more; the seed is fixed.
    let (found, allowed) = figure.map_or((f64::NAN, 0.0), |f| (f.value, 4.0 * f.standard_error / f.value));
    out.push(check("1 m² of 1000 cd/m² at 1 m [lx]", "the form factor, 40 digits", SQUARE_LX, found, allowed));
    out
}
