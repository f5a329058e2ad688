# SPDX-License-Identifier: Apache-2.0
# Sourced. A Debian 12 with nothing in it, in a folder, and commands run there as root. Needs root and debootstrap.
#
#   make_root FOLDER        FOLDER/root is made anew, from FOLDER/debian-12.tar where an earlier run left it
#   in_root COMMAND...      runs there, with /proc and the network of this system
#
# Debian packages that are fetched stay in FOLDER/archives for the next time.

# can_make_root: says why not, where it cannot be done.
can_make_root() {
  [ "$(id -u)" -eq 0 ] || { echo "not root"; return 1; }
  command -v debootstrap >/dev/null || { echo "no debootstrap"; return 1; }
}

make_root() {
  folder=$1 root=$1/root
  rm -rf "$root"
  mkdir -p "$root" "$folder/archives/partial"
  if [ ! -f "$folder/debian-12.tar" ]; then
    debootstrap --variant=minbase bookworm "$folder/new" "${DEBIAN_MIRROR:-http://deb.debian.org/debian}" \
      >"$folder/debootstrap.log" 2>&1 ||
      { tail -n 5 "$folder/debootstrap.log" >&2; return 1; }
    tar -C "$folder/new" -cf "$folder/debian-12.tar.new" .
    mv "$folder/debian-12.tar.new" "$folder/debian-12.tar"
    rm -rf "$folder/new"
  fi
  tar -C "$root" -xf "$folder/debian-12.tar"
  cp /etc/resolv.conf /etc/hosts "$root/etc/"
  # It is thrown away: no need to wait for the disk.
  echo force-unsafe-io >"$root/etc/dpkg/dpkg.cfg.d/unsafe-io"
  in_root apt-get -qq update
}

# The mounts end with the command.
in_root() {
  unshare --mount sh -ec '
    mount -t proc proc "$0/proc"
    mount --bind "$1" "$0/var/cache/apt/archives"
    root=$0
    shift
    exec chroot "$root" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LC_ALL=C.UTF-8 \
      DEBIAN_FRONTEND=noninteractive "$@"
  ' "$root" "$folder/archives" "$@"
}

# install_in_root PACKAGE...: names, or files of the root beginning with ./ or /; what they need comes from the mirror.
install_in_root() {
  in_root apt-get -qq -o Dpkg::Use-Pty=0 -o APT::Sandbox::User=root -o APT::Keep-Downloaded-Packages=true \
    install --yes --no-install-recommends "$@" >>"$folder/apt.log" 2>&1 ||
    { tail -n 20 "$folder/apt.log" >&2; return 1; }
}
