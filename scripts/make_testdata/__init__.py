"""What scripts/make-testdata makes; each kind of file has its module."""
