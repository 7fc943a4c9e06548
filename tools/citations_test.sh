#!/usr/bin/env bash
# Holds that every citation of a man page names a page and a title that exist: `goniochrome-coats(7), "SATIN"` in code and
# documents, `.Xr goniochrome-coats 7 ,` before `.Qq SATIN` and `.Sx SATIN` in the pages. A title without quotes is wrong, too.
#
#   citations_test.sh
set -euo pipefail
top=$(cd "$(dirname "$0")/.." && pwd)
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

# titles TREE: each page with each of its titles, "goniochrome-coats(7)<tab>SATIN", and with none.
titles() {
  local page
  for page in "$1"/man/*.[1-9]; do
    page=$(basename "$page")
    printf '%s(%s)\t\n' "${page%.*}" "${page##*.}"
    sed -nE "s/^\.S[HhSs] (.*)/${page%.*}(${page##*.})\t\1/p" "$1/man/$page"
  done | sed 's/\\-/-/g'
}

# cited TREE: each citation with its file, "lib/brdf/coat.h<tab>goniochrome-coats(7)<tab>SATIN". Words behind the comma that begin
# with a capital are a title without quotes, which is told as "SATIN without quotes".
cited() {
  cd "$1"
  local file page='goniochrome(-[a-z-]+)?\([1-9]\)'
  page="($page|($(ls man | sed -nE 's/\.1$//p' | paste -sd '|'))\(1\))"
  grep -RlE --exclude-dir=man "$page" . | while read -r file; do
    # Comments and strings go on from line to line.
    awk '{ sub(/^[ \t]*(\/\/|#)[ \t]?/, ""); text = text " " $0 } END { gsub(/[^\\]" +"/, " ", text); print text }' "$file" | tr -s ' ' |
      { grep -oE "$page"'(, \\?"[^"\\]+\\?"( and \\?"[^"\\]+\\?")?|, [A-Z][A-Za-z]+)?' || true; } |
      sed -E 's/, ([A-Z][A-Za-z]+)$/, "\1 without quotes"/; s/\\"/"/g; s/ and "([^"]+)"$/\t\1/; s/, "([^"]+)"/\t\1/; s/^([^\t]+)\t([^\t]+)\t([^\t]+)$/\1\t\2\n\1\t\3/; s/^([^\t]+)$/\1\t/' |
      sed "s|^|${file#./}\t|"
  done
  for file in man/*.[57]; do
    awk -v file="$file" '
      function plain(s) { sub(/ *[.,;:]*$/, "", s); return s }
      /^\.Nm goniochrome/ && !own { own = $2 }
      /^\.Xr / { page = $2 "(" $3 ")"; print file "\t" page "\t"; next }
      /^\.Qq / && page { print file "\t" page "\t" plain(substr($0, 5)) }
      /^\.(Pq )?Sx / { text = $0; sub(/^\.(Pq )?Sx /, "", text); print file "\t" own "(" substr(file, length(file)) ")\t" plain(text) }
      /^[A-Z][A-Z]+ *[.,;:]?$/ && page { print file "\t" page "\t" plain($0) " without quotes" }
      match($0, /goniochrome(-[a-z-]+)?\([1-9]\)/) && !/^\.Bl/ { print file "\t" substr($0, RSTART, RLENGTH) "\tno .Xr" }
      { page = "" }' "$file"
  done
}

# wrong TREE: the citations that lead nowhere.
wrong() {
  titles "$1" | sort -u >"$folder/titles"
  (cited "$1") | awk -F'\t' 'NR == FNR { known[$1 "\t" $2]; next } { ++n } !(($2 "\t" $3) in known) { print $1 ": " $2 ($3 ? ", \"" $3 "\"" : "") }
    END { print n >counts }' counts="$folder/count" "$folder/titles" -
}

# The control: each kind of wrong citation is found, and the right ones beside them are not.
mkdir -p "$folder/control/man" "$folder/control/lib"
printf '.Nm goniochrome-one\n.Sh A TITLE\n.Ss Part\n.Sx Part .\n.Sx Nothing\n.Xr goniochrome-one 7 ,\n.Qq A TITEL .\n.Xr goniochrome-two 7\n.Xr goniochrome-one 7 ,\nPART .\nIn goniochrome-one(7), A TITLE.\n' \
  >"$folder/control/man/goniochrome-one.7"
printf '// Ends as goniochrome-one(7), "A\n// TITLE". And goniochrome-one(7),\n// "B". A string: "goniochrome-one(7), \\"Part\\""\n// goniochrome-three(7)\n// goniochrome-one(7),\n// Part. See goniochrome-one(7), which' \
  >"$folder/control/lib/a.h"
found=$(wrong "$folder/control" | sort)
expected='lib/a.h: goniochrome-one(7), "B"
lib/a.h: goniochrome-one(7), "Part without quotes"
lib/a.h: goniochrome-three(7)
man/goniochrome-one.7: goniochrome-one(7), "A TITEL"
man/goniochrome-one.7: goniochrome-one(7), "Nothing"
man/goniochrome-one.7: goniochrome-one(7), "PART without quotes"
man/goniochrome-one.7: goniochrome-one(7), "no .Xr"
man/goniochrome-one.7: goniochrome-two(7)'
[ "$found" = "$expected" ] || {
  printf 'the control is wrong:\n%s\n' "$found"
  exit 1
}

mkdir "$folder/tree"
for part in lib tools scripts man README.md CHANGELOG.md CONTRIBUTING.md; do
  [ ! -e "$top/$part" ] || ln -s "$top/$part" "$folder/tree/$part"
done
rm "$folder/tree/tools" && mkdir "$folder/tree/tools"
for part in "$top"/tools/*; do
  [ "$(basename "$part")" = citations_test.sh ] || ln -s "$part" "$folder/tree/tools/"
done
left=$(wrong "$folder/tree")
count=$(cat "$folder/count")
echo "$count citations"
[ -z "$left" ] || { echo "$left"; exit 1; }
[ "$count" -gt 300 ] || { echo 'too few citations were found'; exit 1; }
