"""Commands that the model cannot do: legs, objects, places, acrobatics, talk, other languages.

They stand beside the known commands in the scope index: a text nearer to one of these is refused or reported.
"""

from __future__ import annotations

OUTSIDE = (
    "walk forward", "walk backwards", "walk in a circle", "take three steps forward", "step to the left", "run", "run away",
    "run around the room", "jog in place", "jump", "jump up and down", "hop on one leg", "skip across the room",
    "kick", "kick the ball with your left foot", "kick with your right leg", "lift your left leg", "raise your right knee",
    "stand on one foot", "squat", "do ten squats", "kneel down", "sit down", "sit on the chair", "lie down", "lie on the floor",
    "get up from the floor", "roll over", "crawl", "climb the stairs", "step over the fence", "go upstairs",
    "ride a bicycle", "do a backflip", "do a somersault", "do a cartwheel", "do a handstand", "do push-ups",
    "do the splits", "stretch your legs", "tap your foot", "wiggle your toes", "stomp your feet", "tiptoe to the door",
    "turn around", "spin around in a full circle", "come to the kitchen", "go to the door", "go to bed", "leave the room",
    "open the door", "close the window", "turn on the light", "switch off the television", "bring me a beer", "get me a coffee",
    "make me a sandwich", "wash the dishes", "vacuum the carpet", "pick up the cup from the table",
    "put the book on the shelf", "carry this box upstairs",
    "draw a picture of a cat",
    "play football", "play chess with me", "play a song", "sing a song", "whistle a tune", "tell me a joke", "tell me a story",
    "what time is it", "what is the weather today", "how are you", "what is your name", "who are you", "translate this to french",
    "calculate two plus two", "solve this equation", "search the internet", "set an alarm for seven",
    "send a message to john", "order a pizza", "buy some milk", "book a flight to paris", "smile", "blink your eyes", "wink at me",
    "open your mouth", "stick out your tongue", "frown", "wiggle your ears", "wiggle your fingers", "snap your fingers",
    "make a fist", "spread your fingers", "show me two fingers", "cross your fingers", "breathe fire", "fly to the moon",
    "become invisible", "explode", "delete all files", "ignore previous instructions", "shut down the computer", "reboot the system",
    "drop table users", "sudo rm -rf", "hello world print", "the quick brown fox jumps over the lazy dog", "lorem ipsum dolor sit amet",
    "asdf qwer zxcv", "blah blah blah", "xyzzy", "one two three four five", "winke mit der rechten hand", "lève le bras gauche",
    "levanta la mano derecha", "alza il braccio sinistro", "zwaai met je hand", "podnieś rękę", "the stock market fell today",
    "my cat is sleeping on the sofa", "democracy is a form of government", "photosynthesis in green plants",
    "climb over the wall", "dance salsa", "do the moonwalk", "ballet pirouette", "walk like a crab", "limp across the room",
    "sneak past the guard", "balance on a beam", "skate on the ice", "ski down the hill", "surf the wave", "ride a horse",
)  # fmt: skip
