"""Texture synthesis, pure: numpy and scipy only, arrays in, arrays out; one algorithm, one file."""
