#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# tests/tool/replay_test.sh TOOL: what --save-config wrote gives the same result again, to the last byte, from another
# folder and with another number of threads.
set -euo pipefail
tool=$(realpath "$1")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir "$work/elsewhere"
cd "$work"
same=0 failed=0

# replay NAME OUTPUT COMMAND ARGUMENTS...: OUTPUT is a file or a folder.
replay() {
  local name=$1 output=$2 command=$3
  shift 3
  "$tool" "$command" "$@" --output "$output" --quiet --save-config "$name.toml"
  (cd elsewhere && "$tool" "$command" --config "../$name.toml" --output "again-$output" --threads 1 --quiet)
  if diff -r "$output" "elsewhere/again-$output" >/dev/null; then
    same=$((same + 1))
  else
    failed=$((failed + 1))
    echo "FAILED: $name: the result differs"
  fi
}

replay synth scan synth figure --arc ring --views 16 --size 160x120 --outliers 0.05 --textured
replay photographs photographs synth figure --arc ring --views 16 --size 320x240 --textured --images-only
replay preset ball synth ball --preset kinect --views 3
replay fuse mesh.ply fuse scan
replay given given.glb fuse scan --resolution 64 --lambda 40 --outliers 0.1 --bbox=-0.3,-0.3,-0.5,0.3,0.3,0.5 --trim 0.3
replay tsdf tsdf.obj fuse scan --method tsdf --carve --weights confidence,incidence --resolution 64
replay images images.stl fuse photographs --resolution 64 --neighbours 4
replay render picture.png render mesh.ply --eye 0,-1.5,0.5 --size 200x150 --color support
replay convert rgbd convert scan --to rgbd
echo "replay: $same runs gave the same again, $failed did not"
[ "$failed" -eq 0 ]
