"""The OpenAPI document is right, and every route keeps its word under fuzzing."""

import hypothesis
import jsonschema_rs
import pytest
import schemathesis
from hypothesis import HealthCheck, Phase
from schemathesis.checks import load_all_checks

from app.methods.registry import METHODS

load_all_checks()
URL = "/api/v1/openapi.json"
FUZZING = hypothesis.settings(
    max_examples=12,
    deadline=None,
    derandomize=True,
    database=None,
    phases=[Phase.explicit, Phase.generate],
    suppress_health_check=list(HealthCheck),
)


@pytest.fixture(scope="module", name="document")
def openapi_document(site):
    return site.client.get(URL).json()


@pytest.fixture(scope="module")
def api(site):
    return schemathesis.openapi.from_url(f"{site.url}{URL}")


def operations(document):
    for path, item in document["paths"].items():
        for method, operation in item.items():
            yield f"{method.upper()} {path}", operation


def test_the_document_is_openapi_3_1_with_every_route_of_the_design(document):
    assert document["openapi"].startswith("3.1")
    assert {name for name, _ in operations(document)} == {
        "GET /api/v1/methods",
        "GET /api/v1/methods/{name}",
        "GET /api/v1/samples",
        "POST /api/v1/samples",
        "GET /api/v1/samples/{sample_id}",
        "GET /api/v1/samples/{sample_id}/image",
        "GET /api/v1/experiments",
        "POST /api/v1/experiments",
        "GET /api/v1/experiments/{experiment_id}",
        "PATCH /api/v1/experiments/{experiment_id}",
        "DELETE /api/v1/experiments/{experiment_id}",
        "GET /api/v1/experiments/{experiment_id}/events",
        "GET /api/v1/experiments/{experiment_id}/outputs/{name}",
        "GET /api/v1/experiments/{experiment_id}/outputs.zip",
        "POST /api/v1/synthesize",
        "GET /healthz",
        "GET /readyz",
        "GET /metrics",
    }


def test_every_operation_has_words_and_every_error_is_a_problem(document):
    for name, operation in operations(document):
        assert operation["summary"], name
        assert operation["description"], name
        for status, response in operation["responses"].items():
            if status >= "400":
                assert list(response["content"]) == ["application/problem+json"], (name, status)


def test_every_reference_leads_somewhere(document):
    def references(node):
        if isinstance(node, dict):
            if isinstance(node.get("$ref"), str):
                yield node["$ref"]
            for value in node.values():
                yield from references(value)
        elif isinstance(node, list):
            for value in node:
                yield from references(value)

    for reference in references(document):
        node = document
        for part in reference.removeprefix("#/").split("/"):
            node = node[part]


def test_the_parameters_of_every_method_are_there(document):
    schemas = document["components"]["schemas"]
    branches = {
        branch["properties"]["method"]["const"]: branch["properties"]["parameters"]["$ref"].rpartition("/")[2]
        for branch in schemas["ExperimentBody"]["oneOf"]
    }
    form = document["paths"]["/api/v1/synthesize"]["post"]["requestBody"]["content"]["multipart/form-data"]["schema"]
    for name, method in METHODS.items():
        assert set(schemas[branches[name]]["properties"]) == set(method.params.model_fields)
        assert set(method.params.model_fields) <= set(form["properties"])


def test_the_example_of_an_experiment_runs(site, document):
    example = document["components"]["schemas"]["ExperimentBody"]["examples"][0]
    response = site.client.post("/api/v1/experiments", json=example, headers={"Prefer": "wait=20"})
    assert (response.status_code, response.json()["status"]) == (201, "succeeded")


def test_declared_parameters_are_json_schemas(site):
    for method in site.client.get("/api/v1/methods").json()["methods"]:
        validator = jsonschema_rs.Draft202012Validator(method["parameters"])
        assert validator.is_valid({})
        assert not validator.is_valid({"seed": -1})
        assert site.client.get(f"/api/v1/methods/{method['name']}").json() == method


schema = schemathesis.pytest.from_fixture("api")


@schema.parametrize()
@FUZZING
def test_no_request_makes_a_route_break_its_word(case):
    """Never a 500, an undeclared status code or media type, or an answer beside its schema."""
    case.call_and_validate(timeout=20)
