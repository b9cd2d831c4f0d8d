//! Lists of directions beside the lights that were found.

use glam::DVec3;

use super::run::Run;
use crate::capture::lights::adjust::Adjusted;
use crate::capture::lights::list::{self, Listed};
use crate::capture::setup::Place;
use crate::cli::Failure;
use crate::cli::capture::photos::Photos;
use crate::finding::Finding;
use crate::report::capture_lights::{self as report, Compared, What};

/// Angle between a list and the photographs from which on it is told, degrees: that of a highlight is known to a quarter of one.
const WRONG_DEG: f64 = 1.0;

impl Run {
    /// The directions that the manifest states for lights that were found too.
    pub(super) fn stated(&self, photos: &Photos, adjusted: &Adjusted) -> Vec<Compared> {
        let centre = adjusted.balls[0].centre;
        let listed: Vec<Listed> = (photos.manifest.light.iter())
            .filter(|l| self.names.contains(&l.name))
            .map(|l| {
                let direction = match l.place {
                    Place::Near(p) => DVec3::from_array(p) - centre,
                    Place::Distant(d) => DVec3::from_array(d),
                };
                Listed { name: Some(l.name.clone()), direction }
            })
            .collect();
        if listed.is_empty() {
            return Vec::new();
        }
        self.listed("the manifest", &listed, |k| report::direction(adjusted, k)).into_iter().collect()
    }

    /// A list beside the lights found: by name where its names are theirs, else in order.
    pub(super) fn listed(
        &self,
        source: &str,
        listed: &[Listed],
        direction: impl Fn(usize) -> DVec3,
    ) -> Result<Compared, Failure> {
        let named = |l: &Listed| l.name.as_ref().and_then(|n| self.names.iter().position(|m| m == n));
        let by_name: Vec<(usize, DVec3)> = listed.iter().filter_map(|l| named(l).map(|k| (k, l.direction))).collect();
        let pairs = match () {
            () if by_name.len() == listed.len() => by_name,
            () if listed.len() == self.names.len() => {
                listed.iter().enumerate().map(|(k, l)| (k, l.direction)).collect()
            }
            () => {
                return Err(Failure::Message(format!(
                    "{source}: found {} lights; expected {}, one for each light of the photographs, or their names",
                    listed.len(),
                    self.names.len()
                )));
            }
        };
        let (lights, listed): (Vec<usize>, Vec<DVec3>) = pairs.into_iter().unzip();
        let found: Vec<DVec3> = lights.iter().map(|k| direction(*k)).collect();
        let difference = list::compare(&listed, &found);
        Ok(Compared { source: source.to_owned(), lights, listed, difference })
    }
}

/// A list that is off by degrees.
pub(super) fn wrong_list(run: &Run, a: &report::Answer<'_>, c: &Compared) -> Option<Finding> {
    let d = &c.difference;
    let highlighted = |k: usize| run.seen.iter().any(|s| s.light == k && matches!(s.what, What::Highlight(_)));
    // Shading alone is believed to three times its spread.
    let bound = |k: usize| {
        let spread = run.seen.iter().filter(|s| s.light == k).map(|s| match s.what {
            What::Shading(s) => 3.0 * s.spread_deg,
            What::Highlight(_) => 0.0,
        });
        if highlighted(k) { WRONG_DEG.max(3.0 * a.adjusted.errors_deg[k]) } else { spread.fold(WRONG_DEG, f64::max) }
    };
    let far: Vec<usize> = (0..c.lights.len()).filter(|i| d.angles_deg[*i] > bound(c.lights[*i])).collect();
    if far.is_empty() {
        return None;
    }
    let angles = far.iter().map(|i| d.angles_deg[*i]);
    let (least, most) = (angles.clone().fold(f64::INFINITY, f64::min), angles.fold(0.0, f64::max));
    let mut words = format!(
        "{} of {} directions of {} are {least:.1} to {most:.1} degrees off what the photographs show",
        far.len(),
        c.lights.len(),
        c.source
    );
    let listed = |l: usize| c.lights.iter().position(|k| *k == l).map(|at| c.listed[at]);
    let shading = report::from_shading(a.seen, listed).zip(report::from_shading(a.seen, |l| Some(a.direction(l))));
    if let Some((list, photographs)) = shading {
        words += &format!(
            "; the shading of the diffuse ball is {list:.1} degrees from them in the mean, {photographs:.1} from these"
        );
    }
    let left = d.turned_deg.iter().sum::<f64>() / d.turned_deg.len() as f64;
    let hint = match d.mirrored {
        Some(axis) => format!("its {axis} axis points the other way"),
        None => format!("one rotation of {:.1} degrees leaves {left:.1} in the mean", d.rotation_deg),
    };
    Some(Finding::warning("K024", words).hint(hint))
}
