"""Sentences for mirrored motions: sides and turns change places, other meanings of "left" and "right" stay."""

from __future__ import annotations

import re

_SWAPS = {
    "left": "right", "leftward": "rightward", "leftwards": "rightwards", "leftmost": "rightmost", "lefthand": "righthand",
    "lefty": "righty", "clockwise": "counterclockwise", "cw": "ccw",
}  # fmt: skip
_SWAPS |= {b: a for a, b in _SWAPS.items()} | {
    "anticlockwise": "clockwise", "anti-clockwise": "clockwise", "counter-clockwise": "clockwise", "counter clockwise": "clockwise", "anti clockwise": "clockwise",
}  # fmt: skip
_SIDED = r"(?:hand|arm|leg|foot|elbow|knee|shoulder|side|hip|ear|eye|fist|palm|wrist|cheek|thigh|ankle|heel|toe|finger|thumb|one|side|turn)s?"
_NOT_A_SIDE = re.compile(
    rf"""\b(?:
    right\ (?:away|now|after|afterwards|before|then|back|there|here|as|at|behind|beside|next|above|below|over|under|into|through|onto|past|when|in\ front|on\ top|up\ to|up\ against)
    |right\ (?:angles?|ways?|moves?|time|moment|answer|order|amount|thing|direction|speed|place|height|rhythm)\b
    |(?:all|that's|that\ is|is|are|am|was|be|you're|quite|exactly|just|about|serves?\ (?:him|her|them|me|you|it))\ right(?=\s*(?:[,.;!?]|$|and\b|to\b|so\b|when\b))
    |alright|outright
    |what(?:'s|\ is|\ was)\ left\b
    |(?:is|has|have|had|was|were|be|been|are|nothing|anything|something|none|one\ second|seconds?|time)\ left\b(?!\ {_SIDED}\b|\ of\b|-)
    |(?:he|she|they|it|we|who|person|man|woman|someone|somebody|figure|just)\ left\b(?!\ {_SIDED}\b)
    |left\ (?:the|his|her|their|a|an|without|behind|over|alone|out)\b
    )""",
    re.IGNORECASE | re.VERBOSE,
)  # fmt: skip
_WORDS = re.compile(rf"\b(?:{'|'.join(sorted(_SWAPS, key=len, reverse=True))})\b", re.IGNORECASE)

_CANONICAL = re.compile(r"right|(?<!anti-)(?<!counter-)(?<!anti)(?<!counter)clockwise|\bcw\b", re.IGNORECASE)


def mirror_words(sentence: str) -> str:
    """The sentence for the mirrored motion.

    "waves the left hand right away" -> "waves the right hand right away"; "left the room" stays. An ambiguous
    sentence ("he turned right as she came") is read as the idiom.
    """
    kept: list[str] = []

    def put_aside(match: re.Match[str]) -> str:
        kept.append(match[0])
        return f"\x00{len(kept) - 1}\x00"

    swapped = _WORDS.sub(_swap, _NOT_A_SIDE.sub(put_aside, sentence))
    return re.sub("\x00(\\d+)\x00", lambda m: kept[int(m[1])], swapped)


def canonical(sentence: str) -> tuple[str, bool]:
    """A sentence or its mirror image, whichever names the right (or clockwise) first, and whether it is the image.

    A sentence without sides is its own canonical form. So is a sentence that mirroring twice does not restore ("turn left as
    she came", since "right as" is an idiom).
    """
    image = mirror_words(sentence)
    back = mirror_words(image)
    if image in (sentence, back) or mirror_words(back) != image:
        return sentence, False
    first = next(ours for ours, theirs in zip(sentence.split(), image.split(), strict=False) if ours != theirs)
    return (sentence, False) if _CANONICAL.search(first) else (image, True)


def _swap(match: re.Match[str]) -> str:
    word = _SWAPS[match[0].lower()]
    if match[0].isupper():
        return word.upper()
    return word.capitalize() if match[0][0].isupper() else word
