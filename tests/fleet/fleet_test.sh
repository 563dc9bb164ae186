#!/usr/bin/env bash
# fleet_test.sh REPO BUILD: a robot of three machines, from a cold start through every fault that it
# must outlive. Prints each figure, and PASS if all expectations held.
# simulator on `camera`, recogniser on `compute`, logger on `storage`, where the operator sits.
# shellcheck disable=SC2016,SC2034  # awk's conditions; what sourced files use
set -euo pipefail
repo=${1:?the checkout} build=${2:?its build folder}
# shellcheck source=tests/fleet/lab.sh
source "$repo/tests/fleet/lab.sh"
# shellcheck source=tests/fleet/machines.sh
source "$repo/tests/fleet/machines.sh"
# shellcheck source=tests/fleet/checks.sh
source "$repo/tests/fleet/checks.sh"
# shellcheck source=tests/fleet/figures.sh
source "$repo/tests/fleet/figures.sh"

if [[ -z ${LAB:-} ]]; then
  why=$(LabWhyNot)
  [[ -z $why ]] || { echo "skipped: $why"; exit 77; }
  LabEnter "$0" "$@"
fi
if [[ ! -d $LAB/layer ]]; then
  date +%s >"$LAB/began"
  LabBase "$build/fleet-lab/layer.tar" || { echo "skipped: Debian's packages are not to be had"; exit 77; }
  InstallVisavis "$build"
  MakeOperator
  LabUnmount
  LabSwitch "$0" "$@"
fi
trap 'exit 130' INT TERM

# ---- the machines
LabMake camera 1
LabMake compute 2
LabMake storage 3
robot=$(LabDisk storage)/home/pilot/robot
mkdir -p "$robot"
cp "$repo"/tests/fleet/robot/* "$robot"
mkdir -p "$(LabDisk camera)/etc/visavis"
cp "$repo/common/rigs/demo_arm.urdf" "$robot" # rig.yaml names it, simulator.yaml names that
cp -r "$repo/tests/data/man_static" "$(LabDisk camera)/etc/visavis"
sed 's/640, height: 480, fx: 800, fy: 800, cx: 319.5, cy: 239.5/320, height: 240, fx: 400, fy: 400, cx: 159.5, cy: 119.5/' \
  "$repo/common/rigs/demo_rig.yaml" >"$robot/rig.yaml"
machines=(camera compute storage)
On() {
  local machine
  for machine in "$@"; do LabOn "$machine"; done
  for machine in "$@"; do WaitFor 30 "$machine up" LabIsUp "$machine"; done
}
On "${machines[@]}"
LabRun storage chown -R pilot:pilot /home/pilot/robot
Told "machines up" "3 of 3"
StartWatch

# Where each service runs.
declare -A home=([simulator]=camera [arm-state]=camera [recogniser]=compute [logger]=storage)
PidOf() { LabRun "${home[$1]}" systemctl show -p MainPID --value "visavis@$1"; }
Restarts() {
  local service
  for service in "${!home[@]}"; do
    LabRun "${home[$service]}" systemctl show -p NRestarts --value "visavis@$service"
  done | paste -sd ' '
}
# SignalAndWait SIGNAL SERVICE SECONDS: until another process of the service tells its status.
SignalAndWait() {
  local pid service=$2
  pid=$(PidOf "$service")
  began_us=$(NowUs)
  LabRun "${home[$service]}" kill -"$1" "$pid"
  WaitFound "$3" "$service again" "$began_us" \
    "\$2 == \"SERVICE_STATUS\" && \$3 == \"${service/-/_}\" && \$5 != $pid" || found_us=''
}

# TimesOfStatus WHAT SECONDS MOST: a start listens for a second, and takes for all the rest but so many
# times what `status` takes in this very run, the quicker of two: how fast a machine is today does not
# count.
TimesOfStatus() {
  local status_s='' listen_s from_us k
  listen_s=$(sed -n 's/^LISTEN_S=\([0-9.]*\).*/\1/p' "$repo/scripts/fleet")
  for k in 1 2; do
    from_us=$(NowUs)
    Operate "visavis-fleet status" >/dev/null 2>&1 || true
    status_s+=" $(Since "$from_us")"
  done
  Figure "$1, beside listening, in times of a status" \
    "$(awk -v all="$2" -v listen="${listen_s:?}" '{s = $1 < $2 ? $1 : $2; printf "%.1f", (all - listen) / s}' <<<"$status_s")" "$3"
}

# ---- four services on three machines, with recorded pictures
Expect "deploy of a capture from recorded pictures" Operate "visavis-fleet --system recorded.conf deploy"
began_us=$(NowUs)
Expect "start" Operate "visavis-fleet --system recorded.conf start"
start_s=$(Since "$began_us")
Told "start of 4 services on 3 machines, with all checks" "$start_s s"
WaitTracking 30 "$began_us" || found_us=''
Figure "start to the first TRACKING pose" "$(Lag "$began_us" "$found_us")" 15
TimesOfStatus "start" "$start_s" 4
Expect "stop" Operate "visavis-fleet --system recorded.conf stop"

# ---- a cold start
Expect "deploy" Operate "visavis-fleet deploy"
Expect "status exits with 1 as nothing runs" Fails Operate "visavis-fleet status"
began_us=$(NowUs)
Expect "start" Operate "visavis-fleet start"
start_s=$(Since "$began_us")
Told "start, with a simulator that paints its room first" "$start_s s"
WaitTracking 30 "$began_us" || found_us=''
Figure "cold start to the first TRACKING pose, heard on storage" "$(Lag "$began_us" "$found_us")" 15
TimesOfStatus "start, with a simulator that paints its room first" "$start_s" 6
Expect "status exits with 0" Operate "visavis-fleet status"
Expect "a second start changes nothing" Operate "visavis-fleet start"
Expect "enable" Operate "visavis-fleet enable"

# ---- what the doctor finds
Expect "the doctor finds nothing but clocks that nobody synchronises here" HealthyButClocks
Expect "the doctor finds a route gone wrong, and its command mends it" MendsRoute

# ---- pictures
pictures_from_us=$(NowUs)
WaitFound 40 "pictures of 30 s" $((pictures_from_us + 30000000)) '$2 == "STEREO_IMAGES"' || found_us=''
Pictures "$pictures_from_us" "$found_us"

# ---- faults
# The simulator paints its room before it is there: as long as that takes here and now is no part of
# what is asked.
began_us=$(NowUs)
Expect "a room painted by itself" LabRun camera visavis-simulator --fast --seconds 0.04 \
  --config /etc/visavis/fleet/simulator.yaml --record /tmp/painted.lcm
declare -A beside_us=([simulator]=$(($(NowUs) - began_us)))
Told "painting a room" "$(Lag 0 "${beside_us[simulator]}") s"
for service in simulator arm-state recogniser logger; do
  SignalAndWait KILL "$service" 10
  Told "kill -9 of $service: back after" "$(Lag "$began_us" "$found_us") s"
  Figure "the same, beside painting" "$(Lag "$((began_us + ${beside_us[$service]:-0}))" "$found_us")" 1.0
  WaitTracking 10 "${found_us:-$began_us}" || found_us=''
  Figure "kill -9 of $service: TRACKING after" "$(Lag "$began_us" "$found_us")" 2.0
done
for service in arm-state recogniser; do
  SignalAndWait STOP "$service" 10
  Figure "$service hung: back after" "$(Lag "$began_us" "$found_us")" 4.0
done
WaitTracking 10 "${found_us:-$began_us}" || found_us=''

restarts=$(Restarts)
LabCut camera
cut_us=$(NowUs)
sleep 2 # so long is the link down
Expect "no picture comes while the link is down" Fails Found $((cut_us + 200000)) '$2 == "STEREO_IMAGES"'
LabHeal camera
began_us=$(NowUs)
WaitTracking 10 "$began_us" || found_us=''
Figure "link down for 2 s: TRACKING after it is back" "$(Lag "$began_us" "$found_us")" 2.0
Expect "nothing began anew" test "$restarts" == "$(Restarts)"

LabOff camera
Expect "status names the machine that is off and exits with 1" \
  Says "host camera (10.77.0.1): is off or cannot be reached" Operate "visavis-fleet status"
Expect "start does the rest and exits with 1" \
  Says "compute *started recogniser" Operate "visavis-fleet start"
began_us=$(NowUs)
On camera
WaitTracking 30 "$began_us" || found_us=''
Figure "power of camera back: TRACKING after" "$(Lag "$began_us" "$found_us")" 15
Expect "status exits with 0 again" WaitFor 10 "ssh" Operate "visavis-fleet status"

# ---- at one seat
Expect "logs of all machines" LogsOfAll
Expect "logs of all machines as they come" FollowsLogs
Expect "logs are refused to who may not read them" LogsForMembers
Expect "a service of the wrong version keeps all from starting" WrongVersion
Expect "stop" Operate "visavis-fleet stop"
Expect "nothing runs" Fails Operate "visavis-fleet status | grep -w active"
Expect "what was recorded on storage plays back" PlaysBack
Expect "another robot on our group and prefix keeps all from starting" OtherRobot
Expect "a host that nobody knows, or that lets nobody in, keeps all from starting" BadHosts
Expect "a bad configuration is deployed nowhere" BadConfiguration
Expect "a machine that has no address while it is off is one that is off" OffByName
Expect "a service that does not start says why; the rest is started" FailsToStart
Expect "a machine given twice, or without the service, keeps all from starting" BadMachines
Expect "a system file that is not deployed keeps all from starting" NotDeployed
Expect "one machine alone, without ssh" OneMachine
Expect "removal ends what runs, and leaves configuration and logs" Removal

if ((num_failures > 0)); then
  echo "FAIL: $num_failures"
  exit 1
fi
echo PASS
