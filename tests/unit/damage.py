"""Bytes as a bad disk, a bad cable or a bad editor leave them."""

from hypothesis import strategies as st

PAGE = 512  # [bytes] that are lost together


@st.composite
def damages(draw):
    """A function that damages bytes somewhere, in one of several ways."""
    where, length = draw(st.floats(0.0, 1.0)), draw(st.integers(1, PAGE))
    kind = draw(st.sampled_from(["flip", "cut", "zero", "repeat", "noise"]))
    bit, noise = 1 << draw(st.integers(0, 7)), draw(st.binary(min_size=1, max_size=8))

    def damage(content: bytes) -> bytes:
        at = min(int(where * len(content)), len(content) - 1)
        before, after = content[:at], content[at:]
        match kind:
            case "flip":
                return before + bytes([after[0] ^ bit]) + after[1:]
            case "cut":
                return before
            case "zero":
                return before + bytes(min(length, len(after))) + after[length:]
            case "repeat":
                return before + after[:length] + after
            case _:
                return before + noise + after[len(noise) :]

    return damage
