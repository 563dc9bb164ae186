# To be sourced by fleet_test.sh: what is tried at the seat. Each prints what went wrong and fails.
# shellcheck shell=bash
# shellcheck disable=SC2016,SC2154  # robot, repo, build: fleet_test.sh sets them

# Lines of all machines, in the order of their times.
LogsOfAll() {
  local words
  words=$(Operate "visavis-fleet logs --lines 20") || return 1
  printf '%s\n' "$words"
  [[ $(awk '{print $2}' <<<"$words" | sort -u | paste -sd ' ') == "camera compute storage" ]] &&
    sort -c -s -k1,1 <<<"$words"
}

# Who may not read a machine's journal is told, and does not take silence for peace.
LogsForMembers() {
  local words code=0
  LabRun camera gpasswd -d pilot systemd-journal
  LabRun camera pkill -u pilot sshd # a connection keeps the groups that it began with
  words=$(Operate "visavis-fleet logs" 2>&1) && code=1
  LabRun camera gpasswd -a pilot systemd-journal
  LabRun camera pkill -u pilot sshd
  printf '%s\n' "$words"
  grep -q '^system.conf:5: host camera: logs: "pilot": must be a member of systemd-journal there' <<<"$words" &&
    grep -q '^[^ ]* storage ' <<<"$words" || code=1
  return "$code"
}

# Following ends with the signal that ends it, and leaves nobody reading.
FollowsLogs() {
  local words
  words=$(Operate "timeout 3 visavis-fleet logs --follow --lines 2") && return 1
  printf '%s\n' "$words"
  [[ $(awk '{print $2}' <<<"$words" | sort -u | paste -sd ' ') == "camera compute storage" ]] &&
    for machine in camera compute storage; do
      WaitFor 5 "end of journalctl on $machine" Fails LabRun "$machine" pgrep -x journalctl
    done
}

# The newest log that is not too short holds pictures, and the recogniser tracks in it.
PlaysBack() {
  LabRun storage bash -ec '
    log=$(ls -S /var/lib/visavis/logs/fleet-*.lcm | head -1)
    visavis-log info --prefix LAB_ "$log"
    visavis-recogniser --prefix LAB_ --replay "$log" --record /tmp/out.lcm
    visavis-evaluate --prefix LAB_ /tmp/out.lcm' >"$LAB/playback" 2>&1 || { cat "$LAB/playback"; return 1; }
  cat "$LAB/playback"
  awk '/TRACKING, .* SEARCHING/ {for (i = 2; i <= NF; ++i) if ($i ~ /^TRACKING/) tracking = $(i - 1)}
    END {exit !(tracking > 500)}' "$LAB/playback"
}

# Refused REGEX [COMMAND]: `start`, or another command, is refused with one line that fits.
Refused() {
  local words
  if words=$(Operate "visavis-fleet ${2:-start}" 2>&1); then return 1; fi
  printf '%s\n' "$words"
  [[ $(wc -l <<<"$words") == 2 && $(tail -1 <<<"$words") == *"nothing was changed"* ]] &&
    grep -qE -- "$1" <<<"$words"
}

WrongVersion() {
  local code=0
  LabRun compute sh -c 'cp /usr/lib/visavis/version /run/version; echo 9.9 >/usr/lib/visavis/version'
  Refused '^system.conf:[0-9]+: host compute: version: "9.9": must be .* as on camera' || code=1
  LabRun compute cp /run/version /usr/lib/visavis/version
  return "$code"
}

# A process on another machine of the network that uses our group, port and prefix.
OtherRobot() {
  local code=0 pid url
  url=$(awk '$1 == "lcm_url" {print $2}' "$robot/system.conf")
  "$build/bin/visavis-arm-state" --lcm-url "$url" --prefix LAB_ >"$LAB/other.out" 2>&1 &
  pid=$!
  WaitFor 5 "another robot" grep -q running "$LAB/other.out" || code=1
  Refused '^system.conf:2: lcm_url: "udpm.*": must be of this robot alone, but arm-state of host' || code=1
  ! Operate "visavis-fleet status | grep -w active" || code=1
  kill "$pid"
  wait "$pid" || true
  return "$code"
}

NotDeployed() {
  local code=0
  sed 's/ recogniser.yaml$//' "$robot/system.conf" >"$robot/fewer.conf"
  Refused '^fewer.conf:[0-9]+: host compute: /etc/visavis/fleet: .*visavis-fleet deploy' \
    "--system fewer.conf start" || code=1
  echo 'arm_wait_ms: 14' >>"$robot/recogniser.yaml"
  Refused '^system.conf:[0-9]+: host compute: /etc/visavis/fleet: .*visavis-fleet deploy' || code=1
  return "$code"
}

# Nothing fails but the clocks, which are this computer's and may be kept by nobody.
HealthyButClocks() {
  local words
  words=$(Operate "visavis-fleet doctor" 2>&1) || true
  printf '%s\n' "$words"
  [[ $(grep -c ' messages  *ok ' <<<"$words") == 6 && $(grep -c ' version  *ok ' <<<"$words") == 3 &&
    $(grep -c ' clock offset  *ok ' <<<"$words") == 2 ]] &&
    ! grep ' FAIL ' <<<"$words" | grep -v ' clock  *FAIL '
}

# Multicast of compute leaves by lo: it is not heard, and the doctor says why.
MendsRoute() {
  local words mend
  LabRun compute ip route replace 224.0.0.0/4 dev lo
  words=$(Operate "visavis-fleet doctor" 2>&1) && return 1
  printf '%s\n' "$words"
  mend=$(grep -A3 'compute  *route  *FAIL' <<<"$words" | sed -n 's/^    mend: sudo //p' | head -1)
  [[ -n $mend ]] && grep -q 'storage  *messages  *FAIL hears nothing of compute' <<<"$words" || return 1
  LabRun compute ip route del 224.0.0.0/4
  LabRun compute bash -c "$mend"
  Operate "visavis-fleet doctor 2>&1 | grep -E 'storage +messages +ok +of compute'"
}

# A service that takes its configuration and does not start: its own words say why.
FailsToStart() {
  local words
  printf '%s\n' 'source: aravis' 'start: require' >"$robot/no_camera.yaml"
  sed 's/ stereo_capture.yaml$/ no_camera.yaml/' "$robot/recorded.conf" >"$robot/no_camera.conf"
  words=$(Operate "visavis-fleet --system no_camera.conf deploy && visavis-fleet --system no_camera.conf start" 2>&1) && return 1
  printf '%s\n' "$words"
  Operate "visavis-fleet stop && visavis-fleet deploy" &&
    grep -q '^camera: start: visavis-stereo-capture: start: require: left camera: left.device: LEFT' <<<"$words" &&
    grep -q '^compute  *started arm-state, recogniser' <<<"$words"
}

# A name that nobody knows, a machine that is not known yet, and a user who may not log in: none is a
# machine that is off.
BadHosts() {
  local code=0
  sed 's/10.77.0.1$/nowhere.invalid/' "$robot/system.conf" >"$robot/nowhere.conf"
  Refused '^nowhere.conf:5: host camera: address: "nowhere.invalid": must be an address or a name' \
    "--system nowhere.conf start" || code=1
  # For another user, as this one is connected.
  sed '/10.77.0.[23]$/d; s/compute\|storage/camera/; $auser root
    s/=accept-new/=yes\nssh_option UserKnownHostsFile=\/dev\/null/' \
    "$robot/system.conf" >"$robot/unknown.conf"
  Refused '^unknown.conf:6: host camera: login: "root@10.77.0.1": must be a machine that ssh knows, log in once by hand: ssh root@10.77.0.1' \
    "--system unknown.conf start" || code=1
  sed '/10.77.0.[23]$/d; s/compute\|storage/camera/; $auser nobody' "$robot/system.conf" >"$robot/nobody.conf"
  Refused '^nobody.conf:5: host camera: login: "nobody@10.77.0.1": must be possible with a key' \
    "--system nobody.conf start" || code=1
  return "$code"
}

# A machine that goes by a name of multicast DNS has no address while it is off.
OffByName() {
  sed 's/10.77.0.1$/camera.local/' "$robot/system.conf" >"$robot/local.conf"
  Says "^local.conf:5: host camera (camera.local): is off or cannot be reached" \
    Operate "visavis-fleet --system local.conf start" &&
    Operate "visavis-fleet --system local.conf status | grep -E '^logger +storage +active'" &&
    Operate "visavis-fleet stop"
}

# One machine by two names, and one whose package lacks a service: as on a processor without Embree.
BadMachines() {
  local code=0
  { sed -n '/^lcm_url\|^prefix\|^ssh_option\|^host *storage\|^logger/p' "$robot/system.conf"
    echo "recogniser localhost"; } >"$robot/twice.conf"
  Refused '^twice.conf:6: host localhost: host name: "storage": is that of storage too: ' \
    "--system twice.conf deploy" || code=1
  LabRun camera sh -c 'cp /usr/lib/visavis/services /run/services; sed -i /simulator/d /usr/lib/visavis/services'
  Refused '^system.conf:[0-9]+: host camera: service: "simulator": must be one of the package.s there .arm-state' || code=1
  Operate "visavis-fleet stop" || code=1
  LabRun camera cp /run/services /usr/lib/visavis/services
  return "$code"
}

# A configuration that its service refuses is deployed nowhere.
BadConfiguration() {
  local code=0 before
  before=$(LabRun camera readlink /etc/visavis/fleet)
  cp "$robot/recogniser.yaml" "$LAB/recogniser.yaml"
  echo 'arm_wait_ms: -1' >>"$robot/recogniser.yaml"
  Refused '^compute: visavis-recogniser: ./recogniser.yaml:2: arm_wait_ms: -1: must be 0 to 1000 ms' deploy || code=1
  [[ $(LabRun camera readlink /etc/visavis/fleet) == "$before" ]] || code=1
  cp "$LAB/recogniser.yaml" "$robot/recogniser.yaml"
  return "$code"
}

# The same commands for this machine alone, without ssh.
OneMachine() {
  printf '%s\n' "prefix ONE_" "logger localhost logger.yaml" "recogniser localhost" >"$robot/one.conf"
  local fleet="visavis-fleet --system one.conf"
  Operate "$fleet deploy && $fleet start && $fleet restart recogniser && $fleet status && $fleet logs logger" &&
    Operate "$fleet enable && $fleet disable recogniser && $fleet status" >"$LAB/status" &&
    grep -qE '^logger .* active .* enabled ' "$LAB/status" &&
    grep -qE '^recogniser .* active .* disabled ' "$LAB/status" &&
    Operate "$fleet stop && ! $fleet status"
}

# The package goes: with it what runs; configuration and logs stay.
Removal() {
  local left
  Operate "visavis-fleet --system one.conf start" && LabRun storage dpkg --no-triggers -r visavis || return 1
  ! LabRun storage pgrep -u visavis || return 1
  LabRun storage test -e /etc/visavis/logger.yaml -a -e /etc/visavis/fleet/logger.yaml || return 1
  [[ -n $(LabRun storage find /var/lib/visavis/logs -name '*.lcm') ]] || return 1
  left=$(LabRun storage systemctl list-units --all --state=loaded --no-legend 'visavis*')
  left+=$(LabRun storage find /usr /lib/systemd /run/systemd -xdev -iname '*visavis*' -not -path '/usr/share/doc/*')
  [[ -z $left ]] || { echo "left: $left"; return 1; }
}
