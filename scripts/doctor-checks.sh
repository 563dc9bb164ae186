# What scripts/doctor runs on each machine, by `bash -s`. Needs nothing of Visavis there but says what
# is missing. Installed in /usr/lib/visavis. Takes the variables
#   url       the LCM network; several  yes if it is to reach other machines
#   services  that this machine runs, by name; prefix  of the channels; querier  yes: wait for one
# and prints lines VERDICT, check, what was found, command that mends it; between them tabs.
# VERDICT is ok, FAIL, warn (works, but) or skip (why it was not checked).
# shellcheck shell=bash
: "${url:=}" "${several:=no}" "${services:=}" "${prefix:=}" "${querier:=no}"

Say() { printf '%s\t%s\t%s\t%s\n' "$1" "$2" "$3" "${4:-}"; }
Has() { command -v "$1" >/dev/null 2>&1; }
Runs() { [[ " $services " == *" $1 "* ]]; }

group=${url#udpm://}
group=${group%%[:/?]*}
port=${url#udpm://*:}
port=${port%%[!0-9]*}
want=$([[ $url =~ recv_buf_size=([0-9]+) ]] && echo "${BASH_REMATCH[1]}")
ttl=$([[ $url =~ ttl=([0-9]+) ]] && echo "${BASH_REMATCH[1]}")
device=''
num_addresses=$(ip -br -4 address 2>/dev/null | grep -vc '^lo ')

CheckUrl() {
  local deployed
  deployed=$(sed -n 's/^LCM_DEFAULT_URL=//p' /etc/visavis/fleet/environment 2>/dev/null)
  if [[ -n $services && -n $deployed && $deployed != "$url" ]]; then
    Say FAIL url "deployed is $deployed, the system file says $url" "visavis-fleet deploy"
  elif [[ -n $services && -z $deployed && $several == yes ]]; then
    Say FAIL url "LCM_DEFAULT_URL is not deployed: services then stay on this machine" "visavis-fleet deploy"
  elif [[ $several == yes && ${ttl:-0} -lt 1 ]]; then
    Say FAIL url "ttl=${ttl:-0}: nothing leaves this machine" "in the system file, then deploy: lcm_url udpm://$group:$port?ttl=1&recv_buf_size=4194304"
  elif [[ -z $want ]]; then
    Say FAIL url "no recv_buf_size: raw pictures will be lost" "in the system file, then deploy: lcm_url ${url%%\?*}?ttl=${ttl:-0}&recv_buf_size=4194304"
  else
    Say ok url "$url"
  fi
}

CheckRoute() {
  local route card made
  route=$(ip -4 route get "$group" 2>&1)
  device=$(sed -n 's/.* dev \([^ ]*\).*/\1/p' <<<"$route")
  card=$(ip -br -4 address | awk '$1 != "lo" && $2 != "DOWN" {sub(/@.*/, "", $1); print $1; exit}')
  [[ $several == yes || -n $card ]] || card=lo
  if [[ -z $device ]]; then
    Say FAIL route "none to $group: ${route%%$'\n'*}" "sudo ip route add 224.0.0.0/4 dev ${card:-lo}"
  elif [[ $device == lo && $several == yes ]]; then
    Say FAIL route "$group leaves by lo: no other machine hears it" "sudo ip route replace 224.0.0.0/4 dev ${card:-NIC}"
    device=${card:-}
  else
    Say ok route "$group leaves by $device"
    ((num_addresses <= 1)) || [[ $several == no ]] ||
      Say warn route "$num_addresses interfaces have addresses: is $device the one to the other machines?" "sudo ip route replace 224.0.0.0/4 dev NIC"
    made=$(ip -4 route show 224.0.0.0/4)
    [[ -z $made || $made == *proto* || $device == lo ]] ||
      Say warn route "was made by hand: gone once $device goes down or the machine is switched off" \
        "in $device's .network file: [Route] Destination=224.0.0.0/4 Scope=link"
  fi
}

CheckInterface() {
  local flags speed filter all
  if [[ -z $device || $device == lo ]]; then
    Say skip interface "${device:-no route, so none}: no card"
    return
  fi
  flags=$(ip link show dev "$device" | head -1)
  if [[ $flags != *MULTICAST* ]]; then
    Say FAIL interface "$device lacks the flag MULTICAST" "sudo ip link set dev $device multicast on"
  elif [[ $flags != *LOWER_UP* ]]; then
    Say FAIL interface "$device has no link" "plug its cable in; sudo ip link set dev $device up"
  else
    Say ok interface "$device, MTU $(cat "/sys/class/net/$device/mtu")"
  fi
  [[ ! -e /sys/class/net/$device/wireless ]] ||
    Say warn interface "$device is Wi-Fi: multicast goes at its lowest rate, unacknowledged" "use a cable for pictures"
  speed=$(cat "/sys/class/net/$device/speed" 2>/dev/null)
  [[ ${speed:-0} -le 0 || ${speed:-0} -ge 1000 ]] ||
    Say warn interface "$device runs at $speed Mbit/s: raw pictures need 1000" "another cable or switch; sudo ethtool -s $device autoneg on"
  filter=$(cat "/proc/sys/net/ipv4/conf/$device/rp_filter")
  all=$(cat /proc/sys/net/ipv4/conf/all/rp_filter)
  if ((all > filter)); then filter=$all; fi
  ((filter != 1 || num_addresses < 2)) ||
    Say warn rp_filter "strict, with several interfaces: may discard multicast" "sudo sysctl -w net.ipv4.conf.$device.rp_filter=2"
}

CheckFirewall() {
  local rules
  if grep -qs '^ENABLED=yes' /etc/ufw/ufw.conf; then
    Say warn firewall "ufw is on: it must let LCM in" "sudo ufw allow proto udp to $group port $port"
  elif ((EUID != 0)); then
    Say skip firewall "its rules are for root to read: sudo visavis-doctor"
  else
    rules=$(nft list ruleset 2>/dev/null; iptables -S 2>/dev/null)
    if grep -qE 'hook input .*policy drop|^-P INPUT DROP' <<<"$rules" && ! grep -qE "dport (\{[^}]*)?$port\b" <<<"$rules"; then
      Say FAIL firewall "drops what comes, and lets UDP port $port not in" "sudo iptables -I INPUT -p udp --dport $port -j ACCEPT; sudo iptables -I INPUT -p igmp -j ACCEPT"
    else
      Say ok firewall "lets UDP port $port in"
    fi
  fi
}

# Counter PROTOCOL NAME: of the kernel, since boot.
Counter() {
  awk -v p="$1:" -v n="$2" '$1 == p && !at {for (i = 2; i <= NF; ++i) if ($i == n) at = i; next}
    $1 == p {print $at; exit}' /proc/net/snmp
}

CheckBuffers() {
  local most udp fragments smallest dropped
  most=$(cat /proc/sys/net/core/rmem_max)
  if ((most < ${want:-4194304})); then
    Say FAIL buffers "net.core.rmem_max is $most, must be ${want:-4194304}" \
      "sudo sysctl -w net.core.rmem_max=${want:-4194304} # the package does it at boot"
  else
    Say ok buffers "net.core.rmem_max $most"
  fi
  read -r smallest dropped < <(ss -uamn "sport = :$port" 2>/dev/null |
    grep -o 'skmem:([^)]*)' | tr -d '()' | awk -F'[:,]' '{for (i = 2; i <= NF; ++i) {
      if ($i ~ /^rb/) {rb = substr($i, 3) / 2; if (!least || rb < least) least = rb}
      if ($i ~ /^d[0-9]/) d += substr($i, 2)}} END {print int(least), d + 0}')
  if ((${smallest:-0} == 0)); then
    Say skip sockets "no process listens on port $port here"
  elif ((smallest < ${want:-0})); then
    Say FAIL sockets "one was granted $smallest bytes where ${want:-0} were asked" "visavis-fleet restart"
  else
    Say ok sockets "$smallest bytes at least, $dropped packets dropped since they began"
  fi
  udp=$(Counter Udp RcvbufErrors) fragments=$(Counter Ip ReasmFails)
  sleep 1 # the counters' rate
  udp_more=$(($(Counter Udp RcvbufErrors) - udp))
  fragments_more=$(($(Counter Ip ReasmFails) - fragments))
  if ((udp_more > 0)); then
    Say FAIL drops "$udp_more packets a second find no room" "raise recv_buf_size in lcm_url; nstat -az UdpRcvbufErrors"
  else
    Say ok drops "none in a second ($udp since boot)"
  fi
  if ((fragments_more > 0)); then
    Say FAIL fragments "$fragments_more pictures a second are not put together again: packets are lost on the way" \
      "image_format: jpeg; cable and switch; sudo sysctl -w net.ipv4.ipfrag_time=1 net.ipv4.ipfrag_high_thresh=33554432"
  else
    Say ok fragments "none lost in a second ($fragments since boot)"
  fi
}

CheckIgmp() {
  local bridge
  for bridge in /sys/class/net/*/bridge; do
    [[ -e $bridge && $(cat "$bridge/multicast_snooping") == 1 && $(cat "$bridge/multicast_querier") == 0 ]] || continue
    Say warn igmp "$(basename "$(dirname "$bridge")") snoops without a querier: multicast ends after 260 s if the network has none" \
      "echo 1 | sudo tee $bridge/multicast_querier"
  done
  if [[ $several == no ]]; then
    Say skip igmp "one machine: no switch"
  elif [[ $querier == no ]]; then
    Say skip igmp "takes 130 s: --querier looks for the querier that a snooping switch needs"
  elif ((EUID != 0)) || ! Has tcpdump; then
    Say skip igmp "needs root and tcpdump: sudo apt install tcpdump"
  elif timeout 130 tcpdump -ni "${device:-any}" -c1 'igmp and dst 224.0.0.1' >/dev/null 2>&1; then
    Say ok igmp "there is a querier"
  else
    Say warn igmp "no querier in 130 s: a switch that snoops then ends multicast after 260 s" "switch on the querier in the switch, or its IGMP snooping off"
  fi
}

CheckClock() {
  local offset leap verdict=FAIL
  [[ $several == yes ]] || verdict=warn
  if Has chronyc && IFS=, read -r _ _ _ _ offset _ _ _ _ _ _ _ _ leap < <(chronyc -c tracking 2>/dev/null) && [[ -n $leap ]]; then
    if [[ $leap == Normal ]] && awk -v o="$offset" 'BEGIN {exit !(o < 0.001 && o > -0.001)}'; then
      Say ok clock "chrony, offset $offset s"
    else
      Say "$verdict" clock "chrony: offset $offset s, $leap" "sudo chronyc makestep; chronyc sources # one with a *"
    fi
  elif [[ $(timedatectl show -p NTPSynchronized --value 2>/dev/null) == yes ]]; then
    Say ok clock "synchronised"
  else
    Say "$verdict" clock "is not known to be synchronised" "sudo apt install chrony"
  fi
  if [[ -n $device && $device != lo ]] && Has ethtool && ethtool -T "$device" 2>/dev/null | grep -q 'PTP Hardware Clock: [0-9]'; then
    Say ok ptp "$device has a clock of its own: linuxptp can be used"
  fi
}

CheckUnits() {
  local service state restarts
  if [[ ! -d /run/systemd/system ]]; then
    Say skip units "systemd does not run here"
    return
  fi
  for service in $services; do
    state=$(systemctl is-active "visavis@$service" 2>/dev/null)
    restarts=$(systemctl show -p NRestarts --value "visavis@$service" 2>/dev/null)
    if [[ $state == active ]]; then
      if ((${restarts:-0} > 0)); then
        Say warn "$service" "runs, begun anew $restarts times by itself" "visavis-fleet logs $service"
      else
        Say ok "$service" "runs"
      fi
    elif ! Has "visavis-$service"; then
      Say FAIL "$service" "is not installed" "sudo apt install ./visavis_*.deb"
    else
      Say FAIL "$service" "is ${state:-unknown}" "visavis-fleet start $service; visavis-fleet logs $service"
    fi
  done
}

# What the services say of themselves: probe's columns are state, rate, latency, text.
CheckStatus() {
  local service host state rate latency text told=''
  if ! Has visavis-probe; then
    Say skip status "visavis-probe is not installed"
    return
  fi
  while read -r service host _ _ state rate latency text; do
    service=${service//_/-}
    if [[ $host != "$(hostname)" ]] || ! Runs "$service"; then continue; fi
    told+=" $service "
    if [[ $state == RUNNING ]]; then
      Say ok "$service" "$rate Hz$([[ $latency == nan ]] || echo ", its input $latency ms old")"
    else
      Say warn "$service" "$state: $text" "visavis-fleet logs $service"
    fi
  done < <(visavis-probe listen --lcm-url "$url" --prefix "$prefix" 2>/dev/null)
  for service in $services; do
    [[ $told == *" $service "* ]] || [[ $(systemctl is-active "visavis@$service" 2>/dev/null) != active ]] ||
      Say FAIL "$service" "runs, but is not heard on the LCM network" "visavis-fleet restart $service"
  done
}

# The value of a top-level key of what configures a service here.
Configured() {
  local file=/etc/visavis/fleet/$1.yaml
  [[ -e $file ]] || file=/etc/visavis/$1.yaml
  sed -n "s/^$2:[[:space:]]*\([^#[:space:]]*\).*/\1/p" "$file" 2>/dev/null
}

CheckCameras() {
  local list found held mtu source
  if ! Runs stereo-capture; then
    Say skip cameras "stereo-capture does not run here"
    return
  elif ! Has visavis-stereo-capture; then
    Say skip cameras "visavis-stereo-capture is not installed"
    return
  fi
  source=$(Configured stereo-capture source)
  if [[ $source == folder || $source == video ]]; then
    Say skip cameras "stereo-capture reads a $source"
    return
  fi
  list=$(timeout 60 visavis-stereo-capture --list 2>&1) || true
  found=$(grep '^[^ ]' <<<"$list" | grep -vc '^no ')
  held=$(grep -c '^  another program holds it' <<<"$list")
  if ((found == 0)); then
    Say FAIL cameras "none found" "cables and power; visavis-stereo-capture --list; sudo ufw allow proto udp from any port 3956"
  elif ((held > 0)) && [[ $(systemctl is-active visavis@stereo-capture 2>/dev/null) != active ]]; then
    Say FAIL cameras "$held of $found are held by another program, maybe on another machine" "end that program; visavis-stereo-capture --list"
  else
    Say ok cameras "$found found"
  fi
  mtu=$(cat /sys/class/net/"${device:-lo}"/mtu)
  ((mtu >= 8000)) ||
    Say warn cameras "MTU $mtu: GigE Vision cameras want 9000" "sudo ip link set dev $device mtu 9000"
  id -nG visavis 2>/dev/null | grep -qw video || [[ -z $(find /dev -maxdepth 1 -name 'video*') ]] ||
    Say warn cameras "user visavis is not in group video: webcams are for that group" "sudo usermod -aG video visavis"
}

CheckDisk() {
  local folder=/var/lib/visavis/logs free speed start
  if ! Runs logger; then
    Say skip disk "logger does not run here"
    return
  fi
  [[ -d $folder ]] || folder=/var/lib
  free=$(df --output=avail -m "$folder" | tail -1)
  if ((free < 500)); then
    Say FAIL disk "$free MB free in $folder" "sudo sh -c 'rm $folder/OLD-LOGS'"
  elif ((free < 10000)); then
    Say warn disk "$((free / 1000)) GB free in $folder: JPEG pairs take 20 GB an hour" "sudo sh -c 'rm $folder/OLD-LOGS'"
  else
    Say ok disk "$((free / 1000)) GB free in $folder"
  fi
  if [[ ! -w $folder ]]; then
    Say skip "disk speed" "only root may write to $folder: sudo visavis-doctor"
    return
  fi
  start=${EPOCHREALTIME/./}
  if dd if=/dev/zero of="$folder/.doctor" bs=1M count=64 conv=fsync 2>/dev/null; then
    speed=$((64000000 / (${EPOCHREALTIME/./} - start + 1)))
    if ((speed >= 60)); then
      Say ok "disk speed" "$speed MB/s"
    else
      Say warn "disk speed" "$speed MB/s: raw pairs come at 55 MB/s" "images: jpeg in logger.yaml"
    fi
  fi
  rm -f "$folder/.doctor"
}

CheckUrl
CheckRoute
CheckInterface
CheckFirewall
CheckBuffers
CheckIgmp
CheckClock
CheckUnits
CheckStatus
CheckCameras
CheckDisk
