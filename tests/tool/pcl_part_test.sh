#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# tests/tool/pcl_part_test.sh TOOL LIBRARY FOLDER built|missing: the tool is not linked to PCL and opens the PCL part when
# a PCD file is read; where the part is not there, it says so.
set -euo pipefail
tool=$1 library=$2 folder=$3 part=$4
rm -rf "$folder"
mkdir -p "$folder/lib"
fail() { echo "$1" >&2; exit 1; }

if ldd "$tool" | grep -iE 'pcl|vtk'; then fail "the tool loads PCL at start"; fi

# 5 x 4 points of a pinhole camera with f = 10 and its centre in the middle, at z = 1.
{
  printf '%s\n' '# .PCD v0.7' 'VERSION 0.7' 'FIELDS x y z' 'SIZE 4 4 4' 'TYPE F F F' 'COUNT 1 1 1' 'WIDTH 5' 'HEIGHT 4' \
    'VIEWPOINT 0 0 0 1 0 0 0' 'POINTS 20' 'DATA ascii'
  for y in -0.15 -0.05 0.05 0.15; do
    for x in -0.2 -0.1 0 0.1 0.2; do echo "$x $y 1"; done
  done
} >"$folder/cloud.pcd"
message="reading PCD needs the PCL part (vdbfuse_pcl), which was not built or is not installed"

if [ "$part" = built ]; then
  "$tool" info "$folder/cloud.pcd" | tee "$folder/info.txt"
  grep -q pcd "$folder/info.txt" || fail "info does not say that it read pcd"
fi
if [ "$part" = missing ] || [ -f "$library" ]; then
  # A copy of the core library, with no PCL part beside it, takes the place of the built one.
  preload=
  if [ "$part" = built ]; then
    cp "$library" "$folder/lib/"
    preload=$folder/lib/$(basename "$library")
  fi
  code=0
  said=$(LD_PRELOAD=$preload "$tool" info "$folder/cloud.pcd" 2>&1) || code=$?
  [ "$code" = 1 ] || fail "exit code $code without the PCL part"
  [ "$said" = "vdbfuse: $folder/cloud.pcd: $message" ] || fail "without the PCL part it says: $said"
fi
