"""The OpenAPI document is right, and every route keeps its word under fuzzing."""

import subprocess
import sys
from pathlib import Path

import jsonschema_rs
import pytest

from app.methods.registry import METHODS

URL = "/api/v1/openapi.json"


@pytest.fixture(scope="module", name="document")
def openapi_document(site):
    return site.client.get(URL).json()


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
        "GET /api/v1/samples/{sample_id}/video",
        "GET /api/v1/samples/{sample_id}/structure",
        "GET /api/v1/experiments",
        "POST /api/v1/experiments",
        "POST /api/v1/check",
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


@pytest.mark.slow
def test_no_request_makes_a_route_break_its_word(site, operator, tmp_path):
    """Never a 500, an undeclared status code, header or media type, or an answer beside its schema.

    Examples, edge cases of every parameter, random requests and sequences of calls, valid and not; the same each time.
    Only that everything the schemas allow is taken is not asked for: no schema says what a photograph is, which ids
    there are, or what a crop's bounds are.
    """
    command = [str(Path(sys.executable).with_name("schemathesis")), "run", f"{site.url}{URL}"]
    options = {
        "--header": f"Authorization: {operator['Authorization']}",
        "--exclude-checks": "positive_data_acceptance",
        "--max-examples": "4",
        "--request-timeout": "20",
        "--warnings": "off",
    }
    flags = ["--generation-deterministic", "--continue-on-failure", "--no-color"]
    arguments = [*command, *flags, *(part for option in options.items() for part in option)]
    result = subprocess.run(arguments, check=False, cwd=tmp_path, capture_output=True, text=True, timeout=300)
    assert result.returncode == 0, result.stdout + result.stderr
    assert "Tested: 21" in result.stdout
