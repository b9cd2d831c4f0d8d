//! Tables over two angles, and wavelength, from elements in any order: every combination once.

use roxmltree::Node;

use super::super::error::{Error, ErrorKind};
use super::xml;
use super::{AngularSpectral, IntensityTable, Symm};
use crate::finding::Finding;
use crate::luminaire::Kind;

/// Angles and wavelengths nearer than this are the same.
const SAME: f64 = 1e-6;
const H: &[&str] = &["h", "horz", "horizontal"];
const V: &[&str] = &["v", "vert", "vertical"];
const W: &[&str] = &["w"];
const DATA: &[&str] = &["IntData", "IntensityData"];

/// A table in the order plane, row, wavelength.
struct Block {
    axes: Vec<Vec<f64>>,
    values: Vec<f64>,
}

fn block(parent: Node<'_, '_>, attributes: &[&[&str]]) -> Result<Block, Error> {
    let mut keys: Vec<f64> = Vec::new();
    let mut given: Vec<(Node<'_, '_>, f64)> = Vec::new();
    for node in parent.children().filter(|n| n.is_element() && DATA.contains(&xml::name(*n))) {
        for names in attributes {
            keys.push(xml::attribute(node, names)?);
        }
        given.push((node, xml::number(node)?));
    }
    if given.is_empty() {
        let kind = ErrorKind::Unexpected {
            found: format!("<{}> without a value", xml::name(parent)),
            expected: "<IntData> elements in it".to_owned(),
        };
        return Err(Error::new(xml::place(parent), kind));
    }
    let dimensions = attributes.len();
    let axes: Vec<Vec<f64>> = (0..dimensions)
        .map(|axis| {
            let mut values: Vec<f64> = keys.iter().skip(axis).step_by(dimensions).copied().collect();
            values.sort_by(f64::total_cmp);
            values.dedup_by(|a, b| (*a - *b).abs() <= SAME);
            values
        })
        .collect();
    let size = axes.iter().try_fold(1_usize, |product, axis| product.checked_mul(axis.len()));
    let counts = axes.iter().map(|a| a.len().to_string()).collect::<Vec<_>>().join(" × ");
    if size != Some(given.len()) {
        let names = attributes.iter().map(|a| a[0]).collect::<Vec<_>>().join(", ");
        return Err(Error::new(
            xml::place(parent),
            ErrorKind::Contradiction {
                first: format!("{} values", given.len()),
                second: format!("{counts} different {names}"),
            },
        )
        .with_hint("each combination of angles (and wavelength) needs one value"));
    }
    let mut values = vec![f64::NAN; given.len()];
    for (i, (node, value)) in given.iter().enumerate() {
        let mut index = 0;
        for (axis, key) in axes.iter().zip(&keys[i * dimensions..]) {
            index = index * axis.len() + axis.partition_point(|a| *a < key - SAME).min(axis.len() - 1);
        }
        if !values[index].is_nan() {
            let at =
                keys[i * dimensions..(i + 1) * dimensions].iter().map(f64::to_string).collect::<Vec<_>>().join(", ");
            let kind = ErrorKind::OutOfRange {
                found: format!("a second value at ({at})"),
                field: format!("<{}>", xml::name(*node)),
                expected: "each direction once".to_owned(),
            };
            return Err(Error::new(xml::place(*node), kind));
        }
        values[index] = *value;
    }
    Ok(Block { axes, values })
}

/// A stated count against the one found.
fn counted(parent: Node<'_, '_>, element: &'static str, found: usize) -> Result<(), Error> {
    let Some(node) = xml::child(parent, &[element]) else { return Ok(()) };
    let stated = xml::number(node)?;
    if stated == found as f64 {
        return Ok(());
    }
    Err(Error::new(
        xml::place(node),
        ErrorKind::Contradiction {
            first: format!("<{element}> of {stated}"),
            second: format!("{found} in the values"),
        },
    )
    .with_hint("correct the count, or complete the values"))
}

/// The same, where it makes a finding only.
fn noted(parent: Node<'_, '_>, element: &'static str, found: usize, out: &mut Vec<Finding>) -> Result<(), Error> {
    let Some(node) = xml::child(parent, &[element]) else { return Ok(()) };
    let stated = xml::number(node)?;
    if stated != found as f64 {
        let message = format!("<{element}> is {stated}, but {found} are given; those given were taken");
        out.push(Finding::warning("L304", message).at(xml::place(node)));
    }
    Ok(())
}

fn multiplier(parent: Node<'_, '_>) -> Result<f64, Error> {
    let Some(value) = xml::optional(parent, &["Multiplier"])? else { return Ok(1.0) };
    if value > 0.0 {
        return Ok(value);
    }
    let kind = ErrorKind::OutOfRange {
        found: value.to_string(),
        field: "<Multiplier>".to_owned(),
        expected: "a number above 0".to_owned(),
    };
    Err(Error::new(xml::place(parent), kind))
}

fn symmetry(parent: Node<'_, '_>) -> Result<Option<Symm>, Error> {
    let Some(node) = xml::child(parent, &["Symm", "SymmType"]) else { return Ok(None) };
    let word = xml::word(node);
    Ok(Some(match word.to_lowercase().replace('_', "").as_str() {
        "" => return Ok(None),
        "symmnone" => Symm::None,
        "symmbi0" => Symm::Bi0,
        "symmbi90" => Symm::Bi90,
        "symmquad" => Symm::Quad,
        "symmfull" => Symm::Full,
        "symmarbitrary" => Symm::Arbitrary,
        _ => {
            return Err(Error::new(
                xml::place(node),
                ErrorKind::OutOfRange {
                    found: format!("`{word}`"),
                    field: format!("<{}>", xml::name(node)),
                    expected: "Symm_None, Symm_Bi_0, Symm_Bi_90, Symm_Quad, Symm_Full or Symm_Arbitrary".to_owned(),
                },
            ));
        }
    }))
}

/// The table in a `…Intensity` element (or, in the variant, in `…Data` itself).
pub(super) fn intensity(
    parent: Node<'_, '_>,
    kind: Kind,
    findings: &mut Vec<Finding>,
) -> Result<IntensityTable, Error> {
    let Block { mut axes, values } = block(parent, &[H, V])?;
    let (vertical_deg, horizontal_deg) = (axes.pop().unwrap_or_default(), axes.pop().unwrap_or_default());
    counted(parent, "NumberHorz", horizontal_deg.len())?;
    counted(parent, "NumberVert", vertical_deg.len())?;
    noted(parent, "NumberMeasured", values.len(), findings)?;
    Ok(IntensityTable {
        kind,
        absolute: xml::boolean(parent, &["AbsolutePhotometry", "Absolute"])?,
        symmetry: symmetry(parent)?,
        multiplier: multiplier(parent)?,
        horizontal_deg,
        vertical_deg,
        values,
        flux: None,
        wavelength_range_nm: None,
        location: xml::place(parent),
    })
}

/// The table in an `AngularSpectral` element.
pub(super) fn angular_spectral(parent: Node<'_, '_>, findings: &mut Vec<Finding>) -> Result<AngularSpectral, Error> {
    let Block { mut axes, values } = block(parent, &[H, V, W])?;
    let wavelengths_nm = axes.pop().unwrap_or_default();
    let (vertical_deg, horizontal_deg) = (axes.pop().unwrap_or_default(), axes.pop().unwrap_or_default());
    counted(parent, "NumberHorz", horizontal_deg.len())?;
    counted(parent, "NumberVert", vertical_deg.len())?;
    counted(parent, "NumberWavelength", wavelengths_nm.len())?;
    // Directions or values: the standard's word fits both.
    let directions = horizontal_deg.len() * vertical_deg.len();
    if xml::optional(parent, &["NumberMeasured"])? != Some(values.len() as f64) {
        noted(parent, "NumberMeasured", directions, findings)?;
    }
    if wavelengths_nm[0] <= 0.0 {
        let kind = ErrorKind::OutOfRange {
            found: format!("{} nm", wavelengths_nm[0]),
            field: "the wavelengths".to_owned(),
            expected: "wavelengths above 0 nm".to_owned(),
        };
        return Err(Error::new(xml::place(parent), kind));
    }
    Ok(AngularSpectral {
        absolute: xml::boolean(parent, &["Absolute"])?,
        symmetry: symmetry(parent)?,
        multiplier: multiplier(parent)?,
        horizontal_deg,
        vertical_deg,
        wavelengths_nm,
        values,
        location: xml::place(parent),
    })
}

/// Samples of a spectrum: wavelengths ascending, their values, and whether these are relative, where stated.
type Power = (Vec<f64>, Vec<f64>, Option<bool>);

/// Samples of `PwrData`, multiplier applied.
pub(super) fn power(parent: Node<'_, '_>, findings: &mut Vec<Finding>) -> Result<Power, Error> {
    let factor = multiplier(parent)?;
    let mut samples = Vec::new();
    for node in parent.children().filter(|n| n.is_element() && ["PwrData", "SpectralData"].contains(&xml::name(*n))) {
        samples.push((xml::attribute(node, W)?, xml::number(node)? * factor));
    }
    noted(parent, "NumberWavelength", samples.len(), findings)?;
    samples.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (wavelengths, values) = samples.into_iter().unzip();
    Ok((wavelengths, values, xml::boolean(parent, &["Normalized"])?))
}
