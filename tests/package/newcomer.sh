#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# tests/package/newcomer.sh [FOLDER]: does what a newcomer does with README.md alone, in a new clone of HEAD, without a
# compiler cache, and says how long each step takes: first mesh and picture, first own data set, first program. The
# commands and the program are taken from README.md as they stand there. FOLDER is the own data set: any that
# `vdbfuse info` reads; without it the one in $VDBFUSE_DATA or ../shared/data, else a synthetic one.
set -euo pipefail
cd "$(dirname "$0")/../.."
source=$PWD
data=${1:-${VDBFUSE_DATA:-$source/../shared/data}/kitchen-rgbd}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export CCACHE_DISABLE=1
results=()

# block HEADING LANGUAGE N: the Nth block of that language below that heading of README.md.
block() {
  awk -v heading="$1" -v fence='```'"$2" -v wanted="$3" '
    /^#/ { inside = ($0 == heading) }
    inside && $0 == fence { if (++count == wanted) { copy = 1; next } }
    copy && /^```/ { exit }
    copy' README.md | grep . || { echo "README.md has no block $3 of $2 below $1" >&2; return 1; }
}

# timed NAME COMMANDS: runs them as they stand in README.md.
timed() {
  local begin=$SECONDS
  printf '\n== %s\n%s\n' "$1" "$2"
  bash -euo pipefail -c "$2"
  results+=("$(printf '%-40s %4d s' "$1" $((SECONDS - begin)))")
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
