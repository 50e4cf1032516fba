"""Restarts and homophones of speech, and long polite requests; and sentences that look like these and are none."""

from __future__ import annotations

import pytest

from mmm_core.language.reading import read


@pytest.mark.parametrize(
    ("text", "read_as"),
    [
        # words begun again, put right, or heard for another
        ("fold you know fold your arms", "fold your arms"), ("raise your left arm i mean hand", "raise your left hand"),
        ("put your hand on your chest, sorry, head", "put your hand on your head"),
        ("clap yeah and then bow", "clap; bow"), ("bow too the king", "bow"),
        ("wave too the ceiling", "wave to the ceiling"), ("not on the door", "knock on the door"),
        ("make a fist and not not on the table", "make a fist; knock on the table"),
        ("pretend your on the phone", "pretend you are on the phone"),
        ("shake your head like you're saying know", "shake your head like you are saying no"),
        # words around a request
        ("sorry to disturb you, I know you are busy, but could you possibly nod", "nod"),
        ("I wonder whether, when you are ready, you might clap", "clap"),
        ("perhaps you would care to wave", "wave"), ("you might want to bow", "bow"), ("wave, perhaps", "wave"),
        ("should anybody ask, kindly nod", "nod"), ("bow to the guests. Go on, do it now.", "bow"),
        ("may I ask you please that you make the gesture of drinking a cup of tea", "drink a cup of tea"),
        ("salute with whichever hand you like, if that's ok with you", "salute"),
        ("there is a wasp on your nose; you might want to brush it away", "brush your nose"),
        ("let the guests know that you see them, with a friendly wave", "a wave"),
        ("turn your head so that you can see the lady on your left", "turn your head to the left"),
        ("let your shoulders say that you have no clue", "shrug your shoulders"),
        ("look around the room, first to one side and then to the other", "look to the left; look to the right"),
        # a robot that is spoken of
        ("the robot should clap its left hand to its hip", "clap its left hand to its hip"), ("tell the robot to nod", "nod"),
        ("I want the robot to bow", "bow"), ("can the robot wave?", "wave"), ("the robot must do the robot", "do the robot"),
        ("a dancing robot", "a dancing robot"), ("can the robot see me", "can the robot see me"), ("wave, robot", "wave"),
        ("show me a quick stir, swiftly", "show me a stir (1.6 times as fast)"),
        # and what looks like these
        ("nod yes and clap", "nod yes + clap"), ("shout yes and pump your fist", "shout yes and pump your fist"),
        ("put your hand on your head, not on the table", "put your hand on your head"),
        ("clap two times", "clap two times"), ("whether you know it or not, wave", "whether you know it or not, wave"),
        ("say maybe", "say maybe"), ("maybe", "wobble your head"), ("greet me with a bow", "greet me with a bow"),
        ("do you know how to bow", "bow"), ("point with your left hand so that I can see it", "point with your left hand"),
        ("let your head hang", "let your head hang"), ("I am sorry", "put your right hand on your heart"),
        ("do the wave", "do the wave"),
    ],
)  # fmt: skip
def test_what_is_read(text: str, read_as: str) -> None:
    assert "; ".join(read(text).sentences) == read_as


@pytest.mark.parametrize(
    ("text", "read_as"),
    [
        ("wave 2 the crowd 4 me", "wave your right hand"), ("hold ur arm up 4 5 secs", "raise your arm up (for 5 s)"),
        ("lift ur left arm hi", "lift your left arm high"), ("raise your hand I mean your left hand", "raise your left hand"),
        ("turn your head to the left uh right", "turn your head to the right"), ("pray 4 us xx", "pray silently"),
        ("put both arms up no sorry just the left one", "put your left arm up"),
        ("raise one arm i mean both arms", "raise both arms"), ("bow i mean salute", "salute"),
        ("look at at the floor", "look down"), ("hay robot nod you're head", "nod your head"),
        ("lean four word", "lean forward"), ("clap your to hands", "clap both hands"),
        ("people usually clap at the end, so please do that as well", "clap at the end"),
        ("it is late and everybody is tired, but one last bow for the audience would really make them happy", "one last bow"),
        ("if I were you I would bow", "bow"), ("could you shake your head if the answer is no", "shake your head"),
        ("you have been standing there all day; surely you'd like to stretch both arms", "stretch both arms"),
        ("the man over there is waving at you, please be polite and nod back", "nod back"),
        ("we would be much obliged if you lifted your left arm", "lift your left arm"),
        ("my sister bets that you can't touch your nose; prove her wrong", "touch your nose"),
        ("hold out your left hand, palm up, then close the fingers",
         "hold out your left hand with the palm up; close your left fingers"),
        ("my son is a bit shy, so maybe start by giving him a tiny wave", "wave your right hand (0.56 times as large)"),
        ("ladies and gentlemen, our robot will now take a deep bow", "bow politely (1.4 times as large)"),
        ("could you please, when the lights go out, raise your right hand so that the people behind you know where you are",
         "raise your right hand"),
        ("you know what would be great right now? A big round of applause", "clap your hands"),
        ("whenever you feel ready and only if nothing hurts, slowly lift your left arm", "lift your left arm (0.62 times as fast)"),
        ("show our guests the way to the exit on the right", "point to the right"),
        ("since it is my birthday, could I have a hug", "a hug"),
        # and what looks like these
        ("ladies and gentlemen, the next act", "ladies and gentlemen, the next act"),
        ("when you have bowed, clap", "bow; clap"), ("show us the way", "show us the way"),
        ("show me the way to the left", "show me the way to the left"),
        ("clap 4 times", "clap 4 times"), ("look left er right er left", "look to the left; look to the right; look to the left"),
        ("lift your hand, say hi", "lift your hand, say hi"),
        ("what is going on on your right", "what is going on on your right"),
        ("reach up with your left hand, grab something and bring it down",
         "reach up with your left hand, grab something and bring it down"),
        ("bow if the king is here", "bow if the king is here"), ("clap for four", "clap for four"),
        ("a bow would be nice", "a bow"),
    ],
)  # fmt: skip
def test_what_is_read_of_stories_and_slips_of_the_tongue(text: str, read_as: str) -> None:
    assert "; ".join(read(text).sentences) == read_as
