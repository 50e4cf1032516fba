"""Words around a request, everyday phrases and the words that the model knows for others: three tables and their use."""

from __future__ import annotations

import re
from functools import cache, lru_cache

from mmm_core.language.at_once import base_of
from mmm_core.language.clause_patterns import SPEAKS_OF_AN_ACT
from mmm_core.language.word_tables import REMEMBERED, WAY, Rule, RuleTable, lines, pairs, replaced, substitutions

_ACT = (
    r"(?:also |just |please |can you |could you )*(?:wave|nod|bow|clap|shrug|salute|point|punch|shake|cross|fold|raise|lift|look|lean|beckon|hug|stretch|twist|tilt|cheer|pray|scratch|rub|pat|"
    r"knock|push|pull|throw|catch|flap|march|dance|drum|circle|spread|open|touch|cover|blow|wipe|stir|applaud|conduct|greet|swing|bend|turn|reach|make|give|take|do|"
    r"play|act|show|strike|flex|lower|put|hold|shade|celebrate|throw|welcome|thank|say|tell|hush|call|flex|pretend|move|bring|let us see you|sway|duck|facepalm|signal|hammer|paint|brush|drum|box|drink|eat|pour|kiss|listen|yawn|climb|swim|steer|type|juggle|flip|rotate|rock|slump|relax|drop|place|"
    r"extend|straighten|uncross|roll|bob|wag|tip|incline|motion|gesture|indicate|demonstrate|perform|imitate|mime|box|jab|row|saw|sow)\b"
)
_STORY = (
    (
        r"(?!(?:please |now |and |then |ok(?:ay)?,? |robot,? |first,? |@ACT)*(?:@ACT|hands?\b|arms?\b|head\b|(?:your|both|left|right|the (?:left|right))\b|"
        r"(?:after|before|once|when|while|as|if|instead of|without|rather than|having)(?: you\b| \w+ing\b)|do not|never|not\b|no\b|stop|skip|forget|only (?!because|since)|neither))"
    )
    .replace("|@ACT)*", ")*")
    .replace("@ACT", _ACT)
)
"""What a story before a request does not begin with: a command, an order of commands, a denial."""
_ASKS = (
    r"(?:(?:can|could|would|will|might) you|(?:might|may|could|can|must|should|would) (?:i|we) (?:please |just |kindly |also )*(?:trouble|ask|beg|request|invite|persuade|bother|get|have) you to|"
    r"(?:i|we) (?:(?:would|do|really|just|only|simply|also|am|was|were) )*wonder(?:ing)?(?: if| whether) you (?:would|could|might|can|will)|"
    r"(?:i|we|they|he|she|everybody|everyone|the \w+|my \w+)(?: would| do| really| just| now| simply| only| all)* (?:like|love|want|need|wish|expect|ask|beg|prefer|ought|likes|loves|wants|needs)(?: to (?:see|have|watch))? you(?: to)?|"
    r"if you (?:could|would|might|were to)|(?:i|we) (?:am|was|are|were|have been) (?:just |only |really )*(?:hoping|thinking|wishing|counting on it)(?: that| if| whether)? you (?:could|might|would|can|will)|it would be (?:\w+ ){1,3}(?:if you (?:could|would)|to see you|to have you)|(?:perhaps|maybe) you (?:could|would|might|can|should)|(?:i|we) (?:think|believe|guess|suggest|propose|recommend|insist)(?: that)? you (?:should|could|might|ought to|had better|must)?|"
    r"(?:so|therefore|and|now) (?:please|kindly|just|do)|(?:so|and) be (?:so )?(?:kind|good|nice|an? \w+)(?: enough)?(?: as)? (?:to|and)|do (?:just|please|kindly)|please|go ahead and|why do not you|how about you|"
    r"let (?:me|us) see you|the time has come (?:for you )?to|it is (?:now )?time (?:for you )?to|your (?:job|task|turn|part) (?:now )?is (?:simply |just )?to|what about|how about)[, ]+"
)
"""Words that ask for something in the middle of a sentence."""
_END, _MARKS = re.compile(r"[\s,.!?;:]+$"), re.compile(r"\s*[,.!?;:]+\s*")
_WORD = re.compile(r"[a-z]{2,}")
_GERUND_FIRST = re.compile(r"^(?:you )?(\w+ing)\b(?= (?:your|the|to|at|with|me|down|up|and|goodbye|a|an)\b|$)")


@cache
def _frames() -> tuple[RuleTable, RuleTable]:
    """Patterns at the front and at the end of a request."""
    patterns = [
        line.replace("@STORY", _STORY).replace("@ASKS", _ASKS).replace("@ACT", _ACT) for line in lines("frames")
    ]
    front = RuleTable(Rule(re.compile(p)) for p in patterns if p.startswith("^"))
    return front, RuleTable(Rule(re.compile(p)) for p in patterns if not p.startswith("^"))


@lru_cache(maxsize=REMEMBERED)
def without_request(said: str) -> str:
    """A sentence in lower case without the words around what it asks for; the sentence itself where nothing would be left.

    >>> without_request("could you please wave for me"), without_request("i would love it if you could bow")
    ('wave', 'bow')
    """
    rest, before = said.strip(), ""
    while rest != before:
        before = rest
        for table in _frames():
            rest = _without(rest, table)
    return _gerund_request(rest)


def _without(rest: str, table: RuleTable) -> str:
    """What the first match of each rule in turn leaves of a request."""
    numbers = iter(table.possible(rest))
    while (number := next(numbers, None)) is not None:
        found = table.rules[number].pattern.search(rest)
        if found is not None:
            rest = _kept(rest, rest[: found.start()] + rest[found.end() :])
            numbers = iter(table.possible(rest, number))
    return rest


def _kept(before: str, after: str) -> str:
    after = after.strip(" ,")
    return after if _WORD.search(after) else before


def _gerund_request(rest: str) -> str:
    """A request whose verb is a gerund as a command: "shaking your head" -> "shake your head"."""
    found = _GERUND_FIRST.match(rest)
    _, comma, after = rest.partition(", ")
    if found is None or not SPEAKS_OF_AN_ACT.match(found[1]) or (comma and SPEAKS_OF_AN_ACT.match(after)):
        return rest  # "looking left, wave" is at once
    return base_of(found[1]) + rest[found.end() :]


@lru_cache(maxsize=REMEMBERED)
def everyday(said: str) -> str:
    """The plain command that an everyday phrase means, "" where it is none.

    >>> everyday("say hello"), everyday("say hello to my little friend")
    ('wave your right hand', 'wave your right hand')
    """
    bare = _END.sub("", said).strip()
    bare = bare if "," in bare else _MARKS.sub(" ", bare)
    table = substitutions("everyday")
    possible = (table.rules[number] for number in table.possible(bare))
    return next((rule.words for rule in possible if rule.pattern.fullmatch(bare)), "")


@cache
def _sentences() -> RuleTable:
    return RuleTable(
        Rule(re.compile(pattern.replace("@ACT", _ACT).replace("@WAY", f"({WAY})")), words)
        for pattern, words in pairs("sentences")
    )


def restated(said: str) -> str:
    """A sentence with its commands in the order in which they are done, and what is listed said in full.

    >>> restated("look up and down"), restated("end with a bow but clap before that")
    ('look up, then down', 'clap, then end with a bow')
    """
    return replaced(said, _sentences())


def rewritten(clause: str) -> str:
    """A clause with words that the model knows in place of others that mean the same."""
    return replaced(clause, substitutions("rewrites"))
