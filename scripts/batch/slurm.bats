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

begun() {
  cat "$1"/shards/*/log | grep -c begun
}

finished() {
  find "$1/shards" -name done.json | wc -l
}

teardown() {
  "$BATS_TEST_DIRNAME/slurm/one-node" stop slurm
}

@test "through Slurm, a job and the controller killed: the same report, every shard finished once" {
  export SLURM_CONF=$PWD/slurm/slurm.conf
  "$BATS_TEST_DIRNAME/slurm/one-node" start slurm 3>&-
  plan farmed
  slurm_run farmed >slurm.said 2>&1 3>&- &
  workflow=$!
  until_done farmed 1
  scancel --signal=KILL --full "$(squeue -h -t running -o %i | head -n 1)"
  # The controller writes its state every 5 s; what it forgets it learns from the node only minutes later.
  until_done farmed 2
  sleep 6
  "$BATS_TEST_DIRNAME/slurm/one-node" controller kill slurm
  sleep 2
  "$BATS_TEST_DIRNAME/slurm/one-node" controller start slurm 3>&-
  wait "$workflow"
  same_as_undisturbed farmed
  # Only the shards of the two jobs that ran when one was killed can have been begun again.
  [ "$(begun farmed)" -le $(($(finished farmed) + 2)) ]
}
