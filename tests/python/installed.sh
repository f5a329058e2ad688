#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# installed.sh CMAKE BUILD_FOLDER PYTHON PREFIX: installs the libraries and the Python package below PREFIX, moves them, and
# uses them from there.
set -euo pipefail
cmake=$1 build=$2 python=$3 prefix=$4
rm -rf "$prefix" "$prefix.moved"
for component in runtime python; do
  "$cmake" --install "$build" --prefix "$prefix" --component $component >/dev/null
done
mv "$prefix" "$prefix.moved"
module=$(find "$prefix.moved" -path '*dist-packages/vdbfuse/__init__.py')
cd /
PYTHONPATH=${module%/vdbfuse/__init__.py} "$python" -B - "$prefix.moved" <<'PROGRAM'
import sys
import numpy as np
import vdbfuse
assert vdbfuse.__file__.startswith(sys.argv[1]), vdbfuse.__file__
with open("/proc/self/maps", encoding="ascii") as maps:
    libraries = {line.split()[-1] for line in maps if "libvdbfuse.so" in line}
assert all(library.startswith(sys.argv[1]) for library in libraries), libraries
mesh = vdbfuse.mesh(np.eye(3), [[0, 1, 2]])
print("vdbfuse", vdbfuse.__version__, mesh, "area", round(mesh.area, 3))
PROGRAM
rm -rf "$prefix.moved"
