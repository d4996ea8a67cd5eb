"""Dependencies of the routes: service, settings, the owner's token and cookie."""

import re
from typing import Annotated, cast

from fastapi import Depends, Request
from starlette.responses import Response

from app.errors import InvalidInputError
from app.experiments.service import Service
from app.experiments.tokens import derive_token, is_same_secret, new_token
from app.settings import Settings
from app.web.headers import API_PREFIX

OWNER_COOKIE = "microtexture_owner"
GUESSABLE = (
    "Send an Authorization: Bearer token of 16 to 512 visible ASCII characters that nobody can guess, "
    "or none at all: you are then given one."
)
_COOKIE_SECONDS = 400 * 24 * 3600  # browsers keep no cookie for longer
_TOKEN = re.compile(r"[!-~]{16,512}")
_READING = {"GET", "HEAD"}
_PRESS = re.compile(r"[0-9a-f]{48}")


def get_service(request: Request) -> Service:
    return cast(Service, request.app.state.service)


def get_settings(request: Request) -> Settings:
    return cast(Settings, request.app.state.settings)


def owner_token(request: Request) -> str | None:
    """Find the token of who is asking: from ``Authorization: Bearer``, else from the cookie.

    Raises
    ------
    InvalidInputError
        If a program sends a token that somebody could guess, or that is none, with what changes something.
    """
    scheme, _, bearer = request.headers.get("authorization", "").partition(" ")
    if scheme.lower() == "bearer":
        token = bearer.strip()
        if _TOKEN.fullmatch(token) or is_operator(request, token):
            return token
        if request.scope["path"].startswith(API_PREFIX) and request.method not in _READING:
            raise InvalidInputError(GUESSABLE, "authorization")
    token = request.cookies.get(OWNER_COOKIE, "").strip()
    return token if _TOKEN.fullmatch(token) else None


def is_operator(request: Request, token: str) -> bool:
    """Whether this is the operator's token, which is as long as the operator made it."""
    secret = get_settings(request).operator_token
    return secret is not None and is_same_secret(token, secret.get_secret_value())


def read_press(text: str) -> str | None:
    """Read the key that `static/js/pages/press.js` puts into a form; what is none counts as not said."""
    return text if _PRESS.fullmatch(text) else None


def choose_owner(token: str | None, press: str | None) -> str:
    """Give who is asking a token; the same one for a press that comes twice before its answer brings the cookie."""
    return token or (derive_token(press) if press else new_token())


def remember_owner(request: Request, response: Response, token: str) -> None:
    """Keep the token in a cookie that scripts cannot read and other sites cannot send along with a form."""
    response.set_cookie(
        OWNER_COOKIE,
        token,
        max_age=_COOKIE_SECONDS,
        path="/",
        secure=base_url(request).startswith("https:"),
        httponly=True,
        samesite="lax",
    )


def base_url(request: Request) -> str:
    """Give the service's public address without a final slash: as the operator, else as the request says."""
    return (get_settings(request).base_url or str(request.base_url)).rstrip("/")


ServiceDep = Annotated[Service, Depends(get_service)]
SettingsDep = Annotated[Settings, Depends(get_settings)]
TokenDep = Annotated[str | None, Depends(owner_token)]
