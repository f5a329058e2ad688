#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# examples/quickstart.sh [FOLDER]: installs the Debian packages that are missing, builds the tool into build/, and makes
# a surface of the depth maps in FOLDER, or, without one, of a synthetic scan. Says where mesh and picture are.
set -euo pipefail
start=$PWD
cd "$(dirname "$0")/.."
input=${1:-}
if [ -n "$input" ]; then
  input=$(cd "$start" && realpath -- "$input")
  [ -e "$input" ] || { echo "quickstart: there is no $input" >&2; exit 1; }
fi

cmake/install-packages.sh build
echo "Building build/bin/vdbfuse" >&2
mkdir -p build
# Settings of an earlier build stay as they are.
[ -f build/CMakeCache.txt ] || settings=(-DVDBFUSE_WITH_PCL=OFF -DVDBFUSE_BUILD_TESTS=OFF -DVDBFUSE_BUILD_EXAMPLES=OFF)
cmake --preset release ${settings[@]+"${settings[@]}"} >build/configure.log 2>&1 || { cat build/configure.log; exit 1; }
cmake --build build -j "$(nproc)" --target vdbfuse_tool >&2
tool=build/bin/vdbfuse
out=build/quickstart
mkdir -p "$out"

if [ -z "$input" ]; then
  input=$out/scan
  echo "Scanning a synthetic figure with a turntable: 72 views, 10 % outliers" >&2
  "$tool" synth figure "$input" --arc ring --views 72 --size 320x240 --outliers 0.1 --overwrite
  "$tool" fuse "$input" "$out/mesh.ply" --resolution 128 --json "$out/mesh.json" --overwrite
  "$tool" evaluate "$out/mesh.ply" "$input/truth.ply"
else
  "$tool" info "$input"
  "$tool" fuse "$input" "$out/mesh.ply" --json "$out/mesh.json" --overwrite
fi
"$tool" render "$out/mesh.ply" "$out/mesh.png" --overwrite

echo
echo "mesh:    $PWD/$out/mesh.ply"
echo "picture: $PWD/$out/mesh.png"
