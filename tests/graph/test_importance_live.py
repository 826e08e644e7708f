# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The importance node: its parameters change, and it starts again; the tests of this file follow each other."""

import numpy as np
import pytest
import trimesh
from graph.processes import Observer

from walk_ros import conversions as c
from walk_ros.conversions.stamps import stamp_from_msg
from walk_ros.diagnostics import diagnostic_values

pytestmark = pytest.mark.ros

MAP_TOPICS = ["importance_map", "importance_map/storeys"]
SUGGESTED = "suggested_keypoints"


@pytest.fixture(scope="module")
def running(graph, observer):
    graph.start("importance")
    observer.wait(lambda: at_rest(observer), "suggestions, and the last map before them")
    return graph


def at_rest(observer):
    """Whether the node is done and all that it has published is heard: a big map may come behind the diagnostics."""
    state, heard = observer.state("importance"), [observer.last(topic) for topic in MAP_TOPICS]
    if state.get("state") != "ready" or "map_revision_ns" not in state or None in heard:
        return False
    return {stamp_from_msg(msg.header.stamp) for msg in heard} == {int(state["map_revision_ns"])}


def counts(observer, *topics):
    return [len(observer.heard[topic]) for topic in topics]


def change(observer, name, value):
    """Sets a parameter and returns the suggestion that answers it."""
    before = len(observer.heard[SUGGESTED])
    result = observer.set_parameter("importance", name, value)
    assert result.successful, result.reason
    return c.keypoints_from_msg(observer.after(SUGGESTED, before, f"suggestions for {name} = {value}"))


def test_another_number_of_keypoints_leaves_the_maps_alone(running, observer):
    before = counts(observer, *MAP_TOPICS)
    assert len(change(observer, "keypoints.count", 5).positions) == 5
    assert len(change(observer, "keypoints.count", 0).positions) >= 3
    assert counts(observer, *MAP_TOPICS) == before


def test_another_cone_leaves_the_maps_alone(running, observer):
    change(observer, "keypoints.count", 8)
    before = counts(observer, *MAP_TOPICS)
    change(observer, "keypoints.cone_radius_m", 2.0)
    assert counts(observer, *MAP_TOPICS) == before
    change(observer, "keypoints.count", 0)


def test_other_weights_weigh_the_same_maps(running, observer):
    before = c.importance_map_from_msg(observer.last("importance_map"))
    maps = counts(observer, *MAP_TOPICS)
    change(observer, "importance.weight_visibility", 4.0)
    after = c.importance_map_from_msg(observer.last("importance_map"))
    # One map, not one at every refinement.
    assert counts(observer, *MAP_TOPICS) == [maps[0] + 1, maps[1] + 1]
    for name in ("obstacle", "distance", "visibility"):
        np.testing.assert_array_equal(getattr(after, name), getattr(before, name))
    np.testing.assert_allclose(after.importance, before.importance + 3.0 * before.visibility, atol=1e-4)
    change(observer, "importance.weight_visibility", 1.0)


def test_another_voxel_size_computes_the_maps_anew_and_the_old_size_comes_from_disk(running, observer):
    old = c.importance_map_from_msg(observer.last("importance_map"))
    change(observer, "importance.voxel_size_m", 0.4)
    assert c.importance_map_from_msg(observer.last("importance_map")).grid.voxel_size_m == pytest.approx(0.4)
    maps = counts(observer, "importance_map")[0]
    change(observer, "importance.voxel_size_m", 0.25)
    assert counts(observer, "importance_map")[0] == maps + 1
    again = c.importance_map_from_msg(observer.last("importance_map"))
    np.testing.assert_array_equal(again.visibility, old.visibility)


def test_every_map_comes_with_its_standard_error_which_falls(running, observer):
    before = counts(observer, "importance_map", "/diagnostics")
    change(observer, "importance.voxel_size_m", 0.15)
    stamps = [stamp_from_msg(msg.header.stamp) for msg in observer.heard["importance_map"][before[0] :]]

    def told():
        found = {}
        for msg in observer.heard["/diagnostics"][before[1] :]:
            for values in map(diagnostic_values, msg.status):
                if "visibility_stderr" in values:
                    found[int(values["map_revision_ns"])] = float(values["visibility_stderr"])
        return found

    observer.wait(lambda: set(stamps) <= set(told()), "the error of every map")
    errors = [told()[stamp] for stamp in stamps]
    assert len(errors) >= 3
    assert errors == sorted(errors, reverse=True)
    assert errors[0] > 1.5 * errors[-1] > 0
    change(observer, "importance.voxel_size_m", 0.25)


def test_a_cap_on_voxels_makes_the_grid_coarser_and_the_node_says_so(running, observer):
    change(observer, "importance.max_voxels", 2000)
    coarse = c.importance_map_from_msg(observer.last("importance_map")).grid
    assert np.prod(coarse.shape) <= 2000
    assert coarse.voxel_size_m > 0.25
    assert f"{coarse.voxel_size_m:.3f} m" in running.log("importance")
    change(observer, "importance.max_voxels", 1_500_000)


@pytest.mark.parametrize(
    ("name", "value", "said"),
    [
        ("importance.weight_distance", -1.0, "weight_distance"),
        ("importance.weight_visibility", float("nan"), "weight_visibility"),
        ("keypoints.cone_radius_m", 0.0, "cone_radius_m"),
        ("importance.voxel_size_m", 1.2, "voxel_size_m"),
    ],
)
def test_a_bad_value_is_refused_by_name_and_changes_nothing(running, observer, name, value, said):
    before = counts(observer, *MAP_TOPICS, SUGGESTED)
    result = observer.set_parameter("importance", name, value)
    assert not result.successful
    assert said in result.reason
    assert counts(observer, *MAP_TOPICS, SUGGESTED) == before
    assert running.processes["importance"].poll() is None


def test_after_bad_values_a_good_one_is_taken(running, observer):
    assert not observer.set_parameter("importance", "keypoints.cone_radius_m", 0.0).successful
    assert len(change(observer, "keypoints.cone_radius_m", 3.0).positions) >= 3
    assert len(change(observer, "keypoints.cone_radius_m", 4.0).positions) >= 3


def test_a_grid_without_a_free_voxel_is_said_and_the_next_building_works(running, observer, rooms, tmp_path):
    sheet = tmp_path / "sheet.ply"
    corners = np.array([[0.0, 0, 0], [6, 0, 0], [6, 6, 0], [0, 6, 0]])
    trimesh.Trimesh(corners, [[0, 1, 2], [0, 2, 3]]).export(sheet)
    assert len(change(observer, "building", str(sheet)).positions) == 0
    observer.wait(lambda: observer.state("importance").get("state") == "failed", "the error")
    assert "no voxel of 0.25 m is free" in observer.state("importance")["message"]
    assert running.processes["importance"].poll() is None
    assert len(change(observer, "building", str(rooms)).positions) >= 3


def test_more_keypoints_than_fit_are_an_error_that_says_how_many_do(running, observer):
    maps = counts(observer, *MAP_TOPICS)
    assert len(change(observer, "keypoints.count", 1000).positions) == 0
    observer.wait(lambda: observer.state("importance").get("state") == "failed", "the error")
    assert "ask for at most" in observer.state("importance")["message"]
    assert counts(observer, *MAP_TOPICS) == maps
    assert len(change(observer, "keypoints.count", 0).positions) >= 3


def test_a_later_start_publishes_before_the_building_is_loaded(running, observer, graph):
    observer.wait(lambda: list((graph.folder / "cache" / "walk").glob("start-*.json")), "the start to be kept")
    last = {topic: observer.last(topic) for topic in (*MAP_TOPICS, SUGGESTED)}
    graph.interrupt("importance")
    before = counts(observer, "importance_map", SUGGESTED)
    graph.start("importance")
    observer.after(SUGGESTED, before[1], "suggestions of the later start")
    observer.wait(lambda: "loaded" in graph.log("importance").rpartition("earlier start")[2], "the building")
    observer.wait(lambda: observer.state("importance").get("state") == "ready", "it to be ready")
    assert counts(observer, "importance_map", SUGGESTED) == [n + 1 for n in before]
    for topic, msg in last.items():
        new = observer.last(topic)
        assert new.header.stamp != msg.header.stamp
        field = "poses" if topic == SUGGESTED else "data"
        assert getattr(new, field) == getattr(msg, field)


@pytest.mark.parametrize("damage", ["flipped", "cut"])
def test_damaged_files_are_seen_and_written_anew(running, observer, graph, damage):
    graph.interrupt("importance")
    folder = graph.folder / "cache" / "walk"
    files = [*folder.glob("importance-*.bin"), *folder.glob("start-*.json")]
    whole = {file: file.read_bytes() for file in files}
    for file, raw in whole.items():
        middle = len(raw) // 2
        file.write_bytes(
            raw[:middle] if damage == "cut" else raw[:middle] + bytes([raw[middle] ^ 1]) + raw[middle + 1 :]
        )
    before = len(observer.heard[SUGGESTED])
    graph.start("importance")
    observer.after(SUGGESTED, before, "suggestions")
    assert "is damaged" in graph.log("importance")
    start = next(file for file in files if file.suffix == ".json")
    observer.wait(lambda: start.read_bytes() == whole[start], "the start to be written anew")
    assert any(file.read_bytes() == raw for file, raw in whole.items() if file.suffix == ".bin")


def test_without_a_folder_nothing_is_kept_and_one_that_cannot_be_written_is_said(running, graph, rooms, other_domain):
    blocked = graph.folder / "a file"
    blocked.write_text("no folder")
    observer = Observer(other_domain)
    process = graph.run(
        "elsewhere", "walk_importance.node", "--ros-args", "-p", f"building:={rooms}", "-p", f"cache_dir:={blocked}",
        domain=other_domain,
    )  # fmt: skip
    observer.wait(lambda: observer.last(SUGGESTED), "suggestions")
    observer.wait(lambda: "cache_dir" in graph.log("elsewhere"), "the warning")
    assert process.poll() is None
    observer.close()
