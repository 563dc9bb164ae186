#!/usr/bin/env bash
# Every C++ file is as clang-format leaves it. The version is Debian 12's: another one formats
# differently, so there the test is skipped.
# shellcheck source=tests/house/files.sh
source "$(dirname "$0")/files.sh"
clang_format=$(command -v clang-format-14 || command -v clang-format || true)
version=$([[ -z $clang_format ]] || "$clang_format" --version | grep -oE 'version [0-9]+')
if [[ $version != "version 14" ]]; then
  echo "skipped: needs clang-format version 14, here is ${version:-none}"
  exit 77
fi
mapfile -t files < <(Files '*.h' '*.cc')
echo "${#files[@]} files"
"$clang_format" --dry-run -Werror --ferror-limit=1 "${files[@]}"
