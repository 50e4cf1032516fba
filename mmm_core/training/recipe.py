"""The recipe of a training in one TOML file: data, text encoder, the sizes and the schedule of each stage."""

from __future__ import annotations

import tomllib
from dataclasses import asdict, dataclass, field, fields, is_dataclass, replace
from pathlib import Path
from typing import Any, Literal, get_type_hints

import msgspec

from mmm_core.errors import TrainingDataError
from mmm_core.model.tokenizer import TokenizerConfig
from mmm_core.model.transformer import TransformerConfig
from mmm_core.model.vqvae import VqVaeConfig
from mmm_core.training.fresh import FreshRecipe
from mmm_core.training.motion_loss import MotionLoss
from mmm_core.training.run import Schedule
from mmm_core.training.transformer_training import TOKENS_PER_BATCH, Corruption

RECIPES = Path(__file__).parent / "recipes"


@dataclass(frozen=True)
class DataRecipe:
    """The data of a training.

    Attributes:
        folder: a HumanML3D or KIT-ML folder, or one with clips.jsonl (docs/DATA.md); empty for none.
        synthesised: number of clips that the gesture corpus makes before the training.
        licence: licence of the folder's data, which is written into the checkpoint.
        cuts: cuts of each of the folder's motions: above 1 varied ones are added (`mmm_core.training.cuts`).
        fresh: gesture clips made while the transformer trains; the length predictor then trains on the newest of them.
    """

    folder: str = ""
    synthesised: int = 0
    licence: str = ""
    cuts: int = 1
    fresh: FreshRecipe = field(default_factory=FreshRecipe)

    @property
    def has_gestures(self) -> bool:
        """Whether any clip comes from the gesture corpus."""
        return bool(self.synthesised or self.fresh.clips)


@dataclass(frozen=True)
class TextRecipe:
    """The text encoder of the captions: the packed MiniLM, or CLIP from files.

    Attributes:
        encoder: name of the encoder.
        clip: file of CLIP's weights.
        vocabulary: file of CLIP's word pieces.
        tuned_layers: number of MiniLM's last layers that the model copies and trains; 0 leaves MiniLM unchanged.
        tuned_rate: learning rate of these layers, as a share of the transformer's.
    """

    encoder: Literal["minilm", "clip"] = "minilm"
    clip: str = ""
    vocabulary: str = ""
    tuned_layers: int = 0
    tuned_rate: float = 0.1


@dataclass(frozen=True)
class TokenizerRecipe:
    """The tokenizer: by body parts, or one of the paper's layouts.

    Attributes:
        layout: "parts" (ours), "whole" or "halves" (the paper's).
        n_codes: codes of each codebook.
        code_dim: width of a code.
        width: width of the decoder ("parts") or of all convolutions.
        batch: windows in a step.
        window_frames: frames in a window.
        real_share: share of windows from people.
        reset_rule: rule for dead codes; "official" never resets a code that was used once.
        plain_steps: number of the schedule's first steps that do not quantise (layout "parts").
        schedule: steps and learning rate.
        decoder: further training of the decoder alone, or of its changes; 0 steps for none (layout "parts").
        gate: whether training stops if the tokenizer loses too much of the corpus's motions (layout "parts"; `mmmd eval
            tokenizer`).
        tune_start: whether the decoder of a start model is also trained further; this does not change its ids.
        rank: rank of changes of the start's tokenizer that are trained on people's clips by `schedule`, with its codebooks as
            they are; the transformer learns the changed tokenizer's ids. 0: none.
    """

    layout: Literal["parts", "whole", "halves"] = "parts"
    n_codes: int = 512
    code_dim: int = 16
    width: int = 256
    batch: int = 128
    window_frames: int = 40
    real_share: float = 0.12
    reset_rule: Literal["for_good", "official"] = "for_good"
    plain_steps: int = 0
    schedule: Schedule = field(default_factory=lambda: Schedule(steps=2600, learning_rate=1e-3))
    decoder: Schedule = field(default_factory=lambda: Schedule(steps=2500, learning_rate=1e-3))
    gate: bool = False
    tune_start: bool = False
    rank: int = 0

    def config(self, n_features: int) -> TokenizerConfig | VqVaeConfig:
        """Sizes for `n_features` features."""
        if self.layout == "parts":
            return TokenizerConfig(self.n_codes, self.code_dim, self.width)
        return VqVaeConfig(
            self.layout, self.n_codes, self.code_dim, self.width, n_features=n_features, reset_rule=self.reset_rule
        )


@dataclass(frozen=True)
class TransformerRecipe:
    """The masked transformer; sizes that follow from the tokenizer and the text encoder are not settings.

    Attributes:
        width, n_heads, n_cross, n_self, dropout: as in `TransformerConfig`.
        rank: rank of the changes of the start's matrices that are trained in place of all weights, and written instead of a
            checkpoint (`mmm_core.inference.people_weights`); 0 trains all weights.
        guidance: guidance with which changed weights are sampled.
        tokens_per_batch: tokens of a batch.
        corruption: shares of a motion that are masked.
        motion_loss: how much the motion that predicted ids decode to counts beside the ids (layout "parts").
        schedule: steps and learning rate.
    """

    width: int = 256
    n_heads: int = 8
    n_cross: int = 2
    n_self: int = 6
    dropout: float = 0.1
    rank: int = 0
    guidance: float = 1.0
    tokens_per_batch: int = TOKENS_PER_BATCH
    corruption: Corruption = field(default_factory=Corruption)
    motion_loss: MotionLoss = field(default_factory=MotionLoss)
    schedule: Schedule = field(default_factory=lambda: Schedule(steps=6200, learning_rate=1e-3))

    def config(
        self, tokenizer: TokenizerConfig | VqVaeConfig, n_codebooks: int, text_dim: int, n_words: int = 0
    ) -> TransformerConfig:
        """Sizes; layout "halves" predicts the upper body given the lower."""
        halves = isinstance(tokenizer, VqVaeConfig) and tokenizer.layout == "halves"
        return TransformerConfig(
            tokenizer.n_codes, n_codebooks, tokenizer.code_dim, self.width, self.n_heads, self.n_cross, self.n_self,
            text_dim, self.dropout, 1 if halves else None, n_words,
        )  # fmt: skip


@dataclass(frozen=True)
class ScopeRecipe:
    """The texts that the scope classifier is trained on (docs/scope.md).

    Attributes:
        sentences: number of sentences of the corpus, which are in scope.
        outside: number of texts out of scope.
        own_captions: whether captions of the data folder are in scope, too. This is off for recordings of everyday motion,
            whose captions name many actions that an upper body cannot do.
    """

    sentences: int = 12_000
    outside: int = 10_000
    own_captions: bool = False


@dataclass(frozen=True)
class Recipe:
    """All settings of a training; see the files in `recipes`.

    Attributes:
        seed: seed of the corpus, and of every stage whose schedule has no seed of its own.
        start: a finished checkpoint to train further ("shipped": the one in this package); its tokenizer stays, transformer and
            length predictor begin with its weights. Empty for new weights.
        data: data and gesture clips.
        text: text encoder.
        tokenizer: sizes and training of the tokenizer.
        transformer: sizes and training of the transformer.
        length: schedule of the length predictor.
        evaluator: schedule of the evaluation's feature extractors.
        scope: texts of the scope classifier; only models with gestures of the corpus have one.
    """

    seed: int = 0
    start: str = ""
    data: DataRecipe = field(default_factory=lambda: DataRecipe(synthesised=14_000))
    text: TextRecipe = field(default_factory=TextRecipe)
    tokenizer: TokenizerRecipe = field(default_factory=TokenizerRecipe)
    transformer: TransformerRecipe = field(default_factory=TransformerRecipe)
    length: Schedule = field(default_factory=lambda: Schedule(steps=2500, learning_rate=1e-3, save_every=500))
    evaluator: Schedule = field(default_factory=lambda: Schedule(steps=1500, learning_rate=3e-4))
    scope: ScopeRecipe = field(default_factory=ScopeRecipe)

    def seeded(self) -> Recipe:
        """The recipe with its seed in every stage that has no seed of its own."""

        def with_seed(schedule: Schedule) -> Schedule:
            return replace(schedule, seed=schedule.seed or self.seed)

        tokenizer = replace(self.tokenizer, schedule=with_seed(self.tokenizer.schedule),
                            decoder=with_seed(self.tokenizer.decoder))  # fmt: skip
        transformer = replace(self.transformer, schedule=with_seed(self.transformer.schedule))
        return replace(self, tokenizer=tokenizer, transformer=transformer, length=with_seed(self.length),
                       evaluator=with_seed(self.evaluator))  # fmt: skip

    def to_dict(self) -> dict[str, Any]:
        """The recipe as plain tables, for a checkpoint."""
        return asdict(self)


def known_recipes() -> list[str]:
    """Names of the recipes in this package."""
    return sorted(p.stem for p in RECIPES.glob("*.toml"))


def read_recipe(name_or_path: str, seed: int | None = None) -> Recipe:
    """A recipe by its name, or from a TOML file; a given `seed` replaces the recipe's.

    Raises:
        TrainingDataError: the recipe does not exist, is not TOML, or has an unknown key or a value of another kind; the key is
            named.
    """
    path = RECIPES / f"{name_or_path}.toml"
    if not path.is_file():
        path = Path(name_or_path)
    try:
        table = tomllib.loads(path.read_text("utf-8"))
    except OSError:
        expected = f"a TOML file, or one of {', '.join(known_recipes())}"
        raise TrainingDataError(path, "", "no such recipe", expected) from None
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise TrainingDataError(path, "", f"not TOML ({error})", "a recipe, see docs/training.md") from None
    return _build(Recipe(), table if seed is None else {**table, "seed": seed}, path, "").seeded()


def _build(default: Any, table: dict[str, Any], path: Path, prefix: str) -> Any:
    """`default` with the values of `table`, checked field by field."""
    hints = get_type_hints(type(default))
    known = [f.name for f in fields(default)]
    values: dict[str, Any] = {}
    for key, value in table.items():
        if key not in known:
            raise TrainingDataError(path, prefix + key, "unknown", ", ".join(known))
        current = getattr(default, key)
        if is_dataclass(current):
            if not isinstance(value, dict):
                raise TrainingDataError(path, prefix + key, repr(value), f"a table [{prefix}{key}]")
            values[key] = _build(current, value, path, f"{prefix}{key}.")
        else:
            try:
                values[key] = msgspec.convert(value, hints[key])
            except msgspec.ValidationError as error:
                raise TrainingDataError(path, prefix + key, repr(value), str(error)) from None
    return replace(default, **values)
