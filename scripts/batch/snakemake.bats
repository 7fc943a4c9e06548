#!/usr/bin/env bats
# scripts/batch under Snakemake on one machine: it is killed and continued.

load engines_test

@test "a batch that is killed twice and continued has the same report, byte for byte" {
  plan killed
  for done in 2 6; do
    setsid bash -c "$(declare -f local_run); BATS_TEST_DIRNAME=${BATS_TEST_DIRNAME@Q} local_run killed" >/dev/null 2>&1 3>&- &
    leader=$!
    until_done killed "$done"
    kill -9 -- "-$leader"
    wait "$leader" || true
    [ ! -e killed/report.json ]
  done
  local_run killed
  same_as_undisturbed killed
}

@test "folders whose names hold blanks, quotes and commands are names and no more" {
  # The shell must not see any of this: the folder of the batch, that of the library, and that of the scripts.
  odd="it's a \"place\" \$(touch ran-1) \`touch ran-2\`; touch ran-3 & {OUT} *"
  mkdir "$odd"
  cp library.paints.xml "$odd/library.paints.xml"
  ln -s "$BATS_TEST_DIRNAME/../.." "$odd/checkout of 'me'"
  scripts="$odd/checkout of 'me'/scripts/batch"
  "$scripts/paint-batch" plan "$odd/library.paints.xml" --out "$odd/batch" --size 64x48 --env-size 16 --basis "$TESTDATA/b5.basis.xml" --shard-paints 4
  snakemake -s "$scripts/Snakefile" --config "out=$odd/batch" --cores 2 --nolock --quiet all
  same_as_undisturbed "$odd/batch"
  run find . -name 'ran-*'
  [ -z "$output" ]
}
