//! Numbers of a manifest that have to be above 0, and directions of some length.

use glam::DVec3;
use serde::Deserialize;
use serde::de::{Deserializer, Error as _};

fn checked<'de, D: Deserializer<'de>>(value: f64, sound: bool, expected: &str) -> Result<f64, D::Error> {
    if sound { Ok(value) } else { Err(D::Error::custom(format!("found {value}; expected {expected}"))) }
}

pub(super) fn positive<'de, D: Deserializer<'de>>(from: D) -> Result<f64, D::Error> {
    let value = f64::deserialize(from)?;
    checked::<D>(value, value > 0.0 && value.is_finite(), "a number above 0")
}

pub(in crate::capture) fn maybe_positive<'de, D: Deserializer<'de>>(from: D) -> Result<Option<f64>, D::Error> {
    positive(from).map(Some)
}

pub(super) fn maybe_size<'de, D: Deserializer<'de>>(from: D) -> Result<Option<[f64; 2]>, D::Error> {
    let size = <[f64; 2]>::deserialize(from)?;
    if !size.iter().all(|s| *s > 0.0 && s.is_finite()) {
        return Err(D::Error::custom(format!("found {size:?}; expected two numbers above 0")));
    }
    Ok(Some(size))
}

pub(super) fn direction<'de, D: Deserializer<'de>>(from: D) -> Result<[f64; 3], D::Error> {
    let value = <[f64; 3]>::deserialize(from)?;
    if DVec3::from_array(value).try_normalize().is_none() {
        return Err(D::Error::custom(format!("found {value:?}; expected a direction of some length")));
    }
    Ok(value)
}
