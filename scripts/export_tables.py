#!/usr/bin/env python3
"""Writes the tables of numbers in data/ and data/MANIFEST.toml, or checks that they are what this script writes.

    scripts/export_tables.py            write data/
    scripts/export_tables.py --check    write to a temporary folder, compare with data/, exit 1 with a diff

Numbers come from two pinned packages (scripts/requirements.txt), from the formula or from the publication named beside
them; nothing else is taken. Every table is held against a second source before it is written, and where the CIE
publishes the table as a data set, the digits are put back into the CIE's own layout and must give the sha256 that the
CIE publishes. The script makes its own environment (scripts/venv.sh) when it is not run inside one.
"""

from __future__ import annotations

import os
import subprocess
import sys
import warnings
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent

warnings.filterwarnings("ignore", message=".*Matplotlib.*")  # not installed; nothing is drawn here
try:
    import colour
    import numpy as np
except ImportError:
    if os.environ.get("PHOTOPIC_VENV"):
        raise
    python = subprocess.run([HERE / "venv.sh"], check=True, stdout=subprocess.PIPE, text=True).stdout.strip()
    os.environ["PHOTOPIC_VENV"] = "1"
    os.execv(python, [python, __file__, *sys.argv[1:]])

import argparse
import difflib
import gzip
import hashlib
import importlib.metadata
import importlib.util
import math
import tempfile
from collections.abc import Callable
from dataclasses import dataclass, field
from decimal import ROUND_HALF_DOWN, ROUND_HALF_EVEN, Context, Decimal

import colour.colorimetry
import colour.quality

EXPORTED = "2026-11-22"
PINS = {"colour-science": "0.4.7", "luxpy": "1.12.5"}
COLOUR = f"colour-science {PINS['colour-science']}"
LUXPY = f"luxpy {PINS['luxpy']}"

Rows = dict[int | Decimal, list[Decimal]]  # whole nanometres, or as printed


# ------------------------------------------------------------------------------------------------ numbers as text


def plain(x: Decimal) -> str:
    """The shortest decimal without an exponent."""
    text = format(x, "f")
    if "." in text:
        text = text.rstrip("0").rstrip(".")
    return "0" if text in ("-0", "") else text


def number(x: float) -> Decimal:
    """The shortest decimal that gives this float back: the digits its package has in its source."""
    return Decimal(repr(float(x)))


def significant(x: Decimal, digits: int, rounding: str = ROUND_HALF_EVEN) -> Decimal:
    return Context(prec=digits, rounding=rounding).create_decimal(x)


def computed(x: float, digits: int) -> Decimal:
    return Decimal(f"{x:.{digits}g}")


# ------------------------------------------------------------------------------------------------ the two packages


def of_colour(*distributions: object) -> Rows:
    """One column per spectral distribution of colour-science, or the columns of one multi-spectral distribution."""
    columns = []
    for d in distributions:
        values = np.atleast_2d(np.asarray(d.values).T)
        columns += [dict(zip((int(w) for w in d.wavelengths), v, strict=True)) for v in values]
    return {w: [number(c[w]) for c in columns] for w in columns[0]}


def colour_file(path: str) -> Rows:
    text = gzip.open(Path(colour.__file__).parent / path, "rt").read()
    return parse(text)


def luxpy_folder() -> Path:
    # The package is not imported: only its text files are read.
    spec = importlib.util.find_spec("luxpy")
    assert spec is not None and spec.origin is not None, "luxpy is not installed"
    return Path(spec.origin).parent


def of_luxpy(path: str, *, header: int = 0, columns: slice = slice(None)) -> Rows:
    return parse((luxpy_folder() / path).read_text(encoding="utf-8-sig"), header=header, columns=columns)


def parse(text: str, *, header: int = 0, columns: slice = slice(None)) -> Rows:
    """Comma-separated lines; an empty cell is zero, which is what the CIE asks for where it prints nothing."""
    rows: Rows = {}
    for line in text.splitlines()[header:]:
        cells = [c.strip() for c in line.split(",")]
        if cells[0]:
            rows[int(float(cells[0]))] = [Decimal(c or "0") for c in cells[1:][columns]]
    return rows


def column(rows: Rows, *which: int) -> Rows:
    return {w: [r[i] for i in which] for w, r in rows.items()}


def beside(*parts: Rows) -> Rows:
    """The columns of several tables on the wavelengths that all of them have."""
    common = sorted(set.intersection(*(set(p) for p in parts)))
    return {w: [x for p in parts for x in p[w]] for w in common}


def every(rows: Rows, step: int) -> Rows:
    return {w: r for w, r in rows.items() if w % step == 0}


# ------------------------------------------------------------------------------------------------ formulas


def illuminant_a() -> Rows:
    """ISO/CIE 11664-2:2022, equation 1, six significant digits."""
    c, t = 1.435e7, 2848.0

    def s(w: int) -> float:
        return 100 * (560 / w) ** 5 * (math.exp(c / (t * 560)) - 1) / (math.exp(c / (t * w)) - 1)

    return {w: [computed(s(w), 6)] for w in range(300, 831)}


def linear(rows: Rows, knots: int, digits: int, rounding: str) -> Rows:
    """Every nanometre by straight lines between the multiples of `knots` nm, rounded to significant digits."""
    out: Rows = {}
    for w in range(min(rows), max(rows) + 1):
        a = w - w % knots
        low = rows[a]
        high = rows[a + knots] if w != a else low
        out[w] = [significant(x + (y - x) * (w - a) / knots, digits, rounding) for x, y in zip(low, high, strict=True)]
    return out


def daylight(cct: float) -> Rows:
    """CIE 015:2018, equations 4.7 to 4.11: S0 + M1 S1 + M2 S2 with M1 and M2 rounded to three decimals.

    The nominal temperature is multiplied by 1.4388/1.4380, which keeps the chromaticity of 1967.
    """
    t = cct * 1.4388 / 1.4380
    if t <= 7000:
        x = -4.6070e9 / t**3 + 2.9678e6 / t**2 + 0.09911e3 / t + 0.244063
    else:
        x = -2.0064e9 / t**3 + 1.9018e6 / t**2 + 0.24748e3 / t + 0.237040
    y = -3.000 * x * x + 2.870 * x - 0.275
    m = 0.0241 + 0.2562 * x - 0.7341 * y
    m1 = Decimal(str(round((-1.3515 - 1.7703 * x + 5.9114 * y) / m, 3)))
    m2 = Decimal(str(round((0.0300 - 31.4424 * x + 30.0717 * y) / m, 3)))
    return {w: [s0 + m1 * s1 + m2 * s2] for w, (s0, s1, s2) in of_luxpy("data/spds/S0123_daylight_phase_5nm.csv", columns=slice(3)).items()}


# ------------------------------------------------------------------------------------------------ from publications

# B(lambda), IEC 62471:2006 Table 4.2 (CIE S 009:2002, EN 62471:2008), 300 nm to 500 nm. Three public transcriptions
# agree on every value: the EN 62471 table in isetcam's s_safetyHazardFunctions.m, luxpy's blue_light_hazard module
# and the 5 nm file BLHF.csv of NorthernLoki/Horticulture_Tools, the last with ICNIRP 2013's 0.0125 at 385 nm.
BLUE_LIGHT = {
    300: "0.01", 380: "0.01", 385: "0.013", 390: "0.025", 395: "0.05", 400: "0.10", 405: "0.20", 410: "0.40",
    415: "0.80", 420: "0.90", 425: "0.95", 430: "0.98", 435: "1.00", 440: "1.00", 445: "0.97", 450: "0.94",
    455: "0.90", 460: "0.80", 465: "0.70", 470: "0.62", 475: "0.55", 480: "0.45", 485: "0.40", 490: "0.22",
    495: "0.16", 500: "0.10",
}  # fmt: skip

# R(lambda), IEC 62471:2006 Table 4.2, 380 nm to 500 nm; 1 from there to 700 nm, then formulas. Two public transcriptions
# agree on every piece: isetcam's s_safetyHazardFunctions.m (by 5 nm to 1400 nm) and an analysis of an infrared illuminator
# by clause 4.3.6 (values to 500 nm, formulas beyond). RTHF.csv of NorthernLoki/Horticulture_Tools is ICNIRP 2013's, which
# has the peak at 1 and is the same from 500 to 1150 nm.
RETINAL_THERMAL = {
    380: "0.1", 385: "0.13", 390: "0.25", 395: "0.5", 400: "1.0", 405: "2.0", 410: "4.0", 415: "8.0", 420: "9.0",
    425: "9.5", 430: "9.8", 435: "10.0", 440: "10.0", 445: "9.7", 450: "9.4", 455: "9.0", 460: "8.0", 465: "7.0",
    470: "6.2", 475: "5.5", 480: "4.5", 485: "4.0", 490: "2.2", 495: "1.6", 500: "1.0",
}  # fmt: skip

# S(lambda), ICNIRP 2004 Table 1 (Health Physics 87, 171-186), the values of IEC 62471:2006 Table 4.1. Three public
# transcriptions agree on every value: EN 62471 in isetcam's s_safetyHazardFunctions.m (from 200 nm), ICNIRP 2004 in a
# web page's hazard-weighting.ts, and, at these wavelengths, an unlabelled 1 nm list in an app, apparently that of
# Directive 2006/25/EC, Annex I, Table 1.2.
ACTINIC_UV = {
    180: "0.012", 190: "0.019", 200: "0.030", 205: "0.051", 210: "0.075", 215: "0.095", 220: "0.120", 225: "0.150",
    230: "0.190", 235: "0.240", 240: "0.300", 245: "0.360", 250: "0.430", 254: "0.500", 255: "0.520", 260: "0.650",
    265: "0.810", 270: "1.000", 275: "0.960", 280: "0.880", 285: "0.770", 290: "0.640", 295: "0.540", 297: "0.460",
    300: "0.300", 303: "0.120", 305: "0.060", 308: "0.026", 310: "0.015", 313: "0.006", 315: "0.003", 316: "0.0024",
    317: "0.0020", 318: "0.0016", 319: "0.0012", 320: "0.0010", 322: "0.00067", 323: "0.00054", 325: "0.00050",
    328: "0.00044", 330: "0.00041", 333: "0.00037", 335: "0.00034", 340: "0.00028", 345: "0.00024", 350: "0.00020",
    355: "0.00016", 360: "0.00013", 365: "0.00011", 370: "0.000093", 375: "0.000077", 380: "0.000064",
    385: "0.000053", 390: "0.000044", 395: "0.000036", 400: "0.000030",
}  # fmt: skip

# Relative quantum yield of CO2 uptake per incident photon, mean of crop plants grown in chambers: McCree 1972,
# Agricultural Meteorology 9, 191-216, Table III. Transcribed in aphalo/photobiologyWavebands (tables_IV_III...txt);
# the finer RQE.csv of NorthernLoki/Horticulture_Tools passes within 0.01 of every one of them. The field means of
# Table IV were found in one place only and are left out.
MCCREE = {
    350: "0.16", 375: "0.45", 400: "0.66", 425: "0.76", 450: "0.75", 475: "0.68", 500: "0.71", 525: "0.74",
    550: "0.87", 575: "0.95", 600: "1.00", 625: "1.00", 650: "0.94", 675: "0.92", 700: "0.44", 725: "0.20",
}  # fmt: skip


def between(knots: dict[int, str], w: int) -> tuple[Decimal, Decimal, Decimal]:
    low = max(k for k in knots if k <= w)
    high = min(k for k in knots if k >= w)
    share = Decimal(0) if low == high else Decimal(w - low) / Decimal(high - low)
    return Decimal(knots[low]), Decimal(knots[high]), share


# Optical constants n, k of metals at the photon energies, eV, of the publications; wavelengths in nm as the database
# refractiveindex.info (CC0 1.0) has them, which is where the digits were copied from.
NOBLE_NM = "354.2 367.9 381.5 397.4 413.3 430.5 450.9 471.4 495.9 520.9 548.6 582.1 616.8 659.5 704.5 756.0 821.1 892.0"
NOBLE_EV = "3.50 3.37 3.25 3.12 3.00 2.88 2.75 2.63 2.50 2.38 2.26 2.13 2.01 1.88 1.76 1.64 1.51 1.39"
METALS = {
    "ag": ("silver", NOBLE_NM,
           "0.10 0.07 0.05 0.05 0.05 0.04 0.04 0.05 0.05 0.05 0.06 0.05 0.06 0.05 0.04 0.03 0.04 0.04",
           "1.419 1.657 1.864 2.070 2.275 2.462 2.657 2.869 3.093 3.324 3.586 3.858 4.152 4.483 4.838 5.242 5.727 6.312"),
    "au": ("gold", NOBLE_NM,
           "1.50 1.48 1.46 1.47 1.46 1.45 1.38 1.31 1.04 0.62 0.43 0.29 0.21 0.14 0.13 0.14 0.16 0.17",
           "1.866 1.895 1.933 1.952 1.958 1.948 1.914 1.849 1.833 2.081 2.455 2.863 3.272 3.697 4.103 4.542 5.083 5.663"),
    "cu": ("copper", NOBLE_NM,
           "1.37 1.36 1.33 1.32 1.28 1.25 1.24 1.25 1.22 1.18 1.02 0.70 0.30 0.22 0.21 0.24 0.26 0.30",
           "1.916 1.975 2.045 2.116 2.207 2.305 2.397 2.483 2.564 2.608 2.577 2.704 3.205 3.747 4.205 4.665 5.180 5.768"),
    "al": ("aluminium", "326.28 364.66 413.28 442.8 476.87 516.6 563.57 619.93 652.25 688.81 729.32 774.91 794.78 815.69 837.74 885.61",
           "0.31474 0.39877 0.52135 0.60790 0.72780 0.87340 1.0728 1.3660 1.5724 1.8301 2.1606 2.6154 2.7675 2.7668 2.6945 2.2802",
           "3.9165 4.3957 5.0008 5.3676 5.7781 6.2418 6.7839 7.4052 7.7354 8.0601 8.3565 8.4914 8.3866 8.2573 8.1878 8.1134"),
}


def metal(symbol: str) -> Table:
    """Optical constants of one metal; the wavelengths must be those of the publication's photon energies."""
    name, nm, n, k = METALS[symbol]
    rows = {Decimal(w): [Decimal(a), Decimal(b)] for w, a, b in zip(nm.split(), n.split(), k.split(), strict=True)}
    if symbol == "al":
        # Printed in steps of the energy that end in 0.02, 0.05 or whole tenths of an electron volt.
        energies = [1239.842 / float(w) for w in rows]
        odd = [e for e in energies if abs(e * 50 - round(e * 50)) > 0.02 and abs(e * 20 - round(e * 20)) > 0.02]
        source, doi = "Rakic 1995 Table 1", "10.1364/AO.34.004755"
        reference = "Rakic 1995, Algorithm for the determination of intrinsic optical constants of metal films: application to aluminum, Applied Optics 34, 4755-4767"
        database = "main/Al/nk/Rakic.yml"
    else:
        odd = [w for w, e in zip(rows, NOBLE_EV.split(), strict=True) if abs(1239.842 / float(w) - float(e)) > 0.0051]
        source, doi = "Johnson & Christy 1972 Table I", "10.1103/PhysRevB.6.4370"
        reference = "Johnson & Christy 1972, Optical constants of the noble metals, Physical Review B 6, 4370-4379"
        database = f"main/{symbol.capitalize()}/nk/Johnson.yml"
    if odd:
        fail(f"{name}: wavelengths off the photon energies: {odd}")
    middle = next(w for w in rows if w > 500)
    return Table(
        name=f"nk-{symbol}", aliases=[symbol, name], file=f"refractive/{symbol}.csv",
        title=f"Optical constants of {name}: refractive index n and extinction coefficient k",
        standard=source, doi=doi, reference=reference,
        origin=f"refractiveindex.info database, {database} (digits of the publication)",
        checked="wavelengths are those of the photon energies at which the publication tabulates",
        licence="CC0 1.0", rows=rows,
        columns=[Column("n", "1", "refractive index"), Column("k", "1", "extinction coefficient, of n - ik")],
        spots=[Spot(middle, c, str(rows[middle][i]), source) for i, c in enumerate("nk")],
        note="In vacuum wavelengths; the difference to standard air, below 0.03 %, is far below the uncertainty. Opaque films; bulk and oxidised surfaces differ by several per cent.")


def blue_light_hazard() -> Rows:
    rows: Rows = {}
    for w in range(300, 501):
        low, high, share = between(BLUE_LIGHT, w)
        rows[w] = [low + (high - low) * share]
    for w in range(501, 600):
        rows[w] = [computed(10 ** ((450 - w) / 50), 15)]
    for w in range(600, 701):
        rows[w] = [Decimal("0.001")]
    return rows


def retinal_thermal_hazard() -> Rows:
    rows: Rows = {}
    for w in range(380, 501):
        low, high, share = between(RETINAL_THERMAL, w)
        rows[w] = [low + (high - low) * share]
    for w in range(501, 1401):
        rows[w] = [Decimal(1) if w <= 700 else computed(10 ** ((700 - w) / 500), 15) if w < 1050 else Decimal("0.2") if w <= 1150
                   else computed(0.2 * 10 ** (0.02 * (1150 - w)), 15) if w < 1200 else Decimal("0.02")]
    return rows


def actinic_uv_hazard() -> Rows:
    rows: Rows = {}
    for w in range(180, 401):
        low, high, share = between(ACTINIC_UV, w)
        rows[w] = [low if share == 0 else computed(math.exp((1 - float(share)) * math.log(low) + float(share) * math.log(high)), 6)]
    return rows


# ------------------------------------------------------------------------------------------------ what a table is


@dataclass
class Column:
    name: str
    unit: str
    meaning: str
    published_sum: str | None = None


@dataclass
class Spot:
    nm: int | Decimal
    column: str
    value: str
    source: str


@dataclass
class Table:
    name: str
    file: str
    title: str
    standard: str
    origin: str
    licence: str
    columns: list[Column]
    rows: Rows
    spots: list[Spot]
    checked: str
    aliases: list[str] = field(default_factory=list)
    doi: str | None = None
    reference: str | None = None
    interpolation: str = "linear"
    extrapolation: str = "zero"
    smooth: bool = False
    breaks: list[int] = field(default_factory=list)
    publisher_sha256: str | None = None
    note: str | None = None

    def csv(self) -> str:
        head = ",".join(["wavelength_nm", *(c.name for c in self.columns)])
        body = (",".join([str(w), *map(plain, self.rows[w])]) for w in sorted(self.rows))
        return "\n".join([head, *body]) + "\n"


FAILURES: list[str] = []


def fail(message: str) -> None:
    FAILURES.append(message)


def agree(what: str, a: Rows, b: Rows, *, within: float = 0.0, except_at: dict[int, float] | None = None) -> None:
    """Every number that both have must be the same, or within `within`; `except_at` lists known differences."""
    common = sorted(set(a) & set(b))
    if not common:
        fail(f"{what}: nothing in common")
    for w in common:
        if len(a[w]) != len(b[w]):
            fail(f"{what}: {len(a[w])} columns against {len(b[w])}")
            return
        allowed = (except_at or {}).get(w, within)
        worst = max(abs(float(x - y)) for x, y in zip(a[w], b[w], strict=True))
        if worst > allowed * (1 + 1e-9):
            fail(f"{what}: {w} nm differs by {worst:g}: {[plain(x) for x in a[w]]} against {[plain(x) for x in b[w]]}")


def as_published(rows: Rows, show: Callable[[Decimal], str]) -> str:
    """The sha256 of the rows in the layout of the CIE's data sets: no header, CRLF."""
    text = "".join(f"{w}," + ",".join(show(x) for x in rows[w]) + "\r\n" for w in sorted(rows))
    return hashlib.sha256(text.encode()).hexdigest()


def published(what: str, rows: Rows, show: Callable[[Decimal], str], sha256: str) -> str:
    if as_published(rows, show) != sha256:
        fail(f"{what}: the digits do not give the CIE's file (sha256 {sha256})")
    return sha256


def fixed(digits: int) -> Callable[[Decimal], str]:
    return lambda x: f"{x:.{digits}f}"


def exponent(digits: int) -> Callable[[Decimal], str]:
    return lambda x: f"{float(x):.{digits}E}"


def published_file(path: str, sha256: str) -> str:
    """As `published`, for a file that luxpy carries unchanged but for its line ends."""
    text = (luxpy_folder() / path).read_bytes().replace(b"\r\n", b"\n").strip(b"\n")
    if hashlib.sha256(text.replace(b"\n", b"\r\n") + b"\r\n").hexdigest() != sha256:
        fail(f"{path}: is not the CIE's file (sha256 {sha256})")
    return sha256


# ------------------------------------------------------------------------------------------------ the tables

CC_BY_SA = "CC BY-SA 4.0"
FACTS = "published numeric values, no terms stated by the publisher"
SAME_FILE = "the digits, put back into the CIE's layout, give the CIE's own file byte for byte (publisher_sha256)"
SUMS = "the column sums equal those the CIE publishes with its data set, to the last digit"


def meaning_of_observer(degrees: str) -> list[str]:
    return [f"colour-matching function {v}, {degrees} observer" for v in ("x", "y", "z")]


def tables() -> list[Table]:
    lefs = colour.colorimetry.SDS_LEFS
    cmfs = colour.colorimetry.MSDS_CMFS
    lamps = colour.colorimetry.SDS_ILLUMINANTS
    out: list[Table] = []

    # -------------------------------------------------------------------------------- luminous efficiency

    xyz31 = of_luxpy("data/cmfs/ciexyz_1931_2.dat")
    v = of_colour(lefs["cie_2_1924"])
    agree("V 1924 against ybar 1931", v, column(xyz31, 1))
    out.append(Table(
        name="cie-1924-v", aliases=["photopic"], file="cie/v_1924.csv",
        title="CIE spectral luminous efficiency for photopic vision, V(lambda)",
        standard="CIE 018:2019 Table 1; ISO/CIE 11664-1:2019", doi="10.25039/CIE.DS.dktna2s3",
        origin=f"{COLOUR}: colorimetry.SDS_LEFS['CIE 1924 Photopic Standard Observer']",
        checked=f"equal to y_bar of {LUXPY} data/cmfs/ciexyz_1931_2.dat; {SAME_FILE}",
        publisher_sha256=published("cie-1924-v", v, fixed(13), "ee5d5d17922ae645d4af52cacf6a50bdb9385749f9d2181ca312eb2b08febac2"),
        licence=CC_BY_SA, smooth=True, rows=v,
        columns=[Column("V", "1", "photopic luminous efficiency", "106.8569171011719")],
        spots=[Spot(555, "V", "1", "CIE 018:2019: the maximum"), Spot(479, "V", "0.1334528", "sample row of the CIE data set"),
               Spot(829, "V", "0.0000004846123", "sample row of the CIE data set"), Spot(363, "V", "0.000005532136", "sample row of the CIE data set"),
               Spot(547, "V", "0.9874182", "CIE 018:2019 Table 6")],
        note="Wavelengths in standard air. Equal to y_bar of cie-1931-2deg."))

    scotopic = of_colour(lefs["cie_1951"])
    agree("V' against luxpy's 5 nm", scotopic, column(of_luxpy("data/cmfs/ciexyz_1951_20_scotopic.dat"), 1))
    out.append(Table(
        name="cie-1951-v-prime", aliases=["scotopic"], file="cie/v_prime_1951.csv",
        title="CIE spectral luminous efficiency for scotopic vision, V'(lambda)",
        standard="CIE 018:2019 Table 2", doi="10.25039/CIE.DS.gr6w4b5g",
        origin=f"{COLOUR}: colorimetry.SDS_LEFS['CIE 1951 Scotopic Standard Observer']",
        checked=f"equal to {LUXPY} data/cmfs/ciexyz_1951_20_scotopic.dat where that has a value (5 nm); {SAME_FILE}",
        publisher_sha256=published("cie-1951-v-prime", scotopic, fixed(10), "6a75d3fdbcbf5e9e9a07478511933eefeda953f3e2cc14b74459e5a099ec3759"),
        licence=CC_BY_SA, smooth=True, rows=scotopic,
        columns=[Column("V_prime", "1", "scotopic luminous efficiency", "97.0713165740")],
        spots=[Spot(507, "V_prime", "1", "CIE 018:2019: the maximum"), Spot(459, "V_prime", "0.557", "sample row of the CIE data set"),
               Spot(499, "V_prime", "0.976", "sample row of the CIE data set"), Spot(555, "V_prime", "0.402", "CIE 018:2019 Table 2")],
        note="Printed 1 at 506, 507 and 508 nm. Wavelengths in standard air."))

    judd = of_colour(lefs["Judd Modified CIE 1951 Photopic Standard Observer"])
    agree("Judd 1951", judd, column(of_luxpy("data/cmfs/ciexyz_1931_2_judd1951.dat"), 1), except_at={770: 1e-5})
    out.append(Table(
        name="judd-1951-v", aliases=["judd"], file="cvrl/v_judd_1951.csv",
        title="Judd's 1951 modification of V(lambda)",
        standard="Judd 1951, Report of U.S. Secretariat Committee on Colorimetry and Artificial Daylight, Proceedings of the Twelfth Session of the CIE",
        origin=f"{COLOUR}: colorimetry.SDS_LEFS['Judd Modified CIE 1951 Photopic Standard Observer']",
        checked=f"equal to {LUXPY} data/cmfs/ciexyz_1931_2_judd1951.dat, but for 770 nm (0 here, 0.00001 there)",
        licence=FACTS, rows=judd, columns=[Column("V", "1", "luminous efficiency, Judd 1951")],
        spots=[Spot(550, "V", "0.995", "Judd 1951"), Spot(400, "V", "0.0045", "Judd 1951")],
        note="Tabulated every 10 nm; the maximum is printed at 550 and 560 nm."))

    vos = of_colour(lefs["Judd-Vos Modified CIE 1978 Photopic Standard Observer"])
    five = column(of_luxpy("data/cmfs/ciexyz_1931_2_juddvos1978.dat"), 1)
    agree("Judd-Vos 1978 every 10 nm", every(vos, 10), {w: r for w, r in every(five, 10).items() if w != 780}, except_at={550: 2e-7})
    agree("Judd-Vos 1978 between", vos, five, within=0.0020)
    out.append(Table(
        name="judd-vos-1978-v", aliases=["judd-vos", "cie-1988-v-m"], file="cvrl/v_judd_vos_1978.csv",
        title="CIE 1988 modified 2-degree spectral luminous efficiency for photopic vision, V_M(lambda) (Judd 1951, Vos 1978)",
        standard="CIE 086-1990", reference="Vos 1978, Color Research and Application 3, 125-128",
        origin=f"{COLOUR}: colorimetry.SDS_LEFS['Judd-Vos Modified CIE 1978 Photopic Standard Observer']",
        checked=f"equal to y_bar of {LUXPY} data/cmfs/ciexyz_1931_2_juddvos1978.dat every 10 nm (550 nm: 0.9949501 here, 0.99495 there)",
        licence=FACTS, smooth=True, breaks=[397, 460], rows=vos, columns=[Column("V", "1", "luminous efficiency, CIE 1988 V_M")],
        spots=[Spot(380, "V", "0.0002", "CIE 086-1990"), Spot(400, "V", "0.0028", "CIE 086-1990"), Spot(450, "V", "0.0468", "CIE 086-1990"),
               Spot(460, "V", "0.06", "CIE 086-1990"), Spot(555, "V", "1", "CIE 086-1990")],
        note="V_M leaves V(lambda) at 460 nm. 0.0018776 at 397 nm stands 1.00e-4 below its neighbours, as if 0.0019776 were meant; all copies "
             "found have it, so it is kept. Not Vos's smoothed 5 nm colour-matching function: at the odd multiples of 5 nm the two differ by up "
             "to 0.0019 (505 nm)."))

    xyz64 = of_colour(cmfs["cie_10_1964"])
    agree("1964", xyz64, of_luxpy("data/cmfs/ciexyz_1964_10.dat"))
    v10 = of_colour(lefs["cie_10_1964"])
    agree("V10 against ybar10", v10, column(xyz64, 1))
    out.append(Table(
        name="cie-1964-v10", file="cie/v10_1964.csv",
        title="CIE spectral luminous efficiency for 10-degree photopic vision, V10(lambda)",
        standard="CIE 018:2019 Table 5; CIE 165:2005", doi="10.25039/CIE.DS.bfn2eqci",
        origin=f"{COLOUR}: colorimetry.SDS_LEFS['CIE 1964 Photopic 10 Degree Standard Observer']",
        checked=f"equal to y_bar of {LUXPY} data/cmfs/ciexyz_1964_10.dat; {SAME_FILE}",
        publisher_sha256=published("cie-1964-v10", v10, fixed(12), "e67e0c48406bdb6cef7ce03c42bd66f9dfc8601fb0a60837f8971973d4b960c9"),
        licence=CC_BY_SA, smooth=True, rows=v10,
        columns=[Column("V10", "1", "photopic luminous efficiency, 10-degree field", "116.661877102312")],
        spots=[Spot(479, "V10", "0.245997", "sample row of the CIE data set"), Spot(557, "V10", "1", "CIE 018:2019 Table 5: the maximum")]))

    xyz15 = {n: of_luxpy(f"data/cmfs/ciexyz_2015_{n}.dat") for n in (2, 10)}
    for n, table, sample, sums, doi, sha in (
        (2, "10.2", "0.501143", "113.0423145713364", "10.25039/CIE.DS.pyqkh5rw", "e2a07b2bbab0dc800b35d2b070e79b87674740bd8c4ceb53ae78c6053c0e2316"),
        (10, "10.4", "0.6096388", "118.5180915321789", "10.25039/CIE.DS.8mrru44q", None),
    ):
        vf = column(xyz15[n], 1)
        agree(f"V_F {n} degrees", vf, of_colour(lefs[f"CIE 2008 {n} Degree Physiologically Relevant LEF"]), within=5.001e-7)
        out.append(Table(
            name=f"cie-2008-v-{n}deg", aliases=[f"cie-2015-v-{n}deg", f"v-f-{n}deg"], file=f"cie/v_f_2008_{n}deg.csv",
            title=f"CIE cone-fundamental-based spectral luminous efficiency for {n}-degree field size, V_F(lambda)",
            standard=f"CIE 170-2:2015 Table {table}", doi=doi,
            origin=f"{LUXPY}: data/cmfs/ciexyz_2015_{n}.dat, y_bar",
            checked=f"equal to {COLOUR} SDS_LEFS['CIE 2008 {n} Degree Physiologically Relevant LEF'] to the six digits printed there; "
                    + (SAME_FILE if sha else SUMS),
            publisher_sha256=published(f"cie-2008-v-{n}deg", vf, exponent(6), sha) if sha else None,
            licence=CC_BY_SA, smooth=True, rows=vf,
            columns=[Column("V_F", "1", f"photopic luminous efficiency, {n}-degree field, from the cone fundamentals", sums)],
            spots=[Spot(509, "V_F", sample, "sample row of the CIE data set")],
            note="The maximum lies between the tabulated wavelengths. The CIE asks for the defining formula between them, not for a line."))

    # -------------------------------------------------------------------------------- colour-matching functions

    agree("1931", xyz31, of_colour(cmfs["cie_2_1931"]), within=5.001e-13)
    out.append(Table(
        name="cie-1931-2deg", aliases=["cie-1931"], file="cie/xyz_1931_2deg.csv",
        title="Colour-matching functions of the CIE 1931 standard colorimetric observer",
        standard="CIE 018:2019 Table 6; ISO/CIE 11664-1:2019 Table 1", doi="10.25039/CIE.DS.xvudnb9b",
        origin=f"{LUXPY}: data/cmfs/ciexyz_1931_2.dat",
        checked=f"equal to {COLOUR} MSDS_CMFS['CIE 1931 2 Degree Standard Observer'] within 5e-13 (that rounds y_bar from 819 nm); "
                "luxpy's file is the CIE's own but for its line ends (publisher_sha256)",
        publisher_sha256=published_file("data/cmfs/ciexyz_1931_2.dat", "fa663e3535a7e0763a745993a1f0a192eb0275ac46ad2d1befd7626841e713c1"),
        licence=CC_BY_SA, smooth=True, rows=xyz31,
        columns=[Column(n, "1", m, s) for n, m, s in zip(("x_bar", "y_bar", "z_bar"), meaning_of_observer("2-degree"),
                 ("106.865469489595", "106.8569171011719", "106.892251278636"), strict=True)],
        spots=[Spot(479, "x_bar", "0.1042979", "sample row of the CIE data set"), Spot(479, "y_bar", "0.1334528", "sample row of the CIE data set"),
               Spot(479, "z_bar", "0.8566193", "sample row of the CIE data set"), Spot(600, "x_bar", "1.0622", "CIE 018:2019 Table 6"),
               Spot(547, "y_bar", "0.9874182", "CIE 018:2019 Table 6"), Spot(555, "y_bar", "1", "CIE 018:2019 Table 6"),
               Spot(445, "z_bar", "1.78260", "ISO/CIE 11664-1:2019")],
        note="A copy in wide use (pbrt until April 2026, and others) has y_bar(547) = 0.9874812, two digits exchanged; 0.9874182 is right."))
    out.append(Table(
        name="cie-1964-10deg", aliases=["cie-1964"], file="cie/xyz_1964_10deg.csv",
        title="Colour-matching functions of the CIE 1964 standard colorimetric observer",
        standard="ISO/CIE 11664-1:2019 Table 2", doi="10.25039/CIE.DS.sqksu2n5",
        origin=f"{COLOUR}: colorimetry.MSDS_CMFS['CIE 1964 10 Degree Standard Observer']",
        checked=f"equal to {LUXPY} data/cmfs/ciexyz_1964_10.dat; {SUMS}",
        licence=CC_BY_SA, smooth=True, rows=xyz64,
        columns=[Column(n, "1", m, s) for n, m, s in zip(("x_bar", "y_bar", "z_bar"), meaning_of_observer("10-degree"),
                 ("116.648519508908", "116.661877102312", "116.673980514647"), strict=True)],
        spots=[Spot(479, "x_bar", "0.089388", "sample row of the CIE data set"), Spot(479, "y_bar", "0.245997", "sample row of the CIE data set"),
               Spot(479, "z_bar", "0.81828", "sample row of the CIE data set"), Spot(579, "x_bar", "1.00191", "sample row of the CIE data set"),
               Spot(579, "y_bar", "0.877986", "sample row of the CIE data set")],
        note="z_bar from 560 nm is blank in the standard, 0 here."))
    for n, table, doi, sha, sums, sample in (
        (2, "10.7a", "10.25039/CIE.DS.548rw69q", "a10751ec8aecdb023f16ba079557e7fb794806884fe3da982dd63da285f872a9",
         ("113.042318330084", "113.0423145713364", "113.04231479170"), ("0.01190224", "0.501143", "0.1268279")),
        (10, "10.8", "10.25039/CIE.DS.dm6qiig7", "9019a35f8f51215e245f818e87d4251147d1925a8fbe9a49944fe7f011f16e38",
         ("118.518090897436", "118.5180915321789", "118.518095303296"), ("0.0319991", "0.6096388", "0.09682266")),
    ):  # fmt: skip
        agree(f"2015 {n} degrees", xyz15[n], of_colour(cmfs[f"CIE 2015 {n} Degree Standard Observer"]), within=1.001e-7)
        names = ("x_bar", "y_bar", "z_bar")
        out.append(Table(
            name=f"cie-2015-{n}deg", file=f"cie/xyz_2015_{n}deg.csv",
            title=f"CIE cone-fundamental-based spectral tristimulus values for {n}-degree field size",
            standard=f"CIE 170-2:2015 Table {table}", doi=doi,
            origin=f"{LUXPY}: data/cmfs/ciexyz_2015_{n}.dat",
            checked=f"equal to {COLOUR} MSDS_CMFS['CIE 2015 {n} Degree Standard Observer'] but for "
                    + ("five values" if n == 2 else "one value") + " one unit in the seventh digit apart; "
                    "luxpy's file is the CIE's own but for its line ends (publisher_sha256)",
            publisher_sha256=published_file(f"data/cmfs/ciexyz_2015_{n}.dat", sha),
            licence=CC_BY_SA, smooth=True, rows=xyz15[n],
            columns=[Column(c, "1", m, s) for c, m, s in zip(names, meaning_of_observer(f"{n}-degree"), sums, strict=True)],
            spots=[Spot(509, c, x, "sample row of the CIE data set") for c, x in zip(names, sample, strict=True)],
            note="The CIE asks for the defining formula between the wavelengths, not for a line."))

    # The cone fundamentals are in one package only; the colour-matching functions of 2015 are made from them, so the
    # published matrices (CIE 170-2:2015, 7.3.1 and 7.3.2) must lead from these to those.
    to_xyz = {
        2: ((1.94735469, -1.41445123, 0.36476327), (0.68990272, 0.34832189, 0.0), (0.0, 0.0, 1.93485343)),
        10: ((1.93986443, -1.34664359, 0.43044935), (0.69283932, 0.34967567, 0.0), (0.0, 0.0, 2.14687945)),
    }
    for n, table, doi in ((2, "6.7", "10.25039/CIE.DS.tijidesg"), (10, "6.2", "10.25039/CIE.DS.nxsqeri8")):
        lms = of_colour(cmfs[f"Stockman & Sharpe {n} Degree Cone Fundamentals"])
        made = {w: [Decimal(sum(m * float(x) for m, x in zip(row, r, strict=True))) for row in to_xyz[n]] for w, r in lms.items()}
        agree(f"cone fundamentals {n} degrees by the matrix", made, xyz15[n], within=2e-6)
        out.append(Table(
            name=f"stockman-sharpe-{n}deg", aliases=[f"lms-{n}deg"], file=f"cvrl/lms_stockman_sharpe_{n}deg.csv",
            title=f"Stockman and Sharpe cone fundamentals, {n}-degree field, in terms of energy",
            standard=f"CIE 170-1:2006 Table {table}", doi=doi, reference="Stockman and Sharpe 2000, Vision Research 40, 1711-1737",
            origin=f"{COLOUR}: colorimetry.MSDS_CMFS['Stockman & Sharpe {n} Degree Cone Fundamentals']",
            checked=f"through the matrix of CIE 170-2:2015 they give cie-2015-{n}deg within 2e-6"
                    + ("; the l, m and s of cie-s026 are the same digits" if n == 10 else ""),
            licence=FACTS, smooth=True, rows=lms,
            columns=[Column(f"{c}_bar", "1", f"{c.upper()}-cone fundamental, {n}-degree field") for c in "lms"],
            spots=[Spot(545, c, x, "sample row of the CIE data set, to six digits") for c, x in zip(
                ("l_bar", "m_bar", "s_bar"), ("0.92666", "0.991383", "0.00175573"), strict=True)] if n == 10 else [
                Spot(390, "l_bar", "0.000415003", "CVRL, as carried by colour-science"), Spot(390, "s_bar", "0.00954729", "CVRL, as carried by colour-science")],
            note="Linear energy, each with maximum 1; s_bar from 616 nm is not tabulated, 0 here."
                 + (" The CIE's 5 nm table carries more digits and another rounding: its sums differ by 3e-6." if n == 2 else "")))

    # -------------------------------------------------------------------------------- illuminants

    a = illuminant_a()
    agree("A formula against colour", a, of_colour(lamps["A"]))
    agree("A formula against luxpy", a, of_luxpy("data/spds/CIE_A.csv"))
    out.append(Table(
        name="cie-illuminant-a", aliases=["illuminant-a"], file="cie/illuminant_a.csv",
        title="CIE standard illuminant A, relative spectral distribution",
        standard="ISO/CIE 11664-2:2022 Table A.1", doi="10.25039/CIE.DS.8jsxjrsn",
        origin="ISO/CIE 11664-2:2022 equation 1 (2848 K with c2 = 1.435e-2 m K), rounded to six significant digits",
        checked=f"equal to {COLOUR} (5 nm) and {LUXPY} (1 nm) where they have a value; {SAME_FILE}",
        publisher_sha256=published("cie-illuminant-a", a, plain, "61ef23fe146b8b665c74706717ab28cec7db6c9022993490bdc71991f43cb59b"),
        licence=CC_BY_SA, smooth=True, rows=a, columns=[Column("A", "1", "relative spectral distribution, 100 at 560 nm")],
        spots=[Spot(560, "A", "100", "ISO/CIE 11664-2:2022"), Spot(419, "A", "20.647", "sample row of the CIE data set"),
               Spot(300, "A", "0.930483", "CIE 015:2018 Table 5"), Spot(780, "A", "241.675", "CIE 015:2018 Table 5")],
        note="The column sum in the first revision of the CIE's metadata (60210.114316) does not belong to its file; the file and these "
             "numbers sum to 60250.921916."))

    d50 = linear(daylight(5000), 5, 6, ROUND_HALF_EVEN)
    agree("D50 against colour", d50, of_colour(lamps["D50"]), within=5.01e-4, except_at={555: 1e-3})  # 101.1585
    out.append(Table(
        name="cie-illuminant-d50", aliases=["illuminant-d50", "d50"], file="cie/illuminant_d50.csv",
        title="CIE standard illuminant D50, relative spectral distribution, 1 nm",
        standard="ISO/CIE 11664-2:2022 Table B.1", doi="10.25039/CIE.DS.etgmuqt5",
        origin="CIE 015:2018 equations 4.7 to 4.11 on cie-daylight-components, straight lines between, six significant digits",
        checked=f"equal to {COLOUR} SDS_ILLUMINANTS['D50'] (5 nm, three decimals) within a unit of its last digit; {SAME_FILE}",
        publisher_sha256=published("cie-illuminant-d50", d50, plain, "b23049c6f7b266c1c1fbe147aa271e8930ca02d6e569c5ae1804c036faea4193"),
        licence=CC_BY_SA, rows=d50, columns=[Column("D50", "1", "relative spectral distribution, 100 at 560 nm", "39484.934570")],
        spots=[Spot(560, "D50", "100", "ISO/CIE 11664-2:2022"), Spot(419, "D50", "59.6817", "sample row of the CIE data set")]))

    d65_5nm = of_colour(lamps["D65"])
    d65_lux = of_luxpy("data/spds/CIE_D65.csv")
    agree("D65 colour and luxpy", d65_5nm, d65_lux)
    d65 = linear({**every(d65_5nm, 10), **every(d65_lux, 10)}, 10, 6, ROUND_HALF_DOWN)
    agree("D65 by lines against luxpy", d65, d65_lux)
    agree("D65 by lines against colour", d65, d65_5nm)
    out.append(Table(
        name="cie-illuminant-d65", aliases=["illuminant-d65", "d65"], file="cie/illuminant_d65.csv",
        title="CIE standard illuminant D65, relative spectral distribution, 1 nm",
        standard="ISO/CIE 11664-2:2022 Table B.1", doi="10.25039/CIE.DS.hjfjmt59",
        origin=f"{COLOUR} SDS_ILLUMINANTS['D65'] and {LUXPY} data/spds/CIE_D65.csv every 10 nm, straight lines between, six significant digits",
        checked=f"equal to {LUXPY} at every nanometre from 360 nm and to {COLOUR} every 5 nm; {SAME_FILE}",
        publisher_sha256=published("cie-illuminant-d65", d65, plain, "e76f210bffff3d552ef7113025da5f325d5dfec200dd4b878b1a2f3a507032cb"),
        licence=CC_BY_SA, rows=d65, columns=[Column("D65", "1", "relative spectral distribution, 100 at 560 nm", "40852.20400")],
        spots=[Spot(560, "D65", "100", "ISO/CIE 11664-2:2022"), Spot(419, "D65", "93.2372", "sample row of the CIE data set"),
               Spot(300, "D65", "0.0341", "CIE 015:2018 Table 5")]))

    d60 = daylight(6000)
    agree("D60", d60, of_colour(lamps["D60"]), within=1e-9)
    grid = range(300, 785, 5)
    equal = {w: [Decimal(100)] for w in grid}
    agree("E", equal, of_colour(lamps["E"]))
    names = ["A", "C", "D50", "D55", "D60", "D65", "D75", "E", "ID50", "ID65"]
    parts = [d60 if n == "D60" else equal if n == "E" else of_colour(lamps[n]) for n in names]
    for n, digits, sha in (
        ("C", 2, "51c53bf065345fc1fb9d50aff40fb0a2ce370bcf35121a3dc4bafc0888602f0b"),
        ("D55", 3, "3e5aa1a8d5514df1928effef1615ab90e16c9a368ccfe513372cd8556c37bf4b"),
        ("D75", 3, "573a08831f2bcdf18a8e333490049e6d0fabaf1d1c0abbc2a49d6247a939b62d"),
        ("ID50", 2, "70541ed195eb91066d3a986d8d5cdd3cbfb2ab963f713022d2a88dfd59b849e2"),
        ("ID65", 2, "be1dc615b4b03e0b4b3e294660101526a30ed17dc800e85786c29759b3dcb7a6"),
    ):  # fmt: skip
        published(f"cie-illuminants {n}", of_colour(lamps[n]), fixed(digits), sha)
    agree("C", of_colour(lamps["C"]), of_luxpy("data/spds/CIE_C.csv"))
    for n, cct in (("D50", 5000), ("D55", 5500), ("D75", 7500)):
        agree(n, of_colour(lamps[n]), daylight(cct), within=5.01e-4)
    agree("A 5 nm", of_colour(lamps["A"]), a)
    meaning = {"A": "standard illuminant A", "C": "illuminant C", "E": "equal-energy spectrum",
               "ID50": "indoor daylight ID50", "ID65": "indoor daylight ID65"}
    sums = {"C": "7327.20", "D55": "7276.149", "D75": "8017.755", "ID50": "6820.49", "ID65": "7122.09"}
    out.append(Table(
        name="cie-illuminants", aliases=["illuminants"], file="cie/illuminants_5nm.csv",
        title="CIE illuminants A, C, D50, D55, D60, D65, D75, E, ID50 and ID65, relative spectral distributions, 5 nm",
        standard="CIE 015:2018 Table 5; CIE 184:2009 Table 2 (ID50, ID65)", doi="10.25039/TR.015.2018",
        reference="CIE data sets 10.25039/CIE.DS.mjdd2enu (C), .qewfb3kp (D55), .9fvcmrk4 (D75), .r4gcnrzc (ID50), .bd53qdqk (ID65)",
        origin=f"{COLOUR}: colorimetry.SDS_ILLUMINANTS; D60 by CIE 015:2018 equations 4.7 to 4.11 on cie-daylight-components; E is 100",
        checked=f"A, C and D65 equal {LUXPY}; D50, D55 and D75 equal the daylight formula to their three decimals, D60 equals {COLOUR}; "
                "C, D55, D75, ID50 and ID65 give the CIE's own files byte for byte, D65 its 1 nm file at these wavelengths",
        licence=CC_BY_SA, rows={w: r for w, r in beside(*parts).items() if w in grid},
        columns=[Column(n, "1", f"relative spectral distribution of {meaning.get(n, 'daylight ' + n)}", sums.get(n)) for n in names],
        spots=[Spot(560, n, "100", "CIE 015:2018 Table 5: normalised at 560 nm") for n in ("A", "D50", "D55", "D65", "D75")]
              + [Spot(445, "C", "123.45", "sample row of the CIE data set"), Spot(425, "D55", "69.746", "sample row of the CIE data set"),
                 Spot(425, "D75", "107.945", "sample row of the CIE data set"), Spot(365, "ID50", "22.5", "sample row of the CIE data set"),
                 Spot(365, "ID65", "43.65", "sample row of the CIE data set"), Spot(780, "A", "241.675", "CIE 015:2018 Table 5")],
        note="D60 is not a CIE standard illuminant; it is the CIE daylight of 6000 K (6003.3 K on today's scale)."))

    b = of_colour(lamps["B"])
    agree("B", b, of_luxpy("data/spds/CIE_B.csv"))
    out.append(Table(
        name="cie-illuminant-b", aliases=["illuminant-b"], file="cie/illuminant_b.csv",
        title="CIE illuminant B (withdrawn), relative spectral distribution",
        standard="CIE 015:2004, withdrawn from later editions", reference="Wyszecki and Stiles 1982, Color Science, Table II(3.3.4)",
        origin=f"{COLOUR}: colorimetry.SDS_ILLUMINANTS['B']", checked=f"equal to {LUXPY} data/spds/CIE_B.csv from 360 nm",
        licence=FACTS, rows=b, columns=[Column("B", "1", "relative spectral distribution")],
        spots=[Spot(560, "B", "102.8", "Wyszecki and Stiles 1982"), Spot(320, "B", "0.02", "Wyszecki and Stiles 1982")]))

    fl = [f"FL{i}" for i in range(1, 13)] + [f"FL3.{i}" for i in range(1, 16)]
    hp = [f"HP{i}" for i in range(1, 6)]
    led = [*(f"LED-B{i}" for i in range(1, 6)), "LED-BH1", "LED-RGB1", "LED-V1", "LED-V2"]
    fl_rows, hp_rows, led_rows = (of_colour(*(lamps[n] for n in group)) for group in (fl, hp, led))
    agree("FL", fl_rows, beside(of_luxpy("data/spds/CIE_F_1to12.csv"), of_luxpy("data/spds/CIE_F3_1to15.csv")))
    agree("HP", hp_rows, of_luxpy("data/spds/CIE_HP_1to5.csv"))
    agree("LED", led_rows, of_luxpy("data/spds/CIE_LED_B1toB5_BH1_RGB1_V1_V2.csv"))
    published("FL", fl_rows, fixed(2), "24303adacbfee5e19b2123ea2c3208a993577a054abaf55ea7e19517f98e4d55")
    published("HP", hp_rows, fixed(2), "035e09d62b27f4b1e362ff1ba99a50235f0d7886c2781c50d49851b6e4bb4552")
    published("LED", led_rows, fixed(2), "6147313bd1ec570ef308df222e1fe1e58115fde1ad0a7d4ba91fb9dcb776b267")
    fl_kind = {**dict.fromkeys(fl[:6], "fluorescent lamp, standard"), **dict.fromkeys(fl[6:9], "fluorescent lamp, broad-band"),
               **dict.fromkeys(fl[9:12], "fluorescent lamp, narrow-band"), **dict.fromkeys(fl[12:15], "fluorescent lamp, standard halophosphate"),
               **dict.fromkeys(fl[15:18], "fluorescent lamp, DeLuxe"), **dict.fromkeys(fl[18:23], "fluorescent lamp, three-band"),
               **dict.fromkeys(fl[23:26], "fluorescent lamp, multi-band"), fl[26]: "fluorescent lamp, D65 simulator"}
    hp_kind = {"HP1": "high-pressure sodium lamp", "HP2": "colour-enhanced high-pressure sodium lamp",
               **dict.fromkeys(hp[2:], "metal halide lamp")}
    led_kind = {**dict.fromkeys(led[:5], "blue-pumped phosphor LED"), "LED-BH1": "hybrid LED, blue-pumped phosphor and red",
                "LED-RGB1": "RGB LED", "LED-V1": "violet-pumped phosphor LED", "LED-V2": "violet-pumped phosphor LED"}
    kinds = {**fl_kind, **hp_kind, **led_kind}
    lamp_sums = dict(zip([*fl, *hp, *led], (
        "684.33 594.50 556.19 540.17 664.37 565.79 788.90 789.42 743.46 615.56 594.08 566.76 2705.00 3232.05 3342.02 3891.36 3961.43 "
        "3925.64 2824.99 2930.19 3062.75 809.69 3175.14 3422.09 3520.19 3684.53 29041 "
        "2534.73 4929.55 3329.71 3591.43 3885.13 641.70 637.35 631.14 626.54 655.25 579.31 686.37 849.68 812.08").split(), strict=True))
    out.append(Table(
        name="cie-fl-hp-led", aliases=["lamps", "cie-lamps"], file="cie/illuminants_fl_hp_led.csv",
        title="CIE illuminants representing fluorescent (FL), high-pressure discharge (HP) and LED lamps, relative spectral distributions",
        standard="CIE 015:2018 Tables 10.1 to 10.3 (FL), 11 (HP), 12.1 and 12.2 (LED)", doi="10.25039/TR.015.2018",
        reference="CIE data sets 10.25039/CIE.DS.ukaymjdn (FL), .f6rvvnev (HP), .vgssnyfg (LED)",
        origin=f"{COLOUR}: colorimetry.SDS_ILLUMINANTS",
        checked=f"equal to {LUXPY} data/spds; the digits give the CIE's three files (FL, HP, LED) byte for byte",
        licence=CC_BY_SA, rows=beside(fl_rows, hp_rows, led_rows),
        columns=[Column(n, "1", f"relative spectral distribution, {kinds[n]}", lamp_sums[n]) for n in [*fl, *hp, *led]],
        spots=[Spot(445, "FL1", "10.72", "sample row of the CIE data set"), Spot(445, "FL2", "6.27", "sample row of the CIE data set"),
               Spot(445, "FL12", "2.65", "sample row of the CIE data set"), Spot(445, "FL3.15", "343", "sample row of the CIE data set"),
               Spot(520, "HP1", "2.1", "sample row of the CIE data set"), Spot(520, "HP5", "48.7", "sample row of the CIE data set"),
               Spot(520, "LED-B1", "7.98", "sample row of the CIE data set"), Spot(520, "LED-V2", "12.74", "sample row of the CIE data set")],
        note="Lamp lines are spread over the 5 nm steps; the scales of the series differ and are the CIE's. Names such as F2 for FL2 are older."))

    l41 = of_luxpy("data/spds/CIE_L41.csv")
    out.append(Table(
        name="cie-l41", aliases=["l41", "cie-reference-spectrum-l41"], file="cie/l41.csv",
        title="CIE reference spectrum L41 for photometer calibration with LEDs, relative spectral distribution",
        standard="CIE 251:2023 Table 1", doi="10.25039/CIE.DS.van56dfj",
        origin=f"{LUXPY}: data/spds/CIE_L41.csv",
        checked="no second source: sums to 3162.46707 where the CIE's data set sums to 3162.483031 (5e-6 more), which also has a sixth "
                "decimal (372 nm: 0.000525, here 0.00052)",
        licence=CC_BY_SA, rows=l41, columns=[Column("L41", "1", "relative spectral distribution of reference spectrum L41")],
        spots=[Spot(448, "L41", "19.18326", "luxpy 1.12.5"), Spot(372, "L41", "0.00052", "CIE data set 0.000525, cut to five decimals")],
        note="Rounded to five decimals by luxpy."))

    s = of_colour(*(colour.colorimetry.SDS_BASIS_FUNCTIONS_CIE_ILLUMINANT_D_SERIES[k] for k in ("S0", "S1", "S2")))
    agree("S0 S1 S2", s, of_luxpy("data/spds/S0123_daylight_phase_5nm.csv", columns=slice(3)))
    out.append(Table(
        name="cie-daylight-components", aliases=["daylight-components", "s0s1s2"], file="cie/daylight_s0_s1_s2.csv",
        title="Components S0, S1, S2 of the relative spectral distribution of daylight",
        standard="CIE 015:2018 Table 6", doi="10.25039/CIE.DS.w7zunnny",
        origin=f"{COLOUR}: colorimetry.SDS_BASIS_FUNCTIONS_CIE_ILLUMINANT_D_SERIES",
        checked=f"equal to {LUXPY} data/spds/S0123_daylight_phase_5nm.csv; {SAME_FILE}",
        publisher_sha256=published("cie-daylight-components", s, fixed(2), "4056cf7c1afb23fb8820ff9cbc383a80005acdffe1c0a6945c6032616e08c6be"),
        licence=CC_BY_SA, rows=s,
        columns=[Column("S0", "1", "mean of measured daylights", "8715.51"), Column("S1", "1", "first component: yellow against blue", "890.13"),
                 Column("S2", "1", "second component: pink against green", "374.95")],
        spots=[Spot(445, "S0", "119.75", "sample row of the CIE data set"), Spot(445, "S1", "36.3", "sample row of the CIE data set"),
               Spot(445, "S2", "-2.75", "sample row of the CIE data set"), Spot(560, "S0", "100", "CIE 015:2018 Table 6"),
               Spot(560, "S1", "0", "CIE 015:2018 Table 6")],
        note="Given every 10 nm by Judd, MacAdam and Wyszecki (1964); the 5 nm values are straight lines."))

    # -------------------------------------------------------------------------------- samples

    tcs_names = [f"TCS{i:02}" for i in range(1, 15)]
    samples = colour.quality.SDS_TCS["CIE 1995"]
    tcs = of_colour(*(samples[n] for n in tcs_names))
    agree("TCS", tcs, of_luxpy("data/rfls/CIE_13_3_1995_R14.dat"))
    munsell = ("7.5 R 6/4", "5 Y 6/4", "5 GY 6/8", "2.5 G 6/6", "10 BG 6/4", "5 PB 6/8", "2.5 P 6/8", "10 P 6/8", "4.5 R 4/13", "5 Y 8/10",
               "4.5 G 5/8", "3 PB 3/11", "5 YR 8/4", "5 GY 4/4")
    tcs_sums = "33.215 24.252 26.713 19.393 25.560 34.759 41.443 46.683 37.916 48.787 18.613 20.974 54.325 14.798".split()
    out.append(Table(
        name="cie-tcs", aliases=["tcs", "cie-13.3"], file="cie/tcs01_14.csv",
        title="Test-colour samples 1 to 14 of the CIE colour rendering index, spectral radiance factors",
        standard="CIE 013.3-1995 Tables 1 and 2", doi="10.25039/CIE.DS.wuiuu9cz",
        origin=f"{COLOUR}: quality.SDS_TCS['CIE 1995']",
        checked=f"equal to {LUXPY} data/rfls/CIE_13_3_1995_R14.dat; {SAME_FILE}",
        publisher_sha256=published("cie-tcs", tcs, plain, "f461decedb5c18800c61a6923240c71f6cf91fd23ac94865133cbfdb7e05c0ad"),
        licence=CC_BY_SA, rows=tcs,
        columns=[Column(n, "1", f"spectral radiance factor, about Munsell {m}", x) for n, m, x in zip(tcs_names, munsell, tcs_sums, strict=True)],
        spots=[Spot(475, n, x, "sample row of the CIE data set") for n, x in zip(tcs_names, (
            "0.214 0.143 0.094 0.254 0.41 0.531 0.429 0.366 0.031 0.125 0.167 0.328 0.389 0.052").split(), strict=True)]))

    ces = colour_file("quality/datasets/tcs_cfi2017_1_nm.csv.gz")
    agree("CES 5 nm is a part of 1 nm (colour)", ces, colour_file("quality/datasets/tcs_cfi2017_5_nm.csv.gz"))
    agree("CES 5 nm is a part of 1 nm (luxpy)", ces, of_luxpy("data/rfls/CIE224_2017_R99_5nm.dat"))
    agree("CES CIE 224", ces, of_luxpy("data/rfls/CIE224_2017_R99_1nm.dat"))
    agree("CES TM-30-18", ces, of_luxpy("data/rfls/IESTM30_18_R99_1nm.dat"))
    out.append(Table(
        name="ies-ces99", aliases=["ces99", "cie-224-ces99", "tm30-ces"], file="ies/ces99_1nm.csv",
        title="The 99 colour evaluation samples of ANSI/IES TM-30 and CIE 224, spectral radiance factors, 1 nm",
        standard="CIE 224:2017 (calculator V.3, 1 nm); the same samples as ANSI/IES TM-30-18, -20 and -24", doi="10.25039/CIE.DS.8svs5rqd",
        origin=f"{COLOUR}: quality/datasets/tcs_cfi2017_1_nm.csv.gz",
        checked=f"equal to {LUXPY} data/rfls/CIE224_2017_R99_1nm.dat and IESTM30_18_R99_1nm.dat; {SAME_FILE}",
        publisher_sha256=published("ies-ces99", ces, plain, "32327de84b4bb8715a2b2f1bce3f5d2eca6276a44bde19c93c6f0aad5742db63"),
        licence=CC_BY_SA, rows=ces,
        columns=[Column(f"CES{i:02}", "1", f"spectral radiance factor, sample {i}") for i in range(1, 100)],
        spots=[Spot(449, "CES01", "0.631978128", "sample row of the CIE data set"), Spot(449, "CES50", "0.13928848", "sample row of the CIE data set"),
               Spot(449, "CES99", "0.194289616", "sample row of the CIE data set")],
        note="The 5 nm table of the same samples is exactly every fifth row of this one, so it is not shipped. The table of "
             "TM-30-15 differs; luxpy's '...from_excel_calculator' file interpolates otherwise and differs by up to 0.0065."))

    # -------------------------------------------------------------------------------- action spectra

    s026 = of_luxpy("toolboxes/photbiochem/data/S026_Table2_Data_downloaded_04062025.csv", header=1, columns=slice(5))
    lms10 = of_colour(cmfs["Stockman & Sharpe 10 Degree Cone Fundamentals"])
    agree("S 026 cones", column(s026, 2, 1, 0), lms10)
    agree("S 026 rhodopic", column(s026, 3), scotopic)
    toolbox = parse((luxpy_folder() / "toolboxes/photbiochem/data/cie_S026_2018_SI_action_spectra_CIEToolBox_v1.049a_20_11.csv")
                    .read_text(encoding="utf-8-sig").replace("nan", ""), header=1)
    agree("S 026 against the CIE toolbox", column(s026, 0, 1, 2, 4), column(toolbox, 0, 1, 2, 4))
    agree("S 026 rhodopic against the CIE toolbox", column(s026, 3), column(toolbox, 3), within=5.001e-4)
    out.append(Table(
        name="cie-s026", aliases=["alpha-opic", "s026"], file="cie/s026_alpha_opic.csv",
        title="CIE alpha-opic action spectra",
        standard="CIE S 026:2018 Table 2", doi="10.25039/CIE.DS.vqqhzp5a",
        origin=f"{LUXPY}: toolboxes/photbiochem/data/S026_Table2_Data_downloaded_04062025.csv",
        checked="the cone columns are the digits of stockman-sharpe-10deg, the rhodopic column those of cie-1951-v-prime; all but the rhodopic "
                "column equal the CIE's toolbox 1.049a and sum to what the CIE publishes, to the last digit",
        licence=CC_BY_SA, smooth=True, rows=s026,
        columns=[Column("s_cone_opic", "1", "S-cone-opic action spectrum", "55.20481795993"),
                 Column("m_cone_opic", "1", "M-cone-opic action spectrum", "101.93985505123"),
                 Column("l_cone_opic", "1", "L-cone-opic action spectrum", "119.6121622561"),
                 Column("rhodopic", "1", "rhodopic action spectrum, V'(lambda)"),
                 Column("melanopic", "1", "melanopic action spectrum", "87.6753991157421")],
        spots=[Spot(499, "s_cone_opic", "0.103934", "sample row of the CIE data set"), Spot(499, "m_cone_opic", "0.57715", "sample row of the CIE data set"),
               Spot(499, "l_cone_opic", "0.379907", "sample row of the CIE data set"), Spot(499, "rhodopic", "0.976", "sample row of the CIE data set"),
               Spot(499, "melanopic", "0.972451", "sample row of the CIE data set"), Spot(490, "melanopic", "1", "CIE S 026:2018: the maximum")],
        note="Order S, M, L, rhodopic, melanopic as in the standard. Blank cells of the standard (cones below 390 nm, S from 616 nm) are 0. The "
             "CIE's data set prints the rhodopic column to three digits (sum 97.0733041); here it has V'(lambda)'s four (sum 97.071316574)."))

    blh = blue_light_hazard()
    reference = {w: [number(x)] for w, x in lux_blue_light().items()}
    agree("blue light against luxpy", {w: r for w, r in blh.items() if w >= 380}, reference, within=2e-15)
    out.append(Table(
        name="icnirp-blue-light-hazard", aliases=["blue-light-hazard", "b-lambda"], file="icnirp/blue_light_hazard.csv",
        title="Blue-light hazard weighting function B(lambda)",
        standard="IEC 62471:2006 / CIE S 009:2002 Table 4.2", doi="10.1097/HP.0b013e318289a611",
        reference="ICNIRP 2013, Guidelines on limits of exposure to incoherent visible and infrared radiation, Health Physics 105, 74-96, Table 2",
        origin="values of IEC 62471:2006 Table 4.2 to 500 nm with straight lines between them; 10^((450 - lambda)/50) from 500 to 600 nm; "
               "0.001 from 600 to 700 nm",
        checked=f"equal to {LUXPY} toolboxes/photbiochem from 380 nm; three public transcriptions of the table agree",
        licence=FACTS, rows=blh, columns=[Column("B", "1", "blue-light hazard weight")],
        spots=[Spot(300, "B", "0.01", "IEC 62471:2006 Table 4.2"), Spot(380, "B", "0.01", "IEC 62471:2006 Table 4.2"),
               Spot(385, "B", "0.013", "IEC 62471:2006 Table 4.2"), Spot(435, "B", "1", "IEC 62471:2006 Table 4.2"),
               Spot(450, "B", "0.94", "IEC 62471:2006 Table 4.2"), Spot(500, "B", "0.1", "IEC 62471:2006 Table 4.2"),
               Spot(550, "B", "0.01", "IEC 62471:2006 Table 4.2"), Spot(700, "B", "0.001", "IEC 62471:2006 Table 4.2")],
        note="ICNIRP 2013 prints 0.0125 at 385 nm. Printed 1 at 435 and 440 nm. luxpy extrapolates below 380 nm to zero; the standard "
             "has 0.01 down to 300 nm. For the aphakic eye another function applies."))

    table = "IEC 62471:2006 Table 4.2"
    out.append(Table(
        name="icnirp-retinal-thermal-hazard", aliases=["retinal-thermal-hazard", "burn-hazard", "r-lambda"], file="icnirp/retinal_thermal_hazard.csv",
        title="Retinal thermal (burn) hazard weighting function R(lambda)",
        standard="IEC 62471:2006 / CIE S 009:2002 Table 4.2", doi="10.1097/HP.0b013e318289a611",
        reference="ICNIRP 2013, Guidelines on limits of exposure to incoherent visible and infrared radiation, Health Physics 105, 74-96, Table 2",
        origin="values of IEC 62471:2006 Table 4.2 to 500 nm with straight lines between them; 1 from 500 to 700 nm; 10^((700 - lambda)/500) from 700 to "
               "1050 nm; 0.2 from 1050 to 1150 nm; 0.2*10^(0.02(1150 - lambda)) from 1150 to 1200 nm; 0.02 from 1200 to 1400 nm",
        checked="two public transcriptions of the standard agree on every piece; the values to 495 nm are ten times those of B(lambda)",
        licence=FACTS, rows=retinal_thermal_hazard(), columns=[Column("R", "1", "retinal thermal hazard weight")],
        spots=[Spot(380, "R", "0.1", table), Spot(385, "R", "0.13", table), Spot(435, "R", "10", table), Spot(450, "R", "9.4", table),
               Spot(495, "R", "1.6", table), Spot(500, "R", "1", table), Spot(700, "R", "1", table),
               Spot(850, "R", "0.501187233627272", "isetcam, s_safetyHazardFunctions.m"), Spot(1175, "R", "0.0632455532033676", "isetcam, s_safetyHazardFunctions.m"),
               Spot(1400, "R", "0.02", table)],
        note="Printed 10 at 435 and 440 nm. ICNIRP 2013 divides the values up to 430 nm by ten and has 1 from there to 700 nm, with other limits; "
             "those of IEC 62471 and Directive 2006/25/EC go with this table."))

    uv = actinic_uv_hazard()
    for w, (x,) in uv.items():  # ICNIRP 2004, equations 2a to 2c, which are approximate
        if w >= 210:
            formula = (0.959 ** (270 - w) if w <= 270 else 1 - 0.36 * ((w - 270) / 20) ** 1.64 if w <= 300
                       else 0.3 * 0.736 ** (w - 300) + 10 ** (2 - 0.0163 * w))
            if abs(float(x) / formula - 1) > 0.33:
                fail(f"actinic UV: {w} nm is {x}, ICNIRP's formula gives {formula:g}")
    out.append(Table(
        name="icnirp-actinic-uv-hazard", aliases=["actinic-uv-hazard", "uv-hazard", "s-lambda"], file="icnirp/actinic_uv_hazard.csv",
        title="Actinic ultraviolet hazard weighting function S(lambda), relative spectral effectiveness",
        standard="ICNIRP 2004 Table 1; IEC 62471:2006 Table 4.1",
        reference="ICNIRP 2004, Guidelines on limits of exposure to ultraviolet radiation of wavelengths between 180 nm and 400 nm, Health Physics 87, 171-186",
        origin="the 56 values of ICNIRP 2004 Table 1; between them straight lines in ln S, six significant digits",
        checked="three public transcriptions of the 56 values agree; a public 1 nm list (apparently Directive 2006/25/EC, Table 1.2) agrees to "
                "its digits but for 221-224, 226-229 and 231-234 nm, where it is up to 0.7 % higher; ICNIRP's equations 2a to 2c, which are approximate, within 33 %",
        licence=FACTS, rows=uv, columns=[Column("S", "1", "actinic ultraviolet hazard weight")],
        interpolation="log-linear",
        spots=[Spot(180, "S", "0.012", "ICNIRP 2004 Table 1"), Spot(254, "S", "0.5", "ICNIRP 2004 Table 1"), Spot(270, "S", "1", "ICNIRP 2004 Table 1"),
               Spot(300, "S", "0.3", "ICNIRP 2004 Table 1"), Spot(313, "S", "0.006", "ICNIRP 2004 Table 1"), Spot(400, "S", "0.00003", "ICNIRP 2004 Table 1"),
               Spot(222, "S", "0.131203", "log-linear between 0.120 at 220 nm and 0.150 at 225 nm")]))

    out.append(Table(
        name="mccree-1972-rqe", aliases=["mccree", "rqe"], file="mccree/rqe_1972.csv",
        title="Relative quantum yield of photosynthesis of crop plants grown in chambers (McCree curve)",
        standard="McCree 1972 Table III, mean", doi="10.1016/0002-1571(71)90022-7",
        reference="McCree 1972, The action spectrum, absorptance and quantum yield of photosynthesis in crop plants, Agricultural Meteorology 9, 191-216",
        origin="values of the publication",
        checked="two public transcriptions: one equal, a finer one within 0.01 at every wavelength",
        licence=FACTS, rows={w: [Decimal(x)] for w, x in MCCREE.items()},
        columns=[Column("rqe", "1", "relative quantum yield per incident photon, growth-chamber mean")],
        spots=[Spot(600, "rqe", "1", "McCree 1972 Table III"), Spot(450, "rqe", "0.75", "McCree 1972 Table III"), Spot(700, "rqe", "0.44", "McCree 1972 Table III")],
        note="Per photon, not per watt. Printed 1 at 600 and 625 nm. The field-grown means (Table IV) could not be confirmed by a second source."))
    out += [metal(symbol) for symbol in METALS]
    return out


def lux_blue_light() -> dict[int, float]:
    """luxpy's B(lambda), its own function: colour has to be imported before it."""
    import luxpy.toolboxes.photbiochem.blue_light_hazard_IEC62471_IECTR62778 as module

    return {int(w): float(x) for w, x in zip(*module._BLH, strict=True)}


# ------------------------------------------------------------------------------------------------ example spectra


def band(w: np.ndarray, centre: float, left: float, right: float) -> np.ndarray:
    """A bell with its own width on each side."""
    return np.exp(-0.5 * ((w - centre) / np.where(w < centre, left, right)) ** 2)


def spectra(all_tables: list[Table]) -> dict[str, str]:
    """Synthetic spectra for a first try; described in data/README.md."""
    v_table = next(t for t in all_tables if t.name == "cie-1924-v").rows
    km = 683.002

    def photometric(w: np.ndarray, s: np.ndarray) -> float:
        step = float(w[1] - w[0])
        return km * step * sum(float(v_table[int(x)][0]) * float(y) for x, y in zip(w, s, strict=True) if int(x) in v_table)

    def text(header: str, w: np.ndarray, s: np.ndarray, target: float) -> str:
        scaled = s * (target / photometric(w, s))
        return f"wavelength [nm],{header}\n" + "".join(f"{int(x)},{plain(computed(float(y), 6))}\n" for x, y in zip(w, scaled, strict=True))

    nm = np.arange(380.0, 781.0)
    office = 1.617 * band(nm, 450, 8.5, 11.5) + 0.857 * band(nm, 520, 20, 60) + band(nm, 610, 45, 56)
    warm = 0.530 * band(nm, 452, 8, 11) + 0.543 * band(nm, 545, 30, 40) + band(nm, 625, 40, 46)
    planck = np.arange(300.0, 1105.0, 5.0)
    tungsten = planck**-5 / np.expm1(1.438776877e7 / (planck * 3000))
    sky = daylight(6500)
    grid = np.array(sorted(sky), dtype=float)
    day = np.array([float(sky[int(w)][0]) for w in grid])
    return {
        "spectra/office-led.csv": text("spectral irradiance [W/m2/nm]", nm, office, 500.0),
        "spectra/warm-led-radiance.csv": text("spectral radiance [W/m2/sr/nm]", nm, warm, 3000.0),
        "spectra/halogen-flux.csv": text("spectral flux [W/nm]", planck, tungsten, 900.0),
        "spectra/daylight-window.csv": text("spectral irradiance [W/m2/nm]", grid, day, 2000.0),
    }


# ------------------------------------------------------------------------------------------------ manifest


def quoted(text: str) -> str:
    return '"' + text.replace("\\", "\\\\").replace('"', '\\"') + '"'


def real(x: Decimal) -> str:
    text = plain(x)
    return text if "." in text else text + ".0"


def peak(rows: Rows, i: int) -> tuple[int | Decimal, Decimal]:
    """The largest value and its wavelength; the middle one where several neighbours are printed alike."""
    top = max(r[i] for r in rows.values())
    where = [w for w in sorted(rows) if rows[w][i] == top]
    return where[len(where) // 2] if len(where) % 2 else where[(len(where) - 1) // 2], top


# Tables over other arguments than the wavelength, transcribed by hand: the file is kept as it is and held to its checksum.
LOOKUPS = [
    {
        "name": "cie-117-position-index",
        "file": "cie/position_index.csv",
        "title": "Position index p of glare sources, after Guth",
        "standard": "CIE 117:1995 Table 4.1",
        "origin": "the digits of eulumdat-ugr 1.0.2 (PyPI, MIT, (c) 2026 123VincentB), but for T/R 2.7, H/R 0.6: 7.50 there is a misprint of 7.05, as its neighbours show",
        "checked": "27 factors K of CIE 190:2010 Table 2, which contain p: 25 agree in all five printed decimals, one differs by one in the last, one (x = 1.5 H, y = 4.5 H) stands out from its own neighbours",
        "licence": "published values, none stated",
        "date": "2026-11-24",
        "sha256": "0daf7de3eee732679df975f7a391f0473f9c1911bbebb56c4b1a2e7204e1f481",
        "rows": "T/R, the distance aside over the distance ahead, 0 to 3 by 0.1",
        "columns": "H/R, the height over the distance ahead, 0 to 1.9 by 0.1",
        "note": "Blank where the standard has no value.",
    },
    {
        "name": "nist-lines",
        "file": "nist/lines.csv",
        "title": "Emission lines of calibration lamps: neon, argon, krypton, cadmium, mercury",
        "standard": "NIST Atomic Spectra Database (SRD 78), neutral atoms; mercury after Sansonetti, Salit and Reader, Appl. Opt. 35, 74 (1996)",
        "origin": "the wavelengths in air that the arc lists of kspecdr (2026) quote from both; those it lacks from the wavelengths in vacuum that the line lists of PypeIt quote from NIST, brought to air with the index of Peck and Reeder (1972), as NIST does",
        "checked": "57 lines stand in both: brought to air, the wavelengths in vacuum agree with the ones in air within 5e-5 nm, half of the last digit printed; 36 more stand in one of both and 16 (cadmium, weaker neon, Hg 253.6521) in the first alone, with the same digits in other lists",
        "licence": "published values, none stated",
        "date": "2026-11-26",
        "sha256": "33df07d3edeebd19fc57f9626ec3477f5119769636b6afd4f2cf8f1f5bbc25fa",
        "rows": "one strong line each, by atomic number and wavelength",
        "columns": "atomic number; wavelength in standard air, nm",
        "note": "Strong lines between 250 and 1020 nm only; no intensities, which depend on the lamp.",
    },
    {
        "name": "ansi-c78-377",
        "file": "ansi/c78_377.csv",
        "title": "Chromaticity quadrangles of white LED products, their centres, and one-step MacAdam ellipses",
        "standard": "ANSI C78.377-2008 Table 1 and Annex; the ellipses as lamp specifications of the ENERGY STAR programme print them for three steps",
        "origin": "the digits of two public programs that agree in all 80 numbers of the quadrangles and centres common to both (a Python chromaticity plot and the LED binning of the Nimble library); the ellipses of one (a tolerance calculation for tunable white)",
        "checked": "every corner has the colour temperature and Duv of the standard's definition (nominal temperature and tolerance, Duv of the target plus or minus 0.006) within its printed digits; the ellipses of 3000, 4000 and 5000 K agree with those of IEC 60081 within 1 %, that of 6500 K within 5 %, that of 2700 K has one source and no check",
        "licence": "published values, none stated",
        "date": "2026-11-26",
        "sha256": "3f5f8a4c11eab854654cc3d8c128c7519553c41455128ff1f894cf330de01574",
        "rows": "one nominal correlated colour temperature each, K",
        "columns": "centre x, y; corners x1, y1 to x4, y4 in order round the quadrangle; of the ellipse of one step half the long and the short axis in x, y, and the angle of the long axis to x in degrees",
        "note": "No ellipse could be had for 3500, 4500 and 5700 K.",
    },
    {
        "name": "iec-60081",
        "file": "iec/60081.csv",
        "title": "Standard colours of fluorescent lamps F 2700 to F 6500 and the metric of their MacAdam steps",
        "standard": "IEC 60081 Annex D",
        "origin": "a public program that calculates steps (Python, function sdcm_cal), which has F 8000 too",
        "checked": "the colour temperatures and centres as a manufacturer's page prints them, equal; the metric of F 3000, F 4000 and F 5000 against the ellipses of ANSI C78.377 from another source, within 1 %, of F 6500 within 5 %",
        "licence": "published values, none stated",
        "date": "2026-11-26",
        "sha256": "de7bcfb9bdad35740b83023178c539ec525eeef4e8db704cdc104921ef9817ae",
        "rows": "one standard colour each: correlated colour temperature, K, and the number it is called by",
        "columns": "centre x, y; g11, g12, g22 of one step",
        "note": "The standard itself could not be had. The metric of F 2700 and F 3500 has one source.",
    },
]


def lookup(entry: dict[str, str]) -> str:
    """The text of a table kept by hand."""
    text = (ROOT / "data" / entry["file"]).read_text(encoding="utf-8")
    if hashlib.sha256(text.encode()).hexdigest() != entry["sha256"]:
        fail(f"data/{entry['file']} is not what its checksum says")
    return text


def manifest(all_tables: list[Table], texts: dict[str, str]) -> str:
    lines = ["# Made by scripts/export_tables.py; change that, not this file.", ""]
    for t in all_tables:
        grid = sorted(t.rows)
        steps = {b - a for a, b in zip(grid, grid[1:], strict=False)}
        lines += ["[[table]]", f"name = {quoted(t.name)}"]
        lines += [f"aliases = [{', '.join(map(quoted, t.aliases))}]"] if t.aliases else []
        lines += [f"file = {quoted(t.file)}", f"title = {quoted(t.title)}", f"standard = {quoted(t.standard)}"]
        lines += [f"doi = {quoted(t.doi)}"] if t.doi else []
        lines += [f"reference = {quoted(t.reference)}"] if t.reference else []
        lines += [f"origin = {quoted(t.origin)}", f"checked = {quoted(t.checked)}", f"licence = {quoted(t.licence)}"]
        if t.licence == CC_BY_SA:
            lines += [f"attribution = {quoted('International Commission on Illumination (CIE), Vienna; a header row is added here')}"]
        lines += [f"date = {quoted(EXPORTED)}", f"sha256 = {quoted(hashlib.sha256(texts[t.file].encode()).hexdigest())}"]
        lines += [f"publisher_sha256 = {quoted(t.publisher_sha256)}"] if t.publisher_sha256 else []
        lines += [f"rows = {len(grid)}", f"first_nm = {real(Decimal(grid[0]))}", f"last_nm = {real(Decimal(grid[-1]))}"]
        lines += [f"step_nm = {steps.pop()}.0"] if len(steps) == 1 else []
        lines += [f"interpolation = {quoted(t.interpolation)}", f"extrapolation = {quoted(t.extrapolation)}"]
        lines += [f"smooth = {str(t.smooth).lower()}"]
        lines += [f"breaks_nm = [{', '.join(f'{w}.0' for w in t.breaks)}]"] if t.breaks else []
        lines += [f"note = {quoted(t.note)}"] if t.note else []
        lines += ["columns = ["]
        for i, c in enumerate(t.columns):
            at, top = peak(t.rows, i)
            total = f", published_sum = {real(Decimal(c.published_sum))}" if c.published_sum else ""
            lines += [f"  {{ name = {quoted(c.name)}, unit = {quoted(c.unit)}, meaning = {quoted(c.meaning)}, peak_nm = {real(Decimal(at))}, peak = {real(top)}{total} }},"]
            if c.published_sum and sum(r[i] for r in t.rows.values()) != Decimal(c.published_sum):
                fail(f"{t.name}: {c.name} sums to {sum(r[i] for r in t.rows.values())}, the CIE publishes {c.published_sum}")
        lines += ["]", "spots = ["]
        for s in t.spots:
            i = [c.name for c in t.columns].index(s.column)
            if t.rows[s.nm][i] != Decimal(s.value):
                fail(f"{t.name}: {s.column}({s.nm}) is {t.rows[s.nm][i]}, {s.source} has {s.value}")
            lines += [f"  {{ nm = {real(Decimal(s.nm))}, column = {quoted(s.column)}, value = {real(Decimal(s.value))}, source = {quoted(s.source)} }},"]
        lines += ["]", ""]
    for entry in LOOKUPS:
        lines += ["[[lookup]]", *(f"{key} = {quoted(text)}" for key, text in entry.items()), ""]
    return "\n".join(lines)


# ------------------------------------------------------------------------------------------------ main


def build() -> dict[str, str]:
    for package, version in PINS.items():
        found = importlib.metadata.version(package)
        if found != version:
            sys.exit(f"{package} {found} is installed; {version} is needed (run scripts/venv.sh)")
    all_tables = tables()
    texts = {t.file: t.csv() for t in all_tables} | {entry["file"]: lookup(entry) for entry in LOOKUPS}
    texts["MANIFEST.toml"] = manifest(all_tables, texts)
    texts.update(spectra(all_tables))
    if FAILURES:
        sys.exit("the sources do not agree:\n  " + "\n  ".join(FAILURES))
    return texts


def main() -> int:
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("--check", action="store_true", help="compare with data/ instead of writing it; exit 1 if it differs")
    options.add_argument("--data", type=Path, default=ROOT / "data", help="the folder to write or to compare with (default: data/)")
    args = options.parse_args()
    texts = build()

    if not args.check:
        for name, text in texts.items():
            path = args.data / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text, encoding="utf-8", newline="\n")
        print(f"{len(texts)} files written to {args.data}")
        return 0

    different = 0
    with tempfile.TemporaryDirectory() as folder:
        for name, text in texts.items():
            # By way of a file, so that what is compared is what would be written.
            fresh = Path(folder) / name
            fresh.parent.mkdir(parents=True, exist_ok=True)
            fresh.write_text(text, encoding="utf-8", newline="\n")
            old = args.data / name
            if old.is_file() and old.read_bytes() == fresh.read_bytes():
                continue
            different += 1
            before = old.read_bytes().decode("utf-8", "replace").splitlines() if old.is_file() else []
            diff = list(difflib.unified_diff(before, text.splitlines(), f"data/{name}", f"exported/{name}", lineterm="", n=1))
            print("\n".join(diff[:40] if diff else [f"data/{name}: only the line ends differ"]))
            if len(diff) > 40:
                print(f"... and {len(diff) - 40} more lines")
    kept = {p.relative_to(args.data).as_posix() for p in args.data.rglob("*.csv")}
    for name in sorted(kept - set(texts)):
        different += 1
        print(f"data/{name}: not made by this script")
    print(f"{len(texts) - different} files as exported" if not different else f"{different} files differ from what scripts/export_tables.py writes")
    return 1 if different else 0


if __name__ == "__main__":
    sys.exit(main())
