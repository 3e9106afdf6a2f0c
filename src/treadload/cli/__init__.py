"""The command line. Each module has the commands of one subject; `commands` puts them together."""

from __future__ import annotations

import gc

from treadload.cli import ending

# Objects before the garbage collector looks at the young ones, and how many such looks before one at older ones.
_COLLECTED = (20_000, 20, 20)

__all__ = ["app", "main"]


def __getattr__(name: str) -> object:
    if name != "app":
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from treadload.cli.commands import app

    return app


def main() -> None:
    """Run the command line. Exit codes stand in `docs/howto/interruptions.md`."""
    # Modules, fields and figures stay to the end of a command; looking at every 700 objects costs a tenth of it.
    gc.set_threshold(*_COLLECTED)
    # Before anything is loaded that an interruption could find half done.
    with ending.orderly():
        from treadload.cli.commands import app

        app()


if __name__ == "__main__":
    main()
