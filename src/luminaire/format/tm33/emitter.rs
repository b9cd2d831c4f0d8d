//! One `Emitter` element.

use roxmltree::Node;

use super::super::error::{Error, ErrorKind};
use super::xml;
use super::{EmissionArea, Emitter, EmitterSpectral, Face, table};
use crate::finding::Finding;
use crate::luminaire::Kind;
use crate::spectrum::{Grid, Spectrum};

/// Elements whose content becomes a field of [`Emitter`].
const FIELDS: [&str; 20] = [
    "Quantity",
    "Description",
    "CatalogNumber",
    "RatedLumens",
    "MeasuredLumens",
    "InputWattage",
    "InputWatts",
    "FixedCCT",
    "CCT",
    "LuminousData",
    "RadiantData",
    "PhotonData",
    "IntensityDistribution",
    "SpectralData",
    "SpectralDistribution",
    "EmissionAreas",
    "IllumData",
    "IrradData",
    "PFDData",
    "SpecIrradData",
];

pub(super) fn emitter(node: Node<'_, '_>, findings: &mut Vec<Finding>) -> Result<Emitter, Error> {
    let text = |name: &'static str| xml::child(node, &[name]).map(xml::text).unwrap_or_default().to_owned();
    let colour = xml::child(node, &["ColorTemperature"]).unwrap_or(node);
    let rendering = xml::child(node, &["ColorRendering"]);
    let cri = rendering.map(|r| xml::child(r, &["CIE_CRI"]).unwrap_or(r));
    let mut emitter = Emitter {
        quantity: xml::optional(node, &["Quantity"])?,
        description: text("Description"),
        catalogue_number: text("CatalogNumber"),
        rated_lumens: xml::optional(node, &["RatedLumens"])?,
        measured_lumens: xml::optional(node, &["MeasuredLumens"])?,
        input_power_w: xml::optional(node, &["InputWattage", "InputWatts"])?,
        cct_k: xml::optional(colour, &["FixedCCT", "CCT"])?,
        ra: cri.map(|cri| xml::optional(cri, &["Ra"])).transpose()?.flatten(),
        ..Emitter::default()
    };
    for part in node.children().filter(Node::is_element) {
        match xml::name(part) {
            "LuminousData" => intensity(part, Kind::Luminous, &mut emitter, findings)?,
            "RadiantData" => intensity(part, Kind::Radiant, &mut emitter, findings)?,
            "PhotonData" => intensity(part, Kind::Photon, &mut emitter, findings)?,
            "IntensityDistribution" => {
                let kind = metric(part)?;
                intensity(part, kind, &mut emitter, findings)?;
            }
            "SpectralData" => spectral_data(part, &mut emitter, findings)?,
            "SpectralDistribution" => spectral_distribution(part, &mut emitter, findings)?,
            "EmissionAreas" => areas(part, &mut emitter.areas)?,
            // Illuminance and the like at points of planes: values without end, of which only the presence is kept.
            "IllumData" | "IrradData" | "PFDData" | "SpecIrradData" | "AngularColor" => {
                emitter.others.push((xml::name(part).to_owned(), String::new()));
            }
            name if !FIELDS.contains(&name) => {
                let mut leaves = Vec::new();
                xml::leaves(part, name, &mut leaves);
                if part.children().any(|n| n.is_element()) {
                    emitter.others.extend(leaves);
                } else {
                    emitter.others.push((name.to_owned(), xml::text(part).to_owned()));
                }
            }
            _ => {}
        }
    }
    Ok(emitter)
}

/// `Metric` of the variant's `IntensityDistribution`.
fn metric(node: Node<'_, '_>) -> Result<Kind, Error> {
    let Some(metric) = xml::child(node, &["Metric"]) else { return Ok(Kind::Luminous) };
    match xml::word(metric).to_lowercase().as_str() {
        "" | "luminous" => Ok(Kind::Luminous),
        "radiant" => Ok(Kind::Radiant),
        "photon" => Ok(Kind::Photon),
        found => Err(Error::new(
            xml::place(metric),
            ErrorKind::OutOfRange {
                found: format!("`{found}`"),
                field: "<Metric>".to_owned(),
                expected: "Luminous, Radiant or Photon".to_owned(),
            },
        )),
    }
}

/// A table with the flux and the wavelengths that stand beside it.
fn intensity(data: Node<'_, '_>, kind: Kind, to: &mut Emitter, findings: &mut Vec<Finding>) -> Result<(), Error> {
    let (inner, flux): (&[&str], &[&str]) = match kind {
        Kind::Luminous => (&["LuminousIntensity"], &["LuminousFlux"]),
        Kind::Radiant => (&["RadiantIntensity"], &["RadiantFlux"]),
        Kind::Photon => (&["PhotonIntensity"], &["PhotonFlux"]),
    };
    if to.intensities.iter().any(|t| t.kind == kind) {
        let kind = ErrorKind::Contradiction {
            first: format!("<{}>", xml::name(data)),
            second: "an intensity of the same kind in the same emitter".to_owned(),
        };
        return Err(Error::new(xml::place(data), kind));
    }
    let mut table = table::intensity(xml::child(data, inner).unwrap_or(data), kind, findings)?;
    table.flux = xml::optional(data, flux)?.filter(|f| *f > 0.0);
    let ends = (xml::optional(data, &["MinWavelength"])?, xml::optional(data, &["MaxWavelength"])?);
    if let (Some(low), Some(high)) = ends {
        table.wavelength_range_nm = (high > low && low > 0.0).then_some((low, high));
    }
    to.intensities.push(table);
    Ok(())
}

fn spectral_data(data: Node<'_, '_>, to: &mut Emitter, findings: &mut Vec<Finding>) -> Result<(), Error> {
    for node in xml::children(data, "EmitterSpectral") {
        let name = xml::child(node, &["EmitterName"]).map(xml::text).unwrap_or_default().to_owned();
        let (wavelengths, values, normalized) = table::power(node, findings)?;
        let spectrum = spectrum(node, wavelengths, values)?;
        to.spectra.push(EmitterSpectral { name, normalized, spectrum });
    }
    if let Some(node) = xml::child(data, &["AngularSpectral"]) {
        to.angular_spectral = Some(table::angular_spectral(node, findings)?);
    }
    Ok(())
}

/// The variant's lists, `Wavelengths` (or start and interval) and `Values`; or elements as in the schema.
fn spectral_distribution(data: Node<'_, '_>, to: &mut Emitter, findings: &mut Vec<Finding>) -> Result<(), Error> {
    let list = |name: &'static str| -> Result<Option<Vec<f64>>, Error> {
        let Some(node) = xml::child(data, &[name]) else { return Ok(None) };
        let items = xml::text(node).split(|c: char| c.is_whitespace() || c == ',').filter(|t| !t.is_empty());
        items.map(|t| xml::finite(node, t, name)).collect::<Result<Vec<f64>, _>>().map(Some)
    };
    let relative = xml::child(data, &["Units"]).is_none_or(|n| xml::word(n).eq_ignore_ascii_case("relative"));
    let (wavelengths, values) = match (list("Wavelengths")?, list("Values")?) {
        (Some(wavelengths), Some(values)) => (wavelengths, values),
        (None, Some(values)) => {
            let start = xml::optional(data, &["StartWavelength"])?;
            let step = xml::optional(data, &["WavelengthInterval"])?;
            let (Some(start), Some(step)) = (start, step) else {
                let kind = ErrorKind::Unexpected {
                    found: "<Values> without wavelengths".to_owned(),
                    expected: "<Wavelengths>, or <StartWavelength> and <WavelengthInterval>".to_owned(),
                };
                return Err(Error::new(xml::place(data), kind));
            };
            ((0..values.len()).map(|i| start + step * i as f64).collect(), values)
        }
        _ => {
            let (wavelengths, values, _) = table::power(data, findings)?;
            (wavelengths, values)
        }
    };
    let spectrum = spectrum(data, wavelengths, values)?;
    to.spectra.push(EmitterSpectral { name: String::new(), normalized: Some(relative), spectrum });
    Ok(())
}

fn spectrum(node: Node<'_, '_>, wavelengths: Vec<f64>, values: Vec<f64>) -> Result<Spectrum, Error> {
    let made = Grid::new(wavelengths).and_then(|grid| Spectrum::density(grid, values));
    made.map_err(|error| {
        let kind = ErrorKind::OutOfRange {
            found: error.to_string(),
            field: format!("the spectrum in <{}>", xml::name(node)),
            expected: "ascending wavelengths with one value each".to_owned(),
        };
        Error::new(xml::place(node), kind)
    })
}

fn areas(node: Node<'_, '_>, out: &mut Vec<EmissionArea>) -> Result<(), Error> {
    for face in node.children().filter(Node::is_element) {
        let (side, area, [along, across]): (Face, &'static str, [&str; 2]) = match xml::name(face) {
            "TopFace" => (Face::Top, "TopArea", ["Length", "Width"]),
            "BottomFace" => (Face::Bottom, "BottomArea", ["Length", "Width"]),
            "C0Face" => (Face::Side(0), "C0Area", ["Length", "Height"]),
            "C90Face" => (Face::Side(90), "C90Area", ["Width", "Height"]),
            "C180Face" => (Face::Side(180), "C180Area", ["Length", "Height"]),
            "C270Face" => (Face::Side(270), "C270Area", ["Width", "Height"]),
            _ => continue,
        };
        for node in xml::children(face, area) {
            let of = |name: &str| xml::optional(node, &[name]).map(Option::unwrap_or_default);
            out.push(EmissionArea {
                face: side,
                along: of(along)?,
                across: of(across)?,
                offsets: (of(&format!("{along}Offset"))?, of(&format!("{across}Offset"))?),
                circular: xml::boolean(node, &["Circular"])?.unwrap_or(false),
            });
        }
    }
    Ok(())
}
