//! Audits of a render: where the energy goes, and what is lost on the way.
//!
//! | file | what it tells |
//! |---|---|
//! | [`energy`] | what every light emits and every material absorbs, and what escapes, by light tracing |
//! | [`bias`] | what readings lose to cut paths and to solvers that leave light out |

pub mod bias;
pub mod energy;

use self::bias::Lost;
use self::energy::Energy;
use super::estimate::Figure;

/// What was found out about a render beside its readings.
#[derive(Debug, Clone, PartialEq)]
pub struct Audit {
    /// Where the energy went; `None` where it was not asked for or nothing shines.
    pub energy: Option<Energy>,
    /// What each instrument loses, in their order; `None` where the solver leaves nothing out.
    pub lost: Vec<Option<Lost>>,
}

/// The mean of independent replicates with its standard error.
fn figure(replicates: &[f64]) -> Figure {
    #[expect(clippy::cast_precision_loss, reason = "a number of replicates")]
    let n = replicates.len() as f64;
    let value = replicates.iter().sum::<f64>() / n;
    let scatter = replicates.iter().map(|m| (m - value) * (m - value)).sum::<f64>();
    Figure { value, standard_error: (scatter / (n * (n - 1.0))).sqrt() }
}

/// Whether a figure that should be 0 is not: farther from it than chance has it once in 10 000 times (Student's t of 31 degrees of
/// freedom), and than rounding of sums of the size `scale`.
#[must_use]
pub fn is_off(figure: Figure, scale: f64) -> bool {
    const T: f64 = 4.45;
    figure.value.abs() > T * figure.standard_error + 1e-9 * scale
}
