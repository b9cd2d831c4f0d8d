//! From radiometric spectra to what eyes, receptors, plants and hazards make of them.
//!
//! - [`luminous`]: photopic and scotopic quantities with K_m and K′_m; the luminous efficiency functions.
//! - [`mesopic`]: the MES2 system of CIE 191.
//! - [`alpha_opic`]: CIE S 026.
//! - [`photon`]: photon numbers, PAR and PPFD.
//! - [`hazard`]: weighting with the hazards of blue light, heat and ultraviolet.
//! - [`risk`]: risk groups of lamps.
//! - [`detector`]: f₁′ and spectral mismatch factors of photometers.
//! - [`flicker`]: light over time.
//! - [`transfer`]: geometry that turns one quantity into another.

pub mod alpha_opic;
pub mod detector;
pub mod flicker;
pub mod hazard;
pub mod luminous;
pub mod mesopic;
pub mod photon;
pub mod risk;
pub mod transfer;
