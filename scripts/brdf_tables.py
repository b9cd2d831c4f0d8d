#!/usr/bin/env python3
"""Writes the tables that the BRDF models are tested against, or checks that they are what this script writes.

    scripts/brdf_tables.py            write tests/data/brdf/
    scripts/brdf_tables.py --check    compare, exit 1 with a word on what differs

fresnel.csv, microfacet.csv   the textbook formulas in 50-digit arithmetic (mpmath), printed to 17 digits
mitsuba.csv                   values of Mitsuba 3.9.1's plugins, divided by its foreshortening cosine, single precision
                              (scalar_rgb), printed to 8 digits

The script makes its own environment (scripts/venv.sh) when it is not run inside one.
"""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
FOLDER = HERE.parent / "tests" / "data" / "brdf"

try:
    import mitsuba as mi
    import mpmath
except ImportError:
    if os.environ.get("PHOTOPIC_VENV"):
        raise
    python = subprocess.run([HERE / "venv.sh"], check=True, stdout=subprocess.PIPE, text=True).stdout.strip()
    os.environ["PHOTOPIC_VENV"] = "1"
    os.execv(python, [python, __file__, *sys.argv[1:]])

import argparse
import math
from itertools import product

from mpmath import mp, mpf

mp.dps = 50
if mi.__version__ != "3.9.1":
    sys.exit(f"mitsuba {mi.__version__} is installed; 3.9.1 is needed (run scripts/venv.sh)")


def digits(x: mpf, n: int = 17) -> str:
    return mpmath.nstr(x, n, min_fixed=1, max_fixed=0) if x else "0"


# ------------------------------------------------------------------------------------------------ Fresnel


def fresnel(cos: mpf, n: mpf, k: mpf) -> mpf:
    """Born & Wolf: the amplitudes as they stand, in complex numbers."""
    index = mpmath.mpc(n, -k)
    g = mpmath.sqrt(index**2 - 1 + cos**2)
    if g.imag > 0:  # the branch that decays
        g = -g
    s = (cos - g) / (cos + g)
    p = (index**2 * cos - g) / (index**2 * cos + g)
    return (abs(s) ** 2 + abs(p) ** 2) / 2


def fresnel_table() -> str:
    lines = ["# Unpolarised Fresnel reflectance, textbook amplitudes in 50-digit arithmetic: scripts/brdf_tables.py", "cos,n,k,reflectance"]
    cosines = ["1", "0.99999", "0.9", "0.7071067811865476", "0.5547001962252291", "0.3", "0.01", "1.7453292519934435e-6"]
    for n, k, c in product(["1.000001", "1.1", "1.5", "4", "1000"], ["0", "1e-9", "0.001", "1", "30", "1e6"], cosines):
        lines.append(f"{c},{n},{k},{digits(fresnel(mpf(float(c)), mpf(float(n)), mpf(float(k))))}")
    for n, k, c in product(["0.05", "0.5"], ["0.5", "4", "1e6"], cosines):
        lines.append(f"{c},{n},{k},{digits(fresnel(mpf(float(c)), mpf(float(n)), mpf(float(k))))}")
    return "\n".join(lines) + "\n"


# ------------------------------------------------------------------------------------------------ microfacets


def microfacet(kind: str, alpha: mpf, i: list[mpf], o: list[mpf]) -> mpf:
    """D G/(4 cos cos) with F = 1 and Smith's height-correlated masking, as the papers print it."""
    h = [a + b for a, b in zip(i, o, strict=True)]
    length = mpmath.sqrt(sum(x * x for x in h))
    h = [x / length for x in h]
    tan2 = (h[0] ** 2 + h[1] ** 2) / h[2] ** 2

    def shadow(w: list[mpf]) -> mpf:
        tan = mpmath.sqrt(w[0] ** 2 + w[1] ** 2) / w[2]
        if tan == 0:
            return mpf(0)
        if kind == "ggx":
            return (mpmath.sqrt(1 + alpha**2 * tan**2) - 1) / 2
        a = 1 / (alpha * tan)
        return (mpmath.exp(-(a**2)) / (a * mpmath.sqrt(mpmath.pi)) - mpmath.erfc(a)) / 2

    if kind == "ggx":
        d = 1 / (mpmath.pi * alpha**2 * h[2] ** 4 * (1 + tan2 / alpha**2) ** 2)
    else:
        d = mpmath.exp(-tan2 / alpha**2) / (mpmath.pi * alpha**2 * h[2] ** 4)
    return d / (1 + shadow(i) + shadow(o)) / (4 * i[2] * o[2])


def microfacet_table() -> str:
    lines = [
        "# Torrance-Sparrow with F = 1, Smith's height-correlated masking, in 50-digit arithmetic: scripts/brdf_tables.py",
        "kind,alpha,ix,iy,iz,ox,oy,oz,brdf",
    ]
    places = [(0.0, 0.0, 0.0), (30.0, 30.0, 180.0), (30.0, 31.0, 179.0), (60.0, 10.0, 77.0), (85.0, 85.0, 180.0), (89.9999, 89.9999, 180.0), (89.9999, 20.0, 90.0), (89.9999, 89.99, 0.0)]
    for kind, alpha, (ti, to, phi) in product(["ggx", "beckmann"], ["1e-6", "0.001", "0.1", "0.5", "1"], places):
        # Directions are rounded to doubles first: what the program is given is what is evaluated.
        t, u, p = math.radians(ti), math.radians(to), math.radians(phi)
        i = [math.sin(t), 0.0, math.cos(t)]
        o = [math.sin(u) * math.cos(p), math.sin(u) * math.sin(p), math.cos(u)]
        value = microfacet(kind, mpf(float(alpha)), [mpf(x) for x in i], [mpf(x) for x in o])
        lines.append(",".join([kind, alpha, *map(repr, i), *map(repr, o), digits(value)]))
    return "\n".join(lines) + "\n"


# ------------------------------------------------------------------------------------------------ Mitsuba

# Our description, Mitsuba's plugin.
MATERIALS: list[tuple[str, dict]] = [
    ("lambert(reflectance=0.35)", {"type": "diffuse", "reflectance": 0.35}),
]
for distribution, a in product(["ggx", "beckmann"], [0.05, 0.2, 0.6]):
    MATERIALS += [
        (f"{distribution}(alpha={a}, eta=0.2, k=3.9, masking=smith-separable)", {"type": "roughconductor", "distribution": distribution, "alpha": a, "eta": 0.2, "k": 3.9}),
        (f"{distribution}(alpha={a}, eta=1.5, masking=smith-separable)", {"type": "roughdielectric", "distribution": distribution, "alpha": a, "int_ior": 1.5, "ext_ior": 1.0}),
    ]
MATERIALS += [
    ("ggx(alpha_x=0.1, alpha_y=0.4, eta=1.2, k=2.5, masking=smith-separable)", {"type": "roughconductor", "distribution": "ggx", "alpha_u": 0.1, "alpha_v": 0.4, "eta": 1.2, "k": 2.5}),
    ("0.7*lambert(reflectance=0.5) + 0.3*ggx(alpha=0.3, eta=0.2, k=3.9, masking=smith-separable)",
     {"type": "blendbsdf", "weight": 0.3, "a": {"type": "diffuse", "reflectance": 0.5}, "b": {"type": "roughconductor", "distribution": "ggx", "alpha": 0.3, "eta": 0.2, "k": 3.9}}),
]
SMOOTH = [
    ("dielectric(eta=1.5)", {"type": "dielectric", "int_ior": 1.5, "ext_ior": 1.0}),
    ("conductor(eta=0.2, k=3.9)", {"type": "conductor", "eta": 0.2, "k": 3.9}),
]
ANGLES = [(0, 0, 0), (10, 35, 180), (45, 45, 180), (45, 50, 170), (60, 30, 0), (75, 70, 180), (85, 80, 175), (20, 60, 90)]


def mitsuba_table() -> str:
    mi.set_variant("scalar_rgb")
    lines = [
        "# Mitsuba 3.9.1, scalar_rgb: eval divided by cos(theta_o); of smooth materials the reflectance of the mirror direction.",
        "# scripts/brdf_tables.py; single precision. Its Beckmann masking is Walter's rational function, up to 0.35 % from the exact one.",
        "material,theta_i_deg,theta_o_deg,phi_deg,value",
    ]
    context = mi.BSDFContext()

    def direction(theta: float, phi: float) -> list[float]:
        t, p = math.radians(theta), math.radians(phi)
        return [math.sin(t) * math.cos(p), math.sin(t) * math.sin(p), math.cos(t)]

    def interaction(wi: list[float]) -> object:
        si = mi.SurfaceInteraction3f()
        si.wi = mi.Vector3f(wi)
        si.sh_frame = mi.Frame3f(mi.Normal3f(0, 0, 1))
        si.n = mi.Normal3f(0, 0, 1)
        return si

    for text, plugin in MATERIALS:
        bsdf = mi.load_dict(plugin)
        for ti, to, phi in ANGLES:
            wo = direction(to, phi)
            value = bsdf.eval(context, interaction(direction(ti, 0)), mi.Vector3f(wo))[0] / wo[2]
            lines.append(f'"{text}",{ti},{to},{phi},{value:.8g}')
    for text, plugin in SMOOTH:
        bsdf = mi.load_dict(plugin)
        reflection = mi.BSDFContext()
        reflection.type_mask = mi.BSDFFlags.DeltaReflection
        for ti in [0, 30, 56, 75, 85, 89]:
            sample, weight = bsdf.sample(reflection, interaction(direction(ti, 0)), 0.5, mi.Point2f(0.5, 0.5))
            lines.append(f'"{text}",{ti},{ti},180,{weight[0]:.8g}')
    return "\n".join(lines) + "\n"


def main() -> int:
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("--check", action="store_true", help="compare with tests/data/brdf/ instead of writing it; exit 1 if it differs")
    args = options.parse_args()
    tables = {"fresnel.csv": fresnel_table(), "microfacet.csv": microfacet_table(), "mitsuba.csv": mitsuba_table()}
    different = 0
    for name, text in tables.items():
        path = FOLDER / name
        if not args.check:
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text, encoding="utf-8", newline="\n")
        elif not path.is_file() or path.read_text(encoding="utf-8") != text:
            different += 1
            print(f"tests/data/brdf/{name}: not what this script writes")
    print(f"{different} files differ" if different else f"{len(tables)} files {'as written' if args.check else 'written'}")
    return 1 if different else 0


if __name__ == "__main__":
    sys.exit(main())
