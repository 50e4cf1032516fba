"""Greetings, thanks and farewells: sentences whose beginning says the gesture."""

from __future__ import annotations

import pytest

from mmm_core.language.reading import read

SOCIAL = {
    'wave your right hand': (
        'hi folks, great to have you', 'good afternoon madam', 'bye grandma, see you next week', "I'm heading home",
    ),
    'bow politely': (
        'thanks for your help today', 'thank you all, you were wonderful', "that's very kind",
    ),
    'nod your head': (
        "yes, that's what I meant",
    ),
    'shake your head': (
        "that's not what I asked for", "no thanks, I'm full",
    ),
    'shrug your shoulders': (
        'who can say', 'not a clue, sorry',
    ),
    'put your right hand on your heart': (
        'sorry for the wait', "excuse me, I'm so sorry",
    ),
    'clap your hands': (
        'bravo, what a goal', 'well done team', 'that was a lovely song', 'everyone give him a round of applause',
    ),
    'beckon me over with your right hand': (
        'come over and say hi', 'come here my friend', 'this way please, ladies',
    ),
    'wave me away with your right hand': (
        'please go away now', 'get out of my kitchen',
    ),
    'make a stop sign with your right hand': (
        "hold on, I'm not ready", "wait a second, I'm coming", 'one moment please, sir',
    ),
    'make a stop sign with both hands': (
        "stay calm, it's only a drill", "don't get angry",
    ),
    'put your right finger to your lips': (
        "shush, he's on the phone", 'quiet please, we are filming',
    ),
    'look, up there + a plane': (
        'look, up there, a plane',
    ),
    'look up': (
        "what's on the ceiling",
    ),
    'look down': (
        'look down at the floor',
    ),
    'celebrate your victory': (
        'we are the winners',
    ),
    'cheer loudly': (
        "hooray, it's snowing",
    ),
    'dance with one arm after the other': (
        'show me your best dance move',
    ),
    'give a big hug': (
        'give your grandpa a hug', 'I want a cuddle',
    ),
    'give me five with your right hand': (
        'gimme a high five buddy',
    ),
    'flex your muscles': (
        'let me see those muscles',
    ),
    'a yawn with the right hand': (
        'this is so boring',
    ),
    'facepalm with your right hand': (
        'oh no, I broke it',
    ),
    'cover your mouth with both hands': (
        'oh my goodness, a spider',
    ),
    'rub your hands together': (
        "brr, it's icy",
    ),
    'wipe your brow with your right hand': (
        'phew, what a hot day',
    ),
    'cup your right ear': (
        "speak up, I'm deaf",
    ),
    'shade your eyes with your right hand': (
        "it's too bright to see",
    ),
    'cover your eyes with both hands': (
        "don't look, it's a surprise",
    ),
    'blow a kiss with your right hand': (
        'kisses to everyone',
    ),
    'raise a glass with your right hand': (
        'cheers everyone, happy new year',
    ),
    'salute with your right hand': (
        'attention, soldiers',
    ),
}  # fmt: skip
"""Sentences whose beginning says the gesture; 34 of 63 such were read before there were rules for them."""


@pytest.mark.parametrize(("text", "command"), [(text, command) for command, texts in SOCIAL.items() for text in texts])
def test_a_phrase_means_a_gesture(text: str, command: str) -> None:
    assert "; ".join(read(text).sentences) == command
