#!/usr/bin/env python3
"""Makes photographs of a glossy sphere with a known BRDF, and their manifest, for `photopic capture brdf` and `photopic trade capture`; needs
Python 3.11 and nothing else.

    scripts/glossy_sphere.py FOLDER

The material is 0.2 + GGX of α = 0.25 and n = 1.5 (Walter et al. 2007, height-correlated masking), under ten distant lights; each light is taken
in three exposures, 16 bits, with a noise of 20 of 65535.
"""

import math
import random
import struct
import sys
import zlib
from pathlib import Path

SIDE, FOCAL, DISTANCE = 96, 450.0, 10.0
ALPHA, INDEX, DIFFUSE = 0.25, 1.5, 0.2
NOISE = 20
TIMES = (1.0, 0.25, 0.0625)
LIGHTS = [(math.sin(t) * math.cos(p), math.sin(t) * math.sin(p), -math.cos(t)) for t, p in ((math.radians(15 + 12 * k), 2.4 * k) for k in range(10))]
IRRADIANCE = 3.0


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def unit(a):
    length = math.sqrt(dot(a, a))
    return tuple(x / length for x in a)


def fresnel(cosine: float) -> float:
    inside = math.sqrt(1 - (1 - cosine * cosine) / INDEX**2)
    s = (cosine - INDEX * inside) / (cosine + INDEX * inside)
    p = (INDEX * cosine - inside) / (INDEX * cosine + inside)
    return (s * s + p * p) / 2


def brdf(normal, light, view) -> float:
    """f_r in 1/sr."""
    i, o = dot(normal, light), dot(normal, view)
    half = unit(tuple(a + b for a, b in zip(light, view)))
    n = dot(normal, half)
    d = ALPHA**2 / (math.pi * (n * n * (ALPHA**2 - 1) + 1) ** 2)
    smith = [math.sqrt(1 + ALPHA**2 * (1 - c * c) / (c * c)) for c in (i, o)]
    g = 2 / (smith[0] + smith[1])
    return DIFFUSE / math.pi + d * g * fresnel(dot(half, light)) / (4 * i * o)


def radiances(light) -> list[float]:
    """The picture, row by row; means over 4 × 4 places of each pixel."""
    out = []
    places = [(k + 0.5) / 4 - 0.5 for k in range(4)]
    for y in range(SIDE):
        for x in range(SIDE):
            total = 0.0
            for sy in places:
                for sx in places:
                    ray = unit(((x + sx - (SIDE - 1) / 2) / FOCAL, (y + sy - (SIDE - 1) / 2) / FOCAL, 1.0))
                    b = ray[2] * DISTANCE
                    root = b * b - DISTANCE**2 + 1
                    if root <= 0:
                        continue
                    t = b - math.sqrt(root)
                    normal = (t * ray[0], t * ray[1], t * ray[2] - DISTANCE)
                    cosine = dot(normal, light)
                    view = tuple(-r for r in ray)
                    if cosine > 0 and dot(normal, view) > 0:
                        total += brdf(normal, light, view) * IRRADIANCE * cosine
            out.append(total / 16)
    return out


def png(path: Path, samples: list[int]) -> None:
    """A grey PNG of 16 bits."""
    rows = (samples[y * SIDE : (y + 1) * SIDE] for y in range(SIDE))
    data = b"".join(b"\0" + struct.pack(f">{SIDE}H", *row) for row in rows)
    out = b"\x89PNG\r\n\x1a\n"
    for name, body in ((b"IHDR", struct.pack(">IIBBBBB", SIDE, SIDE, 16, 0, 0, 0, 0)), (b"IDAT", zlib.compress(data)), (b"IEND", b"")):
        out += struct.pack(">I", len(body)) + name + body + struct.pack(">I", zlib.crc32(name + body))
    path.write_bytes(out)


def make(folder: Path) -> None:
    """Writes `capture.toml` and the photographs."""
    noise = random.Random(7)
    middle = (SIDE - 1) / 2
    manifest = f"""title = "glossy sphere"
[camera]
fx = {FOCAL}
fy = {FOCAL}
cx = {middle}
cy = {middle}
[sphere]
centre_m = [0.0, 0.0, {DISTANCE}]
radius_m = 1.0
[radiance]
unit_w_per_m2_sr = 1.0
[response]
linear = true
"""
    for n, light in enumerate(LIGHTS):
        exposures = []
        picture = radiances(light)
        for k, time in enumerate(TIMES):
            name = f"{n}-{k}.png"
            png(folder / name, [min(65535, max(0, round(65535 * time * value + noise.gauss(0, NOISE)))) for value in picture])
            exposures.append(f'{{ photo = "{name}", time_s = {time} }}')
        manifest += f"""[[light]]
name = "{n}"
direction = [{", ".join(f"{c:.12f}" for c in light)}]
irradiance_w_per_m2 = {IRRADIANCE}
[[stack]]
name = "{n}"
light = "{n}"
exposures = [{", ".join(exposures)}]
"""
    (folder / "capture.toml").write_text(manifest, encoding="utf-8")


if __name__ == "__main__":
    make(Path(sys.argv[1]))
