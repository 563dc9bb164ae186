# The text of --help, of a program (CLI11) or of a script, to a man page. Variables: name, version.
#
#   "X: what it does" or "what it does"   the first line
#   "Usage: X [OPTIONS]"                  the synopsis
#   "Options:" alone in its line          a section
#   "  -f,--flag TEXT   what it is for"   an item, and what is indented deeper goes on with it
#   "@subcommand X"                       what follows is its help
# Other lines are paragraphs; indented ones that are no items stay as they are.

function Escape(text) {
  gsub(/\\/, "\\e", text)
  gsub(/-/, "\\-", text)
  sub(/^[.']/, "\\\\\\&&", text)
  return text
}
function Say(text) { print Escape(text) }
function Macro(macro, text) { print macro " \"" Escape(text) "\"" }
function EndVerbatim() { if (verbatim) print ".fi\n.RE"; verbatim = 0 }
function Capitals(text) { return toupper(substr(text, 1, 1)) substr(text, 2) }

{
  sub(/[ \t]+$/, "")
  gsub(/scripts\//, "visavis-")  # a script installed as visavis-X
}
NR == 1 {
  sub("^" name ": ", "")
  sub(/\.$/, "")
  printf ".TH \"%s\" 1 \"\" \"visavis %s\" \"Visavis\"\n", Escape(toupper(name)), Escape(version)
  print ".SH NAME\n" Escape(name) " \\- " Escape($0)
  next
}
/^@subcommand / {
  EndVerbatim()
  Macro(".SH", "SUBCOMMAND " toupper($2))
  first = 1
  next
}
first {  # a subcommand's own first line
  Say($0)
  first = 0
  next
}
/^Usage: / {
  EndVerbatim()
  sub(/^Usage: /, "")
  if (!synopsis++) print ".SH SYNOPSIS"; else print ".PP"
  Macro(".B", $0)
  section = 1
  next
}
/^[A-Z][A-Za-z ]*:$/ {
  EndVerbatim()
  sub(/:$/, "")
  Macro(synopsis > 1 ? ".SS" : ".SH", synopsis > 1 ? $0 : toupper($0))
  section = 1
  item = 0
  next
}
/^$/ {
  EndVerbatim()
  blank = 1
  item = 0
  next
}
# An item: two to four spaces, a term, two spaces or the end of the line, its text.
match($0, /^   ? ?[^ ]/) && (section || $1 ~ /^-/) {
  EndVerbatim()
  text = substr($0, RLENGTH)
  at = match(text, /  +/)
  print ".TP"
  Macro(".B", at ? substr(text, 1, at - 1) : text)
  if (at) Say(substr(text, at + RLENGTH))
  item = 1
  blank = 0
  next
}
item && /^     / {
  sub(/^ +/, "")
  Say($0)
  next
}
/^ / {
  # How a script is called stands before its first paragraph, without "Usage:".
  if (!section && !described) {
    if ($1 == name && !synopsis) {
      print ".SH SYNOPSIS"
      synopsis = 1
    } else if (!verbatim) {
      print ".SH DESCRIPTION"
      described = 1
    }
  }
  if (!verbatim) print ".PP\n.RS\n.nf"
  verbatim = 1
  item = 0
  Say(substr($0, 3))
  next
}
{
  EndVerbatim()
  if (!section && !described++) print ".SH DESCRIPTION"
  else if (blank) print ".PP"
  blank = 0
  item = 0
  Say($0)
}
END {
  EndVerbatim()
  print ".SH EXIT STATUS\n0 done or stopped, 1 failed while running, 2 bad flags or configuration."
  print ".SH SEE ALSO\nThe other commands of Visavis begin with\n.BR visavis\\- ;\ntheir documentation is in\n.IR /usr/share/doc/visavis ."
}
