"""The parts of scripts/paint-book."""
