//! The lights of photographs as JSON, table and text.

use std::fmt::Write;

use glam::DVec3;
use serde_json::{Map, Value, json};

use crate::capture::lights::adjust::Adjusted;
use crate::capture::lights::angle_deg;
use crate::capture::lights::highlight::Highlight;
use crate::capture::lights::list::Difference;
use crate::capture::lights::outline::Outline;
use crate::capture::lights::shading::{Entanglement, Shaded};
use crate::capture::lights::view::Ball;
use crate::capture::setup::Place;
use crate::units::significant;

/// A ball of the photographs.
#[derive(Debug, Clone, PartialEq)]
pub struct BallSeen {
    /// Its name.
    pub name: String,
    /// Its outline.
    pub outline: Outline,
    /// Where it is; `None` of parallel rays, where its outline says all.
    pub ball: Option<Ball>,
}

/// What a photograph told of a light.
#[derive(Debug, Clone, PartialEq)]
pub struct Seen {
    /// The stack.
    pub stack: String,
    /// The photograph.
    pub photo: String,
    /// Number of the light.
    pub light: usize,
    /// Number of the ball.
    pub ball: usize,
    /// What was seen in it.
    pub what: What,
}

/// A highlight, or shading.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum What {
    /// The lamp in a mirror ball.
    Highlight(Highlight),
    /// The direction from a diffuse ball.
    Shading(Shaded),
}

/// A list of directions beside those found.
#[derive(Debug, Clone, PartialEq)]
pub struct Compared {
    /// The list: a file, or the manifest.
    pub source: String,
    /// Numbers of the lights, in the order of the difference.
    pub lights: Vec<usize>,
    /// Listed directions.
    pub listed: Vec<DVec3>,
    /// How far they are from the lights found.
    pub difference: Difference,
}

/// Everything there is to tell.
#[derive(Debug, Clone, Copy)]
pub struct Answer<'a> {
    /// Names of the lights.
    pub names: &'a [String],
    /// The balls.
    pub balls: &'a [BallSeen],
    /// What was seen, in the order of the observations of the adjustment.
    pub seen: &'a [Seen],
    /// Where everything is.
    pub adjusted: &'a Adjusted,
    /// Lists beside it.
    pub compared: &'a [Compared],
    /// What shading tells apart.
    pub entanglement: Option<&'a Entanglement>,
}

impl Answer<'_> {
    /// Towards a light from the first ball.
    #[must_use]
    pub fn direction(&self, light: usize) -> DVec3 {
        direction(self.adjusted, light)
    }
}

/// Towards an adjusted light from the first ball, of length 1.
#[must_use]
pub fn direction(adjusted: &Adjusted, light: usize) -> DVec3 {
    match adjusted.lights[light] {
        Place::Distant(d) => DVec3::from_array(d),
        Place::Near(p) => (DVec3::from_array(p) - adjusted.balls[0].centre).normalize(),
    }
}

fn mean(all: &[f64]) -> f64 {
    all.iter().sum::<f64>() / all.len().max(1) as f64
}

fn extremes(all: &[f64]) -> (f64, f64) {
    all.iter().fold((f64::INFINITY, 0.0), |(l, h), a| (l.min(*a), h.max(*a)))
}

/// Mean angle between directions and what shading alone says of the same lights, degrees, each light once per photograph.
#[must_use]
pub fn from_shading(seen: &[Seen], direction: impl Fn(usize) -> Option<DVec3>) -> Option<f64> {
    let angle = |s: &Seen| match s.what {
        What::Shading(shaded) => direction(s.light).map(|d| angle_deg(d, shaded.direction)),
        What::Highlight(_) => None,
    };
    let all: Vec<f64> = seen.iter().filter_map(angle).collect();
    (!all.is_empty()).then(|| mean(&all))
}

/// The result as JSON.
#[must_use]
pub fn object(a: &Answer<'_>) -> Value {
    let light = |(k, name): (usize, &String)| {
        let mut out = json!({"name": name, "standard_error_deg": a.adjusted.errors_deg[k]});
        match a.adjusted.lights[k] {
            Place::Near(p) => out["position_m"] = json!(p),
            Place::Distant(d) => out["direction"] = json!(d),
        }
        let told = a.seen.iter().enumerate().filter(|(_, s)| s.light == k).map(|(n, s)| evidence(a, n, s));
        out["evidence"] = told.collect();
        let lists = a.compared.iter().filter_map(|c| {
            let at = c.lights.iter().position(|l| *l == k)?;
            let mut row = json!({
                "source": c.source, "direction": c.listed[at].normalize().to_array(),
                "angle_deg": c.difference.angles_deg[at], "angle_after_rotation_deg": c.difference.turned_deg[at],
            });
            if let Some(angle) = from_shading(a.seen, |l| (l == k).then_some(c.listed[at])) {
                row["angle_to_shading_deg"] = angle.into();
            }
            Some(row)
        });
        out["compared"] = lists.collect();
        out
    };
    let ball = |(b, seen): (&Ball, &BallSeen)| {
        let o = &seen.outline;
        let mut out = json!({"name": seen.name, "outline_px": [o.centre.x, o.centre.y, o.radius], "rms_px": o.rms});
        match seen.ball {
            Some(start) => {
                out["centre_m"] = json!(b.centre.to_array());
                out["radius_m"] = json!(b.radius);
                out["moved_m"] = json!((b.centre - start.centre).length());
            }
            None => out["adjusted_px"] = json!([b.centre.x, -b.centre.y, b.radius]),
        }
        out
    };
    let list = |c: &Compared| {
        let d = &c.difference;
        let (least, most) = extremes(&d.angles_deg);
        let mut out = json!({
            "source": c.source, "lights": c.lights.len(), "angle_mean_deg": mean(&d.angles_deg), "angle_min_deg": least,
            "angle_max_deg": most, "rotation_deg": d.rotation_deg, "angle_after_rotation_mean_deg": mean(&d.turned_deg),
            "mirrored_axis": d.mirrored.map(String::from),
        });
        let listed = |l: usize| c.lights.iter().position(|k| *k == l).map(|at| c.listed[at]);
        if let Some(angle) = from_shading(a.seen, listed) {
            out["angle_to_shading_mean_deg"] = angle.into();
        }
        out
    };
    let mut adjustment = json!({"disagreement": a.adjusted.disagreement, "converged": a.adjusted.converged});
    if let Some(c) = &a.adjusted.camera {
        let degrees = |v: &[f64; 7]| [v[1], v[2], v[3]].map(f64::to_degrees);
        let place = |v: &[f64; 7]| [v[4], v[5], v[6]];
        adjustment["focal_length_factor"] = (1.0 + c.moved[0]).into();
        adjustment["camera"] = json!({
            "focal_length_relative": c.moved[0], "focal_length_standard_error": c.errors[0],
            "turn_deg": degrees(&c.moved), "turn_standard_errors_deg": degrees(&c.errors),
            "shift_m": place(&c.moved), "shift_standard_errors_m": place(&c.errors),
            "numbers_told": c.told, "correlations": c.correlations,
        });
    }
    if let Some(angle) = from_shading(a.seen, |l| Some(a.direction(l))) {
        adjustment["angle_to_shading_mean_deg"] = angle.into();
    }
    let mut out = Map::new();
    out.insert("lights".to_owned(), a.names.iter().enumerate().map(light).collect());
    out.insert("balls".to_owned(), a.adjusted.balls.iter().zip(a.balls).map(ball).collect());
    out.insert("adjustment".to_owned(), adjustment);
    out.insert("lists".to_owned(), a.compared.iter().map(list).collect());
    if let Some(e) = a.entanglement {
        let of = |v: [f64; 3]| json!({"offset": v[0], "gamma": v[1], "roughness_rad": v[2]});
        let [bg, bs, gs] = e.correlations;
        let mut model = json!({
            "told_apart": e.is_told_apart(), "rms_codes": e.rms,
            "correlations": {"offset_gamma": bg, "offset_roughness": bs, "gamma_roughness": gs},
        });
        // Numbers that can stand for one another are none.
        if e.is_told_apart() {
            model["values"] = of(e.values);
            model["standard_errors"] = of(e.errors);
        }
        out.insert("shading_model".to_owned(), model);
    }
    Value::Object(out)
}

fn evidence(a: &Answer<'_>, n: usize, s: &Seen) -> Value {
    let mut out = json!({
        "stack": s.stack, "photo": s.photo, "ball": a.balls[s.ball].name,
        "off_deg": a.adjusted.off_deg[n], "off_standard_errors": a.adjusted.off_sigma[n],
    });
    match s.what {
        What::Highlight(h) => {
            out["kind"] = "highlight".into();
            out["pixel"] = json!([h.pixel.x, h.pixel.y]);
            out["pixels"] = h.pixels.into();
            out["other_highlights"] = h.others.into();
            out["spots_beyond_the_edge"] = h.crossing.into();
            if let Some(lamp) = h.lamp {
                out["lamp_px"] = json!([lamp.x, lamp.y]);
            }
        }
        What::Shading(shaded) => {
            out["kind"] = "shading".into();
            out["direction"] = json!(shaded.direction.to_array());
            out["spread_deg"] = shaded.spread_deg.into();
            out["offset_code"] = shaded.offset.into();
            out["residual_relative"] = shaded.residual.into();
        }
    }
    out
}

/// The lights, a row each: `x`, `y`, `z` are the place in m of a near light, the direction of a distant one.
#[must_use]
pub fn csv(a: &Answer<'_>) -> String {
    let mut out = String::from("name,kind,x,y,z,standard_error_deg\n");
    // Writing to a string cannot fail.
    for (k, name) in a.names.iter().enumerate() {
        let (kind, [x, y, z]) = match a.adjusted.lights[k] {
            Place::Near(p) => ("near", p),
            Place::Distant(d) => ("distant", d),
        };
        let _ = writeln!(out, "{name},{kind},{x},{y},{z},{}", a.adjusted.errors_deg[k]);
    }
    out
}

/// The result for people.
#[must_use]
pub fn text(a: &Answer<'_>) -> String {
    let mut out = String::new();
    for (b, seen) in a.adjusted.balls.iter().zip(a.balls) {
        let o = &seen.outline;
        let _ =
            write!(out, "ball {}: middle {:.2}, {:.2}, radius {:.2} px", seen.name, o.centre.x, o.centre.y, o.radius);
        if seen.ball.is_some() {
            let [x, y, z] = b.centre.to_array().map(|v| significant(v, 6));
            let _ = write!(out, "; at {x}, {y}, {z} m, radius {} m", significant(b.radius, 6));
        }
        out.push('\n');
    }
    let width = a.names.iter().map(|n| n.chars().count()).max().unwrap_or(0).max(5);
    let _ = write!(out, "\n{:width$}  {:>8}  {:>10} {:>10} {:>10}  {:>7}", "light", "kind", "x", "y", "z", "± deg");
    let shaded = a.seen.iter().any(|s| matches!(s.what, What::Shading(_)));
    if shaded {
        let _ = write!(out, "  {:>11}", "shading deg");
    }
    for n in 1..=a.compared.len() {
        let _ = write!(out, "  {:>8}", format!("list {n}"));
    }
    out.push('\n');
    for (k, name) in a.names.iter().enumerate() {
        let (kind, place) = match a.adjusted.lights[k] {
            Place::Near(p) => ("near", p),
            Place::Distant(d) => ("distant", d),
        };
        let [x, y, z] = place;
        let error = a.adjusted.errors_deg[k];
        let _ = write!(out, "{name:width$}  {kind:>8}  {x:>10.6} {y:>10.6} {z:>10.6}  {error:>7.3}");
        if shaded {
            let cell = from_shading(a.seen, |l| (l == k).then(|| a.direction(k)));
            let _ = write!(out, "  {:>11}", cell.map_or_else(String::new, |v| format!("{v:.2}")));
        }
        for c in a.compared {
            let cell = c.lights.iter().position(|l| *l == k).map(|at| format!("{:.2}", c.difference.angles_deg[at]));
            let _ = write!(out, "  {:>8}", cell.unwrap_or_default());
        }
        out.push('\n');
    }
    if shaded {
        let _ = writeln!(out, "\nshading: angle to what the diffuse ball says, degrees");
    }
    for (n, c) in a.compared.iter().enumerate() {
        let d = &c.difference;
        let _ = writeln!(
            out,
            "list {}: {}: {:.2} deg off in the mean; after the best common rotation of {:.2} deg, {:.2}",
            n + 1,
            c.source,
            mean(&d.angles_deg),
            d.rotation_deg,
            mean(&d.turned_deg)
        );
    }
    if let Some(e) = a.entanglement {
        let value = |i: usize| format!("{} ± {}", significant(e.values[i], 3), significant(e.errors[i], 2));
        let what = if e.is_told_apart() {
            format!("offset {} codes, gamma {}, roughness {} rad", value(0), value(1), value(2))
        } else {
            "offset, gamma and roughness are not told apart".to_owned()
        };
        let _ = writeln!(
            out,
            "surface and response of the diffuse ball: {what}; correlations {:.2} of offset and gamma, {:.2} of offset and roughness, \
             {:.2} of gamma and roughness",
            e.correlations[0], e.correlations[1], e.correlations[2]
        );
    }
    if let Some(c) = &a.adjusted.camera {
        let value = |k: usize, unit: f64| {
            format!("{} ± {}", significant(unit * c.moved[k], 3), significant(unit * c.errors[k], 2))
        };
        let deg = 1.0_f64.to_degrees();
        let _ = writeln!(
            out,
            "camera against its statement: focal length {} %; turned by {}, {}, {} deg; shifted by {}, {}, {} m; {} of these 7 are told",
            value(0, 100.0),
            value(1, deg),
            value(2, deg),
            value(3, deg),
            value(4, 1.0),
            value(5, 1.0),
            value(6, 1.0),
            c.told
        );
    }
    if let Some(disagreement) = a.adjusted.disagreement {
        let _ = writeln!(out, "observations disagree by {disagreement:.2} of their standard errors");
    }
    out
}
