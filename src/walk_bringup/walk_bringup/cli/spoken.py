# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""What is wrong with a value, said under the name of the option that was typed."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from contextlib import contextmanager

from walk_building.errors import ParameterError


@contextmanager
def spoken(options: Mapping[str, str]) -> Iterator[None]:
    """Within it, a ParameterError about a field of a config is raised as one about its option.

    Args:
        options: From the field's name to what is typed, such as `radius_m` to `--radius`.
    """
    try:
        yield
    except ParameterError as error:
        # Names of one word are words of the language as well: in a sentence they may mean just that.
        fields = "|".join(re.escape(name) for name in options if "_" in name)
        expected = re.sub(rf"\b({fields})\b", lambda found: options[found[0]], error.expected) if fields else None
        raise ParameterError(options.get(error.name, error.name), error.value, expected or error.expected) from error
