# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""`./walk params`: every parameter of the nodes."""

from __future__ import annotations

import click

from walk_bringup.bootstrap.commands import COMMANDS


@click.command(short_help=COMMANDS["params"])
@click.option("--markdown", is_flag=True, help="As the page of the documentation instead.")
def params(markdown: bool) -> int:
    """Print all parameters of the nodes with defaults, units and ranges as YAML.

    The output is what src/walk_bringup/config/walk.yaml holds; a copy of it is a file for --params-file.

    \b
    Examples:
      ./walk params
      ./walk params > my.yaml
      ./walk up --params-file my.yaml
      ./walk params --markdown > docs/parameters.md
    """
    # Imported here: the configs bring all of the cores with them.
    from walk_bringup.parameters import parameters_markdown, parameters_yaml

    print(parameters_markdown() if markdown else parameters_yaml(), end="")
    return 0
