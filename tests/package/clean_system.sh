#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# tests/package/clean_system.sh [--with-pcl]: builds the Debian packages, asks lintian about them, installs them in a clean
# Debian 12, runs the tool there and builds programs against the library, removes them, and looks for what is left. Works
# in build-package/. --with-pcl: also the PCL part, which fetches a few hundred megabytes more.
# Exit code 77: skipped, it needs root and debootstrap.
set -euo pipefail
cd "$(dirname "$0")/../.."
with_pcl=no
[ "${1:-}" = --with-pcl ] && with_pcl=yes
. tests/package/clean_root.sh
reason=$(can_make_root) || { echo "clean system: skipped, $reason" >&2; exit 77; }
fail() { echo "clean system: $1" >&2; exit 1; }
# package NAME: its file, as the clean system sees it.
package() { (cd build-package && echo "/packages/$(ls "$1"_*.deb)"); }
step() { printf '%4d s  %s\n' $SECONDS "$*"; }

step "Packages"
rm -f build-package/*.deb
cmake --preset package -DVDBFUSE_WERROR=ON -DVDBFUSE_WITH_PCL="${VDBFUSE_WITH_PCL:-ON}" >build-package.log 2>&1 &&
  cmake --build --preset package -j "$(nproc)" >>build-package.log 2>&1 &&
  cpack --preset package >>build-package.log 2>&1 || { tail -n 30 build-package.log; fail "they cannot be built"; }
rm build-package.log
for package in libvdbfuse libvdbfuse-dev vdbfuse python3-vdbfuse; do
  [ -f build-package/${package}_*.deb ] || fail "there is no $package"
done
(cd build-package && du -h ./*.deb)
if command -v lintian >/dev/null; then
  lintian --allow-root --fail-on error build-package/*.deb || fail "lintian finds errors"
fi

step "A clean Debian 12"
make_root build-package/clean
mkdir "$root/packages" "$root/check"
cp build-package/*.deb "$root/packages/"
cp -r tests/consumer/project "$root/check/consumer"

step "The tool"
install_in_root "$(package vdbfuse)" "$(package libvdbfuse)"
in_root sh -ec '
  cd /check
  vdbfuse --version
  vdbfuse synth figure scan --arc ring --views 36 --size 160x120 --outliers 0.1 --quiet
  vdbfuse fuse scan mesh.ply --resolution 64 --quiet
  vdbfuse evaluate mesh.ply scan/truth.ply
  vdbfuse render mesh.ply mesh.png
  if vdbfuse info missing; then exit 1; fi
' || fail "the tool does not run"
cp "$root/check/mesh.png" build-package/

step "The Python package"
install_in_root "$(package python3-vdbfuse)"
in_root sh -ec '
  cd /check
  python3 -c "import vdbfuse; vdbfuse.fuse(\"scan\", resolution=64).save(\"python.ply\")"
  cmp mesh.ply python.ply
' || fail "the Python package does not make the mesh of the tool"

step "The library, by CMake and by pkg-config"
install_in_root "$(package libvdbfuse-dev)" g++ cmake make pkg-config
in_root sh -ec '
  cd /check
  cmake -S consumer -B by-cmake >/dev/null
  cmake --build by-cmake >/dev/null
  by-cmake/consumer
  g++ -std=c++20 -O1 consumer/main.cpp $(pkg-config --cflags --libs vdbfuse) -o by-pkg-config
  ./by-pkg-config
  cmake -S /usr/share/doc/libvdbfuse-dev/examples -B examples >/dev/null
  cmake --build examples --target vdbfuse_example_02_rgbd_folder >/dev/null
  ctest --test-dir examples --output-on-failure -R Example.02 | grep "tests passed"
' || fail "a program cannot be built against libvdbfuse-dev"

if [ "$with_pcl" = yes ]; then
  step "The PCL part"
  install_in_root "$(package libvdbfuse-pcl)"
  {
    printf '%s\n' 'VERSION 0.7' 'FIELDS x y z' 'SIZE 4 4 4' 'TYPE F F F' 'COUNT 1 1 1' 'WIDTH 5' 'HEIGHT 4' \
      'VIEWPOINT 0 0 0 1 0 0 0' 'POINTS 20' 'DATA ascii'
    for y in -0.15 -0.05 0.05 0.15; do
      for x in -0.2 -0.1 0 0.1 0.2; do echo "$x $y 1"; done
    done
  } >"$root/check/cloud.pcd"
  in_root vdbfuse info /check/cloud.pcd || fail "PCD files are not read"
fi

step "Nothing is left"
in_root sh -ec '
  apt-get -qq -o Dpkg::Use-Pty=0 purge --yes "vdbfuse" "libvdbfuse*" "python3-vdbfuse" >/dev/null
  find / -xdev -iname "*vdbfuse*" -not -path "/check/*" -not -path "/packages/*" >/check/left
  dpkg-query -W -f "\${Package} \${db:Status-Status}\n" | grep -i vdbfuse >>/check/left || true
  ldconfig -p | grep -i vdbfuse >>/check/left || true
'
[ ! -s "$root/check/left" ] || { cat "$root/check/left"; fail "purge leaves these"; }
rm -rf "$root"
step "Done"
