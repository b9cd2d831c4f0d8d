//! Files built here from the published descriptions: UTIA, ASTM, CSV.

use photopic::brdf::format::{Format, astm, csv, detect, open, utia};
use photopic::brdf::table::{Channel, Known, Table};
use photopic::geometry::direction::from_degrees;

use super::codes;

#[test]
fn utia_planes_are_light_by_view() {
    // The value tells its place: θ_i, φ_i, θ_v, φ_v in units of their steps, and the plane.
    let mut bytes = Vec::new();
    for plane in 0..3 {
        for (ti, pi) in (0..6).flat_map(|t| (0..48).map(move |p| (t, p))) {
            for (tv, pv) in (0..6).flat_map(|t| (0..48).map(move |p| (t, p))) {
                let value = f64::from(plane)
                    + 0.1 * f64::from(ti)
                    + 1e-3 * f64::from(pi)
                    + 1e-5 * f64::from(tv)
                    + 1e-7 * f64::from(pv);
                bytes.extend_from_slice(&value.to_le_bytes());
            }
        }
    }
    assert_eq!((bytes.len(), detect(&bytes)), (1_990_656, Some(Format::Utia)));
    let table = utia::parse(&bytes).expect("a table").map(Table::Angular);
    assert_eq!(codes(&table.findings), ["B107"]);
    let mut v = [0.0; 3];
    let known = table.value.value(from_degrees(30.0, 15.0), from_degrees(45.0, 82.5), &mut v);
    for (c, v) in v.iter().enumerate() {
        assert!((v - (c as f64 + 0.2 + 0.002 + 3e-5 + 11e-7)).abs() < 1e-12, "{v}");
    }
    assert_eq!(known, Known::Measured);
    // Linear between nodes, around the circle too: between φ_v = 352.5° (47) and 0.
    table.value.value(from_degrees(37.5, 15.0), from_degrees(45.0, 356.25), &mut v);
    assert!((v[0] - (0.25 + 0.002 + 3e-5 + 23.5e-7)).abs() < 1e-12, "{}", v[0]);
    // Beyond 75° nothing was measured.
    assert_eq!(table.value.value(from_degrees(80.0, 0.0), from_degrees(10.0, 0.0), &mut v), Known::Inferred);
    assert_eq!(v[0], 0.5 + 0.0 + 1e-5 * (10.0 / 15.0) + 0.0);
}

#[test]
fn astm_points_in_degrees_and_radians() {
    let degrees = "ASTM E1392\nNUM_POINTS 3\nVARS theta_i,phi_i,theta_s,phi_s,450nm,650 nm\n30,0,30,180,0.5,0.25\n30,0,10,90,0.2,0.1\n45,90,0,0,0.1,0.1\n";
    let read = astm::parse(degrees.as_bytes()).expect("points");
    assert_eq!(codes(&read.findings), ["B107"]);
    assert_eq!(detect(degrees.as_bytes()), Some(Format::Astm));
    assert_eq!(read.value.channels(), [Channel::Wavelength(450.0), Channel::Wavelength(650.0)]);
    let mut v = [0.0; 2];
    assert_eq!(read.value.value(from_degrees(30.0, 0.0), from_degrees(30.0, 180.0), &mut v), Known::Measured);
    assert_eq!(v, [0.5, 0.25]);
    assert!(!read.value.is_isotropic());
    let radians = "NUM_POINTS 2\nVARS theta_i,phi_i,theta_s,phi_s,R,G,B\n0.5,0,0.5,3.141592653589793,1,2,3\n";
    let read = astm::parse(radians.as_bytes()).expect("points");
    assert_eq!(codes(&read.findings), ["B105", "B107"]);
    let (i, o, v) = read.value.iter().next().expect("a point");
    assert!((i.x - 0.5_f64.sin()).abs() < 1e-15 && (o.x + 0.5_f64.sin()).abs() < 1e-15 && v == [1.0, 2.0, 3.0]);
}

#[test]
fn csv_round_trip_in_any_order_of_columns() {
    let text = "value;wavelength_nm;phi_o_deg;theta_o_deg;phi_i_deg;theta_i_deg\n\
        0.5;550;180;30;0;30\n0.4;650;180;30;0;30\n0.1;550;90;60;0;30\n0.2;650;90;60;0;30\n";
    let read = open(text.as_bytes(), None).expect("points");
    assert!(read.value.format == Format::Csv && read.findings.is_empty());
    let Table::Points(points) = &read.value.table else { panic!("points") };
    let mut v = [0.0; 2];
    points.value(from_degrees(30.0, 10.0), from_degrees(60.0, 100.0), &mut v);
    assert_eq!(v, [0.1, 0.2], "one azimuth of incidence alone: isotropic, so that only the difference counts");
    let again = csv::parse(csv::write(points).value.as_bytes()).expect("our own file").value;
    assert_eq!(again.channels(), points.channels());
    for ((i, o, v), (i2, o2, v2)) in points.iter().zip(again.iter()) {
        assert!((i - i2).length() < 1e-15 && (o - o2).length() < 1e-15 && v == v2);
    }
}
