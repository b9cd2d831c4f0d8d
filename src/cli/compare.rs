//! `compare`: two measurements with their budgets, and what of their differences is significant.

use std::io::Write;
use std::path::PathBuf;

use clap::Args;
use serde_json::json;

use super::convert::{budget, single};
use super::notes::Notes;
use super::output::Sink;
use super::{Failure, Talk};
use crate::conversion::{Converter, Settings};
use crate::finding::{Finding, Location};
use crate::report::compare as report;
use crate::report::envelope::Envelope;
use crate::spectrum::{Quantity, Spectrum};
use crate::uncertainty::budget::Budget;
use crate::uncertainty::{self, Uncertainty, compare, shared};

/// Arguments of `compare`.
#[derive(Debug, Args)]
#[command(after_long_help = "\
The difference of a figure is significant where |E_n| > 1: E_n = (a - b)/sqrt(U_a^2 + U_b^2), U being the expanded uncertainties of
95 % (ISO/IEC 17043). Of many figures one in twenty may be so by chance: choose beforehand with --figure.

Two measurements with one instrument share errors, of its calibration above all, which cancel in the difference in part: name them
with --shared, and -2 r U_a U_b is added under the root, r being the correlation of the figures' errors to first order.

Examples:
  photopic compare here.csv there.csv --uncertainty budget.toml
  photopic compare here.csv there.csv --uncertainty here.toml --uncertainty there.toml --json
  photopic compare here.csv there.csv --uncertainty budget.toml --figure cct_k --figure cri_ra
  photopic compare before.csv after.csv --uncertainty budget.toml --shared 'certificate of the lamp' --shared 'wavelength offset'")]
pub(super) struct CompareArgs {
    /// A spectrum: a file, `-`, or a source by name.
    #[arg(value_name = "A")]
    a: String,
    /// The spectrum to set beside it.
    #[arg(value_name = "B")]
    b: String,
    /// The budget (TOML, docs/uncertainty.md); given twice, that of A and that of B.
    #[arg(long = "uncertainty", value_name = "BUDGET", required = true)]
    budgets: Vec<PathBuf>,
    /// The spectrum of this name, where a file holds several; given twice, that of A and that of B.
    #[arg(long, value_name = "NAME")]
    select: Vec<String>,
    /// What both are of, where the files do not say: flux, intensity, irradiance, radiance, exitance, energy, exposure, relative.
    #[arg(long, value_name = "QUANTITY")]
    quantity: Option<Quantity>,
    /// Compare only this figure, by its JSON key, such as photopic.illuminance_lx or cct_k (repeatable).
    #[arg(long, value_name = "KEY")]
    figure: Vec<String>,
    /// A contribution, by its name in the budgets, of which A and B have one and the same error (repeatable).
    #[arg(long, value_name = "NAME")]
    shared: Vec<String>,
    /// One JSON document.
    #[arg(long, conflicts_with = "csv")]
    json: bool,
    /// One table with a header row.
    #[arg(long)]
    csv: bool,
    /// Write to a file instead of standard output.
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
}

/// One of the two measurements with what it is worth.
struct Evaluated {
    budget: Budget,
    quantity: Quantity,
    spectrum: Spectrum,
    uncertainty: Uncertainty,
}

impl Evaluated {
    fn side(&self) -> shared::Side<'_> {
        shared::Side {
            budget: &self.budget,
            quantity: self.quantity,
            spectrum: &self.spectrum,
            uncertainty: &self.uncertainty,
        }
    }
}

pub(super) fn run(arguments: &CompareArgs, talk: Talk) -> Result<(), Failure> {
    let inputs = [arguments.a.clone(), arguments.b.clone()];
    if inputs.iter().all(|i| i == "-") {
        return Err(Failure::Message("`-` given twice; expected standard input once".into()));
    }
    if arguments.budgets.len() > 2 || arguments.select.len() > 2 {
        return Err(Failure::Message("more than two budgets or names; expected one for both, or one each".into()));
    }
    let converter = Converter::new(Settings::default());
    let mut sink = Sink::open(arguments.output.as_deref(), &inputs)?;
    let mut notes = Notes::new(&inputs, talk);
    let settings = json!({"figures": arguments.figure, "shared": arguments.shared, "coverage": 0.95});
    let mut envelope = Envelope::begin(Vec::new(), "compare", &settings)?;
    let mut measured: Vec<Evaluated> = Vec::new();
    for (i, path) in inputs.iter().enumerate() {
        let of = |all: usize| i.min(all - 1);
        let budget = budget::read(&arguments.budgets[of(arguments.budgets.len())])?;
        let name = (!arguments.select.is_empty()).then(|| arguments.select[of(arguments.select.len())].as_str());
        let found = match single(path, name, arguments.quantity, converter.settings().c2) {
            Ok(found) => found,
            Err(refused) => {
                notes.refuse(&refused.message);
                envelope.finding(*refused.finding);
                continue;
            }
        };
        envelope.input(found.input);
        let (quantity, spectrum) = (found.measured.quantity, found.measured.spectrum);
        let budget = budget.with_column(spectrum.grid(), found.measured.standard.as_deref());
        let mut findings = found.findings;
        match uncertainty::evaluate(&converter, &budget, quantity, &spectrum) {
            Ok(checked) => {
                let place = |f: Finding| f.at(Location::default().in_file(path));
                findings.extend(checked.findings.into_iter().map(place));
                measured.push(Evaluated {
                    budget: budget.into_owned(),
                    quantity,
                    spectrum,
                    uncertainty: checked.value,
                });
            }
            Err(why) => {
                notes.refuse(&format!("{path}: {why}"));
                findings.push(Finding::error("P000", why.to_string()).at(Location::default().in_file(path)));
            }
        }
        notes.print(&findings);
        findings.into_iter().for_each(|f| envelope.finding(f));
    }
    let mut plain = String::new();
    let mut passes = true;
    if let [a, b] = &measured[..] {
        if a.quantity != b.quantity {
            let (one, other) = (a.quantity, b.quantity);
            let message = format!("{one} beside {other}; expected two measurements of one quantity, see --quantity");
            return Err(Failure::Message(message));
        }
        let correlations = if arguments.shared.is_empty() {
            Vec::new()
        } else {
            shared::correlations(&converter, a.side(), b.side(), &arguments.shared)
                .map_err(|e| Failure::Message(format!("--shared: {e}")))?
        };
        let differences = compare::differences(&a.uncertainty, &b.uncertainty, &correlations);
        let mut all = report::keyed(&differences, a.quantity);
        if let Some(unknown) = arguments.figure.iter().find(|key| all.iter().all(|(k, _)| k != *key)) {
            let some: Vec<&str> = all.iter().take(12).map(|(k, _)| k.as_str()).collect();
            let message = format!("--figure {unknown}: not a figure of both; expected one of {}, …", some.join(", "));
            return Err(Failure::Message(message));
        }
        all.retain(|(key, _)| arguments.figure.is_empty() || arguments.figure.contains(key));
        passes = all.iter().all(|(_, d)| !d.is_significant());
        let paths = [arguments.a.as_str(), arguments.b.as_str()];
        plain = if arguments.csv { report::csv(&all) } else { report::text(paths, &all) };
        envelope.result(&report::json(paths, &all))?;
    }
    let document = envelope.end()?;
    sink.write_all(if arguments.json { &document } else { plain.as_bytes() })?;
    sink.finish(!notes.failed || arguments.json)?;
    match (notes.failed, passes) {
        (true, _) => Err(Failure::Reported),
        (false, true) => Ok(()),
        (false, false) => Err(Failure::No),
    }
}
