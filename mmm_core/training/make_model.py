"""Runs every stage of a recipe and writes what it trains: a checkpoint, or the changes of one."""

from __future__ import annotations

from pathlib import Path

from mmm_core import distributed
from mmm_core.inference.checkpoint import save_model
from mmm_core.inference.people_weights import save_people
from mmm_core.model.tokenizer import Tokenizer
from mmm_core.training.batches import captions_of_people
from mmm_core.training.caption_training import train_captions
from mmm_core.training.recipe import Recipe
from mmm_core.training.run import Run
from mmm_core.training.stages import Stages
from mmm_core.training.start import start_path
from mmm_core.training.tokenizer_training import smooth_for_people


def make_model(recipe: Recipe, run: Run, data: Path | None, out: Path) -> None:
    """Run every unfinished stage and write the checkpoint to `out`, or the changes of a recipe with a rank."""
    stages = Stages(recipe, run, data)
    if recipe.transformer.rank:
        changed, tokenizer, how = stages.transformer, stages.tokenizer, recipe.tokenizer
        if how.rank and isinstance(tokenizer, Tokenizer) and how.decoder.steps:
            smooth_for_people(tokenizer, stages.clips, how.decoder, run, how.window_frames)
        if distributed.rank() == 0:
            captions = train_captions(captions_of_people(stages.clips), stages.text)
            start, guidance = start_path(recipe), recipe.transformer.guidance
            save_people(out, changed, tokenizer, captions, start, guidance, stages.provenance())
        return
    model = stages.model()
    if distributed.rank() == 0:
        save_model(out, model, half=model.text is None)
