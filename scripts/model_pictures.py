#!/usr/bin/env python3
"""Draws the pictures of the BRDF models' manuals in docs/brdf from the program's own values; needs Python 3.11 and nothing else.

    scripts/model_pictures.py PHOTOPIC            write them
    scripts/model_pictures.py PHOTOPIC --check    exit 1 where they are not what this script draws

Left the plane of incidence, logarithmic, light at 45 degrees from the left; right the albedo over the angle of incidence. Dirac
lobes have no values, so they get the right half alone. Coordinates are rounded to half a unit, which hides the last digits of
one platform or another.
"""

import json
import subprocess
import sys
from math import ceil, floor, log10
from pathlib import Path
from xml.sax.saxutils import escape

FOLDER = Path(__file__).resolve().parent.parent / "docs" / "brdf"
COLOURS = ("#0072b2", "#d55e00", "#009e73")
WIDTH, HEIGHT, LEFT, TOP, SIDE, PLOT = 720, 300, 52, 20, 290, 200

# Picture: the materials in it, at most three, chosen to show what a parameter does.
PICTURES = {
    "lambert": ["lambert(reflectance=0.2)", "lambert(reflectance=0.5)", "lambert(reflectance=0.8)"],
    "oren-nayar": [f"oren-nayar(reflectance=0.5, sigma_deg={sigma})" for sigma in (0, 20, 40)],
    "phong": [f"phong(kd=0.1, ks=0.6, n={n})" for n in (5, 50, 500)],
    "blinn-phong": [f"blinn-phong(kd=0.1, ks=0.6, n={n})" for n in (5, 50, 500)],
    "ward": [f"ward(kd=0.1, ks=0.6, alpha={alpha})" for alpha in (0.1, 0.2, 0.4)],
    "ashikhmin-shirley": [f"ashikhmin-shirley(rd=0.1, rs=0.05, nu={n})" for n in (5, 50, 500)],
    "ggx": [f"ggx(alpha={alpha}, medium=Au)" for alpha in (0.1, 0.2, 0.4)],
    "beckmann": [f"beckmann(alpha={alpha}, medium=Au)" for alpha in (0.1, 0.2, 0.4)],
    "blinn": [f"blinn(n={n}, medium=Au)" for n in (10, 50, 200)],
    "abc": [f"abc(kd=0.1, a=10, b={b}, c=1, eta=1.5)" for b in (100, 1000, 10000)],
    "sgd": [
        f"sgd(rho_d=0.1, rho_s=0.5, alpha={alpha}, p=0.5, kappa={kappa}, f0=0.05, f1=0, lambda=0, gamma=0, k=1, theta0=0)"
        for alpha, kappa in ((0.02, 30), (0.05, 15), (0.1, 8))
    ],
    "specular": ["mirror(reflectance=0.9)", "conductor(medium=Au)", "dielectric(medium=BK7)"],
}


def ask(program: str, *arguments: str) -> dict:
    done = subprocess.run([program, "brdf", *arguments, "--json"], stdout=subprocess.PIPE, check=True)
    return json.loads(done.stdout)["results"][0]


def values(program: str, material: str) -> list[tuple[float, float]]:
    """Outgoing angle, positive away from the light, and f in 1/sr."""
    result = ask(program, "eval", material, "--theta-i", "45", "--theta-o", "0:89:1", "--phi", "0,180")
    points = {}
    for row in result["rows"]:
        away = 1 if row["phi_deg"] == 180 else -1
        points[away * row["theta_o_deg"]] = row["brdf_per_sr"][0]
    return sorted(points.items())


def albedo(program: str, material: str) -> list[tuple[float, float]]:
    return [(row["theta_i_deg"], row["albedo"][0]) for row in ask(program, "info", material)["albedo"]]


def number(value: float) -> str:
    return f"{round(2 * value) / 2:g}"


def text(x: float, y: float, words: str, anchor: str = "middle", colour: str = "#333") -> str:
    return f'<text x="{number(x)}" y="{number(y)}" text-anchor="{anchor}" fill="{colour}">{escape(words)}</text>'


def line(points: list[tuple[float, float]], colour: str, width: float) -> str:
    corners = " ".join(f"{number(x)},{number(y)}" for x, y in points)
    return f'<polyline points="{corners}" fill="none" stroke="{colour}" stroke-width="{width:g}"/>'


def frame(left: float, title: str, x_range: tuple[float, float], x_step: int, y_labels: list[tuple[float, str]]) -> list[str]:
    """Axes; `y_labels` are heights from 0 to 1 and what stands there."""
    out = [text(left + SIDE / 2, TOP - 6, title)]
    for angle in range(int(x_range[0]), int(x_range[1]) + 1, x_step):
        x = left + SIDE * (angle - x_range[0]) / (x_range[1] - x_range[0])
        out += [line([(x, TOP), (x, TOP + PLOT)], "#ddd", 1), text(x, TOP + PLOT + 15, f"{angle}°")]
    for height, words in y_labels:
        y = TOP + PLOT * (1 - height)
        out += [line([(left, y), (left + SIDE, y)], "#ddd", 1), text(left - 6, y + 4, words, "end")]
    return out


def picture(program: str, name: str, materials: list[str]) -> str:
    is_delta = name == "specular"
    left = LEFT if is_delta else LEFT + SIDE + 60
    out = frame(left, "albedo over the angle of incidence", (0, 90), 30, [(h / 5, f"{h / 5:g}") for h in range(6)])
    for material, colour in zip(materials, COLOURS):
        points = [(left + SIDE * t / 90, TOP + PLOT * (1 - min(a, 1))) for t, a in albedo(program, material)]
        out.append(line(points, colour, 2))
    if not is_delta:
        curves = [values(program, m) for m in materials]
        seen = [v for curve in curves for _, v in curve if v > 0]
        high = ceil(log10(max(seen)) + 1e-9)
        low = max(floor(log10(min(seen))), high - 5)
        decades = [((d - low) / (high - low), f"{10.0**d:g}") for d in range(low, high + 1)]
        out += frame(LEFT, "BRDF in 1/sr over the outgoing angle, light from 45° left", (-90, 90), 45, decades)
        for curve, colour in zip(curves, COLOURS):
            height = [(t, (log10(max(v, 1e-99)) - low) / (high - low)) for t, v in curve]
            points = [(LEFT + SIDE * (t + 90) / 180, TOP + PLOT * (1 - h)) for t, h in height if h >= 0]
            out.append(line(points, colour, 2))
    out += [text(LEFT, TOP + PLOT + 35 + 15 * i, m, "start", COLOURS[i]) for i, m in enumerate(materials)]
    head = (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" width="{WIDTH}" height="{HEIGHT}" '
        f'font-family="sans-serif" font-size="11" role="img" aria-label="{name}">'
    )
    return "\n".join([head, f'<rect width="{WIDTH}" height="{HEIGHT}" fill="#fff"/>', *out, "</svg>"]) + "\n"


def main() -> int:
    program, check = sys.argv[1], sys.argv[2:] == ["--check"]
    FOLDER.mkdir(exist_ok=True)
    stale = 0
    for name, materials in PICTURES.items():
        path, drawn = FOLDER / f"{name}.svg", picture(program, name, materials)
        if not check:
            path.write_text(drawn, encoding="utf-8")
        elif not path.exists() or path.read_text(encoding="utf-8") != drawn:
            print(f"{path.name}: not what this script draws; run it without --check")
            stale = 1
    return stale


if __name__ == "__main__":
    sys.exit(main())
