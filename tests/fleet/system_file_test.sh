#!/usr/bin/env bash
# system_file_test.sh REPO BUILD: what visavis-fleet makes of system files and flags, without any
# machine; and that it holds the rules that services and packages have.
set -euo pipefail
repo=${1:?the checkout} build=${2:?its build folder}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
num_failures=0
cd "$folder"
touch recogniser.yaml

# Refuses NAME EXPECTED LINE...: the system file of these lines gets exactly one line, EXPECTED, and
# exit code 2.
Refuses() {
  local name=$1 expected=$2 words code=0
  shift 2
  printf '%s\n' "$@" >system.conf
  words=$("$repo/scripts/fleet" --system system.conf status 2>&1) || code=$?
  if [[ $code != 2 || $words != "$expected" ]]; then
    printf 'FAILED: %s: exit code %s\n  expected: %s\n  got:      %s\n' "$name" "$code" "$expected" "$words"
    num_failures=$((num_failures + 1))
  fi
}

services="stereo-capture, arm-state, recogniser, logger, simulator"
Refuses "unknown service" \
  "system.conf:2: service or key: \"recognizer\": must be a service ($services) or a key (lcm_url, prefix, user, ssh_option, host)" \
  "logger localhost" "recognizer localhost"
Refuses "unknown key" \
  "system.conf:1: service or key: \"lcm-url\": must be a service ($services) or a key (lcm_url, prefix, user, ssh_option, host)" \
  "lcm-url udpm://239.1.1.1:7" "logger localhost"
Refuses "unknown host" \
  'system.conf:3: recogniser host: "computr": must be a host of this file (localhost, compute)' \
  "host compute 10.0.0.2" "" "recogniser computr"
Refuses "a host given after its use is known; a second of the name is refused" \
  'system.conf:3: host: "compute": must be given once, and is in line 2' \
  "recogniser compute" "host compute 10.0.0.2" "host compute 10.0.0.3"
Refuses "two hosts of one address" \
  'system.conf:2: host b: "10.0.0.2": is the address of a already' \
  "host a 10.0.0.2" "host b 10.0.0.2" "logger localhost"
Refuses "an address that is a flag of ssh" \
  'system.conf:1: host a: "-oProxyCommand=x": must be an address or a name that ssh knows' \
  "host a -oProxyCommand=x" "logger localhost"
Refuses "a service twice" \
  'system.conf:2: recogniser: "b": must run on one machine alone, and is given by line 1' \
  "recogniser localhost" "recogniser b" "host b 10.0.0.2" "lcm_url udpm://239.1.1.1:7667?ttl=1"
Refuses "no configuration file" \
  'system.conf:1: recogniser configuration: "./nothing.yaml": must be a readable file' \
  "recogniser localhost nothing.yaml"
Refuses "a word too many" \
  'system.conf:1: recogniser: "recogniser.yaml extra": more words than the line may have' \
  "recogniser localhost recogniser.yaml extra" "logger localhost"
Refuses "a key without a value" 'system.conf:1: prefix: "": must have a value' "prefix" "logger localhost"
Refuses "a key twice" 'system.conf:2: prefix: "B_": must be given once, and is in line 1' \
  "prefix A_" "prefix B_" "logger localhost"
Refuses "a prefix that is no channel's" \
  'system.conf:1: prefix: "robot": must be 1 to 31 of A-Z, 0-9 and _, e.g. ROBOT1_' \
  "prefix robot" "logger localhost"
Refuses "a user that is none" "system.conf:1: user: \"a;b\": must be a user's name" \
  "user a;b" "logger localhost"
Refuses "an ssh option without value" \
  'system.conf:1: ssh_option: "Port": must be NAME=VALUE, as ssh -o takes it' \
  "ssh_option Port" "logger localhost"
url_rule="must be udpm://GROUP:PORT?ttl=N&recv_buf_size=BYTES, GROUP from 224.0.0.0 to 239.255.255.255, PORT from 1 to 65535"
for url in "udpm://10.0.0.1:7667" "udpm://239.1.1.1:99999" "udpm://239.1.1.1:7667?ttl=\$(id)" "tcpq://a:1"; do
  Refuses "url $url" "system.conf:1: lcm_url: \"$url\": $url_rule" "lcm_url $url" "logger localhost"
done
Refuses "several machines with ttl=0" \
  'system.conf:1: lcm_url: "udpm://239.1.1.1:7667?ttl=0": must have ttl=1 or more, else nothing leaves a machine and there are 2' \
  "lcm_url udpm://239.1.1.1:7667?ttl=0" "host b 10.0.0.2" "logger localhost" "recogniser b"
Refuses "no service" 'system.conf:1: service: "": must be given at least once, e.g. recogniser localhost' \
  "prefix A_"

# Uses WHAT CODE REGEX ARGUMENTS...
Uses() {
  local what=$1 expected=$2 regex=$3 words code=0
  shift 3
  words=$("$repo/scripts/fleet" "$@" 2>&1 </dev/null) || code=$?
  if [[ $code != "$expected" || $(wc -l <<<"$words") -gt 1 || ! $words =~ $regex ]]; then
    printf 'FAILED: %s: exit code %s: %s\n' "$what" "$code" "$words"
    num_failures=$((num_failures + 1))
  fi
}
echo "recogniser localhost recogniser.yaml" >system.conf
Uses "no command" 2 "needs a command"
Uses "unknown command" 2 "launch: unknown command" launch
Uses "a service that the file does not list" 2 "logger: must be a service that system.conf lists \(recogniser\)" start logger
Uses "no such file" 2 "^nowhere.conf: must be a readable file" --system nowhere.conf status
Uses "lines of what is no log" 2 "^scripts/fleet: --lines 5: |--lines 5: must be" status --lines 5

# Same WHAT HERE THERE
Same() {
  if [[ -z $2 || $2 != "$3" ]]; then
    printf 'FAILED: %s: "%s" here, "%s" there\n' "$1" "$2" "$3"
    num_failures=$((num_failures + 1))
  fi
}
# The prefixes that the services take, of a length.
for length in 31 32; do
  letters=$(head -c "$length" /dev/zero | tr '\0' A)
  ours=yes theirs=yes
  printf '%s\n' "prefix $letters" "logger localhost" >system.conf
  # shellcheck source=scripts/fleet-system.sh disable=SC2034
  (source "$repo/scripts/fleet-system.sh" && ReadSystem system.conf) 2>/dev/null || ours=no
  "$build/bin/visavis-logger" --prefix "$letters" --check-config 2>/dev/null || theirs=no
  Same "is a prefix of $length letters taken" "$ours" "$theirs"
done
Same "a prefix of 32 letters" "$ours" no
# Every service of the package may stand in a system file.
# shellcheck source=scripts/fleet-system.sh
known=$(source "$repo/scripts/fleet-system.sh" && printf '%s\n' "${SERVICES[@]}")
while IFS= read -r service; do
  Same "$service of the package" "$(grep -xF -e "$service" <<<"$known")" "$service"
done <"$build/scripts/packaging/services"
# The doctor's bound for clocks, unless the robot has its own, is the recogniser's default.
Same "the clocks' bound [ms]" "$(sed -n 's/^CLOCK_BOUND_MS=\([0-9]*\).*/\1/p' "$repo/scripts/doctor")" \
  "$("$build/bin/visavis-recogniser" --print-config | sed -n 's/^arm_clock_bound_ms: //p')"
if ((num_failures > 0)); then exit 1; fi
echo "all as expected"
