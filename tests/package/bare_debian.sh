#!/usr/bin/env bash
# Usage: bare_debian.sh PACKAGES
# Installs the packages of a folder on a bare Debian 12 (debootstrap's smallest, in a temporary
# folder), uses them, removes them and looks at what is left. Needs root and Debian's packages, takes
# minutes; DEBIAN_MIRROR is where they come from [http://deb.debian.org/debian].
# shellcheck source=tests/package/lib.sh
source "$(dirname "$0")/lib.sh"
packages=$(realpath "$1")
outside=$PWD/tests/package/outside
mirror=${DEBIAN_MIRROR:-http://deb.debian.org/debian}
((EUID == 0)) || Skip "needs root"
command -v debootstrap >/dev/null || Skip "debootstrap is missing: sudo apt-get install debootstrap"
if [[ -z ${BARE_DEBIAN_INSIDE:-} ]]; then # what is mounted goes with this namespace
  rm -rf "$folder"
  BARE_DEBIAN_INSIDE=yes exec unshare --mount --pid --fork --kill-child --mount-proc "$0" "$packages"
fi

root=$folder/root
echo "== a bare Debian 12"
debootstrap --variant=minbase bookworm "$root" "$mirror" >"$folder/log" 2>&1 ||
  Skip "debootstrap could not make one from $mirror: $(tail -1 "$folder/log")"
trap 'umount "$root/proc" && rm -rf --one-file-system "$folder"' EXIT
mount -t proc proc "$root/proc"
cp "$packages"/*.deb "$root/mnt"
echo force-unsafe-io >"$root/etc/dpkg/dpkg.cfg.d/fast" # nobody keeps this disk
cp /etc/resolv.conf /etc/hosts "$root/etc"
printf '#!/bin/sh\nexit 101\n' >"$root/usr/sbin/policy-rc.d"
chmod +x "$root/usr/sbin/policy-rc.d"
In() { chroot "$root" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin DEBIAN_FRONTEND=noninteractive "$@"; }
Apt() {
  In apt-get -q -y -o Dpkg::Use-Pty=0 "$@" >"$folder/log" 2>&1 || {
    tail -20 "$folder/log"
    echo "FAILED: apt-get $*"
    exit 1
  }
}
# Whatever stands in the system, without what apt itself keeps.
List() {
  In find / -xdev \( -path /proc -o -path /mnt -o -path /var/cache/apt -o -path /var/lib/apt \) -prune \
    -o -print | sort
}

Apt update
SECONDS=0
In sh -c 'apt-get -q -y -o Dpkg::Use-Pty=0 install /mnt/visavis_*.deb' >"$folder/log" 2>&1 || {
  tail -20 "$folder/log"
  echo "FAILED: apt-get install"
  exit 1
}
echo "== installed with all that it needs and recommends in $SECONDS s: $(grep 'newly installed' "$folder/log")"
In getent passwd visavis >/dev/null || Wrong "there is no user visavis"
In getent group visavis-operators >/dev/null || Wrong "there is no group visavis-operators"
In visudo -cq || Wrong "visudo refuses the rules"
In systemctl is-enabled -q visavis.target || Wrong "visavis.target is not enabled"
# shellcheck disable=SC2016  # dpkg-query's own variable
version=$(In dpkg-query -W -f '${Version}' visavis)
Equal "fleet-control version" "$(In /usr/lib/visavis/fleet-control version)" "$version"
for program in "$root"/usr/bin/visavis-*; do
  In "${program#"$root"}" --help >/dev/null || Wrong "$(basename "$program") --help fails"
done
while read -r service; do
  In "visavis-$service" --config "/etc/visavis/$service.yaml" --check-config ||
    Wrong "visavis-$service refuses its configuration"
done <"$root/usr/lib/visavis/services"
tracking=$(In sh -ec 'cd /tmp; visavis-simulator --fast --record in.lcm --seconds 3
  visavis-recogniser --replay in.lcm --record out.lcm
  visavis-evaluate out.lcm --figures figures --json - | grep share_tracking; ls figures/*.png >&2') ||
  Wrong "simulator, recogniser and evaluate do not work together"
echo "== $tracking"
[[ $tracking =~ :\ (1|0\.9) ]] || Wrong "the head is not tracked"
install -d "$root/var/lib/visavis/logs" "$root/etc/visavis/.fleet-1"
ln -s .fleet-1 "$root/etc/visavis/fleet"
touch "$root/var/lib/visavis/logs/visavis-1.lcm" "$root/etc/visavis/fleet/logger.yaml"

Apt remove visavis
# Left OF: paths that only ours have.
Left() { List | grep -i visavis | grep -vE '^/var/lib/dpkg/info/visavis\.(list|postrm)$' | sort; }
Equal "what is left but configuration and logs" "$(Left | grep -vE '^/etc/visavis(/|$)|^/var/lib/visavis(/|$)' |
  paste -sd ' ')" "/etc/sudoers.d/visavis-fleet /etc/systemd/system/multi-user.target.wants/visavis.target \
/var/lib/systemd/deb-systemd-helper-enabled/multi-user.target.wants/visavis.target \
/var/lib/systemd/deb-systemd-helper-enabled/visavis.target.dsh-also"
[[ -f $root/var/lib/visavis/logs/visavis-1.lcm ]] || Wrong "a log went with the package"
[[ -f $root/etc/visavis/fleet/logger.yaml ]] || Wrong "a configuration went with the package"
Apt purge visavis
Equal "what a purge leaves" "$(Left | paste -sd ' ')" \
  "/var/lib/visavis /var/lib/visavis/logs /var/lib/visavis/logs/visavis-1.lcm"

echo "== types and development files"
In sh -c 'apt-get -q -y -o Dpkg::Use-Pty=0 install --no-install-recommends /mnt/visavis-lcmtypes_*.deb \
  /mnt/visavis-dev_*.deb cmake g++ make' >"$folder/log" 2>&1 || {
  tail -20 "$folder/log"
  echo "FAILED: apt-get install of the development files"
  exit 1
}
cp -r "$outside" "$root/tmp/outside"
In sh -ec 'cmake -S /tmp/outside -B /tmp/outside/build && cmake --build /tmp/outside/build' \
  >"$folder/log" 2>&1 || Wrong "the outside program: $(tail -20 "$folder/log")"
Equal "what it prints" "$(In /tmp/outside/build/outside)" "HEAD_POSE 42 TRACKING 1 z 1.050 m"
Finish && echo "== all well"
