#!/usr/bin/env bats
# scripts/batch under Snakemake through a Slurm of one node, as root, while a job and the controller die.

load engines_test

setup_file() {
  cd "$BATS_FILE_TMPDIR"
  undisturbed
}

setup() {
  cd "$BATS_FILE_TMPDIR"
}

# count WORD OUT: how often the logs of the shards say it.
count() {
  cat "$2"/shards/*/log | grep -c "$1" || true
}

pictures() {
  find "$1/pictures" -name '*.png' -printf '%p %i\n' | sort
}

teardown() {
  "$BATS_TEST_DIRNAME/slurm/one-node" stop slurm
}

@test "through Slurm, jobs and the controller killed: the same report, nothing lost, nothing done twice" {
  export SLURM_CONF=$PWD/slurm/slurm.conf
  "$BATS_TEST_DIRNAME/slurm/one-node" start slurm 3>&-
  plan farmed 8
  slurm_run farmed >slurm.said 2>&1 3>&- &
  workflow=$!
  until_done farmed 1
  # Jobs are killed as a shard begins that has all its work before it: what is finished by then is not made again.
  for _ in {1..2400}; do [ "$(count begun farmed)" -ge 3 ] && break || sleep 0.05; done
  pictures farmed >drawn
  scancel --signal=KILL --full --state=RUNNING --user=root
  until_done farmed 3
  # The controller is killed at any moment, with up to 5 s of which it has written no state.
  "$BATS_TEST_DIRNAME/slurm/one-node" controller kill slurm
  sleep 2
  "$BATS_TEST_DIRNAME/slurm/one-node" controller start slurm 3>&-
  wait "$workflow"
  same_as_undisturbed farmed
  pictures farmed | comm -23 drawn - >drawn_again
  [ -s drawn ] && [ ! -s drawn_again ]
  shards=$(find farmed/shards -name done.json | wc -l)
  [ "$(count finished farmed)" -eq "$shards" ]
  # Begun again are shards whose job was killed: at most two by hand, and two that the controller had forgotten.
  [ "$(count begun farmed)" -gt "$shards" ]
  [ "$(count begun farmed)" -le $((shards + 4)) ]
}
