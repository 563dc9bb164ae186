# To be sourced: Files GLOB... lists the tree's files, one a line; from git where it knows them (so
# that nobody's scratch counts), else from the folders (a source archive).
# shellcheck shell=bash
set -euo pipefail
Files() {
  if git rev-parse --is-inside-work-tree >/dev/null 2>&1; then
    git ls-files --cached --others --exclude-standard -- "$@"
  else
    local pattern
    for pattern in "$@"; do
      find common services tests lcmtypes scripts -path "./$pattern" -o -path "$pattern"
    done | sort
  fi
}
