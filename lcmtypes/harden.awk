# Corrects a C++ header of lcm-gen 1.3.1 (see lcm_hardening.hpp): reads the header, writes the
# corrected one.
#   decode: each wrong length returns -1 before anything is allocated or read; a reused message ends
#           up equal to a fresh one.
#   encode: a vector shorter than its count returns -1 instead of reading past its end.
#   both:   float and double without breaking C++'s aliasing rule.
# Every line of a decoder must be one that is known here: else the line is named and the exit code
# is 1, so that a new construct (say a vector of vectors) stops the build instead of slipping through.

function refuse(why) {
  printf "harden.awk: %s:%d: %s: %s\n", FILENAME, FNR, why, $0 > "/dev/stderr"
  failed = 1
  exit
}
# The identifier in text behind the first `before`; empty: none.
function id_after(text, before) {
  if (!index(text, before)) return ""
  text = substr(text, index(text, before) + length(before))
  return match(text, /^[A-Za-z0-9_]+/) ? substr(text, 1, RLENGTH) : ""
}
function print_before(line, statement) {
  match(line, /^ */)
  print substr(line, 1, RLENGTH) statement
}

/^#include <lcm\/lcm_coretypes.h>/ {
  print; print "#include \"visavis/lcm_hardening.hpp\""
  included = 1
  next
}
/^class / { class = $2 }
/std::vector< / && $0 ~ ("::" class " >") { refuse("recursion is not bounded") }
/^[a-z].*::/ { part = id_after($0, "::") }
part == "_decodeNoHash" { ++decoder_lines }
{
  gsub(/__(float|double)_encode_array\(/, "visavis_lcm_hardening::EncodeFloats(")
  gsub(/__(float|double)_decode_array\(/, "visavis_lcm_hardening::DecodeFloats(")
}

# --- Encoders: the check needs the vector's name, which stands in the line behind the loop's.
(part == "_encodeNoHash" || part == "_getEncodedSizeNoHash") && / a0 < this->/ { loop = $0; next }
loop != "" {
  vector = "this->" id_after($0, "this->"); count = "this->" id_after(loop, "this->")
  if (part == "_encodeNoHash")
    print_before(loop, "if(!visavis_lcm_hardening::Holds(" vector ", " count ")) return -1;")
  else
    sub(/; a0\+\+/, " \\&\\& a0 < (int)" vector ".size(); a0++", loop)
  print loop
  loop = ""
}
part == "_encodeNoHash" && /\[0\], this->/ {
  print_before($0, "if(!visavis_lcm_hardening::Holds(this->" id_after($0, "this->") ", this->" \
               id_after($0, "], this->") ")) return -1;")
}
part != "_decodeNoHash" { print; next }

# --- Decoders. `if(this->n) {` guards the resize of an array of numbers, so that an empty array would
# keep its old elements: it moves behind the resize.
held != "" && !/\.resize\(/ { refuse("expected a resize behind if()") }
/^ *if\(this->[A-Za-z0-9_]+\) \{$/ { held = $0; next }
/^ *this->[A-Za-z0-9_]+\.resize\(this->[A-Za-z0-9_]+\);$/ {
  vector = id_after($0, "this->"); count = id_after($0, "(this->")
  sized[vector] = count; last_count = count
  print_before(held != "" ? held : $0, "if(!visavis_lcm_hardening::Resize(&this->" vector \
               ", this->" count ", maxlen - pos)) return -1;")
  if (held != "") print held
  held = ""
  next
}
# A string: its length, one check, the text.
/^ *if\(__[A-Za-z0-9_]+ > maxlen - pos\) return -1;$/ {
  checked = id_after($0, "if(")
  print_before($0, "if(!visavis_lcm_hardening::StringFits(((const char*)buf) + offset + pos, " \
               checked ", maxlen - pos)) return -1;")
  next
}
/^ *this->[A-Za-z0-9_]+(\[a0\])?\.assign\(\(\(const char\*\)buf\) \+ offset \+ pos, __[A-Za-z0-9_]+ -  ?1\);$/ {
  if (id_after($0, "pos, ") != checked) refuse("text without a checked length")
  checked = ""
  print
  next
}
/^ *int32_t __[A-Za-z0-9_]+;$/ || /^ *pos \+= __[A-Za-z0-9_]+;$/ { print; next }
# Loops over a vector that has just been sized, or over a fixed array.
/^ *for \(int a0 = 0; a0 < this->[A-Za-z0-9_]+; a0\+\+\) \{$/ {
  if (id_after($0, "this->") != last_count) refuse("loop without a checked resize")
  print
  next
}
/^ *for \(int a[0-9] = 0; a[0-9] < [0-9]+; a[0-9]\+\+\) \{$/ { print; next }
# Numbers: one, a fixed array, or a vector that has been sized with the same count.
/_decode_array\(buf, offset \+ pos, maxlen - pos, &this->[A-Za-z0-9_]+\[0\], this->[A-Za-z0-9_]+\);$/ ||
/DecodeFloats\(buf, offset \+ pos, maxlen - pos, &this->[A-Za-z0-9_]+\[0\], this->[A-Za-z0-9_]+\);$/ {
  if (sized[id_after($0, "&this->")] != id_after($0, "], this->")) refuse("vector without a checked resize")
  print
  next
}
/^ *tlen = __[a-z0-9_]+_decode_array\(buf, offset \+ pos, maxlen - pos, &(this->|__)[A-Za-z0-9_]+, 1\);$/ ||
/^ *tlen = __[a-z0-9_]+_decode_array\(buf, offset \+ pos, maxlen - pos, &this->[A-Za-z0-9_]+(\[a[0-9]\])*\[0\], [0-9]+\);$/ ||
/^ *tlen = visavis_lcm_hardening::DecodeFloats\(buf, offset \+ pos, maxlen - pos, &this->[A-Za-z0-9_]+, 1\);$/ ||
/^ *tlen = visavis_lcm_hardening::DecodeFloats\(buf, offset \+ pos, maxlen - pos, &this->[A-Za-z0-9_]+(\[a[0-9]\])*\[0\], [0-9]+\);$/ ||
/^ *tlen = this->[A-Za-z0-9_]+(\[a[0-9]\])*\._decodeNoHash\(buf, offset \+ pos, maxlen - pos\);$/ ||
/^ *if\(tlen < 0\) return tlen; else pos \+= tlen;$/ ||
/^int [A-Za-z0-9_]+::_decodeNoHash\(const void \*buf, int offset, int maxlen\)$/ ||
/^ *int pos = 0, tlen;$/ || /^ *return pos;$/ || /^\{$/ || /^ *\}$/ || /^$/ { print; next }
{ refuse("not a line that it knows") }
END {
  if (!failed && (!included || !decoder_lines)) {
    printf "harden.awk: %s: not a header of lcm-gen --cpp\n", FILENAME > "/dev/stderr"
    failed = 1
  }
  exit failed
}
