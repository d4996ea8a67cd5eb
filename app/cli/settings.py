"""Settings of a command, read from the environment."""

from pydantic import ValidationError

from app.child_environment import keep_allowed
from app.errors import InvalidInputError
from app.settings import Settings


def read_settings(*, for_children: bool = False) -> Settings:
    """Read the settings from the environment.

    Parameters
    ----------
    for_children : bool
        Whether this process will start others: it then keeps only those variables that they are given.

    Raises
    ------
    InvalidInputError
        Naming the variable at fault.
    """
    try:
        settings = Settings()
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        variable = "_".join(["MICROTEXTURE", *(str(part).upper() for part in first["loc"])])
        raise InvalidInputError(f"{variable} is set wrongly: {first['msg']}.") from None
    if for_children:
        keep_allowed()
    return settings
