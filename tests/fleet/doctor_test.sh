#!/usr/bin/env bash
# doctor_test.sh REPO: in a network of its own, makes one fault after the other, sees the doctor name
# it, runs the command that the doctor says mends it, and sees that it does.
set -euo pipefail
repo=${1:?the checkout}
if [[ -z ${DOCTOR_TEST:-} ]]; then
  as_root=()
  ((EUID == 0)) || as_root=(--user --map-root-user)
  if ! unshare "${as_root[@]}" --net --mount bash -ec 'ip link add d0 type veth peer name p0
    ip link add br0 type bridge
    echo 1 >/proc/sys/net/ipv4/conf/d0/rp_filter
    mount -t sysfs sysfs /sys' 2>/dev/null; then
    echo "skipped: this user, or this container, may have no network of its own to change"
    exit 77
  fi
  DOCTOR_TEST=$(mktemp -d)
  export DOCTOR_TEST
  code=0
  unshare "${as_root[@]}" --net --mount "$0" "$@" || code=$?
  rm -rf "$DOCTOR_TEST"
  exit "$code"
fi
cd "$DOCTOR_TEST"
mount -t sysfs sysfs /sys # this network's
printf '#!/bin/sh\nexec "$@"\n' >sudo
# What keeps this machine's clock is of no concern here: chrony says what $PWD/chrony holds.
printf '#!/bin/sh\ncat "%s/chrony" 2>/dev/null\n' "$PWD" >chronyc
printf '#!/bin/sh\necho no\n' >timedatectl
chmod +x sudo chronyc timedatectl
export PATH=$PWD:$PATH
num_failures=0
url='udpm://239.255.76.67:7667?ttl=1&recv_buf_size=4096' services='' several=yes
export url services several

Failed() {
  printf 'FAILED: %s\n' "$1"
  num_failures=$((num_failures + 1))
}
Look() { bash "$repo/scripts/doctor-checks.sh" >checks; }
# Finds VERDICT CHECK REGEX: a line of the last look; sets mend.
Finds() {
  mend=$(awk -F'\t' -v v="$1" -v c="$2" -v r="$3" '$1 == v && $2 == c && $3 ~ r {print $4; found = 1; exit}
    END {exit !found}' checks)
}
# Mends NAME VERDICT CHECK REGEX: the fault is found, its command removes it, and then CHECK is ok.
Mends() {
  local name=$1 verdict=$2 check=$3 regex=$4
  Look
  if ! Finds "$verdict" "$check" "$regex"; then
    Failed "$name: not found: $(grep "$check" checks || true)"
    return
  fi
  bash -c "$mend" >/dev/null || Failed "$name: \"$mend\" fails"
  Look
  ! Finds "$verdict" "$check" "$regex" || Failed "$name: is there still after \"$mend\""
}
# Names NAME VERDICT CHECK REGEX MEND: is found, with this word in what mends it.
Names() {
  Look
  if ! Finds "$2" "$3" "$4" || [[ $mend != *"$5"* ]]; then Failed "$1: $(grep "$3" checks || true)"; fi
}

ip link add d0 type veth peer name p0
ip link set p0 up
ip link set d0 up
ip addr add 10.0.0.1/24 dev d0
Mends "no multicast route" FAIL route "none to 239.255.76.67"
Names "a route made by hand" warn route "by hand" "Destination=224.0.0.0/4"
ip link set lo up
ip route replace 224.0.0.0/4 dev lo
Mends "a route by lo where several machines are meant" FAIL route "leaves by lo"
Finds ok route "leaves by d0" || Failed "the route's interface is not named"

ip link set d0 multicast off
Mends "no flag MULTICAST" FAIL interface "lacks the flag MULTICAST"
ip link set d0 down
ip link set d0 up
ip route replace 224.0.0.0/4 dev d0 proto static
Look
! Finds warn route "by hand" || Failed "a route of the network's configuration is taken for one made by hand"
Finds ok interface "d0, MTU" || Failed "a sound interface is not ok"

ip link add d1 type veth peer name p1
ip link set p1 up
ip link set d1 up
ip addr add 10.0.1.1/24 dev d1
echo 1 >/proc/sys/net/ipv4/conf/d0/rp_filter
Mends "strict reverse path filter with two interfaces" warn rp_filter "strict"
Names "two interfaces" warn route "2 interfaces have addresses: is d0" "dev NIC"

ip link add br0 type bridge mcast_snooping 1
Mends "a bridge that snoops without a querier" warn igmp "br0 snoops without a querier"

url='udpm://239.255.76.67:7667?ttl=0&recv_buf_size=4096'
Names "ttl=0" FAIL url "ttl=0: nothing leaves" "ttl=1"
url='udpm://239.255.76.67:7667?ttl=1'
Names "no recv_buf_size" FAIL url "no recv_buf_size" "recv_buf_size=4194304"
url='udpm://239.255.76.67:7667?ttl=1&recv_buf_size=999999999'
Names "small buffers" FAIL buffers "must be 999999999" "sysctl -w net.core.rmem_max=999999999"

url='udpm://239.255.76.67:7667?ttl=1&recv_buf_size=4096'
Names "a clock that nobody synchronises" FAIL clock "not known to be synchronised" "apt install chrony"
tracking() { echo "A29FC87B,162.159.200.123,4,1700000000.1,$1,0.00002,0.00004,-10.2,0.001,0.05,0.02,0.001,64.2,$2" >chrony; }
tracking -0.000021 Normal
Look
Finds ok clock "chrony, offset -0.000021 s" || Failed "a clock that chrony keeps is not ok"
tracking -0.021 Normal
Names "a clock that is off" FAIL clock "chrony: offset -0.021 s" "chronyc makestep"
tracking 0.00001 "Not synchronised"
Names "a clock without a server" FAIL clock "Not synchronised" "chronyc"
several=no
Names "a clock of one machine alone" warn clock "Not synchronised" "chronyc"
several=yes
rm chrony

# A camera's program that says what $PWD/cameras holds.
printf '#!/bin/sh\ncat "%s/cameras"\n' "$PWD" >visavis-stereo-capture
chmod +x visavis-stereo-capture
services=stereo-capture
echo "no GigE Vision or USB3 Vision camera answers" >cameras
Names "no camera" FAIL cameras "none found" "--list"
printf '%s\n' "Maker Model LEFT at 10.0.0.5" "  another program holds it" "  sensor: 640x480" \
  "Maker Model RIGHT at 10.0.0.6" >cameras
Names "a camera that another program holds" FAIL cameras "1 of 2 are held by another program" "end that program"
sed -i '/holds/d' cameras
Look
Finds ok cameras "2 found" || Failed "two cameras are not ok"
services="recogniser logger"
Look
Finds skip units "systemd does not run" || Finds FAIL recogniser "." || Failed "units"
Finds skip disk "." || Finds ok disk "." || Finds warn disk "." || Finds FAIL disk "." || Failed "disk"
services=''

# The whole program: a table of 80 columns, exit code 1 for the clock.
code=0
LCM_DEFAULT_URL=$url "$repo/scripts/doctor" >table 2>&1 || code=$?
((code == 1)) || Failed "a failed check must exit with 1, not $code"
! grep -vE '^    mend: ' table | grep -E '.{81}' || Failed "a line is longer than 80 columns"
grep -q '^    mend: sudo apt install chrony$' table || Failed "the table lacks what mends"
grep -q 'failed$' table || Failed "the table lacks the count"

if ((num_failures > 0)); then exit 1; fi
echo "every fault was found, and mended by its command"
