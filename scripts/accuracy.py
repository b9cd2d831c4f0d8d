#!/usr/bin/env python3
"""Writes docs/accuracy.md and the pictures of docs/accuracy from runs of `photopic trade` on what ships with the tool; needs Python
3.11 and nothing else. Times are those of the machine it runs on, errors are not.

    scripts/accuracy.py PHOTOPIC
"""

import json
import platform
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PICTURES = ROOT / "docs" / "accuracy"

# Input, figure, errors asked for.
SPECTRA = {
    "data/spectra/office-led.csv": "white LED, 1 nm",
    "data/spectra/warm-led-radiance.csv": "warm white LED",
    "data/spectra/daylight-window.csv": "daylight through a window",
    "data/spectra/halogen-flux.csv": "halogen lamp",
    "FL4": "fluorescent lamp, 5 nm with lines (CIE 15)",
    "LED-B3": "white LED (CIE 15)",
}
# Relative errors as fractions, the others in the figure's unit.
ASKED = {"photopic": (0.01, 0.001, 0.0001), "melanopic": (0.001,), "cct_k": (10.0, 1.0), "cri_ra": (0.5, 0.1)}
SCENE = "data/scenes/office.toml"
SENSORS = {"desk": (0.02, 0.005, 0.001), "wall spot": (0.05, 0.01)}


def trade(program: str, *arguments: str) -> dict:
    """The result; exit code 1 says that no setting meets the error, which is an answer."""
    done = subprocess.run([program, "trade", *arguments, "--json", "--quiet"], cwd=ROOT, stdout=subprocess.PIPE, check=False)
    if done.returncode not in (0, 1):
        raise SystemExit(f"trade {' '.join(arguments)}: exit code {done.returncode}")
    return json.loads(done.stdout)["results"][0]


def digits(value: float) -> str:
    return f"{value:.2g}"


def time(seconds: float) -> str:
    return f"{1e6 * seconds:.0f} µs" if seconds < 1e-3 else f"{1e3 * seconds:.0f} ms" if seconds < 1 else f"{seconds:.1f} s"


def error(result: dict, value: float) -> str:
    if result["figure"]["measure"] == "relative":
        return f"{digits(100 * value)} %"
    return f"{digits(value)} {result['figure']['unit']}".strip()


def recommendation(result: dict, asked: float) -> list[str]:
    """The fastest setting that guarantees the error, as `--error` finds it."""
    meeting = [t for t in result["trials"] if t["offered"] and t["error_bound"] is not None and t["error_bound"] <= asked]
    if not meeting:
        return [error(result, asked), "—", "—", "none of those tried"]
    best = min(meeting, key=lambda t: t["time_s"]["median_s"])
    words = ", ".join(v for k, v in best["settings"].items() if v not in ("none", "f64"))
    return [error(result, asked), error(result, best["error_bound"]), time(best["time_s"]["median_s"]), words]


def table(header: list[str], rows: list[list[str]]) -> list[str]:
    return ["| " + " | ".join(r) + " |" for r in [header, ["---"] * len(header), *rows]] + [""]


def effects(result: dict) -> list[list[str]]:
    rows = []
    for knob, e in result["effects"].items():
        matters = "" if e["matters"] else "within the noise"
        rows.append([f"`{knob}`", error(result, e["error"]), f"{e['time_ratio']:.2g}", matters])
    return rows


def main() -> None:
    program = str(Path(sys.argv[1]).resolve())
    PICTURES.mkdir(exist_ok=True)
    out = [
        "# What speed costs in accuracy",
        "",
        "Written by `scripts/accuracy.py` from runs of `photopic trade` on what ships with the tool; the command above each table repeats it. Errors are",
        "guaranteed: those found, plus the reference's own. Times are medians on one machine",
        f"({platform.machine()}, {platform.system()}, two cores, not idle) and only compare with one another.",
        "",
        "## Integration of spectra",
        "",
        "A coarse step is a choice among the samples of a fine spectrum. What an instrument of a coarse bandwidth would have measured is another question.",
        "",
    ]
    for n, (source, what) in enumerate(SPECTRA.items()):
        out += [f"### {what}", "", f"`photopic trade spectrum {source} --figure FIGURE --error ERROR`", ""]
        rows = []
        for figure, errors in ASKED.items():
            result = trade(program, "spectrum", source, "--figure", figure)
            rows += [[figure, *recommendation(result, asked)] for asked in errors]
        out += table(["figure", "asked", "guaranteed", "time", "fastest setting"], rows)
        picture = f"spectrum-{n + 1}.svg"
        result = trade(program, "spectrum", source, "--error", "0.1%", "--plot", str(PICTURES / picture))
        out += table(["knob alone", "changes `photopic` by at most", "and time by", ""], effects(result))
        out += [f"![error over time](accuracy/{picture})", ""]
    out += ["## Readings of scenes", "", f"`photopic trade render {SCENE} --meter-samples 16384 --sensor SENSOR --error ERROR`", ""]
    for n, (sensor, errors) in enumerate(SENSORS.items()):
        arguments = ["render", SCENE, "--meter-samples", "16384", "--repeats", "8", "--sensor", sensor]
        result = trade(program, *arguments, "--plot", str(PICTURES / f"render-{n + 1}.svg"))
        rows = [[sensor, *recommendation(result, asked)] for asked in errors]
        out += table(["sensor", "asked", "guaranteed", "time", "fastest setting"], rows)
        out += table(["knob alone", f"changes `{sensor}` by at most", "and time by", ""], effects(result))
    out += [f"![error over time](accuracy/render-{n + 1}.svg)" for n in range(len(SENSORS))]
    (ROOT / "docs" / "accuracy.md").write_text("\n".join(out) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
