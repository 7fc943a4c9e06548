#!/usr/bin/env bash
# Holds the option tables, --help, man pages, completions and README together, in both directions.
#
#   documents_test.sh BIN
set -euo pipefail
bin=$1
top=$(cd "$(dirname "$0")/.." && pwd)
made=$(mktemp -d)
trap 'rm -rf "$made"' EXIT

wrong=0
complain() {
  echo "$*"
  wrong=1
}

# The committed pages and completions are what the tables make now.
"$top/scripts/make-documents" "$bin" "$made"
for kind in man scripts/completions; do
  for file in "$made/$kind"/*; do
    diff -u "$top/$kind/$(basename "$file")" "$file" || complain "$kind/$(basename "$file") is stale: run scripts/make-documents"
  done
done

checked=0
for folder in "$top"/tools/*/; do
  tool=$(basename "$folder")
  help=$("$bin/$tool" --help)
  page=$(sed 's/\\-/-/g; s/\\f[BIR]//g' "$top/man/$tool.1")
  # Both ways: an option of the help is in the page, and one of the page is in the help.
  for option in $(grep -oE '^ {2,6}(-[a-zA-Z], )?--[a-z0-9-]+' <<<"$help" | grep -oE -- '--[a-z0-9-]+'); do
    grep -qE -- "^(-[a-zA-Z], )?$option( |$)" <<<"$page" || complain "$tool: $option is in --help and not in the man page"
    grep -q -- "$option" "$top/scripts/completions/$tool.bash" || complain "$tool: $option is not in the completion"
    checked=$((checked + 1))
  done
  for option in $(grep -oE '^(-[a-zA-Z], )?--[a-z0-9-]+' <<<"$page" | grep -oE -- '--[a-z0-9-]+'); do
    grep -q -- "$option" <<<"$help" || complain "$tool: $option is in the man page and not in --help"
  done
  grep -qE "^\| \`$tool\` \|" "$top/README.md" || complain "README.md: the tool table lacks $tool"
  grep -q "^\.It Xr $tool 1" "$top/man/goniochrome.7" || complain "goniochrome(7) does not list $tool"
done
while read -r tool; do
  [ -d "$top/tools/$tool" ] || complain "README.md: the tool table has $tool, which does not exist"
done < <(sed -nE 's/^\| `([a-z-]+)` \|.*/\1/p' "$top/README.md")
for page in "$top"/man/*.1; do
  # make-documents writes the pages of all tools and commands, so that one that it did not write is a page of neither.
  [ -s "$made/man/$(basename "$page")" ] || complain "$page: there is no such tool or command"
done
for page in "$top"/man/*.[57]; do
  name=$(basename "$page")
  case $name in goniochrome.7) continue ;; esac
  grep -q "^\.It Xr ${name%.*} ${name##*.}" "$top/man/goniochrome.7" || complain "goniochrome(7) does not list $name"
done
# Both ways: a source that pages or code cite is in goniochrome-references(7), and each source there is cited.
listed=$(sed -n 's/^\.It Bq //p' "$top/man/goniochrome-references.7" | sort)
[ -n "$listed" ] || complain "goniochrome-references(7) has no references"
body=$(cat "$top"/man/goniochrome-*.7 | grep -v '^\.It Bq ')
for key in $({ grep -oE '\b[A-Z][a-z][A-Za-z]*(19|20)[0-9]{2}\b' <<<"$body"
  grep -rhoE '\[[A-Z][a-z][A-Za-z]*(19|20)[0-9]{2}\]' "$top/lib" "$top/tools" | tr -d '[]'; } | sort -u); do
  grep -qx "$key" <<<"$listed" || complain "goniochrome-references(7): $key is cited and not among the references"
done
while IFS= read -r key; do
  grep -qF "$key" <<<"$body" || complain "goniochrome-references(7): the reference $key is cited nowhere"
done <<<"$listed"
# No page is longer than a reader reads at once: README, pages of subjects, pages of tools. A catalog may be longer.
words() {
  local most=$1 page count
  shift
  for page in "$@"; do
    count=$(wc -w <"$page")
    [ "$count" -le "$most" ] || complain "$(basename "$page") has $count words, and at most $most are wanted"
  done
}
words 1000 "$top/README.md"
words 3500 "$top/man/render-osmesa.1"
for page in "$top"/man/*.1; do [ "$page" = "$top/man/render-osmesa.1" ] || words 1800 "$page"; done
for page in "$top"/man/*.7; do [ "$page" = "$top/man/goniochrome-hard-cases.7" ] || words 4000 "$page"; done
# gallery_faults TREE: pictures that the gallery or a page names and the folder lacks, those that the gallery does not name, too many
# bytes, and options in commands of the gallery that their tool does not have.
gallery_faults() {
  (
    cd "$1"
    sed -nE 's/^!\[.*\]\(gallery\/(.*)\)$/\1/p' docs/gallery.md | sort >"$made/named"
    sed -nE 's/^\.\\" figure: (.*)/\1/p' man/*.[1-9] | sort -u | comm -23 - "$made/named" | sed 's/$/ is a figure that the gallery lacks/'
    ls docs/gallery | comm -13 - "$made/named" | sed 's/$/ is not there: run scripts\/pictures --gallery/'
    ls docs/gallery | comm -23 - "$made/named" | sed 's/$/ is in the folder and not in the gallery/'
    bytes=$(cat docs/gallery/* | wc -c)
    [ "$bytes" -le 1500000 ] || echo "$bytes bytes, and at most 1500000 are wanted"
    awk '/^```/ { inside = /^```sh$/; next } inside' docs/gallery.md | sed -e ':a' -e '/\\$/N; s/\\\n//; ta' | tr '|' '\n' | while read -r tool rest; do
      [ ! -d "$top/tools/$tool" ] || for option in $(grep -oE -- ' --[a-z0-9-]+' <<<" $rest"); do
        grep -qE -- "[\" ]$option[\" ]" "$top/scripts/completions/$tool.bash" || echo "$option is no option of $tool"
      done
    done
  )
}
faults=$(gallery_faults "$top")
[ -z "$faults" ] || complain "docs/gallery: $faults"
# The control: each of the five faults is found.
mkdir -p "$made/control/docs/gallery" "$made/control/man"
printf '![A](gallery/a.jpg)\n![B](gallery/b.jpg)\n```sh\necho | draw-plot --x 1 \\\n  --lost\n```\n' >"$made/control/docs/gallery.md"
printf '.\\" figure: a.jpg\n.\\" figure: c.jpg\n' >"$made/control/man/page.7"
head -c 1500000 /dev/zero >"$made/control/docs/gallery/a.jpg"
echo >"$made/control/docs/gallery/d.jpg"
[ "$(gallery_faults "$made/control" | cut -d' ' -f1 | paste -sd ' ')" = 'c.jpg b.jpg d.jpg 1500001 --lost' ] || complain 'the control of the gallery is wrong'
# The pages as HTML: every figure is a picture, every link leads to a page, and every page is in the index.
"$top/scripts/make-html" "$made/html"
figures=$(cat "$top"/man/*.[1-9] | grep -c '^\.\\" figure: ')
[ "$(cat "$made"/html/*.[1-9].html | grep -c '<figure><img src="gallery/')" -eq "$figures" ] || complain "HTML: not all of $figures figures are pictures"
for link in $(grep -ohE 'href="[^"#:]+' "$made"/html/*.html | sort -u | cut -d'"' -f2); do
  [ -s "$made/html/$link" ] || complain "HTML: the link $link leads nowhere"
done
for page in "$top"/man/*.[1-9]; do
  grep -q "href=\"$(basename "$page").html\"" "$made/html/index.html" || complain "HTML: the index lacks $(basename "$page")"
done
grep -q 'href="goniochrome-paint.5.html"' "$made/html/fit-paint.1.html" || complain 'HTML: pages of tools have no links'
mandoc -Tlint -W warning "$top"/man/*.[1-9] || complain "mandoc finds fault with the man pages"
[ "$checked" -gt 20 ] || complain "only $checked options were checked"
exit $wrong
