# What snakemake.bats and slurm.bats share.

batch() {
  "$BATS_TEST_DIRNAME/paint-batch" "$@"
}

# local_run OUT: runs the workflow on two cores of this machine.
local_run() {
  snakemake -s "$BATS_TEST_DIRNAME/Snakefile" --config "out=$1" --cores 2 --keep-going --rerun-incomplete --nolock --quiet all
}

slurm_run() {
  timeout -k 5 200 snakemake -s "$BATS_TEST_DIRNAME/Snakefile" --config "out=$1" --profile "$BATS_TEST_DIRNAME/slurm" --nolock
}

# plan OUT [N]: plans shards of N paints with small pictures.
plan() {
  batch plan library.paints.xml --out "$1" --size 64x48 --env-size 16 --basis "$TESTDATA/b5.basis.xml" --shard-paints "${2:-4}"
}

same_as_undisturbed() {
  cmp undisturbed/report.tsv "$1/report.tsv"
  cmp undisturbed/report.json "$1/report.json"
  cmp undisturbed/fitted.paints.xml "$1/fitted.paints.xml"
  diff -r undisturbed/pictures "$1/pictures"
}

# until_done OUT N: waits until N shards are done.
until_done() {
  for _ in {1..1800}; do
    [ "$(find "$1/shards" -name done.json 2>/dev/null | wc -l)" -ge "$2" ] && return
    sleep 0.1
  done
  return 1
}

# undisturbed: makes the batch with which the others are compared.
undisturbed() {
  cp "$TESTDATA/paints.paints.xml" library.paints.xml
  plan undisturbed
  local_run undisturbed
}

# Bats 1.8 takes a skip in setup_file for a failure.
setup_file() {
  command -v snakemake >/dev/null || return 0
  cd "$BATS_FILE_TMPDIR"
  undisturbed
}

setup() {
  command -v snakemake >/dev/null || skip "snakemake is not installed"
  cd "$BATS_FILE_TMPDIR"
}
