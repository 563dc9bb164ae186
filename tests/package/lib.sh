# To be sourced. Makes $folder, which goes away at the end, and counts what is wrong: each test says
# what it found and goes on; Finish ends with 1 if there was anything.
# shellcheck shell=bash
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf --one-file-system "$folder"' EXIT
failures=0

Skip() {
  echo "skipped: $1"
  exit 77
}

Wrong() {
  echo "FAILED: $1"
  failures=$((failures + 1))
}

Finish() { ((failures == 0)); }

# InstallPrograms BUILD ROOT: everything of the package visavis, as on a machine whose / is ROOT.
InstallPrograms() {
  DESTDIR=$2 cmake --install "$1" --component programs --prefix /usr >"$folder/install.log" || {
    cat "$folder/install.log"
    exit 1
  }
}

# Equal WHAT ACTUAL EXPECTED
Equal() { [[ $2 == "$3" ]] || Wrong "$1: is '$2', not '$3'"; }

# Refused TEXT COMMAND...: it ends with 2 and says one line, which holds TEXT; stdin goes to it.
Refused() {
  local text=$1 code=0 out
  shift
  out=$("$@" 2>&1) || code=$?
  Equal "exit code of '${*:2}'" "$code" 2
  if [[ $(wc -l <<<"$out") != 1 || $out != *"$text"* ]]; then
    Wrong "'${*:2}' says '$out', not one line with '$text'"
  fi
}
