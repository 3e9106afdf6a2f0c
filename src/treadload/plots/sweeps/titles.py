"""Titles of figures of studies: capitals, and parts of the line below on as many lines as they need."""

from __future__ import annotations

from collections.abc import Sequence

# Letters of a line under a title.
LETTERS = 62


def under(notes: Sequence[str], letters: int = LETTERS) -> str:
    """Parts of the line under a title, on as many lines as they need."""
    lines: list[str] = []
    for part in (note for note in notes if note):
        if lines and len(lines[-1]) + len(part) + 2 <= letters * 1.25:
            lines[-1] += f", {part}"
        else:
            lines.append(part)
    return "\n".join(lines)


def capital(words: str) -> str:
    """Words with a capital in front."""
    return words[:1].upper() + words[1:]
