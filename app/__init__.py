"""Microtexture: texture synthesis by example, as a web service, a REST API and a command line."""
