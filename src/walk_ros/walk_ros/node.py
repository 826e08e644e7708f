# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""What every node of the graph shares: its building, its parameters, its worker, its diagnostics."""

from __future__ import annotations

import gc
import importlib
import logging
import sys
import threading
import time
from collections.abc import Callable, Iterable, Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rcl_interfaces.msg import ParameterDescriptor
from rclpy.clock import Clock, ClockType
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.subscription import Subscription

from walk_building.config import Config
from walk_building.errors import BuildingError, WalkError
from walk_building.model import LoadOptions
from walk_building.walker import Walker
from walk_ros.diagnostics import Diagnostics, error_code
from walk_ros.errors import MessageError
from walk_ros.log import forward_logging, stop_forwarding
from walk_ros.parameters import ConfigParameters, unknown_overrides
from walk_ros.qos import latched
from walk_ros.side_node import SideNode
from walk_ros.topics import BETWEEN_NODES, NAMESPACE, TOPICS
from walk_ros.worker import Superseded, Worker

if TYPE_CHECKING:
    from walk_building.building import Building

STOP_S = 3.0
"""How long a worker may take to end: the longest stretch of a stage between two progress reports, with room."""

_ALL = TOPICS | BETWEEN_NODES


class WalkNode(Node):
    """A node that loads the building in its worker and works on it.

    Subclasses say in `work` what is to be done about the newest input and in `fail` what is published when it
    cannot be done. Both run in the worker's thread.

    Attributes:
        niceness: By how much its process steps back behind others: a planner of the next revision behind those who
            show the present one.
    """

    niceness = 0

    def __init__(self, name: str, configs: Mapping[str, type[Config]]) -> None:
        """Declares the parameters and starts the diagnostics; the worker starts with `start`.

        Args:
            name: Of the node.
            configs: Config classes by parameter group, beside `load` and `walker`.
        """
        super().__init__(name, namespace=NAMESPACE)
        forward_logging(self.get_logger())
        self.diagnostics = Diagnostics(self.get_fully_qualified_name().strip("/"))
        self.worker = Worker(f"{name} worker", self._step, self.report)
        self.building: Building | None = None
        self._loaded_for: tuple[Any, ...] = ()
        self._last_revision_ns = 0
        self._revision_lock = threading.Lock()
        self._aside: SideNode | None = None
        self._publishing: dict[str, Any] = {}
        self.declare_text("building", "", "path of the building file; empty for the sample building")
        groups = {"load": LoadOptions, "walker": Walker, **configs}
        self.parameters = ConfigParameters(self, groups, self._changed)
        self.add_post_set_parameters_callback(self._building_changed)
        self.offer("/diagnostics")
        # A steady clock: diagnostics go on where simulated time stands still.
        self._steady = Clock(clock_type=ClockType.STEADY_TIME)
        self.create_timer(1.0, self.publish_diagnostics, clock=self._steady)

    def declare_text(self, name: str, default: str, description: str) -> None:
        """Declares a parameter that is a text."""
        self.declare_parameter(name, default, ParameterDescriptor(description=description))

    def start(self) -> None:
        """Starts the threads; the last thing a subclass's constructor does."""
        self._warn_of_unknown_parameters()
        self.worker.start()
        if self._aside is not None:
            self._aside.start()
        self.worker.wake()

    def _warn_of_unknown_parameters(self) -> None:
        declared = sorted(self._parameters)
        for name, near in unknown_overrides(self._parameter_overrides, declared, sys.argv):
            hint = f"did you mean {near}?" if near else "ros2 param list, or ./walk params, lists what it has"
            self.get_logger().warning(f"there is no parameter {name}, so it changes nothing; {hint}")

    def work(self, building: Building) -> None:
        """Does what the newest input asks for, in the worker's thread."""
        raise NotImplementedError

    def forget(self) -> None:
        """Drops what was computed for another building, in the worker's thread."""
        raise NotImplementedError

    def before_loading(self, source: Path, options: LoadOptions, walker: Walker) -> None:
        """May publish what is kept from an earlier start, in the worker's thread; the building is not loaded yet."""

    def after_loading(self, building: Building) -> None:
        """May say what the building is like, in the worker's thread."""

    def fail(self, stamp_ns: int) -> None:
        """Publishes empty, stamped messages, in the worker's thread."""
        raise NotImplementedError

    def take_in(
        self,
        topic: str,
        store: Callable[[Any], None],
        then: Callable[[], None] | None = None,
        *,
        raw: bool = False,
        aside: bool = False,
    ) -> None:
        """Subscribes to a topic of the table; a message that is not sound is reported and otherwise ignored.

        Args:
            topic: Its name.
            store: Called with each message.
            then: Called once all messages that wait have been stored: the latest of them counts.
            raw: As `hear` has it.
            aside: As `hear` has it.
        """

        def callback(msg: Any) -> None:
            self._stored(topic, store, msg)
            if then is not None:
                for more in waiting(subscription):
                    self._stored(topic, store, more)
                then()

        subscription = self.hear(topic, callback, raw=raw, aside=aside)

    def hear(
        self, topic: str, callback: Callable[[Any], None], *, raw: bool = False, aside: bool = False
    ) -> Subscription:
        """Subscribes to a topic of the table.

        Args:
            topic: Its name.
            callback: Called with each message.
            raw: Hand the messages over as bytes.
            aside: Hear it in a thread of its own, which has nothing else to look through: for what is answered at once.
        """
        kind, qos = _ALL[topic].type, _ALL[topic].qos
        if not aside:
            return self.create_subscription(kind, topic, callback, qos, raw=raw)
        self._aside = self._aside or SideNode(self, "aside")
        return self._aside.hear(kind, topic, callback, qos, raw=raw)

    def _stored(self, topic: str, store: Callable[[Any], None], msg: Any) -> None:
        try:
            store(msg)
        except MessageError as error:
            self.get_logger().warning(f"{topic}: {error}")
            self.diagnostics.note(refused_message=f"{topic}: {error}")

    def offer(self, *topics: str, depth: int = 0) -> None:
        """Makes the publishers of topics of the table; a depth other than 0 replaces the table's."""
        for topic in topics:
            qos = latched(depth) if depth else _ALL[topic].qos
            old = self._publishing.get(topic)
            self._publishing[topic] = self.create_publisher(_ALL[topic].type, topic, qos)
            if old is not None:
                self.destroy_publisher(old)

    def publish(self, topic: str, msg: Any) -> None:
        """Publishes on a topic that was offered, from any thread; a node that is ending says no more."""
        if self.context.ok():
            self._publishing[topic].publish(msg)

    def publish_all(self, messages: Iterable[tuple[str, Any]]) -> None:
        """Publishes on several topics, in the order given."""
        for topic, msg in messages:
            self.publish(topic, msg)

    def revision(self) -> int:
        """Returns a new stamp [ns]: the clock's time, but always later than the one before."""
        with self._revision_lock:
            self._last_revision_ns = max(self.get_clock().now().nanoseconds, self._last_revision_ns + 1)
            return self._last_revision_ns

    def now_s(self) -> float:
        """Returns a time for measuring latencies [s]."""
        return time.perf_counter()

    def publish_diagnostics(self) -> None:
        """Publishes the state now; the timer does so every second."""
        self.publish("/diagnostics", self.diagnostics.to_msg(self.get_clock().now().nanoseconds))

    def report(self, error: Exception) -> None:
        """Logs an error, sets the diagnostics and publishes empty messages; the node lives on."""
        expected = isinstance(error, WalkError)
        if expected:
            self.get_logger().error(str(error))
        else:
            logging.getLogger(__name__).error("a step of the worker failed", exc_info=error)
        code = error_code(error) if expected else "internal_error"
        sentence = str(error) if expected else f"{type(error).__name__}: {error}"
        self.diagnostics.state("failed", sentence, level="error", code=code)
        self.fail(self.revision())
        self.publish_diagnostics()

    def destroy_node(self) -> None:
        """Ends the worker, then the node."""
        self.worker.stop(STOP_S)
        if self._aside is not None:
            self._aside.stop()
        stop_forwarding()
        super().destroy_node()

    def _changed(self, groups: frozenset[str]) -> None:
        self.worker.wake(supersede=bool(groups & {"load", "walker"}) or self.supersedes(groups))

    def supersedes(self, groups: frozenset[str]) -> bool:
        """Returns whether a change of these config groups makes the running step pointless."""
        return bool(groups)

    def _building_changed(self, parameters: list[Parameter]) -> None:
        if any(p.name == "building" for p in parameters):
            self.worker.wake(supersede=True)

    def _step(self) -> None:
        self._load()
        if self.building is not None:
            self.work(self.building)

    def _load(self) -> None:
        path = str(self.get_parameter("building").value)
        name = path or "the sample building"
        wanted = (path, self.parameters.get("load", LoadOptions), self.parameters.get("walker", Walker))
        if wanted == self._loaded_for:
            return
        self.building = None
        self.forget()
        self.diagnostics.state("loading", f"loading {name}")
        self.diagnostics.building(path, "")
        began = time.perf_counter()
        try:
            source = Path(path) if path else sample_building()
            self.before_loading(source, wanted[1], wanted[2])
            # Only now: its imports take longer than all that comes before the first message.
            from walk_building.pipeline import load_building

            self.building = load_building(source, wanted[1], wanted[2], self.worker.progress)
        except Superseded:
            raise
        except Exception:
            # The same file is not tried again until a parameter changes.
            self._loaded_for = wanted
            raise
        self._loaded_for = wanted
        # What has been loaded stays: looking through it for garbage takes longer than an edit.
        gc.collect()
        gc.freeze()
        self.diagnostics.building(path, self.building.hash)
        self.diagnostics.state("ready")
        self.get_logger().info(f"loaded {name} in {time.perf_counter() - began:.1f} s")
        self.after_loading(self.building)


def waiting(subscription: Any) -> Iterator[Any]:
    """Yields the messages that have come in on a subscription beside the one the executor took, without waiting."""
    with subscription.handle:
        while (taken := subscription.handle.take_message(subscription.msg_type, subscription.raw)) is not None:
            yield taken[0]


def sample_building() -> Path:
    """Returns the sample building; raises BuildingError where it is not installed."""
    try:
        # By name: walk_bringup has the nodes among what it depends on, and they run without it.
        return Path(importlib.import_module("walk_bringup.sample.location").sample_path())
    except (ImportError, FileNotFoundError) as error:
        raise BuildingError(
            "", f"no building is given, and no sample: {error}; set the parameter 'building'"
        ) from error
