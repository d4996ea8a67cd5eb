"""Settings of a command, read from the environment."""

from pydantic import ValidationError

from app.errors import InvalidInputError
from app.settings import Settings


def read_settings() -> Settings:
    """Read the settings from the environment.

    Raises
    ------
    InvalidInputError
        Naming the variable at fault.
    """
    try:
        return Settings()
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        variable = "_".join(["MICROTEXTURE", *(str(part).upper() for part in first["loc"])])
        raise InvalidInputError(f"{variable} is set wrongly: {first['msg']}.") from None
