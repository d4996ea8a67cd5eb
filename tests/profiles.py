"""Hypothesis profiles: on how many examples a property is tried. `ci` is the default, `quick` takes a tenth of it."""

from hypothesis import settings

EXAMPLES = {"ci": 100, "quick": 10}


def register() -> None:
    """Name the profiles and choose `ci`. The examples are the same in every run, so that none fails by chance."""
    for name, examples in EXAMPLES.items():
        settings.register_profile(name, max_examples=examples, deadline=None, derandomize=True, database=None)
    settings.load_profile("ci")


def examples(number: int) -> int:
    """How many examples of a property are tried where `ci` tries ``number``: by the profile that is loaded."""
    return max(1, number * settings().max_examples // EXAMPLES["ci"])
