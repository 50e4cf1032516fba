"""Patterns of the words by which English orders two actions in time, for `mmm_core.language.clauses`.

Texts have single blanks between their words.
"""

from __future__ import annotations

import re

from mmm_core.language.count_words import ADVERBS, NUMBERS


def _any(*phrases: str) -> str:
    """A pattern for any of some phrases."""
    return "(?:" + "|".join(phrases) + ")"


def _pattern(pattern: str) -> re.Pattern[str]:
    return re.compile(pattern, re.IGNORECASE)


_WHO = _any("you", "he", "she", "it", "they", "we", "the robot")
_HAVE = _any("'s", "'ve", "'re", " is", " are", " has", " have", "")
_NUMBER = _any(*(word for word in NUMBERS if word.isalpha()), r"\d+")
DONE = (
    _any("once", "when", "as soon as", "after", "the moment")
    + r"\s+"
    + _any("that", "this", "you", "he", "she", "it", "they", r"the \w+")
    + _HAVE
    + _any(" been", "")
    + r"\s+"
    + _any("done (?:both|that|this|so|it)", "done", "finished", "finish", "through", "over", "down", "completed?")
    + r"(?: with (?:that|this|it))?(?! \w+ing\b| with\b)"
)
"""'Once that is done'."""
BACK_UP = (
    r"(?:once|when|as soon as) you(?:'re| are| stand| get| come)(?: back)?"
    r"(?: up| upright| straight| there| in (?:place|position)| that far)(?: again)?"
)
"""'Once you're up again'."""
NEXT = _any(
    "(?:only |just )?then(?! some)",
    "(?:(?:straight|right|directly|immediately|soon|shortly) )?(?:after|following) (?:all )?(?:that|this|which)",
    "afterwards?", "thereafter", "thereupon", "whereupon",
    "subsequently", r"(?<!\bthe )next(?!\s+to\b)",
    "later(?: on)?", "finally", "lastly", "at last", "last of all", "in the end", r"(?<=, |; |\. )last(?=, )",
    "to (?:finish|end|close|conclude)(?: (?:it |things |this )?off)?(?: (?:with|by|on))?", "(?:with )?(?:that|this) (?:done|finished|over|out of the way)",
    "next up(?! to)", "(?:once|when|as soon as) (?:done|finished|ready)",
    "(?:secondly|thirdly|fourthly)", r"(?<!one )(?<!1 )(?<!\ba )(?:second|third|fourth)(?! \w+)", "(?<!right )now(?! and then)",
    "(?:then )?(?:(?:go|move|get|come|pass) )?(?:straight|right|directly) into(?= an? )",
    r"from there(?: on)?(?:,? (?:you )?(?:go|move|carry|pass|continue|proceed)(?: on)?(?: (?:to|with))?)?",
    r"(?:after|following) an? (?:short |brief |little |quick )?(?:beat|pause|moment|second|while|breath|bit|rest|break)", BACK_UP, DONE,
)  # fmt: skip
DIVIDES = _pattern(
    "|".join((
        rf"\s*[,;:.!]*\s*(?<!\w)(?<!\bnow )(?<!now and )(?:and\s+|but\s+)?{NEXT}(?!\w|\s+time)[,:]?\s*",
        r"\s*,?\s*(?:and\s+)?(?:(?:is|are|being)\s+)?(?:immediately\s+)?\bfollowed\s+(?:up\s+)?(?:by|with)\b[,:]?\s*",
        r"\s*,?\s*(?:and\s+)?(?<!\bto )(?<!left )(?<!right )(?<!far )(?<!\bthe )\b(?:end|finish|wrap|(?:move|go|carry|proceed|continue)(?=\s+on\s+(?:to|with)\b))(?:\s+(?:off|up|on))?\s+(?:with|by|to|on)\b\s*",
        r"\s*[,.]?\s*(?:and\s+)?\b(?:close|conclude|"
        r"(?:round|top|finish)\s+(?:it |that |things )?off|(?:end|follow)\s+(?:it|that|this|things)(?:\s+up)?)\s+(?:with|by)\b\s*",
        r"\s*,?\s*(?:and\s+)?\bend\s+up\s+(?=\w+ing\b)",
        r"\s*;\s*|\s*[.!]+\s+|\s*->\s*",
        r"(?:^|[\s,;.])\s*\(?(?:[1-9][.)]|[a-d]\))\s*(?=[A-Za-z])",
    ))
)  # fmt: skip
"""Words between a command and the next: "then", "; after that"."""
AND = _pattern(r"\s*,\s*(?:and\s+)?|\s+and\s+")

A_FIRST_B_LATER = _pattern(rf"(.+?)[,;]\s*(?:and\s+|but\s+)?(.+?),?\s+(?:(?:comes?|goes)\s+)?{NEXT}")
"""Two actions in the text's order, with the words of order at the end."""
ENDS_IN_ORDER = _pattern(rf"\s{NEXT}$")
"""The end of every text that `A_FIRST_B_LATER` matches. It is searched first, since that pattern needs quadratic time to fail."""
A_BEFORE_B = _pattern(
    rf"(.+?),?\s+(?:(?:right|just)\s+)?{_any('(?:(?:comes|goes|is) )?before', 'prior to', 'precedes', 'ahead of')}\s+(?!(?:the|your)\s+(?:body|chest|face|eyes|mouth|belly|heart|head|breast)\b)(?:{_WHO}\s+)?(.+)"
)
B_AFTER_A = _pattern(
    r"(.+?),?\s+(?:(?:right|just|only|once)\s+)*"
    + _any(
        "comes? after",
        "(?:straight |right )?off the back of",
        "(?:hot |close )?on the heels of",
        "after",
        "succeeds",
        "follows",
        "having(?: first)?(?: begun with| opened with| started with)?",
        rf"(?:once|as soon as)(?= {_WHO}\b)",
    )
    + rf"\s+(?:{_WHO}{_HAVE}\s+)?(?:first\s+)?(.+)"
)
BEFORE_B_A = _pattern(rf"(?:(?:right|just)\s+)?(?:before|prior\s+to)\s+(?:{_WHO}\s+)?(.+?),\s*(.+)")
B_BEFORE_THAT_A = _pattern(
    r"(.+?)[,;.]?\s*(?:and\s+|but\s+)?(?:(?:only )?before (?:that|this|which)|beforehand|but first),?\s+(.+)"
)
AFTER_A_B = _pattern(
    r"(?:(?:right|just)\s+)?"
    + _any("after", "once", "when", "as soon as", "having", "following")
    + rf"\s+(?:{_WHO}{_HAVE}\s+)?(?:having\s+)?(?:(?:done|finished|through)\s+(?:with\s+)?)?(.+?),\s*(.+)"
)

NO_COMMAND = _pattern(
    r"^\W*"
    + _any(
        "I", "that", "this", "which", "me", "us", "him", "her", "them", "all", "a (?:moment|second|while|pause|beat)", "another",
        "the other", "each", "anything", "everything", "midnight", "noon", "you (?:go|start|begin|leave|do|answer|speak)",
        rf"{_NUMBER} seconds?", "more", "once", "twice", "again", r"(?:show|start|begin|try|perform|mime|pretend|demonstrate|practi[sc]e)(?=\W*$)",
    )
    + r"\b"
)  # fmt: skip
"""'After that', 'one after another', 'before anything else': words that name no action."""
OPENING = _pattern(
    r"^\W*(?:(?:"
    + _any(
        "and", "please", "ok(?:ay)?", "so", "now", "well", "alright", "(?:go|come) on(?=,|$)", "right(?=,)", "then",
        "first(?:ly)?(?: of all| off| up)?", "to (?:begin|start|open)(?: with)?",
        "(?:you )?(?:start|begin|finish|end|lead|open|kick)(?: off| out| up| things off)? (?:by|with|on)", "let's have",
    )
    + r"\b|[1-9][.)]|[a-d]\))[,:]?\s*)+"
)  # fmt: skip
CLOSING = _pattern(
    r"[\s,]*(?:\b(?:comes? |goes )?"
    + _any(
        "(?:at )?first(?: of all)?",
        "before (?:anything|everything|all) else",
        "to (?:begin|start|end|finish) (?:on|with)",
        "beforehand",
    )
    + r"|[,;:.!?]+)\s*$"
)

_LIMB = _any("arms?", "hands?", "fists?", "ones?", "sides?")
_MANNER = _any("please", "you", "slowly", "gently", "quickly")
LEANS = _pattern(
    rf"^(?:{_MANNER}\s+)*(?:"
    + _any(
        rf"(?:remain|wait|pause|rest)(?: (?:a|for|there|like|so|still|{_NUMBER})\b|$)",
        "(?:relax|lower|lowers|lowering|drop|drops|release)(?: (?:it|them|again|slowly)| (?:your|the|his|her|their|its) "
        rf"{_LIMB})?$",
        "(?:let|stop|stay|stays|staying|return|returns|freeze|repeat|repeats|again|go back|come back|back|down|up)",
        r"(?:bring|brings|take|takes|put|puts) (?!the (?!left|right|other|hand|arm|fist|head)\w+ (?:down|back)\b).*(?:down|back)", "do(?:es)? (?:it|that|so|the same)",
        "(?:hold|keep)(?:s|ing)?"
        "(?: (?:it|them|that|this|there|on|still|for|the pose|the position|your (?:position|balance)|until)|$)",
        "(?:with|using|to the|the other|other|same)", rf"(?:the )?(?:left|right|same)(?: {_LIMB})?$",
        "(?:not|no|don't|do not|never|without|instead|but)", rf"{_NUMBER}(?: more| times?| seconds?|$)|(?:{'|'.join(ADVERBS)})(?: more| times?| seconds?)?",
        "a (?:bit|little) (?:more|further|higher|lower|faster|slower)",
        "(?:faster|slower|harder|higher|louder|quicker)", "(?:for|until|at|in|on|as)",
        r"(?!(?:wave|bow|point|nod|salute|look|say \w+|blow .*) (?:to|at|for) )(?:\S+ ){0,3}(?:it|them|again|likewise|the same|as well|too|nothing)",
        r"(?:straighten(?:s|ing)?|rises?|rising|stands?|standing|comes?|coming|gets?|getting)(?: yourself)?(?: back| right| slowly)* (?:up|upright)(?: again| straight)?$",
    )
    + r"\b)|\b(?:stays?\s+still|rests)\b"
)  # fmt: skip
"""Beginnings of clauses that depend on the command before them."""
SUBJECT = _pattern(r"^(?:it|he|she|they)\s+(?=\w+s\b)")
AT_ONCE = _pattern(
    r"\b"
    + _any("while", "whilst", "as you", "at the same time", "at once", "simultaneously", "meanwhile", r"(?<!hands )(?<!palms )(?<!arms )(?<!them )together(?= with\b|\W*$)", "all the while",
           "along with")
    + r"\b"
)  # fmt: skip
NOT = _pattern(r"\b(?:not|don't|never|instead|rather\s+than)\b")

_ACT = _any(
    "wav", "nod", "bow", "clap", "shrug", "salut", "point", "punch", "shak", "cross", "fold", "rais", "lift", "look",
    "lean", "beckon", "hug", "stretch", "twist", "tilt", "facepalm", "cheer", "pray", "scratch", "rub", "pat", "knock",
    "push", "pull", "throw", "catch", "jab", "box", "flap", "swim", "march", "danc", "drum", "circl", "spread", "open",
    "touch", "cover", "blow", "wip", "stir", "typ", "applau", "conduct", "greet", "swing", "bend", "turn", "reach", "mak",
    "giv", "tak", "do", "play", "act", "show", "strik", "thumb", "flex", "high[- ]?fiv", "lower", "put", "let", "bring", "hold", "keep",
    "drop", "place", "extend", "straighten", "sway", "pump", "roll", "nudg", "sink", "glanc", "gaz", "peek", "stare", "shade",
    "cup", "hide", "fist (?:bump|pump)", "hammer", "paint", "brush", "scrub", "pour", "comb", "steer",
    "uncross", "unfold", "press", "celebrat", "curts", "uppercut", "hook", "drink", "kiss", "listen", "laugh", "pose", "surrender", "rock", "slump", "yawn", "breath", "juggl", "curl", "mop",
)  # fmt: skip
SPEAKS_OF_AN_ACT = _pattern(rf"\b{_ACT}\w*")
BEGINS_WITH_A_VERB = _pattern(rf"^(?:(?:{_MANNER}|to)\s+)*({_ACT})(?:e|p|s|es|d|ping|ing|ding|t|h)?\b")
PREPARES = _pattern(
    r"^(?:(?:please|you|to)\s+)*(?:rais|lift|reach|open|turn|look)\w*\s?"
    r"(?:around|confused|(?:up|out|your|the|his|her|their|its|an?|one|both)\s.*)?$"
)
"""'Raise your hand and wave' is one gesture."""
POSES_ANEW = _pattern(r"^(?:stretch|extend|reach|bend|lower|drop|put|bring|swing|straighten|let)\b")
"""'Raise your arm and stretch it forward' are two."""
LIMB_FIRST = _pattern(
    r"^(?:your |the |both )?(?:left |right )?(?:hands?|arms?|fists?|palms?|head|chin|eyes|gaze|shoulders|body|upper body)\s"
)
"""'Head up', a command without a verb."""
BOTH_ARMS_POSED = _pattern(
    r"^(?:(?:put|raise|lift|hold|stretch|spread|open|throw|extend) )?(?:(?:your|both|the|both your) )?(?:arms|hands|both)"
    r"(?: straight| high| all the way)? (?:up|down|out|wide|forward|back|in the air|overhead|to the sides?|behind .+|on your (?:hips|head|waist|knees))"
    r"(?: (?:in the air|high|wide|to the sides?|over your head))?$"
)
"""'Hands up', a pose of both arms."""
ONE_ARM_PLACED = _pattern(
    r"^(?:now |then )?(?:your |the )?(?:left|right)(?: (?:hand|arm|one|fist))? (?:up|down|out|forward|back|(?:on|over|behind|to) (?:your|the) "
    r"(?!side)(?:\w+))(?: again)?$"
)
"""'Left hand on your heart', 'right one down'."""
LIMB_ALONE = _pattern(
    r"^(?:(?:your |the )?(?:left|right|both)(?: (?:arm|hand|fist)s?)?|(?:your |the )?(?:arms|hands|head)) (?:straight |back )?"
    r"(?:up|down|left|right|forward|back|out|wide|on (?:your |the )?\w+|to the sides?)$"
)
"""A limb with its place, three of which are in turn: "left arm up, right arm up, both down"."""
LIMB_AND_WAY = _pattern(
    r"^(?:your |the )?(?:(?:left |right )?(?:arm|hand|fist)|arms|hands|head|chin|eyes|gaze) "
    r"(?:up|down|left|right|forward|back|out)$"
)
"""'Head left' in "head left, right, left"."""
