# paint-convert from the outside: options, formats, streams, exit statuses.

setup() {
  cd "$BATS_TEST_TMPDIR" || exit 1
  bats_require_minimum_version 1.5.0
  header=sample,geometry,illuminant,observer,L,a,b
  xml_head='<?xml version="1.0" encoding="UTF-8"?><paints xmlns="urn:goniochrome:paint:1" version="1">'
  printf '%s\n' "$header" a,45as15,A,2,41.87,-45.99,-21.73 a,45as45,A,2,18.1,-28,-18.6 b,45as15,D65,10,1,2,3 >ab.csv
  designed='<paint name="d"><gloss angle="60">90</gloss><appearance travel="63"><face L="60" a="5" b="-20"/><flop L="20" a="3" b="-9"/></appearance></paint>'
  echo "$xml_head$designed</paints>" >d.xml
}

# lab FILE: the Lab rows of a paint XML file, without its provenance.
lab() { grep -oE '<(paint name|lab) [^>]*' "$1"; }

@test "the sample table and the sample library turn into each other without a change" {
  paint-convert -q "$TESTDATA/paints.csv" -o p.xml
  diff <(lab p.xml) <(grep -v '<face' "$TESTDATA/paints.paints.xml" | lab /dev/stdin | sed 's/ class="[a-z]*"//; s/ code="[^"]*"//')
  # Paint XML may hold designs, so its table has the column origin.
  paint-convert -q p.xml -o p.csv
  sed 's/,row$//; s/,origin$//' p.csv | cmp - "$TESTDATA/paints.csv"
  paint-convert -q p.csv -o again.xml
  diff <(lab p.xml) <(lab again.xml)
  paint-convert -q "$TESTDATA/paints-wide.csv" -o w.xml
  diff <(lab p.xml | sort) <(lab w.xml | sort)
  paint-convert -q p.xml --to wide -o w.csv
  sed 's/,$//; s/,origin$//' w.csv | cmp - "$TESTDATA/paints-wide.csv"
}

@test "XML to table to XML keeps names, conditions, gloss, class and code with --columns all" {
  for to in csv wide; do
    paint-convert -q "$TESTDATA/paints.paints.xml" --to $to --columns all -o p.csv
    paint-convert -q p.csv -o p.xml
    diff <(grep -vE '<(!--|processing|\?xml|/?paints|appearance|face|flop|/appearance)' "$TESTDATA/paints.paints.xml" | sed 's/ class="unknown"//') \
      <(grep -vE '<(processing|\?xml|/?paints)' p.xml)
  done
}

@test "standard input is recognized by its first bytes and goes to standard output" {
  run --separate-stderr bash -c 'paint-convert <ab.csv'
  [ "$status" -eq 0 ]
  [[ "$output" == '<?xml'*'<paint name="a">'*'</paints>' ]]
  [[ "$stderr" == "paint-convert: 2 paints read, 2 written as paint XML" ]]
  run --separate-stderr bash -c 'paint-convert -q - -o - --to csv <ab.csv'
  [ "$output" = "$(cat ab.csv)" ]
  [ -z "$stderr" ]
  run --separate-stderr bash -c 'cat ab.csv | paint-convert -q | paint-convert -q --to csv | paint-convert -q --to wide'
  [ "${lines[1]}" = "a,A,2,,,,41.87,-45.99,-21.73,,,,18.1,-28,-18.6,,,,,," ]
}

@test "semicolons, decimal commas, byte order marks and starred headings" {
  printf '\xef\xbb\xbfsample;geometry;illuminant;observer;L*;a*;b*\r\na;45as15;A;2;41,87;-45,99;-21,73\r\na;45as45;A;2;18,1;-28;-18,6\r\nb;15;D65;10;1;2;3\r\n' >german.csv
  run --separate-stderr paint-convert -q german.csv --to csv
  [ "$output" = "$(cat ab.csv)" ]
}

@test "a designed paint is handed over at both sets of the industry, or where it is asked" {
  run --separate-stderr paint-convert d.xml --to csv
  [ "$(cut -d, -f1-4 <<<"$output" | tail -n +2 | tr '\n' ' ')" = "d,45as15,D65,10 d,45as25,D65,10 d,45as45,D65,10 d,45as75,D65,10 d,45as110,D65,10 " ]
  [ "$(sed -n 2p <<<"$output")" = "d,45as15,D65,10,60,5,-20,curve" ]
  [ "$(sed -n 6p <<<"$output")" = "d,45as110,D65,10,20,3,-9,curve" ]
  run --separate-stderr paint-convert -q d.xml --to wide
  [ "$(cut -d, -f1-9 <<<"${lines[1]}")" = "d,D65,10,,,,60,5,-20" ]
  run --separate-stderr paint-convert -q d.xml --to csv --geometry 15 --geometry 45as25az90,75
  [ "$(cut -d, -f2 <<<"$output" | tr '\n' ' ')" = "geometry 45as15 45as25az90 45as75 " ]
  # Paint XML stays as it was, unless rows are asked for.
  run --separate-stderr paint-convert -q d.xml
  [[ "$output" != *"<lab "* ]]
  run --separate-stderr paint-convert -q d.xml --geometry 15,45,110
  [ "$(grep -c '<lab ' <<<"$output")" -eq 3 ]
}

@test "a design with rows is handed over at both sets, and the column origin tells rows from the curve" {
  cat >design.xml <<END
$xml_head<paint name="d" code="S7"><measurement illuminant="D65" observer="10"><lab geometry="45as15" L="61" a="5" b="-20"/>
<lab geometry="45as45" L="27" a="3.5" b="-11"/><lab geometry="45as110" L="20" a="3" b="-9"/></measurement>
<appearance travel="63"><face L="60" a="5" b="-20"/><flop L="20" a="3" b="-9"/></appearance></paint></paints>
END
  run --separate-stderr paint-convert -q design.xml --to csv --columns all
  [ "${lines[0]}" = "$header,class,code,instrument,gloss20,gloss60,gloss85,serial,date,origin" ]
  [ "$(cut -d, -f2,9,16 <<<"$output" | tail -n +2 | tr '\n' ' ')" = "45as15,S7,row 45as25,S7,curve 45as45,S7,row 45as75,S7,curve 45as110,S7,row " ]
  # The curve at 25 deg: 20 + 40 (38/48)^2.
  awk -F, '$2 == "45as25" { exit !($5 - 45.06944444 < 1e-6 && 45.06944444 - $5 < 1e-6) }' <<<"$output"
  run --separate-stderr paint-convert -q design.xml --to wide
  [ "${lines[1]##*,}" = "45as25 45as75" ]
  # Rows that a table marks as the curve are no second measurement.
  paint-convert -q design.xml -o long.csv
  paint-convert -q design.xml --to wide -o wide.csv
  for table in long wide; do
    paint-convert -q $table.csv -o back.xml
    diff <(grep -o '<lab [^>]*' design.xml) <(grep -o '<lab [^>]*' back.xml)
  done
  paint-convert -q design.xml -o design.cxf
  grep -q '<cc:Tag Name="curve" Value="45as25 45as75"/>' design.cxf
  [ "$(paint-convert -q design.cxf | grep -c '<lab ')" -eq 5 ]
  run --separate-stderr paint-convert -q design.xml --to cgats
  [ "$(awk -F'\t' 'NF > 8 && $1 ~ /^[1-5]$/ { print $NF }' <<<"$output" | tr '\n' ' ')" = "row curve row curve row " ]
  # A paint that is only measured keeps the rows it has.
  run --separate-stderr paint-convert -q <(sed 's/<appearance.*appearance>//' design.xml) --to csv
  [ "$(grep -c row <<<"$output")" -eq 3 ]
  [ "$(grep -c curve <<<"$output")" -eq 0 ]
}

@test "an absolute design leaves as it was stated, at both sets, with its code" {
  paint-edit -q "$TESTDATA/paints.paints.xml#silver_fine" --face 45,55,30 --flop 20,25,12 --travel 70 --code S1 |
    paint-convert -q --to csv --columns all -o design.csv
  for angle in 15 25 45 75 110; do grep -q "45as$angle,.*,S1,.*,row$" design.csv; done
  grep -q "45as15,D65,10,45,55,30," design.csv
  grep -q "45as110,D65,10,20,25,12," design.csv
  paint-edit -q --new n --face 45,55,30 --flop 20,25,12 --travel 70 | paint-convert -q --to csv -o new.csv
  diff <(cut -d, -f2-7 design.csv | grep -v 45as-15) <(cut -d, -f2-7 new.csv)
}

@test "--geometry takes rows that are missing from the curve, and says so" {
  printf '%s\n' "$header" c,15,D65,10,60,1,2 c,45,D65,10,40,1,2 c,110,D65,10,20,1,2 >c.csv
  run --separate-stderr paint-convert c.csv --to csv --geometry 110,25,45
  [ "$status" -eq 0 ]
  [ "${lines[0]}" = "$header,origin" ]
  [ "$(tail -n +2 <<<"$output" | cut -d, -f2,8 | tr '\n' ' ')" = "45as110,row 45as25,curve 45as45,row " ]
  [[ "$stderr" == *"warning: 45as25 is not measured: it comes from the curve that is nearest to the rows (c)"* ]]
  # Paint XML has no mark for such a row, so there it is left out.
  run --separate-stderr paint-convert c.csv --geometry 110,25,45
  [ "$(grep -c '<lab ' <<<"$output")" -eq 2 ]
  [[ "$stderr" == *"warning: 45as25 is not measured (c)"* ]]
}

@test "an origin that is not understood is refused" {
  printf '%s\n' "$header,origin" c,15,D65,10,60,1,2,guess >c.csv
  run --separate-stderr paint-convert c.csv --to csv
  [ "$status" -eq 3 ]
  [[ "$stderr" == *'c.csv:2: origin is "guess": write row, or curve for what a curve says'* ]]
}

@test "--geometry selects rows, and two angles make no curve" {
  run --separate-stderr paint-convert ab.csv --to csv --geometry 45as15,25
  [ "$status" -eq 0 ]
  [ "$(tail -n +2 <<<"$output" | cut -d, -f1,2 | tr '\n' ' ')" = "a,45as15 b,45as15 " ]
  [[ "$stderr" == *"warning: 45as25 is not measured (a and 1 more)"* ]]
  run --separate-stderr paint-convert ab.csv --to csv --geometry 45
  [ "$status" -eq 3 ]
  [[ "$stderr" == *'ab.csv:4: paint "b" is not measured at 45as45: choose other geometries'* ]]
  run --separate-stderr paint-convert ab.csv --geometry 45xx
  [ "$status" -eq 2 ]
  [[ "$stderr" == *'--geometry: geometry "45xx" is not understood'* ]]
  run --separate-stderr paint-convert ab.csv --geometry 15,45as15
  [ "$status" -eq 2 ]
  [[ "$stderr" == *"--geometry names 45as15 twice"* ]]
}

@test "a wide table says what it has no columns for" {
  printf '%s\n' "$header" a,15,D65,10,1,2,3 a,45as25az90,D65,10,4,5,6 >odd.csv
  run --separate-stderr paint-convert odd.csv --to wide
  [ "$status" -eq 0 ]
  [[ "$stderr" == *"warning: rows beside the usual six geometries are left out: name the columns with --geometry (a)"* ]]
  run --separate-stderr paint-convert -q odd.csv --to wide --geometry 15,45as25az90
  [ "${lines[0]}" = "sample,illuminant,observer,L15,a15,b15,L45as25az90,a45as25az90,b45as25az90,origin" ]
  [ "${lines[1]}" = "a,D65,10,1,2,3,4,5,6," ]
}

@test "--fit-appearance writes face, flop, travel and the residual" {
  paint-convert -q d.xml --geometry 15,25,45,75,110 | paint-convert -q --to csv -o rows.csv
  run --separate-stderr paint-convert -q rows.csv --fit-appearance
  [ "$status" -eq 0 ]
  [[ "$output" =~ '<appearance travel="'(62.99999|63)[0-9.]*'" residual_de00="'[0-9.e-]+'">' ]]
}

@test "what a table cannot hold is named" {
  cat >full.xml <<END
$xml_head<paint name="p" class="pearl"><measurement illuminant="D65" observer="10"><lab geometry="15" L="1" a="2" b="3"/></measurement>
<lobes space="lin_rec2020_scene" basis="b" method="l1" max_de00="1" mean_de00="1"><diffuse r="0" g="0" b="0"/></lobes>
<x:n xmlns:x="urn:x"/></paint></paints>
END
  run --separate-stderr paint-convert full.xml -o full.csv --report r.json
  [ "$status" -eq 0 ]
  [[ "$stderr" == *"lobes are left out: only paint XML holds them (p)"* ]]
  [[ "$stderr" == *"elements of other vocabularies are left out"* ]]
  [[ "$stderr" == *"gloss, class, code, instrument, serial and date are left out: --columns all keeps them (p)"* ]]
  grep -q '"read": 1' r.json
  grep -q '"written": 1' r.json
  [ "$(grep -c 'left out' r.json)" -eq 3 ]
}

@test "foreign elements and the history stay in paint XML, and the command is added" {
  echo "$xml_head<processing tool=\"t\" version=\"1\" command=\"t x\"/><x:top xmlns:x=\"urn:x\"/><paint name=\"p\"><x:one xmlns:x=\"urn:x\">1 &lt; 2</x:one></paint></paints>" >f.xml
  run --separate-stderr paint-convert -q f.xml
  [[ "$output" == *'command="t x"/>'*'command="paint-convert -q f.xml"/>'*'<x:top xmlns:x="urn:x"/>'*'<x:one xmlns:x="urn:x">1 &lt; 2</x:one>'* ]]
}

@test "several inputs make one library; a name in two of them is refused" {
  printf '%s\n' "$header" c,45as15,D65,10,1,2,3 >c.csv
  run --separate-stderr paint-convert ab.csv d.xml c.csv
  [ "$status" -eq 0 ]
  [ "$(grep -oE '<paint name="."' <<<"$output" | cut -d'"' -f2 | tr -d '\n')" = abdc ]
  run --separate-stderr paint-convert -o both.xml ab.csv c.csv ab.csv
  [ "$status" -eq 3 ]
  [[ "$stderr" == 'paint-convert: ab.csv:2: paint "a" is also in ab.csv: rename one of them' ]]
  [ ! -e both.xml ]
  run --separate-stderr bash -c 'paint-convert -q d.xml - <c.csv'
  [ "$(grep -c '<paint ' <<<"$output")" -eq 2 ]
  run --separate-stderr bash -c 'paint-convert -q <(cat d.xml) <(cat c.csv)'
  [ "$(grep -c '<paint ' <<<"$output")" -eq 2 ]
}

@test "a wrong value exits 3 with one line that names it, and the old file stays" {
  sed -i 's/-28/minus/' ab.csv
  echo old >out.xml
  run --separate-stderr paint-convert ab.csv -o out.xml
  [ "$status" -eq 3 ]
  [ "$stderr" = 'paint-convert: ab.csv:3: a is "minus": write a number such as 12.5' ]
  [ "$(cat out.xml)" = old ]
}

@test "--keep-going keeps the good rows and paints, counts the others and exits with 1" {
  sed -i 's/-28/minus/' ab.csv
  for flag in --keep-going -k; do
    run --separate-stderr paint-convert $flag ab.csv -o out.csv --report r.json
    [ "$status" -eq 1 ]
    [[ "$stderr" == *'warning: ab.csv:3: a is "minus"'* ]]
    [ "$(wc -l <out.csv)" -eq 3 ]
    grep -q '"skipped": 1' r.json
  done
  echo "$xml_head<paint name=\"x\"><gloss angle=\"60\">no</gloss></paint>$designed</paints>" >x.xml
  run --separate-stderr paint-convert -k x.xml
  [ "$status" -eq 1 ]
  [[ "$output" == *'<paint name="d">'* && "$output" != *'<paint name="x"'* ]]
  # A file that is cut off gives what it has.
  head -c -40 d.xml | sed 's/<paint name="d"/<paint name="whole"\/>&/' >cut.xml
  run --separate-stderr paint-convert -k cut.xml
  [ "$status" -eq 1 ]
  [[ "$output" == *'<paint name="whole">'* && "$stderr" == *"it was cut off"* ]]
}

@test "a paint without color has no place in a table" {
  echo "$xml_head<paint name=\"x\"/></paints>" >x.xml
  run --separate-stderr paint-convert x.xml -o x.csv
  [ "$status" -eq 3 ]
  [[ "$stderr" == *'x.xml:1: paint "x" has neither readings nor face and flop: a long table cannot hold it' ]]
}

@test "inputs that hold no paints are refused" {
  run --separate-stderr paint-convert missing.csv -o out.xml
  [ "$status" -eq 3 ]
  [[ "$stderr" == "paint-convert: missing.csv: cannot be read: No such file or directory" ]]
  [ ! -e out.xml ]
  run --separate-stderr paint-convert .
  [ "$status" -eq 3 ]
  run --separate-stderr bash -c 'paint-convert </dev/null'
  [ "$status" -eq 3 ]
  [[ "$stderr" == *"standard input: is empty"* ]]
  echo hello >hello.txt
  run --separate-stderr paint-convert hello.txt
  [ "$status" -eq 3 ]
  [[ "$stderr" == *"hello.txt: is neither paint XML nor a table"* ]]
  run --separate-stderr paint-convert --from csv d.xml
  [ "$status" -eq 3 ]
  [[ "$stderr" == *"d.xml:1: the header has no column"* ]]
  run --separate-stderr paint-convert --from xml ab.csv
  [ "$status" -eq 3 ]
  [[ "$stderr" == *"ab.csv:1: this is not XML"* ]]
}

@test "--from and --to choose the formats; wrong and missing ones are refused" {
  run --separate-stderr paint-convert --from csv --to xml ab.csv
  [ "$status" -eq 0 ]
  run --separate-stderr paint-convert --to wide ab.csv -o out.dat
  [ "$status" -eq 0 ]
  head -1 out.dat | grep -q L15
  run --separate-stderr paint-convert ab.csv -o other.dat
  [ "$status" -eq 2 ]
  [[ "$stderr" == *"the format of other.dat cannot be told from its name: end it in .xml, .csv, .cxf or .cgats, or give --to"* ]]
  for option in --from --to --columns; do
    run --separate-stderr paint-convert $option pdf ab.csv
    [ "$status" -eq 2 ]
    [[ "$stderr" == *"$option is \"pdf\": give "* ]]
  done
  for option in --from --to --columns --geometry --output --report; do
    run --separate-stderr paint-convert ab.csv $option
    [ "$status" -eq 2 ]
    [[ "$stderr" == *"needs a value"* ]]
  done
  run --separate-stderr paint-convert --frm csv ab.csv
  [ "$status" -eq 2 ]
  [[ "$stderr" == *"did you mean --from?"* ]]
}

@test "the report goes to a file or to standard output, and never among the data" {
  run --separate-stderr paint-convert ab.csv -o out.xml --report -
  [ "$status" -eq 0 ]
  [[ "$output" == *'"tool": "paint-convert"'*'"read": 2'*'"warnings": []'* ]]
  run --separate-stderr paint-convert ab.csv --report -
  [ "$status" -eq 2 ]
  [[ "$stderr" == *"give -o FILE"* ]]
}

@test "--explain tells inputs, output and losses" {
  run --separate-stderr paint-convert --explain ab.csv d.xml -o out.csv
  [ "$status" -eq 0 ]
  [[ "$stderr" == *"ab.csv: long table"*"d.xml: paint XML"*"output: long table"*"left out: lobes"* ]]
  run --separate-stderr paint-convert --explain ab.csv --fit-appearance --geometry 15 -o out.xml
  [[ "$stderr" == *"rows: only 45as15"*"fitted to the rows"* ]]
}

@test "an output that cannot be written is an error, and the old file stays" {
  run --separate-stderr paint-convert ab.csv -o no/such/folder/out.xml
  [ "$status" -eq 3 ]
  run --separate-stderr bash -c 'paint-convert ab.csv >/dev/full'
  [ "$status" -eq 3 ]
  [[ "$stderr" == *"standard output"* ]]
}

@test "a closed pipe ends quietly" {
  for i in $(seq 1 5000); do echo "p$i,45as15,D65,10,1,2,3"; done | cat <(echo "$header") - >many.csv
  run --separate-stderr bash -c 'paint-convert many.csv | head -1'
  [ "$status" -eq 0 ]
  [ -z "$stderr" ]
}

@test "each paint goes through at once" {
  mkfifo in out
  paint-convert -q --from csv in --to csv >out &
  exec 7<>out
  exec 8<>in
  printf '%s\n' "$header" a,45as15,D65,10,1,2,3 b,45as15,D65,10,1,2,3 >&8
  read -r -t 10 line <&7
  [ "$line" = "$header" ]
  read -r -t 10 line <&7
  [ "$line" = a,45as15,D65,10,1,2,3 ]
  exec 8>&-
  read -r -t 10 line <&7
  [ "$line" = b,45as15,D65,10,1,2,3 ]
  wait
}

@test "a comma locale changes nothing" {
  run --separate-stderr env LC_ALL=de_DE.UTF-8 paint-convert -q ab.csv --to csv
  [ "$output" = "$(cat ab.csv)" ]
}

@test "an input without a paint is told, and the exit status is 1" {
  echo "$header" >none.csv
  run --separate-stderr paint-convert none.csv --to csv
  [ "$status" -eq 1 ]
  [ "$output" = "$header" ]
  [[ "$stderr" == *"no paint was read: nothing was converted"* ]]
}

# flat VALUE GEOMETRY [UNIT]: a table of a spectrum with one value at all wavelengths.
flat() {
  awk -v value="$1" -v geometry="$2" -v unit="${3:-}" 'BEGIN {
    head = "sample,geometry,illuminant,observer"; row = "x," geometry ",D65,10"
    for (nm = 400; nm <= 700; nm += 10) { head = head "," nm "nm" unit; row = row "," value }
    print head; print row
  }'
}
lightness() { sed -n 2p | cut -d, -f5 | xargs printf '%.3f'; }

@test "--scale says what reflectances are, the table goes before it, and without both what may be either is refused" {
  flat 2 45as45 >dark.csv
  run --separate-stderr paint-convert dark.csv --to csv
  [ "$(lightness <<<"$output")" = 15.487 ]
  [[ "$stderr" == *"reflectances were read as percent"* ]]
  [ "$(paint-convert -q --scale percent dark.csv --to csv | lightness)" = 15.487 ]
  run --separate-stderr paint-convert --scale factor dark.csv --to csv
  [ "$status" -eq 3 ]
  [[ "$stderr" == *"dark.csv: --scale says that reflectances are factors"*'"x" has 2 at 45as45'* ]]
  flat 2.2 45as15 >bright.csv
  run --separate-stderr paint-convert bright.csv --to csv
  [ "$status" -eq 3 ]
  [[ "$stderr" == *'"x" has 2.2 at 45as15, which may be either: give paint-convert --scale percent'* ]]
  run --separate-stderr paint-convert -k bright.csv --to csv
  [ "$status" -eq 1 ]
  [ "${#lines[@]}" -eq 1 ]
  [ "$(paint-convert -q --scale factor bright.csv --to csv | lightness)" = 134.869 ]
  [ "$(cat bright.csv | paint-convert -q --scale percent --to csv | lightness)" = 16.504 ]
  flat 2.2 45as15 ' [%]' >stated.csv
  run --separate-stderr paint-convert --scale factor stated.csv --to csv
  [ "$(lightness <<<"$output")" = 16.504 ]
  [[ "$stderr" == *"--scale has no effect on reflectances whose scale the file states"* ]]
  run --separate-stderr paint-convert --scale half dark.csv
  [ "$status" -eq 2 ]
  [[ "$stderr" == *'--scale is "half": give auto, percent, factor'* ]]
  run --separate-stderr paint-convert dark.csv --scale
  [ "$status" -eq 2 ]
}

@test "tables and CxF in UTF-16 are read, and what is no CxF3 is named" {
  iconv -f utf-8 -t utf-16le ab.csv >body
  { printf '\xff\xfe' && cat body; } >wide.csv
  run --separate-stderr paint-convert -q wide.csv --to csv
  [ "$output" = "$(cat ab.csv)" ]
  paint-convert -q ab.csv -o ab.cxf
  sed 's/encoding="UTF-8"/encoding="UTF-16"/' ab.cxf | iconv -f utf-8 -t utf-16 >wide.cxf
  [ "$(paint-convert -q wide.cxf --to csv)" = "$(cat ab.csv)" ]
  echo '<CXF xmlns="http://old.example/cxf2"/>' >old.cxf
  run --separate-stderr paint-convert old.cxf
  [ "$status" -eq 3 ]
  [[ "$stderr" == *'old.cxf:1: is CxF of another version ("http://old.example/cxf2"): export CxF3'* ]]
}

# Three readings of a name, of which one more stands apart, and a paint of its own.
repeated() {
  echo sample,geometry,illuminant,observer,L,a,b
  local name L
  for name in 'red 50' 'red (2) 50.2' 'red (3) 49.9' 'red (4) 50.1' 'red (5) 57' 'blue 30'; do
    L=${name##* }
    echo "${name% *},45as45,D65,10,$L,10,0"
  done
}

@test "repeated readings become their mean, and what stands apart is named" {
  repeated >in.csv
  run paint-convert --average name in.csv -o out.paints.xml --report report.json
  [ "$status" -eq 0 ]
  [[ $output == *'paint "red (5)" stands apart from the 5 readings of "red"'*kept* ]]
  [ "$(jq -r '.results.averages[0] | "\(.name) \(.readings) \(.kept) \(.geometries["45as45"].readings)"' report.json)" = "red 5 5 5" ]
  [ "$(jq '.results.averages[0].geometries["45as45"].L > 3' report.json)" = true ]
  [ "$(grep -c '<paint ' out.paints.xml)" -eq 2 ]
  run paint-convert -q --average name --outliers drop in.csv --to csv
  [[ $output == *'red,45as45,D65,10,50.05,10,0'* ]]
  run paint-convert -q --average code in.csv -o out.paints.xml
  [ "$status" -eq 3 ]
  [[ $output == *'paint "red" has no code: give --average name'* ]]
}

@test "readings of one day become their mean, which keeps dates and serials in every format" {
  { echo 'sample,date,serial,geometry,illuminant,observer,L,a,b'
    printf 'tile,26.11.2021 %s,S7,45as45,D65,10,%s,0,0\n' 08:00 50 09:00 52
    printf 'tile,2021-11-27T08:00:00Z,S7,45as45,D65,10,51,0,0\n'; } >in.csv
  paint-convert -q --average date in.csv -o days.paints.xml --report report.json
  [ "$(grep -o 'name="[^"]*"' days.paints.xml | xargs)" = "name=tile (2021-11-26) name=tile (2021-11-27)" ]
  [ "$(jq -r '.results.averages[].name' report.json | xargs)" = "tile (2021-11-26) tile (2021-11-27)" ]
  grep -q 'serial="S7" date="2021-11-26T08:00..2021-11-26T09:00">' days.paints.xml
  [ "$(jq -r '.results.averages[1] | "\(.date) \(.serial)"' report.json)" = "2021-11-27T08:00:00Z S7" ]
  grep '<measurement' days.paints.xml >was
  for format in csv wide cxf cgats; do
    paint-convert -q days.paints.xml --to $format --columns all -o back.$format
    paint-convert -q back.$format -o back.paints.xml
    diff was <(grep '<measurement' back.paints.xml)
  done
  # By name, all are one.
  paint-convert -q --average name in.csv | grep -q 'date="2021-11-26T08:00..2021-11-27T08:00:00Z"'
  sed -i 's/2021-11-27T08:00:00Z/11\/27\/2021/' in.csv
  run paint-convert -q --average date in.csv -o days.paints.xml
  [ "$status" -eq 3 ]
  [[ $output == *'paint "tile (3)" has the date "11/27/2021", whose day is not known'* ]]
}

@test "means of codes have the name of their readings, and the code where two codes have one name" {
  { echo 'sample,code,date,geometry,illuminant,observer,L,a,b'
    printf 'red,%s,45as45,D65,10,%s,0,0\n' X1,2021-11-26 50 X1,2021-11-27 52 X2,2021-11-27 60 X2,2021-11-28 62; } >in.csv
  paint-convert -q --average code in.csv -o codes.paints.xml
  [ "$(grep -o '<paint [^>]*' codes.paints.xml | cut -d '"' -f 2,4 | xargs -d '\n')" = 'red"X1 red (X2)"X2' ]
  paint-convert -q --average name in.csv | grep -q '<paint name="red" code="X1, X2">'
}

@test "paints of one name in several files are told apart by date and code, and refused without" {
  printf 'sample,date,geometry,illuminant,observer,L,a,b\ntile,2021-11-26,45as45,D65,10,50,0,0\n' >a.csv
  sed 's/11-26/11-27/' a.csv >b.csv
  paint-convert -q a.csv b.csv -o both.paints.xml
  [ "$(grep -o 'name="[^"]*"' both.paints.xml | xargs)" = "name=tile name=tile (2)" ]
  run paint-convert -q a.csv a.csv -o both.paints.xml
  [ "$status" -eq 3 ]
  [[ $output == *'paint "tile" is also in a.csv'* ]]
}
