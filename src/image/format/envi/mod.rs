//! ENVI images: a text header (`.hdr`) beside a file of plain numbers (NV5 Geospatial, "ENVI Header Files").
//!
//! | header field | here |
//! |---|---|
//! | `samples`, `lines`, `bands` | columns, rows, channels; required |
//! | `data type` | 1 u8, 2 i16, 3 i32, 4 f32, 5 f64, 12 u16, 13 u32, 14 i64, 15 u64; required. 6 and 9, complex, are refused |
//! | `interleave` | bsq, bil, bip; bsq where absent |
//! | `byte order` | 0 little, 1 big endian; needed for numbers of more than a byte |
//! | `header offset` | bytes before the numbers, 0 where absent |
//! | `wavelength`, `wavelength units`, `fwhm` | one per band; nanometres taken where no unit is stated (S003) |
//! | `bbl` | bands marked 0 take part in no integral |
//! | `data gain values`, `data offset values` | sample · gain + offset, per band |
//! | `reflectance scale factor` | samples are divided by it and are reflectances |
//! | `data reflectance gain values`, `… offset values` | as the plain ones, and the samples are reflectances |
//! | `data ignore value` | samples equal to it become NaN |
//! | `band names`, `description` | names, attributes |
//! | `data units` | unit of the samples, as [`crate::spectrum::SpectralUnit`] reads it |
//!
//! Whatever else stands in a header is carried along as an attribute.

mod header;
mod number;
mod read;
mod write;

pub use header::{Header, Interleave, parse_header};
pub use number::{ByteOrder, DataType};
pub(super) use read::open_numbers;
pub use read::{Envi, Options, open};
pub(super) use write::write_numbers;
pub use write::{WriteOptions, write};
