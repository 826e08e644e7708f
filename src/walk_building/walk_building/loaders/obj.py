# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The text of an OBJ file in the form that the mesh engine reads rightly."""

from __future__ import annotations

import re

_RELATIVE_FACE = re.compile(r"^\s*f\s.*(?<![\d/])-\d", re.MULTILINE)


def readable_obj(text: str) -> str:
    """Returns the text with each face counting its vertices from the start of the file.

    A negative index counts back from the last vertex above its line. The engine takes it to count back from the end
    of the file, which puts all objects but the last in the wrong place without a word.
    """
    if _RELATIVE_FACE.search(text) is None:
        return text
    lines = []
    n_vertices = 0
    for line in text.replace("\\\r\n", " ").replace("\\\n", " ").splitlines():
        words = line.split()
        if words and words[0] == "v":
            n_vertices += 1
        elif words and words[0] == "f":
            line = "f " + " ".join(_absolute(word, n_vertices) for word in words[1:])
        lines.append(line)
    return "\n".join(lines)


def _absolute(word: str, n_vertices: int) -> str:
    """Returns the vertex of a corner such as `-4/-4/-1`; what it says of textures and normals is of no use here."""
    index = int(word.partition("/")[0])
    return str(index if index > 0 else n_vertices + index + 1)
