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
  plan farmed 8
  slurm_run farmed >slurm.said 2>&1 3>&- &
  workflow=$!
  until_done farmed 1
  for _ in {1..600}; do [ "$(begun farmed)" -gt "$(finished farmed)" ] && break || sleep 0.05; done
  for job in $(squeue -h -t running -o %i); do scancel --signal=KILL --full "$job"; done
  until_done farmed 3
  "$BATS_TEST_DIRNAME/slurm/one-node" controller kill slurm
  sleep 2
  "$BATS_TEST_DIRNAME/slurm/one-node" controller start slurm 3>&-
  wait "$workflow"
  same_as_undisturbed farmed
  # A shard was in work when its job was killed and was begun again; the two running then are all that were.
  [ "$(begun farmed)" -gt "$(finished farmed)" ]
  [ "$(begun farmed)" -le $(($(finished farmed) + 2)) ]
}
