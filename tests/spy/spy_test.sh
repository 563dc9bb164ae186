#!/bin/sh
# Usage: spy_test.sh spy|player SCRIPTS_SPY TYPES_JAR PROBE_JAR PUBLISHER
# Under Xvfb: scripts/spy must show every type that the publisher sends, decoded; scripts/spy --player
# must list every channel of a log. Exit 77: skipped.
set -u
mode=$1 spy=$2 types_jar=$3 probe=$4 publisher=$5
case $mode in spy) port=7721 ;; player) port=7722 ;; esac  # each its own
url="udpm://239.255.76.67:$port?ttl=0"

skip() { echo "skipped: $*"; exit 77; }
command -v Xvfb > /dev/null || skip "Xvfb is missing: sudo apt-get install xvfb"
java=$(command -v java) || skip "java is missing: sudo apt-get install default-jre"
[ -e "$(dirname "$(dirname "$(readlink -f "$java")")")/lib/libawt_xawt.so" ] ||
  skip "a Java with windows is missing: sudo apt-get install default-jre"
[ -e /usr/share/java/jchart2d.jar ] || skip "jchart2d.jar is missing: sudo apt-get install libjchart2d-java"
[ -e "$types_jar" ] || skip "$types_jar was not built: sudo apt-get install default-jdk-headless liblcm-java"

folder=$(mktemp -d) || exit 1
pids=
# shellcheck disable=SC2086  # a list of pids
trap '[ -n "$pids" ] && kill $pids; wait; rm -rf "$folder"' EXIT

# wait_for FILE: until it has a line, at most 10 s.
wait_for() {
  tries=0
  until [ -s "$1" ]; do
    tries=$((tries + 1))
    [ $tries -le 200 ] || { echo "no $1 after 10 s"; cat "$folder"/*.log; exit 1; }
    sleep 0.05
  done
}

Xvfb -displayfd 3 -screen 0 1280x1024x24 -nolisten tcp 3> "$folder/display" > "$folder/xvfb.log" 2>&1 &
pids="$pids $!"
"$publisher" "$url" "$folder/every_type.lcm" > "$folder/expected" 2> "$folder/publisher.log" &
pids="$pids $!"
wait_for "$folder/display"
wait_for "$folder/expected"
DISPLAY=:$(cat "$folder/display")
export DISPLAY
if [ "$mode" = player ]; then
  set -- --player "$folder/every_type.lcm"
else
  set -- --jar "$types_jar"
fi
JAVA_TOOL_OPTIONS="-javaagent:$probe=$mode:$folder/expected" \
  "$spy" "$@" --lcm-url "$url" > "$folder/$mode.log" 2>&1
result=$?
cat "$folder/publisher.log" "$folder/$mode.log"
exit $result
