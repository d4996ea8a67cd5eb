"""Texture synthesis, pure: numpy and scipy only, arrays in, arrays out; one algorithm, one file."""

__version__ = "0.1.0"  # of the library and of the service
