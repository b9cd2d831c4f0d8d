//! From the model to a TM-33-23 document.

use std::fmt::Write as _;

use super::super::error::Error;
use super::lexical::{date, digits, escaped, leading, rounded};
use crate::finding::{Checked, Finding};
use crate::luminaire::{AngularSpectra, Body, Distribution, Kind, LampSet, Luminaire, Shape, Symmetry, System};
use crate::spectrum::Sampling;

/// A TM-33-23 document (`<IESTM33-22>`, version 1.1), UTF-8, elements in the order of the schema. All intensities are absolute
/// values of the luminaire in one emitter; what the schema requires and the model does not know is filled in and said
/// (findings L390), keywords go into comments as `[LABEL] text`, which [`read`](super::read) understands.
///
/// # Errors
/// None so far: the format carries all that the model's distribution may be.
pub fn write(luminaire: &Luminaire) -> Result<Checked<String>, Error> {
    let mut out = Writer { text: String::new(), depth: 0, findings: Vec::new() };
    out.text.push_str("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n");
    out.open("IESTM33-22");
    out.leaf("Version", "1.1");
    out.header(luminaire);
    out.body(luminaire);
    out.open("Equipment");
    out.open("Gonioradiometer");
    out.leaf(
        "Type",
        match luminaire.distribution.system() {
            System::TypeA => "IES_A",
            System::TypeB => "IES_B",
            System::TypeC => "IES_C",
        },
    );
    out.close("Gonioradiometer");
    out.close("Equipment");
    out.emitter(luminaire);
    out.close("IESTM33-22");
    out.not_carried(luminaire);
    Ok(Checked { value: out.text, findings: out.findings })
}

struct Writer {
    text: String,
    depth: usize,
    findings: Vec<Finding>,
}

impl Writer {
    fn indent(&mut self) {
        self.text.extend(std::iter::repeat_n("  ", self.depth));
    }

    fn open(&mut self, name: &str) {
        self.indent();
        let _ = writeln!(self.text, "<{name}>");
        self.depth += 1;
    }

    fn close(&mut self, name: &str) {
        self.depth -= 1;
        self.indent();
        let _ = writeln!(self.text, "</{name}>");
    }

    fn leaf(&mut self, name: &str, content: &str) {
        self.indent();
        let _ = writeln!(self.text, "<{name}>{}</{name}>", escaped(content));
    }

    fn number(&mut self, name: &str, value: f64) {
        self.leaf(name, &digits(value));
    }

    fn filled(&mut self, name: &str, instead: &str) {
        let message = format!("<{name}> is required and not known; `{instead}` was written");
        self.findings.push(Finding::info("L390", message));
        self.leaf(name, instead);
    }

    fn header(&mut self, luminaire: &Luminaire) {
        let find = |label: &str| luminaire.keywords.iter().find(|(key, _)| key == label).map(|(_, text)| text.clone());
        self.open("Header");
        for (name, text) in [("Manufacturer", &luminaire.manufacturer), ("CatalogNumber", &luminaire.catalogue_number)]
        {
            if !text.is_empty() {
                self.leaf(name, text);
            }
        }
        let gtin = find("_GTIN").filter(|t| !t.is_empty() && t.bytes().all(|b| b.is_ascii_digit()));
        if let Some(gtin) = &gtin {
            self.leaf("GTIN", gtin);
        }
        let mut taken = vec!["TEST", "TESTLAB"];
        if gtin.is_some() {
            taken.push("_GTIN");
        }
        let required = [
            ("Description", Some(luminaire.name.clone())),
            ("Laboratory", find("TESTLAB")),
            ("ReportNumber", find("TEST")),
        ];
        for (name, text) in required {
            match text.filter(|t| !t.is_empty()) {
                Some(text) => self.leaf(name, &text),
                None => self.filled(name, super::UNKNOWN),
            }
        }
        match find("ISSUEDATE").as_deref().and_then(date) {
            Some(date) => {
                taken.push("ISSUEDATE");
                self.leaf("ReportDate", &date);
            }
            None => self.filled("ReportDate", super::NO_DATE),
        }
        for (label, name) in [("_DOCUMENTCREATOR", "DocumentCreator"), ("_UNIQUEIDENTIFIER", "UniqueIdentifier")] {
            if let Some(text) = find(label) {
                taken.push(label);
                self.leaf(name, &text);
            }
        }
        for (label, text) in luminaire.keywords.iter().filter(|(label, _)| !taken.contains(&label.as_str())) {
            let comment = if label == "OTHER" { text.clone() } else { format!("[{label}] {text}") };
            self.leaf("Comment", &comment);
        }
        self.close("Header");
    }

    fn body(&mut self, luminaire: &Luminaire) {
        let Some(body) = luminaire.housing else { return };
        self.open("Luminaire");
        self.open("Dimensions");
        self.number("Length", body.length_m);
        self.number("Width", body.width_m);
        self.number("Height", body.height_m);
        self.close("Dimensions");
        match body.shape {
            Shape::Round => self.leaf("Shape", "Align_Z"),
            Shape::CylinderAlongC0 => self.leaf("Shape", "Align_X"),
            Shape::CylinderAlongC90 => self.leaf("Shape", "Align_Y"),
            Shape::Rectangle => {}
            other => {
                let message = format!("housing: the shape {} was written as the box around it", other.name());
                self.findings.push(Finding::info("L390", message));
            }
        }
        self.leaf("NumEmitter", "1");
        self.close("Luminaire");
    }

    fn emitter(&mut self, luminaire: &Luminaire) {
        let unknown = LampSet::default();
        let lamps = luminaire.lamps.first().unwrap_or(&unknown);
        self.open("Emitter");
        self.leaf("Quantity", &lamps.count.map_or(1.0, |n| n.round().clamp(1.0, 1e6)).to_string());
        if lamps.name.is_empty() {
            self.filled("Description", super::UNKNOWN);
        } else {
            self.leaf("Description", &lamps.name);
        }
        if let Some(flux) = lamps.flux_lm {
            self.number("RatedLumens", flux);
        }
        match luminaire.input_power_w {
            Some(watts) => self.number("InputWattage", watts),
            None => self.filled("InputWattage", "0"),
        }
        if let Some(kelvin) = leading(&lamps.colour).filter(|k| (500.0..=100_000.0).contains(k)) {
            self.open("ColorTemperature");
            self.leaf("FixedCCT", &kelvin.round().to_string());
            self.close("ColorTemperature");
        } else if !lamps.colour.is_empty() {
            self.lost_text("the colour of the lamps", &lamps.colour);
        }
        match lamps.rendering.trim().parse::<f64>() {
            Ok(ra) if ra > 9.0 && ra <= 100.0 => {
                self.open("ColorRendering");
                self.open("CIE_CRI");
                self.leaf("Ra", &ra.round().to_string());
                self.close("CIE_CRI");
                self.close("ColorRendering");
            }
            _ if lamps.rendering.is_empty() => {}
            _ => self.lost_text("the colour rendering of the lamps", &lamps.rendering),
        }
        self.intensity(luminaire);
        self.spectral_data(luminaire);
        if let Some(opening) = luminaire.opening {
            self.areas(luminaire, opening);
        }
        self.close("Emitter");
    }

    fn lost_text(&mut self, what: &str, text: &str) {
        self.findings.push(Finding::info("L390", format!("{what}, `{text}`, is no number and was not carried")));
    }

    fn intensity(&mut self, luminaire: &Luminaire) {
        let table = &luminaire.distribution;
        let (data, intensity, absolute, flux) = match luminaire.kind {
            Kind::Luminous => ("LuminousData", "LuminousIntensity", "AbsolutePhotometry", "LuminousFlux"),
            Kind::Radiant => ("RadiantData", "RadiantIntensity", "Absolute", "RadiantFlux"),
            Kind::Photon => ("PhotonData", "PhotonIntensity", "Absolute", "PhotonFlux"),
        };
        self.open(data);
        if luminaire.kind != Kind::Luminous {
            let range = luminaire.spectrum.as_ref().map(|s| (s.grid().range_nm().0, s.grid().range_nm().1));
            if range.is_none() {
                let message = "the range of wavelengths is required and not known; 0 to 0 was written";
                self.findings.push(Finding::info("L390", message));
            }
            let (low, high) = range.unwrap_or_default();
            self.number("MinWavelength", low);
            self.number("MaxWavelength", high);
        }
        self.open(intensity);
        self.leaf(absolute, if luminaire.absolute { "true" } else { "false" });
        self.directions(table);
        let (horizontal, vertical) = (table.horizontal_deg(), table.vertical_deg());
        let rows: Vec<String> = vertical.iter().map(|v| digits(*v)).collect();
        for (i, h) in horizontal.iter().enumerate() {
            let h = digits(*h);
            for (v, value) in rows.iter().zip(table.plane(i)) {
                self.indent();
                let _ = writeln!(self.text, "<IntData h=\"{h}\" v=\"{v}\">{}</IntData>", digits(*value));
            }
        }
        self.close(intensity);
        self.leaf(flux, &rounded(table.total_flux(), 8));
        self.close(data);
    }

    /// Symmetry and numbers of directions of a table.
    fn directions(&mut self, table: &Distribution) {
        self.leaf(
            "Symm",
            match table.symmetry() {
                Symmetry::Rotational => "Symm_Full",
                Symmetry::Quadrant => "Symm_Quad",
                Symmetry::BilateralC0 => "Symm_Bi_0",
                Symmetry::BilateralC90 => "Symm_Bi_90",
                Symmetry::None => "Symm_None",
            },
        );
        let (horizontal, vertical) = (table.horizontal_deg().len(), table.vertical_deg().len());
        self.leaf("NumberMeasured", &(horizontal * vertical).to_string());
        self.leaf("NumberHorz", &horizontal.to_string());
        self.leaf("NumberVert", &vertical.to_string());
    }

    fn spectral_data(&mut self, luminaire: &Luminaire) {
        let spectrum = luminaire.spectrum.as_ref().filter(|s| s.sampling() == Sampling::Density);
        if luminaire.spectrum.is_some() && spectrum.is_none() {
            let message = "the spectrum consists of lines, which have no W/nm, and was not carried";
            self.findings.push(Finding::warning("L390", message));
        }
        if spectrum.is_none() && luminaire.angular_spectra.is_none() {
            return;
        }
        self.open("SpectralData");
        if let Some(spectrum) = spectrum {
            self.open("EmitterSpectral");
            self.leaf("NumberWavelength", &spectrum.values().len().to_string());
            for (nm, value) in spectrum.wavelengths_nm().iter().zip(spectrum.values()) {
                self.indent();
                let _ = writeln!(self.text, "<PwrData w=\"{}\">{}</PwrData>", digits(*nm), digits(*value));
            }
            self.close("EmitterSpectral");
        }
        if let Some(spectra) = &luminaire.angular_spectra {
            self.angular_spectra(spectra, luminaire.absolute);
        }
        self.close("SpectralData");
    }

    fn angular_spectra(&mut self, spectra: &AngularSpectra, absolute: bool) {
        self.open("AngularSpectral");
        self.leaf("Absolute", if absolute { "true" } else { "false" });
        self.directions(spectra.frame());
        let wavelengths: Vec<String> = spectra.grid().wavelengths_nm().iter().map(|nm| digits(*nm)).collect();
        self.leaf("NumberWavelength", &wavelengths.len().to_string());
        for direction in 0..spectra.directions() {
            let (h, v) = spectra.angles_deg(direction);
            let (h, v) = (digits(h), digits(v));
            for (nm, value) in wavelengths.iter().zip(spectra.values(direction)) {
                self.indent();
                let _ = writeln!(self.text, "<IntData h=\"{h}\" v=\"{v}\" w=\"{nm}\">{}</IntData>", digits(*value));
            }
        }
        self.close("AngularSpectral");
    }

    fn areas(&mut self, luminaire: &Luminaire, body: Body) {
        if matches!(body.shape, Shape::Point) || (body.length_m <= 0.0 && body.width_m <= 0.0) {
            return;
        }
        if matches!(body.shape, Shape::Sphere | Shape::CylinderAlongC0 | Shape::CylinderAlongC90) {
            let message =
                format!("luminous opening: the shape {} was written as the faces around it", body.shape.name());
            self.findings.push(Finding::info("L390", message));
        }
        let table = &luminaire.distribution;
        let upwards = table.system() == System::TypeC && table.flux_between(0.0, 90.0) <= 0.0;
        let face = if upwards { "Top" } else { "Bottom" };
        let round = body.shape == Shape::Round;
        self.open("EmissionAreas");
        self.face(face, [("Length", body.length_m), ("Width", body.width_m)], round);
        if body.height_m > 0.0 {
            for (name, along, extent) in [
                ("C0", "Length", body.length_m),
                ("C90", "Width", body.width_m),
                ("C180", "Length", body.length_m),
                ("C270", "Width", body.width_m),
            ] {
                self.face(name, [(along, extent), ("Height", body.height_m)], false);
            }
        }
        self.close("EmissionAreas");
    }

    fn face(&mut self, name: &str, extents: [(&str, f64); 2], round: bool) {
        self.open(&format!("{name}Face"));
        self.leaf(&format!("Number{name}"), "1");
        self.open(&format!("{name}Area"));
        for (of, metres) in extents {
            self.number(of, metres);
        }
        for (of, _) in extents {
            self.leaf(&format!("{of}Offset"), "0");
        }
        if round {
            self.leaf("Circular", "true");
        }
        self.close(&format!("{name}Area"));
        self.close(&format!("{name}Face"));
    }

    fn not_carried(&mut self, luminaire: &Luminaire) {
        let mut lost = Vec::new();
        if luminaire.lamps.len() > 1 {
            lost.push(format!("{} further sets of lamps", luminaire.lamps.len() - 1));
        }
        if luminaire.declared_output_ratio.is_some() {
            lost.push("the light output ratio declared".to_owned());
        }
        if luminaire.declared_downward_fraction.is_some() {
            lost.push("the downward fraction declared".to_owned());
        }
        if luminaire.distribution.symmetry() == Symmetry::Rotational && luminaire.distribution.system() != System::TypeC
        {
            lost.push("that one plane of Type A or B stands for all".to_owned());
        }
        if !lost.is_empty() {
            self.findings.push(Finding::info("L390", format!("not carried: {}", lost.join(", "))));
        }
    }
}
