//! Figures of luminaires against the reference table: angles, flux codes, zones, spacing criteria, to its printed digits.

mod common;

use std::collections::BTreeMap;
use std::fs;

use photopic::luminaire::beam::{Definition, PlaneAngles, beam_angles, field_angles};
use photopic::luminaire::{Kind, Luminaire, System, format, lcs, luminance, nema, spacing, zonal};

/// The rows whose reference is whole: header → cell and the luminaire. Mutants may be refused; real files may not.
fn readable() -> Option<Vec<(BTreeMap<String, String>, Luminaire)>> {
    let folder = common::shared("luminaires")?;
    let mut out = Vec::new();
    for row in common::rows(&folder.join("reference.csv")) {
        let lit = row["flux_exact"].parse().is_ok_and(|flux: f64| flux > 0.0);
        if row["ref_status"] != "ok" || !lit {
            continue;
        }
        let bytes = fs::read(folder.join("files").join(&row["file"])).expect("a listed file");
        match format::read(&bytes, &Default::default()) {
            Ok(read) => out.push((row.into_iter().collect(), read.value)),
            Err(e) => assert_ne!(row["kind"], "real", "{}: {e}", row["file"]),
        }
    }
    assert!(out.len() > 100, "only {} files of the reference were read", out.len());
    Some(out)
}

/// The rows that the figures are compared on: those whose flux is read as the reference reads it (what a reader makes of
/// damaged files is another test's business). The reference takes the numbers of radiometric files as they stand.
fn comparable() -> Option<Vec<(BTreeMap<String, String>, Luminaire)>> {
    let mut rows = readable()?;
    rows.retain_mut(|(row, lamp)| {
        let ratio = number(row, "flux_exact").expect("a flux") / lamp.distribution.total_flux();
        if lamp.kind == Kind::Luminous {
            let same = (ratio - 1.0).abs() < 1e-5;
            assert!(same || row["kind"] != "real", "{}: {} of the reference's flux", row["file"], 1.0 / ratio);
            return same;
        }
        lamp.distribution = lamp.distribution.scaled(10f64.powf(ratio.log10().round()));
        (ratio.log10() - ratio.log10().round()).abs() < 1e-5
    });
    Some(rows)
}

fn number(row: &BTreeMap<String, String>, key: &str) -> Option<f64> {
    row[key].parse().ok().filter(|v: &f64| v.is_finite())
}

/// Half a unit of the last of six significant digits or of the fourth decimal, whichever is coarser; the reference was rounded
/// to four decimals before.
fn printed(value: f64) -> f64 {
    let six_digits = if value == 0.0 { 0.0 } else { 0.5e-5 * 10f64.powi(value.abs().log10().floor() as i32) };
    six_digits + 0.51e-4
}

#[test]
fn beam_and_field_angles_are_those_of_the_reference() {
    let Some(rows) = comparable() else { return };
    let (mut compared, mut worst) = (0, 0.0_f64);
    for (row, lamp) in &rows {
        let mut check = |got: Option<f64>, key: &str| {
            let expected = number(row, key);
            assert_eq!(got.is_some(), expected.is_some(), "{} {key}: {got:?} against {expected:?}", row["file"]);
            if let (Some(a), Some(b)) = (got, expected) {
                compared += 1;
                worst = worst.max((a - b).abs());
                assert!((a - b).abs() < 5.1e-4, "{} {key}: {a} against {b}", row["file"]);
            }
        };
        let sets = [("beam50", beam_angles(&lamp.distribution)), ("field10", field_angles(&lamp.distribution))];
        for (name, angles) in sets {
            for PlaneAngles { definition, c0_c180, c90_c270 } in angles {
                if lamp.distribution.system() != System::TypeC {
                    // The reference has the full widths of the cuts through the axis.
                    if definition == Definition::Fwhm {
                        check(c0_c180, &format!("{name}_h"));
                        check(c90_c270, &format!("{name}_v"));
                    }
                    continue;
                }
                let suffix = match definition {
                    Definition::Fwhm => "",
                    Definition::Outermost => "_outer",
                    Definition::OfNadir => "_ctr",
                };
                check(c0_c180, &format!("{name}{suffix}_c0"));
                check(c90_c270, &format!("{name}{suffix}_c90"));
            }
        }
    }
    eprintln!("{compared} angles of {} files, worst difference {worst:.1e}°", rows.len());
}

#[test]
fn zones_flux_codes_and_downward_fractions_are_those_of_the_reference() {
    let Some(rows) = comparable() else { return };
    let mut compared = 0;
    for (row, lamp) in rows.iter().filter(|(_, lamp)| lamp.distribution.system() == System::TypeC) {
        let file = &row["file"];
        let zones = zonal::zones(&lamp.distribution, 30.0).expect("Type C");
        let expected: Vec<f64> = row["zones30"].split_whitespace().map(|z| z.parse().expect("a flux")).collect();
        assert_eq!(expected.len(), 6, "{file}");
        for (zone, flux) in zones.iter().zip(expected) {
            assert!((zone.flux - flux).abs() < printed(flux), "{file}: {zone:?} against {flux}");
        }
        let ten: f64 = zonal::zones(&lamp.distribution, 10.0).expect("Type C").iter().map(|z| z.flux).sum();
        assert!((ten / lamp.distribution.total_flux() - 1.0).abs() < 1e-12, "{file}");
        let down = zonal::downward_flux_fraction(&lamp.distribution).expect("lit");
        assert!((down - number(row, "down_frac").expect("a share")).abs() < 5.1e-8, "{file}: {down}");
        let code: Vec<f64> = row["cie_flux"].split_whitespace().filter_map(|n| n.parse().ok()).collect();
        if let Ok(got) = zonal::cie_flux_code(lamp) {
            for (a, b) in got.n1_to_n4.iter().zip(code) {
                assert!((a - b).abs() < 5.1e-3, "{file}: {got:?} against {}", row["cie_flux"]);
            }
        } else {
            assert!(code.iter().all(|n| n.is_nan()) || code.is_empty() || down == 0.0, "{file}: {code:?}");
        }
        compared += 1;
    }
    assert!(compared > 100, "only {compared} files");
}

#[test]
fn spacing_criteria_are_those_that_photometric_toolbox_prints() {
    let Some(rows) = comparable() else { return };
    let mut compared = 0;
    for (row, lamp) in rows.iter().filter(|(row, _)| !row["toolbox_SC"].is_empty()) {
        let s = spacing::spacing_criterion(&lamp.distribution).expect("lit below");
        let expected: Vec<f64> = row["toolbox_SC"].split('/').map(|v| v.parse().expect("a number")).collect();
        assert_eq!([s.c0_c180, s.c90_c270, s.diagonal].as_slice(), expected, "{}", row["file"]);
        compared += 1;
    }
    assert_eq!(compared, 4);
}

#[test]
fn the_flood_is_a_7_by_6() {
    let Some(rows) = comparable() else { return };
    let types: Vec<_> = rows.iter().filter_map(|(_, lamp)| nema::nema_types(&lamp.distribution)).collect();
    // Field angles 146° and 107°, the one open Type B file.
    assert!(types.contains(&(7, 6)), "{types:?}");
}

#[test]
fn outdoor_zones_add_up_whatever_the_street_side() {
    let Some(rows) = comparable() else { return };
    for (row, lamp) in rows.iter().filter(|(_, lamp)| lamp.distribution.system() == System::TypeC) {
        for street in [lcs::STREET_C_DEG_IES, lcs::STREET_C_DEG_EULUMDAT, 33.0] {
            let zones = lcs::lcs(&lamp.distribution, street).expect("Type C");
            let sum: f64 = zones.named().iter().map(|(_, v)| v).sum();
            assert!((sum / lamp.distribution.total_flux() - 1.0).abs() < 1e-11, "{} {street}", row["file"]);
        }
    }
}

#[test]
fn luminances_times_areas_are_intensities() {
    let Some(rows) = comparable() else { return };
    let mut compared = 0;
    for (row, lamp) in &rows {
        let Ok(table) = luminance::luminance_table(lamp, &luminance::TABLE_GAMMA_DEG) else { continue };
        assert_eq!(table.len(), 24, "{}", row["file"]);
        let body = lamp.opening.as_ref().expect("it has a luminance");
        for line in table {
            for (gamma, cell) in luminance::TABLE_GAMMA_DEG.iter().zip(line.cd_per_m2) {
                let area = luminance::projected_area_m2(body, line.c_deg, *gamma);
                let back = cell.expect("seen below the horizontal") * area;
                assert!(
                    (back - lamp.distribution.at(line.c_deg, *gamma)).abs() <= 1e-12 * back.abs(),
                    "{}",
                    row["file"]
                );
            }
        }
        compared += 1;
    }
    assert!(compared > 30, "only {compared} files have a luminous opening");
}
