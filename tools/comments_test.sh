#!/usr/bin/env bash
# Lists the comments in lib and tools that begin without a subject: with What, Whether, Of, As, That, or The same.
#
#   comments_test.sh [FOLDER...]     [lib tools]
source "$(dirname "$0")/offenders.sh"

# offenders FOLDER...: the first line of each such comment, with its file and line.
offenders() {
  find "$@" -type f \( -name '*.h' -o -name '*.cpp' -o -name '*.js' -o -name '*.sh' -o -name '*.bats' -o -name '*.py' \) | sort | xargs awk '
    FNR == 1 { mark = FILENAME ~ /\.(sh|bats|py)$/ ? "(^|[ \t])#+ " : "(^|[ \t])//+ "; inside = 0 }
    {
      at = match($0, mark)
      text = at ? substr($0, RSTART + RLENGTH) : ""
      whole = at && substr($0, 1, RSTART) ~ /^[ \t#\/]*$/
      if (at && !(whole && inside) && text ~ /^(What|Whatever|Whether|Whoever|Of|As|That|The same)[ ,:.]/) print FILENAME ":" FNR ": " text
      inside = whole
    }'
}

# The control: what begins a comment is found, and what goes on with one is not.
printf '// What it is.\nint a;  // Whether it is.\n// A line\n// Of two.\nint b;\n  // The same again.\n// Offsets of it.\n' >"$folder/a.h"
printf '# As it was.\n# What goes on.\necho %s That one\n' '#' >"$folder/a.sh"
check_control 2- ';' '1: What it is.;2: Whether it is.;6: The same again.;1: As it was.;3: That one;'
[ $# -gt 0 ] || set -- lib tools
report 'comments begin without a subject' "$@"
