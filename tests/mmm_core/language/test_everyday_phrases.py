"""Everyday phrases as people say them, each read as the plain command that it means; and what looks like them and is none."""

from __future__ import annotations

import pytest

from mmm_core.language.reading import read

PHRASES = {
    'wave your right hand': (
        'hiya robot!', 'morning!', 'evening all', 'well hello there', 'yo', 'sup', "what's up buddy", 'welcome back',
        'long time no see', "look who's here", 'laters', 'catch you later', 'gotta go, bye', "I'm off now, bye bye",
        'night night', 'sleep well', 'safe travels', 'until tomorrow', 'have a nice day', 'hello hello hello',
        'hey you over there', 'good day to you sir', 'hi there little guy', 'say good morning to the class',
        'bye for now everybody', 'see you on Monday', 'I have to go now', 'good night sleep tight',
    ),
    'nod your head': (
        'yep', 'yup', 'uh-huh', 'okey dokey', 'ok', "that's fine with me", 'you got it', 'makes sense', 'deal',
        'say yes with your head', 'yes of course', 'yeah sure', 'sounds like a plan', "that's right", 'right on',
        "I'm with you on that", 'yes sir!',
    ),
    'shake your head': (
        'nah', 'nope', 'no chance', 'absolutely not', 'not in a million years', "I don't think so", "I'm afraid not",
        'tell him no', "that's not true", "don't think so", 'no thank you very much', 'no way José', 'certainly not',
        "that's wrong", 'please no',
    ),
    'shrug your shoulders': (
        'beats me', 'no clue', "I've no idea", 'dunno mate', 'how would I know', 'search me', 'go figure', 'meh',
        'who on earth knows', "I really couldn't say", "I haven't the foggiest", 'no idea whatsoever',
    ),
    'wobble your head': (
        'could be', 'hard to say', 'maybe so',
    ),
    'bow politely': (
        'ta', 'much obliged', 'thanks a million', 'thank you kindly', 'thank our guests', 'bend over',
        "thanks everyone, you're great", 'thank you for coming', "I'm very grateful", 'introduce yourself',
    ),
    'clap your hands': (
        'way to go', 'nailed it', 'good stuff', 'that was great', 'a big hand for the band', 'round of applause please',
        'give it up for our speaker', 'bravo bravo', 'great job everyone', 'that was a fantastic concert',
        "let's hear some applause", 'congratulations on your birthday',
    ),
    'put your right hand on your heart': (
        'sorry about that', 'my apologies', "sorry I'm late", 'forgive me please',
    ),
    'facepalm with your right hand': (
        'whoops', 'how embarrassing',
    ),
    'beckon me over with your right hand': (
        "c'mere", 'get over here', 'come on in', 'over to me', 'come and join us', 'come over here a second',
        'you there, come here', 'would you come here please',
    ),
    'wave me away with your right hand': (
        'off with you', 'get lost', 'leave us alone', 'go on, get out of here', 'please leave',
    ),
    'make a stop sign with your right hand': (
        'back off', 'not so close', 'hang on a sec', 'give me a minute', 'stop right where you are, sir',
        'just a second please', 'wait for me',
    ),
    'make a stop sign with both hands': (
        'hold your horses', 'stay calm everyone', 'chill out', 'everybody calm down please', 'no need to get upset',
    ),
    'put your right finger to your lips': (
        'pipe down', 'keep your voice down', "mum's the word", "don't tell anyone", 'quiet in the back',
        'could you be a bit quieter', "it's a secret between us", 'silence in the library',
    ),
    'look up': (
        'eyes up', 'check the ceiling', "what's that up there", 'take a look at the sky', 'chin up', 'look up in the sky',
        "there's a bird up there",
    ),
    'look back over your right shoulder': (
        "what's going on behind you", "who's that behind you", "something's moving behind you",
    ),
    'look down': (
        'watch your feet', 'check your shoes', 'your shoelace is open',
    ),
    'look around': (
        'have a look around', 'have a good look round',
    ),
    'look to the left; look to the right': (
        'check left and right',
    ),
    'look straight ahead': (
        'face me', 'keep your eyes on the road', 'look me in the eye', 'keep looking at me', 'look straight at me',
    ),
    'lean forward': (
        "lean in, I can't hear you", 'lean closer so you can hear me',
    ),
    'stand upright': (
        'sit up straight', 'straighten up', 'stand tall',
    ),
    'cover your mouth with both hands': (
        'act surprised', 'oh my god',
    ),
    'slump down': (
        'look sad', "it's so sad",
    ),
    'a yawn with the right hand': (
        "I'm so bored", "I'm so tired today", 'what a boring talk',
    ),
    'flex your muscles': (
        'show us your muscles', "who's a strong robot", 'you look so strong', 'show off',
    ),
    'celebrate your victory': (
        'party time', 'we did it', 'you won!', "it's my birthday",
    ),
    'cheer loudly': (
        'goal!', 'we scored!', 'hip hip hurray',
    ),
    'dance with one arm after the other': (
        'bust a move', 'show us your moves', "let's boogie", 'show me some dance moves', "let's see you dance", 'do anything',
    ),
    'give me five with your right hand': (
        'high five!', 'gimme five', 'up top', "don't leave me hanging", 'give me a high five',
    ),
    'hold out your right fist for a bump': (
        'fist bump',
    ),
    'hold out your right hand for a handshake': (
        "put 'er there", 'shake on it', 'shake hands with me',
    ),
    'give a big hug': (
        'bring it in', 'hug it out', 'I need a hug',
    ),
    'raise your right hand': (
        'pick me, pick me', 'who wants ice cream?', 'put your hand up', 'I swear', 'who wants to go first',
    ),
    'rub your hands together': (
        "it's chilly in here", "I'm freezing",
    ),
    'wipe your brow with your right hand': (
        "it's boiling",
    ),
    'cup your right ear': (
        'what did you say?', "can't hear you", "I can't hear the music",
    ),
    'cover your ears with both hands': (
        'too loud!', 'the music is too loud',
    ),
    'shade your eyes with your right hand': (
        "the sun's in my eyes",
    ),
    'cover your eyes with both hands': (
        "don't peek", 'close your eyes please',
    ),
    'look to the left': (
        "look at what's on your left",
    ),
    'bow politely (0.6 times as large)': (
        'bend down a bit',
    ),
    'raise a glass with your right hand': (
        "here's to you", 'to your good health',
    ),
    'blow a kiss with your right hand': (
        'I love you so much',
    ),
    'point to the right': (
        'over there on the right',
    ),
    'point at yourself': (
        'it was me',
    ),
    'breathe deeply': (
        'take a deep breath',
    ),
    'pray silently': (
        'let us pray',
    ),
    'a stretch': (
        'time for a stretch',
    ),
    'march with your arms': (
        'march',
    ),
    'type on a keyboard': (
        'type, please',
    ),
    'bow (1.4 times as large)': (
        'bow low', 'bow down low to the king',
    ),
    'a bow (1.4 times as large)': (
        'a deep bow', 'a low bow please',
    ),
}  # fmt: skip
"""Each command, and the phrases that mean it. The last third was written after the rules for the first two thirds
and before its own rules."""


@pytest.mark.parametrize(("text", "command"), [(text, command) for command, texts in PHRASES.items() for text in texts])
def test_a_phrase_means_a_gesture(text: str, command: str) -> None:
    assert "; ".join(read(text).sentences) == command


@pytest.mark.parametrize(
    ("text", "read_as"),
    [
        ("hello, shovel snow", "shovel snow"), ("hi, peel a banana", "peel a banana"),
        ("hello, raise your arm", "raise your right hand"),
        ("good morning, how do I install python", "good morning, how do I install python"),
        ("well done is how I like my steak", "done is how i like my steak"), ("sorry, wave instead", "wave"),
        ("maybe you could wave", "wave"), ("say hello with your left hand", "wave your left hand"),
        ("wave goodbye to her with your left hand", "wave goodbye with your left hand"),
        ("hello what is the weather like", "hello what is the weather like"), ("no hands", ""),
        ("not so fast", "make a stop sign with both hands"),
        ("thank you, now nod", "bow politely; nod"), ("yes, but slowly", "nod your head (0.62 times as fast)"),
        ("raise your hand and say hello", "raise your hand and say hello"), ("cover your eyes", "cover your eyes"),
        ("gotta go, bye", "wave your right hand"), ("shoo, go away", "wave me away with your right hand"),
        ("keep your left elbow low", "keep your left elbow low"), ("draw the bow low", "draw the bow low"),
        ("march to the kitchen", "march to the kitchen"), ("take deep breaths and bow", "take deep breaths; bow"),
    ],
)  # fmt: skip
def test_what_looks_like_one(text: str, read_as: str) -> None:
    assert "; ".join(read(text).sentences) == read_as
