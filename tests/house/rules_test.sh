#!/usr/bin/env bash
# No file above 400 lines; no print, exit, abort or assert in a library: only in a main and in what
# speaks for it.
# shellcheck source=tests/house/files.sh
source "$(dirname "$0")/files.sh"
failed=0

while read -r lines file; do
  if [[ $file != total ]] && ((lines > 400)); then
    echo "$file: $lines lines: must be at most 400"
    failed=1
  fi
done < <(Files 'common/*' 'services/*' 'tests/*.cc' 'tests/*.h' 'scripts/*' 'lcmtypes/*' |
  grep -E '\.(h|cc|sh|awk|hpp|lcm|txt)$|^scripts/' | xargs wc -l)

speaks_for_main='/main\.cc|/[a-z_]*_main\.cc|common/service/(run_service|service_flags)\.cc'
words='std::(cout|cerr|clog)\b|\b(printf|fprintf|puts|perror)\(|\b(exit|_exit|abort|assert)\('
if Files 'common/*.h' 'common/*.cc' 'services/*.h' 'services/*.cc' | grep -vE "$speaks_for_main" |
  xargs grep -nE "$words" | grep -vE ':[0-9]+: *//'; then
  echo "the lines above print or end the process: a library must do neither"
  failed=1
fi
exit "$failed"
