"""Settings of `mmmd run` from a TOML file, the environment and flags, each with where its value came from.

Later ones win: default, file, environment (`MMMD_ROBOT`, ...), flag.
"""

from __future__ import annotations

import os
import tomllib
from collections.abc import Mapping
from dataclasses import Field, dataclass, fields
from pathlib import Path
from typing import Any

from daemon.errors import ConfigError
from daemon.settings.config import DaemonConfig, Endpoints, Setting, settings_of_class, stream_beside

_ENDPOINT_KEYS = ("cmd", "ctl", "pub", "stream", "keys")
_LOG_JSON = "log_json"
"""Name of the setting that `mmmd run` itself reads."""


@dataclass(frozen=True)
class KnownSetting:
    """A setting of `mmmd run`: its default, its type, and its help."""

    default: Any
    kind: type
    said: Setting


def _known() -> dict[str, KnownSetting]:
    """All settings by name, the endpoints in their place among the others."""
    found: dict[str, KnownSetting] = {}
    for f in fields(DaemonConfig):
        if f.name == "endpoints":
            ends = settings_of_class(Endpoints)
            found |= {key: _known_of(*ends[key]) for key in _ENDPOINT_KEYS}
        else:
            found[f.name] = _known_of(f, f.metadata["setting"])
    return found | {_LOG_JSON: KnownSetting(False, bool, Setting("print one JSON object a line instead of text"))}


def _known_of(f: Field[Any], said: Setting) -> KnownSetting:
    kinds: dict[str, type] = {"str": str, "float": float, "bool": bool, "Path": Path}
    return KnownSetting(f.default, kinds[str(f.type).removesuffix(" | None")], said)


SETTINGS = _known()
DEFAULTS: dict[str, Any] = {key: known.default for key, known in SETTINGS.items()}


@dataclass(frozen=True)
class SourcedValue:
    """A value and its source."""

    value: Any
    source: str


def default_file(environment: Mapping[str, str]) -> Path | None:
    """$MMMD_CONFIG, else the user's mmmd/mmmd.toml, else /etc/mmmd/mmmd.toml; None when there is none."""
    if chosen := environment.get("MMMD_CONFIG"):
        return Path(chosen)
    home = environment.get("XDG_CONFIG_HOME") or str(Path.home() / ".config")
    places = (Path(home) / "mmmd" / "mmmd.toml", Path("/etc/mmmd/mmmd.toml"))
    return next((p for p in places if p.is_file()), None)


def resolve(
    flags: Mapping[str, Any], file: Path | None = None, environment: Mapping[str, str] | None = None
) -> dict[str, SourcedValue]:
    """Every setting with its source; a flag that is None was not given.

    Raises:
        ConfigError: the file is missing or no TOML, a key is unknown, or a value has another type than its default.
    """
    environment = os.environ if environment is None else environment
    file = file or default_file(environment)
    found = {key: SourcedValue(value, "default") for key, value in DEFAULTS.items()}
    if file is not None:
        found |= {key: SourcedValue(value, str(file)) for key, value in _read(file).items()}
    for key, known in SETTINGS.items():
        variable = f"MMMD_{key.upper()}"
        if variable in environment and known.said.in_environment:
            found[key] = SourcedValue(_converted(key, environment[variable], variable), variable)
    found |= {
        key: SourcedValue(_path(key, value), f"--{key.replace('_', '-')}")
        for key, value in flags.items()
        if value is not None
    }
    if not found["stream"].value:
        taken = {str(found["ctl"].value), str(found["pub"].value)}
        found["stream"] = SourcedValue(stream_beside(str(found["cmd"].value), taken), "beside cmd")
    return found


def config_of(settings: Mapping[str, SourcedValue]) -> DaemonConfig:
    """The daemon's configuration.

    Raises:
        ConfigError: a value is outside its range.
    """
    values = {key: setting.value for key, setting in settings.items() if key != _LOG_JSON}
    ends = Endpoints(**{key: values.pop(key) for key in _ENDPOINT_KEYS})
    return DaemonConfig(endpoints=ends, **values)


def settings_of(config: DaemonConfig) -> dict[str, Any]:
    """Every setting that `mmmd config show` lists, with the daemon's value; `log_json` is not the daemon's."""
    ends = {key: getattr(config.endpoints, key) for key in _ENDPOINT_KEYS}
    return {key: ends[key] if key in ends else getattr(config, key) for key in DEFAULTS if key != _LOG_JSON}


def _read(file: Path) -> dict[str, Any]:
    try:
        table = tomllib.loads(file.read_text("utf-8"))
    except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        raise ConfigError(f"{file}: cannot be read ({error}); give a TOML file with --config") from error
    unknown = sorted(table.keys() - DEFAULTS.keys())
    if unknown:
        raise ConfigError(f"{file}: unknown {', '.join(unknown)}; allowed: {', '.join(DEFAULTS)}; correct it")
    return {key: _converted(key, value, str(file)) for key, value in table.items()}


def _converted(key: str, value: Any, source: str) -> Any:
    """The value, converted to the setting's type."""
    wanted = str if SETTINGS[key].kind is Path else SETTINGS[key].kind
    if wanted is bool and isinstance(value, str):
        known = {"1": True, "true": True, "yes": True, "0": False, "false": False, "no": False}
        value = known.get(value.lower(), value)
    elif wanted is float and isinstance(value, (str, int)) and not isinstance(value, bool):
        try:
            value = float(value)
        except ValueError:
            pass
    if type(value) is not wanted:
        raise ConfigError(f"{source}: {key} = {value!r}; allowed: a {wanted.__name__}; correct it")
    return _path(key, value)


def _path(key: str, value: Any) -> Any:
    return Path(value).expanduser() if SETTINGS[key].kind is Path and isinstance(value, str) else value
