"""What scripts/make-testdata makes, one module for each kind of file."""
