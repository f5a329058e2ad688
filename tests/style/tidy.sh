#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# tests/style/tidy.sh BUILD_FOLDER: the names of every source file of the library and the tool, by clang-tidy.
# The build folder must have been configured with CMAKE_EXPORT_COMPILE_COMMANDS=ON.
set -euo pipefail
cd "$(dirname "$0")/../.."
build=${1:?build folder}
find lib tools -name '*.cpp' ! -path 'lib/pcl/*' -print0 |
  xargs -0 -n 4 -P "$(nproc)" clang-tidy --quiet --extra-arg=-Wno-unknown-warning-option -p "$build"
