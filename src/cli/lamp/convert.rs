//! `lamp convert`: a lamp file in another format.

use std::path::PathBuf;

use clap::Args;

use super::load::load;
use super::transform_args::TransformArgs;
use crate::cli::notes::Notes;
use crate::cli::{Failure, Talk, output};
use crate::finding::Checked;
use crate::luminaire::format::{eulumdat, ies, tm33};

/// Arguments of `lamp convert`.
#[derive(Debug, Args)]
pub(in crate::cli) struct ConvertArgs {
    /// A lamp file, or `-`.
    #[arg(value_name = "FILE")]
    file: String,
    /// The file to write: its ending says the format.
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
    /// Edition of LM-63 to write: 1986, 1991, 1995, 2002, 2019.
    #[arg(long, value_name = "YEAR", default_value = "2019", value_parser = edition)]
    lm63: ies::Version,
    /// Repair what can be repaired safely; each repair is listed.
    #[arg(long)]
    repair: bool,
    #[command(flatten)]
    transform: TransformArgs,
}

fn edition(text: &str) -> Result<ies::Version, String> {
    ies::Version::of_year(text)
        .ok_or_else(|| format!("`{text}` is no edition; expected 1986, 1991, 1995, 2002 or 2019"))
}

pub(super) fn convert(arguments: &ConvertArgs, talk: Talk) -> Result<(), Failure> {
    let mut inputs = vec![arguments.file.clone()];
    inputs.extend(arguments.transform.inputs().map(str::to_owned));
    let notes = Notes::new(&inputs, talk);
    let file = load(&arguments.file, arguments.repair).file.map_err(|(message, _)| Failure::Message(message))?;
    notes.print(&file.findings);
    let Checked { value: lamp, findings } = arguments.transform.apply(&file.value, arguments.repair)?;
    notes.print(&findings);
    let lamp = &lamp;
    let ending = arguments.output.extension().and_then(|e| e.to_str()).map(str::to_lowercase);
    let written = match ending.as_deref() {
        Some("ies") => ies::write(lamp, arguments.lm63),
        Some("ldt") => eulumdat::write(lamp),
        Some("xml") => tm33::write(lamp),
        _ => {
            let message = format!("{}: expected a name ending in .ies, .ldt or .xml", arguments.output.display());
            return Err(Failure::Message(message));
        }
    };
    let Checked { value, findings } = written.map_err(|e| Failure::Message(format!("{}: {e}", arguments.file)))?;
    notes.print(&findings);
    output::write_file(&arguments.output, value.as_bytes(), &inputs)
}
