# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The cores' `logging` as ROS log messages."""

from __future__ import annotations

import logging
from typing import Any


class _Forward(logging.Handler):
    """Hands records on to a ROS logger."""

    def __init__(self, logger: Any) -> None:
        super().__init__(logging.INFO)
        self._logger = logger

    def emit(self, record: logging.LogRecord) -> None:
        text = self.format(record)
        # One line of code per severity: the ROS logger refuses a severity that changes at a call site.
        if record.levelno >= logging.ERROR:
            self._logger.error(text)
        elif record.levelno >= logging.WARNING:
            self._logger.warning(text)
        else:
            self._logger.info(text)


def forward_logging(logger: Any) -> None:
    """Sends what the project's packages log at INFO and above to the ROS logger, until `stop_forwarding`."""
    stop_forwarding()
    root = logging.getLogger()
    handler = _Forward(logger)
    handler.addFilter(lambda record: record.name.startswith("walk_"))
    root.addHandler(handler)
    logging.getLogger().setLevel(min(root.level or logging.WARNING, logging.INFO))


def stop_forwarding() -> None:
    """Ends what `forward_logging` has begun: a node that is gone logs nothing."""
    root = logging.getLogger()
    for handler in [h for h in root.handlers if isinstance(h, _Forward)]:
        root.removeHandler(handler)
