#!/usr/bin/env bash
# Usage: fleet_control_test.sh BUILD
# The operators' root helper, in a root of its own with a systemctl that writes down what it is asked:
# what it does, what it refuses, and that a refused deploy changes nothing.
# shellcheck source=tests/package/lib.sh
source "$(dirname "$0")/lib.sh"
root=$folder/root etc=$folder/root/etc/visavis files=$folder/files
InstallPrograms "$1" "$root"
control=$root/usr/lib/visavis/fleet-control
mkdir "$files"
cat >"$root/usr/bin/systemctl" <<END
#!/bin/sh
echo "\$*" >>$folder/asked
! grep -q fail $folder/systemctl 2>/dev/null
END
chmod +x "$root/usr/bin/systemctl"

# Asked VERB...: what systemctl is asked for it.
Asked() {
  rm -f "$folder/asked"
  "$control" "$@" || echo "exit code $?"
  cat "$folder/asked"
}
quiet="--quiet --no-ask-password"
for verb in start stop restart enable disable reset-failed; do
  Equal "$verb" "$(Asked "$verb" recogniser stereo-capture)" \
    "$quiet $verb -- visavis@recogniser.service visavis@stereo-capture.service"
done
Equal "the target" "$(Asked stop visavis.target)" "$quiet stop -- visavis.target"
Equal reload "$(Asked reload)" "$quiet daemon-reload"
echo fail >"$folder/systemctl"
code=0
"$control" start logger || code=$?
Equal "exit code where systemctl fails" "$code" 1
rm "$folder/systemctl" "$folder/asked"
Equal version "$("$control" version)" "$(cat "$root/usr/lib/visavis/version")"
[[ $("$control" --help) == "fleet-control: "*VERB* ]] || Wrong "--help does not explain"

Refused "needs a verb" "$control"
Refused "isolate: unknown verb" "$control" isolate rescue.target
Refused "--root: unknown verb" "$control" --root /tmp start logger
Refused "start: needs a service" "$control" start
for name in recognizer '' sshd '*' 'logger sshd' 'logger.service' 'visavis@logger' '../logger' -f \
  --root=/tmp $'logger\nsshd' $'log\e[2Jger'; do
  Refused "unknown service, must be one of" "$control" start "$name"
done
Refused "start sshd: unknown service" "$control" start logger sshd # none of them
Refused "version now: takes no argument" "$control" version now
Refused "deploy now: takes no argument" "$control" deploy now
Refused "reload now: takes no argument" "$control" reload now
SUDO_UID=1000 Refused "sudo may start /usr/lib/visavis/fleet-control alone" "$control" version
[[ ! -e $folder/asked ]] || Wrong "systemctl was asked for something that was refused"

# A deploy that is refused leaves what there was.
Bytes() {
  "$@" >"$folder/bytes" || true # by a file: who refuses does not read to the end
  "$control" deploy <"$folder/bytes"
}
Deploy() { Bytes tar -C "$files" -c "$@"; }
Deployed() { (cd "$etc/fleet" && head -100 -- * | paste -sd '|'); }
DeployRefused() {
  local text=$1 before
  shift
  before=$(Deployed)
  Refused "$text" "$@"
  Equal "what is deployed after '$text'" "$(Deployed)" "$before"
}
echo 'LCM_DEFAULT_URL=udpm://239.255.76.67:7667?ttl=1&recv_buf_size=4194304' >"$files/environment"
echo 'seed: 7' >"$files/recogniser.yaml"
Deploy environment recogniser.yaml
Equal "the first" "$(Deployed)" \
  "==> environment <==|$(cat "$files/environment")||==> recogniser.yaml <==|seed: 7"
echo 'name: second' >"$files/logger.yaml"
Deploy ./logger.yaml # replaces all of the first
Equal "the second" "$(Deployed)" "name: second"
Deploy . # a folder as a whole
Equal "three files" "$(find "$etc/fleet/" -type f | wc -l)" 3
Equal "folders left of earlier deploys" "$(find "$etc" -mindepth 1 -maxdepth 1 -type d | wc -l)" 1
Equal "modes" "$(stat -c %a "$etc/fleet/" "$etc/fleet/logger.yaml" | paste -sd ' ')" "755 644"

echo 'individuals: 60' >"$files/recogniser.yaml" # the service's own word on it
DeployRefused "visavis-recogniser: recogniser.yaml:1: individuals: 60: unknown key" Deploy recogniser.yaml
echo 'seed: 8' >"$files/recogniser.yaml"
# shellcheck disable=SC1003,SC2016  # nothing of it must ever expand
for line in LD_PRELOAD=/tmp/x.so 'VISAVIS_PREFIX=$(id)' 'VISAVIS_PREFIX=A B' 'export VISAVIS_PREFIX=A' \
  ' PATH=/tmp' $'VISAVIS_PREFIX=A\\\nPATH=/tmp' $'# a note\rPATH=/tmp' '# a note\'; do
  printf '\n%s\n' "$line" >"$files/environment"
  DeployRefused "must be LCM_DEFAULT_URL= or VISAVIS_PREFIX=" Deploy environment recogniser.yaml
done
printf '# a note\0\nPATH=/tmp\n' >"$files/environment"
DeployRefused "must be LCM_DEFAULT_URL= or VISAVIS_PREFIX=" Deploy environment recogniser.yaml
head -c 10001 /dev/zero | tr '\0' '\n' >"$files/environment"
DeployRefused "environment: must be at most 10000 bytes" Deploy environment recogniser.yaml
printf '# this robot\nVISAVIS_PREFIX=ROBOT1_' >"$files/environment"
Deploy environment
Equal "with a note" "$(Deployed)" "# this robot|VISAVIS_PREFIX=ROBOT1_"

# What a configuration names comes along, and is what the check and the service find.
mkdir "$folder/sub" "$files/rigs"
printf '%s\n' 'right: {width: 640, height: 480, fx: 800, fy: 800, cx: 319.5, cy: 239.5}' \
  'left: {width: 640, height: 480, fx: 800, fy: 800, cx: 319.5, cy: 239.5}' \
  'X_CL: {p_m: [-0.15, 0, 0], q_wxyz: [1, 0, 0, 0]}' >"$files/rigs/rig.yaml"
echo 'rig_file: rigs/rig.yaml' >"$files/recogniser.yaml"
DeployRefused "visavis-recogniser: recogniser.yaml:1: rig_file: rigs/rig.yaml: must be a file" Deploy recogniser.yaml
Deploy recogniser.yaml rigs
Equal "with a file that it names" "$(cat "$etc/fleet/rigs/rig.yaml")" "$(cat "$files/rigs/rig.yaml")"
Equal "its folder's mode" "$(stat -c %a "$etc/fleet/rigs")" 755
(cd / && "$root/usr/bin/visavis-recogniser" --config "$etc/fleet/recogniser.yaml" --check-config) ||
  Wrong "the deployed service does not find its file"
echo 'seed: 8' >"$files/recogniser.yaml"
Deploy environment recogniser.yaml
Equal "without that file" "$(find "$etc/fleet/" -type f | wc -l)" 2

cp "$files/recogniser.yaml" "$folder/sub"
words="must be words of letters, digits and ._+-"
DeployRefused "../sub/recogniser.yaml: $words" Deploy -P ../sub/recogniser.yaml
DeployRefused "/sub/recogniser.yaml: $words" Deploy -P "$folder/sub/recogniser.yaml"
# shellcheck disable=SC2016
for name in ../files rigs/../environment rigs/.hidden .fleet 'a b' -f '$(id)' rigs//a "$(printf '%0201d' 0)"; do
  DeployRefused "deploy: $name: $words" Deploy --transform="s,environment,$name," -P environment
done
DeployRefused "deploy: ../rigs/x: $words" Deploy --transform="s,rigs,../rigs," -P rigs
DeployRefused "deploy: logger.yaml: must be a regular file" \
  Deploy --transform="s,environment,logger.yaml/a," environment
DeployRefused "rigs: stands there twice" Deploy --transform="s,environment,rigs," rigs/rig.yaml environment
rm "$files/recogniser.yaml"
ln -s /etc/shadow "$files/recogniser.yaml"
DeployRefused "deploy: recogniser.yaml: must be a regular file" Deploy recogniser.yaml
rm "$files/recogniser.yaml"
ln "$files/environment" "$files/recogniser.yaml"
DeployRefused "deploy: recogniser.yaml: must be a regular file" Deploy environment recogniser.yaml
rm "$files/recogniser.yaml"
mkfifo "$files/recogniser.yaml"
DeployRefused "deploy: recogniser.yaml: must be a regular file" Deploy recogniser.yaml
rm "$files/recogniser.yaml"
mkdir "$files/recogniser.yaml"
DeployRefused "deploy: recogniser.yaml: must be a regular file" Deploy recogniser.yaml
rmdir "$files/recogniser.yaml"
DeployRefused "stands there twice" Deploy --hard-dereference environment environment
truncate -s 20000001 "$files/recogniser.yaml"
DeployRefused "recogniser.yaml: must be at most 20000000 bytes" Deploy recogniser.yaml
truncate -s 40G "$files/recogniser.yaml"
DeployRefused "recogniser.yaml: must be at most 20000000 bytes" Deploy --sparse recogniser.yaml
rm "$files/recogniser.yaml"

DeployRefused "stdin is empty" Bytes true
DeployRefused "stdin must be a whole tar" Bytes echo "no tar at all"
DeployRefused "the tar must be at most" Bytes head -c 50000001 /dev/zero
DeployRefused "not compressed" Bytes tar -C "$files" -cz environment
Cut() { tar -C "$files" -c environment logger.yaml | head -c "$1"; }
DeployRefused "stdin must be a whole tar" Bytes Cut 1200
DeployRefused "stdin must be a whole tar" Bytes Cut 2048
# Who sends nothing more keeps nobody waiting.
mkfifo "$folder/pipe"
"$control" deploy <"$folder/pipe" 2>/dev/null & stuck=$!
exec 8>"$folder/pipe"
Deploy environment
Equal "while another deploy hangs" "$(ls "$etc/fleet/")" environment
kill "$stuck"
exec 8>&-
wait "$stuck" || true
# What a deploy that was killed left behind goes with the next; an empty one takes everything back.
mkdir "$etc/.fleet-killed"
Deploy -T /dev/null
Equal "nothing deployed" "$(find "$etc/fleet/" -type f | wc -l)" 0
Equal "folders left" "$(find "$etc" -mindepth 1 -maxdepth 1 -type d | wc -l)" 1
Finish
