# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Parameters made from config dataclasses, on a real node."""

import dataclasses

import pytest
import rclpy
from graph.domains import own_domain
from rcl_interfaces.msg import ParameterType
from rclpy.exceptions import InvalidParameterValueException
from rclpy.parameter import Parameter

from walk_building.config import Config, param
from walk_building.errors import ParameterError
from walk_building.walker import Walker
from walk_ros.parameters import ConfigParameters, describe, unknown_overrides


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Settings(Config):
    weight: float = param(0.5, "pull", unit="m", low=0.0, high=2.0)
    open_end: float = param(1.0, "no upper bound", low=0.0)
    count: int = param(3, "how many", low=0, high=9)
    method: str = param("a", "which way", choices=("a", "b"))
    loud: bool = param(False, "say more")


@pytest.fixture
def context(monkeypatch):
    monkeypatch.setenv("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")
    context = rclpy.Context()
    with own_domain() as domain:
        monkeypatch.setenv("ROS_DOMAIN_ID", str(domain))
        yield context
        context.try_shutdown()


@pytest.fixture
def make(context):
    nodes = []

    def build(*overrides, groups=None):
        args = ["--ros-args", *(part for o in overrides for part in ("-p", o))]
        if not context.ok():
            rclpy.init(args=args, context=context)
        node = rclpy.create_node("settings", context=context)
        nodes.append(node)
        changes = []
        parameters = ConfigParameters(node, groups or {"one": Settings, "walker": Walker}, changes.append)
        return node, parameters, changes

    yield build
    for node in nodes:
        node.destroy_node()


def test_every_field_is_a_parameter_with_its_default(make):
    node, parameters, _ = make()
    for field in dataclasses.fields(Settings):
        assert node.get_parameter(f"one.{field.name}").value == field.default
    assert "walker.eye_height_m" in parameters.names()
    assert parameters.get("one", Settings) == Settings()


def test_descriptors_tell_unit_range_and_choices(make):
    node, _, _ = make()
    weight = node.describe_parameter("one.weight")
    assert "pull [m]" in weight.description
    assert (weight.floating_point_range[0].from_value, weight.floating_point_range[0].to_value) == (0.0, 2.0)
    assert weight.type == ParameterType.PARAMETER_DOUBLE
    count = node.describe_parameter("one.count")
    assert (count.integer_range[0].from_value, count.integer_range[0].to_value) == (0, 9)
    assert "one of: a, b" in node.describe_parameter("one.method").description


def test_the_command_line_sets_values_and_whole_numbers_do_for_floats(make):
    _, parameters, _ = make("one.weight:=2", "one.count:=4", "one.method:=b", "one.loud:=true")
    assert parameters.get("one", Settings) == Settings(weight=2.0, count=4, method="b", loud=True)
    assert isinstance(parameters.get("one", Settings).weight, float)


@pytest.mark.parametrize("bad", ["one.weight:=2.5", "one.count:=10", "one.method:=c"])
def test_a_value_out_of_range_on_the_command_line_is_an_error(make, bad):
    with pytest.raises((InvalidParameterValueException, ParameterError), match=bad.split(":=")[0].split(".")[1]):
        make(bad)


def test_a_change_is_applied_and_told_by_group(make):
    node, parameters, changes = make()
    (result,) = node.set_parameters([Parameter("one.weight", value=1.25)])
    assert result.successful
    assert parameters.get("one", Settings).weight == 1.25
    assert changes == [frozenset({"one"})]


def test_setting_the_same_value_tells_nobody(make):
    node, _, changes = make()
    node.set_parameters([Parameter("one.weight", value=0.5)])
    assert changes == []


@pytest.mark.parametrize(
    ("name", "value"),
    [("one.weight", 2.5), ("one.weight", float("nan")), ("one.weight", "much"), ("one.count", -1), ("one.method", "c")],
)
def test_a_bad_change_is_refused_with_a_reason_and_nothing_changes(make, name, value):
    node, parameters, changes = make()
    (result,) = node.set_parameters([Parameter(name, value=value)])
    assert not result.successful
    assert result.reason
    assert parameters.get("one", Settings) == Settings()
    assert changes == []


def test_fields_that_must_fit_each_other_are_set_together(make):
    node, parameters, _ = make()
    (alone,) = node.set_parameters([Parameter("walker.eye_height_m", value=2.0)])
    assert not alone.successful
    assert "at most height_m" in alone.reason
    both = [Parameter("walker.eye_height_m", value=2.0), Parameter("walker.height_m", value=2.2)]
    assert node.set_parameters_atomically(both).successful
    assert parameters.get("walker", Walker) == Walker(eye_height_m=2.0, height_m=2.2)


def test_open_ranges_take_any_value_on_their_open_side(make):
    node, parameters, _ = make()
    assert describe(dataclasses.fields(Settings)[1]).floating_point_range[0].to_value == float("inf")
    assert node.set_parameters([Parameter("one.open_end", value=1e12)])[0].successful
    assert parameters.get("one", Settings).open_end == 1e12
    assert not node.set_parameters([Parameter("one.open_end", value=-1.0)])[0].successful


def test_what_was_given_and_is_not_there_is_told_with_the_nearest():
    declared = ["building", "load.units_m", "timing.speed_mps", "trajopt.weight_length", "use_sim_time"]

    def told(*given, typed=()):
        arguments = ["node", "--ros-args", *(part for name in typed for part in ("-p", f"{name}:=1"))]
        return dict(unknown_overrides([*given, *(name.rpartition(":")[2] for name in typed)], declared, arguments))

    assert told("building", "timing.speed_mps", "qos_overrides./clock.depth") == {}
    assert told("trajopt.weight_lenght") == {"trajopt.weight_lenght": "trajopt.weight_length"}
    assert told(typed=["speed_mps"]) == {"speed_mps": "timing.speed_mps"}
    assert told("timing.zzz") == {"timing.zzz": ""}
    # Said to all nodes in a file: it may be another's. Typed, it is meant for this one.
    assert told("sequencer.kicks") == {}
    assert told(typed=["trajopt:sequencer.kicks"]) == {"sequencer.kicks": ""}
