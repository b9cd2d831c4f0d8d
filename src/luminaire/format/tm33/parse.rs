//! From bytes to [`Tm33`].

use roxmltree::Node;

use super::super::error::{Error, ErrorKind};
use super::super::text::{Text, decode, place};
use super::emitter::emitter;
use super::xml;
use super::{Goniometer, Schema, Tm33};
use crate::finding::{Checked, Finding};

/// Reads a TM-33 document.
///
/// # Errors
/// [`Error`] with line and column where the XML is broken, the document is another, a value is missing, no finite number or given
/// twice, or counts contradict the values.
pub fn parse(bytes: &[u8]) -> Result<Checked<Tm33>, Error> {
    parse_text(&decode(bytes)?)
}

/// The same from text.
pub(in super::super) fn parse_text(text: &Text<'_>) -> Result<Checked<Tm33>, Error> {
    // XML declarations may only stand at the very start.
    let content = text.text.trim_start();
    let skipped = &text.text[..text.text.len() - content.len()];
    let lines_before = place(skipped, skipped.len()).line.map_or(0, |line| line - 1);
    read(content, text.finding.clone()).map_err(|error| error.below(lines_before))
}

fn read(content: &str, encoding: Option<Finding>) -> Result<Checked<Tm33>, Error> {
    let document = xml::document(content)?;
    let root = document.root_element();
    let schema = match xml::name(root) {
        "IESTM33" | "IESTM33-18" => Schema::Tm33Of2018,
        "IESTM33-22" | "IESTM33-23" => Schema::Tm33Of2023,
        "LuminaireOpticalData" => Schema::OpticalData,
        name if name.starts_with("ATLA_S001") || name.starts_with("ATLA-S001") => Schema::AtlaS001,
        name if name.starts_with("UNI11733") => Schema::Uni11733,
        name => {
            let kind = ErrorKind::Unexpected {
                found: format!("the element <{name}>"),
                expected: "<IESTM33-22>, <IESTM33>, <ATLA_S001_A>, <UNI11733> or <LuminaireOpticalData>".to_owned(),
            };
            return Err(Error::new(xml::place(root), kind));
        }
    };
    let mut findings: Vec<Finding> = encoding.into_iter().collect();
    let mut header = Vec::new();
    if let Some(node) = xml::child(root, &["Header"]) {
        xml::leaves(node, "", &mut header);
    }
    let mut equipment = Vec::new();
    let equipment_node = xml::child(root, &["Equipment"]);
    if let Some(node) = equipment_node {
        xml::leaves(node, "", &mut equipment);
    }
    let mut emitters = Vec::new();
    for node in xml::children(root, "Emitter") {
        emitters.push(emitter(node, &mut findings)?);
    }
    if emitters.is_empty() {
        let kind = ErrorKind::Unexpected {
            found: format!("<{}> without <Emitter>", xml::name(root)),
            expected: "an <Emitter> with its intensities".to_owned(),
        };
        return Err(Error::new(xml::place(root), kind));
    }
    let variant = root.descendants().find(|n| {
        n.is_element() && matches!(xml::name(*n), "IntensityData" | "IntensityDistribution" | "SpectralDistribution")
    });
    if let Some(node) = variant {
        let message = format!(
            "<{}> stands in none of the published schemas; read as the `LuminaireOpticalData` variant",
            xml::name(node)
        );
        findings.push(Finding::info("L301", message).at(xml::place(node)));
    }
    let luminaire = xml::child(root, &["Luminaire"]);
    let shape = luminaire.and_then(|node| {
        xml::child(node, &["Shape"])
            .or_else(|| xml::child(node, &["Dimensions"]).and_then(|d| xml::child(d, &["Shape"])))
    });
    let value = Tm33 {
        schema,
        version: xml::child(root, &["Version"])
            .map(xml::text)
            .or_else(|| root.attribute("version"))
            .unwrap_or_default()
            .to_owned(),
        header,
        dimensions: luminaire.map(dimensions).transpose()?.flatten(),
        shape: shape.map(xml::word).filter(|w| !w.is_empty()),
        openings: luminaire.map(openings).transpose()?.unwrap_or_default(),
        goniometer: equipment_node.and_then(goniometer),
        equipment,
        emitters,
        custom: custom(root),
    };
    findings.extend(missing(&value));
    Ok(Checked { value, findings })
}

fn dimensions(luminaire: Node<'_, '_>) -> Result<Option<[f64; 3]>, Error> {
    let Some(node) = xml::child(luminaire, &["Dimensions"]) else { return Ok(None) };
    let of = |name: &str| xml::optional(node, &[name]).map(Option::unwrap_or_default);
    Ok(Some([of("Length")?, of("Width")?, of("Height")?]))
}

/// `LuminousOpening` of the variant.
fn openings(luminaire: Node<'_, '_>) -> Result<Vec<(bool, f64, f64)>, Error> {
    let mut out = Vec::new();
    for node in xml::children(luminaire, "LuminousOpening") {
        let sizes = xml::child(node, &["Dimensions"]).unwrap_or(node);
        let of = |name: &str| xml::optional(sizes, &[name]).map(Option::unwrap_or_default);
        let word = xml::child(node, &["Shape"]).map(xml::word).unwrap_or_default().to_lowercase();
        let round = word.starts_with("circ") || word.starts_with("ellip") || word.starts_with("round");
        let (length, width, diameter) = (of("Length")?, of("Width")?, of("Diameter")?);
        out.push(if diameter > 0.0 { (true, diameter, diameter) } else { (round, length, width) });
    }
    Ok(out)
}

fn goniometer(equipment: Node<'_, '_>) -> Option<Goniometer> {
    let node = xml::child(equipment, &["Gonioradiometer", "Goniometer"])?;
    let word = xml::word(xml::child(node, &["Type", "GoniometerType"])?).to_uppercase();
    Some(
        match word
            .trim_start_matches("CIE")
            .trim_start_matches("IES")
            .trim_start_matches("TYPE")
            .trim_start_matches('_')
        {
            "A" => Goniometer::A,
            "B" => Goniometer::B,
            "C" => Goniometer::C,
            _ => Goniometer::Custom,
        },
    )
}

fn custom(root: Node<'_, '_>) -> Vec<(String, String)> {
    let text = |node: Node<'_, '_>, name: &str| xml::child(node, &[name]).map(xml::text).unwrap_or_default().to_owned();
    xml::children(root, "CustomData").map(|node| (text(node, "Name"), text(node, "UniqueIdentifier"))).collect()
}

/// What the schema requires and the file lacks.
fn missing(file: &Tm33) -> Option<Finding> {
    if file.schema == Schema::OpticalData {
        return None;
    }
    let required = ["Description", "Laboratory", "ReportNumber", "ReportDate"];
    let mut lacking: Vec<&str> = required
        .into_iter()
        .filter(|name| !file.header.iter().any(|(key, text)| key == name && !text.is_empty()))
        .collect();
    if file.emitters.iter().any(|e| e.input_power_w.is_none()) {
        lacking.push("InputWattage");
    }
    if file.emitters.iter().any(|e| e.quantity.is_none()) {
        lacking.push("Quantity");
    }
    (!lacking.is_empty()).then(|| {
        Finding::info("L315", format!("the schema requires elements that are missing: {}", lacking.join(", ")))
    })
}
