//! A render by radiosity: solved once, and once more with patches twice as long to tell the discretisation's error.

use super::work::{Done, Job, Work, progress};
use super::{pictures, sheets};
use crate::cli::Failure;
use crate::render::build::Kind;
use crate::render::estimate::{Estimate, Faults, Replicate};
use crate::render::measure::Meter;
use crate::render::radiosity::gather::Gatherer;
use crate::render::radiosity::{self, Settings};
use crate::render::reading::{self, Reading};

impl Work {
    /// Solves the scene and reads its instruments.
    pub(super) fn solve(&self, job: &Job<'_>, settings: &Settings) -> Result<Done, Failure> {
        let (scene, quantities) = (&self.built.scene, &self.built.quantities);
        let wrong = |e: radiosity::Error| Failure::Message(format!("{}: {e}", self.path));
        let fine = radiosity::solve(scene, settings, &quantities.radiant).map_err(wrong)?;
        let coarse = Settings { edge_m: Some(2.0 * fine.summary.edge_m), ..*settings };
        let coarse = radiosity::solve(scene, &coarse, &quantities.radiant).map_err(wrong)?;
        let (fine_gatherer, coarse_gatherer) = (Gatherer::new(&fine), Gatherer::new(&coarse));
        let pixels = |kind: &Kind| match kind {
            Kind::Camera(c) => u64::from(c.width()) * u64::from(c.height()),
            _ => 0,
        };
        let progress = progress(self.built.instruments.iter().map(|i| pixels(&i.kind)).sum(), job.talk);
        let mut done =
            Done { readings: Vec::new(), written: Vec::new(), findings: Vec::new(), radiosity: Some(fine.summary) };
        let place = sheets::Place { folder: job.folder, inputs: &self.read };
        let dot = |values: &[f64]| values.iter().zip(&quantities.luminous).map(|(v, w)| v * w).sum::<f64>();
        for (n, instrument) in self.built.instruments.iter().enumerate() {
            if let Kind::Camera(camera) = &instrument.kind {
                let job = pictures::Job::new(self, job, n, camera);
                let noise = job.solved(&fine_gatherer, &progress, &mut done.written)?;
                done.readings.push(reading::of_picture(instrument, &noise, None, job.samples.min(16)));
                continue;
            }
            let meters = &self.meters[self.first[n]..self.first[n + 1]];
            let read = |g: &Gatherer<'_>, meter: &Meter| g.reading(meter).expect("checked: no meter around the scene");
            let mut difference = 0.0;
            let estimates: Vec<Estimate> = (meters.iter())
                .map(|(_, meter)| {
                    let values = read(&fine_gatherer, meter);
                    difference += (dot(&values) - dot(&read(&coarse_gatherer, meter))).abs();
                    // Twice the same: a mean without scatter.
                    Estimate::new(vec![Replicate::from_parts(values, 1, Faults::default()); 2])
                })
                .collect();
            let read = reading::of_meters(instrument, &estimates, scene.bands(), quantities, None);
            let Some(mut r) = read else { continue };
            #[expect(clippy::cast_precision_loss, reason = "a number of meters")]
            let mean = difference / meters.len() as f64;
            r.discretisation = Some(mean);
            let described = self.description.sensor[n].illuminance.as_ref().and_then(|i| i.get_ref().grid.as_ref());
            if let (Some(described), Some(points)) = (described, &r.points) {
                place.grid(described, &r, points, &mut done.written)?;
            }
            done.readings.push(r);
        }
        progress.finish_and_clear();
        // What one reading changes by may be small by chance; what any changes by is what all are taken to be off by.
        let share = |r: &Reading| r.discretisation.filter(|_| r.figure.value > 0.0).map(|d| d / r.figure.value);
        let largest = done.readings.iter().filter_map(share).fold(0.0, f64::max);
        for r in &mut done.readings {
            r.discretisation = r.discretisation.map(|own| own.max(largest * r.figure.value));
        }
        Ok(done)
    }
}
