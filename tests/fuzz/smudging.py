"""Changes of the bytes of a file."""

from __future__ import annotations

import random

_LONG = (b"\xff\xff\xff\xff", b"\0\0\0\0", b"\x7f\xff\xff\xff", b"\0\0\0\x80", b"\xff\xff\xff\x7f", b"\0\0\xc0\x7f")


def broken(rng: random.Random, content: bytes) -> bytes:
    """The content with bytes changed, cut out, doubled, put in or cut off, in one place or in several."""
    changed = bytearray(content)
    for _ in range(rng.choice((1, 1, 1, 2, 4, 8))):
        # Headers stand in front.
        place = rng.randrange(max(1, rng.choice((64, 512, len(changed)))))
        place = min(place, max(0, len(changed) - 1))
        which = rng.randrange(7)
        if which == 0:
            changed[place : place + 1] = bytes([rng.randrange(256)])
        elif which == 1:
            changed[place : place + 1] = bytes([(changed[place] if changed else 0) ^ (1 << rng.randrange(8))])
        elif which == 2:
            del changed[place : place + rng.randrange(1, 60)]
        elif which == 3:
            changed[place:place] = bytes(rng.randrange(256) for _ in range(rng.randrange(1, 20)))
        elif which == 4:
            changed[place : place + 4] = rng.choice(_LONG)
        elif which == 5:
            part = changed[place : place + rng.randrange(1, 60)]
            changed[place:place] = part * rng.choice((1, 1, 20))
        elif rng.random() < 0.3:
            changed = changed[:place]
        else:
            digits = [at for at, sign in enumerate(changed) if sign in b"0123456789"]
            if digits:
                at = rng.choice(digits)
                changed[at : at + 1] = rng.choice((b"", b"-", b"e", b".", b"9" * 12, b"0", b"nan", b"\xb2"))
    return bytes(changed)
