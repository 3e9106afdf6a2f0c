"""Write the table of docs/explanation/validation.md as this machine measures it: python docs/validation.py."""

from pathlib import Path

from treadload.validation import format_markdown, run_checks

PAGE = Path(__file__).parent / "explanation" / "validation.md"


def main() -> None:
    """What stands before the table stays."""
    checks = list(run_checks())
    if not all(check.passed for check in checks):
        raise SystemExit("a check failed: treadload validate says which")
    head = PAGE.read_text(encoding="utf-8").partition("| problem |")[0]
    PAGE.write_text(f"{head}{format_markdown(checks)}\n", encoding="utf-8")


if __name__ == "__main__":
    main()
