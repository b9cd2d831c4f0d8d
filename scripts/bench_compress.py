"""Times `photopic brdf compress` on 100 materials of the size of MERL's, and watches its memory.

The materials are Bagher's fits of the 100 MERL materials, evaluated here with numpy in the middle of every bin and written as MERL
binaries (3.3 GiB, removed afterwards).

    "$(scripts/venv.sh)" scripts/bench_compress.py PHOTOPIC merl_sgd_params.csv [FOLDER]
"""

import csv
import os
import subprocess
import sys
import tempfile
import time

import numpy as np

BINS = (90, 90, 180)
SCALE = (1 / 1500, 1.15 / 1500, 1.66 / 1500)


def centres():
    """cosθ_i, cosθ_o, cosθ_d and tan²θ_h of the middle of every bin, φ_d fastest."""
    h, d, p = ((np.arange(n) + 0.5) / n for n in BINS)
    h, d, p = np.meshgrid(h**2 * np.pi / 2, d * np.pi / 2, p * np.pi, indexing="ij")
    along, up = np.sin(h) * np.sin(d) * np.cos(p), np.cos(h) * np.cos(d)
    return up - along, up + along, np.cos(d), np.tan(h) ** 2


def sgd(row, channel, geometry):
    """f_r in 1/sr; NaN where a direction is below the horizon."""
    rho_d, rho_s, alpha, p, kappa, f0, f1, lam, c, k, th0 = (
        float(row[f"{name}_{channel}"])
        for name in "rhoD rhoS alpha p kap f0 f1 lam c k th0".split()
    )
    cos_i, cos_o, cos_d, tan2 = geometry
    fresnel = f0 - cos_d * f1 + (1 - cos_d) ** 5 * (1 - f0)
    a = alpha + tan2 / alpha
    normals = kappa * np.exp(-a) / (np.pi * a**p) * (1 + tan2) ** 2

    def masking(cos):
        beyond = np.maximum(0, np.arccos(np.minimum(cos, 1)) - th0)
        return np.clip(1 + lam * (1 - np.exp(np.minimum(c * beyond**k, 700))), 0, 1)

    lobe = rho_s * fresnel * normals * masking(cos_i) * masking(cos_o) / (cos_i * cos_o)
    return (rho_d + lobe) / np.pi


def write(rows, folder):
    geometry = centres()
    above = (geometry[0] > 0) & (geometry[1] > 0)
    geometry = [g[above] for g in geometry]
    paths = []
    for i, row in enumerate(rows):
        paths.append(os.path.join(folder, f"{i:03}.binary"))
        with open(paths[-1], "wb") as out:
            np.array(BINS, "<u4").tofile(out)
            for channel, scale in zip("RGB", SCALE):
                plane = np.full(BINS, -1.0)
                # A fit may fall below zero, which a file cannot say.
                plane[above] = np.maximum(sgd(row, channel, geometry), 0) / scale
                plane.astype("<f8").tofile(out)
    return paths


def run(program, *arguments):
    start = time.perf_counter()
    process = subprocess.Popen([program, "brdf", "compress", *arguments], stdout=subprocess.PIPE)
    output = process.stdout.read().decode()
    _, status, usage = os.wait4(process.pid, 0)
    wall = time.perf_counter() - start
    cpu = usage.ru_utime + usage.ru_stime
    print(f"{arguments[0]}: exit {status}, wall {wall:.1f} s, CPU {cpu:.1f} s, peak {usage.ru_maxrss / 2**20:.2f} GiB")
    print(output)


def main():
    program, parameters = sys.argv[1:3]
    with open(parameters, newline="") as file:
        rows = list(csv.DictReader(file))
    with tempfile.TemporaryDirectory(dir=sys.argv[3] if len(sys.argv) > 3 else None) as folder:
        paths = write(rows, folder)
        basis = os.path.join(folder, "set.basis")
        run(program, "train", *paths, "-o", basis)
        run(program, "encode", paths[0], "--basis", basis, "-k", "10")
        run(program, "directions", "--basis", basis, "-n", "20")
        run(program, "error", *paths, "-n", "5,10,20")


if __name__ == "__main__":
    main()
