#!/usr/bin/env python3
"""Makes the example lamps of data/lamps from formulas; needs Python 3.11 and nothing else.

    scripts/make_lamps.py            write them
    scripts/make_lamps.py --check    exit 1 where they are not what this script writes

They are synthetic, not measurements of any product. Directions are unit vectors with -z down, +x towards C0, +y towards C90.
"""

import argparse
import sys
from collections.abc import Callable
from math import cos, exp, pi, radians, sin
from pathlib import Path

LAMPS = Path(__file__).resolve().parent.parent / "data" / "lamps"

Intensity = Callable[[float, float], float]  # C and gamma in degrees to cd


def steps(first: int, last: int, step: float) -> list[float]:
    return [first + step * i for i in range(round((last - first) / step) + 1)]


def number(value: float) -> str:
    return f"{value:.4f}".rstrip("0").rstrip(".")


def lm63(keywords: dict[str, str], intensity: Intensity, planes: list[float], gammas: list[float], size_m: tuple[float, float, float], watts: float) -> str:
    """An absolute LM-63-2019 file; `size_m` is width (across C0), length (along C0) and height as LM-63 writes them, negative for round."""

    def rows(values: list[float]) -> list[str]:
        texts = [number(v) for v in values]
        return [" ".join(texts[i : i + 12]) for i in range(0, len(texts), 12)]

    lines = ["IES:LM-63-2019"] + [f"[{key}] {text}" for key, text in keywords.items()] + ["TILT=NONE"]
    lines += [f"1 -1 1 {len(gammas)} {len(planes)} 1 2 " + " ".join(number(v) for v in size_m), f"1 1.00001 {number(watts)}"]
    lines += rows(gammas) + rows(planes)
    for c in planes:
        lines += rows([intensity(c, g) for g in gammas])
    return "\r\n".join(lines) + "\r\n"


def eulumdat(maker: str, name: str, number_: str, intensity: Intensity, flux_lm: float, size_mm: tuple[int, int, int], watts: float) -> str:
    """A file of quadrant symmetry (Isym 4), C planes by 15 and gamma by 5 degrees; the luminous area is the whole underside."""
    planes, gammas = steps(0, 345, 15), steps(0, 180, 5)
    length, width, height = size_mm
    head = [maker, 3, 4, len(planes), 15, len(gammas), 5, "made by scripts/make_lamps.py", name, number_, "", "2026-11-25"]
    head += [length, width, height, length, width, 0, 0, 0, 0, 100, 100, 1, 0, 1]
    head += [1, "LED", number(flux_lm), "4000 K", "80", number(watts)] + [0] * 10
    quarter = [c for c in planes if c <= 90]
    values = [intensity(c, g) * 1000 / flux_lm for c in quarter for g in gammas]
    return "\r\n".join(str(v) if isinstance(v, int) else v for v in head + [number(a) for a in planes + gammas + values]) + "\r\n"


def downlight() -> str:
    """I = I0 cos^30 gamma: half of the maximum at 12.3 degrees; flux 2 pi I0 / 31 = 900 lm."""
    peak = 900 * 31 / (2 * pi)
    keywords = {
        "TEST": "synthetic: I = I0 cos^30(gamma), 900 lm",
        "TESTLAB": "scripts/make_lamps.py",
        "ISSUEDATE": "2026-11-25",
        "MANUFAC": "photopic",
        "LUMCAT": "EXAMPLE-SPOT-24",
        "LUMINAIRE": "Recessed spotlight, 24 degrees",
        "LAMP": "LED",
    }
    return lm63(keywords, lambda _, g: peak * max(cos(radians(g)), 0) ** 30, [0], steps(0, 90, 1), (-0.08, -0.08, 0), 9)


def panel() -> str:
    """I = I0 cos gamma (1 + sin^2 gamma cos 2C / 4) below the horizon; flux pi I0 = 3600 lm."""
    peak = 3600 / pi

    def intensity(c: float, g: float) -> float:
        return peak * cos(radians(g)) * (1 + sin(radians(g)) ** 2 * cos(2 * radians(c)) / 4) if g < 90 else 0.0

    return eulumdat("photopic", "Recessed LED panel 600 x 600", "EXAMPLE-PANEL", intensity, 3600, (600, 600, 60), 30)


def street() -> str:
    """Two lobes exp(k (d.u - 1)), k = 12, towards gamma 65, C +-70 degrees, of 3000 cd each, and 900 cd cos^2 gamma; dark above."""

    def direction(c: float, g: float) -> tuple[float, float, float]:
        return sin(radians(g)) * cos(radians(c)), sin(radians(g)) * sin(radians(c)), -cos(radians(g))

    def intensity(c: float, g: float) -> float:
        if g >= 90:
            return 0.0
        d = direction(c, g)
        lobes = sum(exp(12 * (sum(a * b for a, b in zip(d, direction(side, 65), strict=True)) - 1)) for side in (70, -70))
        return 3000 * lobes * (1 - (g / 90) ** 12) + 900 * cos(radians(g)) ** 2

    keywords = {
        "TEST": "synthetic: two lobes at 65 degrees along the road; C0 is the street side",
        "TESTLAB": "scripts/make_lamps.py",
        "ISSUEDATE": "2026-11-25",
        "MANUFAC": "photopic",
        "LUMCAT": "EXAMPLE-STREET",
        "LUMINAIRE": "Street light",
        "LAMP": "LED",
    }
    return lm63(keywords, intensity, steps(0, 180, 5), steps(0, 90, 2.5), (0.3, 0.4, 0), 40)


def main() -> int:
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("--check", action="store_true", help="compare with data/lamps instead of writing it")
    check = options.parse_args().check
    stale = []
    for name, text in {"spot.ies": downlight(), "panel.ldt": panel(), "street.ies": street()}.items():
        path = LAMPS / name
        if not check:
            path.write_bytes(text.encode("ascii"))
        elif not path.is_file() or path.read_bytes() != text.encode("ascii"):
            stale.append(name)
    if stale:
        print(f"data/lamps: {', '.join(stale)} not as scripts/make_lamps.py writes", file=sys.stderr)
    return 1 if stale else 0


if __name__ == "__main__":
    sys.exit(main())
