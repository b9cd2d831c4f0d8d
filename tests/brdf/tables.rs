//! The sampler of measured tables, with the harness of the models': bins of models, and the real files of `../shared/brdf`.

use photopic::brdf::format::open;
use photopic::brdf::table::{Channel, HalfAngle, Resolution, SampledTable, Table};
use rayon::prelude::*;

use crate::common;
use crate::material;
use crate::sampling::check;

/// A model in bins of half and difference angles, what lies below the horizon missing.
fn bins(text: &str) -> Table {
    const RESOLUTION: Resolution = Resolution { theta_h: 30, theta_d: 30, phi_d: 36 };
    let model = material(text);
    let value = |bin: usize| {
        let (i, o) = RESOLUTION.centre(bin).directions();
        if i.z > 0.0 && o.z > 0.0 { crate::value(model.as_ref(), i, o) as f32 } else { f32::NAN }
    };
    let values = (0..RESOLUTION.bins()).map(value).collect();
    HalfAngle::new(RESOLUTION, vec![Channel::Wavelength(555.0)], values).expect("a table").into()
}

#[test]
fn tables_draw_what_their_density_says() {
    let mut tables: Vec<(String, Table)> = [
        "lambert(reflectance=0.5)",
        "ggx(alpha=0.3, medium=Au)",
        "0.5*lambert(reflectance=0.4) + 0.5*ggx(alpha=0.15, eta=1.5)",
    ]
    .map(|text| (format!("bins of {text}"), bins(text)))
    .to_vec();
    for name in
        ["retro-3M-jaune.dat", "pink-felt-1d.alta", "test_13_planesymmetric_brdf_zemax.bsdf", "test_blinds_kf.xml"]
    {
        if let Some(path) = common::shared(&format!("brdf/{name}")) {
            let bytes = std::fs::read(path).expect("the file of the shared folder");
            tables.push((name.to_owned(), open(&bytes, None).expect("a table").value.table));
        }
    }
    let jobs: Vec<(String, SampledTable, f64)> = (tables.into_iter())
        .flat_map(|(name, table)| {
            let sampled = SampledTable::new(table);
            [10.0, 40.0, 75.0].map(|theta| (name.clone(), sampled.clone(), theta))
        })
        .collect();
    jobs.par_iter()
        .enumerate()
        .for_each(|(i, (name, table, theta))| check(name, table, *theta, 100_000, 1000 + i as u64));
}
