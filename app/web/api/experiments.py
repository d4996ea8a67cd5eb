"""Experiments of the REST API, ``/api/v1/experiments``: submit, read, list, change, cancel and delete."""

import re
from contextlib import suppress
from typing import Annotated, Any

from fastapi import APIRouter, Depends, Header, Path, Query, Request
from pydantic import ConfigDict, Field, ValidationError
from starlette.concurrency import run_in_threadpool
from starlette.exceptions import HTTPException
from starlette.responses import Response

from app.errors import DeletedError, InvalidInputError, NotFoundError, UnavailableError
from app.experiments.model import Experiment
from app.experiments.preparation import NewExperiment, explain
from app.experiments.service import Service
from app.experiments.tokens import new_token
from app.methods.registry import METHODS, refuse_unknown
from app.web.api.bodies import IDENTIFIER, Body, InputBody, ListedBody, without_fraction
from app.web.api.openapi import EXAMPLE_METHOD, EXAMPLE_SAMPLE, OWNER, parameters_schema, problems
from app.web.api.records import API, ExperimentList, ExperimentRecord, PlanRecord
from app.web.clients import client_of
from app.web.deps import ServiceDep, TokenDep, base_url, remember_owner
from app.web.limits import EXPERIMENTS, VIEWS, take
from app.web.shutdown import unless_stopping

MOST_PARAMETERS = 64  # no method has half as many
LONGEST = 60  # seconds that `Prefer: wait=` waits
_WAIT = re.compile(r'(?:^|,)\s*wait\s*=\s*"?(\d{1,9})"?\s*(?=[,;]|$)', re.IGNORECASE)

router = APIRouter(prefix=API, tags=["experiments"])

ExperimentId = Annotated[str, Path(pattern=IDENTIFIER, description="Id of an experiment.")]


class ExperimentBody(Body):
    """What to compute, from what, and how."""

    model_config = ConfigDict(
        json_schema_extra={
            "oneOf": [
                {
                    "title": method.title,
                    "properties": {
                        "method": {"const": method.name},
                        "inputs": {"minItems": len(method.inputs), "maxItems": len(method.inputs) + method.more},
                        "parameters": parameters_schema(method.name),
                    },
                }
                for method in METHODS.values()
            ],
            "examples": [
                {
                    "method": EXAMPLE_METHOD,
                    "inputs": [{"sample": EXAMPLE_SAMPLE, "crop": {"x": 0, "y": 0, "width": 64, "height": 64}}],
                    "parameters": {"width": 128, "height": 128, "seed": 7},
                    "listed": False,
                }
            ],
        }
    )

    method: str = Field(description="Name of a method.", json_schema_extra={"enum": list(METHODS)})
    inputs: list[InputBody] = Field(
        min_length=1, max_length=8, description="As many as the method needs, and at most `more_inputs` more."
    )
    parameters: dict[str, Any] = Field(
        default_factory=dict, max_length=MOST_PARAMETERS, description="What is left out has its default."
    )
    listed: bool = Field(True, description="Whether the archive shows it; otherwise only its link leads to it.")

    def to_request(self) -> NewExperiment:
        """Say the same in the service's words.

        Raises
        ------
        InvalidInputError
            If there is no such method, or a parameter has another JSON type than declared.
        """
        refuse_unknown(self.method)
        self._check_types()
        inputs = tuple(source.to_input() for source in self.inputs)
        return NewExperiment(self.method, inputs, self.parameters, self.listed)

    def _check_types(self) -> None:
        """Refuse ``"7"`` for 7: the service takes it, for forms and command lines have only text; JSON has numbers."""
        method = METHODS[self.method]
        values = {name: without_fraction(value) for name, value in self.parameters.items()}
        try:
            method.params.model_validate(values, strict=True)
        except ValidationError as error:
            for fault in error.errors():
                if fault["type"].endswith("_type"):
                    raise explain(fault, method) from None


def require_json(request: Request) -> None:
    """Answer 415 to a body that does not say it is JSON."""
    kind = request.headers.get("content-type", "").partition(";")[0].strip().lower()
    if kind != "application/json" and not (kind.startswith("application/") and kind.endswith("+json")):
        raise HTTPException(415, "Send JSON, with the header Content-Type: application/json.")


def record_of(request: Request, service: Service, experiment: Experiment) -> ExperimentRecord:
    """Write the record, as of now; without its progress where that cannot be read for now."""
    snapshot = None
    if not experiment.status.finished:
        with suppress(UnavailableError):
            snapshot = service.watching.snapshot(experiment.id)
    return ExperimentRecord.of(experiment, snapshot, base_url(request))


_CREATED = {
    "description": "Finished within the time to wait.",
    "model": ExperimentRecord,
    "headers": {
        "Location": {"description": "Address of the record.", "schema": {"type": "string"}},
        "Preference-Applied": {"description": "`wait=…` if you asked to wait.", "schema": {"type": "string"}},
    },
}


@router.post(
    "/check", dependencies=[Depends(require_json)], summary="Check before running", responses=problems(404, 422, 429)
)
async def check_experiment(body: ExperimentBody, request: Request, service: ServiceDep) -> PlanRecord:
    """Say what it would make and how much memory it would take, or what is wrong with it; nothing is run."""
    take(request, VIEWS)
    return PlanRecord.from_source(await run_in_threadpool(lambda: service.submission.check(body.to_request())))


@router.post(
    "/experiments",
    status_code=202,
    response_model_exclude_unset=True,
    dependencies=[Depends(require_json)],
    summary="Run a method",
    responses={
        201: _CREATED,
        202: {**_CREATED, "description": "Accepted: it waits or runs."},
        **problems(422, 429, 503),
    },
    openapi_extra={"security": OWNER},
)
async def submit_experiment(
    body: ExperimentBody,
    request: Request,
    response: Response,
    service: ServiceDep,
    token: TokenDep,
    prefer: Annotated[
        str | None,
        Header(
            description=f"`wait=30` waits that many seconds at most (up to {LONGEST}) for it to finish.",
            examples=["wait=30"],
        ),
    ] = None,
) -> ExperimentRecord:
    """Everything is checked before it is accepted; once accepted it is finished, whatever restarts in between.

    Without a token of yours the record holds a new `owner_token`, once.
    """
    take(request, EXPERIMENTS)
    owner = token or new_token()
    try:
        client = client_of(request).name
        experiment = await run_in_threadpool(service.submission.submit, body.to_request(), owner, client=client)
    except (NotFoundError, DeletedError) as error:  # this address exists; what does not is a sample
        raise InvalidInputError(error.message, "inputs") from None
    seconds = wait_seconds(prefer)
    if seconds is not None:
        with suppress(UnavailableError):  # it is accepted all the same
            experiment = await unless_stopping(request, service.watching.wait(experiment.id, seconds)) or experiment
        response.headers["Preference-Applied"] = f"wait={seconds}"
    record = await run_in_threadpool(record_of, request, service, experiment)
    response.status_code = 201 if record.status.finished else 202
    response.headers["Location"] = record.url
    if token is None:
        remember_owner(request, response, owner)
        record.owner_token = owner
    return record


@router.get(
    "/experiments",
    summary="The archive",
    response_model_exclude_unset=True,
    responses={
        200: {
            "headers": {
                "Link": {"description": "`rel=next`, unless this is the last page.", "schema": {"type": "string"}}
            }
        },
        **problems(422),
    },
)
def list_experiments(
    request: Request,
    response: Response,
    service: ServiceDep,
    limit: Annotated[int, Query(ge=1, le=100, description="Experiments a page.")] = 24,
    cursor: Annotated[str | None, Query(max_length=200, description="From the `Link` of the page before.")] = None,
    method: Annotated[
        str | None, Query(description="Only of this method.", json_schema_extra={"enum": list(METHODS)})
    ] = None,
) -> ExperimentList:
    """Public experiments that succeeded, newest first."""
    if method is not None:
        refuse_unknown(method)
    page = service.experiments.page(limit=limit, cursor=cursor, method=method)
    following = None
    if page.cursor is not None:
        address = request.url.include_query_params(cursor=page.cursor)
        following = f"{base_url(request)}{address.path}?{address.query}"
        response.headers["Link"] = f'<{following}>; rel="next"'
    return ExperimentList(
        experiments=[record_of(request, service, experiment) for experiment in page.experiments], next=following
    )


@router.get(
    "/experiments/{experiment_id}",
    summary="The record of an experiment",
    response_model_exclude_unset=True,
    responses=problems(404, 410),
)
def read_experiment(experiment_id: ExperimentId, request: Request, service: ServiceDep) -> ExperimentRecord:
    """Where it stands, and its outputs once it succeeded."""
    return record_of(request, service, service.experiments.get(experiment_id))


@router.patch(
    "/experiments/{experiment_id}",
    summary="List or unlist an experiment",
    response_model_exclude_unset=True,
    dependencies=[Depends(require_json)],
    responses=problems(404, 410, 422),
    openapi_extra={"security": OWNER},
)
def change_experiment(
    experiment_id: ExperimentId, body: ListedBody, request: Request, service: ServiceDep, token: TokenDep
) -> ExperimentRecord:
    """For its owner and the operator."""
    service.experiments.set_listed(experiment_id, body.listed, token)
    return record_of(request, service, service.experiments.get(experiment_id))


@router.delete(
    "/experiments/{experiment_id}",
    status_code=204,
    summary="Cancel or delete an experiment",
    responses={
        202: {
            "model": ExperimentRecord,
            "description": "It had not finished: it is cancelled now. Delete it again to remove it.",
        },
        204: {"description": "It had finished: it is removed, with its files."},
        **problems(404, 410),
    },
    openapi_extra={"security": OWNER},
)
def delete_experiment(experiment_id: ExperimentId, request: Request, service: ServiceDep, token: TokenDep) -> Response:
    """For its owner and the operator."""
    service.experiments.cancel_or_delete(experiment_id, token)
    try:
        record = record_of(request, service, service.experiments.get(experiment_id))
    except DeletedError:
        return Response(status_code=204)
    return Response(record.model_dump_json(exclude_unset=True), 202, media_type="application/json")


def wait_seconds(prefer: str | None) -> int | None:
    """Read the seconds a client wants to wait, at most `LONGEST`; None if it says nothing about it.

    Examples
    --------
    >>> wait_seconds("respond-async, wait=30"), wait_seconds("wait=3600"), wait_seconds("return=minimal")
    (30, 60, None)
    """
    found = _WAIT.search(prefer or "")
    return min(int(found[1]), LONGEST) if found else None
