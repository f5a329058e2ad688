#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# tests/package/newcomer.sh [--with-cache] [FOLDER]: does what a newcomer does with README.md alone, in a new clone of
# HEAD, without a compiler cache, and says how long each step takes: first mesh and picture, first own data set, first
# program. The commands and the program are taken from README.md as they stand there. FOLDER is the own data set: any
# that `vdbfuse info` reads; without it the one in $VDBFUSE_DATA or ../shared/data, else a synthetic one.
# --with-cache: for checks, not for times: in build/newcomer/, where a compiler cache finds the same paths again.
set -euo pipefail
cd "$(dirname "$0")/../.."
source=$PWD
if [ "${1:-}" = --with-cache ]; then
  shift
  work=$PWD/build/newcomer
  rm -rf "$work"
  mkdir -p "$work"
else
  work=$(mktemp -d)
  export CCACHE_DISABLE=1
fi
trap 'rm -rf "$work"' EXIT
data=${1:-${VDBFUSE_DATA:-$source/../shared/data}/kitchen-rgbd}
results=()

# block HEADING LANGUAGE N: the Nth block of that language below that heading of README.md.
block() {
  awk -v heading="$1" -v fence='```'"$2" -v wanted="$3" '
    /^```/ { fenced = !fenced; copy = inside && fenced && $0 == fence && ++count == wanted; next }
    !fenced && /^#/ { inside = ($0 == heading) }
    copy' README.md | grep '' || { echo "README.md has no block $3 of $2 below $1" >&2; return 1; }
}

# timed NAME COMMANDS: runs them as they stand in README.md.
timed() {
  printf '\n== %s\n%s\n' "$1" "$2"
  local TIMEFORMAT='%0R %0U %0S'
  { time bash -euo pipefail -c "$2" 1>&3 2>&4; } 3>&1 4>&2 2>"$work/time"
  results+=("$(awk -v name="$1" '{ printf "%-45s %5d s, %5d processor seconds", name, $1, $2 + $3 }' "$work/time")")
}

git clone --quiet "$source" "$work/vdbfuse"
cd "$work/vdbfuse"
timed "first mesh and picture" "$(block '## First steps' sh 1)"
[ -s build/quickstart/mesh.ply ] && [ -s build/quickstart/mesh.png ]

if [ -d "$data" ]; then
  ln -s "$(realpath "$data")" scan
else
  build/bin/vdbfuse synth figure synthetic --arc ring --views 36 --size 320x240 --textured --quiet
  build/bin/vdbfuse convert synthetic scan --to rgbd --quiet
fi
timed "first own data set ($(basename "$(realpath scan)"))" "$(block '## First steps' sh 2)"
[ -s mesh.ply ] && [ -s mesh.png ]

mkdir mine
block '## The library' cmake 1 >mine/CMakeLists.txt
block '## The library' cpp 1 >mine/main.cpp
timed "first find_package program" "$(block '## The library' sh 1)"

printf '\n== Results, on %s processors, load %s\n' "$(nproc)" "$(cut -d ' ' -f 1 /proc/loadavg)"
printf '%s\n' "${results[@]}"
