//! Where the files of a conversion of several inputs go: standard output, one name, or a folder.

use std::collections::{HashMap, HashSet};
use std::fs;
use std::path::{Path, PathBuf};

use super::{Failure, output};

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
    /// `read` are all files that the run reads, which none of the places may be; `ending` is that of the files in a folder.
    pub(super) fn of(inputs: &[String], read: &[String], output: &Path, ending: &str) -> Result<Self, Failure> {
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
            let stem = stem_of(input);
            let first = *taken.entry(stem.to_lowercase()).or_insert(index);
            mains.push(if first == index {
                Ok(output.join(format!("{stem}.{ending}")))
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

    /// Where the main file of an input goes, or why nowhere.
    pub(super) fn main(&self, index: usize) -> Result<&Path, String> {
        self.mains[index].as_ref().map(PathBuf::as_path).map_err(Clone::clone)
    }

    /// Writes the files for an input, all or none: the bytes of each, the first the main file, and with what its name ends
    /// after the stem of the main file's.
    pub(super) fn write(&self, index: usize, files: &[(&str, &[u8])]) -> Result<(), Failure> {
        let main = self.main(index).map_err(Failure::Message)?;
        let stem = self.stem(index).map_err(Failure::Message)?;
        let mut named: Vec<(PathBuf, &[u8])> = Vec::with_capacity(files.len());
        for (i, (suffix, bytes)) in files.iter().enumerate() {
            let place = if i == 0 { main.to_owned() } else { main.with_file_name(format!("{stem}{suffix}")) };
            if named.iter().any(|(other, _)| *other == place) {
                let message = "is the name of another file of this format; expected another name";
                return Err(Failure::Message(format!("{}: {message}", place.display())));
            }
            if fs::canonicalize(&place).is_ok_and(|p| self.inputs.contains(&p)) {
                return Err(Failure::Message(output::overwrites(&place)));
            }
            named.push((place, bytes));
        }
        output::write_files(&named)
    }
}

/// What the names of an input's files in a folder begin with: the input's own name without its ending, and of a description in
/// words its letters and digits.
fn stem_of(input: &str) -> String {
    if input == "-" {
        return "stdin".to_owned();
    }
    if input.contains('(') && !Path::new(input).exists() {
        let words = input.split(|c: char| !(c.is_alphanumeric() || "._-".contains(c))).filter(|w| !w.is_empty());
        return words.collect::<Vec<_>>().join("_");
    }
    Path::new(input).file_stem().map(|s| s.to_string_lossy().into_owned()).unwrap_or_default()
}

fn resolved(inputs: &[String]) -> HashSet<PathBuf> {
    inputs.iter().filter_map(|i| fs::canonicalize(i).ok()).collect()
}
