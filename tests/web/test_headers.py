"""The headers that every answer has, by what is served at its address."""

import pytest

from app.web.headers import CONTENT_SECURITY_POLICY, security_headers

EVERYWHERE = {
    "Content-Security-Policy": CONTENT_SECURITY_POLICY,
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "same-origin",
    "Cross-Origin-Opener-Policy": "same-origin",
}


def test_the_policy_lets_in_files_of_the_service_alone_and_no_inline_script_or_style() -> None:
    policy = dict(part.split(" ", 1) for part in CONTENT_SECURITY_POLICY.split("; "))
    assert policy["default-src"] == policy["base-uri"] == policy["frame-ancestors"] == "'none'"
    assert {name: policy[name] for name in ("script-src", "style-src", "connect-src", "form-action", "media-src")} == (
        dict.fromkeys(("script-src", "style-src", "connect-src", "form-action", "media-src"), "'self'")
    )
    assert "unsafe" not in CONTENT_SECURITY_POLICY
    assert "http" not in CONTENT_SECURITY_POLICY


@pytest.mark.parametrize("path", ["/", "/samples/gravel", "/static/css/base.css", "/api", "/apiary"])
def test_pages_are_for_this_site_alone(path: str) -> None:
    headers = dict(security_headers(path))
    assert EVERYWHERE.items() <= headers.items()
    assert headers["Cross-Origin-Resource-Policy"] == "same-origin"
    assert "Access-Control-Allow-Origin" not in headers


def test_the_api_may_be_read_by_every_page_with_the_headers_that_clients_need() -> None:
    headers = dict(security_headers("/api/v1/methods"))
    assert EVERYWHERE.items() <= headers.items()
    assert headers["Cross-Origin-Resource-Policy"] == "cross-origin"
    assert headers["Access-Control-Allow-Origin"] == "*"
    exposed = headers["Access-Control-Expose-Headers"].split(", ")
    assert {"ETag", "Link", "Retry-After", "Content-Disposition", "Content-Range"} <= set(exposed)
    assert "Access-Control-Allow-Credentials" not in headers
