"""What is said beside a command: targets, ways back, measures, stories with "so"; and what looks like these and is none."""

from __future__ import annotations

import pytest

from mmm_core.language.reading import read


@pytest.mark.parametrize(
    ("text", "read_as"),
    [
        ("raise a glass, though not till you've bowed", "bow; raise a glass"),
        ("wave, but not before you have clapped", "clap; wave"),
        ("pour a drink, and as soon as it's poured have a drink of it", "pour a drink; have a drink of it"),
        ("flex your muscles once you have curled the dumbbells", "curl the dumbbells; flex your muscles"),
        ("left arm straight out in front of you... grand, swap to the right",
         "stretch your left arm forward; stretch your right arm forward"),
        ("right arm up, and then t'other", "raise your right hand; raise your left hand"),
        ("cover your eyes, there's a jumpscare", "cover your eyes"),
        ("look over there. Not to the right, the opposite way!", "look to the left"),
        ("look left, after that look right, that is how we cross the road", "look to the left; look to the right"),
        ("throw a left hook straight off the back of a right uppercut", "a right uppercut; throw a left hook"),
        ("following a yawn you scratch your head", "a yawn; scratch your head"),
        ("raise your right arm, easy does it", "raise your right arm (0.62 times as fast)"),
        ("shake your head at warp speed", "shake your head (1.7 times as fast)"),
        ("nod twice, then shake it once", "nod twice; shake your head once"),
        ("lean left, lean right, then back to the middle", "lean to the left; lean to the right"),
        ("lean over to your right side and then come back and lean to the left", "lean to the right; lean to the left"),
        ("point up, then straight ahead, then at the floor", "point up; point ahead; point down"),
        ("wave with your right, and again with your left", "wave with your right hand; wave with your left hand"),
        ("put your left hand on your hip. Same with the right.", "put your left hand on your hip; put your right hand on your hip"),
        ("head left, right, left", "look to the left; look to the right; look to the left"),
        ("raise one hand, then swap", "raise your right hand; raise your left hand"),
        ("left arm up. Now the right. And both down.", "raise your left hand; raise your right hand; lower both arms"),
        ("with your left arm stretched out, wave with your right", "wave with your right hand + your left arm stretched out"),
        ("when the music starts I want you to clap, and when it stops I want you to bow", "clap; bow"),
        ("look up at the shelf", "look up"), ("look down at the sawdust twice", "look down twice"),
        ("stand up straight", "stand upright"),
        ("conduct the radio with your right arm", "conduct the orchestra with your right arm"),
        ("a wave with the left and then one with the right", "a wave with your left hand; a wave with your right hand"),
        ("rub your belly, then your head", "rub your belly; rub your head"),
        ("your right arm waves, your left arm is behind your back",
         "wave with your right hand + put your left hand behind your back"),
        ("clap, head bobbing", "clap + nod"),
        ("hush me with the right arm in a hurry", "hush me with the right arm (1.6 times as fast)"),
        ("signal with your left arm overhead", "signal with your left arm overhead"),
        ("lock your left elbow with the arm out in front", "lock your left elbow with the arm out in front"),
        ("wave as big as you can with the left arm", "wave with the left arm (1.4 times as large)"),
        ("jiggle my hand up and down using your right hand", "jiggle my hand up and down using your right hand"),
        ("make an ear trumpet with his right hand and holds it for one second",
         "make an ear trumpet with his right hand (for 1 s)"),
        ("the left hand rests, beckon me with your right hand", "beckon me with your right hand"),
        ("stop stirring the soup and clap your hands", "clap your hands"),
        ("for the love of god stop clapping and nod your head", "nod your head"),
        ("stop your ears with both hands", "stop your ears with both hands"),
        # and what looks like it
        ("nod with your arms up high", "nod + raise both hands up"),
        ("wave with your right hand and your left arm up", "wave with your right hand + raise your left hand"),
        ("nod as you clap", "nod + clap"), ("left arm up and right arm down", "raise your left hand + lower your right arm"),
        ("stop waving and clapping", ""), ("the left hand rests on your hip", "the left hand rests on your hip"),
        ("rub your belly, then shake your head", "rub your belly; shake your head"),
        ("look down at your watch", "look down at your watch"),
        ("look left at a snail's pace", "look to the left (0.5 times as fast)"),
        ("look up and clap", "look up + clap"), ("look over your left shoulder", "look back over your left shoulder"),
        ("conduct with your left arm", "conduct with your left arm"), ("conduct the choir", "conduct the choir"),
        ("pull your right hand back to your chest", "pull your right hand back to your chest"), ("lean back", "lean back"),
        ("shake it", "shake it"), ("the left arm at right angles to your body, to the front",
         "the left arm at right angles to your body, to the front"),
        ("stand up", "stand up"),
        ("act as if you are driving a car", "act as if you are driving a car"),
    ],
)  # fmt: skip
def test_what_is_read(text: str, read_as: str) -> None:
    assert "; ".join(read(text).sentences) == read_as


@pytest.mark.parametrize(
    ("text", "tempo", "size", "hold_s"),
    [
        ("slow down and bow", 0.62, 1.0, 0), ("bow, but hurry", 1.6, 1.0, 0), ("take it slow and shake your head", 0.62, 1.0, 0),
        ("clap as quietly and slowly as you can", 0.5, 1.0, 0), ("nod your head real quick", 1.6, 1.0, 0),
        ("nod vigorously", 1.6, 1.0, 0), ("wave like you mean it, nice and big", 1.0, 1.4, 0),
        ("hold your arms out for a count of four", 1.0, 1.0, 4.0), ("raise your hand for three beats", 1.0, 1.0, 3.0),
        ("wave with large movements", 1.0, 1.4, 0), ("nod with tiny movements", 1.0, 0.556, 0),
        ("lean all the way back", 1.0, 1.523, 0), ("bow at a leisurely pace", 0.62, 1.0, 0),
        # and what looks like it
        ("raise your arm all the way up", 1.0, 1.0, 0),
        ("lower your arm", 1.0, 1.0, 0), ("count to four", 1.0, 1.0, 0), ("a big wave", 1.0, 1.4, 0),
        ("wave to the real madrid fans", 1.0, 1.0, 0),
        ("beat the drum four times", 1.0, 1.0, 0),
    ],
)  # fmt: skip
def test_manner(text: str, tempo: float, size: float, hold_s: float) -> None:
    manner = read(text).steps[0][0].manner
    assert (manner.tempo, manner.size, manner.hold_s) == pytest.approx((tempo, size, hold_s), abs=0.03)


@pytest.mark.parametrize(
    ("text", "read_as", "denied"),
    [
        ("She is leaving now so wave goodbye to her with your right hand", "wave goodbye with your right hand", ()),
        ("My daughter likes it when you wave to her with your left hand, so would you?", "wave with your left hand", ()),
        ("The doctor says I should see if you can tilt your head to the right without it hurting",
         "tilt your head to the right", ()),
        ("could you maybe, if it isn't too weird, put both of your hands on your head for me", "put both hands on your head", ()),
        ("I was told this robot can salute, is that true? show me", "salute", ()),
        ("Before you go, one last thing: thumbs up", "thumbs up", ()),
        ("whatever you do, do not clap", "", ("clap",)), ("give me anything except a wave", "clap your hands", ("a wave",)),
        ("anything except clapping is fine, so bow", "bow", ("clapping",)),
        # and what looks like it
        ("lean so far that you nearly fall", "lean so far that you nearly fall", ()), ("tell me so", "tell me so", ()),
    ],
)  # fmt: skip
def test_words_around_a_request(text: str, read_as: str, denied: tuple[str, ...]) -> None:
    reading = read(text)
    assert ("; ".join(reading.sentences), reading.denied) == (read_as, denied)


@pytest.mark.parametrize(
    ("sentence", "commands"),
    [
        ("Raise your, um, left arm.", ["raise your left arm"]),
        ("First your left, then your right: raise your arms!", ["raise your left arm", "raise your right arm"]),
        ("look to your left side, then to the right", ["look to your left side", "look to your right side"]),
        ("my sister deserves a hug", ["a hug"]), ("the dog wants a walk", ["the dog wants a walk"]),
        ("a head tilt to the left while shrugging", ["a head tilt to the left", "shrug"]),
        ("he used to blow me a kiss from the gate, so I'd love it if you would blow me one", ["blow a kiss"]),
        ("my brother gave a bow, pick one up", ["my brother gave a bow, pick one up"]),
        ("bring your palms together", ["bring your palms together"]), ("say hi, five times", ["say hi, five times"]),
    ],
)  # fmt: skip
def test_words_that_the_sentence_said_before(sentence: str, commands: list[str]) -> None:
    assert [c.text for step in read(sentence).steps for c in step] == commands


@pytest.mark.parametrize(
    ("sentence", "command"),
    [
        ("twist your trunk to the right by only a few degrees", "twist your trunk to the right"), ("wave to the postman", "wave"),
        ("turn your head ninety degrees", "turn your head ninety degrees"), ("Lookup at the painted vault.", "look up"),
        ("wave to the bus driver with your left hand", "wave with your left hand"),
        ("bow politely to the camera", "bow politely"),
        ("wave to them three times", "wave three times"), ("bow to the left", "bow to the left"),
        ("nod to the beat", "nod to the beat"),
        ("wave to the people on your left", "wave to the people on your left"), ("clap for joy", "clap for joy"),
        ("raise your hand to your brow", "raise your hand to your brow"), ("nod at the floor", "nod at the floor"),
    ],
)  # fmt: skip
def test_whom_a_gesture_is_meant_for(sentence: str, command: str) -> None:
    assert [c.text for step in read(sentence).steps for c in step] == [command]
