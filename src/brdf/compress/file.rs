//! A basis as a file, with the grid that it stands on, the constants of its mapping and what it was trained on.
//!
//! All numbers are little-endian. d is the number of bins that take part, k of components.
//!
//! | bytes | what |
//! |---|---|
//! | 8 | `89 50 48 4f 54 42 0d 0a`: a mark that does not survive a transfer as text |
//! | u32 | version, 1 |
//! | 3 × u32 | bins in θ_h, θ_d, φ_d |
//! | u32 | d |
//! | u32 | k |
//! | u32 | columns in the set |
//! | u32 | 0: plain components; 1: weighted for exactly k components ([`Training::basis`](super::Training::basis)) |
//! | f64 | variance of the set in x, over all components |
//! | 2 × f64 | ε and the least weight of the mapping |
//! | u32, bytes | length of a text in UTF-8, and the text: a line for each input, its SHA-256 or `-`, a tab, its name |
//! | d × u32 | the bins by their index in a table, rising |
//! | d × f32 | ln(f_ref w + ε) |
//! | d × f32 | mean of x |
//! | k × f64 | variances of the coefficients, falling |
//! | d × k × f32 | components, bin by bin |
//! | 32 | SHA-256 of all that is before it |
//!
//! The weights follow from the bins. Reading takes no more memory than the input has bytes, whatever its numbers claim.

use std::io::{self, Read, Write};
use std::sync::Arc;

use sha2::{Digest, Sha256};

use super::mapping::{EPSILON, LEAST_WEIGHT, Mapping};
use super::{Basis, Grid};
use crate::brdf::table::Resolution;

/// What a file begins with.
pub const MAGIC: [u8; 8] = [0x89, b'P', b'H', b'O', b'T', b'B', b'\r', b'\n'];
const VERSION: u32 = 1;
/// Bytes read or written at a time.
const CHUNK: usize = 1 << 16;
/// Longest text on the inputs.
const LONGEST_TEXT: u32 = 1 << 24;

/// An input that a basis was trained on.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Source {
    /// Its name, without line breaks.
    pub name: String,
    /// SHA-256 of its bytes, lower-case hexadecimal; `None` where it had none (a description).
    pub sha256: Option<String>,
}

/// What a file holds.
#[derive(Debug, Clone, PartialEq)]
pub struct BasisFile {
    /// The bins that take part.
    pub grid: Grid,
    /// The components over them.
    pub basis: Basis,
    /// Weighted for exactly this number of components; otherwise plain, so that the first of them serve as well.
    pub weighted: bool,
    /// Columns in the set.
    pub columns: u32,
    /// Variance of the set in x, over all components.
    pub variance: f64,
    /// What it was trained on.
    pub sources: Vec<Source>,
}

/// The checksum of a file, which it ends in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Checksum(pub [u8; 32]);

impl Checksum {
    /// The first sixteen hexadecimal digits: enough to tell bases apart.
    #[must_use]
    pub fn short(&self) -> String {
        self.0[..8].iter().map(|b| format!("{b:02x}")).collect()
    }
}

/// Why a file is no basis.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FileError {
    /// It cannot be read.
    #[error("cannot be read: {0}; expected a basis")]
    Io(#[from] io::Error),
    /// Something else.
    #[error("found no basis; expected a file that `brdf compress train` wrote")]
    Magic,
    /// A later version.
    #[error("found version {0} of the format; expected 1")]
    Version(u32),
    /// It ends early.
    #[error("found the end of the file; expected {what}; the file may be cut off")]
    Truncated {
        /// What should be there.
        what: &'static str,
    },
    /// It goes on after its end.
    #[error("found bytes after the checksum; expected the end of the file")]
    Trailing,
    /// A number that cannot be.
    #[error("found {found} for {what}; expected {expected}")]
    Number {
        /// Which number.
        what: &'static str,
        /// The number.
        found: f64,
        /// What it should be.
        expected: &'static str,
    },
    /// A text that is none.
    #[error("found a text on the inputs that is not UTF-8 lines of checksum, tab and name")]
    Text,
    /// Bins in no order, or below the horizon.
    #[error("found bins that do not rise or are not in the grid; expected rising indices of bins above the horizon")]
    Bins,
    /// Damaged.
    #[error("found another checksum than that of its bytes; the file is damaged")]
    Checksum,
}

impl BasisFile {
    /// Writes the file and gives its checksum.
    ///
    /// # Errors
    /// Those of the writer; [`io::ErrorKind::InvalidInput`] for counts that 32 bits do not hold.
    pub fn write(&self, out: &mut dyn Write) -> io::Result<Checksum> {
        let mut out = Hashing { inner: out, hash: Sha256::new() };
        let count = |n: usize| u32::try_from(n).map_err(|_| io::Error::from(io::ErrorKind::InvalidInput));
        out.write_all(&MAGIC)?;
        let Resolution { theta_h, theta_d, phi_d } = self.grid.resolution();
        let mut numbers = vec![VERSION];
        for n in [theta_h, theta_d, phi_d, self.grid.bins().len(), self.basis.components()] {
            numbers.push(count(n)?);
        }
        numbers.extend([self.columns, u32::from(self.weighted)]);
        out.all(&numbers, u32::to_le_bytes)?;
        out.all(&[self.variance, EPSILON, LEAST_WEIGHT], f64::to_le_bytes)?;
        let line =
            |s: &Source| format!("{}\t{}\n", s.sha256.as_deref().unwrap_or("-"), s.name.replace(['\n', '\r'], " "));
        let text: String = self.sources.iter().map(line).collect();
        out.all(&[count(text.len())?], u32::to_le_bytes)?;
        out.write_all(text.as_bytes())?;
        let bins = self.grid.bins().iter().map(|b| count(*b)).collect::<io::Result<Vec<u32>>>()?;
        out.all(&bins, u32::to_le_bytes)?;
        out.all(self.basis.mapping().reference(), f32::to_le_bytes)?;
        out.all(self.basis.mean(), f32::to_le_bytes)?;
        out.all(self.basis.variances(), f64::to_le_bytes)?;
        out.all(self.basis.all(), f32::to_le_bytes)?;
        let checksum: [u8; 32] = out.hash.finalize().into();
        out.inner.write_all(&checksum)?;
        Ok(Checksum(checksum))
    }

    /// Reads a file to its end.
    ///
    /// # Errors
    /// [`FileError`].
    pub fn read(input: &mut dyn Read) -> Result<(Self, Checksum), FileError> {
        let mut input = Checked { inner: input, hash: Sha256::new() };
        let mut magic = [0; 8];
        match input.exact(&mut magic, "a basis") {
            Err(FileError::Truncated { .. }) => return Err(FileError::Magic),
            other => other?,
        }
        if magic != MAGIC {
            return Err(FileError::Magic);
        }
        let version = input.number("a version")?;
        if version != VERSION {
            return Err(FileError::Version(version));
        }
        let mut size = |what| input.number(what).map(|n| n as usize);
        let resolution =
            Resolution { theta_h: size("bins in θ_h")?, theta_d: size("bins in θ_d")?, phi_d: size("bins in φ_d")? };
        let [bins, components] = [size("the number of bins")?, size("the number of components")?];
        let (columns, kind) = (input.number("the number of columns")?, input.number("the kind of components")?);
        resolution.check().map_err(|_| number("bins in an angle", 0.0, "1 to 180 in θ_h and θ_d, 1 to 360 in φ_d"))?;
        check("bins that take part", bins as f64, "1 to all of the grid", (1..=resolution.bins()).contains(&bins))?;
        check("components", components as f64, "fewer than columns", components < columns as usize)?;
        check("the kind of components", f64::from(kind), "0 or 1", kind < 2)?;
        let constants: Vec<f64> = input.numbers(3, "the constants of the mapping", f64::from_le_bytes)?;
        let variance = constants[0];
        check("the variance of the set", variance, "a finite number from 0", variance >= 0.0 && variance.is_finite())?;
        check("ε", constants[1], "0.001", constants[1] == EPSILON)?;
        check("the least weight", constants[2], "0.001", constants[2] == LEAST_WEIGHT)?;
        let sources = sources(&mut input)?;
        let indices: Vec<u32> = input.numbers(bins, "the bins", u32::from_le_bytes)?;
        let grid = Grid::of(resolution, indices.into_iter().map(|b| b as usize).collect()).ok_or(FileError::Bins)?;
        let reference: Vec<f32> = input.numbers(bins, "the reference of each bin", f32::from_le_bytes)?;
        finite("the reference", &reference)?;
        let mean: Vec<f32> = input.numbers(bins, "the mean of each bin", f32::from_le_bytes)?;
        finite("the mean", &mean)?;
        let variances: Vec<f64> = input.numbers(components, "the variances", f64::from_le_bytes)?;
        let falling = variances.windows(2).all(|v| v[0] >= v[1]) && variances.iter().all(|v| *v > 0.0 && v.is_finite());
        check("the variances", variances.last().copied().unwrap_or(0.0), "falling numbers above 0", falling)?;
        let all: Vec<f32> = input.numbers(bins * components, "the components", f32::from_le_bytes)?;
        finite("a component", &all)?;
        let checksum = input.end()?;
        let mapping = Arc::new(Mapping::of_reference(grid.weights(), reference));
        let basis = Basis::new(mapping, mean, all, variances);
        Ok((Self { grid, basis, weighted: kind == 1, columns, variance, sources }, checksum))
    }
}

fn sources(input: &mut Checked<'_>) -> Result<Vec<Source>, FileError> {
    let length = input.number("the length of the text on the inputs")?;
    check("the length of the text on the inputs", f64::from(length), "at most 16 MiB", length <= LONGEST_TEXT)?;
    let text = input.numbers::<1, u8>(length as usize, "the text on the inputs", |[b]| b)?;
    let text = String::from_utf8(text).map_err(|_| FileError::Text)?;
    let source = |line: &str| {
        let (checksum, name) = line.split_once('\t').ok_or(FileError::Text)?;
        Ok(Source { name: name.to_owned(), sha256: Some(checksum.to_owned()).filter(|c| c != "-") })
    };
    text.lines().map(source).collect()
}

fn number(what: &'static str, found: f64, expected: &'static str) -> FileError {
    FileError::Number { what, found, expected }
}

fn check(what: &'static str, found: f64, expected: &'static str, sound: bool) -> Result<(), FileError> {
    if sound { Ok(()) } else { Err(number(what, found, expected)) }
}

fn finite(what: &'static str, values: &[f32]) -> Result<(), FileError> {
    let wrong = values.iter().find(|v| !v.is_finite());
    wrong.map_or(Ok(()), |v| Err(number(what, f64::from(*v), "a finite number")))
}

/// A writer that knows the checksum of what went through it.
struct Hashing<'a> {
    inner: &'a mut dyn Write,
    hash: Sha256,
}

impl Hashing<'_> {
    fn write_all(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.hash.update(bytes);
        self.inner.write_all(bytes)
    }

    fn all<const N: usize, T: Copy>(&mut self, numbers: &[T], bytes: impl Fn(T) -> [u8; N]) -> io::Result<()> {
        let mut buffer = Vec::with_capacity(CHUNK);
        for chunk in numbers.chunks(CHUNK / N) {
            buffer.clear();
            chunk.iter().for_each(|n| buffer.extend_from_slice(&bytes(*n)));
            self.write_all(&buffer)?;
        }
        Ok(())
    }
}

/// A reader that knows the checksum of what went through it, and takes no memory before the bytes are there.
struct Checked<'a> {
    inner: &'a mut dyn Read,
    hash: Sha256,
}

impl Checked<'_> {
    fn exact(&mut self, bytes: &mut [u8], what: &'static str) -> Result<(), FileError> {
        self.inner.read_exact(bytes).map_err(|e| match e.kind() {
            io::ErrorKind::UnexpectedEof => FileError::Truncated { what },
            _ => FileError::Io(e),
        })?;
        self.hash.update(bytes);
        Ok(())
    }

    fn number(&mut self, what: &'static str) -> Result<u32, FileError> {
        let mut four = [0; 4];
        self.exact(&mut four, what)?;
        Ok(u32::from_le_bytes(four))
    }

    fn numbers<const N: usize, T>(
        &mut self,
        count: usize,
        what: &'static str,
        of: impl Fn([u8; N]) -> T,
    ) -> Result<Vec<T>, FileError> {
        let mut out = Vec::with_capacity(count.min(CHUNK));
        let mut buffer = vec![0; CHUNK.min(count.saturating_mul(N))];
        while out.len() < count {
            let bytes = &mut buffer[..CHUNK.min((count - out.len()) * N)];
            self.exact(bytes, what)?;
            out.extend(bytes.as_chunks().0.iter().map(|b| of(*b)));
        }
        Ok(out)
    }

    /// The checksum, which nothing follows.
    fn end(self) -> Result<Checksum, FileError> {
        let mut found = [0; 32];
        self.inner.read_exact(&mut found).map_err(|e| match e.kind() {
            io::ErrorKind::UnexpectedEof => FileError::Truncated { what: "the checksum" },
            _ => FileError::Io(e),
        })?;
        let expected: [u8; 32] = self.hash.finalize().into();
        if found != expected {
            return Err(FileError::Checksum);
        }
        match self.inner.read(&mut [0])? {
            0 => Ok(Checksum(found)),
            _ => Err(FileError::Trailing),
        }
    }
}
