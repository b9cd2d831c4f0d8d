//! Arguments of `convert`, and the settings they mean.

use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use serde::Deserialize;

use super::{input, measures};
use crate::cli::Failure;
use crate::colorimetry::adaptation::Transform;
use crate::colorimetry::{Observer, cct, chromaticity};
use crate::constants::{K_M, K_M_SCOTOPIC, SecondRadiation};
use crate::conversion::{Groups, Level, Resampling, Settings};
use crate::illuminant::named;
use crate::photometry::luminous::{Efficacy, Efficiency};
use crate::photometry::transfer::{Geometry, Shape};
use crate::spectrum::format::{Format, Layout, ReadOptions};
use crate::spectrum::integrate::{Contract, Rule};
use crate::spectrum::resample::{Extrapolation, Interpolation};
use crate::spectrum::{Quantity, SpectralUnit, WavelengthUnit};

/// Arguments of `convert`.
#[derive(Debug, Args)]
#[command(after_long_help = "\
Examples:
  photopic convert data/spectra/office-led.csv
  photopic convert LED-B3 D65 blackbody:2856K daylight:5000K line:555nm
  photopic convert lamp.csv --quantity irradiance --unit mW/m2/nm
  photopic convert lamp.csv --distance 2m --cone 30deg        (lx into cd and lm)
  photopic convert LED-B3 --scale-to '800 lm'                 (lm back into W)
  photopic convert line:500nm --scale-to '100 W'              (photons per second)
  photopic convert *.csv --json > results.json
  photopic convert lamp.csv --plot lamp.svg
  photopic convert lamp.csv --uncertainty budget.toml         (every figure with its uncertainty)
  photopic convert lamp.csv --uncertainty budget.toml --report lamp.html
  photopic convert paper.csv --illuminant D65                 (a reflectance: whiteness, tint, yellowness)
  photopic convert lamp.csv --risk-group --cone 40mrad        (IEC 62471, of a source seen within ±40 mrad)
  cat lamp.csv | photopic convert - --csv")]
pub(in crate::cli) struct ConvertArgs {
    /// Spectrum files, `-` for standard input, or sources by name: A, D65, FL11, LED-B3, blackbody:2856K, daylight:6504K,
    /// line:555nm.
    #[arg(required_unless_present = "budget_schema", value_name = "FILE")]
    pub files: Vec<String>,

    #[command(flatten)]
    pub(super) reading: Reading,
    #[command(flatten)]
    pub(super) integration: Integration,
    #[command(flatten)]
    pub(super) colour: Colour,
    #[command(flatten)]
    pub(super) geometry: GeometryArgs,
    #[command(flatten)]
    pub(super) safety: Safety,
    #[command(flatten)]
    pub(super) uncertainty: UncertaintyArgs,
    #[command(flatten)]
    pub(super) output: Output,
}

/// Photobiological safety.
#[derive(Debug, Args)]
#[command(next_help_heading = "Photobiological safety")]
pub(super) struct Safety {
    /// Risk group by IEC 62471: of an irradiance at the distance that the standard asks for (500 lx for general lighting, else
    /// 200 mm), of a radiance, or of both with --cone or --solid-angle of the source as seen, or --source with --distance.
    #[arg(long)]
    pub risk_group: bool,
}

/// Uncertainty.
#[derive(Debug, Args)]
#[command(next_help_heading = "Uncertainty")]
pub(super) struct UncertaintyArgs {
    /// A budget (TOML, docs/uncertainty.md): every figure with its standard uncertainty and its interval of 95 %.
    #[arg(long = "uncertainty", value_name = "BUDGET")]
    pub budget: Option<PathBuf>,
    /// Draw the budget (one input): a .svg or .png file.
    #[arg(long, value_name = "FILE", requires = "budget")]
    pub budget_plot: Option<PathBuf>,
    /// Print the JSON schema of budgets.
    #[arg(long, conflicts_with_all = ["files", "budget"])]
    pub budget_schema: bool,
}

/// How the input is read.
#[derive(Debug, Args)]
#[command(next_help_heading = "Reading")]
pub(super) struct Reading {
    /// What the spectrum is of: flux, intensity, irradiance, radiance, exitance, energy, exposure or relative.
    #[arg(long, value_name = "QUANTITY")]
    pub quantity: Option<Quantity>,
    /// Unit of the samples, such as W/m2/nm, mW/(m2 sr nm), uW/cm2/nm, W/nm, umol/m2/s/nm; without a wavelength it is per band.
    #[arg(long)]
    pub unit: Option<SpectralUnit>,
    /// Unit of the wavelengths where the file does not state one: nm (the default), um, m, angstrom.
    #[arg(long, value_name = "UNIT")]
    pub wavelength_unit: Option<WavelengthUnit>,
    /// Format, where recognising it by content is not wanted: csv, tm27, cgats, jcamp, oceanview, uprtek, sekonic.
    #[arg(long)]
    pub format: Option<Format>,
    /// Separator of delimited text: a character, `tab` or `blank`.
    #[arg(long, value_parser = separator)]
    pub separator: Option<char>,
    /// Decimal mark of delimited text: `.` or `,`.
    #[arg(long, value_name = "MARK", value_parser = decimal)]
    pub decimal: Option<char>,
    /// One spectrum per column or per row of delimited text: columns, rows.
    #[arg(long)]
    pub layout: Option<Layout>,
    /// Convert only the spectra of this name (repeatable; case is ignored).
    #[arg(long, value_name = "NAME")]
    pub select: Vec<String>,
}

/// How it is integrated.
#[derive(Debug, Args)]
#[command(next_help_heading = "Integration")]
pub(super) struct Integration {
    /// Rule; by default CIE 15 summation on equal steps up to 5 nm, else the exact integral of straight lines.
    #[arg(long, value_enum)]
    pub rule: Option<RuleArg>,
    /// Wavelengths that count, such as 380-780 (nm); by default all there are.
    #[arg(long, value_name = "LOW-HIGH", value_parser = measures::range_nm)]
    pub range: Option<(f64, f64)>,
    /// Resample to this step (nm) first; by default nothing is resampled.
    #[arg(long, value_name = "NM", value_parser = positive)]
    pub resample: Option<f64>,
    /// Interpolation of --resample.
    #[arg(long, value_enum, default_value = "linear", requires = "resample")]
    pub interpolation: InterpolationArg,
    /// Range of --resample (nm); by default the spectrum's own.
    #[arg(long, value_name = "LOW-HIGH", value_parser = measures::range_nm, requires = "resample")]
    pub resample_range: Option<(f64, f64)>,
    /// What --resample puts beyond the ends of the samples.
    #[arg(long, value_enum, default_value = "refuse", requires = "resample")]
    pub extrapolation: ExtrapolationArg,
    /// Leave out the samples that straight lines between the others miss by no more than this share of the largest value, per cent or a
    /// fraction: an adaptive step.
    #[arg(long, value_name = "ERROR", value_parser = measures::share, conflicts_with = "resample")]
    pub thin: Option<f64>,
    /// A file with rule, range, step and interpolation, as `trade spectrum --settings` writes it; options given here go before it.
    #[arg(long, value_name = "FILE")]
    pub settings: Option<PathBuf>,
    /// K_m in lm/W.
    #[arg(long, value_name = "LM_PER_W", default_value_t = K_M, value_parser = positive)]
    pub k_m: f64,
    /// K'_m in lm/W.
    #[arg(long, value_name = "LM_PER_W", default_value_t = K_M_SCOTOPIC, value_parser = positive)]
    pub k_m_scotopic: f64,
    /// Luminous efficiency function: cie-1924-v, judd-1951-v, judd-vos-1978-v, cie-1964-v10, cie-2008-v-2deg, cie-2008-v-10deg.
    #[arg(long, value_name = "NAME", default_value_t)]
    pub efficiency: Efficiency,
    /// Photopic luminance (cd/m2) of the adapting field: adds mesopic figures (CIE 191).
    #[arg(long, value_name = "CD_PER_M2", value_parser = positive)]
    pub mesopic_adaptation: Option<f64>,
}

/// Colour.
#[derive(Debug, Args)]
#[command(next_help_heading = "Colour")]
pub(super) struct Colour {
    /// Observer of XYZ and chromaticity: cie-1931-2deg, cie-1964-10deg, cie-2015-2deg, cie-2015-10deg.
    #[arg(long, value_name = "NAME", default_value_t)]
    pub observer: Observer,
    /// Second radiation constant c2: its90 (1.4388e-2 m K, as CIE 15 prescribes for CCT), si (exact), nbs1931 (1.435e-2).
    #[arg(long, value_enum, default_value = "its90")]
    pub c2: C2Arg,
    /// How CCT and Duv are found: by minimising the distance to the locus, or by Ohno's table.
    #[arg(long, value_enum, default_value = "exact")]
    pub cct_method: CctArg,
    /// Take the input as a reflectance (1 is the perfect diffuser) under this light, a source by name (D65, C, A, FL11, blackbody:2856K)
    /// or a spectrum file: all figures are of the light reflected; under D65 and C with whiteness, tint and yellowness.
    #[arg(long, value_name = "SOURCE", conflicts_with_all = ["scale_to", "white"])]
    pub illuminant: Option<String>,
    /// White point x,y of dominant wavelength and purity; by default equal energy, of a reflectance its illuminant.
    #[arg(long, value_name = "X,Y", value_parser = measures::xy)]
    pub white: Option<[f64; 2]>,
    /// White x,y to which the eye is adapted, for RGB; by default each space's own.
    #[arg(long, value_name = "X,Y", value_parser = measures::xy)]
    pub rgb_white: Option<[f64; 2]>,
    /// Chromatic adaptation from --rgb-white: bradford, cat16, none.
    #[arg(long, default_value = "bradford", requires = "rgb_white")]
    pub adaptation: Transform,
}

/// Geometry that connects quantities.
#[derive(Debug, Args)]
#[command(next_help_heading = "Geometry (each option opens relations, none is assumed)")]
pub(super) struct GeometryArgs {
    /// Distance from source to receiver, such as 2m: E = I/r².
    #[arg(long, value_parser = measures::length)]
    pub distance: Option<f64>,
    /// Angle of incidence at the receiver, such as 30deg.
    #[arg(long, value_name = "ANGLE", value_parser = measures::angle)]
    pub incidence: Option<f64>,
    /// Emitting area, such as 1cm2; for an irradiance without --distance, the receiving area.
    #[arg(long, value_parser = measures::area)]
    pub area: Option<f64>,
    /// Solid angle that the light fills evenly, such as 0.1sr: of the beam; for irradiance and radiance without --distance, of
    /// the source as the receiver sees it.
    #[arg(long, value_name = "OMEGA", value_parser = measures::solid_angle)]
    pub solid_angle: Option<f64>,
    /// The same as a cone, by its half-angle, such as 15deg.
    #[arg(long, value_name = "HALF_ANGLE", value_parser = measures::angle)]
    pub cone: Option<f64>,
    /// The source emits by Lambert's cosine law.
    #[arg(long)]
    pub lambertian: bool,
    /// The source emits alike in all directions.
    #[arg(long)]
    pub isotropic: bool,
    /// Extended source facing the receiver: sphere:R, disk:R, rect:WxH, triangle:BxH; goes with --distance.
    #[arg(long, value_name = "SHAPE", value_parser = measures::shape)]
    pub source: Option<Shape>,
    /// Duration, such as 10s: Q = Φt, H = Et.
    #[arg(long, value_parser = measures::time)]
    pub time: Option<f64>,
    /// Ask for a quantity by name; an error says which geometry is missing (repeatable).
    #[arg(long, value_name = "QUANTITY")]
    pub to: Vec<Quantity>,
    /// Scale the spectrum to a level: '800 lm', '500 lx', '300 cd/m2', '100 W', '1 W/m2'.
    #[arg(long, value_name = "LEVEL")]
    pub scale_to: Option<Level>,
}

/// Output.
#[derive(Debug, Args)]
#[command(next_help_heading = "Output")]
pub(super) struct Output {
    /// One JSON document.
    #[arg(long, conflicts_with = "csv")]
    pub json: bool,
    /// One table with a header row.
    #[arg(long)]
    pub csv: bool,
    /// Groups of figures, separated by commas; luminous figures, XYZ and chromaticity always are there.
    #[arg(long, value_enum, value_delimiter = ',', value_name = "GROUPS", default_value = "all")]
    pub figures: Vec<Group>,
    /// Write to a file instead of standard output.
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
    /// Draw the spectrum (one input): a .svg or .png file.
    #[arg(long, value_name = "FILE")]
    pub plot: Option<PathBuf>,
    /// What to draw.
    #[arg(long, value_enum, default_value = "all", requires = "plot")]
    pub plot_kind: PlotKind,
    /// Draw the quadrangles of ANSI C78.377 and ellipses of three MacAdam steps into the chromaticity diagram.
    #[arg(long, requires = "plot")]
    pub plot_tolerances: bool,
    /// Write a report on one spectrum: a self-contained HTML page with figures, pictures, budget, method and findings.
    #[arg(long, value_name = "FILE")]
    pub report: Option<PathBuf>,
}

/// What `--plot` draws.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum PlotKind {
    /// Spectrum, u′v′ diagram and colour vector graphic on one sheet.
    All,
    /// The spectrum with V(λ).
    Spectrum,
    /// The CIE 1976 u′v′ diagram.
    Chromaticity,
    /// The CIE 1931 xy diagram.
    ChromaticityXy,
    /// The TM-30 colour vector graphic.
    Tm30,
    /// The melanopic illuminance beside what is recommended for the eye.
    Melanopic,
}

/// A group of figures.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum Group {
    /// Everything.
    All,
    /// Nothing but luminous figures, XYZ and chromaticity.
    Luminous,
    /// CCT, Duv, dominant wavelength, purity.
    Colour,
    /// Ra and R1–R14.
    Cri,
    /// Rf, Rg, hue bins.
    Tm30,
    /// CIE S 026.
    AlphaOpic,
    /// Photon numbers.
    Photon,
    /// Blue-light, retinal thermal and UV hazard weighting.
    Hazard,
    /// RGB spaces.
    Rgb,
    /// Peak, centroid, width.
    Shape,
}

#[derive(Debug, Clone, Copy, ValueEnum, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(in crate::cli) enum RuleArg {
    /// Δλ Σ S w (CIE 15).
    Summation,
    /// Trapezoids of the product.
    Trapezoid,
    /// The exact integral of straight lines.
    Exact,
    /// Σ S w over lines.
    Lines,
}

impl From<RuleArg> for Rule {
    fn from(rule: RuleArg) -> Self {
        match rule {
            RuleArg::Summation => Self::Summation,
            RuleArg::Trapezoid => Self::Trapezoid,
            RuleArg::Exact => Self::Exact,
            RuleArg::Lines => Self::Lines,
        }
    }
}

#[derive(Debug, Clone, Copy, ValueEnum, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum InterpolationArg {
    /// Straight lines.
    Linear,
    /// Sprague (CIE 167).
    Sprague,
    /// Natural cubic spline.
    Cubic,
    /// Monotone cubic.
    Pchip,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
pub(super) enum ExtrapolationArg {
    /// An error.
    Refuse,
    /// Zero.
    Zero,
    /// The nearest sample.
    Constant,
    /// The line through the two nearest.
    Linear,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
pub(super) enum C2Arg {
    /// 1.4388e-2 m·K.
    Its90,
    /// Exact.
    Si,
    /// 1.435e-2 m·K.
    Nbs1931,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
pub(super) enum CctArg {
    /// Direct minimisation.
    Exact,
    /// Ohno's table.
    Ohno2013,
}

fn separator(text: &str) -> Result<char, String> {
    match text {
        "tab" | "\\t" | "\t" => Ok('\t'),
        "blank" | "space" | " " => Ok(' '),
        _ => {
            let mut chars = text.chars();
            chars.next().filter(|c| chars.next().is_none() && !c.is_alphanumeric()).ok_or_else(|| {
                format!("`{text}` is no separator; expected one character such as `;`, or tab, or blank")
            })
        }
    }
}

fn decimal(text: &str) -> Result<char, String> {
    match text {
        "." | "," => Ok(if text == "." { '.' } else { ',' }),
        _ => Err(format!("`{text}` is no decimal mark; expected `.` or `,`")),
    }
}

pub(in crate::cli) fn positive(text: &str) -> Result<f64, String> {
    let number = text.trim().parse::<f64>().ok().filter(|v| *v > 0.0 && v.is_finite());
    number.ok_or_else(|| format!("`{text}`; expected a positive number"))
}

impl ConvertArgs {
    /// What the user says about the inputs.
    pub(super) fn read_options(&self) -> ReadOptions {
        let r = &self.reading;
        ReadOptions {
            format: r.format,
            wavelength_unit: r.wavelength_unit,
            separator: r.separator,
            decimal: r.decimal,
            layout: r.layout,
        }
    }

    /// The settings of the conversion; an illuminant that is none is a failure.
    pub(super) fn settings(&self) -> Result<Settings, Failure> {
        let (i, c, g) = (&self.integration, &self.colour, &self.geometry);
        let c2 = match c.c2 {
            C2Arg::Its90 => SecondRadiation::Its90,
            C2Arg::Si => SecondRadiation::Si,
            C2Arg::Nbs1931 => SecondRadiation::Nbs1931,
        };
        let light = |name: &String| -> Result<_, Failure> {
            let refused = |why: &str| Failure::Message(format!("--illuminant {name}: {why}"));
            if !Path::new(name).exists() {
                let source = named::source(name, c2).map_err(|e| refused(&e.to_string()))?;
                return Ok((source.name, source.spectrum));
            }
            let light = input::single(name, None, None, c2).map_err(|why| Failure::Message(why.message))?;
            // A file is not the light that it may be called after.
            let called = if named::is_name(name) { format!("./{name}") } else { name.clone() };
            Ok((called, light.measured.spectrum))
        };
        Ok(Settings {
            contract: Contract { rule: i.rule.map(Into::into), range_nm: i.range },
            resampling: i.resample.map(|step_nm| Resampling {
                step_nm,
                range_nm: i.resample_range,
                interpolation: match i.interpolation {
                    InterpolationArg::Linear => Interpolation::Linear,
                    InterpolationArg::Sprague => Interpolation::Sprague,
                    InterpolationArg::Cubic => Interpolation::Cubic,
                    InterpolationArg::Pchip => Interpolation::Pchip,
                },
                extrapolation: match i.extrapolation {
                    ExtrapolationArg::Refuse => Extrapolation::Refuse,
                    ExtrapolationArg::Zero => Extrapolation::Zero,
                    ExtrapolationArg::Constant => Extrapolation::Constant,
                    ExtrapolationArg::Linear => Extrapolation::Linear,
                },
            }),
            thinning: i.thin,
            efficiency: i.efficiency,
            efficacy: Efficacy { k_m: i.k_m, k_m_scotopic: i.k_m_scotopic },
            observer: c.observer,
            c2,
            cct_method: match c.cct_method {
                CctArg::Exact => cct::Method::Exact,
                CctArg::Ohno2013 => cct::Method::Ohno2013,
            },
            dominant_white_xy: c.white.unwrap_or([1.0 / 3.0, 1.0 / 3.0]),
            rgb_white: c.rgb_white.and_then(chromaticity::xyz_of_xy),
            adaptation: c.adaptation,
            mesopic_adaptation: i.mesopic_adaptation,
            illuminant: c.illuminant.as_ref().map(light).transpose()?,
            geometry: Geometry {
                distance_m: g.distance,
                incidence_rad: g.incidence,
                area_m2: g.area,
                solid_angle_sr: g.solid_angle,
                cone_half_angle_rad: g.cone,
                lambertian: g.lambertian,
                isotropic: g.isotropic,
                shape: g.source,
                time_s: g.time,
            },
            risk_group: self.safety.risk_group,
            groups: self.groups(),
            level: g.scale_to.clone(),
        })
    }

    fn groups(&self) -> Groups {
        let has = |g| self.output.figures.contains(&g) || self.output.figures.contains(&Group::All);
        Groups {
            colour: has(Group::Colour),
            cri: has(Group::Cri),
            tm30: has(Group::Tm30),
            alpha_opic: has(Group::AlphaOpic),
            photon: has(Group::Photon),
            hazard: has(Group::Hazard),
            rgb: has(Group::Rgb),
            shape: has(Group::Shape),
        }
    }
}
