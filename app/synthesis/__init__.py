"""Texture synthesis with numpy and scipy: arrays in, arrays out. One algorithm is one file, named as in the article."""

__version__ = "0.1.0"  # of the library and of the service
