#!/usr/bin/env bash
# Usage: installed_types_test.sh BUILD OUTSIDE
# Installs the messages of BUILD into a folder; the project in OUTSIDE, which knows nothing of ours
# but that folder, is configured, built and run by CMake, then once more by pkg-config.
set -euo pipefail
build=$1 outside=$2
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
expected="HEAD_POSE 42 TRACKING 1 z 1.050 m"

Fail() {
  echo "FAILED: $1"
  exit 1
}

for component in lcmtypes dev; do
  DESTDIR=$folder/dest cmake --install "$build" --component "$component" --prefix /prefix \
    >"$folder/install.log" ||
    Fail "component $component cannot be installed: $(cat "$folder/install.log")"
done
[[ $(ls "$folder/dest") == prefix ]] || Fail "outside of the prefix: $(find "$folder/dest" -type f)"
mv "$folder/dest/prefix" "$folder/root"
if grep -rlF -e "$build" -e "$PWD" "$folder/root"; then Fail "the files above name the build"; fi

help=$("$folder/root/bin/visavis-spy" --help)
[[ $help == "visavis-spy: "* ]] || Fail "visavis-spy does not run where it is installed: $help"
if "$folder/root/bin/visavis-spy" --player /nonexistent 2>"$folder/log"; then Fail "visavis-spy plays nothing"; fi
grep -q '^visavis-spy: ' "$folder/log" || Fail "visavis-spy calls itself: $(cat "$folder/log")"

if ! { cmake -S "$outside" -B "$folder/build" -G Ninja -DCMAKE_PREFIX_PATH="$folder/root" \
  -DCMAKE_CXX_FLAGS="-Wall -Wextra -Wconversion -Werror" && cmake --build "$folder/build"; } \
  >"$folder/log" 2>&1; then
  Fail "by CMake: $(cat "$folder/log")"
fi
printed=$("$folder/build/outside")
[[ $printed == "$expected" ]] || Fail "built by CMake it prints '$printed', not '$expected'"

# A newer minor version than what is installed is refused.
mkdir "$folder/newer"
sed 's/visavis 0.1/visavis 0.99/' "$outside/CMakeLists.txt" >"$folder/newer/CMakeLists.txt"
if cmake -S "$folder/newer" -B "$folder/newer/build" -G Ninja \
  -DCMAKE_PREFIX_PATH="$folder/root" >"$folder/log" 2>&1; then
  Fail "find_package(visavis 0.99) accepts what is installed"
fi
grep -q 'requested version "0.99"' "$folder/log" || Fail "another reason: $(cat "$folder/log")"

flags=$(PKG_CONFIG_PATH=$folder/root/share/pkgconfig pkg-config --cflags --libs visavis-lcmtypes) ||
  Fail "pkg-config does not know visavis-lcmtypes"
# shellcheck disable=SC2086  # a list of flags
"${CXX:-c++}" -std=c++17 "$outside/main.cc" $flags -o "$folder/by_pkg_config"
printed=$("$folder/by_pkg_config")
[[ $printed == "$expected" ]] || Fail "built by pkg-config it prints '$printed', not '$expected'"
