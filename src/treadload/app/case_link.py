"""A case as a link: its tables in the part of an address behind "#", which a browser does not send."""

from __future__ import annotations

import base64
import binascii
import json
import zlib
from collections.abc import Collection, Mapping

from treadload.app.form import Form, leaves_of
from treadload.errors import InputError
from treadload.templates import KINDS

PREFIX = "case="
"""What the part behind "#" begins with."""
# The version of what follows; letters that mail and chat leave whole; bytes that a link may unpack to.
_VERSION, _MOST_LETTERS, _MOST_BYTES = "1.", 8000, 200_000
_AGAIN = "copy the whole link again, or ask for the case as a TOML file"


def link_of(form: Form, uploaded: Collection[str]) -> str:
    """The part of an address that restores a form, behind "#".

    uploaded: names under which the user's files are kept. Raises InputError for a case that needs one of them, and
    for a case that is too long.
    """
    files = [value for value in leaves_of(form.table).values() if isinstance(value, str) and value in uploaded]
    if files:
        raise InputError(
            f"this case reads {len(files)} uploaded file(s), which a link cannot hold; take the case home as TOML "
            "and send it together with the files"
        )
    text = json.dumps({"command": form.command, "case": form.table, "yours": sorted(form.yours)},
                      separators=(",", ":"), ensure_ascii=False)  # fmt: skip
    packed = base64.urlsafe_b64encode(zlib.compress(text.encode("utf-8"), 9)).decode("ascii").rstrip("=")
    if len(packed) > _MOST_LETTERS:
        raise InputError(
            f"this case makes a link of {len(packed)} letters, and {_MOST_LETTERS} are the most that mail and chat "
            "programs leave whole; take the case home as TOML"
        )
    return f"{PREFIX}{_VERSION}{packed}"


def form_of_link(link: str, command: str) -> Form:
    """The form that a link restores. link: the part behind "#". command: of the page. Raises InputError."""
    packed = link.removeprefix("#").removeprefix(PREFIX)
    if not packed.startswith(_VERSION):
        raise InputError(f"this link holds a case of another version of treadload, or none; {_AGAIN}")
    packed = packed.removeprefix(_VERSION)
    if len(packed) > _MOST_LETTERS:
        raise InputError(f"this link has {len(packed)} letters, and {_MOST_LETTERS} are the most; {_AGAIN}")
    try:
        unpacking = zlib.decompressobj()
        text = unpacking.decompress(
            base64.b64decode(packed + "=" * (-len(packed) % 4), b"-_", validate=True), _MOST_BYTES
        )
        if unpacking.unconsumed_tail or not unpacking.eof:
            raise InputError(f"this link is cut off, or holds more than {_MOST_BYTES} bytes; {_AGAIN}")
        content = json.loads(text)
        table, command_of_link, yours = content["case"], content["command"], content["yours"]
    except (binascii.Error, zlib.error, UnicodeError, ValueError, KeyError, TypeError, RecursionError) as error:
        if isinstance(error, InputError):
            raise
        raise InputError(f"this link is damaged, so that no case can be read from it; {_AGAIN}") from error
    if not isinstance(table, Mapping) or command_of_link not in KINDS or not isinstance(yours, list):
        raise InputError(f"this link holds no case; {_AGAIN}")
    if command_of_link != command:
        where = "life" if command_of_link == "life" else "the bench"
        raise InputError(f"this link holds a case of another page; open it on the page {where!r}")
    form = Form(dict(table), frozenset(str(key) for key in yours), command)
    # Paths of this machine are refused as those of a file of a case are.
    refused = form.refused()
    if refused:
        raise InputError(f"the case of this link is not opened: {refused}")
    return form
