"""HTTP caching: who may keep a picture and for how long, for every route that gives one and every kind of it.

Bytes may change at an address (exhibits are made again, converters become others), so only an address that names its
bytes is kept for ever; and what not everybody may see is kept by the browser alone.
"""

import html
import re
from datetime import UTC, datetime
from email.utils import format_datetime

import pytest

IMMUTABLE = "max-age=31536000, immutable"
LINK = re.compile(r'(?:src|href|poster|content)="(?:http://[^/"]+)?(/api/v1/(?:samples|experiments)/[^"]+)"')
SAMPLES = {
    "image": "",
    "image of 256": "image?size=256",
    "frame": "image?frame=0",
    "video": "video",
    "video as webm": "video?format=webm",
}
OUTPUTS = {
    "as stored": "texture",
    "crop": "crop",
    "thumbnail of the crop": ".thumbnail-crop",
    "thumbnail": ".thumbnail-texture",
    "preview": ".preview",
    "png": "texture?format=png",
    "jpeg": "texture?format=jpeg",
    "webp": "texture?format=webp",
    "tiff": "texture?format=tiff",
    "8 bits": "texture?depth=8",
    "16 bits": "texture?depth=16",
    "tiff of 16 bits": "texture?format=tiff&depth=16",
    "download": "texture?download=true&format=webp",
}
MOVING_OUTPUTS = {
    "video": "texture",
    "mp4": "texture?format=mp4",
    "animation": "preview",
    "poster": ".poster-texture",
    "cube": "cube",
}


@pytest.fixture(scope="module")
def upload(site):
    return site.upload()["id"]


@pytest.fixture(scope="module")
def experiments(site, upload, clip):
    """Experiments by kind: listed or not, of a bundled sample, of an upload, of a clip."""
    small = {"width": 40, "height": 36, "seed": 3}
    bundled = [{"sample": "gravel_gray", "crop": {"x": 0, "y": 0, "width": 32, "height": 24}}]
    uploaded = [{"sample": upload, "crop": {"x": 0, "y": 0, "width": 32, "height": 24}}]
    moving = {"method": "video-rpn", "inputs": [{"sample": clip}], "parameters": {"width": 40, "height": 36}}
    return {
        "listed": site.finished(inputs=bundled, parameters=small, listed=True),
        "unlisted": site.finished(inputs=bundled, parameters=small, listed=False),
        "listed, of an upload": site.finished(inputs=uploaded, parameters=small, listed=True),
        "unlisted, of an upload": site.finished(inputs=uploaded, parameters=small, listed=False),
        "listed video": site.finished(**moving, listed=True),
        "unlisted video": site.finished(**moving, listed=False),
    }


@pytest.fixture(scope="module")
def exhibit(gallery):
    """The address of an exhibit's outputs."""
    links = [link for path in ("/catalogue", "/figures") for link in LINK.findall(gallery.get(path).text)]
    return re.sub("/outputs/.*", "/outputs", next(link for link in links if "/outputs/" in link))


CASES = [
    *(("bundled", name, "public") for name in ("image", "image of 256", "frame")),
    *(("upload", name, "private") for name in ("image", "image of 256", "frame")),
    *(("clip", name, "private") for name in SAMPLES),
    *(("exhibit", name, "public") for name in OUTPUTS),
    *(
        (kind, name, "private" if kind.startswith("unlisted") else "public")
        for kind in ("listed", "unlisted", "listed, of an upload", "unlisted, of an upload")
        for name in OUTPUTS
    ),
    *(
        (kind, name, "private" if kind.startswith("unlisted") else "public")
        for kind in ("listed video", "unlisted video")
        for name in MOVING_OUTPUTS
    ),
]


@pytest.fixture
def picture(request, site, gallery, upload, clip, experiments, exhibit):
    """A client, the address of a picture, who may keep it, and when its original was made."""
    kind, name, scope = request.param
    samples = {"bundled": "gravel_gray", "upload": upload, "clip": clip}
    if kind in samples:
        record = site.client.get(f"/api/v1/samples/{samples[kind]}").json()
        return site.client, f"{record['url']}/{SAMPLES[name] or 'image'}", scope, record["created_at"]
    if kind == "exhibit":
        record = gallery.get(exhibit.removesuffix("/outputs")).json()
        return gallery, f"{exhibit}/{OUTPUTS[name]}", scope, record["finished_at"]
    record = experiments[kind]
    return site.client, f"{record['url']}/outputs/{(OUTPUTS | MOVING_OUTPUTS)[name]}", scope, record["finished_at"]


def joined(address, version):
    return f"{address}{'&' if '?' in address else '?'}v={version}"


@pytest.mark.parametrize("picture", CASES, indirect=True, ids=lambda case: f"{case[0]}: {case[1]}")
def test_an_address_that_does_not_name_its_bytes_is_asked_again(picture):
    """And what is answered then is the same as long as the tag is: 304, ranges, and the date of its original."""
    client, address, scope, made = picture
    answer = client.get(address)
    assert answer.status_code == 200
    assert answer.headers["Cache-Control"] == f"{scope}, no-cache"
    assert client.get(joined(address, "0" * 12)).headers["Cache-Control"] == f"{scope}, no-cache"
    tag = answer.headers["ETag"]
    assert re.fullmatch(r'"[0-9a-f]{64}[^"]*"', tag)
    modified = datetime.fromisoformat(made).astimezone(UTC)
    assert answer.headers["Last-Modified"] == format_datetime(modified, usegmt=True)
    same = client.get(address, headers={"If-None-Match": tag})
    assert (same.status_code, same.content) == (304, b"")
    assert [same.headers[name] for name in ("ETag", "Cache-Control")] == [tag, f"{scope}, no-cache"]
    assert client.get(address, headers={"If-None-Match": '"another"'}).status_code == 200
    for condition, status in ((tag, 206), ('"another"', 200), (answer.headers["Last-Modified"], 200)):
        part = client.get(address, headers={"Range": "bytes=2-5", "If-Range": condition})
        assert part.status_code == status
        assert part.content == (answer.content[2:6] if status == 206 else answer.content)
        assert part.headers["ETag"] == tag


def pages(client, records, samples):
    yield from ("/", "/archive", "/structure", "/methods", "/catalogue", "/figures")
    for sample in samples:
        yield f"/samples/{sample}"
    for record in records:
        yield f"/experiments/{record['id']}"
    if records:
        yield f"/compare/{records[0]['id']}/{records[1]['id']}"


def check_links(client, paths, is_public):
    """Every picture that a page shows is kept for ever, by those who may; number of them."""
    links = set()
    for path in paths:
        links |= {html.unescape(link) for link in LINK.findall(client.get(path).raise_for_status().text)}
    links = {link for link in links if "/image" in link or "/video" in link or "/outputs/" in link}
    for link in links:
        answer = client.get(link, headers={"Accept": "*/*"})
        assert answer.status_code == 200, link
        if "download=true" in link and "depth=16" in link:  # before it is computed nobody knows its bytes
            continue
        scope = "public" if is_public(link) else "private"
        assert answer.headers["Cache-Control"] == f"{scope}, {IMMUTABLE}", link
        again = client.get(link, headers={"If-None-Match": answer.headers["ETag"], "Accept": "*/*"})
        assert (again.status_code, again.headers["Cache-Control"]) == (304, f"{scope}, {IMMUTABLE}")
    return len(links)


def test_every_picture_of_a_page_names_its_bytes(site, upload, clip, experiments):

    def is_public(link):
        _, _, _, kind, identifier, *_ = link.split("/")
        if kind == "samples":
            return site.service.samples.get(identifier).bundled
        return site.service.experiments.get(identifier).listed

    with site.gate.closed():
        waiting = site.run(wait=False).json()
        paths = pages(site.client, [*experiments.values(), waiting], ["gravel_gray", upload, clip])
        shown = check_links(site.client, paths, is_public)
    assert shown > 40


def test_every_picture_of_an_exhibit_names_its_bytes(gallery):
    assert check_links(gallery, pages(gallery, [], []), lambda link: True) > 10


def test_an_output_at_16_bits_is_named_by_what_was_computed(site, experiments):
    """Not by the one of 8 bits, of which it is no copy: computed again elsewhere, it may be another."""
    record = experiments["listed"]
    address = f"{record['url']}/outputs/texture"
    site.client.get(f"{address}?depth=16").raise_for_status()
    deep = site.service.experiments.get(record["id"]).output(".texture-16")
    for query in ("depth=16", "format=tiff&depth=16"):
        assert site.client.get(f"{address}?{query}").headers["ETag"].startswith(f'"{deep.digest}')
    page = html.unescape(site.client.get(f"/experiments/{record['id']}", headers={"Accept": "text/html"}).text)
    link = re.search(r'href="([^"]*outputs/texture[^"]*format=png[^"]*depth=16[^"]*)"', page)[1]
    assert f"v={deep.digest[:12]}" in link
    assert site.client.get(link).headers["Cache-Control"].endswith(IMMUTABLE)


@pytest.mark.parametrize("path", ["texture?format=webp", "texture?depth=8", ".thumbnail-crop", ".preview"])
def test_another_version_of_a_converter_has_other_tags_and_addresses(site, experiments, monkeypatch, path):
    address = f"{experiments['listed']['url']}/outputs/{path}"
    before = site.client.get(address).headers["ETag"]
    for module in ("renditions", "versions"):
        monkeypatch.setattr(f"app.experiments.files.{module}.CONVERTER", "fedcba")
    after = site.client.get(address, headers={"If-None-Match": before})
    assert after.status_code == 200
    assert after.headers["ETag"] != before


def test_a_picture_that_is_unlisted_is_no_longer_kept_by_everybody(site, operator):
    record = site.finished(listed=True)
    address = f"{record['url']}/outputs/texture"
    assert site.client.get(address).headers["Cache-Control"].startswith("public")
    site.client.patch(record["url"], json={"listed": False}, headers=operator).raise_for_status()
    assert site.client.get(address).headers["Cache-Control"].startswith("private")


@pytest.mark.parametrize("path", ["texture", ".thumbnail-texture", "texture?format=webp"])
def test_a_file_that_is_removed_before_it_is_sent_is_not_found(site, experiments, monkeypatch, tmp_path, path):
    """Its experiment is deleted, or the cache makes room."""
    outputs = site.service.outputs
    fetch = outputs.fetch

    async def render(*arguments):
        return tmp_path / "gone.webp", "image/webp"

    async def fetch_gone(*names):
        return (await fetch(*names))[0], tmp_path / "gone"

    monkeypatch.setattr(outputs, "fetch", fetch_gone)
    monkeypatch.setattr(outputs, "render", render)
    answer = site.client.get(f"{experiments['listed']['url']}/outputs/{path}")
    assert (answer.status_code, answer.headers["Content-Type"]) == (404, "application/problem+json")
