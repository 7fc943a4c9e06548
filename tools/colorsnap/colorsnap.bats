# colorsnap from the outside: the index and its life, options, streams, exit statuses.

bats_require_minimum_version 1.5.0

setup() {
  cd "$BATS_TEST_TMPDIR" || exit 1
  head='<?xml version="1.0"?><paints xmlns="urn:goniochrome:paint:1" version="1">'
  {
    echo "$head"
    paint R1 100,60,30 50,40,20 20,20,10 'code="c-R1" class="metallic"'
    paint R2 90,60,30 50,40,20 20,20,10 'code="c-R2" class="solid"'
    paint G1 80,-50,30 40,-30,20 20,-10,5 'code="c-G1" class="metallic"'
    paint B1 60,10,-60 30,10,-50 15,5,-40
    paint R1again 100,60,30 50,40,20 20,20,10
    echo "</paints>"
  } >lib.xml
  {
    echo "$head"
    paint wish 99,60,30 50,40,20 20,20,10
    echo "</paints>"
  } >wish.xml
}

# paint NAME L,a,b L,a,b L,a,b [ATTRIBUTES]: a paint with readings at 15, 45 and 110 deg.
paint() {
  local name=$1 rows='' angle=(15 45 110) i=0
  for row in "$2" "$3" "$4"; do
    IFS=, read -r l a b <<<"$row"
    rows+="<lab geometry=\"45as${angle[i]}\" L=\"$l\" a=\"$a\" b=\"$b\"/>"
    i=$((i + 1))
  done
  echo "<paint name=\"$name\" ${5:-}><measurement illuminant=\"D65\" observer=\"10\">$rows</measurement></paint>"
}

# column NAME: that column of the table on standard input, without its head, on one line.
column() {
  awk -F'\t' -v name="$1" 'NR == 1 { for (i = 1; i <= NF; ++i) if ($i == name) c = i; next } { print $c }' | paste -sd' '
}

@test "matches come nearest first, ties in the library's order, with the difference at each geometry" {
  run --separate-stderr colorsnap --library lib.xml -k 3 wish.xml
  [ "$status" -eq 0 ]
  [ "$stderr" = "colorsnap: 1 paints against 5" ]
  [ "$(column name <<<"$output")" = "R1 R1again R2" ]
  [ "$(column rank <<<"$output")" = "1 2 3" ]
  [ "$(column distance <<<"$output")" = "1 1 9" ]
  [ "$(column code <<<"$output")" = "c-R1  c-R2" ]
  [ "$(column status <<<"$output")" = "ok ok ok" ]
  [ "$(column de_by_geometry <<<"$output" | cut -d' ' -f1)" = "45as15=1,45as45=0,45as110=0" ]
}

@test "the index is written once and mapped after" {
  colorsnap -q -l lib.xml wish.xml --report a.json >a.tsv
  colorsnap -q -l lib.xml wish.xml --report b.json >b.tsv
  [ "$(jq -r .results.index a.json)" = built ]
  [ "$(jq -r .results.index b.json)" = mapped ]
  jq -e '.results.read_s == 0 and .results.index_s < 0.05' b.json
  cmp a.tsv b.tsv
  [ -f lib.xml.snapindex ]
}

@test "a changed library makes the index anew, and says so" {
  colorsnap -q -l lib.xml wish.xml >/dev/null
  sed -i 's/"R1"/"X1"/' lib.xml
  touch -d '+1 minute' lib.xml
  run --separate-stderr colorsnap -l lib.xml -k 1 wish.xml
  [ "$(column name <<<"$output")" = X1 ]
  [[ "$stderr" == *"lib.xml.snapindex: made anew, the library has changed"* ]]
}

@test "a damaged index is made anew" {
  colorsnap -q -l lib.xml wish.xml >a.tsv
  head -c 1000 lib.xml.snapindex >cut && mv cut lib.xml.snapindex
  run --separate-stderr colorsnap -l lib.xml wish.xml
  [ "$status" -eq 0 ]
  [ "$output" = "$(cat a.tsv)" ]
  [[ "$stderr" == *"damaged or of another version"* ]]
}

@test "where the index cannot be written it stays in memory, and that is told" {
  mkdir lib.xml.snapindex
  run --separate-stderr colorsnap -l lib.xml -k 1 wish.xml --report r.json
  [ "$status" -eq 0 ]
  [ "$(column name <<<"$output")" = R1 ]
  [[ "$stderr" == *"stays in memory"* ]]
  [ "$(jq -r .results.index r.json)" = in_memory ]
}

@test "a --library that is missing, unreadable, a stream or broken is refused" {
  run --separate-stderr colorsnap wish.xml
  [ "$status" -eq 2 ]
  [[ "$stderr" == *"--library"* ]]
  run --separate-stderr colorsnap wish.xml -l
  [ "$status" -eq 2 ]
  run --separate-stderr colorsnap -l none.xml wish.xml
  [ "$status" -eq 3 ]
  [[ "$stderr" == *"none.xml: cannot be read"* ]]
  run --separate-stderr colorsnap -l . wish.xml
  [ "$status" -eq 3 ]
  [[ "$stderr" == *"no plain file"* ]]
  run --separate-stderr colorsnap -l - <lib.xml
  [ "$status" -eq 2 ]
  [[ "$stderr" == *"--library - takes standard input"* ]]
  echo '<paints xmlns="urn:goniochrome:paint:1" version="1"/>' >empty.xml
  run --separate-stderr colorsnap -l empty.xml wish.xml
  [ "$status" -eq 3 ]
  [[ "$stderr" == *"empty.xml: holds no paint"* ]]
  sed 's/L="80"/L="12,5"/' lib.xml >bad.xml
  run --separate-stderr colorsnap -l bad.xml wish.xml
  [ "$status" -eq 3 ]
  [[ "$stderr" == *"bad.xml:4:"*"12,5"* ]]
  [ ! -e bad.xml.snapindex ]
}

@test "tree and scan give the same answer in both metrics" {
  cp "$TESTDATA/paints.paints.xml" all.xml
  for metric in de76 de00; do
    for method in auto tree scan; do
      colorsnap -q -l all.xml all.xml -m $metric --method $method >$method.tsv
    done
    cmp tree.tsv scan.tsv
    cmp tree.tsv auto.tsv
  done
  [ "$(colorsnap -q -l lib.xml -k 1 -m de00 wish.xml | column distance)" != 1 ]

  run colorsnap -l lib.xml wish.xml --metric de94
  [ "$status" -eq 2 ]
  [[ "$output" == *'--formula: there is no color difference formula "de94": use cie76, cie94'* ]]
  run colorsnap -l lib.xml wish.xml --method grid
  [ "$status" -eq 2 ]
}

@test "-k beyond the library gives all there are, and nonsense is refused" {
  [ "$(colorsnap -q -l lib.xml -k 100 wish.xml | column rank)" = "1 2 3 4 5" ]
  for k in 0 -1 x 1.5; do
    run colorsnap -l lib.xml wish.xml -k $k
    [ "$status" -eq 2 ]
  done
}

@test "--geometry and --weight change what is compared; wrong ones are refused" {
  [ "$(colorsnap -q -l lib.xml -k 1 -g 45as45,45as110 wish.xml | column de_by_geometry)" = "45as45=0,45as110=0" ]
  [ "$(colorsnap -q -l lib.xml -k 1 -w 45as15=3 wish.xml | column distance)" = 3 ]
  [ "$(colorsnap -q -l lib.xml -k 1 -w 45as15=0,45as110=2 wish.xml | column distance)" = 0 ]
  run --separate-stderr colorsnap -l lib.xml wish.xml -w 45as25=2
  [ "$status" -eq 0 ]
  [[ "$stderr" == *"weight of 45as25 has no effect"* ]]
  run --separate-stderr colorsnap -l lib.xml wish.xml -g 45as45 -w 45as45=0
  [ "$status" -eq 3 ]
  [[ "$stderr" == *"weight 0"* ]]
  run --separate-stderr colorsnap -l lib.xml wish.xml -g 45as25
  [ "$status" -eq 3 ]
  [[ "$stderr" == *'paint "wish": it has no color at 45as25'* ]]
  for wrong in 45as15 45as15= 45as15=x 45as15=-1 =2 45xx15=2; do
    run colorsnap -l lib.xml wish.xml --weight "$wrong"
    [ "$status" -eq 2 ]
  done
  run colorsnap -l lib.xml wish.xml --geometry 45az
  [ "$status" -eq 2 ]
  [[ "$output" == *"45az"* ]]
}

@test "--filter leaves library paints out by metric and by class" {
  [ "$(colorsnap -q -l lib.xml -k 9 --filter class=metallic wish.xml | column name)" = "R1 G1" ]
  [ "$(colorsnap -q -l lib.xml -k 9 --filter class=metallic,solid --filter L15=85: wish.xml | column name)" = "R1 R2" ]
  run --separate-stderr colorsnap -l lib.xml --filter flop_index=1000: wish.xml
  [ "$status" -eq 1 ]
  [ "$(column status <<<"$output")" = no_match ]
  [[ "$stderr" == *"the filters leave no paint"* ]]
  for wrong in flop_index=3 flop_indx=3:4 flop_index=4:3 class=wood flop_index=a:b; do
    run colorsnap -l lib.xml wish.xml --filter "$wrong"
    [ "$status" -eq 2 ]
  done
  run --separate-stderr colorsnap -l lib.xml wish.xml --filter travel_deg=20:30
  [ "$status" -eq 2 ]
  [[ "$stderr" == *"paint-stats --where"* ]]
}

@test "a design outside the library is told, with its side, and exits 1" {
  paint deep 40,95,45 30,80,40 20,60,30 | sed "s|^|$head|; s|\$|</paints>|" >deep.xml
  run --separate-stderr colorsnap -l lib.xml -k 1 deep.xml
  [ "$status" -eq 1 ]
  [ "$(column status <<<"$output")" = outside ]
  [[ "$stderr" =~ 'paint "deep" is outside the library: the nearest, "R2", is '.*', chroma +'[2-4][0-9]\. ]]
  run --separate-stderr colorsnap -l lib.xml -k 1 deep.xml --threshold 100
  [ "$status" -eq 0 ]
  run colorsnap -l lib.xml wish.xml --threshold 0
  [ "$status" -eq 1 ]
  run colorsnap -l lib.xml wish.xml --threshold x
  [ "$status" -eq 2 ]
}

@test "a hue that turns by half a circle is told, though its flop is on the face's hue line" {
  paint flip 60,40,0 40,1,-1 20,-40,1 | sed "s|^|$head|; s|\$|</paints>|" >flip.xml
  run --separate-stderr colorsnap -l lib.xml -k 1 flip.xml --threshold 100 --off-radial 50 --report r.json
  [ "$status" -eq 0 ]
  [ "$(column status <<<"$output")" = hue_travel ]
  [[ "$stderr" == *'paint "flip" turns its hue by '* ]]
  jq -e '.results.hue_travel == 1 and (.results.queries[0].hue_travel_deg | fabs > 150)' r.json
  # The distance from the hue line alone does not see it.
  jq -e '.results.queries[0].hue_shift | fabs < 5' r.json
  [ "$(colorsnap -q -l lib.xml -k 1 flip.xml --threshold 100 --off-radial 50 --hue-travel 200 | column status)" = ok ]
  [ "$(colorsnap -q -l lib.xml -k 1 flip.xml --off-radial 0 | column status)" = outside,off_radial,hue_travel ]
}

@test "a design of off-radial travel is told" {
  paint turning 99,60,30 50,40,20 20,10,22 | sed "s|^|$head|; s|\$|</paints>|" >turning.xml
  run --separate-stderr colorsnap -l lib.xml -k 1 turning.xml --report r.json
  [ "$status" -eq 0 ]
  [ "$(column status <<<"$output")" = off_radial,hue_travel ]
  [[ "$stderr" == *'paint "turning" travels off-radially'* ]]
  jq -e '.results.queries[0] | .hue_shift > 10 and .matched_hue_shift == 0' r.json
  [ "$(colorsnap -q -l lib.xml -k 1 turning.xml --hue-travel 50 | column status)" = off_radial ]
  [ "$(colorsnap -q -l lib.xml -k 1 turning.xml --off-radial 50 --hue-travel 50 | column status)" = ok ]
  run colorsnap -l lib.xml wish.xml --off-radial x
  [ "$status" -eq 2 ]
}

@test "no common geometry is an error that names both sides" {
  sed 's/45as15"/45as25"/; s/45as45"/45as75"/; s/45as110"/45as60"/' wish.xml >other.xml
  run --separate-stderr colorsnap -l lib.xml other.xml
  [ "$status" -eq 3 ]
  [[ "$stderr" == *'paint "wish": it has no geometry in common with the library: it was measured at 45as25,45as60,45as75, the library at 45as15,45as45,45as110'* ]]
}

@test "mixed observers are refused unless they are asked for" {
  sed 's/observer="10"/observer="2"/' wish.xml >two.xml
  run --separate-stderr colorsnap -l lib.xml two.xml
  [ "$status" -eq 3 ]
  [[ "$stderr" == *'D65/2'*'D65/10'*'--mix-observers'* ]]
  run --separate-stderr colorsnap -l lib.xml -k 1 two.xml --mix-observers
  [ "$status" -eq 0 ]
  [ "$(column name <<<"$output")" = R1 ]
  [[ "$stderr" == *"compared with others as they are"* ]]
}

@test "--keep-going leaves bad queries out, exit 1" {
  {
    echo "$head"
    paint good 99,60,30 50,40,20 20,20,10
    paint bad 1,2,3 4,5,6 7,8,9 | sed 's/L="4"/L="four"/'
    echo '<paint name="bare"/>'
    paint last 60,10,-60 30,10,-50 15,5,-40
    echo "</paints>"
  } >mixed.xml
  run --separate-stderr colorsnap -l lib.xml mixed.xml
  [ "$status" -eq 3 ]
  [[ "$stderr" == *'mixed.xml:3:'*four* ]]
  run --separate-stderr colorsnap -l lib.xml -k 1 mixed.xml --keep-going
  [ "$status" -eq 1 ]
  [ "$(column query <<<"$output")" = "good last" ]
  [ "$(column name <<<"$output")" = "R1 B1" ]
  [[ "$stderr" == *four*'left out'*'paint "bare": it has no color'*'left out'* ]]
}

@test "a designed paint is compared by its curve" {
  echo "$head<paint name=\"d\"><appearance travel=\"60\"><face L=\"100\" a=\"60\" b=\"30\"/><flop L=\"20\" a=\"20\" b=\"10\"/></appearance></paint></paints>" >d.xml
  [ "$(colorsnap -q -l lib.xml -k 1 d.xml | column name)" = R1 ]
}

@test "standard input goes to standard output" {
  [ "$(colorsnap -q -l lib.xml -k 1 <wish.xml | column name)" = R1 ]
  [ "$(colorsnap -q -l lib.xml -k 1 - wish.xml <wish.xml | column query)" = "wish wish" ]
}

@test "--assign passes the queries on with the code of their nearest paint" {
  {
    echo "$head"
    paint wish 99,60,30 50,40,20 20,20,10 'code="old"'
    paint blue 60,10,-59 30,10,-50 15,5,-40
    paint other 79,-50,30 40,-30,20 20,-10,5 'class="pearl"'
    echo "</paints>"
  } >three.xml
  run --separate-stderr colorsnap -l lib.xml --assign three.xml -o out.xml
  [ "$status" -eq 0 ]
  [ "$(grep -oE '<paint [^>]*' out.xml | tr '\n' ';')" = '<paint name="wish" code="c-R1";<paint name="blue" code="B1";<paint name="other" class="pearl" code="c-G1";' ]
  [[ "$stderr" == *'library paint "B1" has no code: its name stands for it'* ]]
  diff <(grep -o '<lab [^>]*' three.xml) <(grep -o '<lab [^>]*' out.xml)
  # Without a match a design keeps its code, and the verdict is negative.
  run --separate-stderr colorsnap -l lib.xml --assign --filter class=pearl wish.xml
  [ "$status" -eq 1 ]
  [ "$(grep -oE '<paint [^>]*' <<<"$output")" = '<paint name="wish"' ]
  for wrong in '-f tsv' '-f json' '-o out.tsv' '-o out.jsonl'; do
    run --separate-stderr colorsnap -l lib.xml --assign wish.xml $wrong
    [ "$status" -eq 2 ]
    [[ "$stderr" == *"--assign writes paint XML"* ]]
  done
}

@test "--format paints writes each matched paint once, every element kept" {
  sed -i 's|name="R2" code="c-R2" class="solid">|&<s:mark xmlns:s="urn:example:shelf" row="7"/>|' lib.xml
  colorsnap -q -l lib.xml -k 3 -f paints - wish.xml <wish.xml >out.xml
  xmllint --noout out.xml
  [ "$(sed -n 's/.*<paint name="\([^"]*\)".*/\1/p' out.xml | paste -sd' ')" = "R1 R1again R2" ]
  grep -q 'row="7"' out.xml
  grep -q '<processing tool="colorsnap"' out.xml
  colorsnap -q -l lib.xml -k 1 wish.xml -o a.paints.xml
  grep -q '<paint name="R1"' a.paints.xml
}

@test "--format json, and the report has the same" {
  colorsnap -q -l lib.xml -f json wish.xml --report r.json >a.jsonl
  jq -e '.matches[0].name == "R1" and .matches[0].de_by_geometry["45as15"] == 1' a.jsonl
  diff <(jq -S . a.jsonl) <(jq -S '.results.queries[0]' r.json)
  jq -e '.results | .library_size == 5 and .candidates == 5 and .searched == 1 and .query_us > 0' r.json
  run colorsnap -l lib.xml wish.xml -f xlsx
  [ "$status" -eq 2 ]
  run colorsnap -l lib.xml wish.xml -o
  [ "$status" -eq 2 ]
  run colorsnap -l lib.xml wish.xml -o /no/such/folder/x
  [ "$status" -eq 3 ]
}

@test "a closed pipe ends quietly" {
  {
    echo "$head"
    for i in $(seq 5000); do paint "p$i" 99,60,30 50,40,20 20,20,10; done
    echo "</paints>"
  } >many.xml
  run --separate-stderr bash -o pipefail -c 'colorsnap -q -l lib.xml many.xml | head -1'
  [ -z "$stderr" ]
}

@test "missing and cut queries are errors" {
  run colorsnap -l lib.xml none.xml
  [ "$status" -eq 3 ]
  head -c 300 wish.xml >cut.xml
  run colorsnap -l lib.xml cut.xml -o kept.tsv
  [ "$status" -eq 3 ]
  [ ! -e kept.tsv ]
}

@test "results do not depend on --threads" {
  for n in 1 2 7; do colorsnap -q -l lib.xml lib.xml --threads $n >$n.tsv; done
  cmp 1.tsv 2.tsv
  cmp 1.tsv 7.tsv
}

@test "--explain says which method and why; --quiet, --help and --version do what they say" {
  run --separate-stderr colorsnap -q -l lib.xml wish.xml --explain
  [[ "$stderr" == *"5 paints, D65/10 at 45as15,45as45,45as110: scan"*"measured"*"left out"* ]]
  [ -z "$(colorsnap --quiet -l lib.xml wish.xml 2>&1 >/dev/null)" ]
  colorsnap --help | grep -q -- --off-radial
  colorsnap --version | grep -q '^colorsnap '
  run colorsnap --libary x
  [ "$status" -eq 2 ]
  [[ "$output" == *"did you mean --library?"* ]]
}

@test "--illuminant looks for the paints that are near in every light" {
  # The nearer of two paints by daylight has other pigments.
  lit() { awk -v name="$1" "BEGIN {
    for (nm = 400; nm <= 700; nm += 10) factors = factors (nm > 400 ? \" \" : \"\") ($2)
    printf \"<paint name=\\\"%s\\\"><measurement illuminant=\\\"D65\\\" observer=\\\"10\\\"><lab geometry=\\\"45as45\\\" L=\\\"50\\\" a=\\\"0\\\" b=\\\"0\\\"/>\", name
    printf \"<spectrum geometry=\\\"45as45\\\" from=\\\"400\\\" step=\\\"10\\\" to=\\\"700\\\">%s</spectrum></measurement></paint>\\n\", factors
  }"; }
  gray=0.3 metamer='0.3 + 0.12 * sin((nm - 400) / 18)'
  { echo "$head"; lit metamer "$metamer"; lit lighter 0.36; echo "</paints>"; } >spectra.xml
  { echo "$head"; lit wish $gray; echo "</paints>"; } >gray.xml
  nearest() { colorsnap -q -k 2 -l spectra.xml --threshold 100 "$@" gray.xml; }
  nearest --illuminant D65 >daylight.tsv
  nearest --illuminant D65,A,F11 >all.tsv
  [ "$(head -1 all.tsv | cut -f13)" = illuminant ]
  [ "$(sed -n 2p daylight.tsv | cut -f13)" = D65 ]
  # The distance in all is the largest of the distances in each.
  for name in metamer lighter; do
    largest=$(for light in D65 A F11; do nearest --illuminant $light | awk -F'\t' -v n=$name '$3 == n { print $6 }'; done | sort -g | tail -1)
    [ "$(awk -F'\t' -v n=$name '$3 == n { print $6 }' all.tsv)" = "$largest" ]
  done
  run --separate-stderr colorsnap -l lib.xml --illuminant A gray.xml
  [ "$status" -eq 3 ]
  [[ "$stderr" == *"6 of 6 library paints have no spectra"* || "$stderr" == *"5 of 5 library paints have no spectra"* ]]
}

@test "--cloud draws the library at face, 45 deg and flop, with the travel of query and matches" {
  run --separate-stderr colorsnap -l lib.xml wish.xml --cloud cloud.svg -o near.tsv
  [ "$status" -eq 0 ]
  xmllint --noout cloud.svg
  for angle in 15 45 110; do
    grep -q ">from above: 5 of 5 paints at 45as$angle, 1 of 1 queries<" cloud.svg
    grep -q ">from the side: 5 of 5 paints at 45as$angle, 1 of 1 queries<" cloud.svg
  done
  [ "$(grep -o '<circle' cloud.svg | wc -l)" -eq 42 ] # five paints and two rings, six times
  # The travel of the design and of its five matches, each a line of three points, in both projections of each angle.
  grep -q '>design, face to flop<' cloud.svg
  grep -q '>matches, face to flop<' cloud.svg
  run --separate-stderr colorsnap -l lib.xml wish.xml --cloud cloud.png
  [ "$status" -eq 2 ]
  [[ "$stderr" == *'--cloud is "cloud.png": give a name that ends in .svg'* ]]
}

@test "every formula finds a paint itself, and both ways of searching agree" {
  for formula in cie76 cie94 cmc:1:1 ciede2000 din99o din6175; do
    colorsnap -q -l "$TESTDATA/paints.paints.xml" --formula $formula -k 4 --method tree "$TESTDATA/paints.paints.xml#*metallic" -o tree.tsv
    colorsnap -q -l "$TESTDATA/paints.paints.xml" --formula $formula -k 4 --method scan "$TESTDATA/paints.paints.xml#*metallic" -o scan.tsv
    cmp tree.tsv scan.tsv
    [ "$(awk -F '\t' '$2 == 1 && ($1 != $3 || $6 != 0)' tree.tsv | wc -l)" -eq 0 ]
  done
  run colorsnap -l "$TESTDATA/paints.paints.xml" --formula cie2 "$TESTDATA/paints.paints.xml"
  [ "$status" -eq 2 ]
}

@test "a library comes through a pipe, in any format, and gives the same answers" {
  colorsnap -q -l lib.xml wish.xml -o file.tsv
  colorsnap -q -l lib.xml wish.xml --format paints -o file.xml
  paint-convert -q lib.xml --to wide --columns all -o lib.csv
  for library in lib.xml lib.csv; do
    colorsnap -q -l - wish.xml <"$library" | diff file.tsv -
    colorsnap -q -l <(cat "$library") wish.xml | diff file.tsv -
    colorsnap -q -l - wish.xml --format paints <"$library" | diff <(grep '<lab' file.xml) <(grep '<lab' -)
    [ ! -e -.snapindex ]
  done
  colorsnap -q -l lib.csv wish.xml | diff file.tsv -
  [ -s lib.csv.snapindex ]
  colorsnap -q -l lib.xml <lib.csv | cut -f 1 | uniq | diff <(printf 'query\nR1\nR2\nG1\nB1\nR1again\n') -
}
