# Sourced by tests that list lines which break a rule. Each defines offenders FOLDER..., and puts a control into $folder.
set -euo pipefail
top=$(cd "$(dirname "$0")/.." && pwd)
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

# check_control FIELDS END EXPECTED: the fields of all that is found in the control, each line ended by END.
check_control() {
  [ "$(offenders "$folder" | cut -d: -f"$1" | tr '\n' "$2")" = "$3" ] || {
    echo 'the control is wrong:'
    offenders "$folder"
    exit 1
  }
}

# report RULE FOLDER...: lists what breaks it, and fails if anything does.
report() {
  local rule=$1 found
  shift
  cd "$top"
  found=$(offenders "$@")
  [ -z "$found" ] || {
    echo "$found"
    echo "$(wc -l <<<"$found") $rule"
    exit 1
  }
}
