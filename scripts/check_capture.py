#!/usr/bin/env python3
"""Holds the camera and the response that photopic finds to OpenCV, run live on the same photographs.

    "$(scripts/venv.sh)" scripts/check_capture.py [target/release/photopic]

calibrateCamera and undistortPoints on the left chessboard set, findChessboardCornersSB on it and on the synthetic boards, CalibrateDebevec and MergeDebevec on the memorial stack, both of
../shared/capture beside the checkout. Exit status 1 when a line fails, 2 when the photographs are not there.
"""

from __future__ import annotations

import csv
import json
import subprocess
import sys
import tempfile
from fractions import Fraction
from pathlib import Path

import cv2
import numpy as np
import OpenEXR

ROOT = Path(__file__).resolve().parent.parent
SHARED = ROOT.parent / "shared" / "capture"
failed = False


def check(what: str, difference: float, bound: float) -> None:
    """Prints one comparison and remembers whether it failed."""
    global failed
    good = difference <= bound
    failed |= not good
    print(f"{'ok  ' if good else 'FAIL'} {what}: {difference:.3g} (at most {bound:.3g})")


def photopic(program: str, *arguments: object) -> dict:
    """Runs a command with --json; its first result."""
    run = subprocess.run([program, "-q", "capture", *map(str, arguments), "--json"], capture_output=True, text=True, check=True)
    return json.loads(run.stdout)["results"][0]


def camera(program: str) -> None:
    """The camera from OpenCV's corners, and its lens the other way round."""
    folder = SHARED / "chessboard_left"
    board, seen = {}, {}
    with open(folder / "opencv_corners.csv", newline="") as file:
        for row in csv.DictReader(file):
            board.setdefault(row["view"], []).append((float(row["X"]), float(row["Y"]), 0.0))
            seen.setdefault(row["view"], []).append((float(row["u"]), float(row["v"])))
    points = [np.float32(p) for p in board.values()]
    corners = [np.float32(p).reshape(-1, 1, 2) for p in seen.values()]
    rms, matrix, lens, *_ = cv2.calibrateCamera(points, corners, (640, 512), None, None)
    ours = photopic(program, "calibrate", "--board", "9x6", "--corners", folder / "opencv_corners.csv", folder / "left01.jpg")
    i, d = ours["intrinsics"], ours["distortion"]
    check("calibrateCamera rms, px", abs(ours["rms_px"] - rms), 5e-6)
    for name, theirs in zip(("fx", "fy", "cx", "cy"), (matrix[0, 0], matrix[1, 1], matrix[0, 2], matrix[1, 2])):
        check(f"calibrateCamera {name}, px", abs(i[name] - theirs), 5e-4)
    for name, theirs in zip(("k1", "k2", "p1", "p2", "k3"), lens.ravel()):
        check(f"calibrateCamera {name}", abs(d[name] - theirs), 5e-6)
    # Pixels that OpenCV undistorts with our camera go back to where they were by the formulas of our documentation.
    grid = np.stack(np.meshgrid(np.arange(0.0, 640, 40), np.arange(0.0, 512, 40)), -1).reshape(-1, 1, 2)
    own = np.array([[i["fx"], 0, i["cx"]], [0, i["fy"], i["cy"]], [0, 0, 1]])
    coefficients = np.array([d[k] for k in ("k1", "k2", "p1", "p2", "k3")])
    settle = (cv2.TERM_CRITERIA_COUNT | cv2.TERM_CRITERIA_EPS, 100, 1e-12)
    ideal = cv2.undistortPoints(grid, own, coefficients, criteria=settle)
    x, y = ideal[:, 0, 0], ideal[:, 0, 1]
    r2 = x * x + y * y
    radial = 1 + r2 * (d["k1"] + r2 * (d["k2"] + r2 * d["k3"]))
    u = i["fx"] * (x * radial + 2 * d["p1"] * x * y + d["p2"] * (r2 + 2 * x * x)) + i["cx"]
    v = i["fy"] * (y * radial + d["p1"] * (r2 + 2 * y * y) + 2 * d["p2"] * x * y) + i["cy"]
    check("undistortPoints there and back, px", float(np.hypot(u - grid[:, 0, 0], v - grid[:, 0, 1]).max()), 1e-6)


def corners(program: str) -> None:
    """Our corners fit a camera no worse than OpenCV's do."""
    board = np.zeros((54, 3), np.float32)
    board[:, :2] = np.mgrid[0:9, 0:6].T.reshape(-1, 2)
    for files in (sorted((SHARED / "chessboard_left").glob("left*.jpg")), sorted((SHARED / "synthetic_camera").glob("board_*.png"))):
        pictures = [cv2.imread(str(f), cv2.IMREAD_GRAYSCALE) for f in files]
        found = [cv2.findChessboardCornersSB(p, (9, 6)) for p in pictures]
        seen = [c for ok, c in found if ok]
        rms, *_ = cv2.calibrateCamera([board] * len(seen), seen, pictures[0].shape[::-1], None, None)
        ours = photopic(program, "calibrate", "--board", "9x6", *files)
        check(f"rms of our corners in {files[0].name} …, px, for OpenCV's {rms:.4f}", ours["rms_px"], rms)


def grid(rows: int, columns: int) -> tuple[np.ndarray, np.ndarray]:
    """Rows and columns of the 70 pixels that CalibrateDebevec takes."""
    across = int(np.sqrt(70 * columns / rows))
    down = 70 // across
    dx, dy = columns // across, rows // down
    x, y = np.meshgrid(dx // 2 + dx * np.arange(across), dy // 2 + dy * np.arange(down), indexing="ij")
    return y.ravel(), x.ravel()


def debevec_sum(codes: np.ndarray, ln_t: np.ndarray, ln_g: np.ndarray) -> tuple[float, float]:
    """Debevec's sum of squares with λ = 10 and OpenCV's weights for codes[exposure, pixel], with the best radiances; and the norm of its
    matrix times that of its solution."""
    levels = np.arange(256)
    hat = np.where(levels < 128, levels + 1.0, 256.0 - levels)
    w, each = hat[codes] ** 2, ln_g[codes] - ln_t[:, None]
    ln_e = (w * each).sum(0) / w.sum(0)
    bent, smooth = (10 * hat[1:-1]) ** 2, np.diff(ln_g, 2)
    total = (w * (each - ln_e) ** 2).sum() + (bent * smooth**2).sum() + ln_g[128] ** 2
    return float(total), float(np.sqrt((2 * w.sum() + 6 * bent.sum() + 1) * ((ln_g**2).sum() + (ln_e**2).sum())))


def response(program: str) -> None:
    """Debevec's curve and the merged picture under it."""
    folder = SHARED / "exposures_memorial"
    files = sorted(folder.glob("memorial*.png"))
    times = np.float32([float(Fraction(line)) for line in (folder / "shutter_times.txt").read_text().split()])
    pictures = [cv2.imread(str(f)) for f in files]
    theirs = cv2.createCalibrateDebevec().process(pictures, times)
    stack = [*files, "--times", folder / "shutter_times.txt"]
    ours = photopic(program, "response", *stack, "--method", "debevec")["response"]
    # OpenCV solves in single precision what we solve in double: its curve must leave more of the sum, by no more than rounding does.
    samples = np.stack(pictures)[(slice(None), *grid(*pictures[0].shape[:2]))]
    green = np.log(theirs[:, 0, 1])
    for channel, name in enumerate("BGR"):
        least, size = debevec_sum(samples[..., channel], np.log(times.astype(float)), np.array(ours[2 - channel]["ln_g"]))
        left, _ = debevec_sum(samples[..., channel], np.log(times.astype(float)), np.log(theirs[:, 0, channel].astype(float)))
        check(f"debevec's sum less that of CalibrateDebevec, {name}, relative", least / left - 1, 1e-12)
        rounding = (samples[..., channel].size + 256) * 2.0**-24 * size
        check(f"root of what CalibrateDebevec leaves more, {name}, over rounding", float(np.sqrt(max(left - least, 0.0)) / rounding), 1.0)
    with tempfile.TemporaryDirectory() as temporary:
        table, picture = Path(temporary) / "response.csv", Path(temporary) / "merged.exr"
        with open(table, "w", newline="") as file:
            out = csv.writer(file)
            out.writerow(["code", "ln_g_R", "ln_g_G", "ln_g_B"])
            # Their curve, made monotone as a merge needs it.
            for code, row in enumerate(np.maximum.accumulate(np.log(theirs[:, 0, ::-1]), axis=0)):
                out.writerow([code, *row])
        # Four exposures, and the pixels that all of them show within the range: any weighted mean lies between what they say.
        some = slice(6, 10)
        named = Path(temporary) / "times.csv"
        named.write_text("".join(f"{f.name},{t}\n" for f, t in zip(files[some], times[some])))
        photopic(program, "merge", *files[some], "--times", named, "--response", table, "-o", picture)
        with OpenEXR.File(str(picture), separate_channels=True) as file:
            own = np.log(file.channels()["G"].pixels)
    merged = np.log(cv2.createMergeDebevec().process(pictures[some], times[some], theirs)[..., 1])
    codes = np.stack([p[..., 1] for p in pictures[some]])
    each = np.maximum.accumulate(green)[codes] - np.log(times[some])[:, None, None]
    good = np.all((np.stack(pictures[some]) >= 20) & (np.stack(pictures[some]) <= 230), axis=(0, 3))
    outside = lambda ln: float(np.maximum(each.min(0) - ln, ln - each.max(0))[good].max())
    # Both are stored in single precision.
    check(f"MergeDebevec, green, outside of its {good.sum()} pixels' exposures, ln", outside(merged), 1e-5)
    check("merge, green, outside of the same, ln", outside(own), 1e-5)
    check("merge less MergeDebevec over the spread of the exposures", float((np.abs(own - merged) / np.ptp(each, 0))[good & (np.ptp(each, 0) > 1e-3)].max()), 1.0)


def main() -> int:
    program = sys.argv[1] if len(sys.argv) > 1 else str(ROOT / "target" / "release" / "photopic")
    if not SHARED.exists():
        print("nothing compared: ../shared/capture is not here")
        return 2
    camera(program)
    corners(program)
    response(program)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
