"""Characters that standard output cannot show, spelt with those that it can."""

from __future__ import annotations

import codecs
import sys
import unicodedata

SPELT = "treadload.spelt"
"""Name of the error handler of codecs that spells: `stream.reconfigure(errors=SPELT)`."""

_SIGNS = {
    "…": "...", "–": "-", "—": "-", "−": "-", "‐": "-", "·": "*", "×": "x", "÷": "/", "∗": "*", "⋅": "*",
    "→": "->", "←": "<-", "↔": "<->", "≤": "<=", "≥": ">=", "≈": "~", "≠": "!=", "±": "+/-", "∓": "-/+",
    "√": "sqrt ", "∞": "inf", "°": "deg", "‰": " per mille", "∂": "d", "∫": "int ", "∇": "grad ",
    "“": '"', "”": '"', "„": '"', "«": '"', "»": '"', "‘": "'", "’": "'", "′": "'", "″": '"',
    "ß": "ss", "æ": "ae", "Æ": "AE", "ø": "o", "Ø": "O", "œ": "oe", "ı": "i", "ł": "l", "Ł": "L", "€": "EUR",
    "✓": "yes", "✗": "no", "•": "*", "⟨": "<", "⟩": ">", "⌈": "[", "⌉": "]",
}  # fmt: skip


def printable(text: str) -> str:
    """A text as standard output can show it; one without an encoding, as in memory, takes the text as it is."""
    encoding = getattr(sys.stdout, "encoding", None)
    return spelt(text, encoding) if encoding else text


def spelt(text: str, encoding: str) -> str:
    """A text with the characters only that an encoding has: σ₁ ≤ 10⁻⁶ µm becomes sigma_1 <= 10^-6 um in ASCII."""
    return text.encode(encoding, SPELT).decode(encoding)


def _handler(error: UnicodeError) -> tuple[str, int]:
    """The characters that a codec could not encode, spelt in ASCII."""
    if not isinstance(error, UnicodeEncodeError):
        raise error
    text = error.object
    return "".join(_in_ascii(text, place) for place in range(error.start, error.end)), error.end


def _in_ascii(text: str, place: int) -> str:
    letter = text[place]
    if letter in _SIGNS:
        return _SIGNS[letter]
    # A byte of the name of a file that is not text.
    if "\udc80" <= letter <= "\udcff":
        return f"\\x{ord(letter) - 0xDC00:02x}"
    kind, _, base = unicodedata.decomposition(letter).partition(" ")
    # Of two letters, as ™ is, they are not an exponent.
    if kind in ("<super>", "<sub>") and " " not in base:
        mark = "^" if kind == "<super>" else "_"
        before = unicodedata.decomposition(text[place - 1]) if place else ""
        plain = chr(int(base, 16))
        return ("" if before.startswith(kind) else mark) + (plain if plain.isascii() else _in_ascii(plain, 0))
    if letter in "µμ":
        # Of a unit, or the coefficient of friction.
        return "u" if text[place + 1 : place + 2].isalpha() else "mu"
    name = unicodedata.name(letter, "")
    if name.startswith("GREEK ") and " LETTER " in name:
        plain = name.split(" LETTER ")[1].split(" WITH ")[0].split()[-1].lower()
        return plain.capitalize() if "CAPITAL" in name else plain
    plain = "".join(part for part in unicodedata.normalize("NFKD", letter).replace("⁄", "/") if part.isascii())
    return plain or letter.encode("ascii", "backslashreplace").decode("ascii")


codecs.register_error(SPELT, _handler)
