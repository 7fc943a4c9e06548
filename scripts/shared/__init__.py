"""What several scripts share. Whoever imports it has standard input, output and error, be it only ones that fail."""

from shared.files import open_closed_descriptors

open_closed_descriptors()
