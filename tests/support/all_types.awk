# From all .lcm files: a header that includes every message, lists their types, and visits the fields
# of two messages side by side (lcm-gen writes no comparison).
/^struct / { types[++n] = $2; fields = "" }
/^ *const / || !/^ *[A-Za-z0-9_]+ [A-Za-z0-9_]+(\[.*\])?;/ || n == 0 { if (!/^}/) next }
/^}/ { all[n] = fields; next }
{
  name = $2; sub(/[[;].*/, "", name)
  fields = fields (fields == "" ? "" : " && ") "f(a." name ", b." name ")"
}
END {
  print "#pragma once\n"
  for (i = 1; i <= n; ++i) print "#include \"visavis/" types[i] ".hpp\""
  print "\nnamespace visavis {\n"
  print "/// Every message type, as List<a_t, b_t, ...>."
  printf "template <template <typename...> class List>\nusing AllTypes = List<"
  for (i = 1; i <= n; ++i) printf "%s%s", types[i], (i < n ? ", " : ">;\n")
  for (i = 1; i <= n; ++i)
    print "\ntemplate <typename F>\nbool AllFields(const " types[i] "& a, const " types[i] \
          "& b, F f) {\n  return " all[i] ";\n}"
  print "\n}  // namespace visavis"
}
