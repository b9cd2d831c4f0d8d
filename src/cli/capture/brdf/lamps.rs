//! Lamps of which a photometric file tells the intensities.

use std::sync::Arc;

use super::message;
use crate::capture::lamp::Pattern;
use crate::capture::setup::Place;
use crate::cli::Failure;
use crate::cli::capture::photos::Photos;
use crate::luminaire::format::{ReadOptions, read};

/// The pattern of each light of the manifest that has a file; lights without a stated strength get that of the file along its axis.
pub(super) fn patterns(photos: &mut Photos) -> Result<Vec<Option<Arc<Pattern>>>, Failure> {
    let mut out = Vec::new();
    for n in 0..photos.manifest.light.len() {
        let light = photos.manifest.light[n].clone();
        let (Some(lamp), Place::Near(position)) = (&light.lamp, light.place) else {
            out.push(None);
            continue;
        };
        let path = photos.path(&lamp.file);
        let bytes = photos.bytes(&path)?;
        let mut read = read(&bytes, &ReadOptions::default()).map_err(|e| message(e.in_file(&path)))?;
        read.findings.iter_mut().for_each(|f| f.location.path = Some(path.clone()));
        photos.findings.append(&mut read.findings);
        let pattern = Pattern::new(read.value.distribution, position, lamp.aim_m, lamp.c0)
            .map_err(|e| Failure::Message(format!("light {}: {e}", light.name)))?;
        photos.manifest.light[n].strength.get_or_insert_with(|| vec![pattern.on_axis]);
        out.push(Some(Arc::new(pattern)));
    }
    Ok(out)
}
