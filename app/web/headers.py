"""Security headers: Content-Security-Policy (CSP), CORS for reads of the API, Referrer-Policy.

Any web page may *read* the API, without cookies: results are public, or have an unguessable address.
"""

from collections.abc import Iterator

API_PREFIX = "/api/"

CONTENT_SECURITY_POLICY = "; ".join(
    [
        "default-src 'none'",
        "script-src 'self'",
        "style-src 'self'",
        "img-src 'self' data: blob:",
        "media-src 'self'",
        "connect-src 'self'",
        "form-action 'self'",
        "base-uri 'none'",
        "frame-ancestors 'none'",
    ]
)
_HEADERS = {
    "Content-Security-Policy": CONTENT_SECURITY_POLICY,
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "same-origin",  # the address of an unlisted experiment is its only lock
    "Permissions-Policy": "camera=(), microphone=(), geolocation=(), payment=(), usb=()",
    "Cross-Origin-Opener-Policy": "same-origin",
}
_READABLE_HEADERS = (
    "Accept-Ranges, Content-Disposition, Content-Range, ETag, Link, RateLimit, RateLimit-Policy, Retry-After, "
    "X-Request-ID"
)


def security_headers(path: str) -> Iterator[tuple[str, str]]:
    """Give the headers that every answer at this path has."""
    yield from _HEADERS.items()
    if path.startswith(API_PREFIX):
        yield "Cross-Origin-Resource-Policy", "cross-origin"
        yield "Access-Control-Allow-Origin", "*"
        yield "Access-Control-Expose-Headers", _READABLE_HEADERS
    else:
        yield "Cross-Origin-Resource-Policy", "same-origin"
