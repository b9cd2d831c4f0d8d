//! Names of the photopic quantity of an image.

use crate::image::Photometric;
use crate::report::conversion::keys;

/// The key of the photopic quantity: `luminance_cd_per_m2`, `illuminance_lx` …; `photopic` where it is relative.
pub(super) fn key(photometric: &Photometric) -> &'static str {
    photometric.quantity().and_then(keys).map_or("photopic", |k| k.luminous)
}

/// Its name: `luminance`, `illuminance` …; `photopic` where it is relative.
#[must_use]
pub fn name(photometric: &Photometric) -> String {
    let words: Vec<&str> = key(photometric).split('_').collect();
    let end = words.iter().position(|w| matches!(*w, "cd" | "lx" | "lm")).unwrap_or(words.len());
    words[..end].join(" ")
}
