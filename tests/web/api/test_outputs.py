"""``/api/v1/experiments/{id}/outputs``."""

import json
import zipfile
from datetime import datetime
from hashlib import sha256
from io import BytesIO

import pytest
from PIL import Image


@pytest.fixture(name="texture")
def texture_url(experiment):
    return experiment["outputs"][0]["url"]


def test_an_output_is_cached_for_ever_under_its_version(site, experiment, texture):
    digest = site.client.get(texture).headers["ETag"].strip('"')
    response = site.client.get(texture, params={"v": digest[:12]})
    assert response.status_code == 200
    assert response.headers["Content-Type"] == "image/png"
    assert int(response.headers["Content-Length"]) == experiment["outputs"][0]["bytes"] == len(response.content)
    assert response.headers["ETag"] == f'"{digest}"'
    assert sha256(response.content).hexdigest() == digest
    assert "immutable" in response.headers["Cache-Control"]
    assert "public" in response.headers["Cache-Control"]
    assert Image.open(BytesIO(response.content)).size == (40, 36)


def test_an_unlisted_output_stays_out_of_shared_caches(site):
    record = site.finished(listed=False)
    assert "private" in site.client.get(record["outputs"][0]["url"]).headers["Cache-Control"]


@pytest.mark.parametrize("sent", ["{tag}", "W/{tag}", '"other", {tag}', "*"])
def test_what_the_client_has_is_not_sent_again(site, texture, sent):
    tag = site.client.get(texture).headers["ETag"]
    response = site.client.get(texture, headers={"If-None-Match": sent.format(tag=tag)})
    assert (response.status_code, response.content, response.headers["ETag"]) == (304, b"", tag)


def test_head_has_the_headers_of_get(site, experiment, texture):
    for address in (texture, f"{texture}?format=jpeg", experiment["url"], "/api/v1/methods", "/healthz"):
        head, get = site.client.head(address), site.client.get(address)
        assert (head.status_code, head.content) == (200, b"")
        for name in ("Content-Type", "Content-Length", "ETag", "Cache-Control"):
            assert head.headers.get(name) == get.headers.get(name)


@pytest.mark.parametrize(
    ("asked", "part"),
    [
        ("bytes=0-9", slice(0, 10)),
        ("bytes=10-", slice(10, None)),
        ("bytes=-7", slice(-7, None)),
        ("bytes=5-5", slice(5, 6)),
    ],
)
def test_a_range_is_that_part(site, texture, asked, part):
    whole = site.client.get(texture).content
    response = site.client.get(texture, headers={"Range": asked})
    assert (response.status_code, response.content) == (206, whole[part])
    assert response.headers["Content-Range"].endswith(f"/{len(whole)}")


@pytest.mark.parametrize("asked", ["bytes=9-2", "pages=1-2", "bytes=a-b", "bytes=0-1,5-6", "bytes", "bytes=--1"])
def test_a_range_that_makes_no_sense_is_ignored(site, texture, asked):
    assert site.client.get(texture, headers={"Range": asked}).status_code == 200


@pytest.mark.parametrize("asked", ["bytes=99999999-", "bytes=-0", "bytes=99999999-999999999"])
def test_a_range_behind_the_end_cannot_be_satisfied(site, texture, asked):
    response = site.client.get(texture, headers={"Range": asked})
    assert (response.status_code, response.headers["Content-Type"]) == (416, "application/problem+json")
    assert response.headers["Content-Range"] == f"bytes */{len(site.client.get(texture).content)}"


def test_a_range_of_another_version_gives_the_whole(site, texture):
    headers = {"Range": "bytes=0-9", "If-Range": '"another"'}
    assert site.client.get(texture, headers=headers).status_code == 200
    tag = site.client.get(texture).headers["ETag"]
    assert site.client.get(texture, headers={**headers, "If-Range": tag}).status_code == 206


def test_the_range_of_a_head_is_ignored(site, texture):
    assert site.client.head(texture, headers={"Range": "bytes=0-9"}).status_code == 200


@pytest.mark.parametrize(
    ("format", "media_type", "suffix"),
    [
        ("png", "image/png", "png"),
        ("jpeg", "image/jpeg", "jpg"),
        ("webp", "image/webp", "webp"),
        ("tiff", "image/tiff", "tif"),
    ],
)
def test_outputs_come_in_four_formats(site, texture, format, media_type, suffix):
    response = site.client.get(texture, params={"format": format, "download": "true"})
    assert response.headers["Content-Type"] == media_type
    assert Image.open(BytesIO(response.content)).size == (40, 36)
    disposition = response.headers["Content-Disposition"]
    assert disposition.startswith("attachment")
    assert "rpn-40x36-seed7-" in disposition
    assert disposition.endswith(f'-texture.{suffix}"')
    again = site.client.get(texture, params={"format": format}, headers={"If-None-Match": response.headers["ETag"]})
    assert again.status_code == 304


def test_validators_differ_between_formats(site, texture):
    queries = [{}, {"format": "jpeg"}, {"format": "tiff"}, {"format": "png", "depth": "16"}]
    assert len({site.client.get(texture, params=query).headers["ETag"] for query in queries}) == len(queries)


def test_the_texture_comes_in_16_bits(site, texture):
    data = site.client.get(texture, params={"format": "png", "depth": 16}).content
    assert data[24] == 16  # bit depth of the header
    assert site.client.get(texture, params={"format": "jpeg", "depth": 16}).status_code == 422


@pytest.mark.parametrize("query", [{"format": "gif"}, {"depth": "12"}, {"download": "perhaps"}])
def test_a_query_that_does_not_fit_is_refused(site, texture, query):
    assert site.client.get(texture, params=query).status_code == 422


def test_everything_comes_as_one_zip(site, experiment):
    response = site.client.get(f"{experiment['url']}/outputs.zip")
    assert response.headers["Content-Type"] == "application/zip"
    assert response.headers["Content-Disposition"].endswith('.zip"')
    with zipfile.ZipFile(BytesIO(response.content)) as archive:
        assert archive.testzip() is None
        names = {f"{output['name']}.png" for output in experiment["outputs"]}
        assert set(archive.namelist()) == {"record.json", *names}
        record = json.loads(archive.read("record.json"))
        assert record["parameters"] == experiment["parameters"]
        texture = site.client.get(experiment["outputs"][0]["url"]).content
        assert archive.read("texture.png") == texture


def test_outputs_that_are_not_there_yet_are_not_found(site):
    with site.gate.closed():
        url = site.run(wait=False).json()["url"]
        assert site.client.get(f"{url}/outputs/texture").status_code == 404
        assert site.client.get(f"{url}/outputs.zip").status_code == 409


@pytest.mark.parametrize("name", ["nothing", "..%2F..%2Fsecret", "a%00"])
def test_an_unknown_output_is_not_found(site, experiment, name):
    response = site.client.get(f"{experiment['url']}/outputs/{name}")
    assert (response.status_code, response.headers["Content-Type"]) == (404, "application/problem+json")


def test_a_zip_is_the_same_file_whenever_it_is_asked_for(site, experiment):
    """Its files are dated as the experiment was finished, not as they were packed."""
    address = f"/api/v1/experiments/{experiment['id']}/outputs.zip"
    packed = site.client.get(address).content
    finished = datetime.fromisoformat(experiment["finished_at"]).timetuple()[:6]
    with zipfile.ZipFile(BytesIO(packed)) as archive:
        dates = {entry.date_time for entry in archive.infolist()}
    assert dates == {(*finished[:5], finished[5] // 2 * 2)}  # ZIP counts every other second
    assert site.client.get(address).content == packed
