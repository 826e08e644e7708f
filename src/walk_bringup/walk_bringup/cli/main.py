# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The command group: each command is imported when it is called, so that help stays quick."""

from __future__ import annotations

import importlib
import os
import sys

import click

from walk_bringup.bootstrap.commands import COMMANDS, overview
from walk_bringup.bootstrap.errors import SetupError
from walk_bringup.bootstrap.main import unknown_command

_MODULES = {
    "up": "up",
    "plan": "plan",
    "save": "project",
    "open": "project",
    "run": "run",
    "record": "bags",
    "recover": "bags",
    "replay": "bags",
    "export": "export",
    "python": "script",
    "params": "params",
    "bench": "bench",
    "test": "develop",
    "check": "develop",
    "docs": "docs",
    "setup": "machine",
    "doctor": "machine",
}


class LazyGroup(click.Group):
    """A group whose commands are the functions of the same names in the modules of this package."""

    def list_commands(self, ctx: click.Context) -> list[str]:  # noqa: ARG002  (click calls it so)
        """Returns the names of the commands."""
        return list(COMMANDS)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:  # noqa: ARG002  (click calls it so)
        """Returns a command after importing its module."""
        if cmd_name not in _MODULES:
            return None
        module = importlib.import_module(f"walk_bringup.cli.{_MODULES[cmd_name]}")
        command = getattr(module, cmd_name)
        assert isinstance(command, click.Command)
        return command

    def format_help(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:  # noqa: ARG002  (click calls it so)
        """Writes the same text that `./walk --help` shows before the set-up."""
        formatter.write(overview())

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        """Finds the command, and says which one may be meant where there is none."""
        if args[0] not in COMMANDS:
            raise SetupError(unknown_command(args[0]))
        return super().resolve_command(ctx, args)


group = LazyGroup(name="walk", no_args_is_help=True)


def main(arguments: list[str] | None = None) -> int:
    """Runs a command; what a user can mend becomes one sentence and exit code 2."""
    arguments = sys.argv[1:] if arguments is None else arguments
    try:
        result = group.main(arguments, prog_name="./walk", standalone_mode=False)
    except click.exceptions.NoArgsIsHelpError as error:
        print(error.ctx.get_help() if error.ctx else overview())
        return 2
    except click.ClickException as error:
        return _refuse(_sentence(error))
    except (click.Abort, KeyboardInterrupt):
        return 130
    except BrokenPipeError:
        # The reader has gone (| head); what is still buffered would raise once more at exit.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 0
    except SetupError as error:
        return _refuse(str(error))
    except Exception as error:
        if _is_walk_error(error):
            return _refuse(str(error))
        raise
    return result if isinstance(result, int) else 0


def _is_walk_error(error: Exception) -> bool:
    # Only what is imported can raise it, and importing it for the question would take a second.
    errors = sys.modules.get("walk_building.errors")
    return errors is not None and isinstance(error, errors.WalkError)


def _sentence(error: click.ClickException) -> str:
    text = error.format_message().rstrip(".")
    command = error.ctx.command_path if isinstance(error, click.UsageError) and error.ctx else "./walk"
    return f"{text}; {command} --help shows what it takes." if isinstance(error, click.UsageError) else text


def _refuse(sentence: str) -> int:
    print(f"walk: {sentence}", file=sys.stderr)
    return 2
