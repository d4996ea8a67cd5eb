"""User-facing messages for runs that the executor stopped: time limit, lost worker."""

LOST = (
    "Try a smaller width and height, or another crop: running this experiment ended its worker process twice, "
    "most likely for want of memory."
)


def out_of_time(seconds: float) -> str:
    """Say that a run took longer than this.

    Examples
    --------
    >>> out_of_time(300)
    'Make the texture smaller: this run took longer than 300 seconds.'
    """
    return f"Make the texture smaller: this run took longer than {seconds:g} seconds."
