"""Sample page: its form, filled in, checked and submitted."""

from contextlib import suppress
from dataclasses import asdict, replace

from fastapi import APIRouter, Request
from fastapi.responses import RedirectResponse
from starlette.concurrency import run_in_threadpool
from starlette.responses import JSONResponse, Response
from starlette.status import HTTP_303_SEE_OTHER

from app.errors import AppError
from app.experiments.model import Sample
from app.experiments.service import Service
from app.methods.registry import method
from app.samples import read_catalogue
from app.settings import Settings
from app.web.clients import client_of
from app.web.deps import (
    ServiceDep,
    SettingsDep,
    TokenDep,
    choose_owner,
    get_service,
    read_press,
    remember_owner,
)
from app.web.form.address import from_query, sample_url, with_switches
from app.web.form.context import form_context
from app.web.form.draft import Draft, read_form, with_error
from app.web.form.inputs import Choices, further_numbers, prefix
from app.web.limits import EXPERIMENTS, VIEWS, take, take_upload
from app.web.pages.errors import WORDS
from app.web.pages.structure import form_structure
from app.web.problems import retry_headers, status_of
from app.web.templating import render
from app.web.uploads import add_sample, receive_form

router = APIRouter(include_in_schema=False)


@router.get("/samples/{sample_id}")
def sample_page(request: Request, sample_id: str, service: ServiceDep, settings: SettingsDep) -> Response:
    sample = service.samples.get(sample_id)
    choices = _choices(service, settings)
    return _sample(request, settings, sample, choices, from_query(sample, choices, request.query_params))


def _choices(service: Service, settings: Settings) -> Choices:
    offered = tuple(service.samples.bundled())
    kept = {sample.id for sample in offered}  # an upload may have any id, and says nothing of the catalogue
    entries = {entry.id: entry for entry in read_catalogue(settings.samples_dir) if entry.id in kept}
    return Choices(offered, entries, service.samples.get)


def _sample(
    request: Request, settings: Settings, sample: Sample, choices: Choices, draft: Draft, status: int = 200
) -> Response:
    context = form_context(sample, choices, draft) | {
        "limit": settings.max_upload_bytes,
        "structure": form_structure(get_service(request), sample, draft.values),
        "summary_title": WORDS[status] if status in (429, 503) else "Please correct the form",
    }
    return render(request, "sample.html", context, status)


@router.get("/experiments")
def experiments() -> Response:
    """Redirect `/experiments` to the archive (people reach it by reloading a rejected form)."""
    return RedirectResponse("/archive")


@router.post("/experiments")
async def submit(request: Request, service: ServiceDep, settings: SettingsDep, token: TokenDep) -> Response:
    """Submit the form: run it, or show the samples that were chosen in it."""
    names = {f"{prefix(number)}file": f"{prefix(number)}sample" for number in further_numbers()}
    if not request.headers.get("content-type", "").startswith("multipart/form-data"):
        return await run_in_threadpool(_submit, request, service, settings, token, await _texts(request), {})
    async with receive_form(request, tuple(names)) as form:
        values, errors = dict(form.fields), {}
        owner = choose_owner(token, read_press(values.get("press", "")))
        for name, path in form.files.items():
            try:
                take_upload(request)
                values[names[name]] = (await add_sample(request, path, owner)).id
            except AppError as error:
                errors[names[name]] = error.message
        return await run_in_threadpool(_submit, request, service, settings, token or owner, values, errors)


async def _texts(request: Request) -> dict[str, str]:
    return {name: value for name, value in (await request.form()).items() if isinstance(value, str)}


@router.post("/experiments/check")
async def check(request: Request, service: ServiceDep, settings: SettingsDep) -> Response:
    """Say what is wrong with a form, or what it would make; nothing is run. The page asks while it is filled in."""
    take(request, VIEWS)
    return await run_in_threadpool(_check, service, settings, await _texts(request))


def _check(service: Service, settings: Settings, values: dict[str, str]) -> Response:
    sample = service.samples.get(values.get("sample", ""))
    submission = read_form(sample, _choices(service, settings), values)
    if submission.request is None:
        return JSONResponse({"errors": submission.draft.errors})
    try:
        return JSONResponse({"errors": {}, "plan": asdict(service.submission.check(submission.request))})
    except AppError as error:
        return JSONResponse({"errors": with_error(submission, method(submission.request.method), error).errors})


def _submit(
    request: Request,
    service: Service,
    settings: Settings,
    token: str | None,
    values: dict[str, str],
    errors: dict[str, str],
) -> Response:
    sample = service.samples.get(values.get("sample", ""))
    choices = _choices(service, settings)
    if errors:
        return _sample(request, settings, sample, choices, Draft(values, errors, frozenset(errors)), 422)
    if values.get("show"):
        return RedirectResponse(sample_url(sample.id, with_switches(values)), HTTP_303_SEE_OTHER)
    submission = read_form(sample, choices, values)
    if submission.request is None:
        return _sample(request, settings, sample, choices, submission.draft, 422)
    press = read_press(values.get("press", ""))
    owner = choose_owner(token, press)
    try:
        take(request, EXPERIMENTS)
        experiment = service.submission.submit(submission.request, owner, press, client=client_of(request).name)
    except AppError as error:
        draft = with_error(submission, method(submission.request.method), error)
        with suppress(AppError):
            service.submission.check(submission.request)
            draft = replace(draft, lasting=frozenset(draft.errors))
        page = _sample(request, settings, sample, choices, draft, status_of(error))
        page.headers.update(retry_headers(error))
        return page
    response = RedirectResponse(f"/experiments/{experiment.id}", HTTP_303_SEE_OTHER)
    remember_owner(request, response, owner)
    return response
