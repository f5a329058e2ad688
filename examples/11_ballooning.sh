#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# examples/11_ballooning.sh [OUTDIR [RESOLUTION [VIEWS]]]: Fig. 4 of the paper. A figure with thin legs and a deep cavity
# in its chest, scanned on a turntable, is fused with visibility evidence and with constant ballooning of seven
# strengths. No strength keeps the legs and the cavity together. Prints a table and leaves a picture of each result in
# OUTDIR (defaults: build/ballooning, 128, 72). Needs build/bin/vdbfuse: run examples/quickstart.sh first.
# VDBFUSE=PROGRAM (environment): another one.
set -euo pipefail
cd "$(dirname "$0")/.."
out=${1:-build/ballooning} resolution=${2:-128} views=${3:-72}
tool=${VDBFUSE:-build/bin/vdbfuse}
mkdir -p "$out"
"$tool" synth figure "$out/scan" --arc ring --views "$views" --size 320x240 --outliers 0.1 --overwrite --quiet

# measure NAME: IoU, open share of the cavity, kept shares of the legs, components.
measure() {
  "$tool" evaluate "$out/$1.ply" "$out/scan/truth.ply" --regions "$out/scan/scene.json" | awk -v name="$1" '
    $1 == "IoU" { iou = $2 }
    /cavity:/ { cavity = $3 } /left leg:/ { left = $4 } /right leg:/ { right = $4 }
    /components/ { for (i = 1; i < NF; ++i) if ($(i + 1) ~ /^components/) components = $i }
    END { printf "%-16s %8s %9s %% %9s %% %9s %% %6s\n", name, iou, cavity, left, right, components }'
}

# run NAME [options of fuse]
run() {
  local name=$1
  shift
  if "$tool" fuse "$out/scan" "$out/$name.ply" --resolution "$resolution" --overwrite --quiet "$@" \
    2>"$out/$name.log"; then
    measure "$name"
    "$tool" render "$out/$name.ply" "$out/$name.png" --overwrite
  else
    printf '%-16s nothing is left: %s\n' "$name" "$(head -n 1 "$out/$name.log")"
  fi
}

printf '%-16s %8s %11s %11s %11s %6s\n' evidence IoU 'cavity open' 'left leg' 'right leg' parts
run visibility
for weight in 0.005 0.01 0.02 0.03 0.05 0.1 0.2; do
  run "balloon-$weight" --rule constant --balloon "$weight"
done
echo "pictures: $out/*.png"
