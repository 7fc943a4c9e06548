#!/usr/bin/env bash
# Holds the order of the rooms that lib/README.md states:
#   - an #include under lib/ names the same room or one before it, and `cli` stands on `base` alone;
#   - what lies in a private folder (internal/, and every folder of `render`) is included by its own room alone;
#   - the sources platform_*.cpp of the page stand in the place of files of the rooms, and may include what these include;
#   - a public header stands at the top of its room because somebody outside the room includes it;
#   - inside `render` no include leads back up: a header and its source are one unit, and the units have an order;
#   - no third-party type shows in a public header;
#   - the code of a room stands in the namespace of that name; that of `base` stands in goniochrome itself; below it a test has a
#     namespace of the name of its file, since several tests are compiled at once;
#   - what of std::filesystem can throw stands in base/paths.cpp alone: a loop of links or a forbidden folder is no bug;
#   - lib/README.md lists the rooms, and CMake builds them, in this order.
set -euo pipefail
cd "$(dirname "$0")/../lib"

order=(base math color paint formats library quality brdf materials image display envmap prefilter mesh rays fit capture render panels sketch studio report cli)
declare -A rank
for i in "${!order[@]}"; do rank[${order[i]}]=$i; done
rank[fuzz]=99

wrong=0
checked=0
complain() {
  echo "$*"
  wrong=1
}

private='^[a-z]+/internal/|^render/[a-z]+/'
while IFS=: read -r file _ include; do
  file=${file#./}
  header=${include#\#include \"}
  header=${header%\"*}
  from=${file%%/*}
  to=${header%%/*}
  checked=$((checked + 1))
  [ -n "${rank[$to]:-}" ] || complain "$file includes $header: there is no room $to"
  if [ "$from" != "$to" ]; then
    [[ $header =~ $private ]] && complain "$file includes $header, which belongs to $to alone"
    if [ "$from" = cli ]; then
      [ "$to" = base ] || complain "$file includes $header: cli stands on base alone"
    elif [ "$to" = cli ]; then
      complain "$file includes $header: only tools include cli"
    elif [ "${rank[$to]:-99}" -gt "${rank[$from]:-0}" ]; then
      complain "$file includes $header, which stands above $from"
    fi
  fi
done < <(grep -rnE '^#include "[a-z]+/' --include='*.h' --include='*.cpp' .)
while IFS=: read -r file _ include; do
  header=${include#\#include \"}
  [[ $file =~ paint-studio/wasm/platform_ ]] && continue
  [[ ${header%\"*} =~ $private ]] && complain "tools/$file includes ${header%\"*}, which is private to its room"
done < <(cd ../tools && grep -rnE '^#include "[a-z]+/' --include='*.h' --include='*.cpp' .)
[ "$checked" -gt 500 ] || complain "only $checked includes were found: this test checks nothing"

# A header at the top of a room that nobody outside includes belongs into the room's internal/.
while read -r header; do
  header=${header#./}
  room=${header%%/*}
  case $room in base | cli | fuzz) continue ;; esac
  grep -rqF "#include \"$header\"" --include='*.h' --include='*.cpp' $(printf '%s\n' */ | grep -v "^$room/") ../tools ||
    complain "$header is public, and nobody outside $room includes it: it belongs into $room/internal"
done < <(find . -name '*.h' | grep -vE "^\./([a-z]+/internal|render/[a-z]+|image/codecs)/" | sort)

# arrows: for each include inside `render` the unit and that which it includes.
arrows() {
  grep -rE '^#include "render/' --include='*.h' --include='*.cpp' render | grep -vE '_(test|bench)\.cpp:|_for_test\.h' |
    sed -E 's#^([^:.]*)\.[a-z]+:\#include "([^".]*)\.h".*#\1 \2#; s/-inl\b//g' | awk '$1 != $2'
}
# loops: reads arrows, prints the units of those that lead back.
loops() { tsort 2>&1 >/dev/null | sed -n 's/^tsort: \(render\)/\1/p' | xargs; }
loop=$(arrows | loops)
[ -z "$loop" ] || complain "these include each other: $loop"
[ -n "$({ arrows && echo render/scene render/renderer; } | loops)" ] || complain "a loop is not found: this test checks nothing"

# fit/ceres_options.h is for the two rooms that solve by Ceres.
while read -r line; do complain "$line: belongs into a .cpp or into internal/"; done < <(
  grep -rlE --include='*.h' '' . | grep -vE '/internal/|^\./render/[a-z]+/|^\./fit/ceres_options\.h$|_for_test\.h$' |
    xargs grep -nE '^#include <(Eigen|ceres|CGAL|Clp|Coin|OpenImageIO|OpenColorIO|libxml|lcms2|jpeglib|embree|GL/|CLI|embree)' || true)

for room in "${order[@]}"; do
  name=goniochrome::$room
  [ "$room" = base ] && name=goniochrome
  while read -r file; do
    own=$name
    [[ $file != *_test.cpp ]] || own+=::$(basename "$file" .cpp)
    grep -qE "^namespace $own(::[a-z_]+)? \{" "$file" || complain "$file does not stand in the namespace $own"
  done < <(find "$room" \( -name '*.h' -o -name '*.cpp' \) ! -path '*/codecs/*')
done

throwing='filesystem::([a-oq-z_]|p[b-z]|path_)[a-z_]*'
while read -r line; do complain "$line: may throw: use base/paths.h"; done < <(
  grep -rnE "$throwing" --include='*.h' --include='*.cpp' . ../tools |
    grep -vE '_(test|bench)\.cpp:|_for_test\.h:|^\./fuzz/|^\./base/paths\.(cpp|h):' || true)

map=$(sed -nE 's/^\| `([a-z]+)` \|.*/\1/p' README.md | tr '\n' ' ')
[ "$map" = "${order[*]} " ] || complain "lib/README.md lists the rooms as \"$map\""
built=$(sed -nE '/^foreach\($/,/\)$/p' CMakeLists.txt | grep -oE '\b[a-z]+\b' | grep -vxE 'foreach|room|fuzz' | tr '\n' ' ')
[ "$built" = "${order[*]} " ] || complain "lib/CMakeLists.txt builds the rooms as \"$built\""
exit $wrong
