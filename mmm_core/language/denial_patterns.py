"""Patterns of the words by which English denies, for `mmm_core.language.denial`; `words/denial.txt` has the words.

Texts are in lower case and plain spelling, with single blanks between their words.
"""

from __future__ import annotations

import re
from functools import partial

from mmm_core.language.word_tables import any_of

_any = partial(any_of, "denial")
DENIES = re.compile(rf"^\W*(?:{_any('before')} )*(?:please )?{_any('not')} (?P<what>.+)$")
BETWEEN = re.compile(
    r"\s*(?:,\s*(?:and |but )?instead\b,?|[,;:.!?]+(?=\s|$)|\s-+\s|\bbut(?= )(?! (?:not|no)\b)(?<!anything but)(?<!everything but)(?<!\bnothing but)(?<!\ball but)"
    r"|\binstead,? (?!of\b)|\binstead$)\s*"
)
INLINE = re.compile(rf"\s*,?\s*\b(?P<not>{_any('inline')})\s+(?P<what>[^,;:.!]+)")
GERUND_FIRST = re.compile(
    r"^\W*(?:instead of|rather than|without) (?P<what>(?:\w+ing)(?: (?:your|the|at|to|with) \w+(?: \w+)?)?|(?:a|an) \w+),? (?=\w)"
)
ANYTHING_BUT = re.compile(
    r"\b(?:(?:any|every|some)thing(?: else)?(?: you (?:like|want))?|any(?: other)? (?:move|movement|gesture|action)|whatever(?: \w+){0,2})"
    r" (?:but|except(?: for)?|other than|besides|apart from)\b"
)
SOMETHING_ELSE = re.compile(
    r"(?:(?:please |just |rather )*(?:do|try|show (?:me|us)|give (?:me|us)) )?(?:some|any)thing (?:else|other|different)(?: instead| please)*"
)
"""A request of any act but a denied one, in a clause of its own."""
IN_PLACE_OF = re.compile(r"^\W*(?:instead of|rather than|as opposed to|in place of)\b|^not .+, but\b")
"""Words of contrast, after which even what is no act is not to be done: "wave instead of just standing there"."""
PLACE = re.compile(
    r"(?:at|to|towards|with|on|over|above|behind|near|for) (?:(?!your (?:left|right)\b|the (?:left|right)\b)\w+ ?){1,3}$"
)
"""A target that is denied: "point, but not at me"."""
ALWAYS_DENIES = re.compile(rf"{IN_PLACE_OF.pattern}|without (?:moving|using)$|except(?: for)?(?: with)?$")
GERUND_CLAUSE = re.compile(r"^\W*(?:instead of|rather than|without|no) (?P<what>\w+ing\b[^,;:.]*), (?P<rest>\w.+)$")
ONE_HAND_FOR_THE_OTHER = re.compile(
    r"^\W*(?:instead of|rather than|in place of) (?P<what>(?:using )?(?:the|your) (?:left|right)(?: hand| arm)?),? (?P<rest>(?:use|with|take|using)\b.+)$"
)
NOT_A_BUT_B = re.compile(
    r"^\W*not (?!only\b)(?P<what>(?:an?|the|your|with|to)? ?[^,;]+?),? but (?:rather |instead )?(?P<rest>.+)$"
)
NOT_THIS_BUT_THAT = re.compile(
    r"^\W*it is not (?P<what>(?:an?|the|your) [^,.;]+?)(?: (?:that )?(?:i|we) (?:want|need|meant|mean|said|asked for|am after|are after))?[,.;]+ (?:it is|but|i (?:want|meant|said|asked for)) (?P<rest>\w.+)$"
)
"""'It is not a wave I want, it is a bow.'"""
IN_PLACE_FIRST = re.compile(
    r"^\W*(?:instead of|rather than|in place of|in lieu of) (?P<what>(?:an? |the |your |that |this )?\w+(?:[ -]\w+)?),? (?P<rest>(?:do|give|show|make|have)\b.+)$"
)
NOT_THAT_PART = re.compile(
    r"^\W*not (?P<what>(?:with )?(?:the|your) (?:left|right) (?:hand|arm|shoulder|ear|eye|elbow|knee|cheek|wrist|hip)),? (?P<rest>(?!but\b).*\b(?:left|right) one\b.*)$"
)
SIDE_ONLY = re.compile(
    rf"^(?:{_any('side verb')}\s+)?(?:your |the |that |my )?(?P<side>left|right)(?: (?:hand|arm|one|side|fist|palm|shoulder|ear|eye|elbow|knee|cheek|wrist))?"
    r"(?: (?:this time|at all|alone|though|please|either|now))?$"
)
LEAVE = re.compile(
    r"(?:,?\s*(?:and|but|while)\s+)?\b(?:leave|keep|leaving|keeping|let)\s+(?:your |the )?(?P<side>left|right) (?:hand|arm|one)\s+"
    rf"{_any('left alone')}\b,?\s*(?:and\s+)?"
)
RESTS = re.compile(
    rf"(?:[,;:.]?\s*(?:and|but|while)\s+)?\b(?:your |the )(?P<side>left|right)(?: (?:hand|arm|one))? {_any('rests')}"
    r"(?=\s*(?:$|,|;|and\b|while\b)),?\s*(?:(?:and|while)\s+)?"
)
"""'The left hand rests, wave with the right.'"""
KEEP_STILL = re.compile(
    r"(?:,?\s*(?:and|but|while)\s+)?\b(?:keep|keeping|leave|leaving|hold|holding)\s+(?:your |the )?"
    rf"{_any('kept')}\s+(?:{_any('how still')} )?{_any('kept still')},?\s*(?:and\s+)?"
    rf"|(?:,?\s*(?:and|but|while)\s+|,\s*)(?:your |the )?(?:{_any('kept')}|(?:left |right )?(?:arm|hand))\s+(?:"
    r"(?:(?:do|does|should|must|shall|will|may) not|never) (?:to )?(?:move|stir|budge|take part|join in)\b(?: at all)?"
    rf"|(?:stays?|remains?|(?:is|are) (?:kept|held|to stay)) (?:{_any('how still')} )?(?:still|motionless|put|in place|where (?:it is|they are))(?=$|[,.;])),?"
)
DIRECTION_ONLY = re.compile(
    r"^(?:to |at |on )?(?:the |your )?(?:up|down|left|right|forward|forwards|back|backward|backwards)(?: side)?$"
)
SIDEWAYS = re.compile(r"(?:to |at |on )?(?:the |your )?(?P<side>left|right)(?: side)?")
WAVED_ASIDE = re.compile(rf"^{_any('waved aside')}$")
NO_DENIAL = re.compile(rf"^\W*{_any('no denial')}")
KEEP_DOING = re.compile(
    r"^\W*(?:please )?(?:do not|never) (?:stop|quit|cease|give up|leave off) (?P<rest>\w.+)$|^\W*(?:please )?do not (?:forget|hesitate) to (?P<other>.+)$"
)
ACTS_ALSO = re.compile(rf"\b{_any('act')}\w*")
NOUN_OF_AN_ACT = re.compile(rf"^(?!(?:so|too|that|quite|very|as) )(?:\w+ ){{0,5}}{_any('noun')}\b")
NOT_USING = re.compile(
    r"^\W*(?:please )?(?:do not|never) (?:use|take) (?:your |the )?(?P<side>left|right) (?:hand|arm|one) (?:to|for|when|and) (?P<rest>\w.+)$"
)
GO_ON = re.compile(
    r"^(\W*(?:skip|forget|leave out|never mind|instead of|rather than) [^,]+?),? and (?:go (?:straight|right|directly) (?:to|on to|for)|just|do|give me|instead) "
    r"|^(\W*(?:spare (?:me|us) (?:the|your|that) \w+(?: \w+)?|(?:quit|stop|enough of|no more of) (?:the|your|that|this) \w+(?: \w+){0,2}|(?:skip|forget|leave out|never mind|ditch|scrap|bin|lose|nix|axe|forgo) (?:the|your|that) \w+|(?:drop|dump|omit|cease|postpone|disregard) (?:the|that) \w+(?: \w+)?)),? and (?!(?:the|an?|your|no|any|not|all)\b)"
    r"|^(\W*(?:(?:save|keep|leave) (?:the|your|that) [^,]+? for (?:later|bedtime|another \w+|tomorrow|\w+day)|leave (?:the|that) [^,]+? to (?:me|us|him|her|them|(?:your|the|my|our) \w+)|put (?:the|your|that) [^,]+? away)),? and (?=\w)"
)
STOP_AND = re.compile(
    rf"((?:^\W*|[,;.] )(?:{_any('before')} )*(?:please )?(?:stop|quit|enough (?:of|with)|no more|leave off|cut out|knock off)(?: (?:with|of))?(?: (?:that|the|your|all that|all the|all this|this))? \w+ing\b[^,]*?),? and (?!\w+ing\b|(?:left|right|up|down|back|forth|forwards?|out|round)\b|(?:your |the |both |left |right )*(?:hands?|arms?|head|fingers?|fists?|shoulders?)$)(?=\w+ \w)"
)
"""'Stop waving and clap your hands' asks for the second; 'stop waving and clapping' for neither."""
SAYS_NOT_TO = re.compile(
    rf"^\W*(?:{_any('before')} )*(?:please )?(?:(?:do not|never) (?!(?:mind|rush|hurry|forget|stop|hesitate|worry)\b)\w|(?:stop|no|quit|avoid) \w+ing\b)"
)
"""A clause that asks for nothing, whatever it names: "do not warble on the recorder"."""
STATES = re.compile(
    r"^(?!to )\S.*?(?:\b(?:is|are|was|were|am|has|have|had|does|did)\b|'s\b|'re\b)|^(?:the|my|our|his|her|their) \w+ \w+s\b(?! on\b)"
)
"""A finite verb behind a subject."""
CANCELLED = re.compile(
    r"(?P<what>.+?)(?:[,.;!?]+|(?= (?:but|no|oh|ah|actually|wait|hmm)\b)) (?:(?:but|no|oh|ah|actually|wait|hmm|on second thoughts?)[, ]+)*"
    r"(?:never ?mind|forget (?:it|that|about it)|scrap that|cancel that)(?:[, ]+(?:forget it|never ?mind|thanks?|thank you|sorry|then|now|it is fine))*\W*"
)
"""A text that ends by taking all of it back."""
THREATENS = re.compile(
    r"if (?:you|i (?:see|catch) you) (?P<what>(?=.*\b(?:again|one more|once more|another)\b).+?) (?:i|we|there|he|she|they|somebody)\b.*"
)
"""'If you bow once more I shall scream.'"""
OFFERED = re.compile(
    r"^(?:(?:i|we) (?:said|want(?:ed)?|asked for|mean|meant|need|(?:would|'d) (?:like|prefer|love|rather (?:have|see))(?: to see)?|came (?:to (?:hear|see)|for))(?: you)?(?: to)?"
    r"|(?:it|that) is(?= (?:an?|the|your) )|what (?:i|we|they)\b[^,]* (?:is|are)|this time(?: (?:i|we) (?:want|would like)(?: to see)?(?: you)?)?|make that|let us (?:have|see|say))(?: now)? (?P<act>(?!you\b)\w.*)$"
    r"|^(?P<it>\w+(?: \w+)?) it is$"
)
"""'I said guitar' beside a denial, and 'tennis it is'."""
FORBIDDEN = re.compile(
    r"^(?P<what>.+?) (?:is|are|has been|have been) (?:banned|forbidden|not allowed(?! to)|off limits|off the table|cancelled|prohibited|out of the question)\b.*$"
)
SET_ASIDE = re.compile(
    r"^(?:please |(?:and|but|so|then) |(?:let us|we will|we shall|you can|you may) )*(?:"
    r"(?:save|keep|leave|spare) (?:the|your|that|those|all the) (.+?) for (?:later|another(?! (?:second|minute|moment|while|bit|few|beat|count|\w+ (?:seconds?|minutes?|beats?|counts?))\b)|some other|next|tomorrow|when|someone|somebody|others|the others|a rainy|bedtime|\w+day)\b(?!.* and \w).*"
    r"|leave (?:the|that|all the|your) ((?:(?!\b(?:and|out|be|alone)\b)[^,.])+?) to (?:me|us|him|her|them|your|the|my|our|others|someone|somebody)\b.*"
    r"|put (?:the|your|that|those) (.+?) away(?: now)?"
    r"|give (?:the|your|that|all the|all that) (.+?) a (?:miss|rest|break|pass|skip)\b.*"
    r"|permission to (.+?) (?:is )?(?:denied|refused)"
    r"|(?:the |your |that )?(.+?) (?:is|are) (?:so last \w+|old hat|history|(?:off|not on) the menu|not (?:wanted|needed|necessary|required|welcome)|unnecessary|denied|vetoed|beneath you|(?:a )?no go|for (?:another|some other) (?:day|time)|overrated)\b.*"
    r"|(?:the |your |that )?(.+?) (?:can|must|should|will have to|has to|have to) wait\b(?! (?:for|until|till)\b).*)$"
)
"""'Save the bow for later', 'give the drums a rest', 'the bow can wait'."""
SWAPPED = re.compile(
    r"^(?:please |let us |can (?:you|we) |could (?:you|we) )*(?:(?P<swap>swap|replace)|trade|exchange)(?: out)? (?!(?:it|them|places|sides|hands|arms)\b)(?:the |your |that |all the )?(?P<what>(?:(?! with )[^,.;:])+?)(?: out)? "
    r"(?(swap)(?:for|by|(?<!handshakes )(?<!greetings )(?<!bumps )(?<!fives )with(?! (?:me|us|you|him|her|them|every\w+|some\w+)\b)(?! (?:your|the) (?:left|right) (?:hand|arm)$))|for) "
    r"(?:a bit of |some )?(?P<rest>.+)$"
)
"""'Swap the wave for a bow' is a bow; 'swap handshakes with the captain' is a handshake."""
ASKED_AND_DENIED = re.compile(
    r"^(?P<what>(?!what\b)[^,.;!?]+)\?+ (?:no|nope|nah|negative|never|not today|not now|not again|wrong|hardly|forget it|no thanks|no thank you|no way)\b(?! ?\?)[,.;!: -]*(?P<rest>(?!the (?:left|right)\b).*)$"
)
"""'Wave? No, bow.'"""
YES_AND_NO = re.compile(
    r"^(?P<rest>[^,;.]+?)(?<!for)(?<!head),? yes[,;.]* (?:and |but )?(?P<what>(?!in place|instead|for)[^,;.]+?)(?<!for),? no(?: please| thanks| thank you)?$"
)
"""'A wave yes, a hug no.'"""
RATHER_THAN = re.compile(
    r"^(?:i (?:would|should) (?:much )?(?:sooner|rather|prefer)(?: (?:it if |that )?you| to see(?: you)?| have(?: you)?)? )?"
    r"(?P<rest>(?!no sooner|not so|it is|less)[^,;.]+?)(?<!rather)(?<!more)(?<!less)(?<!er) than (?P<what>(?:the|an?|your) [^,;.]+)$"
)
TAKEN_BACK = re.compile(
    r"^(?P<what>(?!(?:yes|no)\b)(?!.* (?:and|then|while) )[^,.;:!?]+)[,.;:!]+ (?:(?:oh|ah|um|er|hmm|wait|sorry|oops)[,.]? )*(?:no(?:pe)?|nah)[,.;!]+ (?:(?:no|wait|sorry|please|listen|actually)[,.;!]+ )*"
    r"(?:(?:not that(?: one)?|do not|never ?mind(?: that)?|scratch that|forget that|cancel that)[,.;!]+ )?(?:i (?:mean|meant|said) )?(?P<rest>(?!(?:yes|no|not|sorry|wait|listen|actually)\b)\w.+)$"
)
"""'Clap. No, don't. Wave.'"""
INSTEAD = (SWAPPED, ASKED_AND_DENIED, TAKEN_BACK, YES_AND_NO, RATHER_THAN)
"""Whole texts that deny one act and ask for another."""
ANY_ARM_BUT = re.compile(
    r",? (?:with|using) (?:whichever|whatever|any|either) (?:hand|arm|one)(?: you (?:like|want|fancy|please|prefer))?,? "
    r"(?:(?:so|as|just as) long as it is not|but|except|other than) (?:the|your) (?P<side>left|right)(?: one| hand| arm)?"
)
SURELY_DENIES = re.compile(
    r"^\W*(?:\w+,? )?(?:(?:nobody|no one|none of us)(?:'s)? (?:asked|asks|wants|needs|likes)|never ever|(?:do not|don'?t) you dare|(?:do not|don'?t|never) let (?:me|us|him|her|them|anyone|anybody) (?:see|catch|hear) you|under no circumstances|on no account|in no case|by no means|cancel|abort|call off|quit|"
    r"no (?:\w+ ){1,2}(?:tonight|today|this time|now|anymore|any more)(?=$|[,.;]))|"
    r"^\W*(?:no,? )*(?:please,? )?(?:do not|don'?t) do (?:anything|a thing)(?: at all| now)?(?=$|[,.;!])"
)
"""Words after which even what is no known act is not to be done."""
HAS_SIDE = re.compile(r"\b(?:left|right|both)\b")
SAYS_NOTHING = re.compile(
    r"(?:nope|nah|no)?,? ?not that(?: one)?|(?:fine|okay|ok|alright|correction|not(?: again)?)|(?:the|use the|with the|use) (?:other|opposite)(?: one| hand| arm| way| side| direction)?|instead|(?:and |but )?that is it|"
    r"(?:(?:lord|god|goodness|dear) )?(?:no|oh|hey|well|ok|please)(?:,? (?:no|please|sorry))*|(?:will|would|can|could) you|silly|got it|thanks?|for \w+(?:'s)? sake|not (?:another|one more|a single) \w+(?: \w+){0,4}|"
    r"(?:you )?(?:just )?wait (?:until|till|for)\b.*|(?:no|nothing) (?:other|else|more)\b.*|leave it(?: at that| alone)?|(?:so )?not one(?: out)? (?:of|from) you"
)
"""Clauses beside a denial that request nothing."""
