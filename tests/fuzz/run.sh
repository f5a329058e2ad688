#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# tests/fuzz/run.sh [SECONDS [FORMAT...]]: feeds damaged files to the readers under address and undefined-behaviour
# sanitizers, each format for so many seconds (30), and prints executions a second and covered edges. What fails is
# kept in build-fuzz/findings/FORMAT; run `VDBFUSE_FUZZ_FORMAT=FORMAT build-fuzz/tests/fuzz/vdbfuse_fuzz FILE` to see it
# again. Grown corpora stay in build-fuzz/corpus. An input may take 20 s here, because instrumented code is slow and machines
# are busy; that none takes 5 s otherwise is what DamagedFiles.* tests.
set -euo pipefail
cd "$(dirname "$0")/../.."
seconds=${1:-30} # VDBFUSE_FUZZ_JOBS of them at a time; as many as there are processors
[ $# -eq 0 ] || shift
cmake --preset fuzz >build-fuzz.log 2>&1 ||
  { cat build-fuzz.log; exit 1; }
rm build-fuzz.log
cmake --build build-fuzz --target vdbfuse_fuzz -j "$(nproc)"
fuzzer=$PWD/build-fuzz/tests/fuzz/vdbfuse_fuzz
formats=("$@")
if [ ${#formats[@]} -eq 0 ]; then
  # PCD is read by the Point Cloud Library, which is not ours to instrument; its header is ours, and tested.
  mapfile -t formats < <(sed -nE 's/^ *\{"([a-z0-9_]+)", "[^"]*", [^,]*, .*/\1/p' tests/formats/{,image_}samples.cpp | sort -u | grep -v '^pcd$')
fi

# fuzz FORMAT SECONDS
fuzz() {
  local format=$1 corpus=build-fuzz/corpus/$1 findings=build-fuzz/findings/$1 log=build-fuzz/fuzz-$1.log
  mkdir -p "$corpus" "$findings"
  if VDBFUSE_FUZZ_FORMAT=$format VDBFUSE_FUZZ_SEEDS=$corpus "$fuzzer" "$corpus" -max_total_time="$2" -timeout=20 \
    -rss_limit_mb=3000 -malloc_limit_mb=1024 -max_len=65536 -artifact_prefix="$findings/" -print_final_stats=1 \
    -seed=1 >"$log" 2>&1; then
    status=ok
  else
    status=FAILED
  fi
  printf '%-12s %-7s %6s executions/s %6s edges %5s inputs kept\n' "$format" "$status" \
    "$(sed -n 's/^stat::average_exec_per_sec: *//p' "$log")" "$(grep -oE 'cov: [0-9]+' "$log" | tail -1 | cut -d' ' -f2)" \
    "$(find "$corpus" -type f | wc -l)"
  [ "$status" = ok ] || { grep -E -m1 -A12 'ERROR|runtime error|SUMMARY|uncaught|what\(\)' "$log" || tail -20 "$log"; return 1; }
}
export -f fuzz
export fuzzer
printf '%s\n' "${formats[@]}" | xargs -P "${VDBFUSE_FUZZ_JOBS:-$(nproc)}" -I{} bash -c "fuzz {} $seconds"
