//! Memory is bounded by what is asked for: what a source reads of its file, counted.

use std::io::{self, Cursor, Read, Seek, SeekFrom};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use photopic::image::format::envi::{self, ByteOrder, DataType, Interleave, Options, WriteOptions};
use photopic::image::format::exr::{self, Depth};
use photopic::image::{Channel, Content, Converted, Description, Memory, Plan, Region, Settings, Source, Target};

const WIDTH: usize = 64;
const HEIGHT: usize = 640;
const BANDS: usize = 40;

/// A reader that counts the bytes it gives.
struct Counting<R> {
    inner: R,
    bytes: Arc<AtomicU64>,
}

impl<R: Read> Read for Counting<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let count = self.inner.read(buffer)?;
        self.bytes.fetch_add(count as u64, Ordering::Relaxed);
        Ok(count)
    }
}

impl<R: Seek> Seek for Counting<R> {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.inner.seek(to)
    }
}

fn cube() -> Memory {
    // 380 to 1160 nm: half of the bands lie beyond V(λ).
    let channels = (0..BANDS).map(|i| Channel::band(format!("b{i}"), "", 380.0 + 20.0 * i as f64)).collect();
    let mut description = Description::planes(WIDTH, HEIGHT, channels);
    description.content = Content::Light { quantity: None, unit: Some("W/m2/sr/nm".parse().expect("a unit")) };
    // Noise, which does not compress.
    let samples = (0..WIDTH * HEIGHT * BANDS).map(|i| (i as u32).wrapping_mul(2_654_435_761) as f32 * 1e-9);
    Memory::new(description, samples.collect())
}

#[test]
fn envi_reads_no_more_than_the_rows_and_bands_asked_for() {
    for interleave in [Interleave::Bsq, Interleave::Bil, Interleave::Bip] {
        let (mut header, mut data) = (Vec::new(), Cursor::new(Vec::new()));
        let options = WriteOptions { interleave, data_type: DataType::F32, byte_order: ByteOrder::Little };
        envi::write(&mut header, &mut data, &mut cube(), options).expect("writes");
        let bytes = Arc::new(AtomicU64::new(0));
        let counting = Counting { inner: Cursor::new(data.into_inner()), bytes: Arc::clone(&bytes) };
        let mut source = envi::open(&header, counting, Options::default()).expect("a valid file").value;
        assert_eq!(bytes.load(Ordering::Relaxed), 0, "nothing is read to open it");
        let mut out = vec![0.0; 10 * WIDTH * 3];
        source.read(Region::rows(&source.description().clone(), 100, 10), &[3, 4, 5], &mut out).expect("reads");
        let bands = if interleave == Interleave::Bip { BANDS } else { 3 };
        assert_eq!(bytes.load(Ordering::Relaxed), (10 * WIDTH * bands * 4) as u64, "{interleave:?}");
    }
}

#[test]
fn luminance_of_a_band_sequential_file_leaves_the_infrared_alone() {
    let (mut header, mut data) = (Vec::new(), Cursor::new(Vec::new()));
    let options = WriteOptions { interleave: Interleave::Bsq, ..WriteOptions::default() };
    envi::write(&mut header, &mut data, &mut cube(), options).expect("writes");
    let bytes = Arc::new(AtomicU64::new(0));
    let counting = Counting { inner: Cursor::new(data.into_inner()), bytes: Arc::clone(&bytes) };
    let source = envi::open(&header, counting, Options::default()).expect("a valid file").value;
    let target = Target::Luminance(Default::default());
    let plan = Plan::new(source.description(), &target, &Settings::default()).expect("a plan").value;
    // V(λ) is tabulated to 830 nm: the straight line between 820 and 840 nm still has a share.
    assert_eq!(plan.channels().len(), 24);
    Memory::load(&mut Converted::new(source, plan)).expect("converts");
    assert_eq!(bytes.load(Ordering::Relaxed), (24 * WIDTH * HEIGHT * 4) as u64);
}

#[test]
fn exr_reads_blocks_once_and_only_those_asked_for() {
    let mut file = Cursor::new(Vec::new());
    exr::write(&mut file, &mut cube(), Depth::Float).expect("writes");
    let file = file.into_inner();
    let bytes = Arc::new(AtomicU64::new(0));
    let counting = Counting { inner: Cursor::new(file.clone()), bytes: Arc::clone(&bytes) };
    let mut source = exr::open(counting).expect("a valid file").value;
    let opened = bytes.load(Ordering::Relaxed);
    // Headers, 40 offsets and what is read ahead of them.
    assert!(opened < 40_000, "{opened}");
    let description = source.description().clone();
    let channels: Vec<usize> = (0..BANDS).collect();
    let mut row = vec![0.0; WIDTH * BANDS];
    // Row by row within one block of 16 lines: it is read and decoded once.
    for y in 160..176 {
        source.read(Region::rows(&description, y, 1), &channels, &mut row).expect("reads");
    }
    let block = (16 * WIDTH * BANDS * 4) as u64;
    let read = bytes.load(Ordering::Relaxed) - opened;
    assert!(read < block + 20_000, "{read} bytes for a block of {block}");
    // The whole, luminance, costs about the file once.
    let target = Target::Luminance(Default::default());
    let plan = Plan::new(&description, &target, &Settings::default()).expect("a plan").value;
    Memory::load(&mut Converted::new(source, plan)).expect("converts");
    let all = bytes.load(Ordering::Relaxed) - opened - read;
    assert!(all < file.len() as u64 + 400_000, "{all} of {}", file.len());
}
