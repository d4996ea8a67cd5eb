"""``/api/v1/experiments``: submit, wait, read, list, change, cancel, delete."""

from concurrent.futures import ThreadPoolExecutor

import pytest

from app.experiments.environment import environment
from app.methods.registry import METHODS
from tests.methods.runs import SMALL


def test_an_experiment_is_accepted_at_once(site):
    with site.gate.closed():
        response = site.run(wait=False)
        record = response.json()
        assert response.status_code == 202
        assert response.headers["Location"] == record["url"]
        assert record["status"] in {"queued", "running"}
        assert record["outputs"] == []
        assert "Preference-Applied" not in response.headers


def test_waiting_gives_the_finished_record(site):
    response = site.run(parameters={"width": 20, "height": 10, "seed": 3})
    record = response.json()
    assert response.status_code == 201
    assert response.headers["Preference-Applied"] == "wait=20"
    assert (record["status"], record["progress"], record["error"]) == ("succeeded", 1.0, None)
    assert record["parameters"]["width"] == 20
    assert record["parameters"]["alpha"] == 0.1
    assert record["outputs"][0]["name"] == "texture"
    assert (record["outputs"][0]["width"], record["outputs"][0]["height"]) == (20, 10)
    assert not any(output["name"].startswith(".") for output in record["outputs"])
    assert all(seconds >= 0 for seconds in record["timings"].values())
    assert record["created_at"] <= record["finished_at"]
    read = site.client.get(record["url"]).json()
    assert read == {name: value for name, value in record.items() if name != "owner_token"}


def test_waiting_ends_when_its_time_is_over(site):
    with site.gate.closed():
        body = {"method": "rpn", "inputs": [{"sample": "gravel_gray"}]}
        response = site.client.post("/api/v1/experiments", json=body, headers={"Prefer": "respond-async, wait=0"})
        assert (response.status_code, response.headers["Preference-Applied"]) == (202, "wait=0")


def test_the_default_crop_is_the_whole_sample(site):
    record = site.finished(inputs=[{"sample": "gravel_gray"}])
    whole = {"crop": {"x": 0, "y": 0, "width": 64, "height": 64}, "frames": {"first": 0, "count": 1}}
    assert record["inputs"] == [{"sample": "gravel_gray", **whole}]


def test_the_queue_tells_the_place(site, until):
    with site.gate.closed():
        first = site.run(wait=False).json()["url"]
        until(lambda: site.client.get(first).json()["status"] == "running")
        waiting = [site.run(wait=False).json()["url"] for _ in range(2)]
        assert [site.client.get(url).json()["position"] for url in waiting] == [1, 2]
        until(lambda: site.client.get(first).json()["progress"] == site.gate.held)
        assert site.client.get(first).json()["stage"] == "held"
    until(lambda: site.client.get(waiting[-1]).json()["status"] == "succeeded")


@pytest.mark.parametrize(
    ("change", "field"),
    [
        ({"method": "nothing"}, "method"),
        ({"inputs": []}, "inputs"),
        ({"inputs": [{"sample": "gravel_gray"}] * 2}, "inputs"),
        ({"inputs": [{"sample": "not-there"}]}, "inputs"),
        ({"inputs": [{"sample": "a\x00b"}]}, "inputs.0.sample"),
        ({"inputs": [{"sample": "gravel_gray", "crop": {"x": 60, "y": 0, "width": 9, "height": 9}}]}, "inputs.0.crop"),
        (
            {"inputs": [{"sample": "gravel_gray", "crop": {"x": 0, "y": 0, "width": 0, "height": 9}}]},
            "inputs.0.crop.width",
        ),
        (
            {"inputs": [{"sample": "gravel_gray", "crop": {"x": "0", "y": 0, "width": 9, "height": 9}}]},
            "inputs.0.crop.x",
        ),
        ({"parameters": {"alpha": 0.6}}, "parameters.alpha"),
        ({"parameters": {"width": "40"}}, "parameters.width"),
        ({"parameters": {"add_smooth": 1}}, "parameters.add_smooth"),
        ({"parameters": {"colour": "red"}}, "parameters.colour"),
        ({"parameters": {"seed": -1}}, "parameters.seed"),
        ({"parameters": {"width": 50, "add_smooth": True}}, "parameters.add_smooth"),
        ({"listed": "yes"}, "listed"),
        ({"unknown": 1}, "unknown"),
    ],
    ids=lambda value: value if isinstance(value, str) else "",
)
def test_a_fault_is_refused_with_its_field(site, change, field):
    response = site.run(wait=False, **change)
    assert (response.status_code, response.headers["Content-Type"]) == (422, "application/problem+json")
    assert [fault["field"] for fault in response.json()["errors"]] == [field]
    assert response.json()["errors"][0]["message"] in response.json()["detail"]


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"parameters": {"seed": 1.5}}, "Seed is a whole number from 0 to 9007199254740991; got 1.5."),
        ({"parameters": {"seed": "7"}}, 'Seed is a whole number from 0 to 9007199254740991; got "7".'),
        ({"parameters": {"seed": True}}, "Seed is a whole number from 0 to 9007199254740991; got true."),
        ({"parameters": {"seed": None}}, "Seed is a whole number from 0 to 9007199254740991; got null."),
        ({"parameters": {"seed": -1}}, "Seed is a whole number from 0 to 9007199254740991; got -1."),
        ({"parameters": {"alpha": [0.1]}}, "Transition α is a number from 0 to 0.5; got a list."),
        ({"parameters": {"window": "square"}}, 'Window is one of: bump, gaussian; got "square".'),
        ({"parameters": {"add_smooth": 1}}, "Add the smooth component is true or false; got 1."),
        ({"parameters": 7}, "parameters: input should be a valid dictionary; got 7."),
        ({"listed": "yes"}, 'listed: input should be a valid boolean; got "yes".'),
        (
            {"inputs": [{"sample": "gravel_gray", "crop": {"x": 0.5, "y": 0, "width": 9, "height": 9}}]},
            "inputs.0.crop.x: input should be a valid integer; got 0.5.",
        ),
        (
            {"inputs": [{"sample": "gravel_gray", "crop": {"x": 0, "y": 0, "width": 9}}]},
            "inputs.0.crop.height: field required.",
        ),
    ],
)
def test_a_fault_is_told_with_its_name_and_the_value_that_came(site, change, message):
    assert site.run(wait=False, **change).json()["detail"] == message


def test_a_fault_of_a_query_is_told_in_the_same_way(site):
    detail = site.client.get("/api/v1/experiments?limit=many").json()["detail"]
    assert detail.startswith("limit: input should be a valid integer")
    assert detail.endswith('; got "many".')


def test_a_number_without_a_fraction_is_an_integer_as_json_schema_has_it(site):
    """Some writers of JSON put ``.0`` behind every number."""
    crop = {"x": 2.0, "y": 3.0, "width": 20.0, "height": 10.0}
    record = site.finished(
        inputs=[{"sample": "gravel_gray", "crop": crop, "frames": {"first": 0.0, "count": 1.0}}],
        parameters={"width": 24.0, "height": 1.2e1, "seed": 7.0, "alpha": 0},
    )
    assert record["inputs"][0]["crop"] == crop
    assert [record["parameters"][name] for name in ("width", "height", "seed", "alpha")] == [24, 12, 7, 0]
    assert [type(record["parameters"][name]) for name in ("width", "seed")] == [int, int]


def test_a_texture_beyond_the_limit_is_too_large(site):
    assert site.run(parameters={"width": 10_000, "height": 10_000}).status_code == 413


def test_a_crop_with_transparent_pixels_is_refused(site, picture):
    sample = site.upload(picture(mode="RGBA"))["id"]
    response = site.run(inputs=[{"sample": sample}])
    assert response.status_code == 422
    assert response.json()["errors"][0]["field"] == "inputs.0.crop"


def test_a_full_queue_is_busy(serve, tmp_path):
    with serve(tmp_path, queue_limit=1) as site, site.gate.closed():
        responses = [site.run(wait=False) for _ in range(3)]
        assert responses[-1].status_code == 503
        assert int(responses[-1].headers["Retry-After"]) > 0
        assert responses[-1].headers["Content-Type"] == "application/problem+json"


def test_the_archive_pages_through_listed_experiments_newest_first(serve, tmp_path):
    with serve(tmp_path) as site:
        ids = [site.finished(parameters={"seed": seed})["id"] for seed in range(3)]
        site.finished(listed=False)
        other = site.finished(method="adsn")["id"]
        seen, address = [], "/api/v1/experiments?limit=2"
        while address:
            response = site.client.get(address)
            seen.append([experiment["id"] for experiment in response.json()["experiments"]])
            address = response.links.get("next", {}).get("url")
            assert address == response.json()["next"]
        assert seen == [[other, ids[2]], [ids[1], ids[0]]]
        filtered = site.client.get("/api/v1/experiments", params={"method": "adsn", "limit": 1})
        assert [experiment["id"] for experiment in filtered.json()["experiments"]] == [other]
        assert "Link" not in filtered.headers
        page = site.client.get("/api/v1/experiments", params={"method": "rpn", "limit": 1}).json()["next"]
        assert "method=rpn" in page


@pytest.mark.parametrize(
    "query",
    [{"limit": 0}, {"limit": 101}, {"limit": "x"}, {"cursor": "%%"}, {"cursor": "a\x00"}, {"method": "nothing"}],
)
def test_a_query_that_does_not_fit_is_refused(site, query):
    response = site.client.get("/api/v1/experiments", params=query)
    assert (response.status_code, response.json()["errors"][0]["field"]) == (422, next(iter(query)))


class TestOwnership:
    def test_a_new_client_is_given_a_token_once_and_a_cookie(self, site):
        with site.visitor() as client:
            first = site.run(client=client)
            assert len(first.json()["owner_token"]) >= 20
            cookie = first.headers["Set-Cookie"].lower()
            assert "httponly" in cookie
            assert "samesite=lax" in cookie
            assert "secure" not in cookie
            second = site.run(client=client)
            assert "owner_token" not in second.json()
            assert "Set-Cookie" not in second.headers
            assert client.delete(second.json()["url"]).status_code == 204

    def test_the_cookie_is_secure_where_the_public_address_is(self, serve, tmp_path):
        with serve(tmp_path, base_url="https://texture.example.org/") as site:
            response = site.run(wait=False)
            assert "secure" in response.headers["Set-Cookie"].lower()
            assert response.json()["url"].startswith("https://texture.example.org/api/v1/experiments/")

    def test_the_token_works_as_a_bearer(self, site):
        with site.visitor() as client, site.visitor() as other:
            record = site.run(client=client).json()
            bearer = {"Authorization": f"Bearer {record['owner_token']}"}
            assert other.delete(record["url"]).status_code == 403
            assert (
                other.delete(record["url"], headers={"Authorization": "Bearer wrong-token-wrong-token"}).status_code
                == 403
            )
            assert other.delete(record["url"], headers=bearer).status_code == 204

    def test_deleted_is_gone(self, site, operator):
        record = site.finished()
        assert site.client.delete(record["url"], headers=operator).status_code == 204
        for address in (
            record["url"],
            f"{record['url']}/events",
            record["outputs"][0]["url"],
            f"{record['url']}/outputs.zip",
        ):
            response = site.client.get(address)
            assert (response.status_code, response.headers["Content-Type"]) == (410, "application/problem+json")
        assert site.client.delete(record["url"], headers=operator).status_code == 410

    def test_deleting_an_unfinished_experiment_cancels_it(self, site, operator, until):
        with site.gate.closed():
            record = site.run(wait=False).json()
            response = site.client.delete(record["url"], headers=operator)
            assert (response.status_code, response.json()["status"]) == (202, "cancelled")
            assert site.client.get(record["url"]).json()["status"] == "cancelled"
        assert site.client.delete(record["url"], headers=operator).status_code == 204

    def test_only_the_owner_lists_and_unlists(self, site):
        with site.visitor() as owner, site.visitor() as other:
            record = site.run(client=owner, parameters={"seed": 99}).json()
            assert other.patch(record["url"], json={"listed": False}).status_code == 403
            assert owner.patch(record["url"], json={"listed": False}).json()["listed"] is False
            listed = other.get("/api/v1/experiments").json()["experiments"]
            assert record["id"] not in [experiment["id"] for experiment in listed]
            assert other.get(record["url"]).status_code == 200
            assert owner.patch(record["url"], json={"listed": "no"}).status_code == 422


def test_many_clients_at_once_are_all_served(site):
    with ThreadPoolExecutor(8) as pool:
        responses = list(pool.map(lambda seed: site.run(parameters={"seed": seed}), range(16)))
    assert [response.json()["status"] for response in responses] == ["succeeded"] * 16


@pytest.mark.parametrize("name", METHODS)
def test_every_method_runs(site, film, animation, name):
    """As an experiment, whose record is complete and whose texture can be fetched; and in one call, with its bytes."""
    method = METHODS[name]
    photograph = site.client.get("/api/v1/samples/gravel_gray/image").content
    files = [animation(film(12, 64, 64)) if slot.moving else photograph for slot in method.inputs]
    crop = {"x": 4, "y": 8, "width": 56, "height": 48}
    inputs = [{"sample": site.upload(data)["id"], "crop": crop} for data in files]
    parameters = {**SMALL.get(name, {}), "seed": 3}
    record = site.finished(method=name, inputs=inputs, parameters=parameters)
    names = [output["name"] for output in record["outputs"]]
    assert names[0] == "texture"
    assert {"crop", *(f"crop-{number}" for number in range(2, len(files) + 1))} <= set(names)
    assert record["environment"] == environment()
    measured = record["diagnostics"]["structure"]
    kinds = [output["kind"] for output in record["outputs"]]
    assert (len(measured["inputs"]), len(measured["outputs"])) == (len(files), kinds.count("texture"))
    texture = site.client.get(record["outputs"][0]["url"])
    suffixes = ["", *(f"-{number}" for number in range(2, len(files) + 1))]
    answer = site.client.post(
        "/api/v1/synthesize",
        data={"method": name, **parameters, **{f"crop{suffix}": "4,8,56,48" for suffix in suffixes}},
        files={f"file{suffix}": (f"sample{suffix}", data) for suffix, data in zip(suffixes, files, strict=True)},
    )
    assert answer.status_code == 200, answer.text
    assert answer.content == texture.content
