#!/usr/bin/env python3
"""Holds what photopic writes of images to other programs: they read it, and make the same of it.

    "$(scripts/venv.sh)" scripts/check_images.py [target/release/photopic]

A cube of 512 x 512 pixels and 31 bands is made with numpy. OpenEXR and colour-science's reader of the layout of Fichet et al.
read the EXR that photopic makes of it, Spectral Python the ENVI images in each interleave, numpy the arrays; colour-science
calculates X, Y, Z of 1000 random pixels, and of reflectances under D65, and with numpy how far two cubes are apart. Radiance (the pyradiance wheel), OpenEXR and OpenImageIO
read the pictures in colours, and are read. Where ../shared/image stands beside the checkout, its
files, written by other programs, are read as well. Exit status 1 when a line fails, 2 when nothing could be compared.
"""

from __future__ import annotations

import contextlib
import io
import json
import subprocess
import sys
import tempfile
import warnings
from pathlib import Path

warnings.filterwarnings("ignore")

import numpy as np  # noqa: E402

with contextlib.redirect_stderr(io.StringIO()):
    import colour  # noqa: E402
import OpenEXR  # noqa: E402
import OpenImageIO  # noqa: E402
import pyradiance  # noqa: E402
import spectral  # noqa: E402

RADIANCE = Path(pyradiance.__file__).resolve().parent / "bin"
ROOT = Path(__file__).resolve().parent.parent
SHARED = ROOT.parent / "shared" / "image"
WAVELENGTHS = np.arange(400.0, 701.0, 10.0)
SIZE = 512
K_M = 683.002
CMFS = colour.MSDS_CMFS["CIE 1931 2 Degree Standard Observer"]


class Checks:
    """Lines of the report, and whether all of them hold."""

    def __init__(self, binary):
        self.binary, self.failed = binary, 0

    def run(self, *arguments):
        subprocess.run([self.binary, "-q", "image", *map(str, arguments)], check=True)

    def line(self, what, difference, tolerance):
        good = difference <= tolerance
        self.failed += not good
        print(f"{'ok  ' if good else 'FAIL'}  {what:74} {difference:9.2e}  (≤ {tolerance:.0e})")


def write_envi(path, cube, fields):
    """A little-endian float cube, band-interleaved by pixel, with its header, by hand."""
    cube.astype("<f4").tofile(path.with_suffix(".img"))
    lines, samples, bands = cube.shape
    listed = ", ".join(f"{w:g}" for w in WAVELENGTHS)
    path.write_text(
        f"ENVI\nsamples = {samples}\nlines = {lines}\nbands = {bands}\nheader offset = 0\ndata type = 4\n"
        f"interleave = bip\nbyte order = 0\nwavelength units = Nanometers\nwavelength = {{{listed}}}\n{fields}"
    )


def relative(got, want):
    """Largest difference relative to the wanted value."""
    return float(np.max(np.abs(np.asarray(got, float) - want) / np.abs(want)))


def weights(illuminant=None):
    """Weights of the sum over the bands, 10 nm apart, for X, Y, Z."""
    bars = CMFS.copy().align(colour.SpectralShape(400, 700, 10)).values
    if illuminant is None:
        return K_M * 10 * bars
    light = colour.SDS_ILLUMINANTS[illuminant].copy().align(colour.SpectralShape(400, 700, 10)).values
    weighted = bars * light[:, None]
    return weighted / weighted[:, 1].sum()


def own_files(checks, folder):
    rng = np.random.default_rng(20260101)
    # Radiances over six decades, as scenes have them.
    cube = (10.0 ** rng.uniform(-4, 2, (SIZE, SIZE, 1)) * rng.uniform(0.1, 1, (SIZE, SIZE, 31))).astype(np.float32)
    header = folder / "cube.hdr"
    write_envi(header, cube, "data units = W/m2/sr/nm\n")

    checks.run("convert", header, "-o", folder / "cube.exr", "--to", "cube")
    channels = OpenEXR.File(str(folder / "cube.exr"), separate_channels=True).channels()
    names = ["S0." + f"{w:.1f}nm".replace(".", ",") for w in WAVELENGTHS]
    got = np.dstack([channels[name].pixels for name in names])
    checks.line("spectral EXR read by OpenEXR, every sample", float(np.max(np.abs(got - cube))), 0.0)
    rgb = np.dstack([channels[name].pixels for name in "RGB"])
    matrix = colour.RGB_COLOURSPACES["sRGB"].matrix_XYZ_to_RGB

    components, specification = colour.read_spectral_image_Fichet2021(folder / "cube.exr", additional_data=True)
    wavelengths, values = components["S0"]
    order = np.argsort(wavelengths)
    difference = np.max(np.abs(wavelengths[order] - WAVELENGTHS)) + np.max(np.abs(values[..., order] - cube))
    checks.line("read by colour-science's Fichet 2021 reader, wavelengths and samples", float(difference), 0.0)
    assert specification.is_emissive and not specification.is_polarised

    for interleave in ("bsq", "bil", "bip"):
        out = folder / f"{interleave}.hdr"
        checks.run("convert", header, "-o", out, "--to", "cube", "--interleave", interleave)
        image = spectral.open_image(str(out))
        difference = np.max(np.abs(np.asarray(image.load()) - cube))
        difference += np.max(np.abs(np.array(image.bands.centers) - WAVELENGTHS))
        checks.line(f"ENVI {interleave} read by Spectral Python, wavelengths and samples", float(difference), 0.0)

    # 1000 pixels; photopic sums as colour-science does, and both in double precision from the same floats.
    rows, columns = rng.integers(0, SIZE, (2, 1000))
    pixels = cube[rows, columns].astype(float)
    checks.run("convert", header, "-o", folder / "xyz.npy", "--to", "xyz", "--rule", "summation")
    xyz = np.load(folder / "xyz.npy")[rows, columns]
    want = colour.msds_to_XYZ(
        pixels, cmfs=CMFS, k=K_M, method="Integration", shape=colour.SpectralShape(400, 700, 10)
    )
    checks.line("XYZ of 1000 pixels against colour.msds_to_XYZ", relative(xyz, want), 1e-6)
    checks.run("convert", header, "-o", folder / "y.exr", "--rule", "summation")
    luminance = OpenEXR.File(str(folder / "y.exr"), separate_channels=True).channels()["Y"].pixels
    checks.line("luminance EXR read by OpenEXR, against Y", relative(luminance[rows, columns], want[:, 1]), 1e-6)
    checks.run("convert", header, "-o", folder / "rgb.npy", "--to", "srgb", "--rule", "summation")
    linear = np.load(folder / "rgb.npy")[rows, columns]
    # Components near zero are differences of larger numbers, and colour's matrix is rounded to 4 digits by its standard.
    scale = want[:, 1:2]
    checks.line("linear sRGB, relative to Y", float(np.max(np.abs(linear - want @ matrix.T) / scale)), 5e-4)
    # Those beside the spectra are of the default rule, exact at 10 nm: they differ from the sum by what the rules do.
    checks.line("RGB beside the spectra, relative to Y", float(np.max(np.abs(rgb[rows, columns] - linear) / scale)), 0.05)

    header = folder / "leaf.hdr"
    reflectance = rng.uniform(0.02, 0.98, (SIZE, SIZE, 31))
    write_envi(header, np.round(reflectance * 10000), "reflectance scale factor = 10000\n")
    checks.run(
        "convert", header, "-o", folder / "leaf.npy", "--to", "xyz", "--illuminant", "D65", "--rule", "summation"
    )
    got = np.load(folder / "leaf.npy")[rows, columns]
    want = np.round(reflectance[rows, columns] * 10000) / 10000 @ weights("D65")
    checks.line("XYZ of reflectance under D65, against numpy on colour's tables", relative(got, want), 1e-6)


def comparison(checks, folder):
    """`image compare` of two cubes against numpy, and ΔE2000 against colour-science."""
    rng = np.random.default_rng(20260103)
    reference = (rng.uniform(0.2, 1, (64, 80, 1)) * rng.uniform(0.1, 1, (64, 80, 31))).astype(np.float32)
    other = (reference * rng.normal(1, 0.02, reference.shape)).astype(np.float32)
    for name, cube in (("reference", reference), ("other", other)):
        write_envi(folder / f"{name}.hdr", cube, "data units = W/m2/sr/nm\n")
    # White has the chromaticity of D65 as IEC 61966-2-1 prints it, and a luminance of our choice.
    white_y = 30000.0
    arguments = ["compare", folder / "reference.hdr", folder / "other.hdr", "--rule", "summation", "--lab-white", white_y]
    command = [checks.binary, "-q", "image", *map(str, arguments), "--json"]
    got = json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)["results"][0]

    def figures(a, b):
        rmse = np.sqrt(np.mean((b - a) ** 2))
        return {
            "mean_difference": np.mean(b - a),
            "rmse": rmse,
            "relative_rmse": np.sqrt(np.sum((b - a) ** 2) / np.sum(a**2)),
            "mean_relative": np.mean(np.abs(b - a) / np.abs(a)),
            "max_relative": np.max(np.abs(b - a) / np.abs(a)),
            "psnr_db": 20 * np.log10(a.max() / rmse),
        }

    a, b = reference.astype(float), other.astype(float)
    assert len(got["planes"]) == 31
    worst = max(
        relative(plane[key], want)
        for k, plane in enumerate(got["planes"])
        for key, want in figures(a[..., k], b[..., k]).items()
    )
    checks.line("compare: RMSE, relative errors and PSNR of 31 bands, against numpy", worst, 1e-9)
    # The luminance of each pixel is rounded to a float, 6e-8 of it; their differences are 2 % of it and less.
    xyz = [cube @ weights() for cube in (a, b)]
    want = figures(xyz[0][..., 1], xyz[1][..., 1])
    scale = xyz[0][..., 1].mean()
    difference = abs(got["photopic"]["rmse"] - want["rmse"]) / scale
    checks.line("compare: RMSE of the luminance, relative to its mean", difference, 1.2e-7)
    checks.line("compare: PSNR of the luminance, dB", abs(got["photopic"]["psnr_db"] - want["psnr_db"]), 1e-4)
    lab = [colour.XYZ_to_Lab(v / white_y, np.array([0.3127, 0.3290])) for v in xyz]
    delta_e = colour.delta_E(*lab, method="CIE 2000")
    told = got["delta_e_2000"]
    # X, Y, Z are rounded to floats: a third of 6e-8 in their cube roots, twice 500 times that in a* of either image, 4e-5.
    checks.line("compare: mean ΔE2000, against colour-science", abs(told["mean"] - delta_e.mean()), 1e-4)
    checks.line("compare: largest ΔE2000", abs(told["max"] - delta_e.max()), 1e-4)
    for percent in (50, 95, 99):
        want = np.percentile(delta_e, percent)
        checks.line(f"compare: percentile {percent} of ΔE2000", abs(told[f"p{percent}"] - want), 1e-4)


def shared_files(checks, folder):
    if not SHARED.is_dir():
        print("skipped: ../shared/image is not here")
        return
    for name, component in (("D65", "S0"), ("Ohta1997", "T"), ("Polarised", "S0")):
        checks.run("convert", SHARED / f"{name}.exr", "-o", folder / f"{name}.exr", "--to", "cube", "--no-rgb")
        ours = colour.read_spectral_image_Fichet2021(folder / f"{name}.exr")
        theirs = colour.read_spectral_image_Fichet2021(SHARED / f"{name}.exr")
        assert ours.keys() == theirs.keys(), f"{name}: {ours.keys()} {theirs.keys()}"
        difference = 0.0
        for key in theirs:
            a, b = (np.argsort(c[key][0]) for c in (ours, theirs))
            difference += float(np.max(np.abs(ours[key][0][a] - theirs[key][0][b])))
            difference += float(np.max(np.abs(ours[key][1][..., a] - theirs[key][1][..., b])))
        checks.line(f"{name}.exr through photopic and back to colour-science ({component})", difference, 0.0)


def pictures(checks, folder):
    """RGB: Radiance, OpenEXR and OpenImageIO read what we write, and we read what they write."""
    rng = np.random.default_rng(20260102)
    pixels = (10.0 ** rng.uniform(-2, 2, (40, 60, 1)) * rng.uniform(0.2, 1, (40, 60, 3))).astype(np.float32)
    header = {"chromaticities": (0.64, 0.33, 0.30, 0.60, 0.15, 0.06, 0.3127, 0.3290), "whiteLuminance": 80.0}
    parts = {name: np.ascontiguousarray(pixels[..., k]) for k, name in enumerate("RGB")}
    OpenEXR.File({"compression": OpenEXR.ZIP_COMPRESSION, **header}, parts).write(str(folder / "rgb.exr"))
    srgb = colour.RGB_COLOURSPACES["sRGB"].copy()
    srgb.use_derived_transformation_matrices(True)
    xyz = 80.0 * pixels.astype(float) @ srgb.matrix_RGB_to_XYZ.T
    checks.run("convert", folder / "rgb.exr", "-o", folder / "rgb_xyz.npy", "--to", "xyz")
    checks.line("XYZ of an EXR of OpenEXR, against colour-science", relative(np.load(folder / "rgb_xyz.npy"), xyz), 2e-6)

    # Radiance keeps eight bits of the largest component, cut off; half a unit comes back.
    step = 1 / 128
    for name, target in (("rgbe", "radiance"), ("xyze", "xyz")):
        out = folder / f"{name}.pic"
        checks.run("convert", folder / "rgb.exr", "-o", out, "--to", target, "--adaptation", "none")
        brightness = subprocess.run(
            [RADIANCE / "pvalue", "-o", "-h", "-H", "-d", "-b", out], check=True, capture_output=True, text=True
        ).stdout
        factor = 179.0 if name == "rgbe" else 1.0
        got = factor * np.array(brightness.split(), float).reshape(40, 60)
        checks.line(f"luminance that Radiance's pvalue finds in our {name}", relative(got, xyz[..., 1]), 3 * step)
    text = subprocess.run([RADIANCE / "ra_xyze", "-u", folder / "rgbe.pic"], check=True, capture_output=True).stdout
    (folder / "theirs.pic").write_bytes(text)
    checks.run("convert", folder / "theirs.pic", "-o", folder / "theirs.npy", "--to", "luminance")
    checks.line("luminance of ra_xyze's XYZE", relative(np.load(folder / "theirs.npy"), xyz[..., 1]), 5 * step)

    checks.run("convert", folder / "rgb.exr", "-o", folder / "rgb.png", "--sixteen-bit", "--white-luminance", 8000)
    got = OpenImageIO.ImageBuf(str(folder / "rgb.png")).get_pixels(OpenImageIO.FLOAT)
    want = colour.models.eotf_inverse_sRGB(np.clip(pixels.astype(float) / 100.0, 0, 1))
    checks.line("16-bit PNG read by OpenImageIO, against colour-science's curve", float(np.max(np.abs(got - want))), 8e-6)


def main():
    checks = Checks(Path(sys.argv[1] if len(sys.argv) > 1 else ROOT / "target" / "release" / "photopic").resolve())
    with tempfile.TemporaryDirectory() as folder:
        own_files(checks, Path(folder))
        pictures(checks, Path(folder))
        comparison(checks, Path(folder))
        shared_files(checks, Path(folder))
    print("all hold" if not checks.failed else f"{checks.failed} fail")
    sys.exit(1 if checks.failed else 0)


if __name__ == "__main__":
    main()
