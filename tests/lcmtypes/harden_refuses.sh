#!/bin/sh
# Usage: harden_refuses.sh LCM_GEN AWK HARDEN_AWK
# harden.awk takes the constructs that it can correct and stops the build at all others, naming file
# and line.
set -u
lcm_gen=$1 awk=$2 harden=$3
folder=$(mktemp -d) || exit 1
trap 'rm -rf "$folder"' EXIT
failures=0

# check accepted|refused FIELDS...
check() {
  wanted=$1; shift
  rm -rf "${folder:?}"/*
  echo "package p; struct a_t { int32_t n; int8_t m; $* } struct b_t { int8_t x; }" > "$folder/a.lcm"
  "$lcm_gen" --cpp --cpp-std=c++11 --cpp-hpath "$folder" "$folder/a.lcm" || exit 1
  "$awk" -f "$harden" "$folder/p/a_t.hpp" > "$folder/out.hpp" 2> "$folder/error"
  case $? in 0) got=accepted ;; 1) got=refused ;; *) got="exit $?" ;; esac
  if [ "$got" != "$wanted" ]; then
    echo "FAILED: '$*' was $got, must be $wanted: $(cat "$folder/error")"
    failures=$((failures + 1))
  elif [ "$got" = refused ] && ! grep -q "^harden.awk: .*a_t.hpp:[0-9]*: " "$folder/error"; then
    echo "FAILED: '$*' was refused without file and line: $(cat "$folder/error")"
    failures=$((failures + 1))
  fi
}

check accepted 'double x;'
check accepted 'double x[3]; float y[2][3]; boolean b; string s;'
check accepted 'string s[2]; b_t c[2]; b_t d[2][2]; b_t e;'
check accepted 'double x[n]; byte y[m]; string s[n]; b_t c[m];'
check refused 'double x[n][m];'
check refused 'double x[n][3];'
check refused 'double x[3][n];'
check refused 'string x[2][n];'
check refused 'string x[n][2];'
check refused 'b_t x[n][m];'
check refused 'a_t x[n];'

echo '#include <vector>' > "$folder/other.hpp"
"$awk" -f "$harden" "$folder/other.hpp" > /dev/null 2>&1 &&
  echo "FAILED: a header that is not lcm-gen's was accepted" && failures=$((failures + 1))
[ $failures -eq 0 ] && echo "all constructs as expected"
exit $((failures > 0))
