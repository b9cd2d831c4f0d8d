//! The response of a camera: from code to exposure, found from photographs of one scene at several exposure times.
//!
//! ```text
//! ln g(z_ij) = ln E_i + ln t_j      pixel i, exposure j, code z, radiance E up to a factor, time t
//! ```
//!
//! Each channel is determined up to one factor of g; it is fixed by ln g([`GAUGE`]) = 0.
//!
//! | method | what it is | weak point |
//! |---|---|---|
//! | [`monotone`] | robust least squares in codes under g' > 0; a code at an end is a bound; with covariance | seconds, not milliseconds |
//! | [`smooth`] | least squares in ln g where the noise of codes is known, as smooth as the residuals allow | needs many pixels |
//! | [`debevec`] | least squares with a penalty on g'' (Debevec and Malik 1997) | may decrease |
//! | [`robertson`] | alternating means (Robertson, Borman and Stevenson 2003) | noise of the rare codes is kept |

mod consistency;
mod debevec;
mod monotone;
mod robertson;
mod samples;
mod smooth;

use nalgebra::DMatrix;

pub use consistency::{Consistency, Share, check_order, consistency};
pub use debevec::debevec;
pub use monotone::monotone;
pub use robertson::robertson;
pub use samples::{Exposures, Sampling, grid};
pub use smooth::smooth;

/// Codes of a curve.
pub const LEVELS: usize = 256;
/// The code at which ln g is 0.
pub const GAUGE: usize = LEVELS / 2;

/// ln g of one channel.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    /// At codes 0 to 255.
    pub ln_g: Vec<f64>,
    /// Covariance of `ln_g`, 256 × 256, where the method gives it; its row and column of [`GAUGE`] are 0.
    pub covariance: Option<DMatrix<f64>>,
}

impl Curve {
    /// A response that is proportional to exposure. Code 0 stands for half a code: its logarithm is finite.
    #[must_use]
    pub fn linear() -> Self {
        let ln = |z: usize| ((z as f64).max(0.5) / GAUGE as f64).ln();
        Self { ln_g: (0..LEVELS).map(ln).collect(), covariance: None }
    }

    /// ln g at a code from 0 to 255, between whole ones linear.
    #[must_use]
    pub fn ln_exposure(&self, code: f64) -> f64 {
        let (k, share) = split(code);
        self.ln_g[k] + share * (self.ln_g[k + 1] - self.ln_g[k])
    }

    /// d ln g / dz at a code: over the codes beside it.
    #[must_use]
    pub fn slope(&self, code: f64) -> f64 {
        let k = split(code + 0.5).0.clamp(1, LEVELS - 2);
        (self.ln_g[k + 1] - self.ln_g[k - 1]) / 2.0
    }

    /// Standard error of ln g at a code, against the gauge; 0 where the method gives none.
    #[must_use]
    pub fn standard_error(&self, code: f64) -> f64 {
        let k = split(code + 0.5).0;
        self.covariance.as_ref().map_or(0.0, |c| c[(k, k)].max(0.0).sqrt())
    }

    /// Steps at which the curve decreases.
    #[must_use]
    pub fn decreasing_steps(&self) -> usize {
        self.ln_g.windows(2).filter(|w| w[1] < w[0]).count()
    }
}

/// The whole code at or below, at most the last but one, and what is left.
fn split(code: f64) -> (usize, f64) {
    let code = code.clamp(0.0, (LEVELS - 1) as f64);
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to codes")]
    let k = (code as usize).min(LEVELS - 2);
    (k, code - k as f64)
}

/// A first weight of a code: 0 at both ends of the range and 1 in the middle, as the error of ln g of a camera near to linear has it towards
/// black.
fn weight(code: f64) -> f64 {
    let u = code / (LEVELS - 1) as f64;
    (4.0 * u * (1.0 - u)).max(0.0).powi(2)
}
