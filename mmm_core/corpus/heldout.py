"""Probes: commands in words the grammar never says, with what they should show. Never trained on (a test sees to it)."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Probe:
    """A command and what its motion must show; empty and None where the text leaves it open."""

    text: str
    family: str
    limb: str
    side: str = ""
    count: int | None = None
    direction: str = ""


PROBES: tuple[Probe, ...] = (
    Probe("let me see you wave with the left hand", "wave", "arm", "left"),
    Probe("your right hand should be waving", "wave", "arm", "right"),
    Probe("signal hi using the left arm", "wave", "arm", "left"),
    Probe("send a greeting with your right arm", "wave", "arm", "right"),
    Probe("do four waves using the right hand", "wave", "arm", "right", 4),
    Probe("with the left hand, wave two times", "wave", "arm", "left", 2),
    Probe("hoist your right arm", "raise", "arm", "right"),
    Probe("elevate the left arm", "raise", "arm", "left"),
    Probe("get your right hand up high", "raise", "arm", "right"),
    Probe("left arm up", "raise", "arm", "left"),
    Probe("right hand in the air", "raise", "arm", "right"),
    Probe("thrust both arms skyward", "hands_up", "arm", "both"),
    Probe("both hands in the air now", "hands_up", "arm", "both"),
    Probe("arms out wide to the sides", "t_pose", "arm", "both"),
    Probe("make your body a T shape", "t_pose", "arm", "both"),
    Probe("indicate the left side with your left hand", "point", "arm", "left", None, "left"),
    Probe("aim your right arm to the right", "point", "arm", "right", None, "right"),
    Probe("point your left hand straight up", "point", "arm", "left", None, "up"),
    Probe("show me where the ceiling is by pointing with the right hand", "point", "arm", "right", None, "up"),
    Probe("point your right finger forwards", "point", "arm", "right", None, "forward"),
    Probe("direct your left arm ahead of you", "point", "arm", "left", None, "forward"),
    Probe("smack your hands together three times", "clap", "arm", "both", 3),
    Probe("five handclaps please", "clap", "arm", "both", 5),
    Probe("do a clap, just one", "clap", "arm", "both", 1),
    Probe("applause with both hands", "clap", "arm", "both"),
    Probe("bow deeply before the queen", "bow", "trunk"),
    Probe("do two bows", "bow", "trunk", "", 2),
    Probe("take three bows in a row", "bow", "trunk", "", 3),
    Probe("dip your head yes, two times", "nod", "head", "", 2),
    Probe("nod your agreement", "nod", "head"),
    Probe("four quick nods", "nod", "head", "", 4),
    Probe("your head says yes", "nod", "head"),
    Probe("wag your head no", "shake_head", "head"),
    Probe("shake that head", "shake_head", "head"),
    Probe("peek to the left", "look", "head", "", None, "left"),
    Probe("peer to the right", "look", "head", "", None, "right"),
    Probe("check what is on your right by turning the head", "look", "head", "", None, "right"),
    Probe("eyes up to the clouds", "look", "head", "", None, "up"),
    Probe("stare at your shoes", "look", "head", "", None, "down"),
    Probe("your gaze goes left", "look", "head", "", None, "left"),
    Probe("incline the head towards the left shoulder", "tilt_head", "head", "", None, "left"),
    Probe("tip the head over to the right side", "tilt_head", "head", "", None, "right"),
    Probe("dip your torso to the left", "lean", "trunk", "", None, "left"),
    Probe("sway your upper body over to the right", "lean", "trunk", "", None, "right"),
    Probe("twist your trunk leftwards", "twist", "trunk", "", None, "left"),
    Probe("rotate the shoulders to the right", "twist", "trunk", "", None, "right"),
    Probe("arms crossed, please", "cross_arms", "arm", "both"),
    Probe("interlock your arms over your chest", "cross_arms", "arm", "both"),
    Probe("hands to the hips", "hands_on_hips", "arm", "both"),
    Probe("left hand at your hip", "hands_on_hips", "arm", "left"),
    Probe("express with a shrug that you have no idea", "shrug", "arm", "both"),
    Probe("render a salute, right hand", "salute", "arm", "right"),
    Probe("salute the flag using the left hand", "salute", "arm", "left"),
    Probe("get me to come closer with the right hand", "beckon", "arm", "right"),
    Probe("halt me with the left palm", "stop", "arm", "left"),
    Probe("block the way with your right palm out", "stop", "arm", "right"),
    Probe("strike with the left fist, two times", "punch", "arm", "left", 2),
    Probe("hit out with your right fist three times", "punch", "arm", "right", 3),
    Probe("stroke your chin using the right hand", "think", "arm", "right"),
    Probe("right palm over the heart", "heart", "arm", "right"),
    Probe("press the left hand against your chest", "heart", "arm", "left"),
    Probe("not with the left, use your right hand to wave", "wave", "arm", "right"),
    Probe("wave, but with the left and not the right", "wave", "arm", "left"),
    Probe("lift the right arm rather than the left one", "raise", "arm", "right"),
    Probe("extend the left arm straight ahead", "arm_forward", "arm", "left"),
    Probe("the right arm goes straight out sideways", "arm_side", "arm", "right"),
)
