# To be sourced by fleet_test.sh: what was expected and what was measured.
# shellcheck shell=bash
# shellcheck disable=SC2016  # awk's conditions
# shellcheck disable=SC2154  # build, robot: fleet_test.sh sets them

num_failures=0
NowUs() { echo "${EPOCHREALTIME/./}"; }
# Lag FROM_US TO_US: [s]
Lag() { awk -v a="$1" -v b="$2" 'BEGIN {if (b != "") printf "%.2f", (b - a) / 1e6}'; }
Since() { Lag "$1" "$(NowUs)"; }

Told() { printf '%6.1f s  %-8s %s: %s\n' "$(Lag "$(cat "$LAB/began")000000" "$(NowUs)")" "" "$1" "$2"; }

Judge() { # Judge VERDICT TEXT
  printf '%6.1f s  %-8s %s\n' "$(Lag "$(cat "$LAB/began")000000" "$(NowUs)")" "$1" "$2"
  [[ $1 == ok ]] || num_failures=$((num_failures + 1))
}

# Expect WHAT COMMAND...: which must succeed; else its output is shown.
Expect() {
  local what=$1
  shift
  if "$@" >"$LAB/out" 2>&1; then
    Judge ok "$what"
  else
    Judge FAILED "$what"
    tail -20 "$LAB/out" | sed 's/^/          | /'
  fi
}

Fails() { ! "$@"; }
# Says REGEX COMMAND...: which must fail and say so.
Says() {
  local words
  if words=$("${@:2}" 2>&1); then return 1; fi
  printf '%s\n' "$words"
  grep -q -- "$1" <<<"$words"
}

# Figure WHAT VALUE AT_MOST
Figure() {
  local verdict=ok
  awk -v v="$2" -v most="$3" 'BEGIN {exit !(v != "" && v <= most)}' || verdict=FAILED
  Judge "$verdict" "$1: ${2:-never} (at most $3)"
}

# What comes over the bus at the seat goes to $LAB/watch.log; see bus_watch.cc.
StartWatch() {
  nsenter -t "$(cat "$LAB/storage/pid")" -n "$build/tests/visavis-bus-watch" \
    --lcm-url "$(awk '$1 == "lcm_url" {print $2}' "$robot/system.conf")" \
    --prefix "$(awk '$1 == "prefix" {print $2}' "$robot/system.conf")" >"$LAB/watch.log" &
}

# Found FROM_US AWK-CONDITION: when the first message after FROM_US came that fits; sets found_us.
# $2 is the channel, $3 and on as bus_watch.cc says.
Found() {
  found_us=$(awk -v from="$1" "\$1 > from && ($2) {print \$1; exit}" "$LAB/watch.log")
  [[ -n $found_us ]]
}
# WaitFound SECONDS WHAT FROM_US AWK-CONDITION
WaitFound() { WaitFor "$1" "$2" Found "$3" "$4"; }
WaitTracking() { WaitFound "$1" "a TRACKING pose" "$2" '$2 ~ /HEAD_POSE$/ && $3 == 1'; }

# Pictures FROM_US TO_US: how many pairs came, of those that were sent. The simulator numbers a pair
# that it was too late to render too, and counts those in its status.
Pictures() {
  local num_received num_numbered rate_hz kilobytes late
  read -r num_received num_numbered rate_hz kilobytes late < <(awk -v from="$1" -v to="$2" '
    $2 == "SERVICE_STATUS" && $3 == "simulator" && $1 < to + 1500000 {
      if ($1 <= from) late_before = $7
      late = $7
    }
    $1 > from && $1 <= to && $2 == "STEREO_IMAGES" {
      if (!n) {first = $3; start = $1}
      ++n; last = $3; end = $1; bytes += $4
    }
    END {
      printf "%d %d %.2f %.0f %d\n", n, last - first + 1, (end > start ? (n - 1) * 1e6 / (end - start) : 0),
        (n ? bytes / n / 1000 : 0), late - late_before
    }' "$LAB/watch.log")
  Told "JPEG pairs from camera to storage in 30 s" \
    "$num_received of $num_numbered, $late not rendered in time, $rate_hz Hz, $kilobytes kB a pair"
  Figure "lost on the way, in percent" \
    "$(awk -v n="$num_numbered" -v r="$num_received" -v l="$late" 'BEGIN {if (n > l) print 100 * (n - l - r) / (n - l)}')" 0.5
  Figure "pairs a second that are missing of 30" "$(awk -v r="$rate_hz" 'BEGIN {print 30 - r}')" 1
}
