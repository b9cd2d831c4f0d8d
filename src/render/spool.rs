//! The state of a render in a file: what was sampled so far, to go on after a break, or to be joined with the parts that other
//! machines did.
//!
//! ```text
//! photopic render 9\n
//! length of the header, u64; header, JSON
//! per meter point and replicate:  samples, faults, sums per band; checksum
//! per picture and row:            noise, samples of all channels (f32, channel by channel); checksum
//! ```
//!
//! All numbers are little-endian. A record counts as done where its checksum (the first 8 bytes of the SHA-256 of the record) is
//! right; whatever was torn by a break is sampled again, to the same bits, because every random number is a function of the seed
//! and of what it is for. A file of a share `i/n` holds the replicates r and, of pictures, the
//! [strips](super::film::strip) s with r ≡ s ≡ i (mod n).

use std::io::{Read, Seek, SeekFrom, Write};

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use super::estimate::{Faults, REPLICATES, Replicate};
use super::noise::Noise;

/// The first bytes of a file.
const MAGIC: &[u8] = b"photopic render 9\n";
/// The longest header that is read, bytes.
const LONGEST_HEADER: u64 = 1 << 20;
const CHECKSUM: usize = 8;
/// Bytes of the faults and of the noise of a row.
const FAULTS: usize = 6 * 8;
const NOISE: usize = 3 * 8 + FAULTS;

/// A part of a render: `index` of `count`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Share {
    /// From 0.
    pub index: u32,
    /// At least 1.
    pub count: u32,
}

impl Share {
    /// All of it.
    pub const WHOLE: Self = Self { index: 0, count: 1 };

    /// Whether replicate or strip `number` belongs to this share.
    #[must_use]
    pub fn has(self, number: usize) -> bool {
        number % self.count as usize == self.index as usize
    }
}

/// A picture's extent.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Extent {
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Channels.
    pub channels: usize,
}

/// What was to be rendered.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Task {
    /// The scene's file.
    pub scene: String,
    /// Samples of a pixel.
    pub samples: u64,
    /// Samples of a meter.
    pub meter_samples: u64,
    /// Names all random numbers.
    pub seed: u64,
    /// Everything is modelled, required or not.
    #[serde(default)]
    pub full: bool,
    /// Pictures are filtered, whatever the scene says.
    #[serde(default)]
    pub denoise: bool,
    /// Packets of the energy audit, which is made when the shares are joined.
    pub packets: u64,
    /// The file of settings in place of the scene's, its text; empty without one.
    #[serde(default)]
    pub settings: String,
}

/// What a file holds.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Header {
    /// A checksum of the scene, the settings and the version: parts of one render have the same.
    pub fingerprint: String,
    /// The scene's file and how it is sampled, as asked for.
    pub task: Task,
    /// The share that the file holds.
    pub share: Share,
    /// Meter points.
    pub points: usize,
    /// Bands of a reading.
    pub bands: usize,
    /// The pictures.
    pub pictures: Vec<Extent>,
}

/// Why a state cannot be used.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The file could not be read or written.
    #[error(transparent)]
    Io(#[from] std::io::Error),
    /// It is no state of a render.
    #[error("found no state of a render; expected a file that `photopic render` wrote with --checkpoint or --shard")]
    Format,
    /// It is the state of another render.
    #[error(
        "the state of another render (fingerprint {found}); expected {expected}: the same scene, settings and version"
    )]
    Other {
        /// Fingerprint found.
        found: String,
        /// Fingerprint expected.
        expected: String,
    },
    /// The file is too short or too long for what its header says.
    #[error("{found} bytes; expected {expected} by the header")]
    Length {
        /// Bytes of the file.
        found: u64,
        /// Bytes expected.
        expected: u64,
    },
}

/// A file of state.
#[derive(Debug)]
pub struct Spool<F> {
    file: F,
    header: Header,
    /// Where the records begin.
    start: u64,
}

impl Header {
    /// Bytes of a record. A header from a hostile file may claim anything: sizes saturate, and no file is as long as that.
    fn point_record(&self) -> usize {
        self.bands.saturating_mul(8).saturating_add(8 + FAULTS + CHECKSUM)
    }

    fn row_record(extent: &Extent) -> usize {
        extent.width.saturating_mul(extent.channels).saturating_mul(4).saturating_add(NOISE + CHECKSUM)
    }

    /// Where the rows of a picture begin, bytes behind the header; of one picture more: the end.
    fn rows_at(&self, picture: usize) -> u64 {
        let points = (self.points as u64).saturating_mul(REPLICATES as u64).saturating_mul(self.point_record() as u64);
        let rows = |e: &Extent| (Self::row_record(e) as u64).saturating_mul(e.height as u64);
        self.pictures[..picture].iter().map(rows).fold(points, u64::saturating_add)
    }
}

impl<F: Read + Write + Seek> Spool<F> {
    /// An empty state; the file gets its full length at once.
    ///
    /// # Errors
    /// Those of the file.
    pub fn create(mut file: F, header: Header) -> Result<Self, Error> {
        let text = serde_json::to_vec(&header).map_err(std::io::Error::from)?;
        file.seek(SeekFrom::Start(0))?;
        file.write_all(MAGIC)?;
        file.write_all(&(text.len() as u64).to_le_bytes())?;
        file.write_all(&text)?;
        let start = file.stream_position()?;
        let end = start + header.rows_at(header.pictures.len());
        if end > start {
            // The last byte belongs to a checksum, which is not yet right.
            file.seek(SeekFrom::Start(end - 1))?;
            file.write_all(&[0])?;
        }
        Ok(Self { file, header, start })
    }

    /// The state in a file.
    ///
    /// # Errors
    /// [`Error`].
    pub fn open(mut file: F) -> Result<Self, Error> {
        let length = file.seek(SeekFrom::End(0))?;
        file.seek(SeekFrom::Start(0))?;
        let mut magic = vec![0; MAGIC.len()];
        let mut size = [0; 8];
        if length < (MAGIC.len() + size.len()) as u64 {
            return Err(Error::Format);
        }
        file.read_exact(&mut magic)?;
        file.read_exact(&mut size)?;
        let size = u64::from_le_bytes(size);
        if magic != MAGIC || size > LONGEST_HEADER.min(length) {
            return Err(Error::Format);
        }
        let mut text = Vec::new();
        (&mut file as &mut dyn Read).take(size).read_to_end(&mut text)?;
        let header: Header = serde_json::from_slice(&text).map_err(|_| Error::Format)?;
        let start = file.stream_position()?;
        let expected = start.saturating_add(header.rows_at(header.pictures.len()));
        if header.share.index >= header.share.count || length != expected {
            return Err(Error::Length { found: length, expected });
        }
        Ok(Self { file, header, start })
    }

    /// What the file holds.
    #[must_use]
    pub fn header(&self) -> &Header {
        &self.header
    }

    /// # Errors
    /// [`Error::Other`] where the state is not that of the render `fingerprint`.
    pub fn check(&self, fingerprint: &str) -> Result<(), Error> {
        if self.header.fingerprint == fingerprint {
            return Ok(());
        }
        Err(Error::Other { found: self.header.fingerprint.clone(), expected: fingerprint.to_owned() })
    }

    /// A replicate of a point; `None` where it was not sampled or was torn.
    ///
    /// # Errors
    /// Those of the file.
    pub fn replicate(&mut self, point: usize, replicate: usize) -> Result<Option<Replicate>, Error> {
        let size = self.header.point_record();
        let at = ((point * REPLICATES + replicate) * size) as u64;
        let Some(record) = self.record(at, size)? else { return Ok(None) };
        let numbers: Vec<u64> = words(&record).collect();
        let sums = numbers[1 + FAULTS / 8..].iter().map(|bits| f64::from_bits(*bits)).collect();
        Ok(Some(Replicate::from_parts(sums, numbers[0], faults(&numbers[1..]))))
    }

    /// Stores a replicate of a point.
    ///
    /// # Errors
    /// Those of the file.
    pub fn store_replicate(&mut self, point: usize, replicate: usize, state: &Replicate) -> Result<(), Error> {
        let size = self.header.point_record();
        let mut record = Vec::with_capacity(size);
        record.extend(state.samples().to_le_bytes());
        put_faults(&mut record, state.faults());
        state.sums().iter().for_each(|s| record.extend(s.to_bits().to_le_bytes()));
        self.store(((point * REPLICATES + replicate) * size) as u64, record)
    }

    /// A row of a picture, all channels one behind the other, and its noise; `None` where it was not rendered or was torn.
    ///
    /// # Errors
    /// Those of the file.
    pub fn row(&mut self, picture: usize, y: usize) -> Result<Option<(Noise, Vec<f32>)>, Error> {
        let size = Header::row_record(&self.header.pictures[picture]);
        let at = self.header.rows_at(picture) + (y * size) as u64;
        let Some(record) = self.record(at, size)? else { return Ok(None) };
        let (noise, samples) = record.split_at(NOISE);
        let numbers: Vec<u64> = words(noise).collect();
        let noise = Noise {
            pixels: numbers[0],
            luminance: f64::from_bits(numbers[1]),
            variance: f64::from_bits(numbers[2]),
            faults: faults(&numbers[3..]),
        };
        let samples = samples.chunks_exact(4).map(|b| f32::from_le_bytes([b[0], b[1], b[2], b[3]])).collect();
        Ok(Some((noise, samples)))
    }

    /// Stores a row of a picture.
    ///
    /// # Errors
    /// Those of the file.
    pub fn store_row(&mut self, picture: usize, y: usize, noise: &Noise, samples: &[f32]) -> Result<(), Error> {
        let size = Header::row_record(&self.header.pictures[picture]);
        let mut record = Vec::with_capacity(size);
        record.extend(noise.pixels.to_le_bytes());
        record.extend(noise.luminance.to_bits().to_le_bytes());
        record.extend(noise.variance.to_bits().to_le_bytes());
        put_faults(&mut record, &noise.faults);
        samples.iter().for_each(|s| record.extend(s.to_le_bytes()));
        self.store(self.header.rows_at(picture) + (y * size) as u64, record)
    }

    /// The contents of a record whose checksum is right.
    fn record(&mut self, at: u64, size: usize) -> Result<Option<Vec<u8>>, Error> {
        self.file.seek(SeekFrom::Start(self.start + at))?;
        let mut record = vec![0; size];
        self.file.read_exact(&mut record)?;
        let checksum = record.split_off(size - CHECKSUM);
        Ok((checksum == checksum_of(&record)).then_some(record))
    }

    fn store(&mut self, at: u64, mut record: Vec<u8>) -> Result<(), Error> {
        let checksum = checksum_of(&record);
        record.extend(checksum);
        self.file.seek(SeekFrom::Start(self.start + at))?;
        self.file.write_all(&record)?;
        Ok(())
    }
}

fn checksum_of(record: &[u8]) -> Vec<u8> {
    Sha256::digest(record)[..CHECKSUM].to_vec()
}

fn words(bytes: &[u8]) -> impl Iterator<Item = u64> {
    bytes.chunks_exact(8).map(|b| u64::from_le_bytes([b[0], b[1], b[2], b[3], b[4], b[5], b[6], b[7]]))
}

fn faults(numbers: &[u64]) -> Faults {
    let first = (numbers[3] == 1).then_some((numbers[4], numbers[5]));
    Faults { nan: numbers[0], infinite: numbers[1], negative: numbers[2], first }
}

fn put_faults(record: &mut Vec<u8>, faults: &Faults) {
    let (a, b) = faults.first.unwrap_or_default();
    for number in [faults.nan, faults.infinite, faults.negative, u64::from(faults.first.is_some()), a, b] {
        record.extend(number.to_le_bytes());
    }
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use super::*;

    fn header() -> Header {
        Header {
            fingerprint: "abc".to_owned(),
            task: Task {
                scene: "room.toml".to_owned(),
                samples: 4,
                meter_samples: 100,
                seed: 1,
                full: false,
                denoise: false,
                packets: 2000,
                settings: String::new(),
            },
            share: Share { index: 1, count: 3 },
            points: 2,
            bands: 2,
            pictures: vec![Extent { width: 2, height: 3, channels: 2 }, Extent { width: 1, height: 1, channels: 1 }],
        }
    }

    fn replicate() -> Replicate {
        let mut replicate = Replicate::new(2);
        for sample in [[1.0, 0.1], [f64::NAN, 1.0], [2.0, 1e-300]] {
            replicate.add(7, &sample);
        }
        replicate
    }

    #[test]
    fn what_is_stored_comes_back_and_nothing_else() {
        let noise = Noise { pixels: 2, luminance: 0.1, variance: 1e-9, faults: Faults { nan: 3, ..Faults::default() } };
        let mut spool = Spool::create(Cursor::new(Vec::new()), header()).unwrap();
        spool.store_replicate(1, 31, &replicate()).unwrap();
        spool.store_row(0, 2, &noise, &[1.0, 2.0, f32::MIN_POSITIVE, -0.0]).unwrap();
        spool.store_row(1, 0, &noise, &[9.0]).unwrap();
        let mut spool = Spool::open(spool.file).unwrap();
        assert_eq!(spool.header(), &header());
        assert_eq!(spool.replicate(1, 31).unwrap(), Some(replicate()));
        assert_eq!(spool.row(0, 2).unwrap(), Some((noise, vec![1.0, 2.0, f32::MIN_POSITIVE, -0.0])));
        assert_eq!(spool.row(1, 0).unwrap().unwrap().1, [9.0]);
        assert!(spool.replicate(1, 30).unwrap().is_none() && spool.row(0, 1).unwrap().is_none());
        assert!(spool.check("abc").is_ok() && matches!(spool.check("abd"), Err(Error::Other { .. })));
    }

    #[test]
    fn a_torn_record_counts_as_not_done() {
        let mut spool = Spool::create(Cursor::new(Vec::new()), header()).unwrap();
        spool.store_replicate(0, 0, &replicate()).unwrap();
        let at = usize::try_from(spool.start).unwrap() + 70;
        spool.file.get_mut()[at] ^= 1;
        assert!(spool.replicate(0, 0).unwrap().is_none());
    }

    #[test]
    fn other_files_are_refused() {
        let open = |bytes: &[u8]| Spool::open(Cursor::new(bytes.to_vec()));
        let good = Spool::create(Cursor::new(Vec::new()), header()).unwrap().file.into_inner();
        assert!(matches!(open(b""), Err(Error::Format)));
        assert!(matches!(open(&[7; 100]), Err(Error::Format)));
        assert!(matches!(open(&good[..good.len() - 1]), Err(Error::Length { .. })));
        let mut huge = good.clone();
        huge[MAGIC.len()..MAGIC.len() + 8].fill(255);
        assert!(matches!(open(&huge), Err(Error::Format)));
        assert!(open(&good).is_ok());
        let text = String::from_utf8_lossy(&good[..good.len().min(300)]).into_owned();
        let many = text.replacen("\"points\":2", &format!("\"points\":{}", u64::MAX), 1);
        assert!(matches!(open(many.as_bytes()), Err(Error::Format | Error::Length { .. })), "{many}");
    }

    #[test]
    fn shares_are_disjoint_and_complete() {
        for number in 0..100 {
            let has = (0..7).filter(|&index| Share { index, count: 7 }.has(number)).count();
            assert_eq!(has, 1);
        }
        assert!(Share::WHOLE.has(5));
    }
}
