#!/usr/bin/env bash
# Makes or updates scripts/.venv from scripts/requirements.txt and prints the path of its python.
# Does nothing when the environment already matches; PYTHON names another interpreter (default python3).
set -euo pipefail

here="$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)"
venv="$here/.venv"
base="${PYTHON:-python3}"
want="$({ "$base" --version; cat "$here/requirements.txt"; } | sha256sum | cut -d' ' -f1)"
stamp="$venv/.stamp"

if [ ! -x "$venv/bin/python" ] || [ "$(cat "$stamp" 2>/dev/null || true)" != "$want" ]; then
    # The stamp is written last, so that an interrupted run is repeated.
    rm -rf "$venv"
    "$base" -m venv "$venv" >&2
    "$venv/bin/python" -m pip install --quiet --disable-pip-version-check --requirement "$here/requirements.txt" >&2
    printf '%s\n' "$want" > "$stamp"
fi
printf '%s\n' "$venv/bin/python"
