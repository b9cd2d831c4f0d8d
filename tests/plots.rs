//! Drawings are whole files with the right content, whatever the numbers.

use photopic::plot::{
    ChromaticityPanel, ColourAnglePanel, ColourPlane, ColourPoint, ColourVectorPanel, Curve, Diagram, Error, Format,
    LocusPoint, MarkedPoint, Panel, PlanckPoint, SIDES, SpectrumPanel, Weighting, draw,
};

/// Wavelength, x and y of the spectral locus of CIE 1931, enough for a picture.
const LOCUS: [(f64, f64, f64); 22] = [
    (380.0, 0.1741, 0.0050),
    (420.0, 0.1714, 0.0051),
    (440.0, 0.1644, 0.0109),
    (450.0, 0.1566, 0.0177),
    (460.0, 0.1440, 0.0297),
    (470.0, 0.1241, 0.0578),
    (480.0, 0.0913, 0.1327),
    (490.0, 0.0454, 0.2950),
    (500.0, 0.0082, 0.5384),
    (510.0, 0.0139, 0.7502),
    (520.0, 0.0743, 0.8338),
    (530.0, 0.1547, 0.8059),
    (540.0, 0.2296, 0.7543),
    (550.0, 0.3016, 0.6923),
    (560.0, 0.3731, 0.6245),
    (570.0, 0.4441, 0.5547),
    (580.0, 0.5125, 0.4866),
    (590.0, 0.5752, 0.4242),
    (600.0, 0.6270, 0.3725),
    (620.0, 0.6915, 0.3083),
    (700.0, 0.7347, 0.2653),
    (780.0, 0.7347, 0.2653),
];

/// The Planckian locus after Kim et al. (2002), and its end at infinity.
fn planck() -> Vec<PlanckPoint> {
    let mut out = vec![PlanckPoint { temperature_k: f64::INFINITY, x: 0.2399, y: 0.2341 }];
    for mired in (40..=600).step_by(10).map(f64::from) {
        let (t, m) = (1e6 / mired, mired / 1000.0);
        let x = if t < 4000.0 {
            -0.2661239 * m.powi(3) - 0.2343589 * m * m + 0.8776956 * m + 0.179910
        } else {
            -3.0258469 * m.powi(3) + 2.1070379 * m * m + 0.2226347 * m + 0.240390
        };
        let y = match t {
            t if t < 2222.0 => -1.1063814 * x.powi(3) - 1.34811020 * x * x + 2.18555832 * x - 0.20219683,
            t if t < 4000.0 => -0.9549476 * x.powi(3) - 1.37418593 * x * x + 2.09137015 * x - 0.16748867,
            _ => 3.0817580 * x.powi(3) - 5.87338670 * x * x + 3.75112997 * x - 0.37001483,
        };
        out.push(PlanckPoint { temperature_k: t, x, y });
    }
    out
}

fn bell(w: f64, centre: f64, width: f64) -> f64 {
    (-((w - centre) / width).powi(2)).exp()
}

fn spectrum() -> SpectrumPanel {
    let wavelengths: Vec<f64> = (380..=780).step_by(5).map(f64::from).collect();
    let values = wavelengths.iter().map(|&w| 3e-3 * (bell(w, 450.0, 14.0) + bell(w, 590.0, 75.0))).collect();
    SpectrumPanel {
        title: "desk lamp <3 & more".into(),
        curves: vec![Curve::density("lamp", wavelengths.clone(), values)],
        value_label: "spectral irradiance [W/(m²·nm)]".into(),
        colours: vec![(380.0, [60, 0, 90]), (450.0, [40, 0, 255]), (530.0, [0, 255, 0]), (620.0, [255, 0, 0])],
        weighting: Some(Weighting {
            name: "V(λ)".into(),
            samples: wavelengths.iter().map(|&w| (w, bell(w, 555.0, 60.0))).collect(),
        }),
        figures: vec!["500 lx".into(), "CCT 4012 K, Duv +0.0012".into(), "Ra 83".into(), "Rf 82 Rg 98".into()],
        range_nm: None,
    }
}

fn chromaticity(diagram: Diagram) -> ChromaticityPanel {
    let point = |name: &str, x, y, reference| MarkedPoint { name: name.into(), x, y, reference };
    ChromaticityPanel {
        title: "where it lies".into(),
        diagram,
        locus: LOCUS.map(|(wavelength_nm, x, y)| LocusPoint { wavelength_nm, x, y }).to_vec(),
        planck: planck(),
        points: vec![
            point("lamp", 0.38, 0.377, false),
            point("D65", 0.3127, 0.3290, true),
            point("laser", 0.08, 0.82, false),
        ],
        regions: vec![vec![(0.37, 0.37), (0.39, 0.37), (0.39, 0.39), (0.37, 0.37)]],
    }
}

fn vectors() -> ColourVectorPanel {
    let mut panel = ColourVectorPanel {
        title: "hue by hue".into(),
        fidelity: 81.6,
        gamut: 98.2,
        cct_k: Some(4012.3),
        duv: Some(0.0012),
        ..ColourVectorPanel::default()
    };
    for (bin, vector) in panel.vectors.iter_mut().enumerate() {
        let (s, c) = (std::f64::consts::TAU * (bin as f64 + 0.5) / 16.0).sin_cos();
        *vector = ([c, s], [1.05 * c + 0.06 * s, 0.93 * s]);
    }
    panel
}

fn all_three() -> [Panel; 3] {
    [spectrum().into(), chromaticity(Diagram::Cie1976).into(), vectors().into()]
}

fn svg(panels: &[Panel]) -> String {
    String::from_utf8(draw(panels, None, Format::Svg).expect("a drawing")).expect("UTF-8")
}

fn labels(svg: &str) -> Vec<String> {
    let document = roxmltree::Document::parse(svg).expect("well-formed XML");
    let texts = document.descendants().filter(|n| n.has_tag_name("text"));
    texts.filter_map(|n| n.text()).map(|t| t.trim().to_owned()).collect()
}

fn png(panels: &[Panel], size: Option<(u32, u32)>) -> image::RgbImage {
    let bytes = draw(panels, size, Format::Png).expect("a drawing");
    image::load_from_memory_with_format(&bytes, image::ImageFormat::Png).expect("a PNG").to_rgb8()
}

/// Draw in both formats, and look for signs of numbers gone wrong.
fn survives(panel: impl Into<Panel>) -> Vec<String> {
    let panels = [panel.into()];
    let svg = svg(&panels);
    for bad in ["NaN", "inf", "2147483647", "-2147483648"] {
        let drawn = svg.split("</style>").nth(1).expect("a style");
        let outside_pictures: String = drawn.split("base64,").map(|p| p.split_once('"').map_or(p, |q| q.1)).collect();
        assert!(!outside_pictures.contains(bad), "{bad} in the SVG");
    }
    png(&panels, Some((400, 400)));
    labels(&svg)
}

#[test]
fn svg_is_well_formed_and_says_everything() {
    let text = svg(&all_three());
    assert!(text.len() < 1_000_000, "{} bytes", text.len());
    let labels = labels(&text);
    for expected in [
        "desk lamp <3 & more",
        "spectral irradiance [W/(m²·nm)]",
        "wavelength [nm]",
        "×10⁻³",
        "V(λ)",
        "500 lx",
        "CCT 4012 K, Duv +0.0012",
        "Rf 82 Rg 98",
        "where it lies",
        "u′",
        "v′",
        "460",
        "520",
        "620",
        "2000 K",
        "4000 K",
        "10000 K",
        "lamp",
        "D65",
        "laser",
        "hue by hue",
        "1",
        "16",
        "82",
        "98",
        "4012 K",
        "+0.0012",
        "−20 %",
        "+20 %",
    ] {
        assert!(labels.iter().any(|l| l == expected), "{expected:?} is missing from {labels:?}");
    }
    let document = roxmltree::Document::parse(&text).expect("well-formed XML");
    let root = document.root_element();
    assert_eq!((root.attribute("width"), root.attribute("height")), (Some("1200"), Some("900")));
    let ids: Vec<_> = document.descendants().filter_map(|n| n.attribute("id")).collect();
    for (i, id) in ids.iter().enumerate() {
        assert!(!ids[..i].contains(id), "{id} twice");
        assert!(text.contains(&format!("url(#{id})")), "{id} is not used");
    }
    assert!(text.contains("@font-face"), "the typeface is not embedded");
}

#[test]
fn labels_do_not_cover_each_other() {
    let text = svg(&all_three());
    let document = roxmltree::Document::parse(&text).expect("well-formed XML");
    let mut boxes: Vec<(String, [f64; 4])> = Vec::new();
    for node in document.descendants().filter(|n| n.has_tag_name("text") && !n.has_attribute("transform")) {
        let number = |name: &str| node.attribute(name).and_then(|v| v.parse::<f64>().ok()).expect("a number");
        let label = node.text().unwrap_or_default().trim().to_owned();
        let (x, y, size) = (number("x"), number("y"), number("font-size"));
        let width = 0.56 * size * label.chars().count() as f64;
        let left = match node.attribute("text-anchor") {
            Some("middle") => x - width / 2.0,
            Some("end") => x - width,
            _ => x,
        };
        boxes.push((label, [left, y + 0.03 * size, left + width, y + 0.76 * size]));
        assert!(size >= 110.0, "text of {} px", size / 10.0);
    }
    for (i, (a, p)) in boxes.iter().enumerate() {
        assert!(p[0] >= 0.0 && p[2] <= 12000.0 && p[1] >= 0.0 && p[3] <= 9000.0, "{a} leaves the picture");
        for (b, q) in &boxes[..i] {
            let apart = p[2] <= q[0] || q[2] <= p[0] || p[3] <= q[1] || q[3] <= p[1];
            assert!(apart, "{a:?} and {b:?} overlap");
        }
    }
}

#[test]
fn png_has_its_size_and_ink_in_every_panel() {
    let picture = png(&all_three(), None);
    assert_eq!(picture.dimensions(), (1200, 900));
    for (x, y) in [(60, 60), (60, 440), (740, 470)] {
        let part = image::imageops::crop_imm(&picture, x, y, 400, 350).to_image();
        let (dark, coloured) = part.pixels().fold((0, 0), |(dark, coloured), p| {
            let (low, high) = (p.0.iter().min().unwrap_or(&0), p.0.iter().max().unwrap_or(&0));
            (dark + u32::from(*high < 90), coloured + u32::from(high - low > 20))
        });
        assert!(dark > 500 && coloured > 5_000, "{dark} dark and {coloured} coloured pixels at {x}, {y}");
    }
    assert_eq!(png(&[spectrum().into()], None).dimensions(), (1000, 600));
    assert_eq!(png(&[vectors().into()], None).dimensions(), (800, 800));
    assert_eq!(png(&[spectrum().into()], Some((333, 777))).dimensions(), (333, 777));
}

#[test]
fn drawings_are_the_same_every_time() {
    for format in [Format::Svg, Format::Png] {
        let once = draw(&all_three(), Some((600, 450)), format).expect("a drawing");
        assert!(once == draw(&all_three(), Some((600, 450)), format).expect("a drawing"), "{format:?} differs");
    }
}

#[test]
fn sizes_and_emptiness_are_refused() {
    assert!(matches!(draw(&[], None, Format::Svg), Err(Error::Empty)));
    for size in [(0, 600), (600, 0), (SIDES.0 - 1, 600), (600, SIDES.1 + 1), (u32::MAX, u32::MAX)] {
        let error = draw(&[spectrum().into()], Some(size), Format::Png).expect_err("too small or too large");
        assert!(matches!(error, Error::Size { .. }), "{error}");
    }
}

#[test]
fn extreme_spectra_are_drawn() {
    let with = |wavelengths: &[f64], values: &[f64]| {
        let curves = vec![Curve::density("c", wavelengths.to_vec(), values.to_vec())];
        SpectrumPanel { curves, ..spectrum() }
    };
    assert!(survives(with(&[400.0, 500.0, 600.0], &[0.0; 3])).contains(&"all values are zero".to_owned()));
    assert!(survives(with(&[], &[])).contains(&"no values".to_owned()));
    assert!(survives(with(&[500.0, 600.0], &[f64::NAN; 2])).contains(&"no values".to_owned()));
    assert!(survives(with(&[400.0, 500.0, 600.0], &[1e-30, 3e-30, 2e-30])).contains(&"×10⁻³⁰".to_owned()));
    assert!(survives(with(&[400.0, 500.0, 600.0], &[1e30, 3e30, 2e30])).contains(&"×10³⁰".to_owned()));
    survives(with(&[555.0], &[0.3]));
    survives(with(&[400.0, 500.0, 600.0], &[-1.0, -3.0, -2.0]));
    survives(with(&[400.0, 500.0, 600.0, 700.0], &[-1.0, f64::INFINITY, f64::NAN, 2.0]));
    survives(with(&[400.0, 500.0, 600.0], &[-1e308, 1e308, 5e-324]));
    survives(with(&[600.0, 400.0, 400.0, f64::NAN, 500.0], &[1.0, 2.0, 3.0, 4.0, 5.0, 6.0]));
    survives(with(&[1e-7, 1e9], &[1.0, 2.0]));
    survives(SpectrumPanel { range_nm: Some((500.0, 510.0)), ..spectrum() });
    survives(SpectrumPanel { range_nm: Some((f64::NAN, 510.0)), colours: Vec::new(), ..spectrum() });
    survives(SpectrumPanel::default());
    let noise: Vec<f64> = (0..100_000).map(|i| (f64::from(i) * 12.9898).sin()).collect();
    let steps: Vec<f64> = (0..100_000).map(|i| 380.0 + 0.004 * f64::from(i)).collect();
    let panel = [with(&steps, &noise).into()];
    assert!(svg(&panel).len() < 400_000, "a finely sampled spectrum is thinned");
}

#[test]
fn lines_and_many_curves_are_drawn() {
    let hg = Curve::lines("Hg", vec![404.7, 435.8, 546.1, 579.1], vec![0.3, 0.8, 1.0, -0.2]);
    survives(SpectrumPanel { curves: vec![hg.clone()], ..spectrum() });
    let mut curves: Vec<Curve> =
        (0..63).map(|i| Curve { name: format!("lamp {i}"), ..spectrum().curves[0].clone() }).collect();
    curves.push(hg);
    let labels = survives(SpectrumPanel { curves, ..spectrum() });
    assert!(labels.contains(&"lamp 7".to_owned()));
    assert!(labels.iter().any(|l| l.starts_with("and ") && l.ends_with(" more")), "{labels:?}");
}

#[test]
fn long_and_odd_names_are_drawn() {
    let long = "a very long name of a lamp ".repeat(40);
    let labels = survives(SpectrumPanel { title: long.clone(), figures: vec![long.clone(); 20], ..spectrum() });
    assert!(labels.iter().any(|l| l.starts_with("a very long") && l.ends_with('…')), "{labels:?}");
    let odd = "\u{0}\u{1b}[31m]]></svg>\n\u{FFFF}𝄞 \"&'".to_owned();
    survives(SpectrumPanel { title: odd.clone(), value_label: odd.clone(), figures: vec![odd.clone()], ..spectrum() });
    let mut panel = chromaticity(Diagram::Cie1931);
    panel.points[0].name = long;
    panel.points[1].name = odd;
    survives(panel);
}

#[test]
fn points_anywhere_are_drawn() {
    let mut panel = chromaticity(Diagram::Cie1976);
    let places = [(1.2, -0.3), (0.0, 0.0), (f64::NAN, 0.3), (1e300, -1e300), (1.5, 0.0), (f64::INFINITY, 0.2)];
    panel.points.extend(places.map(|(x, y)| MarkedPoint { name: "stray".into(), x, y, reference: false }));
    assert!(survives(panel.clone()).contains(&"stray (off the diagram)".to_owned()));
    panel.points = (0..64)
        .map(|i| MarkedPoint { name: format!("lamp {i}"), x: 0.38 + 1e-4 * f64::from(i), y: 0.38, reference: false })
        .collect();
    assert!(survives(panel.clone()).iter().any(|l| l.ends_with("more without a label")));
    survives(ChromaticityPanel { locus: Vec::new(), planck: Vec::new(), ..panel.clone() });
    survives(ChromaticityPanel::default());
    let same = LocusPoint { wavelength_nm: 500.0, x: 0.3, y: 0.3 };
    survives(ChromaticityPanel { locus: vec![same; 5], planck: planck()[..1].to_vec(), ..panel });
}

#[test]
fn extreme_colour_vectors_are_drawn() {
    let mut panel = vectors();
    panel.vectors[3].1 = [f64::NAN, 0.2];
    panel.vectors[5].1 = [30.0, -40.0];
    panel.fidelity = f64::NAN;
    panel.duv = None;
    survives(panel);
    survives(ColourVectorPanel::default());
}

#[test]
fn many_panels_are_laid_out() {
    let panels: Vec<Panel> = all_three().into_iter().cycle().take(9).collect();
    let text = svg(&panels);
    assert_eq!(labels(&text).iter().filter(|l| *l == "hue by hue").count(), 3);
    assert_eq!(png(&panels, Some((600, 1600))).dimensions(), (600, 1600));
}

#[test]
fn colour_over_angle_is_drawn_whatever_the_numbers() {
    let point = |angle_deg: f64, kelvin: f64, counted: bool| ColourPoint {
        angle_deg,
        cct_k: Some(kelvin),
        delta_uv_prime: kelvin * 1e-6,
        srgb: [255, 180, 90],
        counted,
    };
    let plane = |points: Vec<ColourPoint>| ColourPlane { name: "C<90>".into(), points };
    let usual = plane((0..19).map(|i| point(5.0 * f64::from(i), 2700.0 + 10.0 * f64::from(i), i < 15)).collect());
    let panel = ColourAnglePanel { title: "a lamp & its colour".into(), planes: vec![usual], figures: vec![] };
    for planes in [
        panel.planes.clone(),
        vec![],
        vec![plane(vec![])],
        vec![plane(vec![point(30.0, 4000.0, true)])],
        vec![plane(vec![point(f64::NAN, f64::INFINITY, true), point(10.0, f64::NAN, false)]); 9],
    ] {
        for format in [Format::Svg, Format::Png] {
            let bytes = draw(&[ColourAnglePanel { planes: planes.clone(), ..panel.clone() }.into()], None, format);
            let bytes = bytes.expect("drawn");
            if format == Format::Svg {
                let text = String::from_utf8(bytes).expect("UTF-8");
                assert!(roxmltree::Document::parse(&text).is_ok() && !text.contains("NaN"), "{planes:?}");
                assert!(text.contains("a lamp &amp; its colour") && text.contains("CCT [K]"));
            }
        }
    }
}
