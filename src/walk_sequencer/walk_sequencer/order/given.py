# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The user's own order."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from walk_sequencer.config import SequencerConfig


def order_given(
    costs: NDArray[np.float64],
    start: int,
    end: int,
    config: SequencerConfig,  # noqa: ARG001  the signature of all orders
) -> NDArray[np.int64]:
    """Returns the indices as they come, but for a chosen start, which goes first, and a chosen end, which goes last."""
    inner = [k for k in range(len(costs)) if k not in (start, end)]
    first = [start] if start >= 0 else []
    last = [end] if end >= 0 else []
    return np.array(first + inner + last, dtype=np.int64)
