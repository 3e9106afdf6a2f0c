"""The command line. Each module has the commands of one subject; `commands` puts them together."""

from __future__ import annotations

from treadload.cli import ending

__all__ = ["app", "main"]


def __getattr__(name: str) -> object:
    if name != "app":
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from treadload.cli.commands import app

    return app


def main() -> None:
    """Run the command line. Exit codes stand in `docs/howto/interruptions.md`."""
    # Before anything is loaded that an interruption could find half done.
    with ending.orderly():
        from treadload.cli.commands import app

        app()


if __name__ == "__main__":
    main()
