# paint-stats from the outside: options, conditions, streams, exit statuses.

bats_require_minimum_version 1.5.0

setup() {
  cd "$BATS_TEST_TMPDIR" || exit 1
  paints=$TESTDATA/paints.paints.xml
  count=$(grep -c '<paint ' "$paints")
  head='<?xml version="1.0"?><paints xmlns="urn:goniochrome:paint:1" version="1">'
  metallic=$(paint one 100,10,0 50,5,0 20,2,0)
}

# paint NAME L,a,b L,a,b L,a,b: a paint with readings at 15, 45 and 110 deg.
paint() {
  local name=$1 row rows='' angle=(15 45 110) i=0
  shift
  for row in "$@"; do
    IFS=, read -r l a b <<<"$row"
    rows+="<lab geometry=\"45as${angle[i]}\" L=\"$l\" a=\"$a\" b=\"$b\"/>"
    i=$((i + 1))
  done
  echo "<paint name=\"$name\"><measurement illuminant=\"D65\" observer=\"10\">$rows</measurement></paint>"
}

# column NAME: that column of the table on standard input, without its head.
column() {
  awk -F'\t' -v name="$1" 'NR == 1 { for (i = 1; i <= NF; ++i) if ($i == name) c = i; next } { print $c }'
}

@test "every paint has a line, in order, under a head" {
  run --separate-stderr paint-stats "$paints"
  [ "$status" -eq 0 ]
  [ "${#lines[@]}" -eq $((count + 1)) ]
  [[ "${lines[0]}" == "name	code	class	flop_index	"* ]]
  [ "$stderr" = "paint-stats: $count paints" ]
  diff <(paint-stats -q "$paints" | column name) <(sed -n 's/.*<paint name="\([^"]*\)".*/\1/p' "$paints")
}

@test "the flop index of a known paint is 12.05" {
  echo "$head$metallic</paints>" | paint-stats -q >t.tsv
  [[ "$(column flop_index <t.tsv)" == 12.05* ]]
  [ "$(column chroma_index <t.tsv)" = 8 ]
  [ "$(column hue_shift_index <t.tsv)" = 0 ]
  [ "$(column hue_travel_deg <t.tsv)" = 0 ]
  [ "$(column gloss <t.tsv)" = n/a ]
  [ "$(column source <t.tsv)" = rows ]
  [ "$(column flags <t.tsv)" = - ]
}

@test "dark, gray and turned paints are flagged, with n/a where nothing applies" {
  {
    echo "$head"
    paint black 3,1,2 0.05,0,0 0.2,0,0
    paint lighter_flop 20,10,0 50,5,0 100,2,0
    paint gray 50,0,0 40,0,0 30,5,0
    echo "</paints>"
  } | paint-stats -q >t.tsv
  [ "$(column flags <t.tsv | paste -sd' ')" = "dark - achromatic" ]
  [ "$(column flop_sensitivity <t.tsv | head -1)" = inf ]
  [[ "$(column flop_index <t.tsv | sed -n 2p)" == -12.05* ]]
  [ "$(column hue_shift_index <t.tsv | tail -1)" = n/a ]
  [ "$(column hue_travel_deg <t.tsv | tail -1)" = n/a ]
}

@test "a paint without any color is told, not invented" {
  echo "$head<paint name=\"none\"/></paints>" | paint-stats -q >t.tsv
  [ "$(column flop_index <t.tsv)" = n/a ]
  [ "$(column flags <t.tsv)" = no_color ]
}

@test "--where picks paints, and exits 1 where none matches" {
  run --separate-stderr paint-stats --where 'flop_index>=17 && chroma_index<5' "$paints"
  [ "$status" -eq 0 ]
  [[ "$stderr" =~ "$count paints, "[1-9][0-9]*" match" ]]
  paint-stats -q -w 'flop_index>=17 and chroma_index<5' "$paints" | column flop_index | awk '$1 < 17 { exit 1 }'
  run --separate-stderr paint-stats -w 'flop_index>1e6' "$paints"
  [ "$status" -eq 1 ]
  [ "${#lines[@]}" -eq 1 ]
}

@test "--where compares classes, names, flags and n/a" {
  [ "$(paint-stats -q -w 'class==solid' "$paints" | column class | sort -u)" = solid ]
  [ "$(paint-stats -q -w 'name=="arctic_white"' "$paints" | column name)" = arctic_white ]
  [ "$(paint-stats -q -w 'hue_shift_index==na' "$paints" | column hue_shift_index | sort -u)" = n/a ]
  a=$(paint-stats -q -w 'hue_shift_index<3' "$paints" | wc -l)
  b=$(paint-stats -q -w 'not hue_shift_index<3' "$paints" | wc -l)
  [ $((a + b)) -eq $((count + 2)) ]
}

@test "a --where that cannot be read is told with its place" {
  for case in 'flop_idx>3|did you mean flop_index?' 'flop_index>|ends where a name or a number is needed' \
    'flop_index=3|write "=="' '(gloss>3|")"' 'class==metalic|there is no class "metalic"'; do
    condition=${case%%|*}
    run --separate-stderr paint-stats --where "$condition" "$paints"
    [ "$status" -eq 2 ]
    [ -z "$output" ]
    [[ "$stderr" == *"${case#*|}"* ]]
  done
  run --separate-stderr paint-stats "$paints" --where
  [ "$status" -eq 2 ]
  [[ "$stderr" == *"--where needs a value"* ]]
}

@test "--format paints is a filter: every element stays and the step is in the history" {
  foreign='<shelf:mark xmlns:shelf="urn:example:shelf" row="7"/>'
  echo "$head${metallic/<\/paint>/$foreign</paint>}$(paint two 50,0,0 50,0,0 50,0,0)</paints>" |
    paint-stats -q -w 'flop_index>5' --format paints | paint-stats -q -w 'chroma_index>1' -f paints -o out.xml
  [ "$(grep -c '<paint ' out.xml)" -eq 1 ]
  [ "$(grep -c '<processing ' out.xml)" -eq 2 ]
  grep -q 'row="7"' out.xml
  xmllint --noout out.xml
}

@test "--format json writes one object a line" {
  paint-stats -q -f json "$paints" >t.json
  [ "$(wc -l <t.json)" -eq "$count" ]
  jq -es 'map(select(.name == "reference_gray"))[0] | .hue_shift_index == null and .flags == ["achromatic"]' t.json
}

@test "the output's ending chooses the format, --format overrules it" {
  paint-stats -q "$paints" -o a.paints.xml
  paint-stats -q "$paints" -o a.json
  paint-stats -q "$paints" --output=a.tsv
  paint-stats -q "$paints" -f tsv -o b.xml
  grep -q '<paints ' a.paints.xml
  jq -es length a.json
  diff a.tsv b.xml
  run paint-stats "$paints" --format csv
  [ "$status" -eq 2 ]
  [[ "$output" == *'--format is "csv": give auto, tsv, json, paints'* ]]
  run paint-stats "$paints" -f
  [ "$status" -eq 2 ]
  run paint-stats "$paints" -o
  [ "$status" -eq 2 ]
  run paint-stats "$paints" -o /no/such/folder/x.tsv
  [ "$status" -eq 3 ]
}

@test "--report holds the same figures" {
  paint-stats -q "$paints" --report r.json >t.tsv
  jq -e ".results.read == $count and .results.matched == $count and .results.left_out == 0" r.json
  jq -e '.results.paints_per_s > 0 and .tool == "paint-stats"' r.json
  paste <(jq -r '.results.paints[].flop_index // "n/a"' r.json) <(column flop_index <t.tsv) |
    awk '$1 != $2 && ($1 - $2 > .00501 || $2 - $1 > .00501) { exit 1 }' # the table has fewer digits
  run paint-stats "$paints" --report
  [ "$status" -eq 2 ]
}

@test "several inputs and - follow each other" {
  echo "$head$metallic</paints>" >a.xml
  [ "$(echo "$head${metallic/one/two}</paints>" | paint-stats -q - a.xml | column name | paste -sd' ')" = "two one" ]
}

@test "the first paint of a slow pipe comes through at once" {
  mkfifo in
  paint-stats -q in >t.tsv &
  exec 7>in
  echo "$head$metallic$(for i in 1 2 3; do echo "${metallic/one/p$i}"; done)" >&7
  for _ in $(seq 50); do
    grep -q '^one' t.tsv && break
    sleep 0.1
  done
  grep -q '^one' t.tsv
  echo "</paints>" >&7
  exec 7>&-
  wait
}

@test "a bad row is named and stops the run, or is left out with --keep-going" {
  {
    echo "$head"
    echo "$metallic"
    echo "${metallic/L=\"50\"/L=\"12,5\"}" | sed 's/one/bad/'
    echo "${metallic/one/three}"
    echo "</paints>"
  } >a.xml
  run --separate-stderr paint-stats a.xml
  [ "$status" -eq 3 ]
  [[ "$stderr" == *'a.xml:3'*'12,5'* ]]
  run --separate-stderr paint-stats --keep-going a.xml
  [ "$status" -eq 1 ]
  [[ "$stderr" == *'12,5'*'left out'*'2 paints, 1 left out'* ]]
  [ "$(column name <<<"$output" | paste -sd' ')" = "one three" ]
}

@test "a cut file is no success, with or without --keep-going" {
  echo "$head$metallic<paint name=\"x\">" >cut.xml
  run paint-stats cut.xml
  [ "$status" -eq 3 ]
  [[ "$output" == *cut.xml:* ]]
  run paint-stats -k cut.xml
  [ "$status" -eq 1 ]
  run paint-stats -o kept.xml cut.xml
  [ "$status" -eq 3 ]
  [ ! -e kept.xml ]
}

@test "missing input is an error" {
  run --separate-stderr paint-stats none.xml
  [ "$status" -eq 3 ]
  [ -z "$output" ]
  [[ "$stderr" == *"none.xml: cannot be read"* ]]
}

@test "a closed pipe ends quietly" {
  {
    echo "$head"
    for i in $(seq 20000); do echo "${metallic/one/p$i}"; done
    echo "</paints>"
  } >many.xml
  run --separate-stderr bash -o pipefail -c 'paint-stats -q many.xml | head -1'
  [ -z "$stderr" ]
}

@test "a full disk is an error" {
  [ -e /dev/full ] || skip
  run --separate-stderr paint-stats -q "$paints" -o /dev/full
  [ "$status" -eq 3 ]
}

@test "results do not depend on --threads" {
  for n in 1 2 7; do paint-stats -q "$paints" --threads $n >$n.tsv; done
  cmp 1.tsv 2.tsv
  cmp 1.tsv 7.tsv
  run paint-stats "$paints" --threads x
  [ "$status" -eq 2 ]
}

@test "--explain, --quiet, --help and --version do what they say, and an unknown option is refused" {
  run --separate-stderr paint-stats -q --explain -w 'gloss>1' "$paints"
  [[ "$stderr" == *"only paints with gloss>1"*"left out:"* ]]
  [ -z "$(paint-stats --quiet "$paints" 2>&1 >/dev/null)" ]
  paint-stats --help | grep -q -- --where
  paint-stats --version | grep -q '^paint-stats '
  run paint-stats --wher x
  [ "$status" -eq 2 ]
  [[ "$output" == *"--where"* ]]
}

@test "--score compares every model of a paint with measured directions; missing and wrong tables are refused" {
  {
    echo '<paints xmlns="urn:goniochrome:paint:1" version="1">'
    echo '<paint name="gray"><measurement illuminant="D65" observer="10"><lab geometry="45as15" L="60" a="0" b="0"/><lab geometry="45as45" L="50" a="0" b="0"/><lab geometry="45as110" L="40" a="0" b="0"/></measurement>'
    echo '<lobes space="lin_rec2020_scene" basis="b" method="l1" max_de00="0" mean_de00="0"><diffuse r="0.05862" g="0.05862" b="0.05862"/></lobes></paint>'
    echo '<paint name="other"><measurement illuminant="D65" observer="10"><lab geometry="45as45" L="50" a="0" b="0"/></measurement></paint></paints>'
  } >gray.xml
  printf 'sample,geometry,illuminant,observer,L,a,b\ngray,45as15,D65,10,63,4,0\ngray,45as45,D65,10,50,0,0\ngray,45as5,D65,10,99,0,0\n' >table.csv
  run --separate-stderr paint-stats --score table.csv gray.xml --report r.json
  [ "$status" -eq 0 ]
  [[ "$stderr" == *"1 of 2 paints compared with table.csv"* ]]
  # The curve misses 45as15 by (3,4,0), which is 5, and 45as45 by nothing; the lobes are L* 50 everywhere.
  [ "$(awk -F'\t' '$2 == "curve" { print $3, $4, $8 }' <<<"$output")" = "2 1 2.500" ]
  awk -F'\t' '$2 == "lobes" { exit !($8 > 6.7 && $8 < 6.85) }' <<<"$output"
  grep -q '"model": "lobes"' r.json
  run --separate-stderr paint-stats --score
  [ "$status" -eq 2 ]
  run --separate-stderr paint-stats --score nowhere.csv gray.xml
  [ "$status" -eq 3 ]
  [[ "$stderr" == *"nowhere.csv"* ]]
  printf 'sample,geometry,illuminant,observer,L,a,b\ngray,45as15,A,10,63,4,0\n' >a.csv
  run --separate-stderr paint-stats --score a.csv gray.xml
  [ "$status" -eq 3 ]
  [[ "$stderr" == *'"gray" was measured under A/10, and the paint is told under D65/10'* ]]
  printf 'sample,geometry,illuminant,observer,L,a,b\nnobody,45as15,D65,10,63,4,0\n' >nobody.csv
  run --separate-stderr paint-stats --score nobody.csv gray.xml
  [ "$status" -eq 3 ]
  [[ "$stderr" == *"no paint has both a model and directions there"* ]]
  # Reasons to doubt a measured BRDF were told by fits alone.
  awk 'BEGIN { print "3\n400 550 700"
    for (ti = 0; ti < 1.5; ti += 0.2) for (to = 0; to < 1.5; to += 0.1) for (az = 0; az <= 3.1; az += 0.3)
      print ti, 0, to, az, 0.9, 0.9, 0.9 }' >gray.brdf
  run --separate-stderr paint-stats --score gray.brdf gray.xml
  [ "$status" -eq 0 ]
  [[ "$stderr" == *": warning: gray.brdf: reflects "*" of the light at 45 deg: more than there is"* ]]
  run --separate-stderr paint-stats --score table.csv --where 'L15>1' gray.xml
  [ "$status" -eq 2 ]
  run --separate-stderr paint-stats --score table.csv -f paints gray.xml
  [ "$status" -eq 2 ]
}

# spectral NAME FACTOR: a paint whose reflectance factors from 400 to 700 nm are FACTOR at each, an expression in nm.
spectral() {
  awk -v name="$1" "BEGIN {
    for (nm = 400; nm <= 700; nm += 10) factors = factors (nm > 400 ? \" \" : \"\") ($2)
    printf \"<paint name=\\\"%s\\\"><measurement illuminant=\\\"D65\\\" observer=\\\"10\\\">\", name
    printf \"<lab geometry=\\\"45as45\\\" L=\\\"50\\\" a=\\\"0\\\" b=\\\"0\\\"/>\"
    printf \"<spectrum geometry=\\\"45as45\\\" from=\\\"400\\\" step=\\\"10\\\" to=\\\"700\\\">%s</spectrum></measurement></paint>\\n\", factors
  }"
}

@test "--illuminant tells the inconstancy and, with --standard, the metamerism of paints with spectra" {
  {
    echo "$head"
    spectral gray 0.3
    spectral green '0.1 + 0.5 * exp(-((nm - 530) / 40) ^ 2)'
    spectral bright_green '0.12 + 0.6 * exp(-((nm - 530) / 40) ^ 2)'
    spectral other_green '0.1 + 0.5 * exp(-((nm - 525) / 30) ^ 2) + 0.1 * exp(-((nm - 580) / 20) ^ 2)'
    echo "$metallic</paints>"
  } >lib.xml
  paint-stats -q --illuminant A,F11 --standard lib.xml#green lib.xml >t.tsv
  [ "$(column inconstancy_A <t.tsv | awk 'NR == 1 { print ($1 < 1e-9) }')" = 1 ]
  [ "$(column inconstancy_A <t.tsv | awk 'NR == 2 { print ($1 > 1) }')" = 1 ]
  # A brighter paint of the same color is no metamer, and one of other pigments is.
  [ "$(column metamerism_A <t.tsv | awk 'NR == 2 { print $1 }')" = 0 ]
  [ "$(column metamerism_A <t.tsv | awk 'NR == 3 { print ($1 < 1e-4) }')" = 1 ]
  [ "$(column metamerism_F11 <t.tsv | awk 'NR == 4 { print ($1 > 0.5) }')" = 1 ]
  [ "$(column metamerism_F11 <t.tsv | tail -1)" = n/a ]
  paint-stats -q -f json --illuminant A lib.xml#green | jq -e '.under.A.inconstancy["45as45"] > 1' >/dev/null
  run paint-stats --illuminant A9 lib.xml
  [ "$status" -eq 2 ]
  [[ "$output" == *"D65, D50, A"* ]]
  run paint-stats --standard lib.xml#green lib.xml
  [ "$status" -eq 2 ]
  run paint-stats --illuminant A --standard lib.xml lib.xml
  [ "$status" -eq 3 ]
  [[ "$output" == *"holds 5 paints: name one of them by FILE#NAME"* ]]
}

@test "a table has the decimals of the readings, and JSON every digit" {
  echo "$head$(paint x 41.87,1,2 20.5,1,2 6.51,1,2)</paints>" >x.xml
  [ "$(paint-stats -q x.xml | tail -1 | tr '\t' '\n' | grep -cE '\.[0-9]{3,}')" -eq 0 ]
  paint-stats -q -f json x.xml | grep -qE '"flop_index":[0-9]+\.[0-9]{6,}'
  echo "$head$(paint x 41.8712,1,2 20.5,1,2 6.51,1,2)</paints>" | paint-stats -q | column flop_index | grep -qE '\.[0-9]{4}$'
}

@test "an input without a paint is told, and the exit status is 1" {
  run --separate-stderr bash -c "echo '$head</paints>' | paint-stats"
  [ "$status" -eq 1 ]
  [[ "$stderr" == *"the input holds no paints"* ]]
}

@test "classes are inferred from readings and told as inferred" {
  paint-convert -q "$TESTDATA/paints.paints.xml" --to csv -o bare.csv
  paint-convert -q bare.csv -o bare.paints.xml
  run --separate-stderr paint-stats --classify bare.paints.xml -o t.tsv
  [ "$status" -eq 0 ]
  # No class is wrong: they are stated in the library.
  paste <(column class <t.tsv) <(paint-stats -q "$paints" | column class) >pairs
  [ "$(awk '$1 != "unknown" && $2 != "unknown" && $1 != $2' pairs | wc -l)" -eq 0 ]
  [ "$(grep -cv unknown pairs)" -gt 40 ]
  [ "$(column class_source <t.tsv | sort -u | xargs)" = "- inferred" ]
  paint-stats -q --classify "$paints" | column class_source | grep -qx stated
  paint-stats -q --classify -w 'class==metallic' -f paints bare.paints.xml | grep -q 'name="silver_fine" class="metallic"'
}

@test "other formulas tell the inconstancy too" {
  printf 'sample,geometry,illuminant,observer' >s.csv
  { printf ',%d' $(seq 400 10 700); printf '\nred,45as45,D65,10'; printf ',0.%02d' $(seq 10 2 70); echo; } >>s.csv
  paint-convert -q --scale factor s.csv -o s.paints.xml
  de00=$(paint-stats -q --illuminant A s.paints.xml | column inconstancy_A)
  cie76=$(paint-stats -q --illuminant A --formula cie76 s.paints.xml | column inconstancy_A)
  [ "$de00" != "$cie76" ]
  run paint-stats --formula cie2 s.paints.xml
  [ "$status" -eq 2 ]
}
