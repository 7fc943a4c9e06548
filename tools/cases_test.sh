#!/usr/bin/env bash
# Lists the lines of bats cases that assert nothing. Bash goes on after `! command` without `|| false` behind it, and after a test
# that fails before `&&`; oiiotool prints no statistics of a result by --stats.
#
#   cases_test.sh [FOLDER...]     [scripts tools]
source "$(dirname "$0")/offenders.sh"

# offenders FOLDER...: these lines, with their files and numbers.
offenders() {
  find "$@" -type f -name '*.bats' | sort | xargs awk '
    /\|\|/ { next }
    /^[ \t]*! / || /oiiotool [^-|][^|]* --stats/ { print FILENAME ":" FNR ": " $0 }
    /^[ \t]*(\[.*\]|diff .*|cmp .*) && / && !/ && (return|continue|break|skip|[a-z_]+=)/ { print FILENAME ":" FNR ": " $0 }'
}

# The control.
cat >"$folder/a.bats" <<'END'
  ! grep -q a b
  ! grep -q a b || false
  [ -e a ] && [ -e b ]
  [ -e a ] && continue
  [[ $a == b && $c == d ]]
  oiiotool a.exr --ch R --stats
  oiiotool --stats a.exr
END
check_control 2 ' ' '1 3 6 '
[ $# -gt 0 ] || set -- scripts tools
report 'lines assert nothing' "$@"
