"""What is read in sentences: one text and the commands read in it a row, and sentences that look like such a form and are none."""

from __future__ import annotations

import pytest

from mmm_core.language.reading import read
from mmm_core.language.spelling import mended


def said(text: str) -> str:
    """The commands that are read, as one line: "nod + clap; bow"."""
    return "; ".join(read(text).sentences)


class TestWhatIsRead:
    @pytest.mark.parametrize(
        ("text", "commands"),
        [
            ("turn your head left, then right", "turn your head left; turn your head right"),
            ("arms up, then down", "raise both hands up; lower both arms"),
            ("tilt one way, then the other", "tilt to the left; tilt to the right"),
            ("left hand on your heart and salute with the right",
             "put your left hand on your heart + salute with your right hand"),
            ("arms wide and nod", "hold your arms out to the sides + nod"),
            ("left fist up, right palm forward", "raise your left hand + make a stop sign with your right hand"),
            ("bwo deeply", "bow deeply"), ("shurg your shoulders", "shrug your shoulders"), ("nod plz", "nod"),
            ("clap ur hnads", "clap your hands"), ("clap, but do not bow", "clap"),
            ("not that arm, the other one: raise your left", "raise your left hand"),
            ("wave without your left hand", "wave with your right hand"), ("do not bow", ""),
            ("lift your left hand, turn it over, let it sink",
             "lift your left hand; turn your left palm up and down; lower your left hand"),
            ("Point first to the door on your left, then to the window on your right",
             "point to the door on your left; point to the window on your right"),
            ("lift both arms, clap above your head and lower them", "lift both arms; clap above your head; lower both arms"),
            ("keep your arms down and look left", "look to the left"),
            ("don't use your right hand to wave", "wave with your left hand"),
            ("skip the wave and go straight to the bow", "the bow"),
            ("with arms crossed, nod", "cross your arms in front of your chest + nod"), ("say hello", "wave your right hand"),
            ("hands up!", "raise both hands up"), ("I'd love it if you could show the kids at the back how you bow", "bow"),
        ],
    )  # fmt: skip
    def test_kind_by_kind(self, text: str, commands: str) -> None:
        assert said(text) == commands

    @pytest.mark.parametrize(
        ("text", "commands"),
        [
            ("look up and down", "look up; look down"), ("end with a bow but clap before that", "clap; a bow"),
            ("shake your head, pause, nod", "shake your head; nod"),
            ("only after you have bowed may you raise your right hand", "bow; raise your right hand"),
            ("first shrug, second nod, third clap", "shrug; nod; clap"),
            ("wave twice with the left and once with the right",
             "wave twice with your left hand; wave once with your right hand"),
            ("head up, head down, head to the left", "look up; look down; look to the left"),
            ("left arm: up, out to the side, and down",
             "raise your left hand; raise your left arm to the side; lower your left arm"),
            ("with your right arm first point up, then forward",
             "point up with your right hand; point forward with your right hand"),
            ("nod once and then three times more", "nod once; nod three times"),
            ("wave with your right hand, then both", "wave with your right hand; wave with both hands"),
            ("put your right hand on your heart and, while you do that, nod", "put your right hand on your heart + nod"),
            ("nod during the clapping", "nod + clap"),
            ("lean to the left and hold it for five seconds", "lean to the left (for 5 s)"),
            ("raise your left arm. No, not that arm, the other one.", "raise your right arm"),
            ("Raise both arms. Hmm, actually just the left.", "raise your left arm"),
            ("left, i mean right, arm up", "raise your right hand"), ("lean forward, actually no, backwards", "lean back"),
            ("don't point just wave", "wave"), ("wave with the hand that isn't your right", "wave with the left hand"),
            ("nobody needs you to applaud now", ""), ("wave a couple of times", "wave twice"), ("clap 3x", "clap 3 times"),
            ("lok dwon", "look down"),
            ("there's something on your left, would you turn your head that way", "turn your head to the left"),
            ("my sister bets that you can't clap four times, so please do it", "clap four times"),
            ("I'd be really grateful if you just shook your head", "shake your head"),
            ("punch with your left, and with your right too", "punch with your left hand; punch with your right hand"),
        ],
    )  # fmt: skip
    def test_orders_lists_and_corrections(self, text: str, commands: str) -> None:
        assert said(text) == commands

    @pytest.mark.parametrize(
        ("text", "commands"),
        [
            ("peer down at your toes", "look down at your toes"), ("crane your neck to the left", "look to the left"),
            ("stare straight up", "look up"), ("glance rightwards", "look to the right"), ("rock back", "lean back"),
            ("tip your body backwards", "lean back"), ("incline your trunk to the right", "lean to the right"),
            ("rotate your torso leftwards", "turn your upper body to the left"),
            ("point your right finger forwards", "point forward with your right hand"),
            ("point to the exit with your left hand", "point forward with your left hand"), ("point at the dog", "point forward"),
            ("point at the ceiling", "point at the ceiling"), ("point at the house on the left", "point at the house on the left"),
            ("point with your left hand down", "point down with your left hand"),
        ],
    )  # fmt: skip
    def test_words_of_looking_leaning_and_pointing_are_those_of_the_model(self, text: str, commands: str) -> None:
        assert said(text) == commands


class TestStoriesAroundARequest:
    @pytest.mark.parametrize(
        ("text", "command"),
        [
            ("My old mum has not seen you for weeks, perhaps you could wave to her with your left hand",
             "wave with your left hand"),
            ("The kids have been asking all day so I wonder whether you might flap your arms like a bird",
             "flap your arms like a bird"),
            ("With the planer on I hear nothing, so for an answer do just nod twice, would you, love", "nod twice"),
            ("We've lost the cat and my neck hurts, so might I ask you to look up for me?", "look up"),
            ("Sorry to bother you at work, but would you mind awfully turning your head to the right?",
             "turn your head to the right"),
            ("The visitors are coming up the drive, so if you could manage a proper salute, that'd make their day", "a salute"),
            ("In this lesson we work on the back, and what I would like to see, if it doesn't hurt, is a rotation of the trunk "
             "to the left", "turn your trunk to the left"),
            ("For the check we need one more measurement, so please be so kind as to extend your right arm forward",
             "extend your right arm forward"),
            ("I was hoping you might wave", "wave"),
            ("I never said you should bow, I said clap", "clap"),
            ("It's so loud in here, would you do me a favor and cover your ears, just so I don't feel alone?", "cover your ears"),
            ("What's up there? Have a look up.", "look up"), ("can you see the moon? look up", "look up"),
            ("clap your hands, the show is over", "clap your hands"), ("Saw away, the merchant's waiting.", "saw away"),
            ("nod, I beg you", "nod"), ("Lean in, I'll whisper it.", "lean forward"), ("raise your left arm, it is heavy",
             "raise your left arm"), ("lean forwards love, then backwards", "lean forward; lean back"),
            ("tilt your head to the left, pet", "tilt your head to the left"), ("bow, old chap", "bow"),
        ],
    )  # fmt: skip
    def test_is_taken_off(self, text: str, command: str) -> None:
        assert said(text) == command

    @pytest.mark.parametrize(
        ("text", "commands"),
        [
            ("wave and could you please nod", "wave + nod"), ("after you clap, could you bow", "clap; bow"),
            ("clap, then could you bow", "clap; bow"), ("I do not want you to bow", ""),
            ("wave at the boss", "wave"), ("look at your mate", "look at your mate"),
            ("blow a kiss to your love", "blow a kiss"), ("give me some love", "give me some love"),
            ("when I say go, wave", "when I say go, wave"), ("wave when the music starts", "wave when the music starts"),
            ("left hand up, the right one is on your hip", "raise your left hand + put your right hand on your hip"),
        ],
    )  # fmt: skip
    def test_what_is_no_story_stays(self, text: str, commands: str) -> None:
        assert said(text) == commands


class TestOrders:
    @pytest.mark.parametrize(
        ("text", "commands"),
        [
            ("step one tilt your head to the right step two look up step three nod", "tilt your head to the right; look up; nod"),
            ("step 1: wave. step 2: bow", "wave; bow"), ("task one: nod, task two: clap", "nod; clap"),
            ("First job: hands on hips. Second job: twist to the right.", "put your hands on your hips; twist to the right"),
            ("first step is to nod, second step is to clap", "nod; clap"),
            ("The last thing to do is bow, the first is salute.", "salute; bow"), ("bow last, wave first", "wave; bow"),
            ("nod first, clap second", "nod; clap"), ("Wave to Mum, but bow first.", "bow; wave to mum"),
            ("Start by shrugging; from there go on to shake your head.", "shrug; shake your head"),
            ("cross your arms, after a beat shake your head", "cross your arms; shake your head"),
            ("before you clap, nod", "nod; clap"), ("clap and after a short pause nod", "clap; nod"),
            ("extend your right arm forward, and once it has been there for four seconds, lower it again",
             "extend your right arm forward (for 4 s); lower your right arm"),
            ("Lean to the left, and when you're there look that way", "lean to the left; look to the left"),
        ],
    )  # fmt: skip
    def test_are_read(self, text: str, commands: str) -> None:
        assert said(text) == commands

    @pytest.mark.parametrize(
        "text",
        ["point at number two", "take one step to the left", "wave to the first one", "nod at the last man first"],
    )
    def test_numbers_of_things_are_no_order(self, text: str) -> None:
        assert ";" not in said(text)


class TestWhatIsLeftOut:
    @pytest.mark.parametrize(
        ("text", "commands"),
        [
            ("uppercuts please. left one. right one.", "uppercuts with your left hand; uppercuts with your right hand"),
            ("jabs. right. left.", "jabs with your right hand; jabs with your left hand"),
            ("lean: left, then right", "lean to the left; lean to the right"),
            ("arms: left up, right down", "raise your left hand + lower your right arm"),
            ("Look up at the lamp, next down at the floor.", "look up; look down"),
            ("I need a peek down to the left, followed by one down to the right", "look down to the left; look down to the right"),
            ("turn your head to the right, then your trunk", "turn your head to the right; turn your trunk to the right"),
            ("Salute with your right hand while the left sits on your hip.",
             "salute with your right hand + put your left hand on your hip"),
            ("Bow, hands clasped while you do it.", "bow + clasp your hands"),
            ("look up during the time you are lifting up both arms", "look up + lift up both arms"),
            ("lean back and yawn all in one", "lean back + yawn"), ("lean forward and clap both at once", "lean forward + clap"),
            ("kiss your left hand and blow the kiss to me", "blow a kiss with your left hand to me"),
        ],
    )  # fmt: skip
    def test_is_taken_from_the_clause_before(self, text: str, commands: str) -> None:
        assert said(text) == commands


class TestDenials:
    @pytest.mark.parametrize(
        ("text", "commands", "denied"),
        [
            ("Shake your head and skip the bow this time.", "shake your head", ("the bow",)),
            ("never mind clapping just shrug", "shrug", ("clapping",)), ("forget the bow, just nod", "nod", ("the bow",)),
            ("Hammer with the left hand. Not saw. Hammer!", "hammer with the left hand", ("saw",)),
            ("a hug? nah. wave.", "wave", ("hug",)), ("neither clap nor nod: bow", "bow", ("clap", "nod")),
            ("neither clap nor nod", "", ("clap", "nod")), ("No more clapping, thank you very much.", "", ("clapping",)),
            ("Don't cover your eyes, it's your ears I want covered.", "cover your ears", ("cover your eyes",)),
            ("No, you're not allowed to clap yet, the glue isn't dry.", "", ("clap yet",)),
            ("Raise your right arm and leave the left one hanging.", "raise your right arm", ("the left arm",)),
            ("Pull! Who told you to push?", "pull", ("push",)),
            ("for goodness sake do not bow", "", ("bow",)), ("that's enough of the waving", "", ("waving",)),
            ("you should wave, oh never mind", "", ("wave",)),
            ("shrug as if to say never mind", "shrug", ()),
            ("if you clap once more I'll leave", "", ("clap once more",)),
            ("nobody's asking you to hug her, bow", "bow", ("hug her",)),
            ("salute; high fives have been banned here", "salute", ("high five",)), ("stop clapping, will you", "", ("clapping",)),
            ("turn your head, but not to the left", "turn your head to the right", ("to the left",)),
            ("wave with whichever hand you like as long as it isn't your left one", "wave with your right hand", ()),
        ],
    )  # fmt: skip
    def test_are_kept(self, text: str, commands: str, denied: tuple[str, ...]) -> None:
        assert (said(text), read(text).denied) == (commands, denied)

    @pytest.mark.parametrize(
        "text", ["do not just nod, bow", "a wave? yes. wave.", "not bad, clap", "no problem, wave"]
    )
    def test_these_deny_nothing_else(self, text: str) -> None:
        assert read(text).steps


class TestManner:
    @pytest.mark.parametrize(
        ("text", "command"),
        [
            ("Nod ever so slowly.", "nod (0.55 times as fast)"), ("nod dead slow", "nod (0.55 times as fast)"),
            ("Right arm up in one swift go", "raise your right hand (1.6 times as fast)"),
            ("The tiniest of nods, if you please.", "a nod (0.56 times as large)"),
            ("the slowest of waves", "a wave (0.5 times as fast)"),
            ("shake your head, but so I can hardly see it", "shake your head (0.56 times as large)"),
            ("bow so nobody notices", "bow (0.56 times as large)"),
            ("stir the glue with teeny weeny movements", "stir the glue (0.56 times as large)"),
            ("bow as far as the hinge goes", "bow (1.4 times as large)"),
            ("Just the one nod.", "nod once"), ("You should be waving to Nana four times.", "wave to nana four times"),
            ("Pump your fist in the air: one, two, three!", "pump your fist in the air three times"),
            ("give me half a dozen claps", "give me six claps"), ("do a couple of nods", "do two nods"),
            ("give a shake of the head", "shake your head"),
        ],
    )  # fmt: skip
    def test_is_read(self, text: str, command: str) -> None:
        assert said(text) == command

    @pytest.mark.parametrize(
        "text",
        [
            "wave so I can see it",
            "wave so that we can see you",
            "one, two, three, clap",
            "lean back a couple of inches",
        ],
    )
    def test_these_are_as_large_as_ever(self, text: str) -> None:
        assert "as large" not in said(text)


@pytest.mark.parametrize(
    ("text", "command"),
    [
        ("Throw a punch with yourleft arm.", "throw a punch with your left arm"), ("raisethe right hand", "raise the right hand"),
        ("clapyour hands twice", "clap your hands twice"),
        ("have a look over youre right shoulder", "look back over your right shoulder"),
        ("wave with your lefthand", "wave with your left hand"),
    ],
)  # fmt: skip
def test_words_typed_together_are_parted(text: str, command: str) -> None:
    assert said(text) == command


@pytest.mark.parametrize(
    "word", ["handsome", "toenail", "uphold", "armadillo", "thermal", "message", "mechanic", "headphones"]
)
def test_words_that_only_look_glued_stay(word: str) -> None:
    assert word in said(f"lean on the {word}")


@pytest.mark.parametrize(
    ("text", "command"),
    [
        ("cross your arns", "cross your arms"), ("salute with your right gand", "salute with your right hand"),
        ("lena forward", "lean forward"), ("leann back", "lean back"), ("wtist to the right", "twist to the right"),
        ("raise both armss", "raise both arms"), ("knock three timess", "knock three times"),
        ("shrug your shouldes", "shrug your shoulders"),
        ("leanforward", "lean forward"), ("coveryour eyes", "cover your eyes"), ("wave your left ha nd", "wave your left hand"),
        ("nod slow ly", "nod (0.62 times as fast)"), ("lean for ward", "lean forward"), ("clap our hands", "clap your hands"),
        ("twist ot the right", "twist to the right"), ("wave your let hand", "wave your left hand"),
        ("turn your head to the lift", "turn your head to the left"),
    ],
)  # fmt: skip
def test_a_slip_is_mended_by_its_place(text: str, command: str) -> None:
    assert said(text) == command


@pytest.mark.parametrize(
    "text",
    [
        "conduct your band", "wave your flag", "show me your work", "raise your glass", "point at your land", "wave to the lift",
        "let your hand sink", "look up right", "wave to lena", "take part in the dance", "hold your hat", "touch your nose",
    ],
)  # fmt: skip
def test_words_that_look_like_slips_in_their_place_stay(text: str) -> None:
    assert mended(text) == text
