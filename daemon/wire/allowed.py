"""Names the allowed values of a request's field after a refusal: "0.5 to 2", "one of now, after, at". No I/O."""

from __future__ import annotations

import re
from typing import Any, cast

import msgspec
from msgspec import inspect

_PLACE = re.compile(r" - at `\$(?P<path>[^`]*)`$")
_STEP = re.compile(r"\.(\w+)|\[(\d+|\.\.\.)\]")


def refused_value(
    error: msgspec.ValidationError, raw: dict[str, Any], kind: type[msgspec.Struct]
) -> tuple[str, Any, str] | None:
    """Place of the value that a decoder refused, the value, and the allowed ones, in words.

    Args:
        error: the decoder's error, which names the place.
        raw: the request.
        kind: the struct into which the request was decoded.

    Returns:
        None where the error concerns no single value: a missing field, or fields that contradict each other.
    """
    found = _PLACE.search(str(error))
    if found is None or not found["path"] or not str(error).startswith("Expected "):
        return None
    value: Any = raw
    types: list[inspect.Type] = [inspect.type_info(kind)]
    for match in _STEP.finditer(found["path"]):
        name, index = match[1], match[2]
        if name is not None and isinstance(value, dict):
            value, types = cast("dict[str, Any]", value).get(name), _field_types(types, name)
        elif index is not None and index.isdigit() and isinstance(value, list):
            value, types = cast("list[Any]", value)[int(index)], [inner for t in types for inner in _item_types(t)]
        else:
            return None
    if not types:
        return None
    some = [t for t in types if not isinstance(t, inspect.NoneType)]
    return found["path"].lstrip("."), value, " or ".join(dict.fromkeys(_words(t) for t in some or types))


def _field_types(types: list[inspect.Type], name: str) -> list[inspect.Type]:
    fields = [f for t in types if isinstance(t, inspect.StructType) for f in t.fields if f.encode_name == name]
    return [single for field in fields for single in _singles(field.type)]


def _item_types(kind: inspect.Type) -> list[inspect.Type]:
    if isinstance(kind, (inspect.ListType, inspect.VarTupleType)):
        return _singles(kind.item_type)
    return []


def _singles(kind: inspect.Type) -> list[inspect.Type]:
    """The alternatives of a type; of an alternative's constraints only the words for a pattern are kept."""
    if isinstance(kind, inspect.Metadata):
        patterned = isinstance(kind.type, inspect.StrType) and kind.type.pattern is not None
        return [kind] if patterned and _noted(kind) else _singles(kind.type)
    if isinstance(kind, inspect.UnionType):
        return [single for one in kind.types for single in _singles(one)]
    return [kind]


def _words(kind: inspect.Type) -> str:
    if isinstance(kind, inspect.Metadata):
        return str(_noted(kind).get("description", "text"))
    if isinstance(kind, (inspect.IntType, inspect.FloatType)):
        what = "a whole number" if isinstance(kind, inspect.IntType) else "a number"
        low, high = (f"{bound:.12g}" if bound is not None else None for bound in (kind.ge, kind.le))
        return f"{what}, {low} to {high}" if low is not None and high is not None else what
    if isinstance(kind, inspect.StrType):
        if kind.pattern is not None:
            return f"text of the form {kind.pattern}"
        length = f"{kind.min_length or 0} to {kind.max_length}" if kind.max_length is not None else ""
        return f"text of {length} characters" if length else "text"
    if isinstance(kind, inspect.LiteralType):
        return f"one of {', '.join(map(str, kind.values))}"
    if isinstance(kind, (inspect.ListType, inspect.VarTupleType)):
        many = "" if kind.max_length is None else f" of {kind.min_length or 0} to {kind.max_length} entries"
        return f"an array{many}"
    if isinstance(kind, inspect.BoolType):
        return "true or false"
    return "null" if isinstance(kind, inspect.NoneType) else "an object"


def _noted(kind: inspect.Metadata) -> dict[str, Any]:
    """The JSON schema annotations of a type."""
    return cast("dict[str, Any]", kind.extra_json_schema or {})  # pyright: ignore[reportUnknownMemberType]
