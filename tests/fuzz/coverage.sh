#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# tests/fuzz/coverage.sh: which lines of the readers the corpora of tests/fuzz/run.sh reach, file by file. Run that
# first; needs the Debian package llvm.
set -euo pipefail
cd "$(dirname "$0")/../.."
cmake --preset fuzz -B build-fuzz-coverage -DVDBFUSE_SANITIZE= \
  -DCMAKE_CXX_FLAGS="-fprofile-instr-generate -fcoverage-mapping" >/dev/null
cmake --build build-fuzz-coverage --target vdbfuse_fuzz -j "$(nproc)"
fuzzer=build-fuzz-coverage/tests/fuzz/vdbfuse_fuzz
for corpus in build-fuzz/corpus/*; do
  VDBFUSE_FUZZ_FORMAT=$(basename "$corpus") LLVM_PROFILE_FILE=$fuzzer-$(basename "$corpus").profraw \
    "$fuzzer" -runs=0 "$corpus" >/dev/null 2>&1
done
llvm-profdata merge -o $fuzzer.profdata $fuzzer-*.profraw
llvm-cov report "$fuzzer" -instr-profile=$fuzzer.profdata lib/formats lib/io | grep -E 'Filename|\.cpp|TOTAL' |
  awk '{print $1, $8, $9, $10}' | column -t
