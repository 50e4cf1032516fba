"""`mmmd run` and `mmmd config`: the daemon, and the sources of its settings."""

from __future__ import annotations

import inspect
import logging
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Annotated, Any, Literal

import tyro

from daemon.settings.sources import SETTINGS, KnownSetting, config_of, resolve


def _with_settings(command: Callable[..., int]) -> Callable[..., int]:
    """The command with an option for each setting that has one; the values are passed as keyword arguments."""
    own = inspect.signature(command)
    options = [
        inspect.Parameter(
            key,
            inspect.Parameter.KEYWORD_ONLY,
            default=known.default if known.kind is bool else None,
            annotation=Annotated[
                _type_of_option(known), tyro.conf.arg(help=known.said.help.format(default=known.default) + ".")
            ],
        )
        for key, known in SETTINGS.items()
        if known.said.is_flag
    ]
    parameters = [p for p in own.parameters.values() if p.kind is not inspect.Parameter.VAR_KEYWORD]
    parameters = [p.replace(kind=inspect.Parameter.KEYWORD_ONLY) for p in parameters]
    ordered = [*options[:2], parameters[0], *options[2:], *parameters[1:]]
    command.__signature__ = own.replace(parameters=ordered)  # type: ignore[attr-defined]  # tyro reads the signature
    command.__annotations__ |= {p.name: p.annotation for p in options}
    return command


def _type_of_option(known: KnownSetting) -> Any:
    """The type of a setting's option: bool for a switch, else the setting's own type or None."""
    if known.kind is bool:
        return bool
    kind: Any = Literal[known.said.choices] if known.said.choices else known.kind
    return kind | None


@_with_settings
def run(config: Path | None = None, quiet: bool = False, **given: Any) -> int:
    """Receive texts over ZeroMQ and move servos, until SIGTERM or Ctrl-C, which park the robot.

    Every setting can also stand in a TOML file or in the environment (MMMD_ROBOT, ...); `mmmd config show` tells the
    values and where each came from.

    Exit status: 0 after a park, 3 when a fault or e-stop was latched, 1 when it could not start, 2 for bad use.

    Example: mmmd run --robot op3 --bus dxl:///dev/ttyUSB0 --log run.mcap

    Args:
        config: TOML file; else $MMMD_CONFIG, ~/.config/mmmd/mmmd.toml, /etc/mmmd/mmmd.toml.
        quiet: log only warnings.
        given: settings, see `daemon.settings.config.DaemonConfig`.
    """
    from dataclasses import replace

    from daemon.logs.log_lines import start_logging
    from daemon.supervisor.start_checks import log_file, log_path_error
    from daemon.supervisor.supervisor import run as run_daemon

    settings = resolve(_flags(given), config)
    as_json = bool(settings["log_json"].value)
    start_logging("front", level=logging.WARNING if quiet else logging.INFO, as_json=as_json, stamp=True)
    chosen = config_of(settings)
    if settings["robot"].source == "default" and not quiet:
        from daemon.cli.first_look import first_look

        told = ("no --robot: the reference robot", *first_look().lines()[:1], "`mmmd run --help` tells how to choose")
        sys.stderr.write("".join(f"mmmd: {line}\n" for line in told))
    if chosen.log is not None:
        path = log_file(chosen.log)
        chosen = replace(chosen, log=path)
        if problem := log_path_error(path):
            sys.stderr.write(f"mmmd: {problem}\n")
            return 2
    return run_daemon(chosen)


def config(
    verb: Annotated[Literal["show"], tyro.conf.Positional],
    config: Path | None = None,
    json: bool = False,
) -> int:
    """Show every setting of `mmmd run` and where its value comes from: default, file, environment.

    Example: mmmd config show

    Args:
        verb: show.
        config: TOML file; else where `mmmd run` looks.
        json: print one JSON object.
    """
    settings = resolve({}, config)
    config_of(settings)
    if json:
        import json as json_module

        rows = {key: {"value": s.value, "source": s.source} for key, s in settings.items()}
        sys.stdout.write(json_module.dumps(rows, default=str) + "\n")
        return 0
    width = max(map(len, settings))
    values = {key: "-" if s.value in (None, "") else str(s.value) for key, s in settings.items()}
    wide = max(map(len, values.values()))
    lines = [f"{key:<{width}}  {values[key]:<{wide}}  {s.source}" for key, s in settings.items()]
    sys.stdout.write("\n".join(lines) + "\n")
    return 0


def _flags(given: dict[str, Any]) -> dict[str, Any]:
    """Options that the command line sets; a switch with its default value counts as not set."""
    return {
        key: None if SETTINGS[key].kind is bool and value == SETTINGS[key].default else value
        for key, value in given.items()
    }
