//! Spectra in a scene.

use std::borrow::Cow;
use std::fmt;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::{Deserialize, Deserializer, Error as _, MapAccess, SeqAccess, Visitor};

/// A spectrum as a scene gives it.
#[derive(Debug, Clone, PartialEq)]
pub enum SpectrumSource {
    /// The same at every wavelength.
    Constant(f64),
    /// `[[nm, value], …]`, wavelengths ascending, straight lines in between; constant beyond the ends for a reflectance, zero for an
    /// emission.
    Table(Vec<[f64; 2]>),
    /// A name: of the scene's `[spectra]`, else of a source that the tool knows (`D65`, `LED-B3`, `blackbody:2856K`, `daylight:5000K`,
    /// `line:589.3nm`).
    Named(String),
    /// A file with one spectrum, beside the scene.
    File(String),
}

struct Reader;

impl<'de> Visitor<'de> for Reader {
    type Value = SpectrumSource;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a spectrum: a number, the name of one, [[nm, value], …] or { file = \"…\" }")
    }

    fn visit_f64<E>(self, value: f64) -> Result<Self::Value, E> {
        Ok(SpectrumSource::Constant(value))
    }

    fn visit_i64<E>(self, value: i64) -> Result<Self::Value, E> {
        #[expect(clippy::cast_precision_loss, reason = "a reflectance or a factor")]
        let value = value as f64;
        Ok(SpectrumSource::Constant(value))
    }

    fn visit_str<E>(self, name: &str) -> Result<Self::Value, E> {
        Ok(SpectrumSource::Named(name.to_owned()))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut items: A) -> Result<Self::Value, A::Error> {
        let mut table: Vec<[f64; 2]> = Vec::new();
        while let Some(pair) = items.next_element::<[f64; 2]>()? {
            if table.last().is_some_and(|last| pair[0] <= last[0]) {
                return Err(A::Error::custom(format!(
                    "found {} nm behind a greater one; expected ascending wavelengths",
                    pair[0]
                )));
            }
            table.push(pair);
        }
        if table.len() < 2 {
            return Err(A::Error::custom("expected at least two pairs [nm, value]"));
        }
        Ok(SpectrumSource::Table(table))
    }

    fn visit_map<A: MapAccess<'de>>(self, mut entries: A) -> Result<Self::Value, A::Error> {
        let mut file = None;
        while let Some(key) = entries.next_key::<String>()? {
            if key != "file" {
                return Err(A::Error::unknown_field(&key, &["file"]));
            }
            file = Some(entries.next_value()?);
        }
        file.map(SpectrumSource::File).ok_or_else(|| A::Error::missing_field("file"))
    }
}

impl<'de> Deserialize<'de> for SpectrumSource {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(Reader)
    }
}

impl JsonSchema for SpectrumSource {
    fn schema_name() -> Cow<'static, str> {
        "Spectrum".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "description": "A number, the name of a spectrum of the scene or of a known source, a table [[nm, value], …], or a file.",
            "oneOf": [
                { "type": "number" },
                { "type": "string", "examples": ["D65", "LED-B3", "blackbody:2856K"] },
                { "type": "array", "minItems": 2, "items": { "type": "array", "items": { "type": "number" }, "minItems": 2, "maxItems": 2 } },
                { "type": "object", "properties": { "file": { "type": "string" } }, "required": ["file"], "additionalProperties": false }
            ]
        })
    }
}
