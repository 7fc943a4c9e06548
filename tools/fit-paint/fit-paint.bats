# fit-paint from the outside: options, streams, exit statuses.

bats_require_minimum_version 1.5.0

setup() {
  cd "$BATS_TEST_TMPDIR" || exit 1
  basis=$TESTDATA/b7.basis.xml
  paints=$TESTDATA/paints.paints.xml
  head='<?xml version="1.0"?><paints xmlns="urn:goniochrome:paint:1" version="1">'
  row='<lab geometry="45as15" L="60" a="5" b="-20"/><lab geometry="45as45" L="30" a="8" b="-25"/><lab geometry="45as110" L="12" a="9" b="-20"/>'
  one="<paint name=\"one\"><measurement illuminant=\"D65\" observer=\"10\">$row</measurement></paint>"
}

# number KEY: the first number of that key in the report.
number() { grep -m1 "\"$1\"" r.json | sed -E 's/.*: ([-0-9.e+]+),?$/\1/'; }

@test "every sample paint is fitted, and the summary says how well" {
  run --separate-stderr fit-paint --basis "$basis" "$paints" -o out.xml --report r.json
  [ "$status" -eq 0 ]
  [ -z "$output" ]
  [[ "$stderr" =~ ^"fit-paint: "[0-9]+" paints by l1, dE00 mean "[0-9.]+", 95 % below "[0-9.]+", worst "[0-9.]+" ("[a-z0-9_]+" at 45as" ]]
  count=$(grep -c '<paint ' "$paints")
  [ "$(grep -c '<lobes ' out.xml)" -eq "$count" ]
  [ "$(grep -c '"status": "optimal"' r.json)" -eq "$count" ]
  grep -q '"de00_by_geometry"' r.json
  [ "$(number failed)" = 0 ]
}

@test "names, order and readings pass unchanged" {
  fit-paint -q -b "$basis" "$paints" -o out.xml
  diff <(grep -o '<paint name="[^"]*"' "$paints") <(grep -o '<paint name="[^"]*"' out.xml)
  diff <(grep -o '<lab [^>]*>' "$paints") <(grep -o '<lab [^>]*>' out.xml)
}

@test "standard input goes to standard output, and the report to a file" {
  run --separate-stderr bash -c "echo '$head$one</paints>' | fit-paint -b '$basis' --report r.json"
  [ "$status" -eq 0 ]
  [[ "$output" =~ '<lobes space="lin_rec2020_scene" basis="b7" method="l1"' ]]
  [ "$(number active_lobes)" -ge 1 ]
}

@test "its own output can be fitted again, with both steps in the history" {
  echo "$head$one</paints>" | fit-paint -q -b "$basis" | fit-paint -q -b "$TESTDATA/b5.basis.xml" --method l2 -o out.xml
  [ "$(grep -c '<processing ' out.xml)" -eq 2 ]
  [ "$(grep -c '<lobes ' out.xml)" -eq 1 ]
  grep -q 'basis="b5" method="l2"' out.xml
}

@test "elements it does not know stay" {
  foreign='<shelf:mark xmlns:shelf="urn:example:shelf" row="7"/>'
  echo "$head${one/<\/paint>/$foreign</paint>}</paints>" | fit-paint -q -b "$basis" -o out.xml
  grep -q 'row="7"' out.xml
}

@test "several inputs follow each other" {
  echo "$head$one</paints>" >a.xml
  echo "$head${one/\"one\"/\"two\"}</paints>" >b.xml
  fit-paint -q -b "$basis" b.xml a.xml -o out.xml
  [ "$(grep -o '<paint name="[^"]*"' out.xml | tr -d '\n')" = '<paint name="two"<paint name="one"' ]
  run fit-paint -q -b "$basis" a.xml b.xml a.xml -o again.xml
  [ "$status" -eq 3 ]
  [[ "$output" =~ "a.xml:1: paint \"one\" is already in a.xml" ]]
  [ ! -e again.xml ]
}

@test "--method l2 and l1 differ, and each reports its proof" {
  for method in l1 l2; do
    fit-paint -q -b "$basis" --method $method "$paints" -o $method.xml --report r.json
    grep -q "\"method\": \"$method\"" r.json
    awk -F': ' '/optimality_gap/ { if ($2 + 0 > 1e-9) exit 1 }' r.json
  done
  ! diff -q l1.xml l2.xml || false
}

@test "--target curve is a poorer target than the readings" {
  echo "$head<paint name=\"m\"><measurement illuminant=\"D65\" observer=\"10\"><lab geometry=\"45as15\" L=\"78\" a=\"-2\" b=\"-38\"/><lab geometry=\"45as25\" L=\"60\" a=\"0\" b=\"-42\"/><lab geometry=\"45as45\" L=\"34\" a=\"6\" b=\"-40\"/><lab geometry=\"45as75\" L=\"17\" a=\"11\" b=\"-33\"/><lab geometry=\"45as110\" L=\"11\" a=\"12\" b=\"-28\"/></measurement></paint></paints>" >m.xml
  fit-paint -q -b "$basis" --target measured m.xml -o /dev/null --report r.json
  measured=$(number de00_mean)
  fit-paint -q -b "$basis" --target curve m.xml -o /dev/null --report r.json
  awk -v m="$measured" -v c="$(number de00_mean)" 'BEGIN { exit !(c > m) }'
}

@test "--weights plain lowers the plain error" {
  fit-paint -q -b "$basis" --weights perceptual "$paints" -o /dev/null --report r.json
  perceptual=$(number plain_objective)
  fit-paint -q -b "$basis" --weights plain "$paints" -o /dev/null --report r.json
  awk -v a="$perceptual" -v b="$(number plain_objective)" 'BEGIN { exit !(b <= a * (1 + 1e-9)) }'
}

@test "--gloss gives a coat to paints that state no gloss" {
  echo "$head$one</paints>" >one.xml
  fit-paint -q -b "$basis" one.xml -o matt.xml
  ! grep -q 'exponent="mirror"' matt.xml || false
  fit-paint -q -b "$basis" --gloss 92 one.xml -o coat.xml --report r.json
  grep -q 'exponent="mirror"' coat.xml
  grep -q '"stated_gu": 92' r.json
}

@test "three readings of a satin coat are met together, and --satin all predicts them from one" {
  stated='<gloss angle="20">18</gloss><gloss angle="60">60</gloss><gloss angle="85">88</gloss>'
  echo "$head${one/<\/measurement>/</measurement>$stated}</paints>" >three.xml
  fit-paint -q -b "$basis" three.xml -o out.xml --report r.json
  [ "$(grep -c '<view angle=' out.xml)" -eq 14 ]
  jq -e '.results.paints[0].gloss | length == 3 and all(.misfit_gu | fabs < 1)' r.json
  jq -e '.results.paints[0].coat_range | .slopes == "ggx" and .least_haze.haze < 0.8 * .most_haze.haze and
    .least_haze.haze <= .probable.haze and .probable.haze <= .most_haze.haze' r.json
  run --separate-stderr fit-paint -b "$basis" three.xml -o out.xml
  [[ "$stderr" =~ "leave open how wide the haze of their coats is" ]]
  # The control: for all views alike, the reading at 20 deg is met and the others are missed.
  fit-paint -q -b "$basis" --satin none three.xml -o out.xml --report r.json
  [ "$(grep -c '<view angle=' out.xml)" -eq 0 ]
  jq -e '.results.paints[0] | (.gloss | any(.misfit_gu | fabs > 10)) and (has("coat_range") | not)' r.json
  echo "$head$one</paints>" >one.xml
  fit-paint -q -b "$basis" --gloss 60 one.xml -o out.xml
  [ "$(grep -c '<view angle=' out.xml)" -eq 0 ]
  fit-paint -q -b "$basis" --gloss 60 --satin all one.xml -o out.xml --report r.json
  [ "$(grep -c '<view angle=' out.xml)" -eq 14 ]
  jq -e '.results.paints[0].gloss | .[0].simulated_gu > 12 and .[0].simulated_gu < 20 and .[2].simulated_gu > 78 and .[2].simulated_gu < 88' r.json
  run fit-paint -b "$basis" --satin some one.xml -o out.xml
  [ "$status" -eq 2 ]
}

@test "--explain tells the plan and what is left out" {
  run --separate-stderr fit-paint -b "$basis" --explain "$paints" -o /dev/null
  [ "$status" -eq 0 ]
  [[ "$stderr" =~ "no reading sees them: 250 900 3000" ]]
}

@test "any number of threads writes the same bytes" {
  for n in 1 2 7; do
    fit-paint -q -b "$basis" --threads $n "$paints" -o t$n.xml
    sed -i 's/--threads [0-9]*//; s/t[0-9].xml//' t$n.xml
  done
  cmp t1.xml t2.xml
  cmp t1.xml t7.xml
}

@test "a paint that cannot be fitted passes, is named, and the exit status is 1" {
  echo "$head<paint name=\"bare\"/>$one</paints>" >mixed.xml
  run --separate-stderr fit-paint -b "$basis" mixed.xml -o out.xml --report r.json
  [ "$status" -eq 1 ]
  [[ "$stderr" =~ "mixed.xml:1: paint \"bare\" is passed on unfitted" ]]
  grep -q '<paint name="bare"' out.xml
  [ "$(grep -c '<lobes ' out.xml)" -eq 1 ]
  grep -q '"status": "failed"' r.json
}

@test "without --basis there is one that is built in, and a file that is not there is bad input" {
  fit-paint -q "$paints" -o built-in.xml
  fit-paint -q --basis "$basis" "$paints" -o named.xml
  diff <(grep -v '<processing' built-in.xml) <(grep -v '<processing' named.xml)
  run fit-paint --basis absent.basis.xml "$paints"
  [ "$status" -eq 3 ]
  [[ "$output" =~ "absent.basis.xml" ]]
  run fit-paint --basis "$paints" "$paints"
  [ "$status" -eq 3 ]
}

@test "wrong words for each option are usage errors that name what is right" {
  for wrong in "--method l3" "--target guess" "--weights heavy" "--gloss much" "--gloss -1" "--gloss 2000" "--threads x"; do
    # shellcheck disable=SC2086
    run fit-paint -b "$basis" $wrong "$paints" -o out.xml
    [ "$status" -eq 2 ]
    [[ "$output" =~ ${wrong%% *} ]]
    [ ! -e out.xml ]
  done
  run fit-paint -b "$basis" --methd l1 "$paints"
  [ "$status" -eq 2 ]
  [[ "$output" =~ "--method" ]]
}

@test "bad paints are named by file and line, and no output appears" {
  printf '%s\n%s\n' "$head" "${one/L=\"60\"/L=\"6,0\"}</paints>" >bad.xml
  run fit-paint -b "$basis" bad.xml -o out.xml
  [ "$status" -eq 3 ]
  [[ "$output" =~ "bad.xml:2" ]]
  [ ! -e out.xml ]
  echo "$head$one" >cut.xml
  run fit-paint -b "$basis" cut.xml -o out.xml
  [ "$status" -eq 3 ]
  [ ! -e out.xml ]
  run fit-paint -b "$basis" absent.paints.xml -o out.xml
  [ "$status" -eq 3 ]
  [[ "$output" =~ "absent.paints.xml" ]]
}

@test "an output that cannot be written is exit 3" {
  run fit-paint -q -b "$basis" "$paints" -o no/such/folder/out.xml
  [ "$status" -eq 3 ]
}

@test "a closed pipe ends quietly" {
  { echo "$head"; for i in $(seq 3000); do echo "${one/\"one\"/\"p$i\"}"; done; echo '</paints>'; } >many.xml
  fit-paint -b "$basis" many.xml 2>err | head -n 3 >/dev/null
  [ ! -s err ]
}

# cornell FILE: a measured BRDF whose flake is 0.05 + cos^10 with the spike of a coat on top, cos^3000 over cos_i times
# its Fresnel reflectance over that at 45 deg, all gray.
cornell() {
  awk 'function fresnel(c,  g) {
      g = sqrt(1.25 + c * c)
      return (((c - g) / (c + g)) ^ 2 + ((2.25 * c - g) / (2.25 * c + g)) ^ 2) / 2
    }
    BEGIN {
    pi = 3.14159265358979; print "# made for a test\n3\n400 550 700"
    for (ti = 0; ti <= 80; ti += 10) for (to = 0; to <= 80; to += 5) for (az = 0; az <= 180; az += 20) {
      a = ti * pi / 180; b = to * pi / 180; c = az * pi / 180
      cosine = cos(a) * cos(b) - sin(a) * sin(b) * cos(c)
      f = 0.05; if (cosine > 0) f += 0.1 * cosine ^ 10 + 20 * cosine ^ 3000 / cos(a) * fresnel(cos(a)) / fresnel(sqrt(0.5))
      printf "%.6f 0 %.6f %.6f %.7f %.7f %.7f\n", a, b, c, f, f, f } }' >"$1"
}

@test "a measured BRDF becomes one fitted paint, its spike apart" {
  cornell metal.brdf
  fit-paint -q -b "$basis" metal.brdf -o out.xml --report r.json
  grep -q '<paint name="metal"' out.xml
  [ "$(grep -c '<lab ' out.xml)" -eq 5 ]
  # b7 has no exponent 10: 6 and 20 between them come within 2 %.
  awk -v e="$(number relative_error_median)" 'BEGIN { exit !(e < 0.02) }'
  [ "$(number steep_directions)" -gt 0 ]
  [ "$(number glare_directions)" -gt 0 ]
  # 2 pi 20/3001 = 0.0419 is the albedo of the spike; the directions of the file sample it once or twice a lobe.
  awk -v e="$(number spike_albedo_45)" 'BEGIN { exit !(e > 0.03 && e < 0.055) }'
  grep -q 'exponent="3000".* gr="[1-9]' out.xml
  # Between scattered directions the spike is lost.
  [ "$(grep -c albedo_error r.json)" -eq 0 ]
}

@test "reasons to doubt a measured BRDF are told" {
  cornell metal.brdf
  awk 'NR > 3 { for (i = 5; i <= 7; ++i) $i *= 30 } { print }' metal.brdf >bright.brdf
  for tool in fit-paint "fit-basis --lobes 1 --starts 2"; do
    run --separate-stderr $tool bright.brdf -o out.xml
    [ "$status" -eq 0 ]
    [[ "$stderr" == *": warning: bright.brdf: reflects "*" of the light at 45 deg: more than there is"* ]]
  done
}

@test "measured BRDFs and libraries pass in one run, and their names must differ" {
  cornell one.brdf
  echo "$head${one/\"one\"/\"two\"}</paints>" >two.xml
  run fit-paint -b "$basis" one.brdf two.xml -o out.xml
  [ "$status" -eq 0 ]
  [[ "$output" =~ "1 measured BRDFs with a median relative error of 0.0" ]]
  [ "$(grep -c '<lobes ' out.xml)" -eq 2 ]
  echo "$head$one</paints>" >same.xml
  run fit-paint -q -b "$basis" one.brdf same.xml -o again.xml
  [ "$status" -eq 3 ]
  [ ! -e again.xml ]
}

@test "--steepest leaves directions out" {
  cornell metal.brdf
  fit-paint -q -b "$basis" --steepest 80 metal.brdf -o /dev/null --report r.json
  [ "$(number steep_directions)" = 0 ]
  fit-paint -q -b "$basis" --steepest 40 metal.brdf -o /dev/null --report r.json
  [ "$(number steep_directions)" -gt 500 ]
}

@test "--lobes takes the best few, --prune drops what nobody sees, and both are told" {
  echo "$head$one</paints>" >one.xml
  fit-paint -q -b "$basis" --lobes 2 one.xml -o two.xml --report r.json
  [ "$(grep -c '<lobe ' two.xml)" -le 2 ]
  grep -q '"dropped_exponents"' r.json
  two=$(number objective)
  fit-paint -q -b "$basis" one.xml -o all.xml --report r.json
  awk -v few="$two" -v all="$(number objective)" 'BEGIN { exit !(all <= few * (1 + 1e-9)) }'
  fit-paint -q -b "$basis" --prune 100 one.xml -o none.xml
  [ "$(grep -c '<lobe ' none.xml)" -eq 0 ]
}

@test "--views writes weights for each view and tells what they gain" {
  two_sided="${row/\/>/\/><lab geometry=\"45as-15\" L=\"70\" a=\"40\" b=\"10\"\/>}"
  echo "$head<paint name=\"shift\"><measurement illuminant=\"D65\" observer=\"10\">$two_sided</measurement></paint></paints>" >s.xml
  run fit-paint -b "$basis" --views 0,15,30,45,60,75 s.xml -o out.xml --report r.json
  [ "$status" -eq 0 ]
  [ "$(grep -c '<view angle=' out.xml)" -eq 6 ]
  [[ "$output" =~ "the views gain dE00" ]]
  awk -v g="$(number gain_de00)" 'BEGIN { exit !(g > 3) }'
  # It can be read again.
  fit-paint -q -b "$basis" out.xml -o again.xml
}

@test "--views auto gives weights by view to paints that contradict themselves, and the floor is told without" {
  two_sided="${row/\/>/\/><lab geometry=\"45as-15\" L=\"70\" a=\"40\" b=\"10\"\/>}"
  echo "$head$one<paint name=\"shift\"><measurement illuminant=\"D65\" observer=\"10\">$two_sided</measurement></paint></paints>" >s.xml
  run fit-paint -b "$basis" --views auto s.xml -o out.xml --report r.json
  [ "$status" -eq 0 ]
  [ "$(grep -c '<view angle=' out.xml)" -eq 2 ]
  grep -q '<view angle="30"' out.xml
  grep -q '<view angle="60"' out.xml
  [[ ! "$output" =~ "contradict" ]]
  awk -v e="$(number de00_p95)" 'BEGIN { exit !(e < 1) }'
  run fit-paint -b "$basis" s.xml -o out.xml --report r.json
  [ "$status" -eq 0 ]
  [ "$(grep -c '<view angle=' out.xml)" -eq 0 ]
  [[ "$output" =~ "1 paints contradict themselves at one aspecular angle: no weights for all views come below dE00 mean "[1-9] ]]
  [ "$(number contradicting)" = 1 ]
  awk -v floor="$(grep '"floor_de00_p95"' r.json | tr -dc 0-9.)" 'BEGIN { exit !(floor > 3) }'
  # One that agrees with itself says nothing of it.
  echo "$head$one</paints>" >one.xml
  run fit-paint -b "$basis" one.xml -o out.xml
  [[ ! "$output" =~ "contradict" ]]
}

@test "the worst paints are named with the reason" {
  bad=
  for k in 1 2 3 4 5 6 7; do
    bad+="<paint name=\"bad$k\"><measurement illuminant=\"D65\" observer=\"10\"><lab geometry=\"45as15\" L=\"30\" a=\"0\" b=\"0\"/><lab geometry=\"45as45\" L=\"$((40 + 3 * k))\" a=\"0\" b=\"0\"/></measurement></paint>"
  done
  echo "$head$one$bad</paints>" >bad.xml
  run --separate-stderr fit-paint -b "$basis" bad.xml -o out.xml --report r.json
  [ "$status" -eq 0 ]
  [[ "$stderr" =~ "(bad7 at 45as"[0-9]+": its red grows by" ]]
  [ "$(grep -c '^  then ' <<<"$stderr")" -eq 4 ]
  [[ ! "$stderr" =~ bad2 ]]
  [ "$(sed -n '/"worst"/,/\]/p' r.json | grep -c '"limit"')" -eq 5 ]
}

@test "a measured BRDF tells how well five of its angles predict the others" {
  cornell metal.brdf
  run fit-paint -b "$basis" metal.brdf -o out.xml --report r.json
  [ "$status" -eq 0 ]
  [[ "$output" =~ "with a median relative error of 0.0"[0-9]+", five angles predict those to 60 deg with 0.0" ]]
  # Its color is a function of the aspecular angle; what is left is that b7 has no exponent 10.
  awk -v a="$(number by_aspecular)" -v f="$(number by_flake)" 'BEGIN { exit !(a < 0.025 && f > 1.3 * a) }'
}

@test "--gloss takes several meters, and the misfit of each is told" {
  echo "$head$one</paints>" >one.xml
  fit-paint -q -b "$basis" --gloss 20:30,60:70,85:90 one.xml -o out.xml --report r.json
  [ "$(grep -c '"misfit_gu"' r.json)" -eq 3 ]
  [ "$(grep -c '"simulated_gu"' r.json)" -eq 3 ]
}

@test "readings that only a coat would keep from being met are met by views, and told with --views none" {
  run --separate-stderr fit-paint -b "$basis" --views none "$paints" -o none.xml --report r.json
  lost=$(sed -nE 's/^    "lost_to_coat": ([0-9]+),?$/\1/p' r.json)
  [ "$lost" -gt 0 ]
  [[ "$stderr" =~ "$lost readings that lobes meet without a coat are off by up to dE00 1."[0-9]+" under it".*"--views lost meets them" ]]
  [ "$(jq '[.results.paints[].lost_to_coat[]] | length' r.json)" -eq "$lost" ]
  jq -e '.results.paints[] | select(.name == "reference_gray") | .lost_to_coat["45as110"] > 1 and .views_for_coat == false' r.json
  jq -e '.results.paints[] | select(.name == "reference_gray") | .limit | test("under the coat grows by 9 %")' r.json
  names=$(jq -r '[.results.paints[] | select(.lost_to_coat != {}) | .name] | join(" ")' r.json)
  fit-paint -q -b "$basis" --coat none "$paints" -o out.xml --report r.json
  jq -e '.results.lost_to_coat == 0 and ([.results.paints[].lost_to_coat[]] == []) and .results.views_for_coat == 0' r.json
  for views in lost auto; do
    run --separate-stderr fit-paint -b "$basis" --views "$views" "$paints" -o "$views.xml" --report r.json
    [[ ! "$stderr" =~ "under it" ]]
    jq -e '.results.lost_to_coat == 0' r.json
    jq -e '.results.paints[] | select(.name == "reference_gray") | .de00_max < 1e-6 and .views_for_coat' r.json
  done
  # lost is the default. Paints that lose nothing are the same as without it.
  run --separate-stderr fit-paint -b "$basis" "$paints" -o out.xml --report r.json
  [[ "$stderr" =~ "$(wc -w <<<"$names") paints have weights for the views of their readings" ]]
  cmp <(grep -v "<processing" out.xml) <(grep -v "<processing" lost.xml)
  [ "$(jq -r '[.results.paints[] | select(.views_for_coat) | .name] | join(" ")' r.json)" = "$names" ]
  diff <(sed '/<view /,/<\/view>/d' lost.xml) <(sed '/<view /,/<\/view>/d' none.xml) >changed || true
  [ "$(grep -c '^< .*<lobes ' changed)" -eq "$(wc -w <<<"$names")" ]
  # By the least color difference too.
  fit-paint -q -b "$basis" --method deltae "$paints" -o out.xml --report r.json
  jq -e '.results.paints[] | select(.name == "reference_gray") | .de00_max < 0.05 and .views_for_coat' r.json
}

@test "--paint-time-limit stops a paint, writes the best and exits 4" {
  cornell metal.brdf
  run fit-paint -b "$basis" --method deltae --paint-time-limit 0.000001 metal.brdf -o out.xml --report r.json
  [ "$status" -eq 4 ]
  grep -q '"status": "time_limit"' r.json
  grep -q '<lobes ' out.xml
  fit-paint -q -b "$basis" --method l2 --paint-time-limit 60 metal.brdf -o out.xml
}

@test "wrong values of the newer options name what is right" {
  for wrong in "--gloss 45:80" "--gloss 60:80,60:90" "--gloss 60:" "--lobes -1" "--lobes few" "--prune x" \
    "--views 30" "--views 30,15" "--views 0,100" "--views a,b" "--views automatic" "--steepest 91" "--paint-time-limit -1"; do
    # shellcheck disable=SC2086
    run fit-paint -b "$basis" $wrong "$paints" -o out.xml
    [ "$status" -eq 2 ]
    [[ "$output" =~ ${wrong%% *} ]]
    [ ! -e out.xml ]
  done
}

@test "--color-map writes a map of each paint; missing and wrong folders are refused" {
  run fit-paint -b "$basis" "$paints" -o out.xml --color-map
  [ "$status" -eq 2 ]
  touch file
  run --separate-stderr fit-paint -b "$basis" "$paints" -o out.xml --color-map file
  [ "$status" -eq 3 ]
  [[ "$stderr" =~ "file: is no folder" ]]
  [ ! -e out.xml ]
  rows=
  for light in 25 45 65; do
    for aspecular in 15 30 60 90; do
      rows+="<lab geometry=\"${light}as$aspecular\" L=\"$((80 - aspecular / 2))\" a=\"$((light - 40))\" b=\"-20\"/>"
    done
  done
  several="<paint name=\"sea green/1\"><measurement illuminant=\"D65\" observer=\"10\">$rows</measurement></paint>"
  mkdir deep
  echo "$head$one$several</paints>" >in.xml
  run --separate-stderr fit-paint -b "$basis" in.xml -o deep/out.xml --color-map deep/maps --report r.json
  [ "$status" -eq 0 ]
  [[ "$stderr" =~ 'in.xml:1: paint "one" gets no color map: a color map takes 4 readings' ]]
  [[ "$stderr" =~ 1\ color\ maps,\ [01]\ of\ them\ by\ the\ aspecular\ angle\ alone,\ mean\ dE76\ of\ a\ reading\ predicted ]]
  [ -s deep/maps/sea_green_1.exr ]
  grep -q '<colorMap href="maps/sea_green_1.exr" index="1.5"/>' deep/out.xml
  [ "$(grep -c '<colorMap' deep/out.xml)" -eq 1 ]
  [ "$(number rows)" = 12 ]
  [ "$(number without_color_map)" = 1 ]
  [ "$(number compared_rows)" = 12 ]
}

@test "--color-map-model takes the better model or the one that is told; missing and wrong ones are refused" {
  # L* falls with the aspecular angle in air, and is the same at every light.
  rows=
  for light in 20 30 45 60; do
    for aspecular in 15 25 40 60 90; do
      rows+="<lab geometry=\"${light}as$aspecular\" L=\"$((90 - aspecular / 2))\" a=\"10\" b=\"5\"/>"
    done
  done
  echo "$head<paint name=\"matt\"><measurement illuminant=\"D65\" observer=\"10\">$rows</measurement></paint></paints>" >in.xml
  for model in better isolines aspecular; do
    fit-paint -q -b "$basis" in.xml -o out.xml --color-map "$model" --color-map-model "$model" --report "$model.json"
  done
  grep -q '"model": "aspecular"' better.json
  grep -q '"model": "isolines"' isolines.json
  grep -q '"model": "aspecular"' aspecular.json
  [ "$(oiiotool --info -v isolines/matt.exr | grep -c 'goniochrome:model: "isolines"')" -eq 1 ]
  run fit-paint -b "$basis" in.xml -o out.xml --color-map maps --color-map-model
  [ "$status" -eq 2 ]
  run fit-paint -b "$basis" in.xml -o out.xml --color-map maps --color-map-model best
  [ "$status" -eq 2 ]
}

@test "a paint with gloss gets a coat, and --coat decides otherwise" {
  glossy=${one/<\/measurement>/<\/measurement><gloss angle=\"60\">92<\/gloss>}
  echo "$head$one</paints>" >matt.xml
  echo "$head$glossy</paints>" >glossy.xml
  fit-paint -q -b "$basis" matt.xml -o out.xml
  [ "$(grep -c '<coat' out.xml)" -eq 0 ]
  fit-paint -q -b "$basis" matt.xml --gloss 40 -o out.xml
  grep -q '<coat index="1.5"/>' out.xml
  # A smooth coat of 1.5 reads 89 GU: 92 ask for more.
  fit-paint -q -b "$basis" glossy.xml -o out.xml
  grep -Eq '<coat index="1\.51' out.xml
  # Its gloss would imply a coat in the next tool.
  fit-paint -q -b "$basis" glossy.xml --coat none -o out.xml
  grep -q '<coat index="1"/>' out.xml
  fit-paint -q -b "$basis" matt.xml --coat none -o out.xml
  [ "$(grep -c '<coat' out.xml)" -eq 0 ]
  fit-paint -q -b "$basis" matt.xml --coat 1.6 -o out.xml
  grep -q '<coat index="1.6"/>' out.xml
  # Statements of a paint stay, also that it has none.
  sed 's/<gloss/<coat index="1"\/><gloss/' glossy.xml | fit-paint -q -b "$basis" -o out.xml
  grep -q '<coat index="1"/>' out.xml
  run fit-paint -b "$basis" matt.xml --coat 1.2
  [ "$status" -eq 2 ]
  [[ "$output" =~ "give auto, none, or the index of the coat from 1.5 to 1.7" ]]
}

@test "--illuminant fits the colors of that light, and passes on unfitted what has no spectra" {
  factors=$(awk 'BEGIN { for (nm = 400; nm <= 700; nm += 10) printf "%s%g", (nm > 400 ? " " : ""), 0.1 + 0.5 / (1 + exp((590 - nm) / 15)) }')
  spectra=
  for angle in 15 45 110; do
    spectra+="<spectrum geometry=\"45as$angle\" from=\"400\" step=\"10\" to=\"700\">$factors</spectrum>"
  done
  echo "$head<paint name=\"red\"><measurement illuminant=\"D65\" observer=\"10\">$row$spectra</measurement></paint>$one</paints>" >two.xml
  run --separate-stderr fit-paint --basis "$basis" --illuminant A two.xml -o lit.xml
  [ "$status" -eq 1 ]
  [[ "$stderr" == *'paint "one" is passed on unfitted: it has no spectra'* ]]
  [ "$(grep -c '<lobes ' lit.xml)" -eq 1 ]
  # The result is that by way of paint-convert.
  paint-convert -q two.xml#red --illuminant A | fit-paint -q --basis "$basis" -o piped.xml
  diff <(sed -n '/<paint name="red"/,/<\/paint>/p' lit.xml) <(sed -n '/<paint name="red"/,/<\/paint>/p' piped.xml)
  grep -q 'illuminant="A"' lit.xml
  for name in a INCA A/10; do
    fit-paint -q --basis "$basis" --illuminant $name two.xml#red -o named.xml
    diff <(grep '<lobe\|<measurement' named.xml) <(grep '<lobe\|<measurement' piped.xml)
  done
  run fit-paint --basis "$basis" --illuminant B two.xml
  [ "$status" -eq 2 ]
  run fit-paint --basis "$basis" --illuminant A,F11 two.xml
  [ "$status" -eq 2 ]
  [[ "$output" == *"give one, and run once for each"* ]]
}

@test "a map that six readings do not support gets no tilted lobes, unless isolines are asked for" {
  fit-paint -q -b "$basis" "$TESTDATA/paints.paints.xml#candy_red" -o out.xml --color-map maps --tilts 2 --report r.json
  run ! grep -q '<tilts' out.xml
  jq -e '.results.without_tilts == 1 and (.results.color_maps[0].model == "isolines")' r.json
  fit-paint -q -b "$basis" "$TESTDATA/paints.paints.xml#candy_red" -o out.xml --color-map maps --tilts 2 \
    --color-map-model isolines --report r.json
  jq -e '.results.without_tilts == 0 and (.results.tilts | length == 1)' r.json
}

@test "--tilts makes sets of tilted lobes where a color map travels; missing and wrong counts are refused" {
  fit-paint -q -b "$basis" "$TESTDATA/travel.paints.xml" -o out.xml --color-map maps --tilts 6,10 --report r.json
  [ "$(grep -c '<tilts xmlns="urn:goniochrome:tilts:1">' out.xml)" -eq 2 ]
  [ "$(grep -c '<set mean_de00=' out.xml)" -eq 4 ]
  # The finer set is closer to the map, and both are closer than the lobes.
  jq -e '.results.tilts | all(.lobes_de00 > .sets[0].de00_mean and .sets[0].de00_mean > .sets[1].de00_mean)' r.json
  jq -e '.results.tilts | all(.sets[0].lookups <= 6 and .sets[1].lookups <= 10)' r.json
  # A paint that names its map gets its sets again without --color-map, with the same axes.
  fit-paint -q -b "$basis" out.xml -o again.xml --tilts 6,10
  diff <(grep 'tilt=' out.xml) <(grep 'tilt=' again.xml)
  fit-paint -q -b "$basis" out.xml -o none.xml --tilts none
  run ! grep -q '<tilts' none.xml
  rm maps/film_gold_teal.exr
  run --separate-stderr fit-paint -b "$basis" out.xml -o lost.xml --tilts 6
  [ "$status" -eq 0 ]
  [[ "$stderr" =~ 'paint "film_gold_teal" gets no tilted lobes: ' ]]
  [ "$(grep -c '<tilts' lost.xml)" -eq 1 ]
  for wrong in 0 65 8,8 16,8 8, all; do
    run fit-paint -b "$basis" out.xml -o wrong.xml --tilts "$wrong"
    [ "$status" -eq 2 ]
    [[ "$output" =~ "--tilts \"$wrong\"" ]]
    [ ! -e wrong.xml ]
  done
  run fit-paint -b "$basis" out.xml -o wrong.xml --tilts
  [ "$status" -eq 2 ]
}

@test "the report tells what two angles of incidence say of each other" {
  cat >two.xml <<'XML'
<?xml version="1.0"?><paints xmlns="urn:goniochrome:paint:1" version="1"><paint name="two"><measurement illuminant="D65" observer="10">
<lab geometry="45as15" L="60" a="1" b="2"/><lab geometry="45as45" L="35" a="1" b="2"/><lab geometry="45as110" L="20" a="1" b="2"/>
<lab geometry="15as15" L="66" a="1" b="2"/><lab geometry="15as45" L="40" a="1" b="2"/></measurement></paint></paints>
XML
  fit-paint -q -b "$TESTDATA/b7.basis.xml" two.xml -o /dev/null --report r.json
  jq -e '.results.paints[0].incidences | map([.incidence_deg, .readings]) == [[15, 2], [45, 3]]' r.json
  jq -e '.results.paints[0].incidences | all(.predicted_de00_mean > .de00_mean and .predicted_de00_mean > 1)' r.json
  fit-paint -q -b "$TESTDATA/b7.basis.xml" "$TESTDATA/paints.paints.xml#silver_fine" -o /dev/null --report r.json
  jq -e '.results.paints[0] | has("incidences") | not' r.json
}

@test "an input without a paint is told, and the exit status is 1" {
  run --separate-stderr bash -c "echo '$head</paints>' | fit-paint -b '$basis'"
  [ "$status" -eq 1 ]
  [[ "$stderr" == *"the input holds no paints: nothing was fitted"* ]]
}
