"""The quantiles of a set of figures."""


def quantile(values, share):
    """The value that stands at `share` (0 to 1) of the sorted values, or the next smaller one; None if there are no values."""
    ordered = sorted(values)
    return ordered[int(share * (len(ordered) - 1))] if ordered else None
