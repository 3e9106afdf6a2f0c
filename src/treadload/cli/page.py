"""`treadload app`: the page."""

from __future__ import annotations

import signal
from pathlib import Path
from typing import Annotated

import typer

from treadload.cli import shell

_HERE = "127.0.0.1"


def app(
    port: Annotated[int, typer.Option(min=0, max=65535, help="Port; a free one if left out.")] = 0,
    host: Annotated[
        str,
        typer.Option(help="Address to listen on; another than this machine's lets others in who have a link."),
    ] = _HERE,
    open_browser: Annotated[
        bool, typer.Option("--open/--no-open", help="Show the page in a browser at once.")
    ] = True,
    service: Annotated[
        Path | None,
        typer.Option(help="TOML file of a proxy with authentication in front of the page, and of limits."),
    ] = None,
    new_link: Annotated[
        bool,
        typer.Option("--new-link", help="Print a new address, good for one visit, of the page that runs, and end."),
    ] = False,
) -> None:
    """Play with tire and road on a page in your browser, served on this machine only."""
    from treadload.app import new_link as another
    from treadload.app import serve

    if new_link:
        typer.echo(f"treadload app: {another(port)}")
        return
    if service is None and host not in (_HERE, "localhost", "::1"):
        shell.err.print(
            f"listening on {host}: whoever reaches this machine and has an address like the one below can solve "
            "cases on it; what is sent is not encrypted",
            style="bold", markup=False,
        )  # fmt: skip
    if hasattr(signal, "SIGHUP"):
        # The server knows the others, and closes its sessions.
        signal.signal(signal.SIGHUP, lambda *_: signal.raise_signal(signal.SIGTERM))
    try:
        serve(host=host, port=port, open_browser=open_browser, service=service, units=shell.chosen_units())
    except KeyboardInterrupt:
        raise KeyboardInterrupt("the page is closed, and results that were not taken home are gone") from None
