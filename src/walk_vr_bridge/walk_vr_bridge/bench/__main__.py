# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""`./walk bench bridge`: what the bridge adds to an edit, and a crowd of clients, as JSON."""

from __future__ import annotations

import argparse
import asyncio
import json
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from walk_building.errors import WalkError
from walk_vr_bridge.bench.crowd import measure_crowd
from walk_vr_bridge.bench.graph import BenchGraph
from walk_vr_bridge.bench.trips import measure_trips


def main(argv: Sequence[str] | None = None) -> int:
    """Measures and writes JSON to stdout; returns the exit code."""
    options = _options(argv)
    with tempfile.TemporaryDirectory(prefix="walk_bench_") as folder:
        graph = BenchGraph(Path(folder), options.building)
        try:
            graph.wait()
            report: dict[str, Any] = {"trips": measure_trips(graph.url, options.edits, options.rate)}
            if options.clients:
                report["crowd"] = asyncio.run(measure_crowd(graph, options.clients, options.seconds))
            report["memory_mib"] = round(graph.memory_mib(), 1)
        except WalkError as error:
            sys.stderr.write(f"walk: {error}\n")
            return 2
        finally:
            codes = graph.close()
    report["exit_codes"] = codes
    sys.stdout.write(json.dumps(report, indent=2) + "\n")
    return 0


def _options(argv: Sequence[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        prog="./walk bench bridge",
        description="Measure what the bridge adds to the way of an edit, beside a node that answers at once; with "
        "--clients also what a crowd does to it, of which one is stalled, one sends garbage and one floods.",
    )
    parser.add_argument("--building", default="", help="file (default: the sample building)")
    parser.add_argument("--edits", type=int, default=500, help="of each kind (default: %(default)s)")
    parser.add_argument("--rate", type=float, default=50.0, help="edits a second (default: %(default)s)")
    parser.add_argument("--clients", type=int, default=0, help="of the crowd; 50 for the figure")
    parser.add_argument("--seconds", type=float, default=300.0, help="that the crowd stays (default: %(default)s)")
    return parser.parse_args(argv)


if __name__ == "__main__":
    sys.exit(main())
