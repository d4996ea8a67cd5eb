"""What browsers are told, and what other sites' pages may do."""

from html import unescape

import pytest

RECORD = {"method": "rpn", "inputs": [{"sample": "gravel_gray"}]}

PATHS = ["/", "/docs", "/api/v1/methods", "/api/v1/nothing", "/nothing", "/static/js/pages/docs.js"]


@pytest.mark.parametrize("path", PATHS)
def test_every_answer_has_the_strict_headers(site, path):
    headers = site.client.get(path).headers
    policy = dict(part.split(" ", 1) for part in headers["Content-Security-Policy"].split("; "))
    assert policy["default-src"] == policy["base-uri"] == policy["frame-ancestors"] == "'none'"
    assert policy["script-src"] == policy["style-src"] == policy["connect-src"] == policy["form-action"] == "'self'"
    assert "unsafe" not in headers["Content-Security-Policy"]
    assert headers["X-Content-Type-Options"] == "nosniff"
    assert headers["Referrer-Policy"] == "same-origin"
    assert headers["Cross-Origin-Opener-Policy"] == "same-origin"
    assert "geolocation=()" in headers["Permissions-Policy"]
    assert headers["Cache-Control"]


def test_any_page_may_read_the_api(site):
    response = site.client.get("/api/v1/methods", headers={"Origin": "https://elsewhere.example"})
    assert response.headers["Access-Control-Allow-Origin"] == "*"
    assert "Access-Control-Allow-Credentials" not in response.headers
    assert response.headers["Cross-Origin-Resource-Policy"] == "cross-origin"
    assert "Access-Control-Allow-Origin" not in site.client.get("/").headers


def test_a_preflight_allows_reading_only(site):
    headers = {"Origin": "https://elsewhere.example", "Access-Control-Request-Method": "DELETE"}
    response = site.client.options("/api/v1/experiments/x", headers=headers)
    assert (response.status_code, response.headers["Access-Control-Allow-Methods"]) == (204, "GET, HEAD")
    assert response.headers["Access-Control-Allow-Origin"] == "*"


@pytest.mark.parametrize(
    "headers",
    [
        {"Sec-Fetch-Site": "cross-site"},
        {"Sec-Fetch-Site": "same-site"},
        {"Origin": "https://elsewhere.example"},
        {"Origin": "null"},
    ],
)
@pytest.mark.parametrize("path", ["/api/v1/experiments", "/samples", "/experiments/x/delete"])
def test_another_sites_page_changes_nothing(site, path, headers):
    assert site.client.post(path, json=RECORD, headers=headers).status_code == 403


@pytest.mark.parametrize(
    ("headers", "origin"),
    [
        ({"Origin": "http://texture.lan"}, "http://texture.lan"),
        ({"Origin": "http://texture.lan:8080", "Host": "texture.lan"}, "http://texture.lan:8080"),
        ({"Sec-Fetch-Site": "cross-site"}, "nothing"),
        ({"Origin": "https://<script>.example/" + 9999 * "x"}, "https://<script>.example/x"),
    ],
)
def test_a_refused_origin_tells_the_operator_what_to_set(site, headers, origin):
    """As a page and as a problem: both headers that were compared, and the setting that settles it."""
    problem = site.client.post("/api/v1/experiments", json=RECORD, headers=headers)
    assert problem.headers["Content-Type"] == "application/problem+json"
    page = site.client.post("/experiments/x/delete", headers=headers)
    assert page.headers["Content-Type"].startswith("text/html")
    host = headers.get("Host", site.url.removeprefix("http://"))
    for answer, text in [(problem, problem.json()["detail"]), (page, unescape(page.text))]:
        assert answer.status_code == 403
        assert f"Origin header says {origin}" in text
        assert f"Host header says {host}." in text
        assert "MICROTEXTURE_BASE_URL" in text
        assert "it is not set" in text
        assert len(text) < 3000
    assert "<script>.example" not in page.text


def test_a_public_address_that_does_not_fit_is_named(serve, tmp_path):
    with serve(tmp_path, base_url="https://texture.example.org/") as site:
        answer = site.client.post("/api/v1/experiments", json=RECORD, headers={"Origin": "http://texture.lan"})
        assert answer.status_code == 403
        assert "MICROTEXTURE_BASE_URL" in answer.json()["detail"]
        assert "it is https://texture.example.org" in answer.json()["detail"]


@pytest.mark.parametrize("sent", [{}, {"Sec-Fetch-Site": "same-origin", "Origin": "{url}"}, {"Origin": "{url}"}])
def test_programs_and_our_own_pages_do(site, sent):
    headers = {name: value.format(url=site.url) for name, value in sent.items()}
    assert site.client.post("/api/v1/experiments", json=RECORD, headers=headers).status_code == 202


def test_our_own_pages_behind_a_proxy_do(serve, tmp_path):
    with serve(tmp_path, base_url="https://texture.example.org") as site:
        headers = {"Origin": "https://texture.example.org"}
        assert site.client.post("/api/v1/experiments", json=RECORD, headers=headers).status_code == 202
