"""Settings of `mmmd run` from a TOML file, the environment and flags, each with where its value came from.

Later ones win: default, file, environment (`MMMD_ROBOT`, ...), flag.
"""

from __future__ import annotations

import os
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from daemon.errors import ConfigError
from daemon.settings.config import DaemonConfig, Endpoints, stream_beside

_ENDPOINTS = Endpoints()
_CONFIG = DaemonConfig("reference", "sim://")
DEFAULTS: dict[str, Any] = {
    "robot": "reference", "bus": "sim://", "log": None, "log_size_mb": _CONFIG.log_size_mb,
    "log_total_mb": _CONFIG.log_total_mb, "generator": None, "model": None, "model_hash": "", "auto_arm": True,
    "estop": _CONFIG.estop, "idle": "off", "alive": True, "gestures": None, "motions": None,
    "cmd": _ENDPOINTS.cmd, "ctl": _ENDPOINTS.ctl, "pub": _ENDPOINTS.pub, "stream": "", "keys": None,
    "metrics": "", "http": "", "view": False, "queue_s": _CONFIG.queue_s, "state_rate_hz": _CONFIG.state_rate_hz,
    "generate_timeout_s": _CONFIG.generate_timeout_s, "park_timeout_s": _CONFIG.park_timeout_s, "lease_s": _CONFIG.lease_s,
    "lease_park_s": _CONFIG.lease_park_s, "lease_limp_s": _CONFIG.lease_limp_s,
    "stream_queue_s": _CONFIG.stream_queue_s, "log_json": False,
}  # fmt: skip
_PATHS = ("log", "model", "gestures", "motions", "keys")
_ENDPOINT_KEYS = ("cmd", "ctl", "pub", "keys", "stream")
_LOG_JSON = "log_json"
"""Read by `mmmd run` itself."""


@dataclass(frozen=True)
class Setting:
    """A value and where it came from."""

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
) -> dict[str, Setting]:
    """Every setting; flags that are None were not given.

    Raises:
        ConfigError: the file is missing or no TOML, a key is unknown, a value has another type than its default.
    """
    environment = os.environ if environment is None else environment
    file = file or default_file(environment)
    found = {key: Setting(value, "default") for key, value in DEFAULTS.items()}
    if file is not None:
        found |= {key: Setting(value, str(file)) for key, value in _read(file).items()}
    for key in DEFAULTS:
        variable = f"MMMD_{key.upper()}"
        if variable in environment and variable not in ("MMMD_KEYS", "MMMD_GESTURES"):  # folders, read where needed
            found[key] = Setting(_converted(key, environment[variable], variable), variable)
    found |= {
        key: Setting(_path(key, value), f"--{key.replace('_', '-')}")
        for key, value in flags.items()
        if value is not None
    }
    if not found["stream"].value:
        taken = {str(found["ctl"].value), str(found["pub"].value)}
        found["stream"] = Setting(stream_beside(str(found["cmd"].value), taken), "beside cmd")
    return found


def config_of(settings: Mapping[str, Setting]) -> DaemonConfig:
    """The daemon's configuration.

    Raises:
        ConfigError: a value is outside its range.
    """
    values = {key: setting.value for key, setting in settings.items() if key != _LOG_JSON}
    ends = Endpoints(**{key: values.pop(key) for key in _ENDPOINT_KEYS})
    return DaemonConfig(endpoints=ends, **values)


def settings_of(config: DaemonConfig) -> dict[str, Any]:
    """Every setting that `mmmd config show` tells, as the daemon runs with it; `log_json` is not the daemon's."""
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
    """A value of the setting's own type."""
    default = DEFAULTS[key]
    wanted: type = str if default is None else type(default)  # pyright: ignore[reportUnknownVariableType]
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
    return Path(value).expanduser() if key in _PATHS and isinstance(value, str) else value
