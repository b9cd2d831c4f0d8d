//! A render's state on disk: to go on after a break, and to be joined from shares.

use std::fs::{File, OpenOptions};
use std::path::Path;
use std::time::{Duration, Instant};

use crate::cli::Failure;
use crate::image::description::Description;
use crate::image::error::Error as ImageError;
use crate::image::source::{self, Region, Source};
use crate::render::build::{Built, Kind};
use crate::render::denoise::record::Layout;
use crate::render::estimate::REPLICATES;
use crate::render::film::{Film, strip};
use crate::render::measure::Board;
use crate::render::noise::Noise;
use crate::render::spool::{Extent, Header, Share, Spool, Task};

/// Meters are stored this often; rows of pictures as they are done.
const BETWEEN: Duration = Duration::from_secs(5);
/// Rows rendered before they are stored: whole strips.
const ROWS: usize = 16;

/// One file that holds everything, or several that hold a share each.
pub(super) struct State {
    files: Vec<Spool<File>>,
    stored: Instant,
    /// It was joined from shares, which must be whole and stay as they are.
    is_joined: bool,
}

fn told(path: &Path) -> impl Fn(crate::render::spool::Error) -> Failure + '_ {
    move |e| Failure::Message(format!("{}: {e}", path.display()))
}

fn unfinished(share: Share) -> Failure {
    let (index, count) = (share.index + 1, share.count);
    Failure::Message(format!(
        "share {index}/{count} is not finished; expected `photopic render --shard {index}/{count}` to run to its end"
    ))
}

/// The header of the state of a render.
pub(super) fn header(built: &Built, points: usize, fingerprint: &str, share: Share, task: &Task) -> Header {
    let bands = built.scene.bands().len();
    let channels = if built.denoises { Layout { bands }.channels() } else { bands + 3 };
    let pictures = (built.instruments.iter())
        .filter_map(|i| match &i.kind {
            Kind::Camera(c) => Some(Extent { width: c.width() as usize, height: c.height() as usize, channels }),
            _ => None,
        })
        .collect();
    Header { fingerprint: fingerprint.to_owned(), task: task.clone(), share, points, bands, pictures }
}

impl State {
    /// Opens the file, which must belong to this render, or begins it where there is none (and `resume` does not ask for one).
    pub(super) fn open(path: &Path, header: &Header, resume: bool) -> Result<Self, Failure> {
        let begin = !resume && !path.exists();
        let mut options = OpenOptions::new();
        options.read(true).write(true).create_new(begin);
        let file = options.open(path).map_err(|e| {
            Failure::Message(format!("{}: cannot be opened: {e}; expected the state of a render", path.display()))
        })?;
        let spool = if begin {
            Spool::create(file, header.clone()).map_err(told(path))?
        } else {
            let spool = Spool::open(file).map_err(told(path))?;
            spool.check(&header.fingerprint).map_err(told(path))?;
            if spool.header().share != header.share {
                let Share { index, count } = spool.header().share;
                let message =
                    format!("{}: share {}/{count} of the render; expected another", path.display(), index + 1);
                return Err(Failure::Message(message));
            }
            spool
        };
        Ok(Self { files: vec![spool], stored: Instant::now(), is_joined: false })
    }

    /// Opens the shares of a render: all of them, each once.
    pub(super) fn join(paths: &[String]) -> Result<Self, Failure> {
        let mut files: Vec<Spool<File>> = Vec::new();
        for path in paths {
            let place = Path::new(path);
            let file = File::open(place)
                .map_err(|e| Failure::Message(format!("{path}: cannot be read: {e}; expected a share of a render")))?;
            let spool = Spool::open(file).map_err(told(place))?;
            if let Some(first) = files.first() {
                spool.check(&first.header().fingerprint).map_err(told(place))?;
            }
            let share = spool.header().share;
            if files.iter().any(|f| f.header().share.count != share.count || f.header().share.index == share.index) {
                let message =
                    format!("{path}: share {}/{} twice, or of another division", share.index + 1, share.count);
                return Err(Failure::Message(message));
            }
            files.push(spool);
        }
        let count = files[0].header().share.count;
        let missing: Vec<String> = (0..count)
            .filter(|index| files.iter().all(|f| f.header().share.index != *index))
            .map(|index| format!("{}/{count}", index + 1))
            .collect();
        if !missing.is_empty() {
            return Err(Failure::Message(format!(
                "the shares {} are missing; expected all of them",
                missing.join(", ")
            )));
        }
        Ok(Self { files, stored: Instant::now(), is_joined: true })
    }

    /// What the files hold.
    pub(super) fn header(&self) -> &Header {
        self.files[0].header()
    }

    /// Packets of the energy audit: the most that any of the files asks for, in whatever order they come.
    pub(super) fn packets(&self) -> u64 {
        self.files.iter().map(|f| f.header().task.packets).max().unwrap_or(0)
    }

    /// The file that holds replicate or strip `number`.
    fn holder(&mut self, number: usize) -> Option<&mut Spool<File>> {
        self.files.iter_mut().find(|f| f.header().share.has(number))
    }

    /// Puts on the board what was stored; of shares that are joined, `samples` per replicate.
    pub(super) fn restore(&mut self, board: &mut Board<'_>, points: usize, samples: u64) -> Result<(), Failure> {
        let is_joined = self.is_joined;
        for point in 0..points {
            for number in 0..REPLICATES {
                let Some(file) = self.holder(number) else { continue };
                match file.replicate(point, number).map_err(|e| Failure::Message(e.to_string()))? {
                    Some(found) if !is_joined || found.samples() == samples => board.restore(point, number, found),
                    _ if is_joined => return Err(unfinished(file.header().share)),
                    _ => {}
                }
            }
        }
        Ok(())
    }

    /// Stores what is on the board, not more often than every few seconds unless it is the `last` time.
    pub(super) fn store(&mut self, board: &Board<'_>, points: usize, last: bool) -> Result<(), Failure> {
        if self.is_joined || (!last && self.stored.elapsed() < BETWEEN) {
            return Ok(());
        }
        self.stored = Instant::now();
        for point in 0..points {
            for (number, replicate) in board.replicates(point).iter().enumerate() {
                let Some(file) = self.holder(number) else { continue };
                file.store_replicate(point, number, replicate).map_err(|e| Failure::Message(e.to_string()))?;
            }
        }
        Ok(())
    }

    /// Renders the rows of a picture that are this state's and not stored yet, after a survey, as `rows_of` does.
    pub(super) fn render<F: Fn(u64) + Send + Sync>(
        &mut self,
        picture: usize,
        film: &mut Film<'_, F>,
        survey: impl Fn(&mut Film<'_, F>),
        rows_of: impl Fn(&mut Film<'_, F>, &[usize]) -> Vec<(Noise, Vec<f32>)>,
    ) -> Result<(), Failure> {
        let wrong = |e: crate::render::spool::Error| Failure::Message(e.to_string());
        let is_joined = self.is_joined;
        let mut missing = Vec::new();
        let (width, height) = (film.description().width, film.description().height);
        let strips = (0..height).step_by(strip(width)).map(|y| y..height.min(y + strip(width)));
        for (number, rows) in strips.enumerate() {
            let Some(file) = self.holder(number) else { continue };
            let mut has = true;
            for y in rows.clone() {
                has &= file.row(picture, y).map_err(wrong)?.is_some();
            }
            if !has && is_joined {
                return Err(unfinished(file.header().share));
            }
            if !has {
                // What its rows have in common is known only where all of them are rendered.
                missing.extend(rows);
            }
        }
        if !missing.is_empty() {
            survey(film);
        }
        for rows in missing.chunks(ROWS) {
            for (y, (noise, samples)) in rows.iter().zip(rows_of(film, rows)) {
                if let Some(file) = self.holder(*y / strip(width)) {
                    file.store_row(picture, *y, &noise, &samples).map_err(wrong)?;
                }
            }
        }
        Ok(())
    }

    /// All rows of a picture that are stored, and its noise.
    pub(super) fn rows(&mut self, picture: usize) -> Result<(Noise, Vec<Vec<f32>>), Failure> {
        let mut noise = Noise::default();
        let rows = (0..self.header().pictures[picture].height).map(|y| {
            let (of_row, samples) = self.row(picture, y).map_err(|e| Failure::Message(e.to_string()))?;
            noise.append(&of_row);
            Ok(samples)
        });
        let rows = rows.collect::<Result<_, Failure>>()?;
        Ok((noise, rows))
    }

    /// A row of a picture.
    fn row(&mut self, picture: usize, y: usize) -> std::io::Result<(Noise, Vec<f32>)> {
        let missing = || std::io::Error::other(format!("row {y} was not rendered; expected a share that is whole"));
        let strip = strip(self.header().pictures[picture].width);
        let file = self.holder(y / strip).ok_or_else(missing)?;
        file.row(picture, y).map_err(std::io::Error::other)?.ok_or_else(missing)
    }

    /// A picture whose rows are all stored.
    pub(super) fn picture(&mut self, picture: usize, description: Description) -> Stored<'_> {
        Stored { state: self, picture, description, noise: Noise::default() }
    }
}

/// A stored picture as a source of pixels; read from top to bottom, it sums up its noise.
pub(super) struct Stored<'a> {
    state: &'a mut State,
    picture: usize,
    description: Description,
    pub noise: Noise,
}

impl Source for Stored<'_> {
    fn description(&self) -> &Description {
        &self.description
    }

    fn read(&mut self, region: Region, channels: &[usize], out: &mut [f32]) -> Result<(), ImageError> {
        source::check(&self.description, region, channels, out);
        let width = self.description.width;
        for (y, row) in (region.y..).zip(out.chunks_exact_mut((region.width * channels.len()).max(1))) {
            let (noise, samples) = self.state.row(self.picture, y)?;
            self.noise.append(&noise);
            for (channel, out) in channels.iter().zip(row.chunks_exact_mut(region.width)) {
                out.copy_from_slice(&samples[channel * width + region.x..][..region.width]);
            }
        }
        Ok(())
    }
}
