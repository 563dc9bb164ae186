#!/usr/bin/env bash
# Usage: man_pages_test.sh BUILD
# Man pages out of --help: of each program of the build, and of what is told here, line by line.
# shellcheck source=tests/package/lib.sh
source "$(dirname "$0")/lib.sh"
make_man=scripts/packaging/make_man
cat >"$folder/help" <<'END'
Looks into logs.
Usage: visavis-look [OPTIONS] LOG

Positionals:
  LOG TEXT:FILE REQUIRED      a log, of a C:\path even

Options:
  -h,--help                   Print this help message and exit
  --offset TEXT Excludes: --align
                              the constant
                              transform
END
cat >"$folder/visavis-look" <<END
#!/bin/sh
cat $folder/help
END
chmod +x "$folder/visavis-look"

# Body: the page without what every page ends with.
Body() { "$make_man" visavis-look 1.2 "$folder/visavis-look" | sed '/^.SH EXIT STATUS/,$d'; }
Equal "the page of a program" "$(Body)" '.TH "VISAVIS\-LOOK" 1 "" "visavis 1.2" "Visavis"
.SH NAME
visavis\-look \- Looks into logs
.SH SYNOPSIS
.B "visavis\-look [OPTIONS] LOG"
.SH "POSITIONALS"
.TP
.B "LOG TEXT:FILE REQUIRED"
a log, of a C:\epath even
.SH "OPTIONS"
.TP
.B "\-h,\-\-help"
Print this help message and exit
.TP
.B "\-\-offset TEXT Excludes: \-\-align"
the constant
transform'
cat >"$folder/help" <<'END'
scripts/look: looks.

  visavis-look [--flag] COMMAND

  begin   begins

A paragraph of scripts/look that
goes on.

  an example   kept as it is
  .and another

  --flag   does it
END
Equal "the page of a script" "$(Body | sed 1d)" '.SH NAME
visavis\-look \- looks
.SH SYNOPSIS
.PP
.RS
.nf
visavis\-look [\-\-flag] COMMAND
.fi
.RE
.SH DESCRIPTION
.PP
.RS
.nf
begin   begins
.fi
.RE
.PP
A paragraph of visavis\-look that
goes on.
.PP
.RS
.nf
an example   kept as it is
\&.and another
.fi
.RE
.TP
.B "\-\-flag"
does it'

command -v groff >/dev/null || Skip "groff is missing: sudo apt-get install groff-base"
# Plain FILE: the page as a reader sees it.
Plain() { LC_ALL=C groff -man -Tascii "$1" | sed 's/.\x08//g; s/\x1b\[[0-9;]*m//g'; }
for program in "$1"/bin/visavis-*; do
  name=$(basename "$program")
  "$make_man" "$name" 1.2 "$program" >"$folder/$name.1"
  warnings=$(LC_ALL=C groff -man -Tutf8 -ww -z "$folder/$name.1" 2>&1)
  Equal "what groff finds in $name.1" "$warnings" ""
  text=$(Plain "$folder/$name.1")
  # Every flag that --help names stands at the head of an item.
  while read -r flag; do
    grep -qE "^ +(-.,)?$flag" <<<"$text" || Wrong "$name.1 does not tell $flag"
  done < <("$program" --help | sed -n 's/^  \(-.,\)\{0,1\}\(--[a-z-]*\).*/\2/p')
done
[[ -s $folder/visavis-recogniser.1 ]] || Wrong "there is no page of visavis-recogniser"
Plain "$folder/visavis-log.1" | grep -q '^SUBCOMMAND IMPORT' || Wrong "visavis-log.1 tells no import"
Finish
