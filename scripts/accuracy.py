#!/usr/bin/env python3
"""Writes docs/accuracy.md and the pictures of docs/accuracy from runs of `photopic trade` on what ships with the tool, or is made from that;
needs Python 3.11 and nothing else, and a few minutes. Times are those of the machine it runs on, errors are not.

    scripts/accuracy.py PHOTOPIC
"""

import json
import platform
import shlex
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

import glossy_sphere

ROOT = Path(__file__).resolve().parent.parent
PICTURES = ROOT / "docs" / "accuracy"
# What a knob says where it is as it always is: left out of a setting's words.
USUAL = {
    "precision": ("f64", "f32"),
    "interpolation": ("none", "bilinear"),
    "filter": ("none",),
    "solver": ("path",),
    "max_edges": ("any",),
    "roulette_from": ("4",),
    "sampler": ("sobol",),
    "wavelengths": ("to 0.001",),
    "wavelengths_per_path": ("all",),
    "model": ("minimal",),
    "denoise": ("no",),
    "adaptive": ("yes",),
    "branches": ("chosen",),
    "virtual_lights": ("chosen",),
    "guiding": ("chosen",),
}


# Figures whose errors are not relative, and their units.
ABSOLUTE = {"cct_k": "K", "cri_ra": "", "ln_rms": "", "albedo": "", "chromaticity_xy": "", "delta_e_2000": "", "coverage_lost": ""}


@dataclass
class Trade:
    """One input: the errors asked for by figure (relative ones as fractions, the others in the figure's unit), and what is typed."""

    title: str
    verb: str
    words: str
    asked: dict[str, tuple[float, ...]]
    picture: str
    # Of a scene the figures are its sensors.
    option: str = "--figure"
    # Where it is typed: where the input is.
    folder: Path = ROOT
    repeats: int = 11


SPECTRUM = {"photopic": (0.01, 0.001, 0.0001), "melanopic": (0.001,), "cct_k": (10.0, 1.0), "cri_ra": (0.5, 0.1)}
LAMP = {"flux": (0.01, 0.001), "mean_illuminance": (0.01, 0.001), "illuminance": (0.1, 0.05, 0.01)}
OPENING = {"illuminance_1x": (0.05,), "illuminance_2x": (0.05,), "illuminance_5x": (0.01,), "illuminance_10x": (0.01,)}
BRDF = {"ln_rms": (0.2, 0.05), "albedo": (0.01,)}
IMAGE = {"luminance": (0.05, 0.005, 0.001), "chromaticity_xy": (0.005,), "delta_e_2000": (1.0,)}
CAPTURE = {"f_r_median": (0.05, 0.02), "coverage_lost": (0.5,), "ggx.alpha": (0.02,), "lambert.reflectance": (0.01,)}


def chapters(folder: Path) -> dict[str, tuple[str, list[Trade]]]:
    """What is traded: an introduction and its inputs, by heading."""
    spectra = {
        "data/spectra/office-led.csv": "white LED, 1 nm",
        "data/spectra/warm-led-radiance.csv": "warm white LED",
        "data/spectra/daylight-window.csv": "daylight through a window",
        "data/spectra/halogen-flux.csv": "halogen lamp",
        "FL4": "fluorescent lamp, 5 nm with lines (CIE 15)",
        "LED-B3": "white LED (CIE 15)",
    }
    materials = {
        "lambert(reflectance=0.5)": "a diffuse white",
        "lambert(reflectance=0.2) + ggx(alpha=0.2, eta=1.5)": "a glossy paint",
        "ggx(alpha=0.1, medium=Au)": "brushed gold",
    }
    return {
        "Integration of spectra": (
            "A coarse step is a choice among the samples of a fine spectrum. What an instrument of a coarse bandwidth would have measured is another question.",
            [Trade(what, "spectrum", source, SPECTRUM, f"spectrum-{n + 1}") for n, (source, what) in enumerate(spectra.items())],
        ),
        "Tables of lamps": (
            "The point for the area is the five-times rule: `illuminance_5x` is what faces the lamp five times its largest dimension away.",
            [
                Trade("a panel of 0.6 m", "lamp", "data/lamps/panel.ldt --height 2", LAMP | OPENING, "lamp-1", repeats=3),
                Trade("a street light", "lamp", "data/lamps/street.ies --height 8", LAMP, "lamp-2", repeats=3),
                Trade("a spot", "lamp", "data/lamps/spot.ies --height 3", LAMP, "lamp-3", repeats=3),
            ],
        ),
        "Materials": (
            "`ln_rms` is the error of logarithms: 0.05 is about 5 % of the values. Bins are read at the nearest.",
            [Trade(what, "brdf", f"'{words}'", BRDF, f"brdf-{n + 1}", repeats=3) for n, (words, what) in enumerate(materials.items())],
        ),
        "Spectral images": (
            "A picture of `data/scenes/cornell.toml` by 5 nm: `wavelength_step_nm = 5` in a file of settings, `photopic render data/scenes/cornell.toml --samples 16 --settings fine.toml`.",
            [Trade("a room", "image", "cornell.exr", IMAGE, "image-1", folder=cube(folder), repeats=3)],
        ),
        "Readings of scenes": (
            "",
            [
                Trade(
                    "an office",
                    "render",
                    "data/scenes/office.toml --meter-samples 16384",
                    {"desk": (0.02, 0.005, 0.001), "wall spot": (0.05, 0.01)},
                    "render-1",
                    option="--sensor",
                    repeats=8,
                ),
                Trade(
                    "a picture of it",
                    "render",
                    "data/scenes/office.toml --samples 16",
                    {"view": (0.2, 0.07, 0.03)},
                    "render-2",
                    option="--sensor",
                    repeats=5,
                ),
            ],
        ),
        "Photographs of a glossy sphere": (
            "0.2 + GGX of α = 0.25 under ten lights in three exposures, made by `scripts/glossy_sphere.py`. Errors are relative to all photographs with all of their pixels.",
            [Trade("a sphere", "capture", "capture.toml -m 'lambert + ggx'", CAPTURE, "capture-1", folder=sphere(folder), repeats=1)],
        ),
    }


def cube(folder: Path) -> Path:
    """The room by 5 nm; the folder with `cornell.exr`."""
    settings = folder / "fine.toml"
    settings.write_text("[render]\nwavelength_step_nm = 5\n", encoding="utf-8")
    scene = ROOT / "data" / "scenes" / "cornell.toml"
    command = [PROGRAM, "render", scene, "--samples", "16", "--settings", settings, "--folder", folder, "--packets", "0", "--quiet"]
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    next(folder.glob("*.exr")).rename(folder / "cornell.exr")
    return folder


def sphere(folder: Path) -> Path:
    """The folder with `capture.toml`."""
    glossy_sphere.make(folder)
    return folder


def run(trade: Trade, *more: str) -> dict:
    """The result; exit code 1 says that no setting meets the error, which is an answer."""
    command = [PROGRAM, "trade", trade.verb, *shlex.split(trade.words), "--repeats", str(trade.repeats), *more, "--json", "--quiet"]
    done = subprocess.run(command, cwd=trade.folder, stdout=subprocess.PIPE, check=False)
    if done.returncode not in (0, 1):
        raise SystemExit(f"{' '.join(command)}: exit code {done.returncode}")
    return json.loads(done.stdout)["results"][0]


def digits(value: float) -> str:
    return f"{value:.2g}"


def time(seconds: float) -> str:
    return f"{1e6 * seconds:.0f} µs" if seconds < 1e-3 else f"{1e3 * seconds:.0f} ms" if seconds < 1 else f"{seconds:.1f} s"


def error(figure: str, value: float) -> str:
    return f"{digits(value)} {ABSOLUTE[figure]}".strip() if figure in ABSOLUTE else f"{digits(100 * value)} %"


def bound(result: dict, trial: dict, figure: str) -> float | None:
    """What `error_bound` is of the figure that was asked for."""
    found, own = trial["errors"][figure], result["reference_errors"][figure]
    return None if found is None or own is None else found["high"] + own


def recommendation(result: dict, figure: str, asked: float) -> list[str]:
    """The fastest setting that guarantees the error, as `--error` finds it."""
    bounds = [(t, bound(result, t, figure)) for t in result["trials"] if t["offered"]]
    meeting = [(t, b) for t, b in bounds if b is not None and b <= asked]
    if not meeting:
        return [error(figure, asked), "—", "—", "none of those tried"]
    best, guaranteed = min(meeting, key=lambda pair: pair[0]["time_s"]["median_s"])
    words = [f"{k} {v}" if v.isdigit() or v in ("yes", "no") else v for k, v in best["settings"].items() if v not in USUAL.get(k, ())]
    return [error(figure, asked), error(figure, guaranteed), time(best["time_s"]["median_s"]), ", ".join(words)]


def table(header: list[str], rows: list[list[str]]) -> list[str]:
    return ["| " + " | ".join(r) + " |" for r in [header, ["---"] * len(header), *rows]] + [""]


def effects(result: dict, figure: str) -> list[list[str]]:
    rows = []
    for knob, e in result["effects"].items():
        matters = "" if e["matters"] else "within the noise"
        rows.append([f"`{knob}`", error(figure, e["error"]), f"{e['time_ratio']:.2g}", matters])
    return rows


def section(trade: Trade) -> list[str]:
    """Recommendations by figure, what each knob does to the first of them, a picture."""
    first = next(iter(trade.asked))
    result = run(trade, trade.option, first, "--plot", str(PICTURES / f"{trade.picture}.svg"))
    rows = [[figure, *recommendation(result, figure, asked)] for figure, errors in trade.asked.items() for asked in errors]
    out = [f"### {trade.title}", "", f"`photopic trade {trade.verb} {trade.words} {trade.option} {trade.option[2:].upper()} --error ERROR`", ""]
    out += table([trade.option[2:], "asked", "guaranteed", "time", "fastest setting"], rows)
    out += table(["knob alone", f"changes `{first}` by at most", "and time by", ""], effects(result, first))
    return out + [f"![error over time](accuracy/{trade.picture}.svg)", ""]


def main() -> None:
    PICTURES.mkdir(exist_ok=True)
    for old in PICTURES.glob("*.svg"):
        old.unlink()
    out = [
        "# What speed costs in accuracy",
        "",
        "Written by `scripts/accuracy.py` from runs of `photopic trade` on what ships with the tool; the command above each table repeats it. Errors are",
        "guaranteed: those found, plus the reference's own. Times are medians on one machine",
        f"({platform.machine()}, {platform.system()}, two cores, not idle) and only compare with one another. Of a setting the knobs are named that are not as",
        "they are without it.",
        "",
    ]
    with tempfile.TemporaryDirectory() as folder:
        for heading, (introduction, trades) in chapters(Path(folder)).items():
            out += [f"## {heading}", ""] + ([introduction, ""] if introduction else [])
            for trade in trades:
                out += section(trade)
    (ROOT / "docs" / "accuracy.md").write_text("\n".join(out) + "\n", encoding="utf-8")


if __name__ == "__main__":
    PROGRAM = str(Path(sys.argv[1]).resolve())
    main()
