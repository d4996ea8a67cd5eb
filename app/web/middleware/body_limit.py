"""Request size limit: rejects bodies over the limit (413) before they are parsed."""

from starlette.datastructures import Headers
from starlette.exceptions import HTTPException
from starlette.requests import Request
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from app.settings import MEBIBYTE
from app.web.problems import respond

JSON_BYTES = 64 << 10  # the largest that means something has a hundred numbers
FORM_BYTES = MEBIBYTE  # room for the fields of a form beside its file
JSON_ROUTES = ("/api/v1/check", "/api/v1/experiments")
_DISCARDED = 3  # times the limit


class BodyLimit:
    """Answers 413 to a body that is larger than its kind may be: ``upload`` bytes in a form, or 64 kB of anything else.

    What a client is still sending when its form is refused, here or behind, is read and dropped, up to a few times the
    limit: most clients look for an answer only when they have sent everything, and a connection closed in their face
    loses it.
    """

    def __init__(self, app: ASGIApp, *, upload: int) -> None:
        self.app = app
        self.upload = upload

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] != "http":
            await self.app(scope, receive, send)
            return
        headers = Headers(scope=scope)
        is_form = headers.get("content-type", "").lower().startswith("multipart/form-data")
        is_form = is_form and not scope["path"].startswith(JSON_ROUTES)  # they read what comes before they look at it
        limit = self.upload + FORM_BYTES if is_form else JSON_BYTES
        what, bound = ("upload", self.upload) if is_form else ("body", limit)
        detail = f"The {what} is larger than {format_bytes(bound)}: send a smaller one."
        declared = headers.get("content-length", "")
        if declared.isdigit() and int(declared) > limit:
            if headers.get("expect", "").lower() != "100-continue":
                await _discard(receive, _DISCARDED * limit)
            await respond(Request(scope), 413, detail)(scope, receive, send)
            return
        received, complete = 0, not is_form

        async def receive_limited() -> Message:
            nonlocal received, complete
            message = await receive()
            received += len(message.get("body", b""))
            complete = complete or not message.get("more_body")
            if received > limit:
                complete = True
                if message.get("more_body"):
                    await _discard(receive, _DISCARDED * limit)
                raise HTTPException(413, detail)
            return message

        async def send_when_read(message: Message) -> None:
            nonlocal complete
            if message["type"] == "http.response.start" and not complete and "expect" not in headers:
                complete = True
                await _discard(receive, _DISCARDED * limit)
            await send(message)

        await self.app(scope, receive_limited, send_when_read)


async def _discard(receive: Receive, at_most: int) -> None:
    dropped = 0
    while dropped <= at_most:
        message = await receive()
        dropped += len(message.get("body", b""))
        if message["type"] == "http.disconnect" or not message.get("more_body"):
            return


def format_bytes(count: int) -> str:
    """Bytes in words.

    Examples
    --------
    >>> format_bytes(32 << 20), format_bytes(1500)
    ('32 MB', '1 kB')
    """
    return f"{count >> 20} MB" if count >= MEBIBYTE else f"{max(1, count >> 10)} kB"
