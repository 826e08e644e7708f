# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""`./walk save` and `./walk open`: projects."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING

import click

from walk_bag.running import Listener, Running
from walk_bringup.bootstrap.commands import COMMANDS
from walk_bringup.bootstrap.errors import SetupError
from walk_bringup.cli.up import NODES, up
from walk_bringup.projects.documents import read_reference
from walk_bringup.projects.files import Layout, only_one
from walk_bringup.projects.opening import open_project
from walk_bringup.projects.saving import GraphState, save_project
from walk_sequencer.whole import whole

if TYPE_CHECKING:
    from walk_sequencer.keypoints import Keypoints


@click.command(short_help=COMMANDS["save"])
@click.argument("folder", type=click.Path(path_type=Path))
@click.option("--tour", default="main", show_default=True, help="Name of the tour within the project.")
@click.option("--namespace", default="walk", show_default=True, help="Namespace of the nodes that run.")
@click.option("--force", is_flag=True, help="Save into a project of another building, too.")
def save(folder: Path, tour: str, namespace: str, force: bool) -> int:
    """Save what the running graph holds as a project in FOLDER: building, parameters, keypoints, edits.

    What a file of the project said before is kept in FOLDER/backup.

    \b
    Examples:
      ./walk save house
      ./walk save house --tour short
    """
    layout = Layout(folder=folder, tour=tour)
    state = running_graph(namespace)
    keypoints = save_project(layout, state, force=force)
    print(f"walk: saved {len(keypoints.ids)} keypoints as the tour {tour!r} of {folder}.")
    absent = [node for node in NODES if node not in state.parameters]
    if absent:
        print(f"walk: without the parameters of {', '.join(absent)}, for that does not run.")
    return 0


@click.command("open", short_help=COMMANDS["open"])
@click.argument("folder", type=click.Path(path_type=Path))
@click.option("--tour", default="main", show_default=True, help="Name of the tour within the project.")
@click.option("--building", type=click.Path(path_type=Path), help="The building's file, where it has moved.")
@click.option("--as-saved", is_flag=True, help="Leave out edits made since the tour was saved.")
@click.option("--lan", is_flag=True, help="Let headsets and other machines in: TLS, a token and a QR code.")
@click.option("--port", type=click.IntRange(0, 65535), help="Port of the headset page; 0 takes a free one.")
@click.option("--viewer-port", type=click.IntRange(0, 65535), help="Port that Foxglove may connect to (default: none).")
@click.option("--namespace", default="walk", show_default=True, help="Namespace of the nodes and topics.")
@click.option("--log-level", type=click.Choice(["debug", "info", "warn", "error"]), default="info", show_default=True)
@click.pass_context
def open(  # noqa: A001  (the command's name; nothing here opens a file)
    ctx: click.Context,
    folder: Path,
    tour: str,
    building: Path | None,
    as_saved: bool,
    lan: bool,
    port: int | None,
    viewer_port: int | None,
    namespace: str,
    log_level: str,
) -> int:
    """Start the node graph on the project in FOLDER; Ctrl-C stops all.

    Edits are kept in the project from then on, and are there again when it is opened; ./walk save makes them part of
    the tour.

    \b
    Examples:
      ./walk open house
      ./walk open house --tour short --building moved/house.ifc
    """
    layout = Layout(folder=folder, tour=tour)
    # First, so that what is no project gets no folder for edits.
    read_reference(layout)
    with only_one(layout):
        opened = open_project(layout, building, as_saved=as_saved)
        for note in opened.notes:
            print(f"walk: {note}", flush=True)
        own = (
            f"sequencer.state_dir={opened.state_dir}",
            f"trajopt.state_dir={opened.state_dir}",
            "sequencer.editing.restore=true",
        )
        code = ctx.invoke(
            up,
            building=opened.building,
            params=own,
            params_file=opened.parameters_file,
            units=None,
            up_axis=None,
            keypoints_file=None,
            lan=lan,
            port=port,
            viewer_port=viewer_port,
            namespace=namespace,
            log_level=log_level,
        )
    return int(code)


def running_graph(namespace: str) -> GraphState:
    """Returns what the running graph holds.

    Raises:
        SetupError: None runs, or it has no keypoints yet.
    """
    listener = Listener(namespace)
    try:
        running = listener.read(list(NODES))
    except TimeoutError as error:
        raise SetupError(f"nothing is saved, for {error}: is the graph ending?") from error
    finally:
        listener.close()
    if running is None:
        domain = os.environ.get("ROS_DOMAIN_ID", "0")
        raise SetupError(
            f"no graph with keypoints runs in the namespace {namespace!r} of the ROS domain {domain}; "
            "start one with ./walk up, and wait for its tour"
        )
    return GraphState(
        building=Path(running.building) if running.building else None,
        building_hash=running.building_hash,
        shown=_shown(running),
        rooms=dict(zip(running.keypoints.ids, running.keypoints.labels, strict=True)),
        left_out=dict(running.keypoints.left_out),
        parameters=running.parameters,
    )


def _shown(running: Running) -> Keypoints:
    poses, marks, ids = running.keypoints.poses, running.marks, running.keypoints.ids
    keypoints = [
        {
            "id": identity,
            "position": position.tolist(),
            "quat_xyzw": quat_xyzw.tolist(),
            "locked": identity in marks.locked,
            "dwell_s": marks.dwell_s.get(identity),
            "look_at": marks.look_at.get(identity),
        }
        for identity, position, quat_xyzw in zip(ids, poses.positions, poses.quat_xyzw, strict=True)
    ]
    start, end = (identity if identity in ids else -1 for identity in (marks.start, marks.end))
    return whole({"keypoints": keypoints, "order": ids, "start": start, "end": end, "next_id": 0})
