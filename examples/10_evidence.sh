#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# examples/10_evidence.sh SCAN [OUTDIR] [SLICE] [options of fuse]: Fig. 5 of the paper, on any data set. Draws a slice of
# the evidence without and with the outlier model, and how far each pixel of a view is believed, and counts the pieces
# that visibility and Curless-Levoy fusion leave. OUTDIR: build/evidence; SLICE: y=0. Needs build/bin/vdbfuse: run
# examples/quickstart.sh first. VDBFUSE=PROGRAM (environment): another one.
set -euo pipefail
cd "$(dirname "$0")/.."
[ $# -ge 1 ] || { echo "usage: examples/10_evidence.sh SCAN [OUTDIR] [SLICE] [options of fuse]" >&2; exit 2; }
scan=$1 out=${2:-build/evidence} slice=${3:-y=0}
shift $(($# < 3 ? $# : 3))
tool=${VDBFUSE:-build/bin/vdbfuse}
mkdir -p "$out"

# run NAME [options]: a mesh, its grids, its report.
run() {
  local name=$1
  shift
  "$tool" fuse "$scan" "$out/$name.ply" --save-grids "$out/$name.vdb" --json "$out/$name.json" --overwrite --quiet "$@"
}
number() { sed -nE "s/.*\"$2\": *([0-9]+),?.*/\1/p" "$out/$1.json" | head -n 1; }

run without --outliers 0 "$@"
run with "$@"
run tsdf --method tsdf "$@"
"$tool" judge "$scan" "$out/judged" --overwrite --quiet
for name in without with; do
  "$tool" render "$out/$name.vdb" "$out/sigma-$name.png" --slice "$slice" --grid sigma --range -8,8 --overwrite
done
printf '%-28s %10s %10s\n' method pieces 'open edges'
for name in without with tsdf; do
  printf '%-28s %10s %10s\n' "$name" "$(number $name components)" "$(number $name open_edges)"
done
echo "pictures: $out/sigma-without.png $out/sigma-with.png and one a view in $out/judged"
