#!/usr/bin/env python3
"""Writes docs/extremes.md from a run of `photopic selfcheck`; needs Python 3.11 and nothing else.

    scripts/extremes.py PHOTOPIC
"""

import json
import math
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
# What doubles can hold.
MOST = 15


def digits(case: dict) -> str:
    """Decimal digits that agree; where 0 is expected there are none to agree."""
    if case["expected"] == 0:
        return f"within {case['error']:.1g}" if case["error"] else "exact"
    if case["error"] == 0:
        return str(MOST)
    return str(min(MOST, math.floor(-math.log10(case["error"]))))


def main() -> None:
    done = subprocess.run([sys.argv[1], "selfcheck", "--json"], stdout=subprocess.PIPE, check=False)
    if done.returncode not in (0, 1):
        raise SystemExit(f"selfcheck: exit code {done.returncode}")
    cases = json.loads(done.stdout)["results"]
    out = [
        "# To what magnitude figures hold their digits",
        "",
        "Written by `scripts/extremes.py` from a run of `photopic selfcheck`, which repeats it on any machine. Expectations are closed forms, evaluated",
        "with 40 or 50 digits, or a standard's; the digits are those that agree with them, the digits asked for those below which `selfcheck` says no. The",
        "long versions are the tests in `tests/extremes` and beside each module.",
        "",
    ]
    for area in dict.fromkeys(c["area"] for c in cases):
        out += [f"## {area.capitalize()}", "", "| case | expectation | expected | digits | asked for |", "| --- | --- | --- | --- | --- |"]
        for c in (c for c in cases if c["area"] == area):
            asked = digits({**c, "error": c["allowed"]})
            cells = [c["case"], c["source"], f"{c['expected']:.6g}", digits(c), asked]
            out.append("| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |")
        out.append("")
    (ROOT / "docs" / "extremes.md").write_text("\n".join(out), encoding="utf-8")


if __name__ == "__main__":
    main()
