#![no_main]

use photopic::brdf::table::Table;
use photopic::luminaire::Luminaire;
use photopic::render::build::{Files, PictureFile, build};
use photopic::render::description::Description;
use photopic::render::format::Object;
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

    fn meshes(&self, file: &str) -> Result<Vec<Object>, String> {
        Err(format!("{file}: no such file; expected a mesh"))
    }

    fn picture(&self, file: &str) -> Result<PictureFile, String> {
        Err(format!("{file}: no such file; expected a picture"))
    }

    fn table(&self, file: &str) -> Result<Table, String> {
        Err(format!("{file}: no such file; expected a measured BRDF"))
    }
}

libfuzzer_sys::fuzz_target!(|text: &str| {
    if let Ok(description) = Description::parse(text) {
        let _ = build(text, &description, &Nothing);
    }
});
