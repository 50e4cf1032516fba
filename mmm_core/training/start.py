"""Reads the checkpoint that a recipe starts from, and refuses one with other sizes, another text encoder or other features."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from mmm_core.errors import CheckpointError
from mmm_core.inference.checkpoint import MODEL_FILE, Model, file_hash, load_model
from mmm_core.model.tokenizer import TokenizerConfig
from mmm_core.training.recipe import Recipe


def start_path(recipe: Recipe) -> Path:
    """The file of the recipe's start."""
    return MODEL_FILE if recipe.start == "shipped" else Path(recipe.start)


def read_start(recipe: Recipe, run_folder: Path, rest_pose: str) -> Model | None:
    """The checkpoint of the recipe's start; None if the recipe has none.

    Args:
        recipe: names the start.
        run_folder: keeps the hash of the file that the run began with.
        rest_pose: definition of the data's features, "mmmd" or "humanml3d".

    Raises:
        CheckpointError: the file cannot be read, is not the one that the run began with, or has other sizes, another text
            encoder or other features than the recipe.
    """
    if not recipe.start:
        return None
    path = start_path(recipe)
    model = load_model(path)
    _check_same_start(path, run_folder)
    found, books = model.transformer.config, model.tokenizer.n_codebooks
    if model.rest_pose != rest_pose:
        raise CheckpointError(path, "rest_pose", model.rest_pose, f"{rest_pose}, as the data have")
    if (model.text is None) != (recipe.text.encoder == "minilm"):
        has = "minilm" if model.text is None else "clip"
        raise CheckpointError(path, "text", f"a model that reads {has}", f"{recipe.text.encoder}, as the recipe says")
    sizes = recipe.tokenizer.config(len(model.tokenizer.mean))
    held = model.tokenizer.config
    if isinstance(sizes, TokenizerConfig) and isinstance(held, TokenizerConfig) and sizes.n_codes > held.n_codes:
        sizes = replace(sizes, n_codes=held.n_codes)  # its codebooks are refined (`Stages.start`)
    if sizes != model.tokenizer.config:
        raise CheckpointError(path, "tokenizer", f"{model.tokenizer.config}", f"{sizes}, as the recipe says")
    wanted = recipe.transformer.config(sizes, books, found.text_dim, recipe.text.tuned_layers)
    if 0 in (
        found.n_words,
        wanted.n_words,
    ):  # word layers are copied from the text encoder, or those of the start are dropped
        wanted = replace(wanted, n_words=found.n_words)
    if replace(wanted, dropout=found.dropout) != found:
        raise CheckpointError(path, "transformer", f"{found}", f"{wanted}, as the recipe says")
    return model


def _check_same_start(path: Path, run_folder: Path) -> None:
    """Raises CheckpointError if a resumed run has another start file: ids of another tokenizer would mean other motions."""
    marker, found = run_folder / "start.sha256", file_hash(path)
    if not marker.is_file():
        run_folder.mkdir(parents=True, exist_ok=True)
        marker.write_text(found)
    began = marker.read_text().strip()
    if began != found:
        raise CheckpointError(
            path, "", f"sha256 {found[:12]}", f"{began[:12]}, which the run began with, or a new --run"
        )
