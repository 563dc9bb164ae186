#!/usr/bin/env bash
# Each script can be run, tells with --help what it does in 80 columns, and refuses an unknown flag
# with one line and exit code 2.
# shellcheck source=tests/house/files.sh
source "$(dirname "$0")/files.sh"
failed=0

Complain() {
  echo "$1"
  failed=1
}

for script in $(Files 'scripts/*' | grep -E '^scripts/[a-z_-]+$'); do
  [[ -x $script ]] || Complain "$script: must be executable"
  if [[ $(head -1 "$script") == *bash* ]]; then bash -n "$script" || Complain "$script: no bash"; fi
  help=$("$script" --help </dev/null) || Complain "$script: --help must exit with 0"
  [[ $help == "$script: "* ]] || Complain "$script: --help must begin with '$script: '"
  if grep -nE '.{81}' <<<"$help"; then Complain "$script: --help must fit 80 columns"; fi
  [[ $script == scripts/test ]] && continue  # what it does not know goes to ctest
  code=0
  error=$("$script" --no-such-flag </dev/null 2>&1 >/dev/null) || code=$?
  ((code == 2)) || Complain "$script: an unknown flag must exit with 2, not $code"
  [[ $error == *--no-such-flag* && $(wc -l <<<"$error") == 1 ]] ||
    Complain "$script: an unknown flag must get one line naming it, not: $error"
done

if command -v shellcheck >/dev/null; then
  Files 'scripts/*' 'tests/*.sh' '.ci/*' | xargs grep -lE '^#!.*sh\b|^# shellcheck shell=bash' |
    xargs shellcheck -x -P "$PWD" || failed=1
fi
exit "$failed"
