# paint-convert and the formats of others: CxF3, CGATS, measured BRDFs. Real data only where GONIOCHROME_DATA is set.

setup() {
  cd "$BATS_TEST_TMPDIR" || exit 1
  bats_require_minimum_version 1.5.0
  export SOURCE_DATE_EPOCH=1700000000
  header=sample,geometry,illuminant,observer,L,a,b,class,code,instrument,gloss20,gloss60,gloss85
  cat >paints.csv <<END
$header
"blue ""night"" & <7>",45as15,A,2,41.870000000000005,-45.99,-21.733333333333334,metallic,B-7,MA-T12,,92.1,
"blue ""night"" & <7>",45as-15,A,2,130.5,1e-17,-0.1,metallic,B-7,MA-T12,,92.1,
"blue ""night"" & <7>",45as25az-76,A,2,0,0,0.1,metallic,B-7,MA-T12,,92.1,
plain,45as15,D65,10,1,2,3,unknown,,,,,
plain,r45as-15,D65,10,4,5,6,unknown,,,,,
END
  head='CGATS.17\nWEIGHTING_FUNCTION "ILLUMINANT, D65"\nWEIGHTING_FUNCTION "OBSERVER, 10 degree"\n'
}

real_data() { [ -n "${GONIOCHROME_DATA:-}" ] || skip "GONIOCHROME_DATA is not set"; }

# brdf N: a spectral measurement of a gray sample with reflectance factor 0.5, at N incidences.
brdf() {
  awk -v n="$1" 'BEGIN {
    print "# gray\n2\n380 780"
    for (i = 1; i <= n; ++i) for (o = 0; o <= 7; ++o) for (p = 0; p <= 4; ++p)
      printf "%.6f 0 %.6f %.6f 0.1591549431 0.1591549431\n", i * 1.4 / n, o * 0.2, p * 0.785398
  }'
}

@test "a measured BRDF without the ends of the visible is told" {
  grid() {
    printf '%s\n' "$#" "$*"
    for light in 0 0.4 0.8 1.2; do for view in 0 0.4 0.8 1.2; do for turn in 0 1.57 3.14; do
      echo "$light 0 $view $turn$(printf ' 0.1%.0s' "$@")"
    done; done; done
  }
  grid $(seq 430 50 680) >part.brdf
  run --separate-stderr paint-convert part.brdf --to csv
  [ "$status" -eq 0 ]
  [[ "$stderr" == *"part.brdf: its spectra leave out 15 % of what the observer sees"* ]]
  grid $(seq 380 20 780) >whole.brdf
  run --separate-stderr paint-convert whole.brdf --to csv
  [[ "$stderr" != *"leave out"* ]]
}

@test "XML, table, CxF and CGATS in a circle keep every Lab, name, gloss and observer" {
  paint-convert -q paints.csv -o 1.xml
  paint-convert -q 1.xml --to csv --columns all -o 2.csv
  sed 's/,[^,]*,[^,]*,[^,]*$//' 2.csv | cmp paints.csv -  # without serial, date and origin
  [ "$(sed -n 's/.*,//p' 2.csv | sort | uniq -c | tr -s ' ' | tr '\n' ';')" = " 1 origin; 5 row;" ]
  paint-convert -q 2.csv -o 3.cxf
  paint-convert -q 3.cxf -o 4.cgats
  paint-convert -q 4.cgats -o 5.xml
  diff <(grep -v '<processing' 1.xml) <(grep -v '<processing' 5.xml)
  paint-convert -q 5.xml --cxf-compat -o 6.cxf
  [ "$(grep -c '<cc:Object ' 6.cxf)" -eq 5 ]
  paint-convert -q 6.cxf --to csv --columns all | sed 's/,[^,]*,[^,]*$//' | cmp - paints.csv
}

@test "the sample library passes through CxF and CGATS unchanged" {
  paint-convert -q "$TESTDATA/paints.csv" --to cxf | paint-convert -q --to cgats | paint-convert -q --to csv | cmp - "$TESTDATA/paints.csv"
}

@test "CxF is the same each time with SOURCE_DATE_EPOCH" {
  paint-convert -q paints.csv --to cxf >a.cxf
  paint-convert -q paints.csv --to cxf >b.cxf
  cmp a.cxf b.cxf
  grep -q '<cc:CreationDate>2023-11-14T22:13:20Z</cc:CreationDate>' a.cxf
}

@test "CGATS of another program is read: names with spaces, decimal commas, what it leaves open" {
  printf 'ECI2002\nBEGIN_DATA_FORMAT\nSampleID\tSAMPLE_NAME\tLAB_L\tLAB_A\tLAB_B\nEND_DATA_FORMAT\nBEGIN_DATA\n1\tPaper white\t95,5\t-0.2\t1.5\nEND_DATA\n' >other.txt
  run --separate-stderr paint-convert other.txt --to csv
  [ "$status" -eq 0 ]
  [ "${lines[1]}" = "Paper white,45as45,D50,2,95.5,-0.2,1.5" ]
  [[ "$stderr" == *"decimal commas were read as points (line 6)"* ]]
  [[ "$stderr" == *"taken as D50/2"* && "$stderr" == *"taken as 45/0"* ]]
  run --separate-stderr paint-convert -q other.txt --to csv --illuminant D65 --observer 10
  [ "${lines[1]}" = "Paper white,45as45,D65,10,95.5,-0.2,1.5" ]
}

@test "bad CGATS is told by line and cell, and --keep-going keeps the good rows" {
  printf "${head}BEGIN_DATA_FORMAT\nSAMPLE_NAME GEOMETRY LAB_L LAB_A LAB_B\nEND_DATA_FORMAT\nBEGIN_DATA\np 15 1 2 x\nq 15 4 5 6\nEND_DATA\n" >bad.cgats
  run --separate-stderr paint-convert bad.cgats -o out.xml
  [ "$status" -eq 3 ]
  [ "$stderr" = 'paint-convert: bad.cgats:8: LAB_B is "x": write a number' ]
  [ ! -e out.xml ]
  run --separate-stderr paint-convert -k bad.cgats --to csv
  [ "$status" -eq 1 ]
  [ "${lines[1]}" = "q,45as15,D65,10,4,5,6" ]
  [[ "$stderr" == *'bad.cgats:8: LAB_B is "x"'*"1 left out"* ]]
}

@test "hostile CxF is refused" {
  paint-convert -q paints.csv --to cxf >good.cxf
  sed '1a <!DOCTYPE x [<!ENTITY a "aaaa"><!ENTITY b "&a;&a;&a;&a;">]>' good.cxf >bomb.cxf
  run --separate-stderr paint-convert bomb.cxf
  [ "$status" -eq 3 ]
  [[ "$stderr" == *"bomb.cxf:2: <!DOCTYPE is not accepted"* ]]
  head -c 1500 good.cxf >cut.cxf
  run --separate-stderr paint-convert cut.cxf -o out.xml
  [ "$status" -eq 3 ]
  [[ "$stderr" == *"cut off"* ]]
  [ ! -e out.xml ]
  sed 's/<cc:L>1</<cc:L>1,5</' good.cxf >comma.cxf
  run --separate-stderr paint-convert comma.cxf
  [ "$status" -eq 3 ]
  [[ "$stderr" == *'L is "1,5": write a number with a decimal point'* ]]
}

@test "what CxF and CGATS cannot hold is named" {
  printf '%s\n' sample,geometry,illuminant,observer,L,a,b dark,45as110,D65,10,-0.5,0,0 >dark.csv
  run --separate-stderr paint-convert dark.csv --to cxf -o dark.cxf
  [ "$status" -eq 3 ]
  [[ "$stderr" == *'paint "dark" at 45as110: L* is -0.5: CxF3 allows none below 0'* ]]
  [ ! -e dark.cxf ]
  run --separate-stderr paint-convert paints.csv --cxf-compat --to csv
  [ "$status" -eq 2 ]
  [[ "$stderr" == *"--cxf-compat is for CxF, and the output is long table: give --to cxf"* ]]
  run --separate-stderr paint-convert paints.csv --to cgats --illuminant A
  [ "$status" -eq 0 ]
  [[ "$stderr" == *"paints without spectra stay as they are: nothing tells their color under A/10 (plain)"* ]]
}

@test "a measured BRDF becomes a paint under the illuminant and observer asked for" {
  brdf 7 >gray.brdf
  run --separate-stderr paint-convert gray.brdf --to csv --report r.json
  [ "$status" -eq 0 ]
  [ "${#lines[@]}" -eq 6 ]
  [[ "${lines[1]}" =~ ^gray,45as15,D65,10,76\.0692 ]]
  grep -q '"format": "cornell"' r.json
  grep -q '"gap_deg": [1-9]' r.json
  run --separate-stderr paint-convert -q gray.brdf --to csv --geometry 20,45as25az90 --illuminant A --observer 2 --aperture 2
  [[ "${lines[1]}" =~ ^gray,45as20,A,2,76\.0692 ]]
  [[ "${lines[2]}" =~ ^gray,45as25az90,A,2,76\.0692 ]]
  # From standard input the format must be named.
  run --separate-stderr bash -c 'paint-convert -q --from measured --to csv <gray.brdf'
  [[ "${lines[1]}" =~ ^measured,45as15 ]]
}

@test "files that are no measured BRDFs are refused, and so are impossible requests" {
  brdf 7 | sed 's/^0.6[0-9]* 0/0.6/' >short.brdf
  run --separate-stderr paint-convert short.brdf
  [ "$status" -eq 3 ]
  [[ "$stderr" =~ short.brdf:[0-9]+:\ 5\ numbers\ where\ 4\ angles\ and\ 2\ wavelengths\ make\ 6 ]]
  brdf 7 >gray.brdf
  run --separate-stderr paint-convert gray.brdf --illuminant F4
  [ "$status" -eq 3 ]
  [[ "$stderr" == *'gray.brdf: illuminant is "F4": spectra are integrated under D65, D50, A, C, D55, '* ]]
  for option in --illuminant --observer --aperture; do
    run --separate-stderr paint-convert gray.brdf $option
    [ "$status" -eq 2 ]
  done
  run --separate-stderr paint-convert gray.brdf --observer 4
  [ "$status" -eq 2 ]
  run --separate-stderr paint-convert gray.brdf --aperture 30
  [ "$status" -eq 2 ]
}

@test "a measured BRDF without a value at any geometry is refused" {
  # A MERL table whose bins are negative, which marks what was not measured, but for one.
  { printf '\x5a\0\0\0\x5a\0\0\0\xb4\0\0\0' && head -c 34991992 /dev/zero | LC_ALL=C tr '\0' '\277' &&
    head -c 8 /dev/zero; } >none.binary
  run --separate-stderr paint-convert none.binary -o none.xml
  [ "$status" -eq 3 ]
  [[ "$stderr" == *"none.binary: has no value at any geometry that is asked for: give others by --geometry"* ]]
  [ ! -e none.xml ]
  rm none.binary
}

@test "the cayman metallic reads as the published table says" {
  real_data
  run --separate-stderr paint-convert "$GONIOCHROME_DATA/brdf/cornell/cayman.brdf" --to csv --observer 2 \
    --geometry 45as15,45as25,45as45,45as75,45as110
  [ "$status" -eq 0 ]
  [[ "$stderr" == *"interpolated between samples far apart: 45as75 across 43 deg"* ]]
  paste -d, <(tail -n +2 <<<"$output" | cut -d, -f1-7) <(grep cayman "$GONIOCHROME_DATA/lab/measured-multiangle.csv") |
    awk -F, '{ d = sqrt(($5-$12)^2 + ($6-$13)^2 + ($7-$14)^2); n += d <= 1.5 } END { exit n != 5 }'
}

@test "the NVIDIA files tell their negatives, reciprocity and noise" {
  real_data
  for paint in carpaint_blue carpaint_red; do
    run --separate-stderr paint-convert "$GONIOCHROME_DATA/brdf/nvidia/$paint.mbsdf" --to csv --report $paint.json
    [ "$status" -eq 0 ]
    [[ "$stderr" == *"% of the samples are negative"*"light and viewer swapped"*"darker than the noise"* ]]
    grep -q '"noise_floor": 0.0[1-9]' $paint.json
  done
  run --separate-stderr paint-convert "$GONIOCHROME_DATA/brdf/nvidia/carpaint_red.mbsdf" --observer 10 -o out.xml
  [ "$status" -eq 3 ]
  [[ "$stderr" == *"D65/10 would need spectra"* ]]
}

@test "our CxF is valid, and the published samples are read" {
  real_data
  for option in "" --cxf-compat; do
    paint-convert -q paints.csv $option -o ours.cxf
    if command -v xmllint >/dev/null; then xmllint --noout --schema "$GONIOCHROME_DATA/cxf/CxF3_Core.xsd" ours.cxf; fi
  done
  for sample in "$GONIOCHROME_DATA"/cxf/*.cxf; do
    run --separate-stderr paint-convert "$sample" --to csv
    case $sample in */sample.cxf | */geometry_edge_cases.cxf) paints=0 ;; *) paints=1 ;; esac # the others hold none at an angle
    [ "$status" -eq $paints ]
  done
  run --separate-stderr paint-convert -q "$GONIOCHROME_DATA/cxf/geometry_edge_cases.cxf" --to csv
  [ "$(tail -n +2 <<<"$output" | cut -d, -f2 | tr '\n' ' ')" = "45as15 45as25 45as45 45as15az30 45as25az60 " ]
}

@test "spectra are kept in paint XML, and give the colors in other light" {
  brdf 7 >gray.brdf
  paint-convert -q gray.brdf -o gray.xml
  [ "$(grep -c '<spectrum geometry="45as[0-9]*" from="380" to="780" step="400">0.5[0-9]* 0.5[0-9]*</spectrum>\|<spectrum geometry="45as[0-9]*" from="380" to="780" step="400">0.4999[0-9]* 0.4999[0-9]*</spectrum>' gray.xml)" -eq 5 ]
  # A slope from blue to red, which is redder and lighter under A; what was made for the light before goes.
  {
    echo '<paints xmlns="urn:goniochrome:paint:1" version="1"><paint name="slope">'
    echo '<measurement illuminant="D65" observer="10"><lab geometry="45as15" L="60" a="1" b="2"/><lab geometry="45as45" L="50" a="0" b="0"/>'
    echo '<spectrum geometry="45as15" from="400" to="700" step="100">0.1 0.2 0.4 0.8</spectrum></measurement>'
    echo '<lobes space="lin_rec2020_scene" basis="b" method="l1" max_de00="0" mean_de00="0"><diffuse r="0.1" g="0.1" b="0.1"/></lobes></paint>'
    echo '<paint name="plain"><measurement illuminant="D65" observer="10"><lab geometry="45as15" L="60" a="1" b="2"/></measurement></paint></paints>'
  } >slope.xml
  run --separate-stderr paint-convert slope.xml --illuminant A -o a.xml
  [ "$status" -eq 0 ]
  [[ "$stderr" == *"readings without a spectrum are left out"*"(slope)"* ]]
  [[ "$stderr" == *"lobes and color maps are left out: they are those of the light before (slope)"* ]]
  [[ "$stderr" == *"paints without spectra stay as they are: nothing tells their color under A/10 (plain)"* ]]
  [ "$(grep -c '<lobes' a.xml)" -eq 0 ]
  [ "$(grep -c '<spectrum' a.xml)" -eq 1 ]
  grep -q 'illuminant="A" observer="10"' a.xml
  paint-convert -q slope.xml --illuminant D50 | grep -q 'illuminant="D50"'
  light() { sed -nE 's/.*45as15" L="([0-9.]*)".*/\1/p' "$1" | head -1; }
  paint-convert -q slope.xml --illuminant C -o c.xml
  awk -v a="$(light a.xml)" -v c="$(light c.xml)" 'BEGIN { exit !(a > c + 1) }'
  # There and back again, nothing is lost.
  paint-convert -q a.xml --illuminant C -o again.xml
  [ "$(grep '<lab' again.xml)" = "$(grep '<lab' c.xml)" ]
  # A color that is changed has no spectrum any more, and other formats say that they hold none.
  paint-edit -q --lightness-shift 2 slope.xml | grep -c '<spectrum' | grep -qx 0
  run --separate-stderr paint-convert slope.xml --to csv
  [[ "$stderr" == *"spectra are left out: --columns all keeps them (slope)"* ]]
  run --separate-stderr paint-convert slope.xml --to wide --geometry 15
  [[ "$stderr" == *"spectra are left out: paint XML, CxF and long tables with --columns all hold them (slope)"* ]]
  run --separate-stderr paint-convert slope.xml --illuminant F4
  [ "$status" -eq 3 ]
  [[ "$stderr" == *'paint "slope": illuminant is "F4"'* ]]
}

# A workbook of one sheet: its name, and rows whose cells are parted by |.
workbook() {
  python3 - "$@" <<'EOF'
import sys, zipfile
file, name, *rows = sys.argv[1:]
cell = lambda text: f"<c><v>{text}</v></c>" if text.replace(".", "").replace("-", "").isdigit() else f'<c t="inlineStr"><is><t>{text}</t></is></c>'
data = "".join("<row>" + "".join(map(cell, row.split("|"))) + "</row>" for row in rows)
with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as archive:
    archive.writestr("xl/workbook.xml", f'<workbook xmlns:r="r"><sheets><sheet name="{name}" r:id="a"/></sheets></workbook>')
    archive.writestr("xl/_rels/workbook.xml.rels", '<Relationships><Relationship Id="a" Target="s.xml"/></Relationships>')
    archive.writestr("xl/s.xml", f"<worksheet><sheetData>{data}</sheetData></worksheet>")
EOF
}

@test "a workbook becomes paints, under any name, from a pipe, and by name" {
  workbook a.xlsx Farbe 'Lichtart|D65/10' 'Muster|Winkel|L*|a*|b*' 'rot|45as15|41.5|-1.25|3' 'blau|45as15|20|1|-30'
  paint-convert -q a.xlsx --to csv -o a.csv
  [ "$(cat a.csv)" = "$(printf '%s\n' sample,geometry,illuminant,observer,L,a,b rot,45as15,D65,10,41.5,-1.25,3 blau,45as15,D65,10,20,1,-30)" ]
  [ "$(paint-convert -q --to csv <a.xlsx)" = "$(cat a.csv)" ]
  cp a.xlsx some.data
  [ "$(paint-convert -q --to csv 'some.data#blau' | tail -1)" = blau,45as15,D65,10,20,1,-30 ]
}

@test "a workbook that cannot be read is refused by sheet and row" {
  workbook a.xlsx Farbe 'Name|Geometry|L*|a*|b*' 'rot|45as15|41.5|x|3'
  run --separate-stderr paint-convert a.xlsx -o out.xml
  [ "$status" -eq 3 ]
  [ "$stderr" = 'paint-convert: a.xlsx: sheet "Farbe", row 2: a* is "x": write a number' ]
  [ ! -e out.xml ]
  head -c 300 a.xlsx >half.xlsx
  run --separate-stderr paint-convert half.xlsx -o out.xml
  [ "$status" -eq 3 ]
  [[ "$stderr" == *'half.xlsx: the workbook is damaged or cut off'* ]]
}

@test "workbooks of an instrument are read (real data)" {
  [ -n "${GONIOCHROME_DATA:-}" ] || skip "GONIOCHROME_DATA is not set"
  run --separate-stderr paint-convert "$GONIOCHROME_DATA"/instrument/*.xlsx -o both.xml
  [ "$status" -eq 0 ]
  [ "$stderr" = 'paint-convert: 2 paints read, 2 written as paint XML' ]
  [ "$(grep -c '<lab ' both.xml)" -eq 24 ]
  [ "$(grep -c '<spectrum .*from="400" to="700" step="10"' both.xml)" -eq 24 ]
  paint-convert -q both.xml -o both.cxf
  xmllint --noout --schema "$GONIOCHROME_DATA/cxf/CxF3_Core.xsd" both.cxf
  paint-convert -q both.xml --to csv --columns all -o both.csv
  for back in both.cxf both.csv; do
    paint-convert -q "$back" -o back.xml
    # Readings and spectra come back to the last digit; a table keeps no textures.
    [ "$(grep -E '<(lab|spectrum) ' back.xml)" = "$(grep -E '<(lab|spectrum) ' both.xml)" ]
    # Lab from the spectra, which a look under another light and back makes, is that of the sheet.
    paint-convert -q back.xml --illuminant A -o a.xml
    paint-convert -q a.xml --illuminant D65 -o from_spectra.xml
    join -t, <(paint-convert -q back.xml --to csv | awk -F, 'NR > 1 { print $1 "@" $2 "," $5 "," $6 "," $7 }' | sort) \
      <(paint-convert -q from_spectra.xml --to csv | awk -F, 'NR > 1 { print $1 "@" $2 "," $5 "," $6 "," $7 }' | sort) >pairs
    [ "$(wc -l <pairs)" -eq 24 ]
    # CIEDE2000 is at most 1.5 times the plain distance: it stretches a* by that much near gray.
    awk -F, '{ d = sqrt(($2-$5)^2 + ($3-$6)^2 + ($4-$7)^2); if (d > worst) worst = d } END { print worst; exit !(1.5 * worst <= 0.05) }' pairs
  done
}

@test "the files of instruments are told apart by their content, and their spectra are those of the text" {
  corpus=$BATS_TEST_DIRNAME/../../lib/fuzz/corpus
  for file in qtx/two.qtx mif/two.mif xtf/three.xtf mtf/two.mtf jcamp/plain.jdx; do
    format=${file%%/*}
    cp "$corpus/$file" noending
    paint-convert -q --viewing 45as45 noending --explain -o "$format.xml" --to xml --report r.json 2>explained.txt
    grep -qi "$format" explained.txt || { cat explained.txt; false; }
    # 5 % at 400 nm and .5 % more at each further 10 nm.
    grep -q 'from="400" to="700" step="10">0.05 0.055 0.06 ' "$format.xml"
    paint-convert -q --from "$format" --viewing 45as45 - -o again.xml <noending
    diff <(grep -v processing again.xml | grep -v '<step') <(grep -v processing "$format.xml" | grep -v '<step')
  done
  [ "$(grep -c '<spectrum geometry="45as\(15\|45\|110\)"' mif.xml)" -eq 3 ]
}

@test "readings of a sphere are named, and --viewing says what they stand for" {
  corpus=$BATS_TEST_DIRNAME/../../lib/fuzz/corpus
  run --separate-stderr paint-convert "$corpus/qtx/two.qtx" -o out.xml
  [ "$status" -eq 0 ] # the standard has a geometry
  [[ $stderr == *'the viewing "%R SAV SCE UV Inc" has no aspecular angle, and its readings are left out: give paint-convert --viewing'* ]]
  paint-convert -q --viewing SCE=45as15 "$corpus/qtx/two.qtx" --to csv >out.csv
  [ "$(cut -d, -f2 out.csv | tail -n +2 | paste -sd' ')" = "45as45 45as15" ]
  for wrong in SCE=front =45as45 front; do
    run paint-convert --viewing "$wrong" "$corpus/qtx/two.qtx"
    [ "$status" -eq 2 ]
    [[ $output == *"--viewing $wrong"* ]]
  done
}

@test "illuminants are known by any of their names, with their observer too" {
  paint-convert -q "$TESTDATA/../lib/fuzz/corpus/measured/cornell.brdf" --geometry 15,45,75 -o spectra.xml
  for name in D65/10:D65/10 d65:D65/10 a/2:A/2 tl84:F11/10 CWF/2:F2/2 led-b3:LED-B3/10 ID65/2:ID65/2 TL83:F12/10; do
    paint-convert -q --illuminant "${name%%:*}" spectra.xml --to csv >out.csv
    [ "$(sed -n 2p out.csv | cut -d, -f3,4 | tr , /)" = "${name##*:}" ] || { echo "$name"; head -2 out.csv; false; }
  done
  run paint-convert --illuminant D65/10 --observer 2 spectra.xml
  [ "$status" -eq 2 ]
  printf 'sample,geometry,illuminant,L,a,b\nx,15,d65/2,1,2,3\n' >in.csv
  paint-convert -q in.csv --to csv | grep -q 'x,45as15,D65,2,1,2,3'
}
