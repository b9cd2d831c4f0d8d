#!/bin/sh
# The search for surfaces beside Embree's, in one run: million rays a second on the meshes and rays of benches/render.rs.
#
#     scripts/bench_rays.sh [THREADS]
#
# Needs g++ and Embree 3 (Debian: libembree-dev) and ../shared/render; without them it says so and does nothing.
set -eu
cd "$(dirname "$0")/.."
threads=${1:-2}
meshes=../shared/render/meshes
if [ ! -d "$meshes" ] || [ ! -e /usr/include/embree3/rtcore.h ]; then
    echo "skipped: needs $meshes and Embree 3 (libembree-dev)"
    exit 0
fi
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
g++ -O3 -march=native -std=c++17 -o "$folder/rays" scripts/embree/rays.cpp -lembree3 -lpthread
cargo bench --quiet --bench render --no-run
# Interleaved, so that what else the machine does falls on both.
for turn in 1 2 3; do
    PHOTOPIC_RAYS="$folder" PHOTOPIC_THREADS="$threads" cargo bench --quiet --bench render
    for name in blob spheres; do
        for kind in coherent incoherent; do
            # shellcheck disable=SC2046
            set -- $("$folder/rays" "$meshes/$name.ply" "$folder/$name.$kind" "$threads")
            echo "turn $turn $name $kind Embree: $1 hits, distances $2, $3 Mrays/s"
        done
    done
done
