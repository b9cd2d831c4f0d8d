//! Where the files of `lamp convert` go: standard output, one name, or a folder.

use std::collections::{HashMap, HashSet};
use std::fs;
use std::path::{Path, PathBuf};

use super::target::Target;
use crate::cli::{Failure, output};
use crate::luminaire::export::ExportFile;

/// The places of the main files, one for each input, in order.
pub(super) struct Places {
    folder: Option<PathBuf>,
    /// Place or why there is none.
    mains: Vec<Result<PathBuf, String>>,
    /// The inputs, links followed: none of them is overwritten.
    inputs: HashSet<PathBuf>,
}

impl Places {
    /// The places for inputs and an output as the user gave them.
    ///
    /// `read` are all files that the run reads, which none of the places may be.
    pub(super) fn of(inputs: &[String], read: &[String], output: &Path, target: Target) -> Result<Self, Failure> {
        let is_folder = output.is_dir() || output.to_string_lossy().ends_with(std::path::is_separator);
        if !is_folder && inputs.len() > 1 {
            let message = format!("{}: one output for {} inputs; expected a folder", output.display(), inputs.len());
            return Err(Failure::Message(format!("{message}; end its name with a slash to make one")));
        }
        if !is_folder {
            let one = [Ok(output.to_owned())];
            return Ok(Self { folder: None, mains: one.into(), inputs: resolved(read) });
        }
        // By lower case: some file systems take names that differ in case for one.
        let mut taken: HashMap<String, usize> = HashMap::new();
        let mut mains = Vec::with_capacity(inputs.len());
        for (index, input) in inputs.iter().enumerate() {
            let name = if input == "-" { "stdin" } else { input.as_str() };
            let stem = Path::new(name).file_stem().map(|s| s.to_string_lossy().into_owned()).unwrap_or_default();
            let first = *taken.entry(stem.to_lowercase()).or_insert(index);
            mains.push(if first == index {
                Ok(output.join(format!("{stem}.{}", target.ending())))
            } else {
                Err(format!(
                    "{input}: would be written to the same file as {}; expected different names",
                    inputs[first]
                ))
            });
        }
        Ok(Self { folder: Some(output.to_owned()), mains, inputs: resolved(read) })
    }

    /// Makes the folder where there is none.
    pub(super) fn prepare(&self) -> Result<(), Failure> {
        let Some(folder) = &self.folder else { return Ok(()) };
        fs::create_dir_all(folder).map_err(|e| {
            Failure::Message(format!("{}: cannot be made: {e}; expected the name of a folder", folder.display()))
        })
    }

    /// What the names of the files for an input begin with, or why there are none.
    pub(super) fn stem(&self, index: usize) -> Result<String, String> {
        let main = self.mains[index].as_ref().map_err(Clone::clone)?;
        Ok(main.file_stem().map(|s| s.to_string_lossy().into_owned()).unwrap_or_default())
    }

    /// Writes the files for an input, all or none.
    pub(super) fn write(&self, index: usize, target: Target, files: &[ExportFile]) -> Result<(), Failure> {
        let main = self.mains[index].as_ref().map_err(|e| Failure::Message(e.clone()))?;
        if main == Path::new("-") && !target.is_one_file() {
            let message = "-: standard output holds one file and this format has several; expected a name";
            return Err(Failure::Message(message.to_owned()));
        }
        let stem = self.stem(index).map_err(Failure::Message)?;
        let mut named: Vec<(PathBuf, &[u8])> = Vec::with_capacity(files.len());
        for (i, file) in files.iter().enumerate() {
            let place = if i == 0 { main.clone() } else { main.with_file_name(format!("{stem}{}", file.suffix)) };
            if named.iter().any(|(other, _)| *other == place) {
                let message = "is the name of another file of this format; expected another name";
                return Err(Failure::Message(format!("{}: {message}", place.display())));
            }
            if fs::canonicalize(&place).is_ok_and(|p| self.inputs.contains(&p)) {
                return Err(Failure::Message(output::overwrites(&place)));
            }
            named.push((place, &file.bytes));
        }
        output::write_files(&named)
    }
}

fn resolved(inputs: &[String]) -> HashSet<PathBuf> {
    inputs.iter().filter_map(|i| fs::canonicalize(i).ok()).collect()
}
