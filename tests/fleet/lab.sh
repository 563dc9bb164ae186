# To be sourced: several whole machines on this one, for tests. A machine has a root of its own (an
# overlay of ours), a network stack, systemd as PID 1 and sshd; a bridge joins them. All of it lives
# in namespaces of the test: whatever ends the test, kill -9 included, ends the machines, and nothing
# is installed or written outside of them.
# Needs root, util-linux, iproute2, systemd, overlayfs and cgroup v2; the packages that machines have
# and this one lacks are downloaded from Debian into the machines' layer alone.
# shellcheck shell=bash

LAB_NET=10.77.0
LAB_PACKAGES=(openssh-server openssh-client sudo dbus systemd-sysv iproute2 procps)

# Why there can be no machines here; nothing: there can.
LabWhyNot() {
  local tool
  ((EUID == 0)) || { echo "needs root"; return; }
  for tool in unshare nsenter ip tar chroot apt-get; do
    command -v "$tool" >/dev/null || { echo "needs $tool"; return; }
  done
  [[ -x /lib/systemd/systemd ]] || { echo "needs systemd on this machine"; return; }
  [[ -w $(LabCgroups) ]] || { echo "needs cgroup v2 to write to"; return; }
  # shellcheck disable=SC2016  # for the inner shell
  unshare --mount --uts --ipc --net --cgroup --pid --fork --kill-child bash -ec '
    mount -t tmpfs tmpfs /mnt; mkdir /mnt/up /mnt/work /mnt/root
    mount -t overlay overlay -o lowerdir=/,upperdir=/mnt/up,workdir=/mnt/work /mnt/root
    ip link add lab0 type bridge; ip link add lab1 type veth peer name lab2' >/dev/null 2>&1 ||
    echo "the kernel or the container allows no namespaces, overlay, bridge or veth"
}

# Where cgroup v2 is mounted.
LabCgroups() { awk '$3 == "cgroup2" {print $2; exit}' /proc/mounts; }

# LabEnter SCRIPT ARGUMENTS...: runs the script anew in namespaces of its own, with LAB, a folder in
# memory, and does not return. The script's second life has LAB set.
LabEnter() {
  local folder code=0 group
  folder=$(mktemp -d)
  trap '' INT TERM # the script inside gets them too, and ends; then we tidy
  LabGoFirst "${folder##*/}"
  # shellcheck disable=SC2016  # for the inner shell
  LAB=$folder unshare --mount --pid --fork --kill-child --mount-proc --propagation private bash -c '
    mount -t tmpfs -o mode=755 tmpfs "$LAB" && exec "$@"' lab "$@" || code=$?
  echo "$BASHPID" 2>/dev/null >/sys/fs/cgroup/cpu/cgroup.procs || true
  for group in "$(LabCgroups)/${folder##*/}"-* "/sys/fs/cgroup/cpu/${folder##*/}"; do
    [[ ! -d $group ]] || find "$group" -depth -type d -exec rmdir {} + 2>/dev/null || true
  done
  rmdir "$folder"
  exit "$code"
}

# The machines go before what else this machine does, as if they had it for themselves (where cgroup
# v1 has the processors; in v2 LabOn does it). Nice serves for nothing here: it counts within a
# session alone (sched_autogroup).
LabGoFirst() {
  local group=/sys/fs/cgroup/cpu/$1
  [[ -w /sys/fs/cgroup/cpu/cpu.shares ]] || return 0
  mkdir "$group" && echo 100000 >"$group/cpu.shares" && echo "$BASHPID" >"$group/cgroup.procs"
}

# LabMount: what the machines have and we lack, as an overlay of our root at $LAB/make; programs run
# in it by LabChroot. LabUnmount ends that: $LAB/layer then holds what was added.
LabMount() {
  mkdir -p "$LAB"/{layer,work,make}
  mount -t overlay overlay -o "lowerdir=/,upperdir=$LAB/layer,workdir=$LAB/work" "$LAB/make"
  mount -t proc proc "$LAB/make/proc"
  mount --rbind /dev "$LAB/make/dev"
  mount -t tmpfs tmpfs "$LAB/make/tmp"
  mount -t tmpfs tmpfs "$LAB/make/run"
}
LabChroot() { chroot "$LAB/make" env DEBIAN_FRONTEND=noninteractive "$@"; }
LabUnmount() { umount -R "$LAB/make"; }

# LabInstall PACKAGE...: into the layer, from Debian or from a file under /tmp of the layer.
LabInstall() {
  local options=(-q -y -o Dpkg::Use-Pty=0 -o APT::Sandbox::User=root --no-install-recommends)
  LabChroot apt-get "${options[@]}" install "$@" </dev/null >"$LAB/apt.log" 2>&1 ||
    { LabChroot apt-get -q update && LabChroot apt-get "${options[@]}" install "$@"; } \
      </dev/null >"$LAB/apt.log" 2>&1
}

# LabBase CACHE: the layer with LAB_PACKAGES. CACHE, a tar, is taken if it was made on a system like
# this one, else written. Then LabMount is in force.
LabBase() {
  local cache=$1 key
  key=$({ echo "${LAB_PACKAGES[@]}"; cat /var/lib/dpkg/status "${BASH_SOURCE[0]}"; } | sha256sum | cut -c1-16)
  if [[ -f $cache && $(cat "$cache.key" 2>/dev/null) == "$key" ]]; then
    mkdir -p "$LAB/layer"
    tar -C "$LAB/layer" --xattrs --xattrs-include='trusted.*' -xf "$cache"
    LabMount
    return
  fi
  LabMount
  # None of the services that this machine happens to run, none started by an installation.
  rm -rf "$LAB"/make/etc/systemd/system "$LAB"/make/etc/rc?.d/S*
  mkdir "$LAB/make/etc/systemd/system"
  printf '#!/bin/sh\nexit 101\n' >"$LAB/make/usr/sbin/policy-rc.d"
  chmod +x "$LAB/make/usr/sbin/policy-rc.d"
  if ! LabInstall "${LAB_PACKAGES[@]}"; then
    tail -3 "$LAB/apt.log" >&2
    return 1
  fi
  LabUnmount
  rm -rf "$LAB"/layer/var/{cache/apt,cache/man,cache/debconf,log} "$LAB"/layer/usr/share/{doc,man}
  mkdir -p "$(dirname "$cache")"
  tar -C "$LAB/layer" --xattrs --xattrs-include='trusted.*' -cf "$cache.new" .
  mv "$cache.new" "$cache"
  echo "$key" >"$cache.key"
  LabMount
}

# LabSwitch: leaves this network for one of our own, the machines' Ethernet switch. To be called in
# the script's main process, as it runs SCRIPT ARGUMENTS... anew there.
LabSwitch() {
  # shellcheck disable=SC2016  # for the inner shell
  LAB_NET=$LAB_NET exec unshare --net bash -ec '
    ip link set lo up; ip link add br0 type bridge mcast_snooping 0; ip link set br0 up
    ip addr add "$LAB_NET.254/24" dev br0; ip route add 224.0.0.0/4 dev br0
    exec "$@"' lab "$@"
}

# LabDisk NAME: the folder that becomes the machine's /, where it differs from the layer's.
LabDisk() { echo "$LAB/$1/disk"; }

# LabMake NAME NUMBER: a machine named NAME at address LAB_NET.NUMBER, not yet switched on.
LabMake() {
  local name=$1 number=$2 disk unit
  disk=$(LabDisk "$name")
  mkdir -p "$disk"/etc/systemd/system "$LAB/$name"/{work,root}
  echo "$number" >"$LAB/$name/number"
  echo "$name" >"$disk/etc/hostname"
  systemd-id128 new >"$disk/etc/machine-id"
  printf '%s\n' '127.0.0.1 localhost' "$LAB_NET.$number $name" >"$disk/etc/hosts"
  : >"$disk/etc/fstab"
  for unit in systemd-{networkd,resolved,timesyncd,udevd,logind,udev-trigger,modules-load,remount-fs}.service \
    systemd-udevd-{control,kernel}.socket sys-kernel-debug.mount sys-kernel-tracing.mount \
    dev-hugepages.mount dev-mqueue.mount proc-sys-fs-binfmt_misc.automount console-getty.service \
    getty@.service; do
    ln -s /dev/null "$disk/etc/systemd/system/$unit"
  done
}

# LabOn NAME: switches a machine on. Its disk is as it was left.
LabOn() {
  local name=$1 group pid number
  number=$(cat "$LAB/$name/number")
  group=$(LabCgroups)/${LAB##*/}-$name
  mkdir -p "$group"
  [[ ! -w $group/cpu.weight ]] || echo 10000 >"$group/cpu.weight"
  # shellcheck disable=SC2016  # for the inner shells
  LAB_NAME=$name LAB_GROUP=$group LAB_ADDRESS=$LAB_NET.$number setsid bash -c '
    echo $$ >"$LAB_GROUP/cgroup.procs"
    exec unshare --mount --uts --ipc --net --cgroup --pid --fork --kill-child=SIGKILL \
      --propagation private bash -ec "$0"' '
    cd "$LAB/$LAB_NAME"
    hostname "$LAB_NAME"
    mount -t overlay overlay -o "lowerdir=$LAB/layer:/,upperdir=disk,workdir=work" root
    cd root
    mount -t proc proc proc
    mount -t sysfs sysfs sys
    mount -t cgroup2 cgroup2 sys/fs/cgroup
    mount -t tmpfs -o mode=755 tmpfs run
    mount -t tmpfs tmpfs tmp
    mount -t tmpfs -o mode=755 tmpfs dev
    mkdir dev/pts dev/shm
    mount -t devpts -o newinstance,ptmxmode=0666,mode=620,gid=5 devpts dev/pts
    mount -t tmpfs tmpfs dev/shm
    for d in null zero full random urandom tty; do touch dev/$d; mount --bind /dev/$d dev/$d; done
    ln -s pts/ptmx dev/ptmx; ln -s /proc/self/fd dev/fd
    ip link set lo up
    until [ -e /sys/class/net/eth0 ] || [ -e sys/class/net/eth0 ]; do sleep 0.02; done
    ip addr add "$LAB_ADDRESS/24" dev eth0
    ip link set eth0 up
    ip route add 224.0.0.0/4 dev eth0 proto static
    mkdir -p oldroot
    pivot_root . oldroot
    umount -l /oldroot
    exec env -i container=lab PATH=/usr/sbin:/usr/bin:/sbin:/bin /lib/systemd/systemd \
      --log-target=console --log-level=notice --show-status=no --unit=multi-user.target
  ' </dev/null >"$LAB/$name/console.log" 2>&1 &
  echo $! >"$LAB/$name/unshare"
  WaitFor 5 "a first process on $name" LabFindInit "$name"
  pid=$(cat "$LAB/$name/pid")
  WaitFor 5 "the port of $name" LabPlugIn "$name" "$number" "$pid"
  ip link set "port-$name" master br0 up
}

# A machine's network card, which keeps its address. Fails while the kernel still tidies away the one
# that it had before its power was cut.
LabPlugIn() {
  ip link add "port-$1" type veth peer name eth0 address "02:00:00:00:00:0$2" netns "$3" 2>/dev/null
}

# Writes the pid of the machine's PID 1, as seen from here.
LabFindInit() {
  local parent child
  parent=$(cat "$LAB/$1/unshare")
  child=$(cat "/proc/$parent/task/$parent/children" 2>/dev/null) || return 1
  [[ $child =~ ^([0-9]+)\ ?$ && $(readlink "/proc/$parent/exe") == */unshare ]] || return 1
  echo "${BASH_REMATCH[1]}" >"$LAB/$1/pid"
}

# LabRun NAME COMMAND...: as root on a machine.
LabRun() {
  local name=$1
  shift
  nsenter -t "$(cat "$LAB/$name/pid")" -a env -C / "$@"
}

LabIsUp() {
  local state
  state=$(LabRun "$1" systemctl is-system-running 2>/dev/null) || true
  [[ $state == running || $state == degraded ]]
}

# LabOff NAME: pulls the plug.
LabOff() {
  local pid
  pid=$(cat "$LAB/$1/pid")
  kill -KILL "$pid"
  wait "$(cat "$LAB/$1/unshare")" 2>/dev/null || true
  rm "$LAB/$1/pid"
}

# Takes a machine's cable out of the switch, and puts it in again.
LabCut() { ip link set "port-$1" down; }
LabHeal() { ip link set "port-$1" up; }

# WaitFor SECONDS WHAT COMMAND...: until the command succeeds; else names what did not come.
WaitFor() {
  local seconds=$1 what=$2 end
  shift 2
  end=$((${EPOCHREALTIME/./} + seconds * 1000000))
  until "$@"; do
    if ((${EPOCHREALTIME/./} > end)); then
      echo "$what: not within $seconds s" >&2
      return 1
    fi
    Nap
  done
}

# A moment between two looks at a condition.
Nap() { sleep 0.02; }
