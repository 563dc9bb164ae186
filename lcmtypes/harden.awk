# Corrects a C++ header of lcm-gen 1.3.1 so that its decoder survives any bytes: reads the header,
# writes the corrected one. Each wrong length makes decode() return -1 before anything is allocated.
# Fails (exit 1) where a line of the decoder looks different from what it knows how to correct.

/^#include <lcm\/lcm_coretypes.h>/ { print; print "#include \"visavis/lcm_hardening.hpp\""; next }
/::_decodeNoHash\(/ { in_decoder = 1 }
in_decoder && /^}/ { in_decoder = 0 }

# `if(this->n) {` skips the resize of an empty array, so that a reused message keeps old elements.
in_decoder && /^ *if\(this->[A-Za-z0-9_]+\) \{$/ { sub(/if\(this->[A-Za-z0-9_]+\) /, "") }

in_decoder && match($0, /this->[A-Za-z0-9_]+\.resize\(this->[A-Za-z0-9_]+\);$/) {
  statement = substr($0, RSTART)
  vector = statement; sub(/\.resize.*/, "", vector)
  count = statement; sub(/.*\(/, "", count); sub(/\).*/, "", count)
  indent = substr($0, 1, RSTART - 1)
  print indent "if (!visavis_lcm_hardening::ArrayFits(" vector ", " count ", maxlen - pos)) return -1;"
  print
  next
}
in_decoder && /\.resize\(/ { print "harden.awk: cannot correct: " $0 > "/dev/stderr"; failed = 1 }

in_decoder && match($0, /if\(__[A-Za-z0-9_]+ > maxlen - pos\) return -1;/) {
  name = $0; sub(/.*if\(/, "", name); sub(/ >.*/, "", name)
  print substr($0, 1, RSTART - 1) "if (!visavis_lcm_hardening::StringFits(((const char*)buf) + offset + pos, " \
    name ", maxlen - pos)) return -1;"
  next
}
# &v[0] of an empty vector is undefined.
in_decoder && match($0, /&this->[A-Za-z0-9_]+\[0\], this->/) {
  vector = substr($0, RSTART + 1, RLENGTH - 12)
  $0 = substr($0, 1, RSTART - 1) vector ".data(), this->" substr($0, RSTART + RLENGTH)
}
{ print }
END { exit failed }
