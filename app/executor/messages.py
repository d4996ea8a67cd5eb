"""User-facing messages for runs that the executor stopped: time limit, lost worker."""

BROKEN = "Something went wrong inside the method. This is a fault of the service, not yours."
LOST = (
    "Running this experiment ended its worker process twice, most likely for want of memory: "
    "try a smaller width and height, or another crop."
)


def out_of_time(seconds: float) -> str:
    """Words for a run that took longer than this.

    Examples
    --------
    >>> out_of_time(300)
    'This run took longer than 300 seconds: make the texture smaller.'
    """
    return f"This run took longer than {seconds:g} seconds: make the texture smaller."
