"""What a browser may do on a page of ours: the headers of every answer, and a nonce for what the page brings.

Scripts and style sheets run where they come from this server as files, or where their tag carries the nonce of the
answer that they came in. What a text of a file smuggles into the page has neither. Two things stay open, because the
framework of the page cannot do without: `eval` of what its own scripts hand it (Vue compiles the templates of its
components in the browser, and the server's commands arrive as text), and style attributes (plotly writes them).
"""

from __future__ import annotations

import re
import secrets
from typing import Any

NONCE = "treadload.nonce"
"""Key of a request's scope under which the nonce of its answer stands."""

# The hash of nothing: plotly and the framework add style sheets that are empty, which scripts then fill.
_EMPTY = "'sha256-47DEQpj8HBSa+/TImW+5JCeuQeRkm5NMpJWZG3hSuFU='"
_TAG = re.compile(r"<(script|style)(?=[\s>])")
_FIXED = {
    "cross-origin-opener-policy": "same-origin",
    "cross-origin-resource-policy": "same-origin",
    "permissions-policy": "camera=(), geolocation=(), microphone=(), payment=(), usb=()",
    "referrer-policy": "no-referrer",
    "x-content-type-options": "nosniff",
    "x-frame-options": "DENY",
}


def new_nonce() -> str:
    """A nonce that nobody guesses."""
    return secrets.token_urlsafe(18)


def headers_of(nonce: str = "", socket: str = "") -> list[tuple[bytes, bytes]]:
    """The headers of an answer.

    nonce: of the scripts and style sheets in it, "" where it has none. socket: scheme and host of the page's
    socket, such as "ws://127.0.0.1:8137", "" for an answer that loads nothing.
    """
    headers = {"content-security-policy": _policy(nonce, socket), **_FIXED}
    return [(name.encode(), value.encode()) for name, value in headers.items()]


def _policy(nonce: str, socket: str) -> str:
    ends = "object-src 'none'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
    if not socket:
        return f"default-src 'none'; {ends}"
    return (
        "default-src 'none'; "
        f"script-src 'self' 'nonce-{nonce}' 'unsafe-eval'; script-src-attr 'none'; "
        f"style-src 'self' 'nonce-{nonce}' {_EMPTY}; style-src-attr 'unsafe-inline'; "
        f"img-src 'self' data: blob:; font-src 'self'; connect-src 'self' {socket}; {ends}"
    )


def give_nonces(loader: Any) -> None:
    """Let the scripts and style sheets of templates carry the nonce of their answer. loader: of jinja2."""
    inner = loader.get_source

    def get_source(environment: object, template: str) -> tuple[object, ...]:
        source, *rest = inner(environment, template)
        return (_TAG.sub(rf'<\1 nonce="{{{{ request.scope["{NONCE}"] }}}}"', source), *rest)

    loader.get_source = get_source
