"""OpenAPI document: what FastAPI derives from the routes, plus the parameters of all methods."""

from collections.abc import Iterable
from typing import Annotated, Any

from fastapi import FastAPI, Path
from fastapi.openapi.utils import get_openapi
from pydantic.json_schema import models_json_schema

from app.methods.registry import METHODS
from app.web.api.records import Fault, Problem
from app.web.problems import MEDIA_TYPE, RETRY_SECONDS, title

REF = "#/components/schemas/{model}"
EXAMPLE_SAMPLE = "gravel_gray"
EXAMPLE_METHOD = next(iter(METHODS))

MethodName = Annotated[
    str, Path(description="Name of a method.", json_schema_extra={"enum": list(METHODS)}, examples=[EXAMPLE_METHOD])
]

OWNER: list[dict[str, list[str]]] = [{}, {"ownerToken": []}, {"ownerCookie": []}]
"""Security requirement of what works for everybody, and does more for an owner."""

_PARAMETER_REFS, _PARAMETER_SCHEMAS = models_json_schema(
    [(params, "validation") for params in dict.fromkeys(method.params for method in METHODS.values())], ref_template=REF
)

DESCRIPTION = """
Upload a photograph or take a bundled sample, name a method, get the texture.

* **In one call**: `POST /api/v1/synthesize` answers with the picture.
* **As an experiment**, which is kept and has a page: `POST /api/v1/experiments`, then read its record, follow its
  events, or let the `Prefer: wait=30` header wait for it.
* **Owners**: who submits an experiment without a token is given one in `owner_token`; `Authorization: Bearer <token>`
  then allows to cancel, delete and unlist. Browsers keep it in a cookie.
* **Errors** are `application/problem+json` (RFC 9457); `errors` names the fields at fault.
* **Limits**: one client may not ask for everything; 429 says in `Retry-After` how long to wait, and the `RateLimit`
  header of what is counted how much is left.
* **From other web pages**: every GET may be read from any origin, without cookies; what changes something may not be
  called.
"""


def problems(*statuses: int) -> dict[int | str, dict[str, Any]]:
    """Declare the errors that a route answers with."""
    return {status: {"description": title(status)} for status in statuses}


def parameters_schema(method: str) -> dict[str, Any]:
    """Refer to the JSON Schema of a method's parameters."""
    return dict(_PARAMETER_REFS[METHODS[method].params, "validation"])


def form_parameters() -> dict[str, Any]:
    """Describe every parameter of every method as a property of a form.

    Methods may mean the same name differently: such a property is any of their schemas.
    """
    properties: dict[str, list[dict[str, Any]]] = {}
    users: dict[str, list[str]] = {}
    for method in METHODS.values():
        schema = method.params.model_json_schema(ref_template=REF)
        for name, declared in schema["properties"].items():
            known = properties.setdefault(name, [])
            if declared not in known:
                known.append(declared)
            users.setdefault(name, []).append(method.name)
    return {
        name: {**(schemas[0] if len(schemas) == 1 else {"anyOf": schemas}), "x-methods": users[name]}
        for name, schemas in properties.items()
    }


def build_document(app: FastAPI) -> dict[str, Any]:
    """Make the document, once."""
    if app.openapi_schema is None:
        schema = get_openapi(
            title=app.title,
            version=app.version,
            openapi_version=app.openapi_version,
            summary=app.summary,
            description=DESCRIPTION.strip(),
            license_info={"name": "BSD-3-Clause", "identifier": "BSD-3-Clause"},
            tags=[
                {"name": "experiments", "description": "Run a method on a sample, and what comes of it."},
                {"name": "samples", "description": "Photographs to take textures from."},
                {"name": "methods", "description": "What can be computed."},
                {"name": "service", "description": "For those who operate it."},
            ],
            routes=app.routes,
        )
        components = schema.setdefault("components", {})
        schemas = components.setdefault("schemas", {})
        for unused in ("HTTPValidationError", "ValidationError"):
            schemas.pop(unused, None)
        schemas.update(_PARAMETER_SCHEMAS.get("$defs", {}))
        schemas["Fault"] = Fault.model_json_schema(ref_template=REF)
        schemas["Problem"] = {**Problem.model_json_schema(ref_template=REF)}
        schemas["Problem"].pop("$defs", None)
        components["securitySchemes"] = {
            "ownerToken": {
                "type": "http",
                "scheme": "bearer",
                "description": "The `owner_token` of the record of your first experiment, or the operator's token.",
            },
            "ownerCookie": {
                "type": "apiKey",
                "in": "cookie",
                "name": "microtexture_owner",
                "description": "The same token as browsers keep it.",
            },
        }
        for operation in _operations(schema):
            _declare_problems(operation)
        app.openapi_schema = schema
    return app.openapi_schema


def _operations(schema: dict[str, Any]) -> Iterable[dict[str, Any]]:
    for path in schema["paths"].values():
        for method, operation in path.items():
            if method != "get":
                operation["responses"].setdefault("403", {"description": title(403)})
            if "requestBody" in operation:
                for status in (400, 413, 415):
                    operation["responses"].setdefault(str(status), {"description": title(status)})
            yield operation


def _declare_problems(operation: dict[str, Any]) -> None:
    responses = operation["responses"]
    if "HTTPValidationError" in str(responses.get("422")):
        del responses["422"]  # FastAPI's guess from a path parameter, which we answer with 404
    for status, response in responses.items():
        if status.isdigit() and int(status) >= 400:
            response["content"] = {MEDIA_TYPE: {"schema": {"$ref": REF.format(model="Problem")}}}
            if status in ("429", "503"):
                response["headers"] = {
                    "Retry-After": {"description": "Seconds.", "schema": {"type": "integer", "example": RETRY_SECONDS}}
                }
    operation["responses"] = dict(sorted(responses.items()))
