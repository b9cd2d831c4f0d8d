//! The command line: arguments, files and exit codes. It holds no physics.

use std::ffi::OsString;
use std::io::{self, Write};
use std::process::ExitCode;

use clap::{CommandFactory, Parser, Subcommand};

mod brdf;
mod capture;
mod compare;
mod convert;
mod correct;
mod detector;
mod flicker;
mod image;
mod lamp;
mod notes;
mod output;
mod places;
mod render;
mod require;
mod selfcheck;
mod tables;
mod trade;
mod writer;

/// Light as physics measures it, as people see it, and back.
///
/// Results go to standard output, everything else to standard error. Exit codes: 0 done; 1 ran, and the answer is no; 2 could
/// not run (arguments, unreadable or invalid input).
#[derive(Debug, Parser)]
#[command(name = "photopic", version, max_term_width = 110, arg_required_else_help = true)]
struct Cli {
    #[command(flatten)]
    talk: Talk,
    #[command(subcommand)]
    command: Command,
}

/// How much is said on standard error.
#[derive(Debug, Clone, Copy, clap::Args)]
struct Talk {
    /// Also say what is merely worth knowing (findings of severity info).
    #[arg(short, long, global = true, conflicts_with = "quiet")]
    verbose: bool,
    /// Say nothing but errors, and draw no progress bar.
    #[arg(short, long, global = true)]
    quiet: bool,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Spectra into photometric, colour, colour-quality, photon and α-opic figures.
    Convert(Box<convert::ConvertArgs>),
    /// Spectral images (EXR, ENVI, NPY, stacks of pictures): facts, luminance, XYZ, RGB, other formats.
    #[command(subcommand)]
    Image(image::ImageCommand),
    /// Goniometric lamp data (IES LM-63, EULUMDAT, TM-33): facts, findings, trade tables, other formats.
    #[command(subcommand)]
    Lamp(lamp::LampCommand),
    /// Reflection of materials (BRDF models): facts, audits, values, pictures.
    #[command(subcommand)]
    Brdf(brdf::BrdfCommand),
    /// Photographs of known geometry: the camera, its response, radiance.
    #[command(subcommand)]
    Capture(capture::CaptureCommand),
    /// A scene (TOML) into readings of virtual instruments with their standard errors, and spectral pictures.
    Render(Box<render::RenderArgs>),
    /// Parts of a render (`render --shard`) into its readings and pictures.
    Merge(render::MergeArgs),
    /// What speed costs in accuracy, measured on an input: settings timed and compared, and the fastest that meets an error.
    #[command(subcommand)]
    Trade(trade::TradeCommand),
    /// The simplest model that carries a scene, a lamp, a spectrum, a material, a spectral image or photographs within an error, and the error of a
    /// simpler one; exit code 1 where none does.
    Require(Box<require::RequireArgs>),
    /// Extremes and reference cases, run on this machine: from 1 K to 10⁹ K, from 1e-300 to 1e300 W, grazing angles, tiny and huge scenes;
    /// exit code 1 where one is off.
    Selfcheck(selfcheck::SelfcheckArgs),
    /// Photometers: f1', spectral mismatch factors for a set of lamps, their ranking.
    Detector(detector::DetectorArgs),
    /// Raw spectra into corrected ones: dark signal, stray light, wavelengths, bandwidth, smoothing, resampling, with their uncertainty.
    Correct(Box<correct::CorrectArgs>),
    /// Light over time: percent flicker, flicker index, stroboscopic visibility (SVM), short-term flicker (Pst LM).
    Flicker(flicker::FlickerArgs),
    /// Two measurements, each with its budget: what of their differences is significant.
    Compare(compare::CompareArgs),
    /// The embedded reference tables, with source, checksum and terms.
    Tables(tables::TablesArgs),
    /// Shell completions.
    Completions {
        /// The shell.
        shell: clap_complete::Shell,
    },
    /// The manual pages: of the tool, or of a verb.
    Man {
        /// The verb.
        verb: Option<String>,
    },
}

/// Why a run ended without doing all that was asked.
#[derive(Debug, thiserror::Error)]
enum Failure {
    /// Nothing more to write to: the reader went away, which is its right.
    #[error("broken pipe")]
    BrokenPipe,
    /// What to tell the user.
    #[error("{0}")]
    Message(String),
    /// Already reported.
    #[error("reported")]
    Reported,
    /// Ran, and the answer is no.
    #[error("no")]
    No,
}

impl From<io::Error> for Failure {
    fn from(error: io::Error) -> Self {
        if error.kind() == io::ErrorKind::BrokenPipe { Self::BrokenPipe } else { Self::Message(error.to_string()) }
    }
}

/// Parses the arguments, runs, and says how it went.
#[must_use]
pub fn run(arguments: impl IntoIterator<Item = OsString>) -> ExitCode {
    let cli = match Cli::try_parse_from(arguments) {
        Ok(cli) => cli,
        Err(error) => {
            // Help and version are answers (0), anything else is a call that cannot be run (2). A reader that has gone is neither.
            let code = if error.use_stderr() { 2 } else { 0 };
            let _ = error.print();
            return ExitCode::from(code);
        }
    };
    let done = match cli.command {
        Command::Convert(arguments) => convert::run(*arguments, cli.talk),
        Command::Image(command) => image::run(command, cli.talk),
        Command::Lamp(command) => lamp::run(command, cli.talk),
        Command::Brdf(command) => brdf::run(command, cli.talk),
        Command::Capture(command) => capture::run(command, cli.talk),
        Command::Render(arguments) => render::run(&arguments, cli.talk),
        Command::Merge(arguments) => render::merge(&arguments, cli.talk),
        Command::Trade(command) => trade::run(command, cli.talk),
        Command::Require(arguments) => require::run(&arguments, cli.talk),
        Command::Selfcheck(arguments) => selfcheck::run(&arguments, cli.talk),
        Command::Detector(arguments) => detector::run(&arguments, cli.talk),
        Command::Correct(arguments) => correct::run(&arguments, cli.talk),
        Command::Flicker(arguments) => flicker::run(&arguments, cli.talk),
        Command::Compare(arguments) => compare::run(&arguments, cli.talk),
        Command::Tables(arguments) => tables::run(&arguments),
        Command::Completions { shell } => completions(shell),
        Command::Man { verb } => manual(verb.as_deref()),
    };
    match done {
        Ok(()) | Err(Failure::BrokenPipe) => ExitCode::SUCCESS,
        Err(Failure::No) => ExitCode::from(1),
        Err(Failure::Reported) => ExitCode::from(2),
        Err(Failure::Message(message)) => {
            let mut stderr = io::stderr().lock();
            let _ = writeln!(stderr, "error: {message}");
            ExitCode::from(2)
        }
    }
}

fn completions(shell: clap_complete::Shell) -> Result<(), Failure> {
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut Cli::command(), "photopic", &mut script);
    Ok(io::stdout().write_all(&script)?)
}

fn manual(verb: Option<&str>) -> Result<(), Failure> {
    let mut command = Cli::command();
    command.build();
    let page = match verb {
        None => command,
        Some(verb) => {
            let known: Vec<&str> = command.get_subcommands().map(clap::Command::get_name).collect();
            let message = format!("no verb `{verb}`; expected one of {}", known.join(", "));
            let found = command.find_subcommand(verb).cloned().ok_or(Failure::Message(message))?;
            let name = format!("photopic-{verb}");
            found.display_name(name)
        }
    };
    let mut text = Vec::new();
    clap_mangen::Man::new(page).render(&mut text)?;
    Ok(io::stdout().write_all(&text)?)
}
