//! Images as JSON, CSV and text.

mod compare;
mod falsecolor;
mod info;
mod probe;
mod quantity;

pub use compare::{Compared, Comparison, DeltaE, PERCENTILES};
pub use falsecolor::{Legend, falsecolor, title};
pub use info::{info, info_text};
pub use probe::{Part, Probed, Table, probe_csv, probe_text};
pub use quantity::name as photopic_name;
