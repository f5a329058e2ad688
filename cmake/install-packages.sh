#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# cmake/install-packages.sh SCOPE...: installs those packages of cmake/debian-packages.txt that are missing. Does
# nothing where all are there.
set -euo pipefail
list="$(dirname "$0")/debian-packages.txt"
missing=()
while read -r scope package; do
  for wanted in "$@"; do
    [ "$scope" = "$wanted" ] || continue
    dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null | grep -qx installed || missing+=("$package")
  done
done < <(grep -v '^#' "$list")
[ ${#missing[@]} -eq 0 ] && exit 0

as_root=()
if [ "$(id -u)" -ne 0 ]; then
  command -v sudo >/dev/null || { echo "missing: ${missing[*]}; install them as root, there is no sudo" >&2; exit 1; }
  as_root=(sudo env DEBIAN_FRONTEND=noninteractive)
fi
echo "Installing with apt-get: ${missing[*]}" >&2
export DEBIAN_FRONTEND=noninteractive
"${as_root[@]}" apt-get -qq update
"${as_root[@]}" apt-get -qq -o Dpkg::Use-Pty=0 install --yes --no-install-recommends "${missing[@]}" >/dev/null
