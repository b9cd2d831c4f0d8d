"""Races photopic against numpy, colour-science and the Rust crates colorimetry and eulumdat, in one run and interleaved.

    PY=$(scripts/venv.sh) && "$PY" scripts/bench_peers.py [--rounds 7] [--json FILE] [--binary PATH] [--skip-process]

Every implementation gets the same spectra (see benches/samples/mod.rs) as 81 samples by 5 nm, one thread and one pass to warm
up in each round; its mean result is checked. Times of libraries are CPU times of their thread, so that a busy machine
disturbs less. The table shows the median of the rounds, the fastest and the slowest, and the ratio of medians to photopic.
Then the whole program, by the clock: start-up, and a CSV of 100 000 spectra with its peak memory.
"""

import argparse
import contextlib
import io
import json
import math
import os
import platform
import statistics
import subprocess
import sys
import tempfile
import time
import warnings
from pathlib import Path

ONE_THREAD = {k: "1" for k in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS", "RAYON_NUM_THREADS")}
if any(os.environ.get(k) != v for k, v in ONE_THREAD.items()):
    # numpy reads them when it is imported, so they have to stand before this process begins.
    os.execve(sys.executable, [sys.executable, *sys.argv], os.environ | ONE_THREAD)

import numpy as np  # noqa: E402

with warnings.catch_warnings(), contextlib.redirect_stderr(io.StringIO()):
    warnings.simplefilter("ignore")
    import colour

ROOT = Path(__file__).resolve().parent.parent
WAVELENGTHS = np.arange(380.0, 781.0, 5.0)
K_M = 683.002
# Seconds that a short task is repeated for in each round.
AT_LEAST = 0.1
# Means that the results must have, and how far from them they may be: benches/samples/mod.rs.
IMAGE_SIZE, IMAGE_WAVELENGTHS = 1024, np.arange(400.0, 701.0, 10.0)
MEAN = {"xyz": (K_M * 81.34364396, 1e-5), "cct": (4050.84364, 1.0), "cri": (73.4162, 0.2), "tm30": (75.6697, 0.02), "image": (81.34402178, 1e-4)}
# The targets for one core: spectra, seconds.
TARGET = {"cct": (10_000, 13e-3), "cri": (1000, 36e-3), "tm30": (100, 23e-3)}
# Readers of lamps: photopic and the crate eulumdat on the same text in memory.
LAMPS = {"lm63-plain": "LM-63, 181 × 361 angles, ordinary numbers", "lm63-long": "the same with 17-digit numbers"}
TITLE = {
    "xyz": "100 000 spectra to X, Y, Z, luminance",
    "cct": "10 000 CCTs of XYZ",
    "cri": "1000 CRIs of spectra, CCT included",
    "tm30": "100 TM-30s of spectra",
    "cold": "first conversion in a process, all figures",
    "image": "1024 × 1024 pixels × 31 bands, float32, to X, Y, Z",
}
SPECTRA = {"xyz": 100_000, "cct": 10_000, "cri": 1000, "tm30": 100, "cold": 1, "image": IMAGE_SIZE}


def spectra(count, wavelengths=WAVELENGTHS):
    """The first `count` spectra, as rows."""
    i = np.arange(count, dtype=float)[:, None]
    part = lambda step: (step * i) % 1.0  # noqa: E731
    bell = lambda x: np.exp(-0.5 * x * x)  # noqa: E731
    blue, peak = 0.1 + 1.6 * part(0.61803398875), 560 + 40 * part(0.7548776662)
    return blue * bell((wavelengths - 450) / 10) + bell((wavelengths - peak) / 55)


def timed(run, scale=1):
    """CPU seconds for one pass of `run` after one to warm up, and the mean of what it returns; `scale` stretches the time from
    the part that was run to the whole."""
    run()
    start, passes = time.thread_time(), 0
    while passes == 0 or time.thread_time() - start < AT_LEAST:
        result = run()
        passes += 1
    return (time.thread_time() - start) / passes * scale, float(np.mean(result))


def python_peers():
    """(task, implementation) and what runs it."""
    cmfs = colour.MSDS_CMFS["CIE 1931 2 Degree Standard Observer"]
    shape = colour.SpectralShape(380, 780, 5)
    bars = cmfs.copy().align(shape).values
    weights = np.ascontiguousarray(5.0 * np.column_stack([bars, K_M * bars[:, 1]]))
    values, out = spectra(100_000), np.empty((100_000, 4))
    xyz = values[:10_000] @ weights[:, :3]
    lights = [colour.SpectralDistribution(row, shape.wavelengths) for row in values[:100]]

    def numpy_xyz():
        np.matmul(values, weights, out=out)
        return out[-1:, 3] * (MEAN["xyz"][0] / K_M / 86.4437433242464)

    def numpy_check():
        # The mean of all, once; a pass itself looks at the last row only.
        numpy_xyz()
        assert abs(out[:, 3].mean() - MEAN["xyz"][0]) < 1e-5

    numpy_check()

    def colour_xyz():
        got = colour.msds_to_XYZ(values[:10_000], cmfs=cmfs, k=K_M, method="Integration", shape=shape)
        return got[:, 1]

    def colour_cct():
        uv = colour.UCS_to_uv(colour.XYZ_to_UCS(xyz))
        return colour.temperature.uv_to_CCT_Ohno2013(uv)[:, 0]

    image = spectra(IMAGE_SIZE**2, IMAGE_WAVELENGTHS).astype(np.float32)
    image_shape = colour.SpectralShape(400, 700, 10)
    image_weights = (10 * cmfs.copy().align(image_shape).values).astype(np.float32)
    image_out = np.empty((IMAGE_SIZE**2, 3), np.float32)

    def numpy_image():
        np.matmul(image, image_weights, out=image_out)
        return image_out[:, 1]

    def colour_image():
        return colour.msds_to_XYZ(image, cmfs=cmfs, k=1, method="Integration", shape=image_shape)[:, 1]

    return {
        ("image", "numpy"): lambda: timed(numpy_image),
        ("image", "colour-science"): lambda: timed(colour_image),
        ("xyz", "numpy"): lambda: timed(numpy_xyz),
        ("xyz", "colour-science"): lambda: timed(colour_xyz, 10),
        ("cct", "colour-science"): lambda: timed(colour_cct),
        ("cri", "colour-science"): lambda: timed(lambda: [colour.colour_rendering_index(s) for s in lights], 10),
        ("tm30", "colour-science"): lambda: timed(
            lambda: [colour.colour_fidelity_index(s, method="ANSI/IES TM-30-18") for s in lights]
        ),
    }


def peers_binary():
    """Builds benches/peers."""
    target = ROOT / "target" / "peers"
    manifest = ROOT / "benches" / "peers" / "Cargo.toml"
    build = ["cargo", "build", "--quiet", "--release", "--manifest-path", manifest, "--target-dir", target]
    subprocess.run(build, check=True)
    return target / "release" / "peers"


def lamps(binary, rounds):
    """Prints megabytes a second of the readers of lamps, interleaved."""
    rates = {}
    for _ in range(rounds):
        for task in LAMPS:
            for name in ("photopic", "eulumdat"):
                done = subprocess.run([binary, name, task], check=True, capture_output=True, text=True)
                got = json.loads(done.stdout)
                rates.setdefault(task, {}).setdefault(name, []).append(got["spectra"] / got["seconds"] / 1e6)
    for task, by_name in rates.items():
        ours = statistics.median(by_name["photopic"])
        print(f"\n{LAMPS[task]}, MB/s\n{'':18}{'median':>10} {'slowest':>10} {'fastest':>10} {'ratio':>8}")
        for name, rate in by_name.items():
            median, low, high = spread(rate)
            print(f"{name:18}{median:>10.0f} {low:>10.0f} {high:>10.0f} {ours / median:>8.2f}")


def rust_peers():
    """The same of the Rust libraries: a process each time, which warms up by itself."""
    binary = peers_binary()

    def race(task, implementation):
        done = subprocess.run([binary, implementation, task], check=True, capture_output=True, text=True)
        got = json.loads(done.stdout)
        return got["seconds"] * SPECTRA[task] / got["spectra"], got["mean"]

    pairs = [
        ("xyz", "photopic"),
        ("xyz", "photopic-1"),
        ("xyz", "colorimetry"),
        ("xyz", "colorimetry-1nm"),
        *[(task, name) for task in ("cct", "cri", "tm30") for name in ("photopic", "colorimetry-1nm")],
        ("cold", "photopic"),
        ("image", "photopic"),
        ("image", "read"),
    ]
    return {(task, name): lambda task=task, name=name: race(task, name) for task, name in pairs}


def check(task, name, mean):
    """The result is the known one; the crate resamples to 1 nm and so gets a looser bound."""
    if task == "cold" or name == "read":
        return
    want, tolerance = MEAN[task]
    if name.startswith("colorimetry"):
        tolerance = {"xyz": 60.0, "cct": 5.0, "cri": 0.5, "tm30": 0.5}[task]
    elif task == "image":
        tolerance = 1e-2  # means of float32 values
    elif name == "colour-science":
        # A part of the spectra, or Ohno's method: the mean is another by a little.
        tolerance = {"xyz": 60.0, "cct": 1.0, "cri": 1.0, "tm30": 0.02}[task]
    assert abs(mean - want) <= tolerance, f"{name} gives a mean {task} of {mean}, expected {want} ± {tolerance}"


def spread(seconds):
    """Median, fastest and slowest."""
    return statistics.median(seconds), min(seconds), max(seconds)


def readable(seconds):
    """Seconds with a fitting unit and three digits."""
    for unit, size in (("s", 1), ("ms", 1e-3), ("µs", 1e-6)):
        if seconds >= size:
            return f"{seconds / size:.{max(0, 2 - int(math.log10(seconds / size)))}f} {unit}"
    return f"{seconds * 1e9:.0f} ns"


# Starts a program from a process that is small itself: a child is charged with the memory of its parent until it is itself.
LAUNCHER = """
import os, sys, time
null = os.open(os.devnull, os.O_WRONLY)
to_null = [(os.POSIX_SPAWN_DUP2, null, 1), (os.POSIX_SPAWN_DUP2, null, 2)]
start = time.perf_counter()
pid = os.posix_spawnp(sys.argv[1], sys.argv[1:], os.environ, file_actions=to_null)
_, status, usage = os.wait4(pid, 0)
print(time.perf_counter() - start, usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024, os.waitstatus_to_exitcode(status))
"""


def run_once(command):
    """Wall seconds, CPU seconds, peak memory in MiB and exit status of a process; its output is thrown away."""
    launcher = [sys.executable, "-I", "-S", "-c", LAUNCHER, *map(str, command)]
    *numbers, status = subprocess.run(launcher, check=True, capture_output=True, text=True).stdout.split()
    return *map(float, numbers), int(status)


def write_csv(path, count):
    """A table of `count` spectra, one per row."""
    header = "name," + ",".join(f"{w:g}" for w in WAVELENGTHS)
    with open(path, "w") as file:
        file.write(header + "\n")
        for at in range(0, count, 10_000):
            rows = spectra(min(count, at + 10_000))[at:]
            file.writelines(f"led {at + i}," + ",".join(f"{v:.7f}" for v in row) + "\n" for i, row in enumerate(rows))


def whole_process(binary, rounds):
    """Start-up and streaming of the program, as (title, wall seconds, CPU seconds, MiB)."""
    results = []

    def measure(title, command, times):
        runs = [run_once(command) for _ in range(times + 1)][1:]
        failed = [status for *_, status in runs if status != 0]
        assert not failed, f"{' '.join(map(str, command))}: exit {failed[0]}"
        results.append((title, spread([r[0] for r in runs]), min(r[1] for r in runs), max(r[2] for r in runs)))

    # All threads that there are, as for a user.
    for key in ("RAYON_NUM_THREADS", "OMP_NUM_THREADS"):
        os.environ.pop(key, None)
    measure("/bin/true, for comparison", ["/bin/true"], 30)
    measure("photopic --version", [binary, "--version"], 30)
    measure("photopic convert D65, all figures", [binary, "convert", "D65"], 15)
    office = ROOT / "data" / "spectra" / "office-led.csv"
    measure("photopic convert office-led.csv, all figures", [binary, "convert", office], 15)
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "out.csv"
        for count in (10_000, 100_000):
            path = Path(folder) / f"{count}.csv"
            write_csv(path, count)
            size = path.stat().st_size / 1e6
            command = [binary, "convert", "--quantity", "irradiance", "--unit", "W/m2/nm", "--csv", "-q", "-o", out, path]
            some = [*command[:-1], "--figures", "colour", path]
            measure(f"CSV of {count} spectra ({size:.0f} MB), XYZ and colour", some, max(1, rounds // 2))
            measure(f"CSV of {count} spectra ({size:.0f} MB), all figures", command, 1)
            lines = sum(1 for _ in open(out, "rb"))
            assert lines == count + 1, f"{lines} lines for {count} spectra and a header"
    return results


def machine():
    """Processor, cores, load and versions, in a line."""
    model = "unknown processor"
    with contextlib.suppress(OSError):
        lines = Path("/proc/cpuinfo").read_text().splitlines()
        model = next(line.split(":")[1].strip() for line in lines if line.startswith("model name"))
    rustc = subprocess.run(["rustc", "--version"], capture_output=True, text=True).stdout.split()[1]
    return (
        f"{model}, {os.cpu_count()} cores (one thread each below), load {os.getloadavg()[0]:.1f}; rustc {rustc}, "
        f"Python {platform.python_version()}, numpy {np.__version__}, colour-science {colour.__version__}, colorimetry 0.1.0"
    )


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--rounds", type=int, default=7, help="rounds of all implementations (default 7)")
    parser.add_argument("--json", type=Path, help="write all times to this file as well")
    parser.add_argument("--binary", type=Path, default=ROOT / "target" / "release" / "photopic", help="the program")
    parser.add_argument("--skip-process", action="store_true", help="libraries only")
    parser.add_argument("--skip-libraries", action="store_true", help="the whole program only")
    parser.add_argument("--lamps", action="store_true", help="the readers of lamps only")
    arguments = parser.parse_args()
    print(machine())
    if arguments.lamps:
        lamps(peers_binary(), arguments.rounds)
        return
    times = {}
    if not arguments.skip_libraries:
        lamps(peers_binary(), arguments.rounds)
        peers = rust_peers() | python_peers()
        for _ in range(arguments.rounds):
            for (task, name), run in peers.items():
                with warnings.catch_warnings():
                    warnings.simplefilter("ignore")
                    seconds, mean = run()
                check(task, name, mean)
                times.setdefault(task, {}).setdefault(name, []).append(seconds)
    for task, by_name in times.items():
        ours = statistics.median(by_name["photopic"])
        note = f" — target {readable(TARGET[task][1])}" if task in TARGET else ""
        note = " — target: no more than numpy" if task == "xyz" else note
        note = " — target: 1.1 times the reading" if task == "image" else note
        print(f"\n{TITLE[task]}{note}\n{'':18}{'median':>10} {'fastest':>10} {'slowest':>10} {'ratio':>8}")
        for name, seconds in by_name.items():
            median, low, high = spread(seconds)
            ratio = f"{median / ours:.2f}"
            print(f"{name:18}{readable(median):>10} {readable(low):>10} {readable(high):>10} {ratio:>8}")
    process = []
    if arguments.skip_process:
        pass
    elif arguments.binary.exists():
        process = whole_process(arguments.binary, arguments.rounds)
        print(f"\nThe whole program\n{'':58}{'median':>10} {'fastest':>10} {'slowest':>10} {'CPU':>10} {'peak MiB':>9}")
        for title, (median, low, high), cpu, peak in process:
            columns = f"{readable(median):>10} {readable(low):>10} {readable(high):>10} {readable(cpu):>10}"
            print(f"{title:58}{columns} {peak:>9.0f}")
    else:
        print(f"\n{arguments.binary} is not built: whole program not measured")
    if arguments.json:
        arguments.json.write_text(json.dumps({"machine": machine(), "seconds": times, "process": process}, indent=1))


if __name__ == "__main__":
    main()
