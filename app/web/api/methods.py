"""Methods of the REST API, ``/api/v1/methods``: names, parameters, inputs and outputs."""

from fastapi import APIRouter

from app.methods.registry import METHODS, method
from app.web.api.openapi import MethodName, problems
from app.web.api.records import API, MethodList, MethodRecord

router = APIRouter(prefix=f"{API}/methods", tags=["methods"])


@router.get("", summary="Every method")
async def list_methods() -> MethodList:
    """List them with the JSON Schema of their parameters, which forms and command-line options are made from, too."""
    return MethodList(methods=[MethodRecord.of(entry) for entry in METHODS.values()])


@router.get("/{name}", summary="One method", responses=problems(404))
async def read_method(name: MethodName) -> MethodRecord:
    """Its parameters, inputs and references."""
    return MethodRecord.of(method(name))
