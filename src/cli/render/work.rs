//! One render: the scene built, its meters and pictures sampled, its results told.

use std::cell::Cell;
use std::io::Write;
use std::path::Path;
use std::time::{Duration, Instant};

use indicatif::ProgressBar;
use serde_json::{Value, json};
use sha2::{Digest, Sha256};

use super::settings::Settings;
use super::state::{self, State};
use super::{audits, files, pictures, sheets};
use crate::cli::notes::{Notes, bar};
use crate::cli::output::Sink;
use crate::cli::{Failure, Talk};
use crate::finding::Finding;
use crate::render::audit::{Audit, bias, energy};
use crate::render::build::{Built, Instrument, Kind, build};
use crate::render::description::{self, Description, Model, Solver};
use crate::render::estimate::{Figure, REPLICATES};
use crate::render::goniophotometer::Run;
use crate::render::measure::{Board, Meter, Target};
use crate::render::radiosity::Summary;
use crate::render::reading::{self, Reading};
use crate::render::spool::{Header, Share, Task};
use crate::report::envelope::{Envelope, Input};
use crate::report::render::{self as report, Seconds};
use crate::report::render_audit;

/// Samples of a pixel with which a picture with a target is begun: from so many on it is found out where they go.
const FEWEST: u64 = 16;
/// Rounds in which meters without a target are sampled: so often the bar moves.
const ROUNDS: u64 = 64;

/// What the command line puts in place of the scene's.
pub(super) struct Overrides {
    pub solver: Option<Solver>,
    pub samples: Option<u64>,
    pub meter_samples: Option<u64>,
    pub seed: Option<u64>,
    pub model: Option<Model>,
    /// Pictures are filtered.
    pub denoise: bool,
    /// The relative standard error that is asked for.
    pub target: Option<f64>,
    pub settings: Settings,
}

/// A scene that is ready, with all that was read for it.
pub(super) struct Work {
    pub(super) path: String,
    pub built: Built,
    pub(super) description: Description,
    inputs: Vec<Input>,
    settings: String,
    /// Pictures are filtered because the command line says so.
    denoise: bool,
    /// Paths of the inputs.
    pub read: Vec<String>,
    /// A checksum of everything that the results depend on.
    pub fingerprint: String,
    /// Every meter with its number in the render; instruments are 2³² numbers apart, so that none depends on another's points.
    pub(super) meters: Vec<(u64, Meter)>,
    /// The first meter of each instrument, and the end.
    pub(super) first: Vec<usize>,
    begun: Instant,
    /// What reading the scene took.
    reading: Duration,
    /// What writing pictures takes so far.
    pub(super) writing: Cell<Duration>,
}

/// How it is to be rendered.
pub(super) struct Job<'a> {
    pub share: Share,
    pub folder: &'a Path,
    /// The relative standard error to reach, per instrument.
    pub targets: &'a [Option<f64>],
    pub talk: Talk,
}

/// Readings, and the files written.
pub(super) struct Done {
    pub(super) readings: Vec<Reading>,
    pub(super) written: Vec<String>,
    /// What the files written could not carry.
    pub(super) findings: Vec<Finding>,
    /// What a solution by radiosity was like.
    pub(super) radiosity: Option<Summary>,
}

impl Work {
    pub(super) fn new(path: &str, overrides: &Overrides) -> Result<Self, Failure> {
        let begun = Instant::now();
        let scene = files::Scene::read(path)?;
        let wrong = |e: description::Error| Failure::Message(format!("{path}:{e}"));
        let mut description = Description::parse(&scene.text).map_err(wrong)?;
        let render = &mut description.render;
        overrides.settings.apply(render);
        render.solver = overrides.solver.unwrap_or(render.solver);
        render.samples = overrides.samples.unwrap_or(render.samples);
        render.meter_samples = overrides.meter_samples.unwrap_or(render.meter_samples);
        render.seed = overrides.seed.unwrap_or(render.seed);
        render.model = overrides.model.unwrap_or(render.model);
        render.wavelength_tolerance = overrides.target.into_iter().fold(render.wavelength_tolerance, f64::min);
        if overrides.denoise {
            render.denoise = Some(toml::Spanned::new(0..0, true));
        }
        // What the scene does not ask for has no place in it.
        let asked = [("--denoise", overrides.denoise), ("--settings", overrides.settings.denoise.is_some())];
        if let Some((option, _)) = asked.iter().find(|(_, asked)| *asked) {
            render.denoises().map_err(|reason| Failure::Message(format!("{option}: {reason}")))?;
        }
        let built = build(&scene.text, &description, &scene).map_err(wrong)?;
        let inputs = scene.inputs();
        let read = inputs.iter().map(|i| i.path.clone()).collect();
        let mut sum = Sha256::new();
        sum.update(env!("CARGO_PKG_VERSION"));
        inputs.iter().filter_map(|i| i.sha256.as_ref()).for_each(|s| sum.update(s));
        sum.update(format!("{:?}", description.render));
        let fingerprint = sum.finalize().iter().map(|b| format!("{b:02x}")).collect();
        let (mut meters, mut first): (Vec<(u64, Meter)>, Vec<usize>) = (Vec::new(), Vec::new());
        for (number, instrument) in (0_u64..).zip(&built.instruments) {
            first.push(meters.len());
            let own: &[Meter] = match &instrument.kind {
                Kind::Meter(meter) => std::slice::from_ref(meter),
                Kind::Grid { meters, .. } => meters,
                Kind::Camera(_) | Kind::Goniophotometer(_) | Kind::Gonioreflectometer(_) => &[],
            };
            meters.extend((0_u64..).zip(own).map(|(point, m)| ((number << 32) + point, m.clone())));
        }
        first.push(meters.len());
        let (path, settings) = (path.to_owned(), overrides.settings.text.clone());
        let denoise = overrides.denoise;
        let (reading, writing) = (begun.elapsed(), Cell::default());
        Ok(Self {
            path,
            built,
            description,
            inputs,
            settings,
            denoise,
            read,
            fingerprint,
            meters,
            first,
            begun,
            reading,
            writing,
        })
    }

    /// The header of the state of a share; `packets` are those of the energy audit.
    pub(super) fn header(&self, share: Share, packets: u64) -> Header {
        let render = &self.description.render;
        let task = Task {
            scene: self.path.clone(),
            samples: render.samples,
            meter_samples: render.meter_samples,
            seed: render.seed,
            full: render.model == Model::Full,
            denoise: self.denoise,
            packets,
            settings: self.settings.clone(),
        };
        state::header(&self.built, self.meters.len(), &self.fingerprint, share, &task)
    }

    /// Samples everything; `None` where only a share was asked for, which is in the state.
    pub(super) fn render(&self, job: &Job<'_>, mut state: Option<&mut State>) -> Result<Option<Done>, Failure> {
        if let Some(settings) = &self.built.radiosity {
            return self.solve(job, settings).map(Some);
        }
        let render = &self.description.render;
        let per_replicate = render.meter_samples.div_ceil(REPLICATES as u64);
        let others: u64 = (self.built.instruments.iter().enumerate())
            .map(|(n, instrument)| match &instrument.kind {
                Kind::Camera(camera) => {
                    let picture = pictures::Job::new(self, job, n, camera);
                    match job.targets[n] {
                        Some(_) => picture.with_samples(FEWEST.min(render.samples)).work(),
                        None => picture.work(),
                    }
                }
                Kind::Goniophotometer(_) => render.meter_samples,
                Kind::Gonioreflectometer(g) => render.meter_samples * g.incident() as u64,
                Kind::Meter(_) | Kind::Grid { .. } => 0,
            })
            .sum();
        // In units of samples, of meters and pixels alike.
        let meter_work = per_replicate * (REPLICATES * self.meters.len()) as u64;
        let progress = progress(meter_work + others, job.talk);
        let mut board = Board::new(&self.built.scene, &self.built.settings, job.share, self.meters.clone());
        if let Some(state) = state.as_deref_mut() {
            state.restore(&mut board, self.meters.len(), per_replicate)?;
        }
        let mut reached = vec![None; self.built.instruments.len()];
        // Of pictures each is rendered to its own.
        let of_meters = |n: &usize| !matches!(self.built.instruments[*n].kind, Kind::Camera(_));
        let targets = || (0..).zip(job.targets).filter_map(|(n, t)| Some((n, (*t)?))).filter(|(n, _)| of_meters(n));
        if targets().next().is_none() {
            for round in 1..=ROUNDS {
                board.sample_until(per_replicate * round / ROUNDS);
                progress.set_position(meter_work * round / ROUNDS);
                if let Some(state) = state.as_deref_mut() {
                    state.store(&board, self.meters.len(), round == ROUNDS)?;
                }
            }
        }
        for (n, relative) in targets() {
            // All meters are sampled alike: those without a target get as many samples as those with one.
            let weights = self.built.quantities.luminous.clone();
            let target = Target { relative, meters: (self.first[n]..self.first[n + 1]).collect(), weights };
            let met = board.sample_to(&target, per_replicate, |_, samples| {
                progress.set_position(meter_work * samples / per_replicate);
            });
            reached[n] = Some((relative, met));
        }
        progress.set_position(meter_work);
        let mut done = Done { readings: Vec::new(), written: Vec::new(), findings: Vec::new(), radiosity: None };
        let place = sheets::Place { folder: job.folder, inputs: &self.read };
        let mut picture = 0;
        for (n, instrument) in self.built.instruments.iter().enumerate() {
            if let Kind::Camera(camera) = &instrument.kind {
                let one = pictures::Job::new(self, job, n, camera);
                if let Some(relative) = job.targets[n] {
                    done.readings.push(self.picture_to(relative, instrument, one, &progress, &mut done.written)?);
                    continue;
                }
                let stored = state.as_deref_mut().map(|s| (s, picture));
                let (noise, price) = one.render(stored, &progress, &mut done.written)?;
                picture += 1;
                done.readings.push(reading::of_picture(instrument, &noise, price, render.samples));
            } else if let Kind::Goniophotometer(goniophotometer) = &instrument.kind {
                let measured = goniophotometer.measure(&Run {
                    scene: &self.built.scene,
                    settings: &self.built.settings,
                    instrument: (n as u64) << 32,
                    samples: render.meter_samples,
                    weights: &self.built.quantities.luminous,
                });
                progress.inc(render.meter_samples);
                if let Some(described) = &self.description.sensor[n].goniophotometer {
                    let described = described.get_ref();
                    done.findings.extend(place.lamp(described, &instrument.name, &measured, &mut done.written)?);
                }
                let (bands, quantities) = (self.built.scene.bands(), &self.built.quantities);
                done.readings.push(reading::of_goniophotometer(instrument, measured, bands, quantities));
            } else if let Kind::Gonioreflectometer(gonioreflectometer) = &instrument.kind {
                let (scene, settings) = (&self.built.scene, &self.built.settings);
                let measured = gonioreflectometer.measure(scene, settings, (n as u64) << 32, render.meter_samples);
                progress.inc(render.meter_samples * gonioreflectometer.incident() as u64);
                if let Some(described) = &self.description.sensor[n].gonioreflectometer {
                    let described = described.get_ref();
                    done.findings.extend(place.brdf(described, &measured, scene.bands(), &mut done.written)?);
                }
                done.readings.push(reading::of_gonioreflectometer(instrument, measured, &self.built.quantities));
            } else if let Some(r) = reading::of_board(
                instrument,
                &board,
                self.first[n],
                self.built.scene.bands(),
                &self.built.quantities,
                reached[n],
            ) {
                let described = self.description.sensor[n].illuminance.as_ref().and_then(|i| i.get_ref().grid.as_ref());
                if let (Some(described), Some(points), true) = (described, &r.points, job.share == Share::WHOLE) {
                    place.grid(described, &r, points, &mut done.written)?;
                }
                done.readings.push(r);
            }
        }
        progress.finish_and_clear();
        Ok((job.share == Share::WHOLE).then_some(done))
    }

    /// Renders a picture with more samples each time, at most as many as it would have, until the standard error of its mean luminance is this share of
    /// it.
    fn picture_to(
        &self,
        relative: f64,
        instrument: &Instrument,
        mut picture: pictures::Job<'_>,
        progress: &ProgressBar,
        written: &mut Vec<String>,
    ) -> Result<Reading, Failure> {
        /// The variance falls as 1/N, or faster; it is itself known to a few per cent.
        const MARGIN: f64 = 1.1;
        let (most, others) = (picture.samples, written.len());
        picture = picture.with_samples(FEWEST.min(most));
        loop {
            written.truncate(others);
            let (noise, price) = picture.render(None, progress, written)?;
            let mut reading = reading::of_picture(instrument, &noise, price, picture.samples);
            let off = reading.figure.standard_error / (relative * reading.figure.value.abs());
            let samples = picture.samples;
            // Of darkness without noise nothing is left to be known.
            let met = off <= 1.0 || reading.figure == Figure { value: 0.0, standard_error: 0.0 };
            if met || samples >= most {
                reading.target = Some((relative, met));
                return Ok(reading);
            }
            let wanted = samples as f64 * off * off * MARGIN;
            let next = if wanted < most as f64 { (wanted.ceil() as u64).clamp(samples + 1, most) } else { most };
            picture = picture.with_samples(next);
            progress.inc_length(picture.work());
        }
    }

    /// Where the energy goes, by so many packets of flux, and what the solver leaves out of every reading.
    fn audit(&self, packets: u64) -> Audit {
        /// Samples of a reading, with and without what the solver leaves out.
        const SAMPLES: u64 = 1 << 13;
        if self.built.endless {
            // Both follow light to its natural end, and there is none.
            return Audit { energy: None, lost: vec![None; self.built.instruments.len()] };
        }
        let Built { scene, settings, quantities, .. } = &self.built;
        let (materials, of) = (self.built.material_names.len(), &self.built.material_of_surface);
        let energy = energy::audit(scene, settings, &quantities.radiant, of, materials, packets);
        let weights = &quantities.luminous;
        let lost = (self.built.instruments.iter().enumerate()).map(|(n, instrument)| match &instrument.kind {
            Kind::Camera(camera) => bias::of_picture(scene, settings, camera, (n as u64) << 32, weights, SAMPLES),
            _ => {
                let meters = &self.meters[self.first[n]..self.first[n + 1]];
                if meters.is_empty() {
                    return None;
                }
                bias::of_meters(scene, settings, meters, weights, SAMPLES.div_ceil(meters.len() as u64))
            }
        });
        Audit { energy, lost: lost.collect() }
    }

    /// What is to be said of the scene and of its readings; said on standard error at once.
    pub(super) fn findings(&self, readings: &[Reading], audit: Option<&Audit>, talk: Talk) -> Vec<Finding> {
        let mut findings = files::findings(&self.path, &self.built, readings);
        findings.extend(audit.into_iter().flat_map(|audit| audits::findings(&self.path, &self.built, audit)));
        Notes::new(&[], talk).print(&findings);
        findings
    }

    /// Tells what came out.
    pub(super) fn report(
        &self,
        command: &str,
        done: Done,
        as_json: bool,
        output: Option<&Path>,
        talk: Talk,
        packets: u64,
    ) -> Result<(), Failure> {
        let rendered = self.begun.elapsed();
        let audit = self.audit(packets);
        let audits = self.begun.elapsed() - rendered;
        let mut findings = self.findings(&done.readings, Some(&audit), talk);
        Notes::new(&[], talk).print(&done.findings);
        findings.extend_from_slice(&done.findings);
        let mut result = report::result(&self.built, &done.readings, &done.written, &self.seconds(audits));
        result["energy"] = render_audit::energy(&self.built, &audit);
        result["bias"] = render_audit::bias(&self.built, &audit);
        let mut text = report::text(&self.built, &done.readings);
        if let Some(summary) = &done.radiosity {
            result["radiosity"] = report::radiosity(summary);
            text.push_str(&report::radiosity_text(summary));
        }
        text.push_str(&render_audit::text(&self.built, &audit));
        done.written.iter().for_each(|w| text.push_str(&format!("written: {w}\n")));
        self.print(command, (result, text), as_json, output, findings)?;
        let reached = done.readings.iter().all(|r| r.target.is_none_or(|t| t.1));
        if reached { Ok(()) } else { Err(Failure::No) }
    }

    /// What the parts of the work took.
    fn seconds(&self, audits: Duration) -> Seconds {
        let total = self.begun.elapsed();
        let (scene, writing) = (self.reading, self.writing.get());
        let rendering = total.saturating_sub(scene + writing + audits);
        let [total, scene, rendering, writing, audits] =
            [total, scene, rendering, writing, audits].map(|part| part.as_secs_f64());
        Seconds { total, scene, rendering, writing, audits }
    }

    /// Writes a result as JSON or as text.
    pub(super) fn print(
        &self,
        command: &str,
        (result, text): (Value, String),
        as_json: bool,
        output: Option<&Path>,
        findings: Vec<Finding>,
    ) -> Result<(), Failure> {
        let mut sink = Sink::open(output, &self.read)?;
        if as_json {
            let render = &self.description.render;
            let settings = json!({
                "samples": render.samples,
                "meter_samples": render.meter_samples,
                "seed": render.seed,
                "replicates": REPLICATES,
            });
            let mut envelope = Envelope::begin(&mut sink, command, &settings)?;
            self.inputs.iter().for_each(|i| envelope.input(i.clone()));
            envelope.result(&result)?;
            findings.into_iter().for_each(|f| envelope.finding(f));
            envelope.end()?;
        } else {
            sink.write_all(text.as_bytes())?;
        }
        sink.finish(true)
    }
}

/// A bar for what takes long.
pub(super) fn progress(samples: u64, talk: Talk) -> ProgressBar {
    bar(samples, "{bar:40} {percent} %, {eta} left", true, talk)
}
