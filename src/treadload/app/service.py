"""The page as a service for a few people: behind a proxy that knows who they are, with limits of memory and time.

The proxy ends TLS, asks for passwords and states the user in a header. It proves that it is the proxy by a secret, as
every account of the machine can send headers to the port of the server. Nothing here is on unless a file asks for it.
"""

from __future__ import annotations

import hmac
import re
import stat
import sys
from dataclasses import dataclass, field
from pathlib import Path
from urllib.parse import urlsplit

from treadload.errors import InputError
from treadload.files import parse_toml, text_of
from treadload.units import Time

SECRET_HEADER = "x-treadload-proxy"
"""Header in which the proxy sends its secret."""

# A solving process holds 250 to 475 MB before its first case.
_LEAST_MEMORY, _LEAST_TIME = 1000, 5.0
_LEAST_SECRET = 32
_HEADER = re.compile("[a-z0-9-]+")
_PATH = re.compile("(/[A-Za-z0-9._~-]+)*/?")


@dataclass(frozen=True)
class Proxy:
    """What stands between browsers and the server.

    address: of the page as browsers know it, such as "https://lab.example/treadload/". user_header: name of the
    header in which the proxy states the user, in small letters. secret: that it sends in `SECRET_HEADER`.
    """

    address: str
    user_header: str
    secret: str = field(repr=False)

    def __post_init__(self) -> None:
        parts = urlsplit(self.address)
        if (
            parts.scheme not in ("https", "http")
            or not parts.hostname
            or parts.query
            or parts.fragment
            or parts.username
        ):
            raise InputError(
                'address is the page as browsers know it, such as "https://lab.example/treadload/", got '
                f"{self.address!r}"
            )
        if not _PATH.fullmatch(parts.path):
            raise InputError(f"the path of an address has letters, digits and .-_~ only, got {parts.path!r}")
        if not _HEADER.fullmatch(self.user_header) or self.user_header == SECRET_HEADER:
            raise InputError(f'user_header names a header, such as "X-Remote-User", got {self.user_header!r}')
        if len(self.secret) < _LEAST_SECRET or not self.secret.isascii() or not self.secret.isprintable():
            raise InputError(
                f"the secret of the proxy needs {_LEAST_SECRET} printable ASCII characters or more, got "
                f"{len(self.secret)}; make it by `openssl rand -hex 32`"
            )

    @property
    def host(self) -> str:
        """Host, and port where it is not the usual one, as browsers send it."""
        return urlsplit(self.address).netloc.lower()

    @property
    def origin(self) -> str:
        """Scheme and host, as browsers send them."""
        return f"{urlsplit(self.address).scheme}://{self.host}"

    @property
    def base(self) -> str:
        """The path below which the page lies, "" for the root."""
        return urlsplit(self.address).path.rstrip("/")

    def proves(self, secret: str) -> bool:
        """True for the secret."""
        return hmac.compare_digest(self.secret.encode(), secret.encode("utf-8", "replace"))


@dataclass(frozen=True)
class Limits:
    """What a solving process may use. memory: MB, time: s of one request; None for no limit."""

    memory: int | None = None
    time: float | None = None

    def __post_init__(self) -> None:
        if self.memory is not None and self.memory < _LEAST_MEMORY:
            raise InputError(f"memory_limit_mb must be at least {_LEAST_MEMORY}, got {self.memory}")
        if self.memory is not None and not sys.platform.startswith("linux"):
            raise InputError(f"memory_limit_mb works on Linux only, and this is {sys.platform}; leave it out")
        if self.time is not None and not self.time >= _LEAST_TIME:
            raise InputError(f"time_limit must be at least {_LEAST_TIME:g} s, got {self.time:g} s")


@dataclass(frozen=True)
class ServiceFile:
    """`treadload app --service service.toml`.

    address, user_header: see `Proxy`. secret_file: holds the secret and nothing else; only its owner may read it.
    memory_limit_mb, time_limit: see `Limits`.
    """

    address: str
    user_header: str
    secret_file: Path
    memory_limit_mb: int | None = None
    time_limit: Time | None = None

    def proxy(self) -> Proxy:
        """What the server must know of its proxy. Raises InputError."""
        secret = text_of(self.secret_file, "a file with the secret of the proxy").strip()
        if sys.platform != "win32" and stat.S_IMODE(self.secret_file.stat().st_mode) & 0o077:
            raise InputError(f"{self.secret_file} can be read by others; run `chmod 600 {self.secret_file}`")
        return Proxy(self.address, self.user_header.lower(), secret)


@dataclass(frozen=True)
class Service:
    """How a server is offered. proxy: None for visitors who come by an address with a token."""

    proxy: Proxy | None = None
    limits: Limits = field(default_factory=Limits)

    @classmethod
    def from_toml(cls, path: Path) -> Service:
        """Of a file, see `ServiceFile`. Raises InputError that names the file and the key."""
        from treadload.read import read

        table = parse_toml(text_of(path, "a TOML file with the address of the page"), str(path))
        service: ServiceFile = read(ServiceFile, table, str(path), folder=path.parent)
        try:
            return cls(service.proxy(), Limits(service.memory_limit_mb, service.time_limit))
        except InputError as error:
            raise InputError(f"{path}: {error}") from None
