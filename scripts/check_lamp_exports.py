#!/usr/bin/env python3
"""Puts lamps exported by photopic into Radiance and Mitsuba and prints how far the light that arrives is from I cosθ/r².

    $(scripts/venv.sh) scripts/check_lamp_exports.py [target/release/photopic]

An asymmetric lamp with a closed form is written as LM-63 with several luminous openings, exported, and lit by `rtrace` (from the
pyradiance wheel) and by Mitsuba's emitters; the illuminance at points all around is compared with the interpolated table of the
LM-63 file. A lamp turned or mirrored would be off by tens of per cent. Exit status 1 when a tolerance is missed, 2 when the
comparison could not be made.
"""

from __future__ import annotations

import argparse
import math
import os
import random
import subprocess
import sys
import tempfile
from pathlib import Path

import mitsuba
import pyradiance

ROOT = Path(__file__).resolve().parent.parent
RADIANCE = Path(pyradiance.__file__).resolve().parent
LUMENS_PER_WATT = 179.0
POINTS = 60
# Openings by LM-63's signs (width, length, height in metres), and the largest γ of the table.
LAMPS = {
    "point": ("0 0 0", 180),
    "flat": ("0.2 0.6 0", 180),
    "downlight": ("0.2 0.6 0", 90),
    "box": ("0.2 0.6 0.1", 180),
    "disc": ("-0.3 -0.3 0", 180),
    "ellipse": ("-0.3 -0.5 0", 90),
    "cylinder": ("-0.3 -0.3 0.2", 180),
    "ball": ("-0.3 -0.3 -0.3", 180),
    "tube": ("-0.03 1.2 -0.03", 180),
}
NEAREST_M, FARTHEST_M = 300.0, 600.0
# A side of the opening that faces the point is nearer than its middle, by half of 1.2 m at most: 2 · 0.6 m / 300 m.
RADIANCE_TOLERANCE = 4e-3
# Bilinear faces of 512 pixels: kinks of the table (every 5°) between pixels of 0.2°.
MITSUBA_TOLERANCE = 1e-3
C_STEP, GAMMA_STEP = 15, 5


def formula(c_deg: float, gamma_deg: float) -> float:
    """Intensity in cd of a lamp that is alike in no two directions of its symmetry."""
    c, g = math.radians(c_deg), math.radians(gamma_deg)
    side = 200 * math.cos(c) + 120 * math.sin(c) + 80 * math.sin(2 * c) * math.sin(g)
    return 500 + 300 * math.cos(g) + math.sin(g) * side


def lm63(opening: str, last: int) -> str:
    """The lamp as LM-63-2019."""
    gammas, planes = range(0, last + 1, GAMMA_STEP), range(0, 361, C_STEP)
    head = "IES:LM-63-2019\n[TEST] a\n[TESTLAB] b\n[ISSUEDATE] 2026\n[MANUFAC] c\nTILT=NONE\n"
    numbers = f"1 -1 1 {len(gammas)} {len(planes)} 1 2 {opening}\n1 1.00001 10\n"
    rows = [" ".join(map(str, gammas)), " ".join(map(str, planes))]
    rows += [" ".join(f"{formula(c, g):.5f}" for g in gammas) for c in planes]
    return head + numbers + "\n".join(rows) + "\n"


def intensity(point: tuple[float, float, float]) -> float:
    """Intensity towards a point: the table, linear in both angles."""
    x, y, z = point
    gamma = math.degrees(math.atan2(math.hypot(x, y), -z)) / GAMMA_STEP
    c = math.degrees(math.atan2(y, x)) % 360 / C_STEP
    i, j = min(int(c), 360 // C_STEP - 1), min(int(gamma), 180 // GAMMA_STEP - 1)
    s, t = c - i, gamma - j

    def along(plane: int) -> float:
        return (1 - t) * formula(C_STEP * plane, GAMMA_STEP * j) + t * formula(C_STEP * plane, GAMMA_STEP * (j + 1))

    return (1 - s) * along(i) + s * along(i + 1)


def around(last: int) -> list[tuple[float, float, float]]:
    """Points that see the lamp."""
    draw = random.Random(1)
    out = []
    while len(out) < POINTS:
        z, azimuth, r = draw.uniform(-1, 1), draw.uniform(0, math.tau), draw.uniform(NEAREST_M, FARTHEST_M)
        # Flat openings show nothing of themselves from the side.
        if abs(z) > 0.02 and (last > 90 or z < 0):
            across = r * math.sqrt(1 - z * z)
            out.append((across * math.cos(azimuth), across * math.sin(azimuth), r * z))
    return out


def radiance(folder: Path, name: str, points: list[tuple[float, float, float]]) -> list[float]:
    """Illuminance at the points, facing the lamp, by rtrace."""
    environment = {**os.environ, "RAYPATH": f".:{RADIANCE / 'lib'}"}

    def run(program: str, *arguments: str, text: str = "") -> bytes:
        command = [str(RADIANCE / "bin" / program), *arguments]
        done = subprocess.run(command, cwd=folder, env=environment, input=text.encode(), capture_output=True, check=False)
        if done.returncode:
            raise RuntimeError(done.stderr.decode())
        return done.stdout

    (folder / "lamp.oct").write_bytes(run("oconv", f"{name}.rad"))
    rays = "".join("{} {} {} {} {} {}\n".format(*p, *(-v / math.hypot(*p) for v in p)) for p in points)
    options = ["-h", "-I", "-ab", "0", "-dj", "0", "-ds", "0", "-dt", "0", "lamp.oct"]
    lines = run("rtrace", *options, text=rays).decode().splitlines()
    return [float(line.split()[1]) * LUMENS_PER_WATT for line in lines]


def by_mitsuba(folder: Path, name: str, points: list[tuple[float, float, float]]) -> list[float]:
    """The same from the sum of Mitsuba's emitters."""
    scene = mitsuba.load_file(str(folder / f"{name}.xml"))
    out = []
    for point in points:
        at = mitsuba.Interaction3f()
        at.p = mitsuba.Point3f(*point)
        total = 0.0
        for emitter in scene.emitters():
            _, weight = emitter.sample_direction(at, mitsuba.Point2f(0.5, 0.5))
            total += weight[1]
        out.append(total)
    return out


def worst(points: list[tuple[float, float, float]], illuminances: list[float]) -> float:
    """Largest relative difference from I/r²."""
    pairs = zip(points, illuminances, strict=True)
    return max(abs(e * math.hypot(*p) ** 2 / intensity(p) - 1) for p, e in pairs)


def compare(binary: str, folder: Path) -> bool:
    """Prints a line for each lamp and renderer; whether all are within tolerance."""
    good = True
    mitsuba.set_variant("scalar_rgb")
    for name, (opening, last) in LAMPS.items():
        (folder / f"{name}.ies").write_text(lm63(opening, last))
    for target in ("rad", "mitsuba"):
        files = [f"{name}.ies" for name in LAMPS]
        done = subprocess.run(
            [binary, "lamp", "convert", *files, "--to", target, "-o", f"{target}/"],
            cwd=folder,
            capture_output=True,
            text=True,
            check=False,
        )
        if done.returncode:
            raise RuntimeError(done.stderr)
    for name, (_, last) in LAMPS.items():
        points = around(last)
        for renderer, found, tolerance in (
            ("Radiance", radiance(folder / "rad", name, points), RADIANCE_TOLERANCE),
            ("Mitsuba", by_mitsuba(folder / "mitsuba", name, points), MITSUBA_TOLERANCE),
        ):
            difference = worst(points, found)
            good &= difference <= tolerance
            print(f"{name:10} {renderer:9} {difference:.1e}  {'' if difference <= tolerance else 'MISSED'}")
    return good


def main() -> int:
    """Runs the comparison."""
    parser = argparse.ArgumentParser(description="Puts exported lamps into Radiance and Mitsuba.")
    parser.add_argument("binary", nargs="?", help="the photopic to check; by default target/release/photopic, else the debug build")
    given = parser.parse_args().binary
    candidates = [Path(given)] if given else [ROOT / "target" / build / "photopic" for build in ("release", "debug")]
    binary = next((str(c.resolve()) for c in candidates if c.is_file()), None)
    if binary is None:
        print("no photopic to check; build it first: cargo build --release", file=sys.stderr)
        return 2
    try:
        with tempfile.TemporaryDirectory() as folder:
            return 0 if compare(binary, Path(folder)) else 1
    except (RuntimeError, OSError) as why:
        print(why, file=sys.stderr)
        return 2


if __name__ == "__main__":
    sys.exit(main())
