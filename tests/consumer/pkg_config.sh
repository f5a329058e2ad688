#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# tests/consumer/pkg_config.sh BUILD SOURCE FOLDER LIBDIR shared|static COMPILER [FLAGS...]: installs BUILD, moves it,
# and compiles SOURCE with what pkg-config says of it, and nothing else.
set -euo pipefail
build=$1 source=$2 folder=$3 libdir=$4 kind=$5
shift 5
rm -rf "$folder"
cmake --install "$build" --prefix "$folder/installed_here" >/dev/null
mv "$folder/installed_here" "$folder/prefix"
export PKG_CONFIG_PATH=$folder/prefix/$libdir/pkgconfig
asked=(--cflags --libs)
[ "$kind" = shared ] || asked+=(--static)
said=$(pkg-config "${asked[@]}" vdbfuse)
echo "$said"
case $said in *installed_here*) echo "it names the folder where it was installed at first" >&2; exit 1 ;; esac
# shellcheck disable=SC2086  # flags are words
"$@" -std=c++20 "$source" $said -o "$folder/program"
LD_LIBRARY_PATH=$folder/prefix/$libdir "$folder/program"
