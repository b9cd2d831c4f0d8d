//! Any luminaire survives every edition, and no bytes make the reader panic.

use photopic::luminaire::format::ies::{self, ReadOptions, Version};
use photopic::luminaire::{Body, Distribution, Kind, Luminaire, Shape, Symmetry, System};
use proptest::prelude::*;

use super::{SMALL, read};

fn any_luminaire() -> impl Strategy<Value = Luminaire> {
    let shape = prop_oneof![
        Just(Shape::Point),
        Just(Shape::Rectangle),
        Just(Shape::Round),
        Just(Shape::Sphere),
        Just(Shape::CylinderAlongC0),
        Just(Shape::CylinderAlongC90)
    ];
    let symmetry = prop_oneof![
        Just((System::TypeC, Symmetry::Rotational, 0.0, 0.0)),
        Just((System::TypeC, Symmetry::Quadrant, 0.0, 90.0)),
        Just((System::TypeC, Symmetry::BilateralC0, 0.0, 180.0)),
        Just((System::TypeC, Symmetry::BilateralC90, 90.0, 270.0)),
        Just((System::TypeC, Symmetry::None, 0.0, 360.0)),
        Just((System::TypeB, Symmetry::Quadrant, 0.0, 90.0)),
        Just((System::TypeB, Symmetry::None, -90.0, 90.0)),
        Just((System::TypeA, Symmetry::None, -90.0, 90.0)),
    ];
    let parts = (symmetry, shape, 2_usize..12, 2_usize..12, -6_i32..7, any::<[bool; 2]>(), "\\PC{0,40}");
    parts.prop_flat_map(|(table, shape, rows, planes, power, flags, name)| {
        let planes = if table.1 == Symmetry::Rotational { 1 } else { planes };
        proptest::collection::vec(0.0..1.0_f64, rows * planes).prop_map(move |values| {
            let steps = |from: f64, to: f64, n: usize| -> Vec<f64> {
                (0..n).map(|i| if n == 1 { from } else { from + (to - from) * i as f64 / (n - 1) as f64 }).collect()
            };
            let (system, symmetry, from, to) = table;
            let vertical = if system == System::TypeC { (0.0, 180.0) } else { (-90.0, 90.0) };
            let values = values.into_iter().map(|v| (v + 0.01) * 10_f64.powi(power)).collect();
            let distribution = Distribution::new(
                system,
                symmetry,
                steps(from, to, planes),
                steps(vertical.0, vertical.1, rows),
                values,
            );
            let size = if shape == Shape::Point { 0.0 } else { 0.25 };
            let mut lamp = read(SMALL.as_bytes()).expect("a file").value;
            lamp.distribution = distribution.expect("a table");
            lamp.kind = if flags[0] { Kind::Radiant } else { Kind::Luminous };
            lamp.absolute = flags[0] || flags[1];
            lamp.name = name.clone();
            lamp.opening = Some(Body { shape, length_m: size, width_m: size, height_m: size });
            lamp.keywords.push(("Besonderes".into(), name.clone()));
            lamp
        })
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn any_luminaire_survives_every_edition(lamp in any_luminaire()) {
        for version in Version::ALL {
            let text = ies::write(&lamp, version).expect("text").value;
            let back = ies::read(text.as_bytes(), ReadOptions::default()).map_err(|e| TestCaseError::fail(format!("{e}\n{text}")))?.value;
            let ratio = back.distribution.total_flux() / lamp.distribution.total_flux();
            prop_assert!((ratio - 1.0).abs() < 1e-7, "{version}: {ratio}");
            prop_assert!((back.distribution.peak().0 / lamp.distribution.peak().0 - 1.0).abs() < 1e-7);
            prop_assert_eq!(back.kind, lamp.kind);
            prop_assert_eq!(back.distribution.symmetry(), lamp.distribution.symmetry());
            prop_assert!(text.is_ascii() && text.split("\r\n").all(|l| l.len() <= version.line_length()));
        }
    }

    #[test]
    fn any_bytes_are_read_or_refused(bytes in proptest::collection::vec(any::<u8>(), 0..400)) {
        let _ = read(&bytes);
        let mut behind = SMALL.as_bytes()[..60].to_vec();
        behind.extend(&bytes);
        let _ = ies::read(&behind, ReadOptions { repair: true });
    }

    #[test]
    fn any_change_of_a_file_is_read_or_refused(
        at in 0_usize..SMALL.len(), cut in 0_usize..20, put in "([-+0-9.,eEdDnaif \r\n\t\\[\\]=]|\\PC){0,12}", repair: bool
    ) {
        let end = (at + cut).min(SMALL.len());
        let text = format!("{}{put}{}", &SMALL[..at], &SMALL[end..]);
        if let Ok(checked) = ies::read(text.as_bytes(), ReadOptions { repair }) {
            let lamp = checked.value;
            prop_assert!(lamp.distribution.total_flux().is_finite() || lamp.distribution.peak().0 > 1e300);
            for version in Version::ALL {
                let _ = ies::write(&lamp, version);
            }
        }
    }
}
