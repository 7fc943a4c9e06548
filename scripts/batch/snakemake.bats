#!/usr/bin/env bats
# scripts/batch under Snakemake on one machine: it is killed and continued.

load engines_test

@test "a batch that is killed twice and continued has the same report, byte for byte" {
  plan killed
  for done in 2 6; do
    setsid bash -c "$(declare -f local_run); BATS_TEST_DIRNAME=$BATS_TEST_DIRNAME local_run killed" >/dev/null 2>&1 3>&- &
    leader=$!
    until_done killed "$done"
    kill -9 -- "-$leader"
    wait "$leader" || true
    [ ! -e killed/report.json ]
  done
  local_run killed
  same_as_undisturbed killed
}
