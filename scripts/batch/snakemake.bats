#!/usr/bin/env bats
# scripts/batch under Snakemake on one machine: killed and taken up again.

load engines_test

setup_file() {
  cd "$BATS_FILE_TMPDIR"
  undisturbed
}

setup() {
  cd "$BATS_FILE_TMPDIR"
}

@test "killed twice and taken up again: the same report, byte for byte" {
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
