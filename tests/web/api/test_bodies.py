"""Bodies that nobody means are refused in few words, however much they hold."""

import json
from typing import Any

import pytest

from app.web.problems import FAULTS

HEADERS = {"Content-Type": "application/json"}
ANSWER_BYTES = 4096
SAID: dict[str, Any] = {
    "method": "rpn",
    "inputs": [{"sample": "gravel_gray", "crop": {"x": 0, "y": 0, "width": 32, "height": 32}}],
}
UNKNOWN = {f"k{number}": 0 for number in range(6000)}  # just under 64 kB
LONG = {f"{'k' * 2000}{number}": "v" * 1000 for number in range(8)}
BODIES = {
    "keys of the body": SAID | UNKNOWN,
    "parameters": {**SAID, "parameters": UNKNOWN},
    "keys of an input": {**SAID, "inputs": [{**SAID["inputs"][0], **UNKNOWN}]},
    "keys of a crop": {**SAID, "inputs": [{"sample": "gravel_gray", "crop": UNKNOWN}]},
    "inputs": {**SAID, "inputs": [0] * 9000},
    "faulty inputs": {**SAID, "inputs": [{"crop": {"x": "a", "y": "b", "width": [], "height": {}}}] * 8},
    "long names": SAID | LONG,
    "long names of parameters": {**SAID, "parameters": LONG},
}


@pytest.mark.parametrize("path", ["/api/v1/check", "/api/v1/experiments"])
@pytest.mark.parametrize("body", BODIES.values(), ids=BODIES)
def test_many_faults_are_answered_with_few(site, path, body):
    response = site.client.post(path, json=body)
    assert response.status_code == 422
    assert len(response.content) <= ANSWER_BYTES
    assert 1 <= len(response.json()["errors"]) <= FAULTS


def test_the_faults_that_are_not_listed_are_counted(site):
    response = site.client.post("/api/v1/check", json=BODIES["faulty inputs"])
    assert len(response.json()["errors"]) == FAULTS
    assert "(and 39 more)" in response.json()["detail"]


def test_many_unknown_keys_are_counted_and_the_known_ones_named(site):
    detail = site.client.post("/api/v1/check", json=BODIES["keys of the body"]).json()["detail"]
    assert "6000 of its fields are not known" in detail
    assert "method, inputs, parameters, listed" in detail


def test_80_000_keys_are_refused_by_their_size(site):
    body = json.dumps({f"k{number}": 0 for number in range(80_000)})
    response = site.client.post("/api/v1/experiments", content=body, headers=HEADERS)
    assert response.status_code == 413
    assert len(response.content) <= ANSWER_BYTES


@pytest.mark.parametrize("text", ["[" * 60_000, '{"a":' * 10_000, '{"method":"rpn","inputs":' + "[" * 30_000])
def test_deep_nesting_is_refused(site, text):
    for content in (text, text + "]" * text.count("[") + "}" * text.count("{") if "a" not in text else text + "0"):
        response = site.client.post("/api/v1/check", content=content[: 64 << 10], headers=HEADERS)
        assert response.status_code in {400, 422}
        assert len(response.content) <= ANSWER_BYTES


def test_deeply_nested_values_of_parameters_are_refused(site):
    nested = "[" * 900 + "]" * 900
    body = json.dumps({**SAID, "parameters": {"width": "@"}}).replace('"@"', nested)
    response = site.client.post("/api/v1/check", content=body, headers=HEADERS)
    assert response.status_code == 422
    assert len(response.content) <= ANSWER_BYTES


def test_a_width_of_4_000_digits_is_refused(site):
    body = json.dumps({**SAID, "parameters": {"width": 0}}).replace(": 0}}", ": " + "9" * 4000 + "}}")
    response = site.client.post("/api/v1/check", content=body, headers=HEADERS)
    assert response.status_code == 422
    assert response.json()["errors"][0]["field"] == "parameters.width"
