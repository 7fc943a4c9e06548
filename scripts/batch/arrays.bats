#!/usr/bin/env bats
# paint-batch slurm through a Slurm of one node without accounting, as root, while the node dies.

batch() {
  "$BATS_TEST_DIRNAME/paint-batch" "$@"
}

# plan OUT: 16 shards with small pictures.
plan() {
  batch plan library.paints.xml --out "$1" --size 64x48 --env-size 16 --basis "$TESTDATA/b5.basis.xml" --shard-paints 4 --chapter 40
}

# count WORD: how often the logs of the shards have the word.
count() {
  cat farmed/shards/*/log 2>/dev/null | grep -c "$1" || true
}

setup() {
  command -v slurmctld >/dev/null && command -v slurmd >/dev/null && command -v munged >/dev/null || skip "slurmctld, slurmd and munge are not installed"
  [ "$(id -u)" -eq 0 ] || skip "only root can start a Slurm"
  cd "$BATS_TEST_TMPDIR"
  export SLURM_CONF=$PWD/slurm/slurm.conf
  paint-convert -q "$TESTDATA/paints.paints.xml" -o library.paints.xml
}

teardown() {
  [ ! -d slurm ] || "$BATS_TEST_DIRNAME/slurm/one-node" stop slurm
}

@test "a node is killed: all shards are done, none twice, and the report is that of a batch without Slurm" {
  plan plain
  for n in $(batch list plain); do batch shard plain "$n"; done
  batch merge plain
  "$BATS_TEST_DIRNAME/slurm/one-node" start slurm 3>&-
  plan farmed
  # Tasks of a single shard, so that there are many of them.
  timeout 300 "$BATS_TEST_DIRNAME/paint-batch" slurm farmed --task-s 0.01 >said 2>&1 3>&- &
  command=$!
  for _ in {1..600}; do [ "$(count finished)" -ge 2 ] && [ "$(count begun)" -gt "$(count finished)" ] && break || sleep 0.05; done
  "$BATS_TEST_DIRNAME/slurm/one-node" node kill slurm
  sleep 1
  "$BATS_TEST_DIRNAME/slurm/one-node" node start slurm 3>&-
  status=0
  wait "$command" || status=$?
  cat said >&2
  [ "$status" -eq 0 ]
  cmp plain/report.tsv farmed/report.tsv
  cmp plain/report.json farmed/report.json
  cmp plain/fitted.paints.xml farmed/fitted.paints.xml
  diff -r plain/pictures farmed/pictures
  shards=$(find farmed/shards -name done.json | wc -l)
  [ "$shards" -eq "$(jq '.shards | length' farmed/plan.json)" ]
  [ "$(count finished)" -eq "$shards" ]
  [ "$(count begun)" -gt "$shards" ]
  [[ "$(head -n 1 said)" =~ "cost: $shards of $shards shards in an array of $shards tasks".*core-hours ]]
  [[ "$(tail -n 1 said)" =~ "core-hours in tools".*estimated ]]
  [ -s farmed/book-001.html ]
  # What is done is not sent again, which needs no Slurm.
  run batch slurm farmed
  [ "$status" -eq 0 ]
  [[ ! "$output" =~ "shards in an array" ]]
}

@test "without Slurm, what to install is said" {
  plan alone
  mkdir -p bin
  for tool in bash env python3; do ln -sf "$(command -v $tool)" bin/; done
  run env PATH="$PWD/bin" "$BATS_TEST_DIRNAME/paint-batch" slurm alone
  [ "$status" -eq 3 ]
  [[ "$output" =~ "is not in PATH: run this where Slurm's commands are" ]]
}
