"""Tokens and identifiers that nobody can guess."""

import base64
import hashlib
import hmac
import secrets

TOKEN_BYTES = 24
IDENTIFIER_BYTES = 12


def new_identifier() -> str:
    """Make an identifier for addresses: 96 random bits; it never starts with ``-``, as an option of a shell does.

    Examples
    --------
    >>> len(new_identifier())
    16
    """
    while (identifier := secrets.token_urlsafe(IDENTIFIER_BYTES)).startswith("-"):
        pass
    return identifier


def new_token() -> str:
    """Make a token whose holder owns what is submitted with it: 192 random bits."""
    return secrets.token_urlsafe(TOKEN_BYTES)


def token_digest(token: str) -> str:
    """Digest a token, whose SHA-256 in hex is all that is kept of it.

    Examples
    --------
    >>> token_digest("texture")[:8]
    '38a3c50b'
    """
    return hashlib.sha256(token.encode(errors="replace")).hexdigest()


def derive_identifier(*parts: str) -> str:
    """Derive an identifier like those of `new_identifier` from parts, one of which must be a secret.

    Examples
    --------
    >>> derive_identifier("secret", "rpn") == derive_identifier("secret", "rpn")
    True
    >>> derive_identifier("secret", "rpn") == derive_identifier("secretr", "pn")
    False
    """
    identifier = _derived(IDENTIFIER_BYTES, "identifier", *parts)
    return f"_{identifier[1:]}" if identifier.startswith("-") else identifier


def derive_token(secret: str) -> str:
    """Derive a token like those of `new_token` from a secret, which it does not tell."""
    return _derived(TOKEN_BYTES, "token", secret)


def _derived(count: int, *parts: str) -> str:
    digest = hashlib.sha256("".join(f"{len(part)}:{part}" for part in parts).encode(errors="replace")).digest()
    return base64.urlsafe_b64encode(digest[:count]).decode()


def is_same_secret(one: str, other: str) -> bool:
    """Whether two secrets are the same; takes the same time wherever they differ."""
    return hmac.compare_digest(one.encode(errors="replace"), other.encode(errors="replace"))
