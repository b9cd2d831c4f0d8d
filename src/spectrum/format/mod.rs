//! Reading spectra from files: one file per format, one error type with line and column, formats told by content.
//!
//! A reader returns what the file states and nothing more: [`Entry`] keeps the quantity and unit as found (or absent), the
//! figures that the instrument printed, and the samples in nm, ascending, finite and without duplicates.
//! [`Entry::resolve`] brings an entry to SI per nanometre, with the user's word where the file is silent.

use super::{Quantity, SpectralUnit, Spectrum};

/// One spectrum as its file states it.
#[derive(Debug, Clone, PartialEq)]
pub struct Entry {
    /// Name in the file: column header, row label, title; empty where there is none.
    pub name: String,
    /// The samples in the file's own unit, wavelengths in nm.
    pub spectrum: Spectrum,
    /// Quantity, where the file states one.
    pub quantity: Option<Quantity>,
    /// Unit of the samples, where the file states one.
    pub unit: Option<SpectralUnit>,
    /// Figures that the instrument printed beside the spectrum.
    pub printed: Vec<Printed>,
    /// Other facts in the file (maker, date, integration time), label and text, in file order.
    pub metadata: Vec<(String, String)>,
}

/// A figure that an instrument printed beside its spectrum.
#[derive(Debug, Clone, PartialEq)]
pub struct Printed {
    /// The key under which our own figure of the same meaning stands in the results, such as `photopic.illuminance_lx`,
    /// `cct_k`, `cri_ra`, `cri_r.9`, `tm30_rf`, `chromaticity_xy.0`; empty where we have none.
    pub key: &'static str,
    /// The label in the file.
    pub label: String,
    /// The figure.
    pub value: f64,
    /// The figure as printed, which tells its digits.
    pub text: String,
}
