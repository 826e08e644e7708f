# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""`./walk up`: the node graph on one building."""

from __future__ import annotations

import os
import socket
import tempfile
from collections.abc import Iterable, Mapping
from pathlib import Path

import click

from walk_bag.keypoint_files import read_keypoints
from walk_bringup.bootstrap.commands import COMMANDS
from walk_bringup.bootstrap.errors import SetupError
from walk_bringup.cli.executables import find_executable
from walk_bringup.cli.overrides import Configs, checked, overrides_yaml, read_params, read_params_file
from walk_bringup.cli.processes import Child, Supervisor
from walk_bringup.cli.spoken import spoken
from walk_bringup.cli.units import UnitOfLength
from walk_building.config import Config
from walk_building.loaders import check_file, load_model
from walk_building.model import LoadOptions
from walk_vr_bridge.config import BridgeConfig

NODES = {
    "importance": "walk_importance",
    "sequencer": "walk_sequencer",
    "trajopt": "walk_trajopt",
    "vr_bridge": "walk_vr_bridge",
}
"""The nodes and their packages, in the order of the data flow."""

STATE_THEIR_UNIT = (".ifc", ".ifczip")

TOPICS = "importance_map, suggested_keypoints, keypoints, pairwise_paths, tour, path, trajectory, /diagnostics"


@click.command(short_help=COMMANDS["up"])
@click.argument("building", type=click.Path(path_type=Path), required=False)
@click.option("--param", "params", multiple=True, metavar="NODE.NAME=VALUE", help="Set a parameter of a node.")
@click.option("--params-file", type=click.Path(path_type=Path), help="YAML of parameters; ./walk params prints one.")
@click.option("--units", type=UnitOfLength(), help="Unit of a file that does not say it: cm, ft, … or metres.")
@click.option("--up", "up_axis", type=click.Choice(["y", "z"]), help="The axis that points up in such a file.")
@click.option(
    "--keypoints-file",
    type=click.Path(path_type=Path),
    metavar="FILE",
    help="Begin with the keypoints of FILE, CSV, JSON or a bag, not with suggested ones.",
)
@click.option("--lan", is_flag=True, help="Let headsets and other machines in: TLS, a token and a QR code.")
@click.option("--port", type=click.IntRange(0, 65535), help="Port of the headset page; 0 takes a free one.")
@click.option("--viewer-port", type=click.IntRange(0, 65535), help="Port that Foxglove may connect to (default: none).")
@click.option("--namespace", default="walk", show_default=True, help="Namespace of the nodes and topics.")
@click.option("--log-level", type=click.Choice(["debug", "info", "warn", "error"]), default="info", show_default=True)
def up(
    building: Path | None,
    params: tuple[str, ...],
    params_file: Path | None,
    units: float | None,
    up_axis: str | None,
    keypoints_file: Path | None,
    lan: bool,
    port: int | None,
    viewer_port: int | None,
    namespace: str,
    log_level: str,
) -> int:
    """Start the node graph on BUILDING (default: the sample building); Ctrl-C stops all.

    It prints the address of the page on which the walk is seen and edited, in a browser or a headset.

    ROS_DOMAIN_ID is kept where it is set; nodes are found on this machine only, unless
    ROS_AUTOMATIC_DISCOVERY_RANGE says otherwise.

    \b
    Examples:
      ./walk up
      ./walk up building.ifc
      ./walk up house.obj --units cm --up y
      ./walk up building.ifc --keypoints-file keypoints.csv
      ./walk up building.ifc --lan
      ./walk up building.ifc --param trajopt.timing.speed_mps=1.0 --param importance.keypoints.count=12
    """
    params = (*load_params(units, up_axis), *keypoint_params(keypoints_file), *bridge_params(lan, port), *params)
    shared = ros_arguments(building, params_file, namespace, log_level)
    configs = start_configs(params, params_file, namespace)
    if building is not None:
        refuse_unusable(building, configs.values())
    bridge = configs["vr_bridge"]["bridge"]
    assert isinstance(bridge, BridgeConfig)
    refuse_taken_port(bridge.port)
    with tempfile.TemporaryDirectory(prefix="walk_") as folder:
        own = Path(folder) / "params.yaml"
        own.write_text(overrides_yaml(params, list(NODES)), encoding="utf-8")
        # The last file wins; a plain `-p` would lose against the same parameter in --params-file.
        last = ["--params-file", str(own)] if params else []
        children = [
            Child(name=name, command=(str(find_executable(package, name)), "--ros-args", *shared, *last), unblocks=True)
            for name, package in NODES.items()
        ]
        if viewer_port is not None:
            viewer = str(find_executable("walk_bag", "viewer"))
            options = ("-r", f"__ns:=/{namespace.strip('/')}", "-p", f"viewer_port:={viewer_port}")
            children.append(Child(name="viewer", command=(viewer, "--ros-args", *options), unblocks=True))
        supervisor = Supervisor(children)
        supervisor.start()
        domain = os.environ.get("ROS_DOMAIN_ID", "0")
        supervisor.say(f"walk: {', '.join(NODES)} started on {building or 'the sample building'}, ROS domain {domain}.")
        supervisor.say(f"walk: topics under /{namespace.strip('/')}: {TOPICS}.")
        supervisor.say("walk: Ctrl-C stops all.")
        supervisor.wait()
    if supervisor.failed:
        supervisor.say(f"walk: ended; {', '.join(supervisor.failed)} had ended before.")
        return 1
    supervisor.say("walk: all nodes have ended.")
    return 0


def bridge_params(lan: bool, port: int | None) -> tuple[str, ...]:
    """Returns what the options about the page mean as parameters."""
    ports = () if port is None else (f"vr_bridge.bridge.port={port}",)
    return (*(("vr_bridge.bridge.lan=true",) if lan else ()), *ports)


def load_params(units_m: float | None, up_axis: str | None) -> tuple[str, ...]:
    """Returns what the options about the building's file mean as parameters: all nodes read the same file.

    Raises:
        ParameterError: The unit is none that a file could have.
    """
    given = {"units_m": units_m, "up": up_axis}
    chosen = {name: value for name, value in given.items() if value is not None}
    with spoken({"units_m": "--units"}):  # the option that was typed, not the node's parameter
        LoadOptions(**chosen)  # type: ignore[arg-type]
    return tuple(f"{node}.load.{name}={value}" for name, value in chosen.items() for node in NODES)


def start_configs(params: tuple[str, ...], params_file: Path | None, namespace: str) -> Configs:
    """Returns the configs that the nodes will start with.

    A node would refuse a bad value by itself, but only once it runs, and the others would go on without it.

    Raises:
        SetupError: A parameter is misspelt, or its value is not what it may be.
    """
    nodes = list(NODES)
    from_file = read_params_file(params_file, nodes, namespace) if params_file is not None else []
    return checked([*from_file, *read_params(params, nodes)], nodes)


def refuse_unusable(building: Path, configs: Iterable[Mapping[str, Config]]) -> None:
    """Raises BuildingError where the nodes could not load the file, each of them for itself.

    IFC files are only looked at: they say their unit, and reading one takes seconds that the nodes need once more.
    """
    check_file(building)
    if building.suffix.lower() in STATE_THEIR_UNIT:
        return
    for options in {group["load"] for group in configs}:
        assert isinstance(options, LoadOptions)
        load_model(building, options)


def keypoint_params(file: Path | None) -> tuple[str, ...]:
    """Returns what the user's keypoints mean as parameters; raises WalkError where the file says something else.

    They begin a session: those that an earlier one has edited are put aside.
    """
    if file is None:
        return ()
    read_keypoints(file)
    return (f"importance.keypoints_file={file.resolve()}", "sequencer.editing.restore=false")


def refuse_taken_port(port: int) -> None:
    """Raises SetupError where the page's port is taken: two graphs that share a domain would disturb each other."""
    if port == 0:
        return  # any free one
    with socket.socket() as probe:
        probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            probe.bind(("127.0.0.1", port))
        except OSError as error:
            raise SetupError(
                f"port {port} is taken, most likely by another ./walk up: end that one, or start this one beside it "
                f"with a port and a ROS domain of its own: ROS_DOMAIN_ID=7 ./walk up --port {port % 65535 + 1}"
            ) from error


def ros_arguments(building: Path | None, params_file: Path | None, namespace: str, log_level: str) -> list[str]:
    """Returns the ROS arguments that all nodes get.

    Raises:
        SetupError: A file is not there.
    """
    arguments = ["-r", f"__ns:=/{namespace.strip('/')}", "--log-level", log_level]
    for path, what in ((building, "building"), (params_file, "parameter file")):
        if path is not None and not path.is_file():
            raise SetupError(f"{path}: there is no such {what}")
    if params_file is not None:
        arguments += ["--params-file", str(params_file.resolve())]
    if building is not None:
        arguments += ["-p", f"building:={building.resolve()}"]
    return arguments
