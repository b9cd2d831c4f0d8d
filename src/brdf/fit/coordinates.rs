//! The variables of a fit: open parameters in coordinates in which steps of equal length mean about the same.
//!
//! | range of the parameter | coordinate |
//! |---|---|
//! | begins above 0 (`alpha`, `eta`) | ln x |
//! | 0 to beyond 1000 (`n`, `nu`, `k`, `b`) | ln(1 + x) |
//! | any other | x |
//!
//! `kd` and `ks` of models in which kd + ks ≤ 1 are varied as their sum s and the share t of kd, both from 0 to 1: a box again.

use super::{Error, Scope};
use crate::brdf::description::template::{Open, Template};
use crate::brdf::parameter::{Kind, Parameter};
use crate::math::random::Stream;

/// How a parameter is varied.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Scale {
    Linear,
    Log,
    Log1p,
    /// kd + ks, the partner being the share.
    Sum(usize),
    /// kd/(kd + ks), the partner being the sum.
    Share(usize),
}

/// An open parameter as one variable, or one per band.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Column {
    scale: Scale,
    pub(super) shared: bool,
    /// Its first variable.
    pub(super) first: usize,
    low: f64,
    high: f64,
    /// Where starts lie, in the parameter's own units.
    usual: (f64, f64),
    start: Option<f64>,
}

/// All variables of a fit.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Coordinates {
    pub(super) columns: Vec<Column>,
    pub(super) bands: usize,
    pub(super) count: usize,
}

impl Coordinates {
    pub(super) fn new(template: &Template, scope: &Scope, bands: usize) -> Result<Self, Error> {
        let open = template.open();
        if open.is_empty() {
            return Err(Error::NothingOpen);
        }
        for name in scope.shared.iter().chain(&scope.per_band) {
            if !open.iter().any(|o| names(name, o)) {
                return Err(Error::Name { name: name.clone(), known: known(open) });
            }
        }
        let mut columns = Vec::with_capacity(open.len());
        let mut count = 0;
        for o in open {
            let per_band = o.parameter.kind == Kind::Spectral;
            if !per_band && scope.per_band.iter().any(|n| n != Scope::ALL && names(n, o)) {
                return Err(Error::OneNumber { name: o.parameter.name });
            }
            let listed = |list: &[String]| list.iter().any(|n| n != Scope::ALL && names(n, o));
            let all = |list: &[String]| list.iter().any(|n| n == Scope::ALL);
            let shared =
                !per_band || bands == 1 || listed(&scope.shared) || all(&scope.shared) && !listed(&scope.per_band);
            columns.push(Column {
                scale: scale(&o.parameter),
                shared,
                first: count,
                low: o.parameter.low,
                high: o.parameter.high,
                usual: usual(&o.parameter),
                start: o.start,
            });
            count += if shared { 1 } else { bands };
        }
        let mut out = Self { columns, bands, count };
        out.join(template);
        Ok(out)
    }

    /// Holds kd + ks ≤ 1 where a model asks for it.
    fn join(&mut self, template: &Template) {
        let open = template.open();
        for (i, o) in open.iter().enumerate() {
            let classic = template.word(o.part, "form") == Some("classic");
            let (name, other) = match (o.model, o.parameter.name) {
                ("ward", "kd") | ("phong" | "blinn-phong", "kd") if !classic => ("kd", "ks"),
                ("ward", "ks") | ("phong" | "blinn-phong", "ks") if !classic => ("ks", "kd"),
                _ => continue,
            };
            let partner = open.iter().position(|p| p.part == o.part && p.parameter.name == other);
            match partner {
                Some(p) if self.columns[p].shared == self.columns[i].shared => {
                    let column = &mut self.columns[i];
                    (column.low, column.high) = (0.0, 1.0);
                    column.scale = if name == "kd" { Scale::Sum(p) } else { Scale::Share(p) };
                }
                Some(_) => self.columns[i].high = 1.0,
                None => {
                    let given = template.given(o.part, other).unwrap_or(&[]).iter().copied().fold(0.0, f64::max);
                    self.columns[i].high = (1.0 - given).max(0.0);
                }
            }
            let column = &mut self.columns[i];
            column.usual = (0.05 * column.high, 0.9 * column.high);
        }
    }

    /// The variable of a column in a band.
    pub(super) fn variable(&self, column: usize, band: usize) -> usize {
        let c = &self.columns[column];
        if c.shared { c.first } else { c.first + band }
    }

    /// Bounds of the variables.
    pub(super) fn bounds(&self) -> (Vec<f64>, Vec<f64>) {
        let (mut low, mut high) = (vec![0.0; self.count], vec![0.0; self.count]);
        for (c, column) in self.columns.iter().enumerate() {
            for band in 0..self.bands {
                let v = self.variable(c, band);
                (low[v], high[v]) = (column.inside(column.low), column.inside(column.high));
            }
        }
        (low, high)
    }

    /// A place to start from; number 0 is the middle of the usual ranges, number 1 the simplest material: what can be nothing, is
    /// (a lobe's weight, a spread of slopes), so that a model finds at least what the models in it find. A start that was given
    /// holds for all of them.
    pub(super) fn start(&self, number: u64) -> Vec<f64> {
        let mut random = Stream::new(START_SEED, number);
        let drawn: Vec<f64> = (self.columns.iter())
            .map(|c| {
                let (a, b) = (c.inside(c.usual.0), c.inside(c.usual.1));
                let share = if number < 2 { 0.5 } else { random.uniform() };
                match (c.start, c.scale) {
                    (Some(given), _) => c.inside(given),
                    (None, Scale::Linear) if number == 1 => c.low,
                    (None, _) => a + share * (b - a),
                }
            })
            .collect();
        let mut out = vec![0.0; self.count];
        for (c, column) in self.columns.iter().enumerate() {
            // A pair in which a start was given is put together from the two values.
            let value = match column.scale {
                Scale::Sum(p) if column.start.or(self.columns[p].start).is_some() => drawn[c] + drawn[p],
                Scale::Share(p) if column.start.or(self.columns[p].start).is_some() => {
                    drawn[p] / (drawn[c] + drawn[p]).max(f64::MIN_POSITIVE)
                }
                _ => drawn[c],
            };
            (0..self.bands).for_each(|b| out[self.variable(c, b)] = value);
        }
        out
    }

    /// The parameters' values: of each column one, or one per band.
    pub(super) fn values(&self, x: &[f64]) -> Vec<Vec<f64>> {
        let value = |c: usize, band: usize| {
            let v = x[self.variable(c, band)];
            let column = &self.columns[c];
            match column.scale {
                Scale::Linear => v,
                // Out of the logarithm and back in, a bound may be passed by its rounding.
                Scale::Log => v.exp().clamp(column.low, column.high),
                Scale::Log1p => v.exp_m1().clamp(column.low, column.high),
                Scale::Sum(p) => v * x[self.variable(p, band)],
                Scale::Share(p) => x[self.variable(p, band)] * (1.0 - v),
            }
        };
        let of = |c: usize| (0..if self.columns[c].shared { 1 } else { self.bands }).map(|b| value(c, b)).collect();
        (0..self.columns.len()).map(of).collect()
    }

    /// Derivatives of the parameter at a variable's place by variables: at most itself and its partner.
    pub(super) fn derivatives(&self, x: &[f64]) -> Vec<Vec<(usize, f64)>> {
        let mut out = vec![Vec::new(); self.count];
        for (c, column) in self.columns.iter().enumerate() {
            for band in 0..if column.shared { 1 } else { self.bands } {
                let v = self.variable(c, band);
                out[v] = match column.scale {
                    Scale::Linear => vec![(v, 1.0)],
                    Scale::Log | Scale::Log1p => vec![(v, x[v].exp())],
                    Scale::Sum(p) => {
                        let t = self.variable(p, band);
                        vec![(v, x[t]), (t, x[v])]
                    }
                    Scale::Share(p) => {
                        let s = self.variable(p, band);
                        vec![(s, 1.0 - x[v]), (v, -x[s])]
                    }
                };
            }
        }
        out
    }

    /// A length over which the variable of a column changes the model about once.
    pub(super) fn span(&self, x: f64) -> f64 {
        x.abs().max(0.1)
    }
}

impl Column {
    /// A parameter's value as a variable; of a pair the sum or the share itself.
    fn inside(&self, value: f64) -> f64 {
        match self.scale {
            Scale::Log => value.ln(),
            Scale::Log1p => value.ln_1p(),
            Scale::Linear | Scale::Sum(_) | Scale::Share(_) => value,
        }
    }
}

/// Of the starts: the same data give the same fit.
const START_SEED: u64 = 1963;

/// Whether `name` means an open parameter: `f0`, `ggx.f0`, `2.f0` (the second model of the sum), `all`.
pub(super) fn names(name: &str, open: &Open) -> bool {
    match name.rsplit_once('.') {
        None => name == Scope::ALL || name == open.parameter.name,
        Some((model, parameter)) => {
            parameter == open.parameter.name && (model == open.model || model.parse() == Ok(open.part + 1))
        }
    }
}

fn known(open: &[Open]) -> String {
    let names: Vec<String> = open.iter().map(|o| format!("{}.{}", o.model, o.parameter.name)).collect();
    names.join(", ")
}

fn scale(p: &Parameter) -> Scale {
    let wide = p.low == 0.0 && p.high > 1e3 && (p.high.is_finite() || p.kind == Kind::Number);
    match p {
        _ if p.low > 0.0 => Scale::Log,
        _ if wide => Scale::Log1p,
        _ => Scale::Linear,
    }
}

/// Where values of real materials lie.
fn usual(p: &Parameter) -> (f64, f64) {
    match p.name {
        "alpha" | "alpha_x" | "alpha_y" => (0.02, 0.7),
        "n" | "nu" | "nv" => (3.0, 3000.0),
        "eta" => (1.2, 3.0),
        "sigma_deg" => (5.0, 60.0),
        "b" => (10.0, 1e5),
        "c" => (0.3, 3.0),
        _ if p.high.is_finite() && p.high <= 1.0 => (p.low + 0.05 * (p.high - p.low), p.low + 0.95 * (p.high - p.low)),
        _ if p.low.is_finite() => (p.low + 0.1, p.low + 1.0),
        _ => (-1.0, 1.0),
    }
}
