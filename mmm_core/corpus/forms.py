"""Tables of phrases around a gesture: sides, manner, order, requests and persons; `{v}`, `{a}`, `{b}` and `{s}` are slots."""

from __future__ import annotations

from mmm_core.language.inflection import NUMBERS

OTHER = {"left": "right", "right": "left"}
WITH_HAND = (" with your {S} hand", " with your {S} arm", " with the {S} hand", " using your {S} hand", " with the {S} arm", " using the {S} arm")  # fmt: skip
WITH_BOTH = (" with both hands", " with both arms", " with two hands", " using both hands")
IN_TURNS = (" one after the other", " alternately", " in turns", " with alternating hands", " left and right in turn", " first one hand then the other")  # fmt: skip
PRETEND = ("pretend to {v}", "act as if you {v}", "mime how you {v}", "make believe that you {v}", "do as if you {v}", "show me how you {v}")  # fmt: skip
PRETENDING = ("pretend", "act", "be", "imitate", "do", "show", "dance", "perform")
"""First verbs of phrases that already ask for pretending."""
REQUESTS = ("please {v}", "could you {v}", "can you {v}", "{v} please", "robot, {v}", "now {v}", "I want you to {v}", "go ahead and {v}", "you should {v}", "try to {v}", "would you {v}", "I would like you to {v}", "hey, {v}", "ok, {v}", "hey robot, {v}", "robot please {v}", "can you please {v}", "could you {v} for me", "would you mind and {v}", "I need you to {v}", "just {v}", "um, {v}", "uh {v}", "ok so {v}", "well, {v}", "you can {v} now", "will you {v}", "{v}, thanks", "{v} for me", "{v} now", "kindly {v}", "come on, {v}", "mate, {v}", "you must {v}", "next, {v}", "let us {v}", "how about you {v}", "it is time to {v}", "you have to {v}", "make sure to {v}", "be so kind and {v}", "your task: {v}", "I wish you would {v}", "all I ask is: {v}")  # fmt: skip
ABOUT_THE_ROBOT = ("have the robot {v}", "let the robot {v}", "make the robot {v}", "tell the robot to {v}", "the robot should {v}", "the robot must {v}")  # fmt: skip
PERSONS = ("a person {v}", "someone {v}", "the person {v}", "a man {v}", "a woman {v}", "the robot {v}", "a figure {v}", "the character {v}", "he {v}", "she {v}", "somebody {v}", "the humanoid {v}", "a human {v}", "a standing person {v}", "this person {v}")  # fmt: skip
GERUNDS = ("a person {v}", "someone {v}", "a person is {v}", "the robot is {v}", "{v}", "start {v}", "a motion of {v}", "show {v}", "a man is {v}", "begin {v}", "someone who is {v}")  # fmt: skip
SLOW = ("slowly", "gently", "in slow motion", "calmly", "at a slow pace", "carefully", "very slowly", "unhurriedly", "at a leisurely pace", "lazily", "at half speed", "taking your time", "without any hurry", "slow and steady", "really slow", "sluggishly")  # fmt: skip
FAST = ("quickly", "fast", "rapidly", "briskly", "at a fast pace", "in a hurry", "energetically", "very fast", "hastily", "swiftly", "speedily", "at high speed", "as fast as you can", "at double speed", "at a rapid pace", "like lightning", "really fast", "at a quick pace")  # fmt: skip
LARGE = ("widely", "with a big movement", "as far as you can", "strongly", "with large movements", "in a big way")
SMALL = ("slightly", "a little", "with a small movement", "a bit", "a tiny bit", "only slightly")
HEIGHTS = {
    ("wave", "high"): ("above your head", "up high", "high in the air", "with your arm raised"),
    ("wave", "low"): ("low at your side", "down low", "at hip height", "with a low arm"),
    ("raise", "low"): ("to shoulder height", "halfway", "only halfway", "to the level of your shoulder"),
    ("raise", "high"): ("as high as you can", "all the way up", "to the very top"),
}
HOLDS = ("and ^hold it for {s}", "for {s}", "and ^keep it there for {s}", "and ^stay like that for {s}", "and ^hold the pose for {s}", "and ^hold it {s} long", "holding it for {s}", "and ^stay there {s}", "and ^wait like that for {s}", "{s} long", "and ^do not move for {s}")  # fmt: skip
THEN = ("{a}, then {b}", "{a} and then {b}", "first {a}, then {b}", "{a}, after that {b}", "{a} and {b}", "{a}. then {b}", "{a}, next {b}", "first {a} and afterwards {b}", "{a} before you {b}", "{a}, followed by: {b}", "{a} then {b}", "{a}; {b}", "start with: {a}, then {b}", "after you {a}, {b}", "{a}, finally {b}", "{a}. now {b}")  # fmt: skip
THEN_TERSE = ("{a}, then {b}", "{a} and then {b}", "first {a}, then {b}", "{a}, after that {b}", "{a}. then {b}", "{a}, next {b}", "first {a} and afterwards {b}", "{a}; {b}", "start with: {a}, then {b}", "{a}, finally {b}", "{a}. now {b}", "{a}, and then {b}", "{a}, followed by {b}")  # fmt: skip
AT_ONCE_TERSE = ("{a} and {b} at the same time", "{a}, and at the same time {b}", "{a}, meanwhile {b}", "{a} together with {b}", "at the same time {a} and {b}", "{a}, and simultaneously {b}")  # fmt: skip
ASKED_TERSE = ("{p}, please", "{p} please", "please, {p}", "now {p}", "{p} now", "robot, {p}", "ok, {p}", "just {p}", "{p}, thanks", "hey robot, {p}", "um, {p}", "and {p}", "next, {p}", "robot: {p}", "{p} for me")  # fmt: skip
ASKED_NOUN = ("do {p}", "give me {p}", "show me {p}", "I want {p}", "make {p}", "perform {p}", "I would like {p}", "can I have {p}", "let us have {p}", "we need {p}", "how about {p}", "I would love {p}", "do me {p}", "it is time for {p}")  # fmt: skip
NOUN_BEGINS = ("a", "an", "some", "another", *NUMBERS[2:], *"2345678")
THEN_THIRD = ("{a}, then {b}", "{a} and then {b}", "{a} and afterwards {b}", "{a} and {b}", "first {a}, then {b}", "{a}, after that {b}", "{a} and finally {b}")  # fmt: skip
LONG_WAY_WORDS = (
    "up",
    "above",
    "over",
    "high",
    "sky",
    "ceiling",
    "question",
    "pupil",
    "volunteer",
    "overhead",
    "upwards",
    "upward",
    "vertical",
    "vertically",
    "air",
    "top",
)
