"""The parts of paint-batch: planning, the steps of a shard, and the merged report."""
