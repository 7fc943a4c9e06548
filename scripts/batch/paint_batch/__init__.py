"""The steps of a batch over a paint library."""
