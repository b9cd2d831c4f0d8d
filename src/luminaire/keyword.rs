//! Labels of [`Luminaire::keywords`](super::Luminaire::keywords) that mean something to this library; those of LM-63 where it
//! has the same, else with the underscore that LM-63-2002, 5.2 reserves for a user's own.

/// Measurement report number (EULUMDAT line 8).
pub const REPORT: &str = "TEST";
/// File name (EULUMDAT line 11).
pub const FILE: &str = "_FILENAME";
/// Date and user (EULUMDAT line 12).
pub const DATE_USER: &str = "_DATE_USER";
/// Ityp (EULUMDAT line 2).
pub const TYPE: &str = "_ITYP";
/// Tilt during the measurement (EULUMDAT line 25), °.
pub const TILT_DEG: &str = "_TILT_DEG";
/// Heights of the luminous area at C0, C90, C180, C270 (EULUMDAT lines 18–21), mm.
pub const HEIGHTS: &str = "_OPENING_HEIGHTS_MM";
/// The ten direct ratios of EULUMDAT.
pub const DIRECT_RATIOS: &str = "_DIRECT_RATIOS";
/// What LM-63 writes behind `TILT=`: output of the lamp by its position.
pub const LAMP_TILT: &str = "TILT";

/// How the file came to be: the file-generation code of LM-63-2019, table 2.
pub const FILE_GENERATION: &str = "FILEGENERATION";

/// Names by which makers declare the luminaire's own flux, without blanks, `_` and `-`.
const DECLARED_FLUX: [&str; 6] =
    ["ABSOLUTELUMENS", "TOTALLUMINAIRELUMENS", "LUMINAIRELUMENS", "TOTALLUMENS", "LUMINAIREFLUX", "TOTALLUMINAIREFLUX"];

/// Whether a label is one by which makers declare the luminaire's own flux.
#[must_use]
pub fn declares_flux(label: &str) -> bool {
    let bare: String = label.chars().filter(char::is_ascii_alphanumeric).collect();
    DECLARED_FLUX.contains(&bare.as_str())
}
