//! The numbers of a data file.

use std::fmt;

/// Type of the samples, by ENVI's code.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DataType {
    /// 1: 8-bit unsigned.
    U8,
    /// 2: 16-bit signed.
    I16,
    /// 3: 32-bit signed.
    I32,
    /// 4: 32-bit float.
    F32,
    /// 5: 64-bit float.
    F64,
    /// 12: 16-bit unsigned.
    U16,
    /// 13: 32-bit unsigned.
    U32,
    /// 14: 64-bit signed.
    I64,
    /// 15: 64-bit unsigned.
    U64,
}

/// Order of the bytes of a number.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ByteOrder {
    /// 0: least significant first.
    #[default]
    Little,
    /// 1: most significant first.
    Big,
}

impl DataType {
    /// Every type that is read.
    pub const ALL: [Self; 9] =
        [Self::U8, Self::I16, Self::I32, Self::F32, Self::F64, Self::U16, Self::U32, Self::I64, Self::U64];

    /// ENVI's code.
    #[must_use]
    pub fn code(self) -> u32 {
        match self {
            Self::U8 => 1,
            Self::I16 => 2,
            Self::I32 => 3,
            Self::F32 => 4,
            Self::F64 => 5,
            Self::U16 => 12,
            Self::U32 => 13,
            Self::I64 => 14,
            Self::U64 => 15,
        }
    }

    /// Bytes of a sample.
    #[must_use]
    pub fn bytes(self) -> usize {
        match self {
            Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::F32 | Self::U32 => 4,
            Self::F64 | Self::I64 | Self::U64 => 8,
        }
    }

    /// Smallest and largest value; `None` for floats.
    #[expect(clippy::cast_precision_loss, reason = "bounds of 64-bit integers, to compare doubles with")]
    fn range(self) -> Option<(f64, f64)> {
        Some(match self {
            Self::U8 => (0.0, f64::from(u8::MAX)),
            Self::I16 => (f64::from(i16::MIN), f64::from(i16::MAX)),
            Self::U16 => (0.0, f64::from(u16::MAX)),
            Self::I32 => (f64::from(i32::MIN), f64::from(i32::MAX)),
            Self::U32 => (0.0, f64::from(u32::MAX)),
            Self::I64 => (i64::MIN as f64, i64::MAX as f64),
            Self::U64 => (0.0, u64::MAX as f64),
            Self::F32 | Self::F64 => return None,
        })
    }

    /// Whether a value is lost in this type: beyond its range, or not a number where there is none.
    pub(super) fn loses(self, value: f32) -> bool {
        let value = f64::from(value);
        self.range().is_some_and(|(low, high)| !(low - 0.5..high + 0.5).contains(&value))
    }

    /// Appends a value: integers rounded to the nearest, cut at the ends of the range, 0 for NaN.
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "`as` cuts at the ends of the range")]
    pub(super) fn encode(self, order: ByteOrder, value: f32, out: &mut Vec<u8>) {
        let rounded = f64::from(value).round();
        macro_rules! push {
            ($value:expr) => {
                match order {
                    ByteOrder::Little => out.extend($value.to_le_bytes()),
                    ByteOrder::Big => out.extend($value.to_be_bytes()),
                }
            };
        }
        match self {
            Self::U8 => push!((rounded as u8)),
            Self::I16 => push!((rounded as i16)),
            Self::I32 => push!((rounded as i32)),
            Self::F32 => push!(value),
            Self::F64 => push!(f64::from(value)),
            Self::U16 => push!((rounded as u16)),
            Self::U32 => push!((rounded as u32)),
            Self::I64 => push!((rounded as i64)),
            Self::U64 => push!((rounded as u64)),
        }
    }
}

impl fmt::Display for DataType {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::U8 => "u8",
            Self::I16 => "i16",
            Self::I32 => "i32",
            Self::F32 => "f32",
            Self::F64 => "f64",
            Self::U16 => "u16",
            Self::U32 => "u32",
            Self::I64 => "i64",
            Self::U64 => "u64",
        })
    }
}

/// What is done to a stored number on its way to a sample.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Scaling {
    pub gain: f64,
    pub offset: f64,
    /// The stored number that means nothing.
    pub ignore: Option<f64>,
}

/// What happened to samples on the way.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) struct Tally {
    /// Equal to the value that means nothing.
    pub ignored: u64,
    /// Finite, but beyond the range of `f32`.
    pub overflowed: u64,
}

impl std::ops::Add for Tally {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self { ignored: self.ignored + other.ignored, overflowed: self.overflowed + other.overflowed }
    }
}

/// Decodes `out.len()` samples, the first of which begins at `bytes[0]` and each further one `stride` samples later.
pub(super) fn decode(
    kind: DataType,
    order: ByteOrder,
    scaling: Scaling,
    bytes: &[u8],
    stride: usize,
    out: &mut [f32],
) -> Tally {
    macro_rules! of {
        ($number:ty) => {
            match order {
                ByteOrder::Little => samples(bytes, stride, out, scaling, |b| <$number>::from_le_bytes(b)),
                ByteOrder::Big => samples(bytes, stride, out, scaling, |b| <$number>::from_be_bytes(b)),
            }
        };
    }
    match kind {
        DataType::U8 => of!(u8),
        DataType::I16 => of!(i16),
        DataType::I32 => of!(i32),
        DataType::F32 => of!(f32),
        DataType::F64 => of!(f64),
        DataType::U16 => of!(u16),
        DataType::U32 => of!(u32),
        DataType::I64 => of!(i64),
        DataType::U64 => of!(u64),
    }
}

/// A stored number: as a double for scaling, and as a pixel.
trait Stored: Copy {
    fn double(self) -> f64;
    fn pixel(self) -> f32;
}

macro_rules! stored {
    ($($number:ty),*) => {
        $(impl Stored for $number {
            #[allow(clippy::cast_precision_loss, clippy::cast_lossless, clippy::cast_possible_truncation, reason = "pixels are f32")]
            fn double(self) -> f64 {
                self as f64
            }
            #[allow(clippy::cast_precision_loss, clippy::cast_lossless, clippy::cast_possible_truncation, reason = "pixels are f32")]
            fn pixel(self) -> f32 {
                self as f32
            }
        })*
    };
}

stored!(u8, i16, i32, f32, f64, u16, u32, i64, u64);

#[expect(clippy::cast_possible_truncation, reason = "pixels are f32")]
fn samples<const N: usize, T: Stored>(
    bytes: &[u8],
    stride: usize,
    out: &mut [f32],
    scaling: Scaling,
    number: impl Fn([u8; N]) -> T,
) -> Tally {
    let (stored, _) = bytes.as_chunks::<N>();
    let stored = stored.iter().step_by(stride);
    let mut tally = Tally::default();
    if scaling.gain == 1.0 && scaling.offset == 0.0 && scaling.ignore.is_none() {
        if N < 8 {
            out.iter_mut().zip(stored).for_each(|(out, bytes)| *out = number(*bytes).pixel());
            return tally;
        }
        for (out, bytes) in out.iter_mut().zip(stored) {
            let number = number(*bytes);
            *out = number.pixel();
            tally.overflowed += u64::from(out.is_infinite() && number.double().is_finite());
        }
        return tally;
    }
    for (out, bytes) in out.iter_mut().zip(stored) {
        let number = number(*bytes).double();
        if scaling.ignore == Some(number) {
            *out = f32::NAN;
            tally.ignored += 1;
            continue;
        }
        *out = (number * scaling.gain + scaling.offset) as f32;
        tally.overflowed += u64::from(out.is_infinite() && number.is_finite());
    }
    tally
}
