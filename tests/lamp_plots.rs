//! The diagrams of luminaires: what is drawn is the table, on the side where it belongs, and can be read.
//!
//! Numbers are read back from the SVG file: the outermost circle and its label give the scale.

mod common;

use std::fs;
use std::path::Path;

use assert_cmd::Command;
use photopic::luminaire::Luminaire;
use photopic::luminaire::format::{ReadOptions, open};
use photopic::plot::luminaire::{
    Drawn, Error, View, cartesian_panel, cone_panel, figures_panel, isocandela_panel, polar_panel, web_panel,
};
use photopic::plot::{Format, Panel, draw};

/// Units of the `viewBox` per pixel.
const UNITS: f64 = 10.0;
/// A place is rounded to whole units, and so are the places that it is measured from: √2 (½ + ½) units.
const ROUNDING: f64 = 1.42;
/// Stroke of the first curve, of the second, and of the outermost circle.
const FIRST: &str = "#005496";
const SECOND: &str = "#C84600";
const OUTERMOST: &str = "#5A5A5A";

/// An LM-63 file: photometric type (1 C, 2 B), vertical and horizontal angles, a plane of candela per horizontal angle.
fn ies(kind: u8, vertical: &[f64], planes: &[(f64, &[f64])]) -> String {
    let list = |v: &[f64]| v.iter().map(f64::to_string).collect::<Vec<_>>().join(" ");
    let horizontal: Vec<f64> = planes.iter().map(|p| p.0).collect();
    let rows: Vec<String> = planes.iter().map(|p| list(p.1)).collect();
    format!(
        "IESNA:LM-63-2002\n[TEST] 1\n[TESTLAB] none\n[ISSUEDATE] 2026\n[MANUFAC] ours\n[LUMINAIRE] lamp\nTILT=NONE\n\
         1 -1 1 {} {} {kind} 2 0 0 0\n1 1 10\n{}\n{}\n{}\n",
        vertical.len(),
        planes.len(),
        list(vertical),
        list(&horizontal),
        rows.join("\n")
    )
}

fn lamp(text: &str) -> Luminaire {
    open(text.as_bytes(), &ReadOptions { format: None, repair: false }).expect("a sound file").value.luminaire
}

/// Different in all four principal half-planes.
fn asymmetric() -> String {
    let row = |peak: f64| [500.0, peak, 0.5 * peak, 0.0];
    let [a, b, c, d] = [900.0, 600.0, 300.0, 100.0].map(row);
    ies(1, &[0.0, 30.0, 60.0, 90.0], &[(0.0, &a), (90.0, &b), (180.0, &c), (270.0, &d), (360.0, &a)])
}

/// Falls linearly from 1000 cd on the axis to nothing at 90°, the same all around.
fn linear() -> String {
    ies(1, &[0.0, 30.0, 60.0, 90.0], &[(0.0, &[1000.0, 2000.0 / 3.0, 1000.0 / 3.0, 0.0])])
}

fn drawn(luminaire: &Luminaire) -> Drawn<'_> {
    Drawn { name: "lamp", luminaire }
}

fn svg(panels: &[Panel]) -> String {
    String::from_utf8(draw(panels, None, Format::Svg).expect("a drawing")).expect("UTF-8")
}

/// A label: its text, place, size and how it hangs there.
struct Label {
    text: String,
    at: (f64, f64),
    size: f64,
    anchor: String,
}

impl Label {
    /// No wider than DejaVu Sans sets it (advance widths of the font in em, the least for letters).
    fn least_box(&self) -> [f64; 4] {
        let advance = |c: char| match c {
            '0'..='9' => 0.636,
            '.' | ',' | ' ' | 'i' | 'l' | 'j' | 'I' | '\'' | ':' | ';' | '|' | '!' => 0.27,
            '−' => 0.838,
            '°' => 0.5,
            _ => 0.39,
        };
        let width = self.size * self.text.chars().map(advance).sum::<f64>();
        let left = match self.anchor.as_str() {
            "middle" => self.at.0 - width / 2.0,
            "end" => self.at.0 - width,
            _ => self.at.0,
        };
        [left, self.at.1 + 0.03 * self.size, left + width, self.at.1 + 0.76 * self.size]
    }
}

fn numbers(node: roxmltree::Node<'_, '_>, name: &str) -> f64 {
    node.attribute(name).and_then(|v| v.parse().ok()).expect("a number")
}

fn labels(svg: &str) -> Vec<Label> {
    let document = roxmltree::Document::parse(svg).expect("well-formed XML");
    let texts = document.descendants().filter(|n| n.has_tag_name("text") && !n.has_attribute("transform"));
    texts
        .map(|n| Label {
            text: n.text().unwrap_or_default().trim().to_owned(),
            at: (numbers(n, "x"), numbers(n, "y")),
            size: numbers(n, "font-size"),
            anchor: n.attribute("text-anchor").unwrap_or("start").to_owned(),
        })
        .collect()
}

fn has(svg: &str, text: &str) -> bool {
    labels(svg).iter().any(|l| l.text == text)
}

/// The lines of one colour, longest (by points) first.
fn lines(svg: &str, stroke: &str) -> Vec<Vec<(f64, f64)>> {
    let document = roxmltree::Document::parse(svg).expect("well-formed XML");
    let of_colour = document.descendants().filter(|n| n.attribute("stroke") == Some(stroke));
    let mut out: Vec<Vec<(f64, f64)>> = of_colour
        .filter_map(|n| n.attribute("points"))
        .map(|points| {
            let pair = |p: &str| p.split_once(',').and_then(|(x, y)| Some((x.parse().ok()?, y.parse().ok()?)));
            points.split_whitespace().filter_map(pair).collect()
        })
        .collect();
    out.sort_by_key(|l| std::cmp::Reverse(l.len()));
    out
}

/// Middle and radius of the outermost circle.
fn outermost(svg: &str) -> ((f64, f64), f64) {
    let ring = lines(svg, OUTERMOST).swap_remove(0);
    let (left, right) = ring.iter().fold((f64::MAX, f64::MIN), |(l, r), p| (l.min(p.0), r.max(p.0)));
    let ends: Vec<f64> = ring.iter().filter(|p| p.0 == left || p.0 == right).map(|p| p.1).collect();
    ((0.5 * (left + right), ends.iter().sum::<f64>() / ends.len() as f64), 0.5 * (right - left))
}

/// The largest whole number among the labels: the value of the outermost circle.
fn largest_label(svg: &str) -> f64 {
    labels(svg).iter().filter_map(|l| l.text.parse::<f64>().ok()).fold(0.0, f64::max)
}

fn overlaps(svg: &str) -> Vec<(String, String)> {
    let boxes: Vec<(String, [f64; 4])> = labels(svg).into_iter().map(|l| (l.text.clone(), l.least_box())).collect();
    let apart = |p: &[f64; 4], q: &[f64; 4]| p[2] <= q[0] || q[2] <= p[0] || p[3] <= q[1] || q[3] <= p[1];
    let mut out = Vec::new();
    for (i, (a, p)) in boxes.iter().enumerate() {
        out.extend(boxes[..i].iter().filter(|(_, q)| !apart(p, q)).map(|(b, _)| (a.clone(), b.clone())));
    }
    out
}

/// Every diagram that a luminaire has.
fn all(luminaire: &Luminaire, view: &View) -> Result<Vec<Panel>, Error> {
    let one = drawn(luminaire);
    let mut panels: Vec<Panel> = vec![
        figures_panel(&one).into(),
        polar_panel(&[one], view)?.into(),
        cartesian_panel(&[one], view)?.into(),
        isocandela_panel(&one, view)?.into(),
        web_panel(&one, view)?.into(),
    ];
    panels.extend(cone_panel(&one, view).map(Panel::from));
    Ok(panels)
}

#[test]
fn the_polar_curve_is_the_table_on_its_side() {
    let luminaire = lamp(&asymmetric());
    let svg = svg(&[polar_panel(&[drawn(&luminaire)], &View::default()).expect("lit").into()]);
    let (centre, radius) = outermost(&svg);
    let most = largest_label(&svg);
    assert_eq!(most, 1000.0, "a round number above 900");
    let solid = lines(&svg, FIRST).swap_remove(0);
    // γ positive is C0, to the right; γ = 0 is at the bottom. 45° lies halfway in angle and intensity between its neighbours.
    for (gamma, candela) in [(-60.0, 150.0), (-30.0, 300.0), (0.0, 500.0), (30.0, 900.0), (45.0, 675.0), (60.0, 450.0)]
    {
        let (s, c) = f64::to_radians(gamma).sin_cos();
        let r = radius * candela / most;
        let place = (centre.0 + r * s, centre.1 + r * c);
        let nearest = solid.iter().map(|p| (p.0 - place.0).hypot(p.1 - place.1)).fold(f64::MAX, f64::min);
        assert!(nearest <= ROUNDING, "{gamma}°: {nearest} units off");
    }
    // The dashed curve: C90 reaches 600 cd to the right, C270 no more than the 500 cd at the bottom to the left.
    let mut dashed: Vec<(f64, f64)> = lines(&svg, SECOND).concat();
    dashed.retain(|p| p.1 >= centre.1 - ROUNDING); // the legend stands above
    let width = |side: f64| dashed.iter().map(|p| side * (p.0 - centre.0) / radius * most).fold(0.0, f64::max);
    assert!(width(1.0) > 300.0 && width(-1.0) < 130.0, "{} {}", width(1.0), width(-1.0));
    assert!(has(&svg, "C0–C180") && has(&svg, "C90–C270") && has(&svg, "cd") && has(&svg, "0°") && !has(&svg, "120°"));
}

#[test]
fn planes_and_lumens_are_as_asked() {
    let luminaire = lamp(&linear());
    let flux = luminaire.distribution.total_flux();
    let view = View { planes_deg: vec![0.0, 45.0, 200.0], per_klm: true, ..View::default() };
    let panel = polar_panel(&[drawn(&luminaire)], &view).expect("lit");
    assert_eq!(panel.curves.iter().map(|c| c.name.as_str()).collect::<Vec<_>>(), ["C0–C180", "C45–C225", "C200–C20"]);
    // ∫ 1000 (1 − 2γ/π) 2π sin γ dγ = 2000π (1 − 2/π) lm.
    let exact = 2000.0 * std::f64::consts::PI - 4000.0;
    assert!((flux / exact - 1.0).abs() < 1e-9, "{flux}");
    let peak = panel.curves[1].values.iter().copied().fold(0.0, f64::max);
    assert!((peak / (1e6 / exact) - 1.0).abs() < 1e-9, "{peak}");
    assert_eq!(panel.unit, "cd/klm");
    let seven = View { planes_deg: (0..7).map(|i| 10.0 * f64::from(i)).collect(), ..View::default() };
    assert_eq!(polar_panel(&[drawn(&luminaire)], &seven), Err(Error::TooMany { found: 7 }));
}

#[test]
fn the_cartesian_curve_is_the_table() {
    let luminaire = lamp(&asymmetric());
    let svg = svg(&[cartesian_panel(&[drawn(&luminaire)], &View::default()).expect("lit").into()]);
    let labels = labels(&svg);
    let place = |text: &str| labels.iter().find(|l| l.text == text).map(|l| l.at).expect("a tick");
    let per_degree = (place("60").0 - place("−60").0) / 120.0;
    let middle = 0.5 * (place("60").0 + place("−60").0);
    let per_candela = (place("800").1 - place("200").1) / 600.0;
    let solid = lines(&svg, FIRST).swap_remove(0);
    let height = |gamma: f64| {
        let near = |p: &&(f64, f64)| (p.0 - middle - gamma * per_degree).abs() <= 2.0 * ROUNDING;
        solid.iter().find(near).map(|p| p.1).expect("a point at a tabulated angle")
    };
    for (gamma, candela) in [(-60.0, 150.0), (-30.0, 300.0), (30.0, 900.0), (60.0, 450.0)] {
        let difference = (height(gamma) - height(0.0)) / per_candela;
        assert!((difference - (candela - 500.0)).abs() * per_candela.abs() <= 2.0 * ROUNDING, "{gamma}: {difference}");
    }
    // Half of 900 cd: on the right at 60°, on the left at −5° + …, from 500 at 0 to 300 at −30: 7.5°.
    assert!(has(&svg, "50 %") && has(&svg, "10 %"));
    assert!(labels.iter().any(|l| l.text.starts_with("C0–C180, beam 67.5°")), "60 + 7.5 degrees wide");
}

#[test]
fn isocandela_lines_lie_where_the_projection_puts_them() {
    let luminaire = lamp(&linear());
    let svg = svg(&[isocandela_panel(&drawn(&luminaire), &View::default()).expect("lit").into()]);
    let (centre, radius) = outermost(&svg);
    // 1 − γ/90° of the maximum; Lambert's azimuthal projection: r = R sin(γ/2) / sin(90°/2).
    let expected =
        |percent: f64| radius * (45.0 * (1.0 - percent / 100.0)).to_radians().sin() / 45f64.to_radians().sin();
    let closed: Vec<Vec<(f64, f64)>> = lines(&svg, FIRST).into_iter().filter(|l| l.len() > 60).collect();
    assert_eq!(closed.len(), 9);
    for percent in [90.0, 50.0, 10.0, 2.0] {
        let fits = |l: &&Vec<(f64, f64)>| {
            l.iter().all(|p| ((p.0 - centre.0).hypot(p.1 - centre.1) - expected(percent)).abs() <= ROUNDING)
        };
        assert_eq!(closed.iter().filter(fits).count(), 1, "{percent} %");
        assert!(has(&svg, &format!("{percent} %")));
    }
}

#[test]
fn the_cone_has_the_figures_of_its_geometry() {
    let luminaire = lamp(&linear());
    let svg = svg(&[cone_panel(&drawn(&luminaire), &View::default()).expect("a beam").into()]);
    // Half of the maximum at 45°: as wide as twice the distance. 1000 cd / d².
    for text in [
        "1000",
        "250",
        "111",
        "62.5",
        "40",
        "2",
        "4",
        "6",
        "8",
        "10",
        "half-peak beam: 90.0°, width not to scale",
        "[lx]",
    ] {
        assert!(has(&svg, text), "{text} in {:?}", labels(&svg).iter().map(|l| &l.text).collect::<Vec<_>>());
    }
    let beside = lamp(&ies(1, &[0.0, 40.0, 60.0], &[(0.0, &[10.0, 100.0, 0.0])]));
    assert!(matches!(cone_panel(&drawn(&beside), &View::default()), Err(Error::NoCone(_))));
}

#[test]
fn the_solid_of_an_even_lamp_is_a_ball_seen_from_outside() {
    let luminaire = lamp(&ies(1, &[0.0, 90.0, 180.0], &[(0.0, &[100.0; 3])]));
    let svg = svg(&[web_panel(&drawn(&luminaire), &View::default()).expect("lit").into()]);
    // The ring about the ball gives its middle and radius.
    let ring: Vec<(f64, f64)> = lines(&svg, "#969696").concat();
    let (left, right) = ring.iter().fold((f64::MAX, f64::MIN), |(l, r), p| (l.min(p.0), r.max(p.0)));
    let (low, high) = ring.iter().fold((f64::MAX, f64::MIN), |(l, r), p| (l.min(p.1), r.max(p.1)));
    let (centre, radius) = ((0.5 * (left + right), 0.5 * (low + high)), 0.5 * (right - left));
    let document = roxmltree::Document::parse(&svg).expect("well-formed XML");
    let patches: Vec<&str> =
        document.descendants().filter(|n| n.has_tag_name("polygon")).filter_map(|n| n.attribute("points")).collect();
    // 72 × 36 patches, of which half look away (those along the rim may do either).
    assert!((1150..=1300).contains(&patches.len()), "{}", patches.len());
    for points in patches {
        for (x, y) in points.split_whitespace().filter_map(|p| p.split_once(',')) {
            let at = |v: &str| v.parse::<f64>().expect("a number");
            // Patches are drawn up to one pixel larger than they are.
            assert!((at(x) - centre.0).hypot(at(y) - centre.1) <= radius + UNITS + ROUNDING);
        }
    }
}

#[test]
fn odd_lamps_are_drawn_or_refused_with_a_word() {
    let view = View::default();
    let dark = lamp(&ies(1, &[0.0, 90.0], &[(0.0, &[0.0, 0.0])]));
    assert_eq!(polar_panel(&[drawn(&dark)], &view), Err(Error::Dark { in_planes: false }));
    assert!(matches!(web_panel(&drawn(&dark), &view), Err(Error::Dark { .. })));
    // Light only between the principal planes.
    let oblique = lamp(&ies(1, &[0.0, 90.0], &[(0.0, &[0.0; 2]), (45.0, &[0.0, 5.0]), (90.0, &[0.0; 2])]));
    assert_eq!(polar_panel(&[drawn(&oblique)], &view), Err(Error::Dark { in_planes: true }));
    let texts = [
        ies(1, &[90.0, 135.0, 180.0], &[(0.0, &[10.0, 20.0, 30.0])]),
        ies(1, &[0.0, 1.0, 2.5, 5.0, 90.0], &[(0.0, &[1e6, 9e5, 5e5, 1e3, 0.0])]),
        ies(1, &[0.0, 45.0, 90.0], &[(0.0, &[3e-9, 2e-9, 0.0])]),
        ies(1, &[0.0, 45.0, 90.0], &[(0.0, &[3e12, 2e12, 0.0])]),
        ies(1, &[0.0, 45.0, 90.0], &[(0.0, &[100.0, 50.0, -3.0])]),
        ies(2, &[-90.0, 0.0, 90.0], &[(-90.0, &[0.0; 3]), (0.0, &[0.0, 100.0, 0.0]), (90.0, &[0.0; 3])]),
        ies(3, &[-90.0, 0.0, 90.0], &[(0.0, &[0.0, 100.0, 0.0]), (90.0, &[0.0; 3])]),
    ];
    for text in texts {
        let luminaire = lamp(&text);
        for logarithmic in [false, true] {
            let panels = all(&luminaire, &View { logarithmic, ..View::default() }).expect("lit");
            let svg = svg(&panels);
            let body = svg.split("</style>").nth(1).expect("a style");
            for bad in ["NaN", "inf", "2147483647", "-2147483648"] {
                assert!(!body.contains(bad), "{bad} in {text}");
            }
            assert_eq!(overlaps(&svg), [], "{text}");
        }
    }
}

#[test]
fn every_real_file_is_drawn_and_readable() {
    let Some(folder) = common::shared("luminaires") else { return };
    let mut count = 0;
    for row in common::rows(&folder.join("index.csv")) {
        let lamp = ["ies", "ldt", "xml"].iter().any(|e| row["file"].to_lowercase().ends_with(e));
        if row["kind"] != "real" || !lamp {
            continue;
        }
        let Ok(bytes) = fs::read(folder.join("files").join(&row["file"])) else { continue };
        let Ok(file) = open(&bytes, &ReadOptions { format: None, repair: false }) else { continue };
        let panels = all(&file.value.luminaire, &View::default()).unwrap_or_else(|e| panic!("{}: {e}", row["file"]));
        assert_eq!(overlaps(&svg(&panels)), [], "{}", row["file"]);
        count += 1;
    }
    assert!(count >= 60, "{count} real files");
}

fn photopic(folder: &Path, arguments: &[&str]) -> assert_cmd::assert::Assert {
    Command::new(env!("CARGO_BIN_EXE_photopic")).current_dir(folder).args(["lamp", "plot"]).args(arguments).assert()
}

#[test]
fn the_command_writes_one_picture_or_one_per_file() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path();
    fs::write(path.join("a.ies"), linear()).expect("written");
    fs::write(path.join("b.ies"), asymmetric()).expect("written");
    for kind in ["sheet", "polar", "cartesian", "web", "isocandela", "cone", "all"] {
        photopic(path, &["a.ies", "-o", "a.svg", "--kind", kind, "--size", "700x500"]).success();
        photopic(path, &["a.ies", "-o", "a.png", "--kind", kind, "--size", "700x500"]).success();
        let text = fs::read_to_string(path.join("a.svg")).expect("an SVG");
        assert!(text.contains("width=\"700\" height=\"500\""), "{kind}");
        let picture = image::open(path.join("a.png")).expect("a PNG").to_rgb8();
        assert_eq!(picture.dimensions(), (700, 500));
        photopic(path, &["a.ies", "-o", "again.svg", "--kind", kind, "--size", "700x500"]).success();
        assert!(text == fs::read_to_string(path.join("again.svg")).expect("an SVG"), "{kind}: not the same twice");
        // Without a size, both formats have the same one.
        photopic(path, &["a.ies", "-o", "a.svg", "--kind", kind]).success();
        photopic(path, &["a.ies", "-o", "a.png", "--kind", kind]).success();
        let (width, height) = image::image_dimensions(path.join("a.png")).expect("a PNG");
        let text = fs::read_to_string(path.join("a.svg")).expect("an SVG");
        assert!(text.contains(&format!("width=\"{width}\" height=\"{height}\"")), "{kind}");
    }
    photopic(path, &["a.ies", "b.ies", "-o", "both.svg"]).success();
    let both = fs::read_to_string(path.join("both.svg")).expect("an SVG");
    assert!(has(&both, "a, all C planes") && has(&both, "b, C90–C270"));
    fs::create_dir(path.join("out")).expect("a folder");
    photopic(path, &["a.ies", "b.ies", "-o", "out", "--format", "png"]).success();
    assert!(path.join("out/a.png").exists() && path.join("out/b.png").exists());
    let piped = photopic(path, &["a.ies", "-o", "-"]).success();
    assert!(piped.get_output().stdout.starts_with(b"<svg"));
}

#[test]
fn what_cannot_be_drawn_is_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path();
    fs::write(path.join("a.ies"), linear()).expect("written");
    fs::write(path.join("dark.ies"), ies(1, &[0.0, 90.0], &[(0.0, &[0.0, 0.0])])).expect("written");
    let refused = |arguments: &[&str], word: &str| {
        let done = photopic(path, arguments).code(2);
        let error = String::from_utf8_lossy(&done.get_output().stderr).into_owned();
        assert!(error.contains(word), "{arguments:?}: {error}");
    };
    refused(&["dark.ies", "-o", "x.svg"], "dark.ies: no intensity is above zero");
    refused(&["a.ies", "-o", "x.pdf"], ".svg or .png");
    refused(&["a.ies", "-o", "x.svg", "--planes", "400"], "0 to 360");
    refused(&["a.ies", "-o", "x.svg", "--planes", "0,10,20,30,40,50,60"], "7 curves");
    refused(&["a.ies", "-o", "x.svg", "--size", "10x10"], "240");
    refused(&["a.ies", "-o", "x.svg", "--size", "big"], "1200x900");
    refused(&["a.ies", "a.ies", "-o", "x.svg", "--kind", "web"], "one file");
    refused(&["none.ies", "-o", "x.svg"], "none.ies");
    assert!(!path.join("x.svg").exists());
}
