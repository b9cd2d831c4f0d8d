//! `tables`: the embedded reference tables with their provenance.

use std::io::{self, Write};

use clap::Args;
use serde_json::json;

use super::Failure;
use crate::report::envelope::Envelope;
use crate::tables::{self, Table, TableInfo};

/// Arguments of `tables`.
#[derive(Debug, Args)]
#[command(after_long_help = "\
Examples:
  photopic tables
  photopic tables cie-1924-v
  photopic tables cie-1931-2deg --csv > cmf.csv")]
pub(super) struct TablesArgs {
    /// A table by name; without one, all are listed.
    name: Option<String>,
    /// The numbers as CSV, their provenance in comment lines before the header.
    #[arg(long, conflicts_with = "json")]
    csv: bool,
    /// One JSON document.
    #[arg(long)]
    json: bool,
}

pub(super) fn run(arguments: &TablesArgs) -> Result<(), Failure> {
    let chosen: Vec<&'static Table> = match &arguments.name {
        Some(name) => vec![tables::get(name).map_err(|e| Failure::Message(e.to_string()))?],
        None => tables::all().iter().collect(),
    };
    let mut out = io::BufWriter::new(io::stdout().lock());
    if arguments.json {
        json(out, arguments.name.is_some(), &chosen)?;
        return Ok(());
    }
    match (&arguments.name, arguments.csv) {
        (Some(_), true) => numbers(&mut out, chosen[0])?,
        (Some(_), false) => describe(&mut out, chosen[0].info())?,
        (None, true) => {
            writeln!(out, "name,title,standard,rows,first_nm,last_nm,licence,sha256")?;
            for table in &chosen {
                let i = table.info();
                let cells = [&i.name, &i.title, &i.standard].map(|c| quote(c));
                writeln!(
                    out,
                    "{},{},{},{},{},{}",
                    cells.join(","),
                    i.rows,
                    i.first_nm,
                    i.last_nm,
                    quote(&i.licence),
                    i.sha256
                )?;
            }
        }
        (None, false) => {
            for table in &chosen {
                let i = table.info();
                writeln!(out, "{:<26} {}–{} nm  {}", i.name, i.first_nm, i.last_nm, i.title)?;
            }
            writeln!(out, "\n`photopic tables NAME` tells the source of one, `--csv` prints its numbers.")?;
        }
    }
    Ok(out.flush()?)
}

fn quote(cell: &str) -> String {
    if cell.contains([',', '"', '\n']) { format!("\"{}\"", cell.replace('"', "\"\"")) } else { cell.to_owned() }
}

fn json(out: impl Write, numbers: bool, chosen: &[&'static Table]) -> Result<(), Failure> {
    let mut envelope = Envelope::begin(out, "tables", &json!({}))?;
    for table in chosen {
        let mut value = json!(table.info());
        if numbers {
            let columns: serde_json::Map<_, _> = (table.columns().iter())
                .filter_map(|c| Some((c.name.clone(), json!(table.column(&c.name)?))))
                .collect();
            value["wavelengths_nm"] = json!(table.wavelengths_nm());
            value["values"] = columns.into();
        }
        envelope.result(&value)?;
    }
    envelope.end()?;
    Ok(())
}

/// Label and text of each fact.
fn facts(i: &TableInfo) -> Vec<(&'static str, String)> {
    let mut out = vec![("title", i.title.clone()), ("standard", i.standard.clone())];
    let mut add = |label, text: Option<&String>| out.extend(text.map(|t| (label, t.clone())));
    add("doi", i.doi.as_ref());
    add("reference", i.reference.as_ref());
    add("origin", Some(&i.origin));
    add("checked", Some(&i.checked));
    add("licence", Some(&i.licence));
    add("attribution", i.attribution.as_ref());
    add("date", Some(&i.date));
    add("sha256", Some(&i.sha256));
    add("note", i.note.as_ref());
    out
}

fn describe(out: &mut impl Write, i: &TableInfo) -> io::Result<()> {
    writeln!(out, "{}", i.name)?;
    for (label, text) in facts(i) {
        writeln!(out, "  {label:<12} {text}")?;
    }
    let step = i.step_nm.map_or("unequal steps".to_owned(), |s| format!("by {s} nm"));
    writeln!(out, "  {:<12} {}–{} nm {step}, {} rows", "wavelengths", i.first_nm, i.last_nm, i.rows)?;
    for c in &i.columns {
        writeln!(out, "  {:<12} {} [{}]: {}", "column", c.name, c.unit, c.meaning)?;
    }
    writeln!(out, "\n`photopic tables {} --csv` prints the numbers.", i.name)
}

fn numbers(out: &mut impl Write, table: &Table) -> io::Result<()> {
    writeln!(out, "# {}", table.name())?;
    for (label, text) in facts(table.info()) {
        writeln!(out, "# {label}: {text}")?;
    }
    out.write_all(table.csv().as_bytes())
}
