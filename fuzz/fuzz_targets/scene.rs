#![no_main]

use photopic::luminaire::Luminaire;
use photopic::render::build::{Files, build};
use photopic::render::description::Description;
use photopic::render::mesh::MeshData;
use photopic::spectrum::Spectrum;

/// No file is there.
struct Nothing;

impl Files for Nothing {
    fn spectrum(&self, file: &str) -> Result<Spectrum, String> {
        Err(format!("{file}: no such file; expected a spectrum"))
    }

    fn luminaire(&self, file: &str) -> Result<Luminaire, String> {
        Err(format!("{file}: no such file; expected a lamp file"))
    }

    fn meshes(&self, file: &str) -> Result<Vec<MeshData>, String> {
        Err(format!("{file}: no such file; expected a mesh"))
    }
}

libfuzzer_sys::fuzz_target!(|text: &str| {
    if let Ok(description) = Description::parse(text) {
        let _ = build(text, &description, &Nothing);
    }
});
