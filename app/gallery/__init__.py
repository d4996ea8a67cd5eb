"""Gallery: the catalogue, the figures of the literature and the figures of every method."""
