#!/usr/bin/env bats
# scripts/batch under Snakemake through a Slurm of one node, as root, while a job and the controller die.

load engines_test

# count WORD OUT: how often the logs of the shards have the word.
count() {
  cat "$2"/shards/*/log | grep -c "$1" || true
}

pictures() {
  find "$1/pictures" -name '*.png' -printf '%p %i\n' | sort
}

teardown() {
  "$BATS_TEST_DIRNAME/slurm/one-node" stop slurm
}

@test "jobs and the controller of Slurm are killed: the same report, nothing is lost, nothing is done twice" {
  export SLURM_CONF=$PWD/slurm/slurm.conf
  "$BATS_TEST_DIRNAME/slurm/one-node" start slurm 3>&-
  plan farmed 8
  slurm_run farmed >slurm.said 2>&1 3>&- &
  workflow=$!
  until_done farmed 1
  # Jobs are killed when a shard has just begun. What other shards have finished by then must not be made again.
  for _ in {1..2400}; do [ "$(count begun farmed)" -ge 3 ] && break || sleep 0.05; done
  pictures farmed >drawn
  scancel --signal=KILL --full --state=RUNNING --user=root
  until_done farmed 3
  # The controller is killed at any moment; of its last 5 s it may not have written any state.
  "$BATS_TEST_DIRNAME/slurm/one-node" controller kill slurm
  sleep 2
  "$BATS_TEST_DIRNAME/slurm/one-node" controller start slurm 3>&-
  wait "$workflow"
  same_as_undisturbed farmed
  pictures farmed | comm -23 drawn - >drawn_again
  [ -s drawn ]
  [ ! -s drawn_again ]
  shards=$(find farmed/shards -name done.json | wc -l)
  [ "$(count finished farmed)" -eq "$shards" ]
  # Only shards whose job was killed begin again: at most the two killed above, and two that the controller has forgotten.
  [ "$(count begun farmed)" -gt "$shards" ]
  [ "$(count begun farmed)" -le $((shards + 4)) ]
}
