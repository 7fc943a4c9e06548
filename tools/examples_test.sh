#!/usr/bin/env bash
# Executes the examples of man pages and of README.md: the commands of tool pages and of blocks that begin with ```sh, which
# have to be done (0), if with a negative verdict (1) or into a pipe that head closes (141); and of goniochrome-paint(5) the sample
# files, which have to be read. In goniochrome-tutorial(7) they are the literal blocks.
#
#   examples_test.sh PAGE...     the tools are in PATH, TESTDATA is the folder of sample data
set -euo pipefail
pages=()
for page in "$@"; do pages+=("$(realpath "$page")"); done
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
ln -s "$(realpath "$TESTDATA")" testdata
export XDG_CACHE_HOME=$folder/caches

wrong=0
executed=0

# commands PAGE: the example commands as a reader copies them, one a line.
commands() {
  case $1 in
    *.md) awk '/^```/ { inside = /^```sh$/; next } inside' "$1" && return ;;
    *.7) awk '/^\.Bd -literal/ { inside = 1; next } /^\.Ed/ { inside = 0 } inside' "$1" | sed 's/\\e/\\/g; s/\\-/-/g' && return ;;
  esac
  awk '/^\.S[Hh] / { inside = /EXAMPLES/ } inside' "$1" | sed -n '/^\.RS/,/^\.RE/p' | sed '/^\.R[SE]/d; s/\\-/-/g; s/\\(aq/'\''/g; s/\\e/\\/g; s/^\\&//'
}

# execute COMMAND [STATUS...]: runs it; any other exit status than 0 and these is wrong.
execute() {
  local command=$1 status=0
  shift
  bash -c "set -eo pipefail; $command" >out 2>err </dev/null || status=$?
  executed=$((executed + 1))
  # The tools can be built without this compiler, and the one that needs it then says so.
  if [ "$status" -eq 3 ] && grep -q 'there was no compiler for WebAssembly when the tools were built' err; then
    echo "left out, for there was no compiler for WebAssembly: $command"
    return
  fi
  [[ " 0 $* " == *" $status "* ]] && return
  printf 'exit status %d: %s\n' "$status" "$command"
  tail -n 5 err
  wrong=1
}

# samples PAGE: writes the literal blocks of a page to sample-1, sample-2, ...
samples() {
  awk '/^\.Bd -literal/ { inside = 1; file = "sample-" ++count; next } /^\.Ed/ { inside = 0 } inside { print > file }' "$1"
}

# Reads each sample by what it starts with; a sample message is no file.
read_samples() {
  samples "$1"
  local sample
  mkdir -p maps
  for sample in sample-*; do
    case $(head -c 200 "$sample") in
      *'<paints'*) execute "paint-convert --to xml $sample -o read.paints.xml && grep -q RM331 read.paints.xml" ;;
      '<basis'*) execute "fit-paint --quiet --basis $sample testdata/paints.paints.xml -o /dev/null" ;;
      sample,*) execute "paint-convert --from csv --to xml $sample -o read.paints.xml && grep -q RM331 read.paints.xml" ;;
    esac
  done
}

for page in "${pages[@]}"; do
  before=$executed
  case $page in
    *.5) read_samples "$page" ;;
    *) while IFS= read -r command; do execute "$command" 1 141; done < <(commands "$page") ;;
  esac
  [ "$executed" -gt "$before" ] || {
    echo "$page: no example was found"
    wrong=1
  }
done
echo "$executed examples"
exit $wrong
