//! ANSI/IES TM-27-14 `.spdx`: XML with one spectral distribution, wavelengths in nm.
//!
//! The standard fixes the unit of each `SpectralQuantity`: flux W/nm, intensity W/(sr·nm), irradiance and exitance W/(m²·nm),
//! radiance W/(m²·sr·nm). Relative values, reflectance, transmittance, absorptance, R-factor and T-factor are ratios.

use roxmltree::{Document, Node};

use super::super::{Quantity, SpectralUnit};
use super::error::{Error, ErrorKind};
use super::instrument::{self, Samples};
use super::text::place;
use super::{Entry, Format, ReadOptions, SpectrumFile};
use crate::finding::{Checked, Finding, Location};

/// Whether a text is XML, of whatever kind: no other format here is.
pub(super) fn matches(head: &str) -> bool {
    head.trim_start().starts_with('<')
}

pub(super) fn read(text: &str, options: &ReadOptions) -> Result<Checked<SpectrumFile>, Error> {
    let document = Document::parse(text).map_err(|error| {
        let at = error.pos();
        Error::at(at.row.into(), at.col.into(), ErrorKind::Xml { message: without_place(&error.to_string()) })
    })?;
    let reader = Reader { text, options, line_starts: text.match_indices('\n').map(|(at, _)| at + 1).collect() };
    let root = document.root_element();
    if root.tag_name().name() != "IESTM2714" {
        let found = format!("the element <{}>", root.tag_name().name());
        let kind = ErrorKind::Unexpected { found, expected: "<IESTM2714>".to_owned() };
        return Err(Error::new(reader.place(root), kind));
    }
    let mut metadata = Vec::new();
    for node in child(root, "Header").into_iter().flat_map(|header| header.children()).filter(Node::is_element) {
        metadata.push((node.tag_name().name().to_owned(), content(node).to_owned()));
    }
    let name = ["Description", "CatalogNumber"].iter().find_map(|key| {
        metadata
            .iter()
            .find(|(k, value)| k == key && !value.is_empty() && value != "N/A")
            .map(|(_, value)| value.clone())
    });
    let mut findings = Vec::new();
    let mut entries = Vec::new();
    for node in root.children().filter(|n| n.has_tag_name_local("SpectralDistribution")) {
        let mut entry = reader.distribution(node, &mut findings)?;
        entry.name = name.clone().unwrap_or_default();
        entry.metadata.splice(0..0, metadata.iter().cloned());
        entries.push(entry);
    }
    if entries.is_empty() {
        let expected = "a <SpectralDistribution> in <IESTM2714>";
        return Err(Error::new(reader.place(root), ErrorKind::NoSpectrum { expected }));
    }
    Ok(Checked { value: SpectrumFile { format: Format::Tm27, entries, metadata: Vec::new() }, findings })
}

/// The message of the XML parser without the place at its end, which the error carries already.
fn without_place(message: &str) -> String {
    message.rsplit_once(" at ").map_or(message, |(text, _)| text).to_owned()
}

/// Comparison of local names: files carry the namespace `iestm2714` or none.
trait LocalName {
    fn has_tag_name_local(&self, name: &str) -> bool;
}

impl LocalName for Node<'_, '_> {
    fn has_tag_name_local(&self, name: &str) -> bool {
        self.is_element() && self.tag_name().name() == name
    }
}

fn child<'a, 'i>(node: Node<'a, 'i>, name: &str) -> Option<Node<'a, 'i>> {
    node.children().find(|n| n.has_tag_name_local(name))
}

fn content<'a>(node: Node<'a, '_>) -> &'a str {
    node.text().unwrap_or_default().trim()
}

struct Reader<'a> {
    text: &'a str,
    options: &'a ReadOptions,
    /// Where the second line begins, the third, and so on.
    line_starts: Vec<usize>,
}

impl Reader<'_> {
    fn place(&self, node: Node<'_, '_>) -> Location {
        place(self.text, 1, node.range().start)
    }

    /// Where the text of an element begins.
    fn content_place(&self, node: Node<'_, '_>) -> Location {
        let Some(inside) = node.first_child() else { return self.place(node) };
        let start = inside.range().start;
        let blank = self.text.get(start..).map_or(0, |rest| rest.len() - rest.trim_start().len());
        place(self.text, 1, start + blank)
    }

    fn distribution(&self, node: Node<'_, '_>, findings: &mut Vec<Finding>) -> Result<Entry, Error> {
        let mut samples = Samples::default();
        let mut metadata = Vec::new();
        let (mut quantity, mut unit) = (None, None);
        for part in node.children().filter(Node::is_element) {
            match part.tag_name().name() {
                "SpectralData" => {
                    let (nm, value) = self.sample(part)?;
                    let line = 1 + self.line_starts.partition_point(|start| *start <= part.range().start) as u64;
                    samples.push(nm, value, line, || self.place(part))?;
                }
                "SpectralQuantity" => (quantity, unit) = self.quantity(part, findings),
                other => metadata.push((other.to_owned(), content(part).to_owned())),
            }
        }
        if samples.values.is_empty() {
            let expected = "<SpectralData wavelength=\"…\"> in <SpectralDistribution>";
            return Err(Error::new(self.place(node), ErrorKind::NoSpectrum { expected }));
        }
        let location = self.place(node);
        let spectrum = samples.in_nm(self.options, findings)?;
        Ok(Entry {
            name: String::new(),
            spectrum,
            standard: None,
            quantity,
            unit,
            printed: Vec::new(),
            metadata,
            location,
        })
    }

    fn sample(&self, node: Node<'_, '_>) -> Result<(f64, f64), Error> {
        let Some(attribute) = node.attribute_node("wavelength") else {
            let kind = ErrorKind::Unexpected {
                found: "<SpectralData> without wavelength".to_owned(),
                expected: "<SpectralData wavelength=\"380\">".to_owned(),
            };
            return Err(Error::new(self.place(node), kind));
        };
        let start = || place(self.text, 1, attribute.range_value().start);
        let nm = instrument::number(attribute.value().trim(), '.', "wavelength", start)?;
        let value = instrument::number(content(node), '.', "value", || self.content_place(node))?;
        Ok((nm, value))
    }

    fn quantity(&self, node: Node<'_, '_>, findings: &mut Vec<Finding>) -> (Option<Quantity>, Option<SpectralUnit>) {
        let word = content(node).to_lowercase();
        let quantity = match word.as_str() {
            "flux" => Quantity::Flux,
            "intensity" => Quantity::Intensity,
            "irradiance" => Quantity::Irradiance,
            "radiance" => Quantity::Radiance,
            "exitance" => Quantity::Exitance,
            "relative" | "reflectance" | "transmittance" | "absorptance" | "r-factor" | "t-factor" => {
                return (Some(Quantity::Relative), None);
            }
            "other" | "" => return (None, None),
            _ => {
                let message = format!("`{word}` is no SpectralQuantity of TM-27-14; no quantity taken");
                findings.push(Finding::warning("S006", message).at(self.content_place(node)));
                return (None, None);
            }
        };
        let unit = super::resolve::si_per_nm(quantity);
        let message =
            format!("{quantity} in {unit} by the definition of TM-27-14, which carries no total to check it by");
        findings.push(Finding::info("S007", message).at(self.content_place(node)));
        (Some(quantity), unit.parse().ok())
    }
}
