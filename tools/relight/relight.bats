# relight from the outside: options, streams, exit statuses.

bats_require_minimum_version 1.5.0

setup() {
  cd "$BATS_TEST_TMPDIR" || exit 1
  sky=$TESTDATA/outdoor.exr
  estimate=$BATS_TEST_DIRNAME/../../scripts/estimate-operator
}

# value KEY: that number of the report.
value() { sed -nE "s/.*\"$1\": ([^,]+),?$/\1/p" r.json | head -1; }

# Six wavelengths of three overlapping sensors.
sensors() { printf 'nm,r,g,b\n400,0,0,2\n450,0,.5,2\n500,.2,1,.5\n550,.8,2,0\n600,2,.8,0\n650,1,0,0\n'; }

@test "an image goes from one illuminant to another, and the figures are told" {
  run --separate-stderr relight --from 0.4,0.9,1 --to 1,0.9,0.1 "$sky" -o out.exr --report r.json
  [ "$status" -eq 0 ]
  [ -z "$output" ]
  [[ "$stderr" == *"condition number 2.5,"* ]]
  [ "$(value pixels)" != "" ]
  value condition | awk '{ exit !($1 > 2.49 && $1 < 2.51) }'
  value negative_fraction | awk '{ exit !($1 >= 0 && $1 <= 1) }'
  [ -s out.exr ]
}

@test "the same light leaves the image alone, whatever the operator" {
  for op in fitted iso iso709 estimated working plain none iso,0.2; do
    relight -q --from D50 --to D50 --operator "$op" "$sky" -o "$op.exr" --report r.json
    [ "$(value negative_fraction)" = 0.0 ]
  done
}

@test "standard input goes to standard output" {
  relight -q --from D65 --to A <"$sky" >a.exr
  relight -q --from D65 --to A - -o - <"$sky" >b.exr
  [ -s a.exr ]
  [ -s b.exr ]
}

@test "a light that cannot be divided by is refused with its condition number" {
  run --separate-stderr relight --from 1,0,0 --to D65 --operator plain "$sky" -o out.exr
  [ "$status" -eq 2 ]
  [[ "$stderr" == *"condition number is inf"* ]]
  [ ! -e out.exr ]
  run --separate-stderr relight --from 0,0,0 --to D65 "$sky" -o out.exr
  [ "$status" -eq 2 ]
  relight -q --from 1,0,0 --to D65 "$sky" -o out.exr
}

@test "--from and --to take values and names; missing and wrong ones are refused" {
  run --separate-stderr relight --to D65 "$sky" -o out.exr
  [ "$status" -eq 2 ]
  [[ "$stderr" == *"--from is missing"* ]]
  run --separate-stderr relight --from D65 "$sky" -o out.exr
  [ "$status" -eq 2 ]
  [[ "$stderr" == *"--to is missing"* ]]
  for wrong in D99 1,2 1,2,x -1,1,1 "" 1,,1; do
    run --separate-stderr relight --from "$wrong" --to D65 "$sky" -o out.exr
    [ "$status" -eq 2 ]
  done
  relight -q --from D50 --to 1,1,0.5 "$sky" -o out.exr
}

@test "--operator takes names and files; missing and wrong ones are refused" {
  run --separate-stderr relight --from D65 --to A "$sky" -o out.exr --operator
  [ "$status" -eq 2 ]
  run --separate-stderr relight --from D65 --to A --operator nowhere.json "$sky" -o out.exr
  [ "$status" -eq 3 ]
  [[ "$stderr" == *"nowhere.json"* ]]
  echo '{"k": 3}' >bad.json
  run --separate-stderr relight --from D65 --to A --operator bad.json "$sky" -o out.exr
  [ "$status" -eq 3 ]
  sensors | relight -q --estimate - -o good.json
  relight -q --from D65 --to A --operator good.json "$sky" -o out.exr
  run --separate-stderr relight --from D65 --to A --operator xyz "$sky" -o out.exr
  [ "$status" -eq 2 ]
  [[ "$stderr" == *"write fitted, plain, iso, iso709, estimated or a JSON file"* ]]
  # fitted is what is taken without the option.
  relight -q --from D65 --to A "$sky" -o out.exr --report a.json
  relight -q --from D65 --to A --operator fitted "$sky" -o out.exr --report b.json
  [ "$(tr -d ' \n' <a.json | grep -o '"matrix":.*')" = "$(tr -d ' \n' <b.json | grep -o '"matrix":.*')" ]
}

@test "--primaries are stored by --estimate and honored by --operator; missing and wrong ones are refused" {
  sensors | relight -q --estimate - -o plain-space.json
  sensors | relight -q --estimate - --primaries rec709 -o rec709.json
  grep -q '"primaries":\[\[0.64,0.33\],\[0.3,0.6\],\[0.15,0.06\]\],"white":\[0.3127,0.329\]' rec709.json
  relight -q --from D65 --to A --operator plain-space.json "$sky" -o out.exr --report a.json
  relight -q --from D65 --to A --operator rec709.json "$sky" -o out.exr --report b.json
  [ "$(tr -d ' \n' <a.json | grep -o '"operator":.*')" != "$(tr -d ' \n' <b.json | grep -o '"operator":.*')" ]
  sensors | relight -q --estimate - --primaries 0.64,0.33,0.3,0.6,0.15,0.06,0.3127,0.329 -o numbers.json
  cmp rec709.json numbers.json
  run --separate-stderr relight --estimate - --primaries
  [ "$status" -eq 2 ]
  for wrong in adobe 1,2,3 0.1,0.1,0.2,0.2,0.3,0.3; do
    run --separate-stderr relight --estimate - --primaries "$wrong" </dev/null
    [ "$status" -eq 2 ]
    [[ "$stderr" == *"--primaries is \"$wrong\""* ]]
  done
  run --separate-stderr relight --from D65 --to A --primaries rec709 "$sky" -o out.exr
  [ "$status" -eq 2 ]
}

@test "--transfer takes three shares; missing and wrong ones are refused" {
  run --separate-stderr relight --from D65 --to A "$sky" -o out.exr --transfer
  [ "$status" -eq 2 ]
  for wrong in 0,1 2,0,0 a; do
    run --separate-stderr relight --from D65 --to A --transfer "$wrong" "$sky" -o out.exr
    [ "$status" -eq 2 ]
  done
  run --separate-stderr relight --from D65 --to A --operator plain --transfer 0,.5,0 "$sky" -o out.exr
  [ "$status" -eq 3 ]
  [[ "$stderr" == *"green of this operator keeps 1.000 of itself"* ]]
  relight -q --from D65 --to A --operator estimated --transfer .1,0,0 "$sky" -o out.exr
  relight -q --from D65 --to A --operator iso --transfer 0,0,0 "$sky" -o none.exr --report r.json
  tr -d ' \n' <r.json | grep -q '"matrix":\[\[[0-9.]*,0.0,0.0\],\[0.0,[0-9.]*,0.0\]'
  relight -q --from D65 --to A --operator iso --transfer 0,0,1 "$sky" -o blue.exr --report r.json
  tr -d ' \n' <r.json | grep -q '"matrix":\[\[[0-9.]*,0.0,0.0\],\[0.0,[0-9.]*,0.0\],\[-*[1-9.]'  && return 1
  tr -d ' \n' <r.json | grep -vq '"matrix":\[\[[0-9.]*,0.0,0.0\],\[0.0,[0-9.]*,0.0\],\[0.0,0.0,'
}

@test "--negative keeps or zeroes what is counted; missing and wrong words are refused" {
  run --separate-stderr relight --from D65 --to A "$sky" -o out.exr --negative
  [ "$status" -eq 2 ]
  run --separate-stderr relight --from D65 --to A --negative drop "$sky" -o out.exr
  [ "$status" -eq 2 ]
  for what in keep zero; do
    run --separate-stderr relight --from 1,0.3,0.1 --to 0.1,0.3,1 --negative "$what" "$sky" -o $what.exr --report r.json
    [ "$status" -eq 0 ]
  done
  [[ "$stderr" == *"negative channel"* ]]
}

@test "--estimate makes an operator; missing and wrong tables are refused" {
  run --separate-stderr relight --estimate
  [ "$status" -eq 2 ]
  run --separate-stderr relight --estimate nowhere.csv
  [ "$status" -eq 3 ]
  printf '400,1,2\n' >short.csv
  run --separate-stderr relight --estimate short.csv
  [ "$status" -eq 3 ]
  [[ "$stderr" == *"short.csv:1"* ]]
  printf '400,1,0,0\n410,0,1,0\n430,0,0,1\n' >uneven.csv
  run --separate-stderr relight --estimate uneven.csv
  [ "$status" -eq 3 ]
  [[ "$stderr" == *"uneven.csv:3"* ]]
  run --separate-stderr relight --estimate short.csv --from D65
  [ "$status" -eq 2 ]
  sensors >sensors.csv
  run --separate-stderr relight --estimate sensors.csv
  [ "$status" -eq 0 ]
  [[ "$output" == '{"k":[['* ]]
}

@test "--estimate takes columns by their names, whatever separates them, and wavelengths that are visible" {
  sensors >rgb.csv
  relight -q --estimate rgb.csv -o rgb.json
  awk -F, -v OFS=';' '{ print $4, $3, $1, $2 }' rgb.csv | iconv -t UTF-16 >other.csv
  relight -q --estimate other.csv -o other.json
  cmp rgb.json other.json
  # By position, blue was red.
  sed 1d rgb.csv | awk -F, -v OFS=, '{ print $1, $4, $3, $2 }' >nameless.csv
  relight -q --estimate nameless.csv -o nameless.json
  ! cmp -s rgb.json nameless.json || false
  awk -F, -v OFS=, 'NR > 1 { $1 += 500 } 1' rgb.csv >infrared.csv
  run --separate-stderr relight --estimate infrared.csv
  [ "$status" -eq 3 ]
  [[ "$stderr" == *"infrared.csv: the spectrum goes from 900 to"*"leaves out 100 %"* ]]
}

@test "a bad image is told by name" {
  run --separate-stderr relight --from D65 --to A nowhere.exr -o out.exr
  [ "$status" -eq 3 ]
  [[ "$stderr" == *"nowhere.exr"* ]]
}

@test "--explain shows the matrix before working" {
  run --separate-stderr relight --explain --from D65 --to A "$sky" -o out.exr
  [ "$status" -eq 0 ]
  [[ "$stderr" == *"illuminant 1"*"to 1.4"*"condition number"* ]]
}

@test "scripts/estimate-operator makes the operator of a space from CIE tables" {
  # A coarse table will do: 20 nm of the 1931 observer.
  cat >cie.csv <<'END'
nm,x,y,z
420,0.13438,0.0040,0.6456
440,0.34828,0.0230,1.74706
460,0.29080,0.0600,1.66920
480,0.09564,0.13902,0.81295
500,0.00490,0.3230,0.2720
520,0.06327,0.7100,0.07825
540,0.29040,0.9540,0.02030
560,0.59450,0.9950,0.00390
580,0.91630,0.8700,0.00165
600,1.06220,0.6310,0.00080
620,0.85445,0.3810,0.00019
640,0.44790,0.1750,0.00002
660,0.16490,0.0610,0.0
680,0.04677,0.0170,0.0
END
  run --separate-stderr "$estimate" cie.csv --primaries rec709 -o op.json
  [ "$status" -eq 0 ]
  grep -q '"primaries":\[\[0.64,0.33\],' op.json
  relight -q --from D65 --to A --operator op.json "$sky" -o out.exr
  # Behind a mark of the encoding the first row was taken for names, and columns of other names for x, y and z.
  { printf '\xef\xbb\xbf' && tail -n +2 cie.csv; } >marked.csv
  "$estimate" marked.csv --primaries rec709 -o same.json
  cmp op.json same.json
  sed 's/nm,x,y,z/nm,z,y,x/' cie.csv >turned.csv
  run "$estimate" turned.csv -o none.json
  [ "$status" -eq 3 ]
  [[ "$output" == *"turned.csv:1: the columns are nm, z, y, x: give wavelength, x, y and z bar"* ]]
  run "$estimate" cie.csv --primaries 0.64,0.33,0.3
  [ "$status" -ne 0 ]
  run "$estimate" cie.csv --primaries 0.1,0.1,0.2,0.2,0.3,0.3
  [ "$status" -ne 0 ]
  [[ "$output" == *"on one line"* ]]
  run "$estimate" nowhere.csv
  [ "$status" -ne 0 ]
  [[ "$output" == *"nowhere.csv"* ]]
}

@test "inks are told" {
  base64 -d >cmyk.jpg <<<'/9j/7gAOQWRvYmUAZAAAAAAC/9sAQwAGBAUGBQQGBgUGBwcGCAoQCgoJCQoUDg8MEBcUGBgXFBYWGh0lHxobIxwWFiAsICMmJykqKRkfLTAtKDAlKCko/9sAQwEHBwcKCAoTCgoTKBoWGigoKCgoKCgoKCgoKCgoKCgoKCgoKCgoKCgoKCgoKCgoKCgoKCgoKCgoKCgoKCgoKCgo/8AAFAgACAAIBAERAAIRAQMRAQQRAP/EABUAAQEAAAAAAAAAAAAAAAAAAAUI/8QAFBABAAAAAAAAAAAAAAAAAAAAAP/EABUBAQEAAAAAAAAAAAAAAAAAAAYH/8QAFBEBAAAAAAAAAAAAAAAAAAAAAP/aAA4EAQACEQMRBAAAPwBAnQ1QL//Z'
  run relight --from D65 --to A cmyk.jpg -o out.exr
  [ "$status" -eq 0 ]
  [[ $output == *"warning: cmyk.jpg is CMYK, and its inks were taken for RGB without regard to its profile: convert it to RGB"* ]]
}
