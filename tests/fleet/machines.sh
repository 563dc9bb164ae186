# To be sourced after lab.sh: the lab's machines as a robot's: Visavis installed, an operator who may
# log in from the machine `storage`, the seat, and control the services.
# shellcheck shell=bash

# InstallVisavis BUILD: the package of programs, as scripts/package makes it, into the layer, between
# LabBase and LabUnmount.
InstallVisavis() {
  if ! { cmake --build "$1" --target visavis_package_files &&
    cpack --config "$1/CPackConfig.cmake" -B "$LAB/pack" -D CPACK_COMPONENTS_ALL=programs \
      -D CPACK_DEBIAN_COMPRESSION_TYPE=none; } >"$LAB/pack.log" 2>&1; then
    tail -5 "$LAB/pack.log" >&2
    return 1
  fi
  mv "$LAB"/pack/visavis_*.deb "$LAB/make/tmp/visavis.deb"
  rm -r "$LAB/pack"
  LabInstall /tmp/visavis.deb || { tail -5 "$LAB/apt.log" >&2; return 1; }
}

# Between LabBase and LabUnmount: the user, and keys between all machines.
MakeOperator() {
  local home=$LAB/make/home/pilot
  LabChroot useradd --create-home --shell /bin/bash --groups visavis-operators,systemd-journal pilot
  mkdir -m 700 "$home/.ssh"
  LabChroot ssh-keygen -q -t ed25519 -N '' -f /home/pilot/.ssh/id_ed25519
  cp "$home/.ssh/id_ed25519.pub" "$home/.ssh/authorized_keys"
  : >"$home/.hushlogin"
  LabChroot chown -R pilot:pilot /home/pilot
}

# Operate COMMAND: a shell's command by the operator at the seat, in the folder ~/robot.
Operate() { LabRun storage setpriv --reuid=pilot --regid=pilot --init-groups env -i \
  HOME=/home/pilot USER=pilot PATH=/usr/bin:/bin LC_ALL=C.UTF-8 bash -c "cd ~/robot && $1"; }
