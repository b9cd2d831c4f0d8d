//! What the readers of XML elements share: children by local name, numbers, places.

use roxmltree::{Document, Node};

use super::super::error::{Error, ErrorKind};
use crate::finding::Location;

/// A parsed document.
pub(super) fn document(text: &str) -> Result<Document<'_>, Error> {
    Document::parse(text).map_err(|error| {
        let at = error.pos();
        let message = error.to_string();
        // The parser's words end with the place, which the error carries already.
        let message = message.rsplit_once(" at ").map_or(message.as_str(), |(words, _)| words).to_owned();
        Error::new(Location::at(at.row.into(), at.col.into()), ErrorKind::Xml { message })
            .with_hint("the file may be cut off or not be XML")
    })
}

pub(super) fn name<'a>(node: Node<'a, '_>) -> &'a str {
    node.tag_name().name()
}

pub(super) fn place(node: Node<'_, '_>) -> Location {
    let at = node.document().text_pos_at(node.range().start);
    Location::at(at.row.into(), at.col.into())
}

/// The child elements of a name, whatever their namespace.
pub(super) fn children<'a, 'i: 'a>(node: Node<'a, 'i>, of: &'static str) -> impl Iterator<Item = Node<'a, 'i>> {
    node.children().filter(move |n| n.is_element() && n.tag_name().name() == of)
}

/// The first child element of one of these names.
pub(super) fn child<'a, 'i>(node: Node<'a, 'i>, names: &[&str]) -> Option<Node<'a, 'i>> {
    node.children().find(|n| n.is_element() && names.contains(&n.tag_name().name()))
}

pub(super) fn text<'a>(node: Node<'a, '_>) -> &'a str {
    node.text().unwrap_or_default().trim()
}

/// The text without any blanks, as the schema's names had blanks put in by typesetting (`Symm _ None`).
pub(super) fn word(node: Node<'_, '_>) -> String {
    text(node).split_whitespace().collect()
}

/// A finite number out of a text that stands at a node.
pub(super) fn finite(node: Node<'_, '_>, text: &str, field: &str) -> Result<f64, Error> {
    match text.trim().parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value),
        parsed => {
            let (found, field) = (text.trim().chars().take(40).collect(), field.to_owned());
            // XML Schema writes infinity as INF.
            let not_finite = parsed.is_ok() || matches!(text.trim(), "INF" | "-INF");
            let kind =
                if not_finite { ErrorKind::NotFinite { found, field } } else { ErrorKind::NotANumber { found, field } };
            Err(Error::new(place(node), kind))
        }
    }
}

/// The number that an element holds.
pub(super) fn number(node: Node<'_, '_>) -> Result<f64, Error> {
    finite(node, text(node), &format!("<{}>", name(node)))
}

/// The number of a child element; an empty element counts as none.
pub(super) fn optional(node: Node<'_, '_>, names: &[&str]) -> Result<Option<f64>, Error> {
    child(node, names).filter(|n| !text(*n).is_empty()).map(number).transpose()
}

/// `xs:boolean` of a child element.
pub(super) fn boolean(node: Node<'_, '_>, names: &[&str]) -> Result<Option<bool>, Error> {
    let Some(node) = child(node, names) else { return Ok(None) };
    match word(node).to_lowercase().as_str() {
        "" => Ok(None),
        "true" | "1" => Ok(Some(true)),
        "false" | "0" => Ok(Some(false)),
        found => Err(Error::new(
            place(node),
            ErrorKind::OutOfRange {
                found: format!("`{found}`"),
                field: format!("<{}>", name(node)),
                expected: "true or false".to_owned(),
            },
        )),
    }
}

/// The number in an attribute, which may have one of several names.
pub(super) fn attribute(node: Node<'_, '_>, names: &[&str]) -> Result<f64, Error> {
    match node.attributes().find(|a| names.contains(&a.name())) {
        Some(attribute) => finite(node, attribute.value(), &format!("attribute `{}`", attribute.name())),
        None => Err(Error::new(
            place(node),
            ErrorKind::Unexpected {
                found: format!("<{}> without attribute `{}`", name(node), names[0]),
                expected: "an angle or wavelength in it".to_owned(),
            },
        )),
    }
}

/// All texts below a node: path of names, text.
pub(super) fn leaves(node: Node<'_, '_>, path: &str, out: &mut Vec<(String, String)>) {
    for child in node.children().filter(Node::is_element) {
        let path = if path.is_empty() { name(child).to_owned() } else { format!("{path}/{}", name(child)) };
        if child.children().any(|n| n.is_element()) {
            // Deeper than any schema goes: a file made to exhaust the stack.
            if path.len() < 1000 {
                leaves(child, &path, out);
            }
        } else {
            out.push((path, text(child).to_owned()));
        }
    }
}
