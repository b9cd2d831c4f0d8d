#!/usr/bin/env python3
"""Times photopic's renderer beside Mitsuba 3.9.1 on the benchmark scenes of ../shared/render, to equal error.

    "$(scripts/venv.sh)" scripts/bench_render.py [target/release/photopic] [--scenes cornell,blob,…] [--solvers path,bidirectional] [--samples N] [--seeds N] [--mitsuba] [--whole] [--bands] [--denoise] [--denominators N] [--turns N] [--reach]

The neutral JSON scenes are written as TOML for photopic, without polarisation, which neither the references nor Mitsuba's renders of them know (with it
light in the prism differs from theirs by a relMSE of 0.013); the picture's tristimulus values are compared with the two high-sample references
there: the mean of (x − r1)(x − r2) is an unbiased estimate of the squared error, relative to r² + (0.01 mean)². Printed are the seconds of
the whole command, the relative error of luminance, and the seconds to an error of 1e-3 if it falls as 1/N; below it those of the rendering alone, without
reading the scene, writing the picture and the audits (`seconds_of` in the JSON). With --mitsuba, Mitsuba's LLVM spectral
variant renders the same scenes with its multijitter sampler in the same run (it needs DRJIT_LIBLLVM_PATH, see ../shared/README.md): its render call alone.
With --bands the error is that of the 30 bands of 10 nm from 400 to 700 nm instead: half the mean squared difference of two renders, relative to
r² + (0.01 mean)² of a render of eight times the samples by photopic; printed are the median over the bands and their range.
With --whole Mitsuba is also timed as its user waits for it, from the command to the picture on disk, its start, loading and compiling included: with as
many samples, and what that is with those that an error of 1e-3 takes.
With --denominators N errors are relative to a picture of N samples a pixel by photopic, in place of the references' mean, where that is noisy itself
(the prism's are: a relMSE of 0.023 each, so that not even the truth has less than 0.0085). What is compared stays the references.
With --denoise photopic's pictures are also filtered (`--denoise`), at 4, 8 ... samples until the error is below 1e-3: what is filtered does not get
better as 1/N, so the seconds are those between the last two, along a straight line of logarithms. With --bands as well it is the median error of the
bands, by the product of the differences from two renders of eight times the samples.
With --reach photopic renders --samples, twice, four times … as many, Mitsuba four, 16 … times, until the error is below 1e-3, and the seconds are those between
the last two renders as with --denoise: nothing is said about how the error falls; where a render takes more than half a minute, it is taken to fall as 1/N from there on.
With --turns N every render is repeated N times and the median of its times counts.
Exit status 2 where the scenes are not there.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
import OpenEXR

ROOT = Path(__file__).resolve().parent.parent
SHARED = ROOT.parent / "shared" / "render"
# From the references' unit to cd/m²: the observer's sum times K_m (../shared/README.md).
CANDELA = 106.75026 * 683.002
# The name of photopic's seconds without reading, writing and audits.
ALONE = "rendering"
# Times that each render is repeated.
TURNS = 1
# Seconds of a render beyond which the error is taken to fall as 1/N.
LONGEST = 30.0
# Samples of what is filtered, at most.
MOST = 2048
# Middles of bands of 10 nm.
BANDS_NM = np.arange(405, 696, 10)
SELLMEIER = "dielectric = {{ sellmeier = {{ b = {b}, c_um2 = {c} }} }}"


def table(spectrum):
    pairs = zip(spectrum["lambda_nm"], spectrum["values"])
    return "[" + ", ".join(f"[{nm}, {value}]" for nm, value in pairs) + "]"


def rectangle(corners):
    a, b, _, d = (np.array(c) for c in corners)
    return f"rectangle = {{ corner = {a.tolist()}, edges = [{(b - a).tolist()}, {(d - a).tolist()}] }}"


def material(name, m, shapes, dispersive):
    out = ["[[material]]", f'name = "{name}"']
    if m["type"] == "diffuse" and "checkerboard" in m:
        board = m["checkerboard"]
        corners = next(s["corners"] for s in shapes if s.get("material") == name)
        fields = round(float(np.linalg.norm(np.subtract(corners[1], corners[0]))) / board["tile_m"])
        out.append("reflectance = 1.0")
        even, odd = table(board["color0"]), table(board["color1"])
        out.append(f"checkerboard = {{ even = {even}, odd = {odd}, fields = [{fields}, {fields}] }}")
    elif m["type"] == "diffuse":
        out.append(f"reflectance = {table(m['reflectance'])}")
        # As the references have it: the upper side of the Cornell box's lamp is black.
        out.append("one_sided = true")
    elif dispersive:
        out.append(SELLMEIER.format(b=m["sellmeier_B"], c=m["sellmeier_C_um2"]))
    else:
        out.append(f"dielectric = {{ index = {m['n_const_587.6nm']} }}")
    return "\n".join(out)


def shape(s):
    out = ["[[shape]]", f'material = "{s["material"]}"']
    if s["kind"] == "quad":
        out.append(rectangle(s["corners"]))
    elif s["kind"] == "sphere":
        out.append(f'sphere = {{ centre = {s["center"]}, radius = "{s["radius"]} m" }}')
    else:
        out.append(f'mesh = {{ file = "{SHARED / s["file"]}", flat = true }}')
    if "emission" in s:
        out.append(f"emission = {{ spectrum = {table(s['emission'])} }}")
    return "\n".join(out)


def scene(name, step_nm, adaptive, solver):
    """The text of a scene; `prism+disp` is the prism with dispersion."""
    base = name.removesuffix("+disp")
    d = json.loads((SHARED / "scenes" / f"{base}.json").read_text())
    camera, film = d["camera"], d["film"]
    parts = [f"[render]\nsolver = \"{solver}\"\nmax_edges = {d['integrator']['max_path_edges']}\nwavelength_step_nm = {step_nm}\nadaptive = {str(adaptive).lower()}\npolarisation = false"]
    parts += [material(k, m, d["shapes"], name != base) for k, m in d["materials"].items()]
    parts += [shape(s) for s in d["shapes"]]
    if d["env"]:
        parts.append(f"[[light]]\nspectrum = {table(d['env']['radiance'])}\nenvironment = {{ radiance = \"1 W/m2/sr/nm\" }}")
    parts.append(
        f"[[sensor]]\nname = \"view\"\ncamera = {{ at = {camera['origin']}, look_at = {camera['target']}, up = {camera['up']}, "
        f"field_of_view = \"{camera['fov_deg']} deg\", resolution = [{film['width']}, {film['height']}], exr = \"view.exr\" }}"
    )
    return "\n\n".join(parts)


def errors(xyz, name, relative_to=None):
    """Relative squared error of X, Y, Z and the relative error of their means; relative to the references' or those of a given picture."""
    references = np.load(SHARED / "references" / f"ref_spectral_{name}.npz")
    r1, r2 = references["r1"].astype(float), references["r2"].astype(float)
    mean = ((r1 + r2) / 2).mean((0, 1))
    r = (r1 + r2) / 2 if relative_to is None else relative_to
    error = (xyz - r1) * (xyz - r2) / (r**2 + (0.01 * mean) ** 2)
    return error.mean((0, 1)), xyz.mean((0, 1)) / mean - 1


def ours(binary, name, samples, step_nm, adaptive, solver, channels=("X", "Y", "Z"), seed=0, options=()):
    """Seconds of the whole command and of the rendering alone, and the channels of the picture."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder)
        (path / "scene.toml").write_text(scene(name, step_nm, adaptive, solver))
        command = [binary, "-q", "render", "scene.toml", "--samples", str(samples), "--seed", str(seed), "--json", "-o", "out.json", *options]

        def turn():
            start = time.perf_counter()
            subprocess.run(command, cwd=folder, check=True)
            seconds = time.perf_counter() - start
            return seconds, json.loads((path / "out.json").read_text())["results"][0]["seconds_of"]["rendering"]

        seconds = np.median([turn() for _ in range(TURNS)], axis=0)
        with OpenEXR.File(str(path / "view.exr"), separate_channels=True) as file:
            stored = file.channels()
            pixels = np.stack([stored[c].pixels for c in channels], axis=-1).astype(float)
    return seconds, pixels


def mitsuba_scene(name, samples):
    """Mitsuba's description of a scene."""
    import mitsuba as mi

    if not mi.variant():
        mi.set_variant("llvm_ad_spectral")
    os.chdir(SHARED / "mitsuba")
    sys.path.insert(0, str(SHARED / "mitsuba"))
    from mi_scene import build

    dispersive = name.endswith("+disp")
    integrator = None
    if dispersive:
        import mi_disp

        mi_disp.register()
        integrator = {"type": "hero", "max_depth": 12, "rr_depth": 8}
    return build(name.removesuffix("+disp"), samples, dispersive=dispersive, integrator=integrator, sampler="multijitter")


def mitsuba(name, samples, bands=False, seed=2):
    description = mitsuba_scene(name, samples)
    import mitsuba as mi

    if bands:
        size = {k: description["sensor"]["film"][k] for k in ("width", "height", "rfilter")}
        description["sensor"]["film"] = {"type": "specfilm", "component_format": "float32"} | size
        for nm in BANDS_NM:
            box = {"type": "spectrum", "value": [(float(nm) - 5, 1.0), (float(nm) + 5, 1.0)]}
            description["sensor"]["film"][f"band_{nm}"] = box
    loaded = mi.load_dict(description)
    np.array(mi.render(loaded, spp=samples, seed=1))
    seconds = []
    for _ in range(TURNS):
        start = time.perf_counter()
        pixels = np.array(mi.render(loaded, spp=samples, seed=seed)).astype(float)
        seconds.append(time.perf_counter() - start)
    return np.array([np.median(seconds)]), pixels


def band_errors(render, reference):
    """Seconds of a render, and the relative squared error of each band, from two renders of other seeds."""
    (first, a), (second, b) = render(2), render(3)
    scale = reference.mean((0, 1)) / a.mean((0, 1))
    error = 0.5 * ((a - b) * scale) ** 2 / (reference**2 + (0.01 * reference.mean((0, 1))) ** 2)
    return (first + second) / 2, error.mean((0, 1))


def compare_bands(binary, name, arguments):
    channels = [f"S0.{nm},0nm" for nm in BANDS_NM]
    render = lambda samples, seed, options=(): ours(binary, name, samples, arguments.step_nm, not arguments.even, "path", channels, seed, options)
    _, reference = render(8 * arguments.samples, 1)
    seconds, error = band_errors(lambda seed: render(arguments.samples, seed), reference)
    rows = [("photopic", seconds, error)]
    if arguments.mitsuba:
        rows.append(("mitsuba", *band_errors(lambda seed: mitsuba(name, arguments.samples, True, seed), reference)))
    for program, seconds, error in rows:
        for what, seconds in zip((program, ALONE), seconds):
            to = seconds * error / 1e-3
            print(f"{name:12} {what:13} {seconds:8.2f} {np.median(error):10.5f} {np.median(to):10.2f} {to.min():8.2f} to {to.max():.2f}", flush=True)
    if arguments.mitsuba:
        # Mitsuba's seconds are those of its render call alone.
        ratio = rows[1][1][0] * rows[1][2] / (rows[0][1][1] * rows[0][2])
        print(f"{name:12} {'ratio':13} {'':19} {np.median(ratio):10.2f} {ratio.min():8.2f} to {ratio.max():.2f}", flush=True)
    if arguments.denoise:
        # Filtered pictures have a bias: two references that know nothing of one another give the squared error with it.
        _, other = render(8 * arguments.samples, 4)
        both = (reference + other) / 2

        def judge(pixels):
            error = (pixels - reference) * (pixels - other) / (both**2 + (0.01 * both.mean((0, 1))) ** 2)
            each = error.mean((0, 1))
            return np.median(each), f"{each.min():8.5f} to {each.max():.5f}"

        reached(name, "denoised", lambda samples: render(samples, 0, ["--denoise"]), judge)


def whole(name, samples, call, error):
    """Prints what a user of Mitsuba waits for, whose render call takes so long and has such an error."""
    seconds = []
    for _ in range(TURNS):
        start = time.perf_counter()
        subprocess.run([sys.executable, __file__, "--once", "--scenes", name, "--samples", str(samples)], check=True)
        seconds.append(time.perf_counter() - start)
    seconds = np.median(seconds)
    print(f"{name:12} {'whole':13} {seconds:8.2f} {error:10.5f} {seconds - call + call * error / 1e-3:10.2f}", flush=True)


def once(name, samples):
    """Renders a picture with Mitsuba and writes it, as a program of its own."""
    with tempfile.TemporaryDirectory() as folder:
        description = mitsuba_scene(name, samples)
        import mitsuba as mi

        picture = mi.render(mi.load_dict(description), spp=samples, seed=1)
        mi.util.write_bitmap(str(Path(folder) / "view.exr"), picture, write_async=False)


def reached(name, label, run, judge, first=4, step=2, longest=None):
    """Prints renders of ever more samples until one is good enough, and the seconds to it; `judge` gives the error of one, and what else is to be told.
    Where one takes longer than `longest`, the error is taken to fall as 1/N from there on, which is told; without it, as with what is filtered, 2048 samples
    are the most."""
    spent, error = [], []
    for samples in (first * step**k for k in range(18)):
        seconds, pixels = run(samples)
        off, beside = judge(pixels)
        spent.append(seconds)
        error.append(off)
        for what, one in zip((f"{label}, {samples}", ALONE), seconds):
            own = f"{off:10.5f} {'':10} {beside}" if what != ALONE else ""
            print(f"{name:12} {what:15} {one:8.2f} {own}", flush=True)
        if error[-1] < 1e-3 or (samples >= MOST if longest is None else seconds[-1] > longest):
            break
    for what, seconds in zip((label, ALONE), np.transpose(spent)):
        if error[-1] >= 1e-3 and longest is None:
            print(f"{name:12} {what:15} not reached", flush=True)
        elif error[-1] >= 1e-3:
            print(f"{name:12} {what:15} {'':8} {'':10} {seconds[-1] * error[-1] / 1e-3:10.2f} as 1/N", flush=True)
        elif len(error) == 1:
            print(f"{name:12} {what:15} {'':8} {'':10} at most {seconds[0]:.2f}", flush=True)
        else:
            at = np.exp(np.interp(np.log(1e-3), np.log(error[:-3:-1]), np.log(seconds[:-3:-1])))
            print(f"{name:12} {what:15} {'':8} {'':10} {at:10.2f}", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("binary", nargs="?", default=str(ROOT / "target" / "release" / "photopic"))
    parser.add_argument("--scenes", default="cornell,blob,spheres,prism,prism+disp")
    parser.add_argument("--samples", type=int, default=64)
    parser.add_argument("--step-nm", type=float, default=10.0)
    parser.add_argument("--even", action="store_true", help="photopic gives every pixel as many samples")
    parser.add_argument("--solvers", default="path", help="photopic's, such as path,bidirectional")
    parser.add_argument("--seeds", type=int, default=1, help="renders of each, whose errors are averaged: where few pixels hold most of it one says little")
    parser.add_argument("--mitsuba", action="store_true")
    parser.add_argument("--whole", action="store_true", help="what a user of Mitsuba waits for as well: start, reading, compiling, writing")
    parser.add_argument("--once", action="store_true", help=argparse.SUPPRESS)
    parser.add_argument("--denominators", type=int, default=0, help="errors relative to a picture of so many samples by photopic")
    parser.add_argument("--denoise", action="store_true", help="photopic's filtered pictures as well, of as many samples as they need")
    parser.add_argument("--reach", action="store_true", help="ever more samples until the error is reached, in place of one number of them")
    parser.add_argument("--turns", type=int, default=1, help="times that each render is repeated; the median of its times counts")
    parser.add_argument("--bands", action="store_true", help="the error of bands of 10 nm in place of luminance")
    arguments = parser.parse_args()
    global TURNS
    TURNS = arguments.turns
    if not SHARED.is_dir():
        print("skipped: ../shared/render is not here")
        return 2
    if arguments.once:
        once(arguments.scenes, arguments.samples)
        return 0
    binary = str(Path(arguments.binary).resolve())
    last = "of all bands" if arguments.bands else "mean Y off"
    print(f"{'scene':12} {'program':13} {'s':>8} {'relMSE':>10} {'s to 1e-3':>10} {last:>11}")
    for name in arguments.scenes.split(","):
        if arguments.bands:
            compare_bands(binary, name, arguments)
            continue
        relative_to = None
        if arguments.denominators:
            relative_to = ours(binary, name, arguments.denominators, arguments.step_nm, not arguments.even, "path", seed=10**6)[1] / CANDELA
        if arguments.reach:
            programs = [("path", 2, float("inf"), lambda samples, seed, name=name: ours(binary, name, samples, arguments.step_nm, not arguments.even, "path", seed=seed))]
            if arguments.mitsuba:
                # Numbers that are no squares its sampler rounds up.
                programs.append(("mitsuba", 4, LONGEST, lambda samples, seed, name=name: mitsuba(name, samples, seed=seed + 2)))
            for program, step, longest, render in programs:

                def of_seeds(samples, name=name, program=program, render=render, relative_to=relative_to):
                    """The means over the seeds of the seconds and of the error of luminance."""
                    found = [render(samples, seed) for seed in range(arguments.seeds)]
                    scale = 1.0 if program == "mitsuba" else CANDELA
                    error = [errors(xyz / scale, name, relative_to)[0][1] for _, xyz in found]
                    return np.mean([seconds for seconds, _ in found], axis=0), np.mean(error)

                reached(name, program, of_seeds, lambda error: (error, ""), arguments.samples, step, longest)
            continue
        run = lambda solver, seed, name=name: ours(binary, name, arguments.samples, arguments.step_nm, not arguments.even, solver, seed=seed)
        runs = [(solver, lambda seed, solver=solver, run=run: run(solver, seed)) for solver in arguments.solvers.split(",")]
        if arguments.mitsuba:
            runs.append(("mitsuba", lambda seed, name=name: mitsuba(name, arguments.samples, seed=seed + 2)))
        for program, run in runs:
            found = []
            for seed in range(arguments.seeds):
                seconds, xyz = run(seed)
                error, mean = errors(xyz if program == "mitsuba" else xyz / CANDELA, name, relative_to)
                found.append((error[1], mean[1], *seconds))
            error, mean, *seconds = np.mean(found, axis=0)
            for what, seconds in zip((program, ALONE), seconds):
                print(f"{name:12} {what:13} {seconds:8.2f} {error:10.5f} {seconds * error / 1e-3:10.2f} {100 * mean:10.3f} %", flush=True)
            if arguments.seeds > 1:
                each = np.array(found)[:, 0]
                print(f"{'':12} {'':13} {'':8} {each.min():10.5f} to {each.max():.5f}", flush=True)
            if arguments.whole and program == "mitsuba":
                whole(name, arguments.samples, seconds, error)
        if arguments.denoise:
            render = lambda samples, name=name: ours(binary, name, samples, arguments.step_nm, not arguments.even, "path", options=["--denoise"])

            def judge(xyz, name=name, relative_to=relative_to):
                error, mean = errors(xyz / CANDELA, name, relative_to)
                return error[1], f"{100 * mean[1]:10.3f} %"

            reached(name, "denoised", render, judge)
    return 0


if __name__ == "__main__":
    sys.exit(main())
