"""What people say for each family. Every phrase is an imperative that begins with its verb; `grammar` bends it.

Slots: {S} the side (left or right), {D} the direction, {n} a count ("twice", "3 times", or nothing), {N} a number.
A family's phrases stand under "one" (with a side), "any" (no side named), "both", or "none" (families without sides);
a direction with words of its own has its own table, keyed by direction.
"""

from __future__ import annotations

Phrases = dict[str, list[str]]

PHRASES: dict[str, Phrases] = {
    "wave": {
        "one": ["wave your {S} hand {n}", "wave with your {S} hand {n}", "wave your {S} arm {n}", "wave {n} with your {S} arm",
                "wave hello with your {S} hand {n}", "say hello with your {S} hand {n}", "greet me with your {S} hand {n}",
                "say goodbye with your {S} hand {n}", "raise your {S} hand and wave {n}", "give {N} waves with your {S} hand",
                "give a wave with your {S} hand", "do a {S} hand wave {n}", "wave goodbye with your {S} arm {n}"],
        "any": ["wave {n}", "wave hello {n}", "wave at me {n}", "say hello", "say hi", "greet the visitors", "wave goodbye {n}", "say goodbye", "give a friendly wave", "wave your hand {n}", "greet me with a wave"],
        "both": ["wave both hands {n}", "wave both your arms {n}", "wave with both hands {n}", "wave with both arms {n}", "wave hello with two hands {n}", "greet me with both hands {n}"],
    },
    "raise": {
        "one": ["raise your {S} hand", "raise your {S} arm", "lift your {S} hand", "lift your {S} arm up", "put your {S} hand up", "put your {S} arm up in the air", "hold your {S} hand up high", "raise the {S} arm above your head", "stretch your {S} arm up", "bring your {S} hand up", "reach up with your {S} hand", "move your {S} arm up", "lift the {S} hand over your head"],
        "any": ["raise your hand", "put your hand up", "raise one arm", "lift one hand up"],
    },
    "arm_forward": {
        "one": ["stretch your {S} arm forward", "extend your {S} arm in front of you", "hold your {S} arm out in front", "reach forward with your {S} hand", "put your {S} arm straight out in front", "raise your {S} arm forward to shoulder height", "lift your {S} arm to the front", "reach out your {S} hand to the front"],
        "any": ["reach forward", "stretch one arm forward"],
        "both": ["stretch both arms forward", "hold your arms out in front of you", "extend both arms forward", "put both arms straight out in front", "raise both arms forward", "reach forward with both hands", "walk like a zombie", "hold your arms out like a zombie"],
    },
    "arm_side": {
        "one": ["raise your {S} arm to the side", "hold your {S} arm out to the side", "stretch your {S} arm out sideways", "extend your {S} arm to the side", "lift your {S} arm sideways", "put your {S} arm out to the side"],
        "any": ["raise one arm to the side"],
    },
    "t_pose": {
        "both": ["hold your arms out to the sides", "make a T pose", "do a T pose", "spread your arms", "stretch both arms out to the sides", "raise both arms to shoulder height", "hold both arms out sideways", "extend your arms sideways", "put your arms out like a scarecrow", "spread both arms wide like a T", "form the letter T", "lift both arms to the sides", "put both arms out", "stand with arms out"],
    },
    "hands_up": {
        "both": ["raise both hands", "raise both arms", "put your hands up", "put both hands up in the air", "lift both arms up", "raise your arms above your head", "lift your hands over your head", "stretch both arms up", "hold both arms up", "put your arms up", "reach for the sky with both hands", "hold your hands up high", "surrender with your hands up", "bring both hands up over your head"],
    },
    "arms_down": {
        "one": ["lower your {S} arm", "put your {S} arm down", "put your {S} hand down", "drop your {S} arm", "bring your {S} hand down", "let your {S} arm hang", "relax your {S} arm"],
        "any": ["lower your arm", "put your hand down"],
        "both": ["lower both arms", "put your arms down", "put your hands down", "lower your hands", "bring both arms down", "let your arms hang by your sides", "relax your arms", "put both arms by your sides", "drop both arms", "rest your arms"],
    },
    "clap": {
        "both": ["clap {n}", "clap your hands {n}", "clap your hands together {n}", "give {N} claps", "applaud", "give a round of applause", "clap {n} with both hands", "hit your hands together {n}", "give me {N} claps", "do {N} claps", "applaud the speaker"],
    },
    "bow": {
        "none": ["bow {n}", "take a bow", "make a bow {n}", "bow down {n}", "bow politely {n}", "bend forward in a bow {n}", "give a bow", "give {N} bows", "bow to the audience {n}", "bow your upper body {n}", "greet with a bow", "make a deep bow"],
    },
    "nod": {
        "none": ["nod {n}", "nod your head {n}", "nod yes {n}", "say yes with your head", "give a nod", "give {N} nods", "nod in agreement {n}", "agree by nodding {n}", "move your head up and down {n}", "show that you agree with a nod", "nod approvingly {n}", "nod your head up and down {n}"],
    },
    "shake_head": {
        "none": ["shake your head {n}", "shake your head no {n}", "say no by shaking your head", "say no with your head", "turn your head from side to side {n}", "disagree by shaking your head {n}", "move your head left and right {n}", "shake your head in disagreement {n}", "show disagreement with your head", "give {N} head shakes", "refuse by shaking your head {n}"],
    },
    "tilt_head": {
        "none": ["tilt your head to the {D}", "tilt your head {D}", "lean your head to the {D}", "tip your head to the {D}", "bend your head to the {D}", "incline your head to the {D}", "drop your head towards your {D} shoulder", "put your {D} ear to your {D} shoulder"],
    },
    "look_around": {
        "none": ["look around", "look left and right", "look around the room", "look to both sides", "scan the room", "look from side to side", "search the room with your eyes", "glance around", "have a look around"],
    },
    "cross_arms": {
        "both": ["cross your arms", "fold your arms", "cross your arms in front of your chest", "fold both arms", "stand with crossed arms", "fold your arms across your chest", "cross both arms over your chest", "put your arms across your chest", "keep your arms folded"],
    },
    "hands_on_hips": {
        "one": ["put your {S} hand on your hip", "place your {S} hand on your {S} hip", "rest your {S} hand on your hip", "set your {S} hand on the hip", "hold your {S} hip", "bring your {S} hand to your waist"],
        "any": ["put one hand on your hip", "rest a hand on your hip"],
        "both": ["put your hands on your hips", "place both hands on your hips", "stand with hands on hips", "rest both hands on your hips", "put your hands on your waist", "hold your hips with both hands", "set your arms akimbo", "stand like a superhero with hands on hips"],
    },
    "shrug": {
        "both": ["shrug {n}", "shrug your shoulders {n}", "give a shrug", "raise your shoulders {n}", "lift your shoulders as if you do not know", "show that you do not know", "say I don't know with your shoulders", "give {N} shrugs", "shrug helplessly {n}", "pull up your shoulders {n}", "make a shrug"],
    },
    "salute": {
        "one": ["salute with your {S} hand", "give a {S} handed salute", "salute like a soldier with your {S} hand", "bring your {S} hand to your forehead in a salute", "make a military salute with the {S} hand", "put your {S} hand to your brow", "shade your eyes with your {S} hand"],
        "any": ["salute", "give a salute", "salute like a soldier", "make a military salute", "salute the captain", "shade your eyes"],
    },
    "beckon": {
        "one": ["beckon with your {S} hand {n}", "call me over with your {S} hand {n}", "wave me over with your {S} hand {n}", "signal me to come with your {S} hand {n}", "make a come here sign with the {S} hand {n}", "gesture come here with your {S} arm {n}", "motion me closer with your {S} hand {n}"],
        "any": ["beckon {n}", "call me over", "tell me to come here", "signal come here {n}", "make a come here gesture", "invite me over with your hand", "beckon me to come {n}", "wave me over"],
    },
    "stop": {
        "one": ["make a stop sign with your {S} hand", "hold up your {S} hand to say stop", "signal stop with your {S} hand", "show your {S} palm", "put your {S} palm out to stop me", "stop the traffic with your {S} hand", "hold your {S} palm out in front of you", "give a halt sign with your {S} hand"],
        "any": ["make a stop sign", "signal stop", "show me a stop gesture", "stop the traffic", "tell me to stop with your hand", "hold your palm out", "give a halt sign"],
        "both": ["make a stop sign with both hands", "hold up both palms", "signal stop with both hands", "put both palms out in front of you", "show both your palms"],
    },
    "punch": {
        "one": ["punch with your {S} hand {n}", "punch with your {S} fist {n}", "throw a {S} punch {n}", "throw {N} punches with your {S} arm", "hit forward with your {S} fist {n}", "box with your {S} hand {n}", "jab with your {S} hand {n}", "punch forward with the {S} arm {n}", "give {N} {S} punches"],
        "any": ["punch {n}", "throw a punch", "punch forward {n}", "jab {n}"],
        "both": ["punch with both hands {n}", "box {n}", "throw {N} punches with both hands", "punch with alternating fists {n}", "do some boxing", "box with both fists {n}", "punch left and right {n}", "shadow box"],
    },
    "flap": {
        "both": ["flap your arms {n}", "flap your arms like a bird {n}", "flap your wings {n}", "pretend to fly like a bird", "move your arms up and down at your sides {n}", "flap both arms {n}", "beat your arms like wings {n}", "give {N} flaps with your arms", "fly like a bird"],
    },
    "pray": {
        "both": ["put your hands together in prayer", "pray", "make a namaste", "greet with a namaste", "fold your hands in prayer", "press your palms together in front of your chest", "hold your hands together as if praying", "put your palms together", "say namaste", "join your hands in front of your chest", "beg with folded hands"],
    },
    "think": {
        "one": ["put your {S} hand to your chin", "think with your {S} hand on your chin", "hold your chin with your {S} hand", "touch your chin with your {S} hand", "rest your chin on your {S} hand", "scratch your chin with your {S} hand", "bring your {S} hand to your chin"],
        "any": ["think", "look thoughtful", "put your hand to your chin", "ponder", "think about it", "touch your chin", "act like you are thinking"],
    },
    "heart": {
        "one": ["put your {S} hand on your heart", "place your {S} hand on your chest", "touch your chest with your {S} hand", "hold your {S} hand over your heart", "lay your {S} hand on your chest", "put the {S} hand to your heart", "swear with your {S} hand on your heart"],
        "any": ["put your hand on your heart", "place a hand on your chest", "touch your heart", "show that you are grateful with a hand on your heart", "hold your hand over your heart"],
    },
    "go_away": {
        "one": ["shoo me away with your {S} hand {n}", "wave me away with your {S} hand {n}", "send me away with your {S} hand {n}", "make a go away gesture with your {S} hand {n}", "shoo with the {S} hand {n}", "dismiss me with your {S} hand {n}"],
        "any": ["shoo me away {n}", "make a go away gesture", "tell me to go away", "send me away with a gesture", "wave me away {n}", "dismiss me"],
    },
    "conduct": {
        "one": ["conduct an orchestra with your {S} hand {n}", "conduct with your {S} arm {n}", "beat time with your {S} hand {n}", "swing a baton with your {S} hand {n}"],
        "any": ["beat time with one hand {n}"],
        "both": ["conduct an orchestra {n}", "conduct with both hands {n}", "beat time with both arms {n}", "act like a conductor", "conduct the music"],
    },
    "drum": {
        "both": ["play the drums", "drum {n}", "beat a drum {n}", "drum with both hands {n}", "hit the drum {n}", "pretend to play the drums", "give {N} drum beats", "play a drum roll", "drum on a table {n}"],
    },
    "push": {
        "one": ["push with your {S} hand {n}", "push forward with your {S} arm {n}", "push something away with your {S} hand {n}", "shove with your {S} hand {n}", "push the door with your {S} hand {n}"],
        "any": ["push with one hand {n}"],
        "both": ["push {n}", "push forward {n}", "push with both hands {n}", "push something away {n}", "push a wall {n}", "shove forward with both hands {n}", "push an invisible box away {n}", "give {N} pushes"],
    },
    "pull": {
        "one": ["pull with your {S} hand {n}", "pull something towards you with your {S} hand {n}", "pull a rope with your {S} arm {n}", "pull back your {S} arm {n}"],
        "any": ["pull with one hand {n}"],
        "both": ["pull {n}", "pull a rope {n}", "pull with both hands {n}", "pull something towards you {n}", "pull back with both arms {n}", "pull an invisible rope {n}", "row with both arms {n}"],
    },
    "drink": {
        "one": ["drink with your {S} hand", "take a sip with your {S} hand", "bring a cup to your mouth with your {S} hand", "drink from a glass with your {S} hand", "lift a cup to your lips with the {S} hand", "bring your {S} hand to your mouth"],
        "any": ["drink", "take a drink", "pretend to drink from a cup", "take a sip of coffee", "drink a glass of water"],
    },
    "phone": {
        "one": ["answer the phone with your {S} hand", "hold a phone to your {S} ear", "make a phone call with your {S} hand", "put your {S} hand to your ear", "listen with your {S} hand at your ear", "talk on the phone with the {S} hand", "cup your {S} ear"],
        "any": ["answer the phone", "make a phone call", "talk on the phone", "put your hand to your ear", "pretend to call someone"],
    },
    "facepalm": {
        "one": ["facepalm with your {S} hand", "cover your face with your {S} hand", "put your {S} hand over your face", "hide your eyes with your {S} hand", "wipe your forehead with your {S} hand", "hit your forehead with your {S} palm"],
        "any": ["facepalm", "do a facepalm", "cover your face with one hand", "put your hand on your face"],
    },
    "behind_head": {
        "one": ["put your {S} hand behind your head", "scratch the back of your head with your {S} hand", "bring your {S} hand behind your head", "touch the back of your head with your {S} hand", "place your {S} hand at the back of your neck"],
        "any": ["put one hand behind your head", "scratch the back of your head"],
        "both": ["put your hands behind your head", "place both hands behind your head", "relax with your hands behind your head", "fold your hands behind your head", "clasp your hands behind your neck"],
    },
    "flex": {
        "one": ["flex your {S} arm", "flex your {S} biceps", "show your {S} muscle", "flex the {S} bicep", "show off your {S} arm muscle"],
        "any": ["flex one arm"],
        "both": ["flex your muscles", "flex both arms", "show your muscles", "flex your biceps", "show how strong you are", "pose like a bodybuilder", "make a strong man pose"],
    },
    "cheer": {
        "both": ["cheer {n}", "cheer with both arms {n}", "celebrate", "celebrate with your arms up", "pump both fists in the air {n}", "throw your arms up in joy {n}", "cheer for the team {n}", "celebrate a goal", "rejoice", "give {N} cheers", "raise both arms and cheer {n}"],
    },
    "offer": {
        "one": ["offer your {S} hand", "hold out your {S} hand", "hold your {S} hand out palm up", "ask for something with your {S} hand", "offer something with your {S} hand", "present something with your {S} hand", "reach out your {S} hand to shake hands", "give me your {S} hand"],
        "any": ["offer a hand", "hold out your hand", "shake hands", "offer me something", "give me your hand"],
        "both": ["hold out both hands", "offer something with both hands", "hold out both hands palms up", "present something with both hands", "receive something with both hands"],
    },
    "stand": {
        "none": ["stand still", "do nothing", "stay still", "stand there", "wait", "rest", "stay where you are", "hold still", "do not move", "be idle", "stand quietly", "keep still", "stand at ease", "relax and stand"],
    },
}  # fmt: skip

DIRECTED: dict[str, dict[str, Phrases]] = {
    "point": {
        "left": {"any": ["point to the left", "point left", "point to your left", "point at the left wall", "show me the left side"], "one": ["point left with your {S} hand", "point to the left with your {S} arm", "use your {S} hand to point left"]},
        "right": {"any": ["point to the right", "point right", "point to your right", "point at the right wall", "show me the right side"], "one": ["point right with your {S} hand", "point to the right with your {S} arm", "use your {S} hand to point right"]},
        "forward": {"any": ["point at me", "point forward", "point straight ahead", "point to the front", "point in front of you"], "one": ["point forward with your {S} hand", "point at me with your {S} hand", "point ahead with your {S} arm", "point at the person in front of you with your {S} hand"]},
        "up": {"any": ["point up", "point at the ceiling", "point to the sky", "point upwards"], "one": ["point up with your {S} hand", "point at the ceiling with your {S} arm", "point to the sky with your {S} hand"]},
        "down": {"any": ["point down", "point at the floor", "point to the ground", "point downwards"], "one": ["point down with your {S} hand", "point at the floor with your {S} hand", "point to the ground with your {S} arm"]},
        "self": {"any": ["point at yourself", "point to yourself", "point to your own chest"], "one": ["point at yourself with your {S} hand", "point to your chest with your {S} hand"]},
    },
    "look": {
        "left": {"none": ["look left", "look to the left", "turn your head to the left", "turn your head left", "glance left", "look over to your left side", "face left with your head", "gaze to the left"]},
        "right": {"none": ["look right", "look to the right", "turn your head to the right", "turn your head right", "glance right", "look over to your right side", "face right with your head", "gaze to the right"]},
        "up": {"none": ["look up", "look at the ceiling", "look up at the sky", "raise your head", "turn your eyes up", "gaze upwards", "lift your head and look up", "tilt your head back"]},
        "down": {"none": ["look down", "look at the floor", "look down at your feet", "lower your head", "drop your head", "gaze at the ground", "hang your head", "bend your head down"]},
    },
    "lean": {
        "left": {"none": ["lean to the left", "lean left", "bend your body to the left", "bend sideways to the left", "tilt your upper body left", "lean over to your left side"]},
        "right": {"none": ["lean to the right", "lean right", "bend your body to the right", "bend sideways to the right", "tilt your upper body right", "lean over to your right side"]},
        "forward": {"none": ["lean forward", "bend forward a little", "lean your body forward", "tilt your upper body forward", "lean towards me", "bend your back forward"]},
        "back": {"none": ["lean back", "lean backward", "bend backwards", "lean your body back", "tilt your upper body back", "lean away from me"]},
    },
    "twist": {
        "left": {"none": ["turn your upper body to the left", "twist to the left", "rotate your torso left", "turn your waist to the left", "twist your body left", "turn your shoulders left", "swivel to the left"]},
        "right": {"none": ["turn your upper body to the right", "twist to the right", "rotate your torso right", "turn your waist to the right", "twist your body right", "turn your shoulders right", "swivel to the right"]},
    },
    "clap": {
        "": {"both": PHRASES["clap"]["both"]},
        "up": {"both": ["clap above your head {n}", "clap overhead {n}", "clap your hands over your head {n}", "raise your arms and clap {n}", "clap high in the air {n}"]},
    },
    "arm_circle": {
        "forward": {"one": ["circle your {S} arm forward {n}", "swing your {S} arm in circles {n}", "make circles with your {S} arm {n}", "rotate your {S} arm forward {n}", "draw {N} circles with your {S} arm"], "any": ["make circles with one arm {n}"], "both": ["circle your arms forward {n}", "make arm circles {n}", "do {N} arm circles", "rotate both arms forward {n}", "swing both arms in circles {n}"]},
        "back": {"one": ["circle your {S} arm backward {n}", "rotate your {S} arm backwards {n}", "make backward circles with your {S} arm {n}"], "any": ["make backward circles with one arm {n}"], "both": ["circle your arms backward {n}", "do {N} backward arm circles", "rotate both arms backwards {n}"]},
    },
    "hug": {
        "": {"both": ["open your arms", "open your arms wide", "welcome me with open arms", "spread your arms for a hug", "hold your arms open", "open both arms to welcome everybody"]},
        "in": {"both": ["give a hug", "hug me", "hug someone", "embrace me", "give me a big hug", "embrace a friend", "wrap your arms around someone", "hug yourself"]},
    },
}  # fmt: skip
