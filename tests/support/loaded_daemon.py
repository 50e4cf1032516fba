"""Everything that `mmmd run` loads before its robot, for the process from which daemons are forked."""

from __future__ import annotations

import gc
import importlib
import os

from mmm_core.language.context import in_context
from mmm_core.language.reading import read
from mmm_core.language.warming import warmed

os.environ["MUJOCO_GL"] = "disable"  # MuJoCo reads it when it is imported
for module in (
    "daemon.cli.services.run",
    "daemon.supervisor.supervisor",
    "typeguard",
):  # the last by tyro, when it parses
    importlib.import_module(module)
warmed()
in_context("again", read("nod"))
gc.collect()
gc.freeze()  # collecting in a forked process would copy the pages of all that is loaded
