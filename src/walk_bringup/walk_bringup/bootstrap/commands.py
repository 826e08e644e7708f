# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The commands of `./walk` and what each does, for the help that needs no installation."""

from __future__ import annotations

COMMANDS = {
    "up": "Start the node graph on a building (default: the sample); Ctrl-C stops all.",
    "plan": "Turn a building into a collision-free, timed, recorded walkthrough.",
    "save": "Save the running graph's building, parameters, keypoints and edits as a project.",
    "open": "Start the node graph on a saved project.",
    "run": "Start one executable of a package: what `ros2 run` does.",
    "record": "Record a walkthrough as a rosbag2 (MCAP) bag.",
    "recover": "Make a whole bag of one whose recording was cut off.",
    "replay": "Publish a recorded walkthrough again.",
    "export": "Write a recorded walk as glTF, USD, video, camera path or table.",
    "python": "Run a Python script that uses the project's packages, such as those in examples/.",
    "params": "Print all parameters of the nodes with defaults, units and ranges as YAML.",
    "bench": "Measure every stage, side by side with the plain way, as JSON.",
    "test": "Run the tests; arguments go to pytest.",
    "check": "Check format, lint, types and the rules of the house.",
    "docs": "Build the documentation as a site.",
    "setup": "Install and build what is missing and do nothing else.",
    "doctor": "Report what this machine has and lacks, and what to do about it.",
}


def overview() -> str:
    """Returns the text of `./walk --help`."""
    rows = "\n".join(f"  {name:<8} {line}" for name, line in COMMANDS.items())
    return (
        "Usage: ./walk COMMAND [OPTIONS] …\n\n"
        "  From a building model to a walkthrough; the first call sets up what it needs.\n\n"
        f"Commands:\n{rows}\n\n"
        "Examples:\n"
        "  ./walk up\n"
        "  ./walk plan building.ifc --out out/building\n"
        "  ./walk COMMAND --help\n"
    )
