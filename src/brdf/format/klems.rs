//! WINDOW and Radiance XML: matrices over the Klems patches ([`Patches`]), reflection and transmission from both sides.
//!
//! Whatever stands before the XML declaration (a line that a program printed into the file) is left out and reported. Matrices in
//! a basis of `AngleBasisBlock`s are read; tensor trees are refused by name. With `IncidentDataStructure` `Columns` a column is an
//! incident patch.

use roxmltree::{Document, Node};

use super::error::{Error, ErrorKind};
use super::text::decode;
use crate::brdf::table::{Channel, Patches, Ring};
use crate::finding::{Checked, Finding, Location};

/// One matrix of a file.
#[derive(Debug, Clone, PartialEq)]
pub struct Block {
    /// `Visible`, `Solar`, …
    pub wavelength: String,
    /// `Reflection Front`, `Transmission Back`, …
    pub direction: String,
    /// The matrix, one channel.
    pub patches: Patches,
}

/// Reads all matrices of a file, in its order.
///
/// # Errors
/// [`Error`] with the place of what is missing, no number, or of another basis.
pub fn parse(bytes: &[u8]) -> Result<Checked<Vec<Block>>, Error> {
    let (text, assumed) = decode(bytes);
    let mut findings: Vec<Finding> = assumed.into_iter().collect();
    let start = text.find("<?xml").or_else(|| text.find('<')).unwrap_or(0);
    let (before, xml) = text.split_at(start);
    if !before.trim().is_empty() {
        let first: String = before.trim().chars().take(60).collect();
        let words = format!("`{first}` stands before the XML declaration and was left out");
        findings.push(Finding::warning("B102", words).at(Location::line(1)));
    }
    let lines = before.matches('\n').count() as u64;
    let blocks = document(xml).map_err(|e| e.below(lines))?;
    Ok(Checked { value: blocks, findings })
}

fn document(xml: &str) -> Result<Vec<Block>, Error> {
    let document = Document::parse(xml).map_err(|error| {
        let at = error.pos();
        let message = error.to_string();
        let message = message.rsplit_once(" at ").map_or(message.as_str(), |(words, _)| words).to_owned();
        Error::at(at.row.into(), at.col.into(), ErrorKind::Xml { message })
    })?;
    let root = document.root_element();
    let named = |name: &'static str| root.descendants().filter(move |n| n.has_tag_name_of(name));
    let structure = named("IncidentDataStructure").next().map_or("Columns", text_of);
    if !matches!(structure, "Columns" | "Rows") {
        let kind = ErrorKind::unexpected(format!("IncidentDataStructure {structure}"), "Columns or Rows (matrices)");
        return Err(place(named("IncidentDataStructure").next().unwrap_or(root), kind));
    }
    let rings = named("AngleBasisBlock").map(ring).collect::<Result<Vec<_>, _>>()?;
    if rings.is_empty() {
        return Err(place(root, ErrorKind::unexpected("no <AngleBasisBlock>", "a basis of patches")));
    }
    let mut blocks = Vec::new();
    for data in named("WavelengthData") {
        let wavelength = child(data, "Wavelength").map_or("", text_of).to_owned();
        for block in data.children().filter(|n| n.has_tag_name_of("WavelengthDataBlock")) {
            blocks.push(read_block(block, &wavelength, &rings, structure == "Rows")?);
        }
    }
    Ok(blocks)
}

fn read_block(node: Node<'_, '_>, wavelength: &str, rings: &[Ring], transposed: bool) -> Result<Block, Error> {
    let data = child(node, "ScatteringData");
    let data = data.ok_or_else(|| place(node, ErrorKind::unexpected("no <ScatteringData>", "a matrix")))?;
    let mut values = Vec::new();
    for word in text_of(data).split(|c: char| c.is_whitespace() || c == ',').filter(|w| !w.is_empty()) {
        values.push(number(data, word, "<ScatteringData>")?);
    }
    let patches: usize = rings.iter().map(|r| r.sectors).fold(0, usize::saturating_add);
    if Some(values.len()) != patches.checked_mul(patches) {
        let found = format!("{} numbers in <ScatteringData>", values.len());
        return Err(place(data, ErrorKind::unexpected(found, format!("{patches} × {patches}"))));
    }
    if transposed {
        values = (0..values.len()).map(|i| values[i % patches * patches + i / patches]).collect();
    }
    let channel = Channel::Named(if wavelength.is_empty() { "Visible" } else { wavelength }.to_owned());
    let patches = Patches::new(rings.to_vec(), vec![channel], values).map_err(|e| place(node, e.into()))?;
    let direction = child(node, "WavelengthDataDirection").map_or("", text_of).to_owned();
    Ok(Block { wavelength: wavelength.to_owned(), direction, patches })
}

fn ring(node: Node<'_, '_>) -> Result<Ring, Error> {
    let of = |name: &'static str| {
        let found = node.descendants().find(|n| n.has_tag_name_of(name));
        found.ok_or_else(|| place(node, ErrorKind::unexpected(format!("no <{name}>"), "one in each <AngleBasisBlock>")))
    };
    let value = |name| of(name).and_then(|n| number(n, text_of(n), name));
    let sectors = of("nPhis")?;
    let count = text_of(sectors).parse().ok().filter(|n| (1..=10_000).contains(n));
    let count = count.ok_or_else(|| {
        place(sectors, ErrorKind::unexpected(format!("`{}` for <nPhis>", text_of(sectors)), "1 to 10000"))
    })?;
    Ok(Ring { lower_deg: value("LowerTheta")?, upper_deg: value("UpperTheta")?, sectors: count })
}

/// Elements by local name, whatever their namespace.
trait Named {
    fn has_tag_name_of(&self, name: &str) -> bool;
}

impl Named for Node<'_, '_> {
    fn has_tag_name_of(&self, name: &str) -> bool {
        self.is_element() && self.tag_name().name() == name
    }
}

fn child<'a, 'i>(node: Node<'a, 'i>, name: &str) -> Option<Node<'a, 'i>> {
    node.children().find(|n| n.has_tag_name_of(name))
}

fn text_of<'a>(node: Node<'a, '_>) -> &'a str {
    node.text().unwrap_or_default().trim()
}

fn number(node: Node<'_, '_>, word: &str, field: &str) -> Result<f64, Error> {
    word.parse::<f64>().ok().filter(|v| v.is_finite()).ok_or_else(|| {
        let found = word.chars().take(40).collect();
        place(node, ErrorKind::NotANumber { found, field: field.to_owned() })
    })
}

fn place(node: Node<'_, '_>, kind: ErrorKind) -> Error {
    let at = node.document().text_pos_at(node.range().start);
    Error::at(at.row.into(), at.col.into(), kind)
}
