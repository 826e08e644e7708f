# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Writes the sample building: `python -m walk_bringup.sample [FILE]`."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from walk_bringup.sample.pipeline import make_sample


def main() -> int:
    """Writes the file named on the command line and says what it wrote."""
    parser = argparse.ArgumentParser(prog="python -m walk_bringup.sample", description="write the sample building")
    parser.add_argument("output", type=Path, nargs="?", default=Path("sample.ifc"), help="default: %(default)s")
    output = parser.parse_args().output
    try:
        make_sample(output)
    except OSError as error:
        sys.stderr.write(f"{output}: cannot be written: {error.strerror}\n")
        return 2
    sys.stdout.write(f"wrote {output}, {output.stat().st_size / 1000:.0f} kB\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
