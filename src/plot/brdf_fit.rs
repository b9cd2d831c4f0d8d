//! From a table and its fit to panels: lobes in the plane of incidence, and value against value.

use super::{DotsPanel, Series};
use crate::brdf::Brdf;
use crate::brdf::fit::Samples;
use crate::brdf::table::{Known, Table};
use crate::geometry::direction::from_degrees;

/// Dots of a scatter drawing at most.
const MOST_DOTS: usize = 4000;

/// Measured values in the plane of incidence as dots, the model as a line; `in_table` and `band` are the band's numbers in both.
#[must_use]
pub fn lobes_panel(
    table: &Table,
    in_table: usize,
    brdf: &dyn Brdf,
    band: usize,
    thetas_deg: &[f64],
    title: String,
) -> DotsPanel {
    let mut measured = vec![0.0; table.channels().len()];
    let mut model = vec![0.0; brdf.bands()];
    let mut series = |t: &f64| {
        let incident = from_degrees(*t, 180.0);
        let mut out = Series { name: format!("light at {t}°"), ..Series::default() };
        for i in -895..=895 {
            let angle = 0.1 * f64::from(i);
            let outgoing = from_degrees(angle.abs(), if angle < 0.0 { 180.0 } else { 0.0 });
            brdf.evaluate(incident, outgoing, &mut model);
            out.line.push((angle, model[band]));
            // Every third degree, and closer about the mirror direction.
            let close = (angle - t).abs();
            let wanted = i % 30 == 0 || close < 3.0 && i % 5 == 0 || close < 10.0 && i % 10 == 0;
            if wanted && table.value(incident, outgoing, &mut measured) == Known::Measured {
                out.dots.push((angle, measured[in_table]));
            }
        }
        out
    };
    DotsPanel {
        title,
        x_label: "outgoing angle [°], the light comes from the left".to_owned(),
        y_label: "BRDF [1/sr], dots: table, lines: model".to_owned(),
        both_logarithmic: false,
        series: thetas_deg.iter().map(&mut series).collect(),
    }
}

/// The model's value over the measured one, at places drawn evenly from those that took part.
#[must_use]
pub fn scatter_panel(samples: &Samples, brdf: &dyn Brdf, band: usize) -> DotsPanel {
    let chosen = samples.subset(MOST_DOTS);
    let mut model = vec![0.0; brdf.bands()];
    let mut dots = Vec::new();
    for (incident, outgoing, values) in chosen.as_ref().unwrap_or(samples).iter() {
        brdf.evaluate(incident, outgoing, &mut model);
        dots.push((values[band], model[band]));
    }
    let ends = dots.iter().flat_map(|d| [d.0, d.1]).filter(|v| *v > 0.0);
    let (low, high) = ends.fold((f64::MAX, 0.0_f64), |(a, b), v| (a.min(v), b.max(v)));
    let line = (0..=200).map(|i| low * (high / low).powf(f64::from(i) / 200.0)).map(|v| (v, v)).collect();
    DotsPanel {
        title: "model against table".to_owned(),
        x_label: "table [1/sr]".to_owned(),
        y_label: "model [1/sr]".to_owned(),
        both_logarithmic: true,
        series: vec![Series { name: String::new(), dots, line }],
    }
}
