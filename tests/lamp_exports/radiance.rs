//! Radiance: `brightdata` by the reference manual's rule (linear in the table), `source.cal`'s functions, and the surfaces' areas.

use glam::DVec3;
use photopic::luminaire::export::radiance::{LUMENS_PER_WATT, write};
use photopic::luminaire::{Body, Distribution, Kind, Luminaire, Shape, Symmetry, System};

use super::lamp::{asymmetric, directions, flux_bound, lamp, tables, type_b};

/// Relative: numbers of 32 bits (2⁻²⁴), coordinates to a nanometre on sides of 0.03 m.
const ROUNDING: f64 = 3e-7;

/// A data file: the angles of each dimension and the values, the last dimension running fastest.
struct Data {
    axes: Vec<Vec<f64>>,
    values: Vec<f64>,
}

impl Data {
    fn parse(text: &str) -> Self {
        let mut numbers = text.split_whitespace().map(|w| w.parse::<f64>().expect("a number"));
        let mut next = || numbers.next().expect("a number");
        let axes: Vec<Vec<f64>> = (0..next() as usize)
            .map(|_| {
                let (begin, end, count) = (next(), next(), next() as usize);
                if begin == end {
                    return (0..count).map(|_| next()).collect();
                }
                (0..count).map(|i| begin + (end - begin) * i as f64 / (count - 1) as f64).collect()
            })
            .collect();
        let values: Vec<f64> = numbers.collect();
        assert_eq!(values.len(), axes.iter().map(Vec::len).product::<usize>());
        Self { axes, values }
    }

    fn at(&self, point: &[f64]) -> f64 {
        self.inside(point, 0, 0)
    }

    fn inside(&self, point: &[f64], axis: usize, offset: usize) -> f64 {
        let Some(x) = point.get(axis) else { return self.values[offset] };
        let angles = &self.axes[axis];
        let i = angles.partition_point(|a| a <= x).clamp(1, angles.len() - 1) - 1;
        let t = (x - angles[i]) / (angles[i + 1] - angles[i]);
        assert!((-1e-9..=1.0 + 1e-9).contains(&t), "{x} is outside of the table");
        let side = |i: usize| self.inside(point, axis + 1, offset * angles.len() + i);
        (1.0 - t) * side(i) + t * side(i + 1)
    }
}

/// A primitive of a scene: its type, its words and its numbers.
struct Primitive {
    kind: String,
    words: Vec<String>,
    numbers: Vec<f64>,
}

fn primitives(scene: &str) -> Vec<Primitive> {
    let text: String = scene.lines().filter(|l| !l.starts_with('#')).collect::<Vec<_>>().join("\n");
    let mut words = text.split_whitespace().map(|w| w.trim_matches('"').to_owned());
    let mut out = Vec::new();
    while let Some(_modifier) = words.next() {
        let kind = words.next().expect("a type");
        words.next().expect("a name");
        let mut list = || {
            let count: usize = words.next().expect("a count").parse().expect("a count");
            (0..count).map(|_| words.next().expect("an argument")).collect::<Vec<String>>()
        };
        let (strings, _integers, numbers) = (list(), list(), list());
        let numbers = numbers.iter().map(|w| w.parse().expect("a number")).collect();
        out.push(Primitive { kind, words: strings, numbers });
    }
    out
}

/// Area vectors of flat surfaces; a sphere shows the same from everywhere.
fn surfaces(scene: &[Primitive]) -> Vec<Result<DVec3, f64>> {
    use std::f64::consts::PI;
    scene
        .iter()
        .filter_map(|p| {
            let n = &p.numbers;
            match p.kind.as_str() {
                "polygon" => {
                    let corners: Vec<DVec3> = n.chunks(3).map(DVec3::from_slice).collect();
                    let next = corners.iter().cycle().skip(1);
                    Some(Ok(corners.iter().zip(next).map(|(a, b)| 0.5 * a.cross(*b)).sum()))
                }
                "ring" => Some(Ok(DVec3::new(n[3], n[4], n[5]).normalize() * PI * (n[7] * n[7] - n[6] * n[6]))),
                "sphere" => Some(Err(PI * n[3] * n[3])),
                _ => None,
            }
        })
        .collect()
}

/// Far from the lamp: the sum over the surfaces of radiance × area shown, W/sr.
fn intensity(scene: &[Primitive], data: &Data, towards: DVec3) -> f64 {
    // Radiance's D is the ray's direction, from the receiver to the lamp.
    let ray = -towards;
    let bright = scene.iter().find(|p| p.kind == "brightdata").expect("a distribution");
    let coordinate = |name: &str| match name {
        "src_theta" => ray.z.clamp(-1.0, 1.0).acos().to_degrees(),
        "src_phi" => (-ray.y).atan2(-ray.x).to_degrees().rem_euclid(360.0),
        other => panic!("{other}"),
    };
    assert_eq!(bright.words[2], "source.cal");
    let point: Vec<f64> = bright.words[3..].iter().map(|w| coordinate(w)).collect();
    let (value, a) = (data.at(&point), &bright.numbers);
    let shown = |surface: &Result<DVec3, f64>| surface.map_or_else(|area| area, |s| s.dot(towards).max(0.0));
    let radiance = |surface: &Result<DVec3, f64>| match bright.words[0].as_str() {
        "corr" => a[0] * value,
        "flatcorr" => a[0] * value / surface.expect("a flat surface").normalize().dot(towards),
        "boxcorr" => a[0] * value / (ray.x.abs() * a[2] * a[3] + ray.y.abs() * a[1] * a[3] + ray.z.abs() * a[1] * a[2]),
        other => panic!("{other}"),
    };
    surfaces(scene).iter().filter(|s| shown(s) > 0.0).map(|s| radiance(s) * shown(s)).sum()
}

fn exported(luminaire: &Luminaire) -> (Vec<Primitive>, Data, String) {
    let files = write(luminaire, "my lamp").expect("exported").value;
    assert_eq!(files.iter().map(|f| f.suffix.as_str()).collect::<Vec<_>>(), [".rad", ".dat"]);
    let scene = String::from_utf8(files[0].bytes.clone()).expect("text");
    assert!(scene.contains("\"my lamp.dat\""), "{scene}");
    let text = String::from_utf8(files[1].bytes.clone()).expect("text");
    // A blank in a quoted name would break this test's words.
    (primitives(&scene.replace("my lamp.dat", "my_lamp.dat")), Data::parse(&text), scene)
}

fn agree(luminaire: &Luminaire, unit: f64) {
    let (scene, data, _) = exported(luminaire);
    let peak = luminaire.distribution.peak().0;
    for d in directions(2000) {
        let (got, expected) = (intensity(&scene, &data, d) * unit, luminaire.distribution.towards(d));
        assert!((got - expected).abs() <= ROUNDING * peak, "{:?} {d}: {got} {expected}", luminaire.opening);
    }
}

#[test]
fn every_symmetry_is_the_lamp_in_every_direction() {
    for distribution in tables() {
        agree(&lamp(distribution), LUMENS_PER_WATT);
    }
}

#[test]
fn every_opening_gives_the_same_intensities() {
    for shape in [Shape::Point, Shape::Rectangle, Shape::Round, Shape::Sphere, Shape::CylinderAlongC0] {
        for (length_m, width_m) in [(0.6, 0.2), (0.3, 0.3), (0.03, 1.2), (0.4, 0.0)] {
            for height_m in [0.0, 0.03, 0.3] {
                let opening = Some(Body { shape, length_m, width_m, height_m });
                agree(&Luminaire { opening, ..asymmetric() }, LUMENS_PER_WATT);
            }
        }
    }
    agree(&Luminaire { opening: None, ..asymmetric() }, LUMENS_PER_WATT);
}

#[test]
fn light_between_rows_on_both_sides_of_the_horizon_is_kept() {
    // Nothing at nadir, light at the horizon: the straight line between them is light below.
    let rows = vec![0.0, 90.0, 135.0, 180.0];
    let values = vec![0.0, 300.0, 500.0, 100.0];
    let distribution = Distribution::new(System::TypeC, Symmetry::Rotational, vec![0.0], rows, values);
    agree(&lamp(distribution.expect("a table")), LUMENS_PER_WATT);
}

#[test]
fn light_to_one_side_has_surfaces_on_that_side() {
    let gammas = [tables().remove(5), tables().remove(6)];
    for (distribution, sign) in gammas.into_iter().zip([-1.0, 1.0]) {
        let (scene, ..) = exported(&lamp(distribution));
        let normals: Vec<f64> = surfaces(&scene).into_iter().map(|s| s.expect("flat").normalize().z).collect();
        assert_eq!(normals, [sign]);
    }
}

#[test]
fn the_flux_of_the_data_is_the_lamps() {
    for distribution in tables() {
        let luminaire = lamp(distribution);
        let (_, data, _) = exported(&luminaire);
        let (symmetry, planes) = match &data.axes[..] {
            [_] => (Symmetry::Rotational, vec![0.0]),
            axes => (Symmetry::None, axes[0].clone()),
        };
        let gamma = data.axes.last().expect("γ").clone();
        let back = Distribution::new(System::TypeC, symmetry, planes, gamma, data.values).expect("a table");
        let (got, expected) = (back.total_flux() * LUMENS_PER_WATT, luminaire.distribution.total_flux());
        // The steps at a table's ends are 0.001° wide, half of them light that the lamp does not have.
        let steps = 2.0 * 2.0 * std::f64::consts::PI * 0.0005_f64.to_radians() * luminaire.distribution.peak().0;
        assert!((got - expected).abs() <= steps + 1e-7 * expected, "{got} {expected}");
    }
}

#[test]
fn type_b_is_sampled_where_it_shines() {
    let luminaire = lamp(type_b());
    let (scene, data, _) = exported(&luminaire);
    // A cell of 1° × 1° is at most √2° across, and the table's slopes are at most a few per cent above the formula's.
    let bound = 1.1 * DVec3::new(200.0, 120.0, 300.0).length() * 2.0_f64.sqrt() * 1.0_f64.to_radians();
    for d in directions(4000) {
        let (got, expected) = (intensity(&scene, &data, d) * LUMENS_PER_WATT, luminaire.distribution.towards(d));
        // The edge of darkness lies within a cell.
        if d.z.abs() > 1.0_f64.to_radians() {
            assert!((got - expected).abs() <= bound, "{d}: {got} {expected}");
        }
    }
    let findings = write(&luminaire, "b").expect("exported").findings;
    assert!(findings.iter().any(|f| f.code == "L506"), "{findings:?}");
    assert!(findings.iter().any(|f| f.code == "L504"), "{findings:?}");
    let (planes, gamma) = (data.axes[0].clone(), data.axes[1].clone());
    let back = Distribution::new(System::TypeC, Symmetry::None, planes, gamma, data.values).expect("a table");
    let difference = back.total_flux() * LUMENS_PER_WATT - luminaire.distribution.total_flux();
    assert!(difference.abs() <= flux_bound(bound), "{difference}");
}

#[test]
fn radiant_lamps_stay_in_watts_and_darkness_is_not_negative() {
    let radiant = Luminaire { kind: Kind::Radiant, ..asymmetric() };
    agree(&radiant, 1.0);
    let (_, _, scene) = exported(&radiant);
    assert!(scene.contains("W/sr") && scene.contains("irradiance is in W/m2"), "{scene}");
    let distribution = asymmetric().distribution.scaled(-1.0);
    let checked = write(&lamp(distribution), "dark").expect("exported");
    assert!(checked.findings.iter().any(|f| f.code == "L502"));
    let data = Data::parse(std::str::from_utf8(&checked.value[1].bytes).expect("text"));
    assert!(data.values.iter().all(|v| *v == 0.0));
}

#[test]
fn the_scene_says_how_it_is_oriented() {
    let (_, _, scene) = exported(&asymmetric());
    for words in ["-z is the photometric axis", "+x is C0", "+y is C90", "ies2rad", "179"] {
        assert!(scene.contains(words), "{words}: {scene}");
    }
    // A name with a line break stays a comment.
    assert!(scene.lines().take_while(|l| !l.is_empty()).all(|l| l.starts_with('#')), "{scene}");
    for (name, refused) in [("a\"b", true), ("a\nb", true), ("", true), ("!a", true), ("a b", false), ("R&D's", false)]
    {
        assert_eq!(write(&asymmetric(), name).is_err(), refused, "{name:?}");
    }
}
