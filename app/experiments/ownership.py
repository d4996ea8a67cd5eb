"""Identifiers and tokens that nobody can guess."""

import hashlib
import hmac
import secrets

TOKEN_BYTES = 24
IDENTIFIER_BYTES = 12


def new_identifier() -> str:
    """An identifier for addresses: 96 random bits; never starts with ``-``, which a shell would take for an option.

    Examples
    --------
    >>> len(new_identifier())
    16
    """
    while (identifier := secrets.token_urlsafe(IDENTIFIER_BYTES)).startswith("-"):
        pass
    return identifier


def new_token() -> str:
    """A token that makes its holder the owner of what is submitted with it: 192 random bits."""
    return secrets.token_urlsafe(TOKEN_BYTES)


def token_digest(token: str) -> str:
    """What is kept of a token: its SHA-256 in hex.

    Examples
    --------
    >>> token_digest("texture")[:8]
    '38a3c50b'
    """
    return hashlib.sha256(token.encode(errors="replace")).hexdigest()


def same(one: str, other: str) -> bool:
    """Compare two secrets in constant time."""
    return hmac.compare_digest(one.encode(errors="replace"), other.encode(errors="replace"))
