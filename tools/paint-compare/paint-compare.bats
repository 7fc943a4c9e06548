#!/usr/bin/env bats
# paint-compare: differences with their direction, limits and verdicts, pairs, what is refused, and the files that it makes.

bats_require_minimum_version 1.5.0

setup() {
  cd "$BATS_TEST_TMPDIR"
  export TESTDATA
  standard=$TESTDATA/paints.paints.xml#candy_red
  printf 'geometry,quantity,low,high\n*,dL,-1.5,1.5\nmax,dE_cmc:2:1,,3\n' >limits.csv
  printf 'sample,geometry,illuminant,observer,L,a,b\n' >head.csv
  { cat head.csv; printf 'batch,45as15,D65,10,%s\nbatch,45as45,D65,10,60.1,-0.8,1.4\nbatch,45as110,D65,10,31.2,0.2,-0.9\n' 124.3,-1.2,2.1; } >std.csv
  { cat head.csv; printf 'batch,45as15,D65,10,%s\nbatch,45as45,D65,10,61.0,-0.7,1.1\nbatch,45as110,D65,10,32.4,0.1,-1.5\n' 121.9,-0.9,2.9; } >dark.csv
  paint-convert -q std.csv -o std.paints.xml
  paint-convert -q dark.csv -o dark.paints.xml
}

# The field of a table at the line of a geometry.
field() {
  awk -F '\t' -v name="$1" -v at="$2" 'NR == 1 { for (i = 1; i <= NF; ++i) column[$i] = i } $3 == at { print $column[name] }' table.tsv
}

@test "differences are sample minus standard, and the header says so" {
  paint-compare -q -s std.paints.xml --formula din6175,cmc,cie94,din99o dark.paints.xml -o table.tsv
  [ "$(head -n 1 table.tsv | cut -f 1-4)" = "$(printf 'sample\tminus_standard\tgeometry\tdL')" ]
  [ "$(field dL 45as15)" = -2.4 ]
  [ "$(field dE_din6175 45as15), $(field dE_cmc:2:1 45as45), $(field dE_cie94 45as110), $(field dE_din99o 45as15)" = "1.38, 0.57, 1.34, 2.27" ]
  [ "$(field dE_din6175 max)" = 1.38 ]
  [[ $(field other paint) == *flop_index=* ]]
}

@test "a batch that fails stops a script of sh -e with 1 and one line for a painter" {
  cat >script.sh <<-END
	paint-compare -s std.paints.xml -l limits.csv dark.paints.xml -o table.tsv
	echo not reached
	END
  run sh -e script.sh
  echo "$output"
  [ "$status" -eq 1 ]
  [ "${#lines[@]}" -eq 2 ]
  [ "${lines[0]}" = 'paint-compare: "batch" fails against "batch": 45as15: dL -2.4, limit -1.5: too dark near gloss' ]
  [ "$(field verdict 45as15), $(field verdict 45as45), $(field verdict paint)" = "fail, pass, fail" ]
}

@test "a batch that passes ends with 0" {
  run paint-compare -s std.paints.xml -l limits.csv std.paints.xml -o table.tsv
  [ "$status" -eq 0 ]
  [ "$output" = "paint-compare: 1 compared with 1 standard, 1 pass, 0 fail" ]
  [ "$(field dL mean), $(field dE_cmc:2:1 max)" = "0, 0" ]
}

@test "a sample that lacks an angle with a limit is incomplete, in every output and with -q" {
  grep -v 45as110 std.csv >short.csv
  paint-convert -q short.csv -o short.paints.xml
  run paint-compare -q -s std.paints.xml -l limits.csv short.paints.xml -o table.tsv --report report.json --chart page.html
  echo "$output"
  [ "$status" -eq 1 ]
  [ "${lines[0]}" = 'paint-compare: "batch" is incomplete against "batch": 45as110: dL has a limit and was not measured; max: dE_cmc:2:1 has a limit, and 45as110 was not measured' ]
  [ "${lines[-1]}" = 'paint-compare: 1 compared with 1 standard, 0 pass, 0 fail, 1 incomplete' ]
  [ "$(for at in 45as15 45as110 mean max paint; do field verdict $at; done | xargs)" = "pass incomplete - incomplete incomplete" ]
  [ "$(field dL 45as110)" = - ]
  jq -e '.results | .failed == 0 and .incomplete == 1 and .passed == 0' report.json
  jq -e '.results.judgements[0] | .verdict == "incomplete" and .verdicts["45as110"] == "incomplete" and .verdicts["45as15"] == "pass"
    and .verdicts.mean == "-" and (.failures[0] | .at == "45as110" and .value == null)' report.json
  grep -q '<span class="incomplete">incomplete</span> batch' page.html
  run ! paint-compare -q -s std.paints.xml -l limits.csv short.paints.xml -o judged.paints.xml
  grep -q 'result="incomplete">45as110: dL has a limit and was not measured' judged.paints.xml
  # All that a geometry lacks is one reason.
  printf 'geometry,quantity,low,high\n*,dL,-9,9\n*,da,-9,9\n*,dE,,9\n' >three.csv
  run paint-compare -q -s std.paints.xml -l three.csv short.paints.xml -o table.tsv
  [[ ${lines[0]} == *': 45as110: dL, da, dE_ciede2000 have limits and were not measured' ]]
  # Limits that name the angles judge such a sample, and the others are not judged.
  printf 'geometry,quantity,low,high\n45as15,dL,-1.5,1.5\n' >named.csv
  run paint-compare -q -s std.paints.xml -l named.csv short.paints.xml -o table.tsv
  [ "$status, $output" = "0, " ]
  [ "$(for at in 45as15 45as45 mean max paint; do field verdict $at; done | xargs)" = "pass - - - pass" ]
}

@test "samples of standards without limits are counted as not judged" {
  sed 's/batch/other/' std.csv >other.csv
  paint-convert -q other.csv -o other.paints.xml
  for dL in 0.1 0.2 0.3; do paint-edit -q std.paints.xml --lightness-shift $dL -o accepted$dL.paints.xml; done
  paint-compare -q -s std.paints.xml --make-limits with.paints.xml accepted*.paints.xml -o table.tsv
  paint-convert -q with.paints.xml other.paints.xml --to xml -o both.paints.xml
  run paint-compare -s both.paints.xml accepted0.2.paints.xml other.paints.xml -o table.tsv --report report.json
  echo "$output"
  [ "$output" = "paint-compare: 2 compared with 2 standards, 1 pass, 0 fail, 1 not judged: their standards have no limits" ]
  [ "$(awk '$1 == "other" { print $NF }' table.tsv | sort -u)" = - ]
  jq -e '.results | .passed == 1 and .not_judged == 1 and .judgements[1].verdicts["45as15"] == "-"' report.json
}

@test "advice names the tool that has the option" {
  { echo 'sample,geometry,illuminant,observer,400,420,440,460,480,500,520,540,560,580,600,620,640,660,680,700'
    echo 'batch,45as45,D65,10,.2,.2,.2,.2,.2,.2,.2,.2,.2,.2,.2,.2,.2,.2,.2,.2'; } >spectra.csv
  run paint-compare -s std.paints.xml spectra.csv -o table.tsv
  echo "$output"
  [[ $output == *'give paint-convert --scale percent if not'* ]]
  ! grep -qE '[^t] --(scale|viewing)' <<<"$output" || false
  paint-convert -q --scale percent spectra.csv -o dark.paints.xml
}

@test "JSON lines and the report hold the same judgement, paint XML its verdict" {
  run ! paint-compare -q -s std.paints.xml -l limits.csv dark.paints.xml -o verdict.jsonl --report report.json
  [ "$(jq -r '.verdict, .failures[0].quantity' verdict.jsonl | xargs)" = "fail dL" ]
  [ "$(jq -c '.results.judgements[0]' report.json)" = "$(cat verdict.jsonl)" ]
  jq -e '.results.failed == 1' report.json
  run ! paint-compare -q -s std.paints.xml -l limits.csv dark.paints.xml -o judged.paints.xml
  grep -q '<verdict xmlns="urn:goniochrome:quality:1" standard="batch" result="fail">45as15: dL -2.4, limit -1.5: too dark near gloss</verdict>' judged.paints.xml
  paint-stats -q judged.paints.xml
  # A new verdict takes the place of the old one.
  paint-compare -q -s dark.paints.xml -l limits.csv judged.paints.xml -o again.paints.xml
  [ "$(grep -o 'result="[a-z]*"' again.paints.xml)" = 'result="pass"' ]
}

@test "standards are found by name, code and nearness" {
  paint-compare -q -s "$TESTDATA/paints.paints.xml" "$TESTDATA/paints.paints.xml" -o table.tsv
  [ "$(awk -F '\t' 'NR > 1 && $1 != $2' table.tsv | wc -l)" -eq 0 ]
  paint-edit -q "$standard" --lightness-shift 0.3 --rename other -o other.paints.xml
  run paint-compare -q -s "$TESTDATA/paints.paints.xml" other.paints.xml
  [ "$status" -eq 3 ]
  [[ $output == *'paint "other": there is no standard of its name'* ]]
  paint-compare -q -s "$TESTDATA/paints.paints.xml" --pair nearest other.paints.xml -o table.tsv
  [ "$(tail -n 1 table.tsv | cut -f 2)" = candy_red ]
  run paint-compare -q -s std.paints.xml --pair code std.paints.xml
  [ "$status" -eq 3 ]
  [[ $output == *'it has no code'* ]]
}

@test "limits are made of accepted panels, kept with the standard, and used from there" {
  paint-edit -q "$standard" --variations face --step 0.5 -o accepted.paints.xml
  paint-compare -q -s "$standard" --make-limits made.csv --share 0.8 accepted.paints.xml -o table.tsv
  run paint-compare -s "$standard" -l made.csv accepted.paints.xml -o table.tsv
  [ "$status" -eq 1 ]
  [[ $output == *'9 compared with 1 standard, 8 pass, 1 fail'* ]]
  paint-compare -q -s "$standard" --make-limits with.paints.xml --spread 50 accepted.paints.xml -o table.tsv
  run paint-compare -s with.paints.xml accepted.paints.xml -o table.tsv
  [ "$status" -eq 0 ]
  [[ $output == *'9 pass, 0 fail'* ]]
  grep -v 45as110 std.csv >short.csv
  run paint-compare -s std.paints.xml --make-limits made.csv std.paints.xml std.paints.xml short.csv -o table.tsv
  [[ $output == *'made.csv: no limits for 45as110, '* ]]
  ! grep -q 45as110 made.csv || false
  run paint-compare -q -s "$standard" --make-limits few.csv "$standard"
  [ "$status" -eq 3 ]
  [ ! -e few.csv ]
}

@test "the paints of --show-limit pass, and farther ones do not" {
  printf 'geometry,quantity,low,high\n*,dE,,2\n' >round.csv
  paint-compare -q -s "$standard" -l round.csv --show-limit limit.paints.xml "$standard" -o table.tsv
  paint-compare -q -s "$standard" -l round.csv limit.paints.xml -o table.tsv
  [ "$(awk -F '\t' '$3 == "max" && $1 != $2 && $9 < 1.999' table.tsv | wc -l)" -eq 0 ]
  [ "$(awk -F '\t' '$3 == "max"' table.tsv | wc -l)" -eq 9 ]
  run paint-compare -q -s "$standard" --show-limit limit.paints.xml "$standard"
  [ "$status" -eq 2 ]
}

@test "a page needs no other file, and a folder has a page for each sample" {
  run ! paint-compare -q -s std.paints.xml -l limits.csv --chart page.html dark.paints.xml std.paints.xml -o table.tsv
  grep -q 'data:image/png;base64,' page.html
  [ "$(grep -c '<section>' page.html)" -eq 2 ]
  grep -q '45as15: dL -2.4, limit -1.5: too dark near gloss' page.html
  ! grep -qE '(src|href)="(http|[^d#"])' page.html || false
  run ! paint-compare -q -s std.paints.xml -l limits.csv --chart pages dark.paints.xml std.paints.xml -o table.tsv
  [ "$(ls pages | xargs)" = "0001.html 0002.html index.html" ]
}

@test "control charts stand against the date where every sample has one, and else in order" {
  { echo 'sample,date,geometry,illuminant,observer,L,a,b'
    printf '%s,%s,45as15,D65,10,%s,-1,2\n' b1 2021-11-28 123 b2 2021-11-26 125 b3 2021-11-27T12:00Z 124; } >days.csv
  paint-convert -q days.csv -o days.paints.xml
  paint-compare -q -s std.paints.xml --chart page.html days.paints.xml -o table.tsv
  grep -q '3 samples by their dates' page.html
  grep -q '>date</text>' page.html
  grep -q '>2021-11-26 12:00</text>' page.html
  # dL of the days is .7, -.3 and -1.3, whose ranges are 1 and 1; in the order of the file they would be 2 and 1.
  paint-convert -q days.csv --to csv | paint-convert -q --from csv -o plain.paints.xml
  paint-compare -q -s std.paints.xml --chart plain.html plain.paints.xml -o table.tsv
  grep -q '3 samples in their order' plain.html
  ! grep -q '>date</text>' plain.html || false
}

@test "a control chart of a tile marks the readings beyond three sigma" {
  { echo 'sample,date,geometry,illuminant,observer,L,a,b'
    for day in $(seq 10 27); do printf 'd%s,2026-11-%s,45as15,D65,10,%s,-1.2,2.1\n' $day $day $((day == 25 ? 126 : 124)).$((day % 2)); done; } >tile.csv
  paint-convert -q tile.csv -o tile.paints.xml
  paint-compare -q -s std.paints.xml --chart page.html tile.paints.xml -o table.tsv
  sed -n '/>dL at 45as15</,/>moving range at 45as15</p' page.html >chart
  [ "$(grep -c '<circle.*fill="#b3261e"' chart)" -eq 2 ] # one in the legend
  grep -q '>beyond</text>' chart
  sed -i 's/,126/,124/' tile.csv
  paint-convert -q tile.csv -o tile.paints.xml
  paint-compare -q -s std.paints.xml --chart page.html tile.paints.xml -o table.tsv
  ! grep -q '>beyond</text>' page.html || false
}

@test "a control chart has one word for both of its limits" {
  for dL in 0.5 0.2 -0.3; do paint-edit -q "$standard" --lightness-shift "$dL" -o "batch$dL.paints.xml"; done
  paint-compare -q -s "$standard" -l limits.csv --chart page.html batch*.paints.xml -o table.tsv
  [ "$(sed -n '/>dL at 45as15</,/>moving range at 45as15</p' page.html | grep -c '>limit</text>')" -eq 1 ]
}

@test "a sample that fails everywhere has a line of four failures, and a page that marks all of them" {
  printf 'geometry,quantity,low,high\n*,dL,-0.1,0.1\n*,da,-0.01,0.01\n*,db,-0.01,0.01\n*,dE,,0.01\n*,dC,-0.001,0.001\n' >strict.csv
  run paint-compare -s std.paints.xml -l strict.csv --chart page.html dark.paints.xml -o table.tsv
  [ "$status" -eq 1 ]
  [[ ${lines[0]} == *'; and 11 more' ]]
  [ "$(grep -o '; ' <<<"${lines[0]}" | wc -l)" -eq 4 ]
  [ "$(grep -o '<li>' page.html | wc -l)" -eq 13 ]
  [ "$(grep -o '<td class="fail">' page.html | wc -l)" -eq 15 ]
}

@test "the page draws the paints of --show-limit around their standard" {
  printf 'geometry,quantity,low,high\n*,dE,,2\n' >round.csv
  paint-compare -q -s "$standard" -l round.csv --show-limit limit.paints.xml --chart page.html "$standard" -o table.tsv
  [ "$(grep -c '<figure><img' page.html)" -eq 9 ]
  [ "$(grep -o '<figcaption>[^<]*' page.html | sed 's/.*>//' | xargs)" = "lighter darker red yellow the standard green cyan blue magenta" ]
  paint-compare -q -s "$standard" -l round.csv --chart page.html "$standard" -o table.tsv
  ! grep -q '<figure>' page.html || false
}

@test "what cannot be compared is refused in a sentence" {
  refused() {
    local said=$1
    shift
    run paint-compare -q "$@" -o table.tsv
    echo "$output"
    [ "$status" -eq 3 ]
    [[ $output == *"$said"* ]]
  }
  sed 's/45as15/45as20/; s/45as45/45as50/; s/45as110/45as100/' dark.csv >angles.csv
  paint-convert -q angles.csv -o angles.paints.xml
  refused 'no geometry in common' -s std.paints.xml angles.paints.xml
  sed 's/D65,10/A,2/' dark.csv >light.csv
  paint-convert -q light.csv -o light.paints.xml
  refused 'the standard is stated for D65/10, the sample for A/2' -s std.paints.xml light.paints.xml
  printf 'geometry,quantity,low,high\n*,dL,2,1\n' >wrong.csv
  refused 'wrong.csv:2: low is 2, above high' -s std.paints.xml -l wrong.csv dark.paints.xml
  printf 'geometry,quantity,low,high\n*,dX,2,1\n' >wrong.csv
  refused 'there is no quantity "dX"' -s std.paints.xml -l wrong.csv dark.paints.xml
  printf 'geometry,quantity,low,high\n*,metamerism_Q,,1\n' >wrong.csv
  refused 'Q' -s std.paints.xml -l wrong.csv dark.paints.xml
  run paint-compare -q -s std.paints.xml --formula cie2 dark.paints.xml
  [ "$status" -eq 2 ]
  run paint-compare -s std.paints.xml -k angles.paints.xml dark.paints.xml -o table.tsv
  [ "$status" -eq 1 ]
  [[ $output == *'left out'* ]]
  [ "$(field dL 45as15)" = -2.4 ]
}

@test "a sample in other light is brought to that of its standard by its spectra" {
  { printf 'sample,geometry,illuminant,observer'; printf ',%d' $(seq 400 10 700); printf '\ngray,45as45,A,2'; printf ',0.25%.0s' $(seq 31); printf '\n'; } >gray.csv
  paint-convert -q --scale factor gray.csv -o gray.paints.xml
  paint-convert -q --illuminant D65 --observer 10 gray.paints.xml -o day.paints.xml
  run paint-compare -s day.paints.xml gray.paints.xml --illuminant F11 -o table.tsv
  echo "$output"
  [ "$status" -eq 0 ]
  [[ $output == *'the sample was brought from A/2 to D65/10 by its spectra'* ]]
  [ "$(field dE_ciede2000 45as45)" = 0 ]
  [[ $(field other 45as45) == metamerism_F11=0 ]]
}
