"""Home page, and the upload of a sample from it."""

from fastapi import APIRouter, Request
from fastapi.responses import RedirectResponse
from starlette.concurrency import run_in_threadpool
from starlette.responses import Response
from starlette.status import HTTP_303_SEE_OTHER

from app.errors import AppError, InvalidInputError
from app.experiments.service import Service
from app.experiments.tokens import new_token
from app.settings import Settings
from app.web.deps import (
    ServiceDep,
    SettingsDep,
    TokenDep,
    remember_owner,
)
from app.web.limits import take_upload
from app.web.problems import retry_headers, status_of
from app.web.templating import render
from app.web.uploads import add_sample, receive_form

NEWEST = 8
NOTHING_CHOSEN = "Choose a photograph or a clip first: a PNG, JPEG, WebP, TIFF, MP4, WebM, GIF or APNG file."


router = APIRouter(include_in_schema=False)


@router.get("/")
def home(request: Request, service: ServiceDep, settings: SettingsDep) -> Response:
    return _home(request, service, settings)


def _home(
    request: Request, service: Service, settings: Settings, error: str | None = None, status: int = 200
) -> Response:
    context = {
        "limit": settings.max_upload_bytes,
        "longest": {"seconds": settings.max_film_seconds, "frames": settings.max_film_frames},
        "samples": service.samples.bundled(),
        "newest": service.experiments.page(limit=NEWEST).experiments,
        "upload_error": error,
    }
    return render(request, "home.html", context, status)


@router.post("/samples")
async def upload(request: Request, service: ServiceDep, settings: SettingsDep, token: TokenDep) -> Response:
    owner = token or new_token()
    try:
        take_upload(request)
        async with receive_form(request) as form:
            if form.file is None:
                raise InvalidInputError(NOTHING_CHOSEN, "file")
            sample = await add_sample(request, form.file, owner)
    except AppError as error:
        page = await run_in_threadpool(_home, request, service, settings, error.message, status_of(error))
        page.headers.update(retry_headers(error))
        return page
    response = RedirectResponse(f"/samples/{sample.id}", HTTP_303_SEE_OTHER)
    remember_owner(request, response, owner)
    return response
