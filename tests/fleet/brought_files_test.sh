#!/usr/bin/env bash
# brought_files_test.sh REPO: which files `visavis-fleet deploy` brings along with a configuration, and
# what it says of those that it cannot.
# shellcheck disable=SC2034  # for what is sourced
set -euo pipefail
repo=${1:?the checkout}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
# shellcheck source=scripts/fleet-system.sh
source "$repo/scripts/fleet-system.sh"
# shellcheck source=scripts/fleet-remote.sh
source "$repo/scripts/fleet-remote.sh"
scratch=$folder/scratch
mkdir -p "$folder/robot/rigs" "$folder/robot/recorded" "$scratch"
cd "$folder/robot"
num_failures=0

# Brings EXPECTED FAULTS: for the host of system.conf; both with a space between lines.
Brings() {
  local brought faults
  (
    task_services=() task_hosts=() task_files=() hosts=() given_at=() address=()
    ReadSystem system.conf
    MakeConfiguration localhost
  )
  brought=$(cd "$scratch/configuration/localhost" && find . -type f | sort | paste -sd ' ')
  faults=$(paste -sd ' ' "$scratch/localhost.unfit")
  if [[ $brought != "$1" || $faults != "$2" ]]; then
    printf 'FAILED: %s\n  brought: %s\n  instead: %s\n  faults:  %s\n  instead: %s\n' \
      "${3:-}" "$brought" "$1" "$faults" "$2"
    num_failures=$((num_failures + 1))
  fi
}

printf '%s\n' 'prefix A_' 'recogniser localhost recogniser.yaml' 'arm-state localhost' >system.conf
touch head.obj notes.txt recorded/frames.csv
echo 'arm: {urdf: "arm.urdf", base: b, tip: t}  # see notes.txt' >rigs/rig.yaml
touch rigs/arm.urdf arm.urdf
printf '%s\n' 'rig_file: rigs/rig.yaml # or notes.txt' 'seed: 7' 'refined:' "  head: {file: './head.obj', scale: 1}" \
  'folder: recorded' >recogniser.yaml
Brings "./environment ./head.obj ./recogniser.yaml ./rigs/arm.urdf ./rigs/rig.yaml" "" \
  "what a configuration names, and what that names, to the same places"
cmp -s rigs/rig.yaml "$scratch/configuration/localhost/rigs/rig.yaml" || num_failures=$((num_failures + 1))
echo "rig_file: $PWD/rigs/rig.yaml" >recogniser.yaml
Brings "./environment ./recogniser.yaml" "" "an absolute path is the machine's own"
echo "rig_file: rigs/none.yaml" >recogniser.yaml
Brings "./environment ./recogniser.yaml" "" "what is not here is for the check there to refuse"

mkdir other
echo "rig_file: ../arm.urdf" >other/recogniser.yaml
sed -i 's| recogniser.yaml| other/recogniser.yaml|' system.conf
Brings "./environment ./recogniser.yaml" './other/recogniser.yaml: names "../arm.urdf": must lie in ./other or below, of letters, digits and ._+-, or be an absolute path there' \
  "what lies elsewhere"
echo "rig_file: logger.yaml" >other/recogniser.yaml
touch other/logger.yaml
Brings "./environment ./recogniser.yaml" './other/recogniser.yaml: names "logger.yaml": must have another name, as that is a service'\''s there' \
  "the name of another service's configuration"
printf '%s\n' 'arm-state localhost arm.yaml' 'recogniser localhost other/recogniser.yaml' >system.conf
echo "rig_file: rig.yaml" | tee arm.yaml >other/recogniser.yaml
echo "right: 1" | tee rig.yaml >other/rig.yaml
Brings "./arm-state.yaml ./environment ./recogniser.yaml ./rig.yaml" "" "one file by two names"
echo "right: 2" >other/rig.yaml
Brings "./arm-state.yaml ./environment ./recogniser.yaml ./rig.yaml" './other/recogniser.yaml: names "rig.yaml": must have another name, as another service of localhost names another file so' \
  "two files by one name"
truncate -s 20000001 other/rig.yaml
echo 'recogniser localhost other/recogniser.yaml' >system.conf
Brings "./environment ./recogniser.yaml" './other/recogniser.yaml: names "rig.yaml": must be readable, of at most 20 MB' \
  "what fleet-control would refuse"
grep -q "max_file_bytes=$MAX_FILE_BYTES " "$repo/scripts/packaging/root/fleet-control" || {
  echo "FAILED: fleet-control takes files of another size"
  num_failures=$((num_failures + 1))
}

if ((num_failures > 0)); then exit 1; fi
echo "all as expected"
