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

teardown() {
  "$BATS_TEST_DIRNAME/slurm/one-node" stop slurm
}

@test "through Slurm, a job and the controller killed: the same report, every shard finished once" {
  export SLURM_CONF=$PWD/slurm/slurm.conf
  "$BATS_TEST_DIRNAME/slurm/one-node" start slurm
  plan farmed 8
  slurm_run farmed >slurm.said 2>&1 3>&- &
  workflow=$!
  until_done farmed 1
  scancel --signal=KILL --full "$(squeue -h -t running -o %i | head -n 1)"
  until_done farmed 3
  "$BATS_TEST_DIRNAME/slurm/one-node" controller kill slurm
  sleep 2
  "$BATS_TEST_DIRNAME/slurm/one-node" controller start slurm
  wait "$workflow"
  same_as_undisturbed farmed
  # A shard that was begun again is one whose job was killed; none was written twice.
  [ "$(cat farmed/shards/*/log | grep -c begun)" -le $(($(find farmed/shards -name done.json | wc -l) + 2)) ]
}
