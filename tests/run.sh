#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# tests/run.sh [--all]: installs the Debian packages that are missing, builds with warnings as errors, runs all tests,
# and those that read files or count cells once more under the address and undefined-behaviour sanitizers, and feeds
# damaged files to the readers.
#
#   --all                   also: sanitizers on everything, clang++, no PCL, a static library, names in every file, HTML
#                           of the pages, the report of vdbfuse compare in a browser, replay, completion, manual pages,
#                           interrupts, full disks, the Debian packages in a clean system, the first steps of README.md in a
#                           clean clone
#   VDBFUSE_WITH_PCL=OFF    (environment) without the Point Cloud Library and its 2.6 GB
#   VDBFUSE_WITH_PYTHON=OFF (environment) without the Python package
#   VDBFUSE_FUZZ_SECONDS=N  (environment) that the fuzzer has for each reader; 10, with --all 30
set -euo pipefail
cd "$(dirname "$0")/.."
all=no
case "${1:-}" in
  --all) all=yes ;;
  "") ;;
  *) echo "usage: tests/run.sh [--all]" >&2; exit 2 ;;
esac
with_pcl=${VDBFUSE_WITH_PCL:-ON}
with_python=${VDBFUSE_WITH_PYTHON:-ON}
jobs=$(nproc)
[ "$all" = no ] && fuzz_seconds=10 || fuzz_seconds=30
fuzz_seconds=${VDBFUSE_FUZZ_SECONDS:-$fuzz_seconds}
# So that a compiler cache keeps files with precompiled headers.
export CCACHE_SLOPPINESS=pch_defines,time_macros
results=()
failed=0

step() { printf '\n== %s\n' "$*"; }

# run_tests NAME BUILD_FOLDER [ctest arguments]: counts what passed and failed.
run_tests() {
  local name=$1 folder=$2 log passed bad
  shift 2
  log=$folder/tests.log
  ctest --test-dir "$folder" --output-on-failure -j "$jobs" "$@" | tee "$log" | grep -vE '^ *(Start|[0-9]+/[0-9]+ .* Passed)' || true
  if ! grep -q 'tests passed' "$log"; then
    results+=("$name: ctest did not finish")
    failed=$((failed + 1))
    return
  fi
  passed=$(grep -cE '^ *[0-9]+/[0-9]+ .* Passed' "$log" || true)
  bad=$(sed -nE 's/.* ([0-9]+) tests? failed out of .*/\1/p' "$log")
  results+=("$name: $passed passed, ${bad:-0} failed")
  total_passed=$((${total_passed:-0} + passed))
  failed=$((failed + ${bad:-0}))
}

# run_script NAME COMMAND...: one result, with the last line that the command says; exit code 77: skipped.
run_script() {
  local name=$1 log code=0
  shift
  step "$name"
  log=$(mktemp)
  "$@" | tee "$log" || code=$?
  case $code in
    0) results+=("$name: passed: $(tail -n 1 "$log")"); total_passed=$((${total_passed:-0} + 1)) ;;
    77) results+=("$name: skipped: $(tail -n 1 "$log")") ;;
    *) results+=("$name: FAILED: $(tail -n 1 "$log")"); failed=$((failed + 1)) ;;
  esac
  rm "$log"
}

# build NAME FOLDER PRESET [cmake arguments]
build() {
  local name=$1 folder=$2 preset=$3
  shift 3
  step "$name"
  cmake --preset "$preset" -B "$folder" -DVDBFUSE_WERROR=ON -DVDBFUSE_BUILD_TESTS=ON \
    -DVDBFUSE_BUILD_EXAMPLES=ON -DVDBFUSE_WITH_PCL="$with_pcl" "$@" >"$folder.log" 2>&1 ||
    { cat "$folder.log"; exit 1; }
  rm "$folder.log"
}

step "Packages"
scopes=(build test)
[ "$with_pcl" = OFF ] || scopes+=(pcl)
[ "$with_python" = OFF ] || scopes+=(python)
[ "$all" = no ] || scopes+=(all)
cmake/install-packages.sh "${scopes[@]}"

build "Release" build release -DVDBFUSE_WITH_PYTHON="$with_python" -DCMAKE_EXPORT_COMPILE_COMMANDS=ON
cmake --build build -j "$jobs"
if [ "$all" = no ]; then
  run_tests release build -LE slow
else
  run_tests release build
fi

if [ "$all" = no ]; then
  build "Sanitizers on the modules of the preset fuzz, and fuzzers" build-fuzz fuzz
  cmake --build build-fuzz -j "$jobs"
  run_tests sanitizers build-fuzz
else
  build "Sanitizers on everything" build-asan asan -DVDBFUSE_MODULES=
  cmake --build build-asan -j "$jobs"
  run_tests sanitizers build-asan -LE 'style|consumer'
  build "clang++" build-clang release -DVDBFUSE_WITH_PYTHON="$with_python" -DCMAKE_CXX_COMPILER=clang++
  cmake --build build-clang -j "$jobs"
  run_tests clang++ build-clang -LE 'style|consumer'
  # Without precompiled headers: each file must include what it uses.
  build "Without PCL, static" build-static release -DVDBFUSE_WITH_PCL=OFF -DBUILD_SHARED_LIBS=OFF \
    -DVDBFUSE_PRECOMPILE=OFF
  cmake --build build-static -j "$jobs"
  run_tests "static, without PCL" build-static -LE style
  run_script "Pages and headers as HTML, without a warning" cmake --build build --target vdbfuse_docs
  run_script "The report of compare in a browser" tests/tool/compare_browser_test.py build/bin/vdbfuse build/compare_browser
  run_script "Saved configurations give the same again" tests/tool/replay_test.sh build/bin/vdbfuse
  run_script "Completion in bash and zsh" tests/tool/completion_test.sh build/bin/vdbfuse
  run_script "Manual pages" tests/tool/manual_test.sh build/bin/vdbfuse
  run_script "Ctrl-C during each step" tests/tool/interrupt_test.py build/bin/vdbfuse
  run_script "Full disks" tests/tool/full_disk_test.py build/bin/vdbfuse
  run_script "Names in every file (clang-tidy)" tests/style/tidy.sh build
  run_script "Debian packages in a clean system" tests/package/clean_system.sh
  run_script "First steps of README.md" tests/package/newcomer.sh --with-cache
fi

run_script "Fuzzers of the readers, $fuzz_seconds s each" tests/fuzz/run.sh "$fuzz_seconds"

step "Results"
printf '%s\n' "${results[@]}"
echo "${total_passed:-0} passed, $failed failed"
[ "$failed" -eq 0 ]
