//! The real files of `../shared/brdf`, with figures from its README and from the files themselves.

use photopic::brdf::coordinates::{HalfDiff, Parameterisation};
use photopic::brdf::format::convert::nodes;
use photopic::brdf::format::{Format, alta, csv, detect, klems, open, zemax};
use photopic::brdf::table::specular::Rim;
use photopic::brdf::table::{Known, Table};
use photopic::geometry::direction::{from_angles, from_degrees};

use super::{codes, shared};

#[test]
fn zemax_integrals_enclose_the_printed_tis() {
    let Some(bytes) = shared("test_13_planesymmetric_brdf_zemax.bsdf") else { return };
    assert_eq!(detect(&bytes), Some(Format::Zemax));
    let read = zemax::parse(&bytes).expect("a table");
    assert!(codes(&read.findings).contains(&"B103"), "{:?}", read.findings);
    let table = &read.value.table;
    assert_eq!((table.incidences_deg().len(), read.value.printed.len()), (13, 13));
    assert!((read.value.printed[0] - 0.134_506).abs() < 1e-12 && (read.value.printed[12] - 0.257_189_2).abs() < 1e-12);
    // Another program's integrals of the same file, as printed: cut at the last radial angle, and going on to the horizon.
    for (angle, cut, extrapolated) in [(15.0, 0.1299, 0.1359), (75.0, 0.2213, 0.2760)] {
        let integral = |rim| table.scatter(angle, rim)[0];
        let found = [Rim::Cut, Rim::Extrapolated, Rim::Filled].map(integral);
        println!("{angle}°: {found:.5?}");
        assert!((found[0] - cut).abs() < 5e-5 && (found[1] - extrapolated).abs() < 5e-5, "{found:?}");
        // Zeros below the horizon pull their neighbours down where they count as values.
        assert!(found[2] > found[1]);
    }
    for (angle, tis) in table.incidences_deg().iter().zip(&read.value.printed) {
        assert!(
            (table.scatter(*angle, Rim::Cut)[0]..table.scatter(*angle, Rim::Filled)[0]).contains(tis),
            "{angle}: {tis}"
        );
    }
}

#[test]
fn zemax_nodes_are_where_the_file_says() {
    let Some(bytes) = shared("test_13_planesymmetric_brdf_zemax.bsdf") else { return };
    let table = open(&bytes, None).expect("a table").value.table;
    let mut v = [0.0];
    // θ_i = 15°: the mirror direction holds 6.375E-02; 5° further from the normal (α = 180°) 6.406E-02, 5° towards it (α = 0)
    // 6.180E-02.
    for (theta_o, expected) in [(15.0, 6.375e-2), (20.0, 6.406e-2), (10.0, 6.180e-2)] {
        let known = table.value(from_degrees(15.0, 40.0), from_degrees(theta_o, 220.0), &mut v);
        assert!(known == Known::Measured && (v[0] - expected).abs() < 1e-9, "{theta_o}: {} {known:?}", v[0]);
    }
    // θ_i = 75°, α = 180°, β = 10° lies at 85°: 9.745 is in the table at 5° and the horizon beyond.
    let known = table.value(from_degrees(75.0, 0.0), from_degrees(88.0, 180.0), &mut v);
    assert!(known == Known::Inferred && v[0] > 5.0, "{} {known:?}", v[0]);
}

#[test]
fn klems_matrices_are_read_behind_a_junk_line() {
    let Some(bytes) = shared("test_blinds_kf.xml") else { return };
    assert_eq!(detect(&bytes), Some(Format::Klems));
    let read = klems::parse(&bytes).expect("matrices");
    assert_eq!(codes(&read.findings), ["B102"]);
    let back = read.value.iter().find(|b| b.direction == "Transmission Back").expect("its transmission");
    assert_eq!(back.wavelength, "Visible");
    assert_eq!(back.patches.coverage(), (145 * 145, 0));
    assert_eq!(back.patches.element(0, 0), [34.65]);
    // The first row goes on with column 1, the second begins with 4.678e-05 and 35.30.
    assert_eq!((back.patches.element(0, 1), back.patches.element(1, 0)), (&[1.352e-3][..], &[4.678e-5][..]));
    assert_eq!(back.patches.element(1, 1), [35.30]);
    // π in projected solid angle.
    let sum: f64 = back.patches.rings().iter().map(|r| r.projected_solid_angle() * r.sectors as f64).sum();
    assert!((sum - std::f64::consts::PI).abs() < 1e-12);
    let file = open(&bytes, None).expect("a reflection");
    assert!(matches!(file.value.table, Table::Patches(_)) && codes(&file.findings) == ["B102", "B106"]);
    for block in &read.value {
        for patch in 0..145 {
            let r = block.patches.reflectance(patch)[0];
            assert!((0.0..=1.0).contains(&r), "{} {patch}: {r}", block.direction);
        }
    }
}

#[test]
fn alta_text_and_binary_agree() {
    let (Some(text), Some(binary)) =
        (shared("brdf_small_simu_two_layers_txt.alta"), shared("brdf_small_simu_two_layers_binary.alta"))
    else {
        return;
    };
    let [text, binary] = [text, binary].map(|b| alta::parse(&b).expect("points").value);
    assert_eq!((text.len(), binary.len()), (29, 29));
    for ((i, o, v), (i2, o2, v2)) in text.iter().zip(binary.iter()) {
        // 17 decimals were printed.
        assert!((i - i2).length() < 1e-15 && (o - o2).length() < 1e-15);
        v.iter().zip(v2).for_each(|(a, b)| assert!((a - b).abs() < 1e-16, "{a} {b}"));
    }
    // Second point: θ_v = 0, θ_l = 0.0087, and its values.
    let (i, o, v) = text.iter().nth(1).expect("29 points");
    assert!((i - from_angles(0.008_726_646_259_971_65, 0.0)).length() < 1e-15 && (o.z - 1.0).abs() < 1e-15);
    assert_eq!(v, [0.0, 0.016_414_031_750_058_73, 0.019_696_838_100_070_47]);
}

#[test]
fn written_alta_is_what_was_read() {
    for name in ["brdf_small_simu_two_layers_txt.alta", "pink-felt-1d.alta", "retro-3M-jaune.dat"] {
        let Some(bytes) = shared(name) else { return };
        let read = alta::parse(&bytes).expect("points").value;
        for encoding in [alta::Encoding::Text, alta::Encoding::Binary] {
            let again = alta::parse(&alta::write(&read, encoding).value).expect("our own file");
            assert_eq!((again.value.len(), codes(&again.findings).len()), (read.len(), 0), "{name}");
            for ((i, o, v), (i2, o2, v2)) in read.iter().zip(again.value.iter()) {
                assert!(
                    (i - i2).length() < 1e-12 && (o - o2).length() < 1e-12 && v == v2,
                    "{name}: {i} {o}, {i2} {o2}"
                );
            }
        }
    }
}

#[test]
fn pink_felt_depends_on_the_half_vector_alone() {
    let Some(bytes) = shared("pink-felt-1d.alta") else { return };
    let file = open(&bytes, None).expect("points").value;
    let Table::Points(points) = &file.table else { panic!("{file:?}") };
    assert_eq!(points.parameterisation(), Parameterisation::CosHalf);
    // Its third line, cosθ_h = 0.999614…, at any θ_d, φ_d.
    let theta_h = 0.999_614_111_167_918_f64.acos();
    let mut v = [0.0; 3];
    for (theta_d, phi_d) in [(0.0, 0.0), (0.9, 2.0)] {
        let (i, o) = HalfDiff { theta_h, phi_h: 1.0, theta_d, phi_d }.directions();
        assert_eq!(file.table.value(i, o, &mut v), Known::Measured);
        for (v, expected) in v.iter().zip([0.109_124_042_093_754, 0.079_037_696_123_123_2, 0.061_592_094_600_200_7]) {
            // acos of a cosine of 15 digits near 1 has 12.
            assert!((v - expected).abs() < 1e-9, "{v} {expected}");
        }
    }
}

#[test]
fn the_retro_reflector_shines_back() {
    let Some(bytes) = shared("retro-3M-jaune.dat") else { return };
    let read = alta::parse(&bytes).expect("points");
    assert!(codes(&read.findings).contains(&"B107") && codes(&read.findings).contains(&"B110"), "{:?}", read.findings);
    // Lit at 15° and 30° the brightest direction on the light's own side is the light's, to within the grid's 1°.
    for theta_i in [15.0_f64, 30.0] {
        let lit = read.value.iter().filter(|(i, o, _)| (i.z - theta_i.to_radians().cos()).abs() < 1e-9 && o.x > 0.0);
        let (i, o, v) = lit.max_by(|a, b| a.2[0].total_cmp(&b.2[0])).expect("points");
        assert!(i.angle_between(o).to_degrees() < 1.5, "{i} {o} {v:?}");
    }
}

#[test]
fn a_zemax_table_becomes_rows_of_its_own_angles() {
    let Some(bytes) = shared("test_13_planesymmetric_brdf_zemax.bsdf") else { return };
    let table = open(&bytes, None).expect("a table").value.table;
    let points = nodes(&table).expect("points").value;
    let written = csv::write(&points);
    // The pole β = 0 of 13 angles of incidence stands in 19 azimuths.
    assert!(written.findings[0].message.starts_with("234 points"), "{:?}", written.findings);
    let read = open(written.value.as_bytes(), None).expect("our own file");
    assert_eq!((read.value.format, read.value.table.coverage()), (Format::Csv, (points.len() - 234, 0)));
    assert!(read.value.table.is_isotropic() && read.value.table.channels() == table.channels());
    // As the file has them at θ_i = 15°: the mirror direction, 5 and 40° from it towards the normal, 30° from it to the horizon.
    for row in [
        "15,0,15,180,Monochrome,0.06375",
        "15,0,10,180,Monochrome,0.0618",
        "15,0,25,0,Monochrome,0.04038",
        "15,0,45,180,Monochrome,0.054",
    ] {
        assert!(written.value.lines().any(|l| l == row), "{row}");
    }
}
