//! What photographs were developed with, beside their result.

use serde_json::{Value, json};

use super::capture::channel_name;
use crate::capture::camera::{Calibration, Camera, Edge};
use crate::capture::flat::Vignetting;
use crate::capture::noise::Noise;

/// Codes at which the noise is told.
const CODES: [u8; 8] = [8, 16, 32, 64, 128, 192, 224, 250];

/// What was found on the way to linear pictures.
#[derive(Debug, Clone, Copy, Default)]
pub struct Developed<'a> {
    /// The camera as it was used, where there is one.
    pub camera: Option<&'a Camera>,
    /// Where it is from.
    pub calibration: Option<&'a Calibration>,
    /// What the edge of the sphere changed.
    pub edge: Option<&'a Edge>,
    /// The noise of codes.
    pub noise: Option<&'a Noise>,
    /// What the flat field told.
    pub vignetting: Option<&'a Vignetting>,
}

/// Adds `camera`, `noise` and `vignetting` to a result, as far as there are any.
pub fn add(result: &mut Value, d: &Developed<'_>) {
    if let Some(camera) = d.camera {
        let (i, l) = (&camera.intrinsics, &camera.distortion);
        let mut out = json!({
            "intrinsics": {"fx": i.fx, "fy": i.fy, "cx": i.cx, "cy": i.cy},
            "distortion": {"k1": l.k1, "k2": l.k2, "p1": l.p1, "p2": l.p2, "k3": l.k3},
        });
        if let Some(found) = d.calibration {
            out["rms_px"] = found.rms_px.into();
            out["standard_errors"] = json!(found.standard_errors);
        }
        if let Some(edge) = d.edge {
            out["edge"] = json!({
                "moved_px": edge.moved_px.to_array(), "focal_length_factor": edge.zoom, "rms_px": edge.rms_px,
                "standard_error_px": edge.standard_error_px,
            });
        }
        result["camera"] = out;
    }
    if let Some(noise) = d.noise {
        let channel = |c: usize| {
            let name = channel_name(noise.channels(), c);
            json!({"channel": name, "codes": CODES, "standard_errors": CODES.map(|z| noise.at(c, f64::from(z)))})
        };
        result["noise"] = (0..noise.channels()).map(channel).collect();
    }
    if let Some(v) = d.vignetting {
        result["vignetting"] = json!({
            "centre_px": v.centre.to_array(), "unit_px": v.unit_px, "coefficients": v.coefficients, "rms": v.rms, "least": v.least,
        });
    }
}
