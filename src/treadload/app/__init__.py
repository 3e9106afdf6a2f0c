"""A page to play with tire and road, served to browsers on this machine: `treadload app`."""

from __future__ import annotations

from pathlib import Path

from treadload.errors import InputError, how_to_install
from treadload.us_units import display_units

__all__ = ["new_link", "serve"]


def serve(
    *,
    host: str = "127.0.0.1",
    port: int = 0,
    open_browser: bool = True,
    service: Path | None = None,
    units: str = "si",
) -> None:
    """Serve the page until it is interrupted.

    host: that it listens on; another than that of this machine lets others in who have an address of it. port: 0
    takes a free one. open_browser: show the page at once. service: a TOML file with the address of a proxy in front
    of the server and limits of memory and time, see `treadload.app.service.ServiceFile`. units: of results,
    "si" or "us"; fields take SI units. Raises InputError without the packages of the extra "app", for a port that
    is taken, for a file that cannot be used, and for other units.
    """
    try:
        import nicegui  # noqa: F401
        import plotly  # noqa: F401
    except ImportError as error:
        raise InputError(f"the page needs {error.name}, which is not installed; {how_to_install('app')}") from error
    from treadload.app.server import run
    from treadload.app.service import Service

    # Tasks and requests of the server run in copies of this context.
    with display_units(units):
        run(host, port, service=None if service is None else Service.from_toml(service), open_browser=open_browser)


def new_link(port: int = 0) -> str:
    """Another address, good for one visit, of the page that this user serves on this machine.

    port: of its server, where there are several. Raises InputError where there is none.
    """
    from treadload.app.links import new_link as another

    return another(port)
