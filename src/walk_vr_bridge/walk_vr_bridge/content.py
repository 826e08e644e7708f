# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Files as they are served: compressed once, named by their content."""

from __future__ import annotations

import dataclasses
import gzip
import hashlib
import mimetypes
from pathlib import Path

_COMPRESSIBLE = ("text/", "application/json", "application/javascript", "model/", "image/svg", "application/octet")
PAGE = "index.html"
_NOT_BUILT = """<!doctype html><html lang="en"><head><meta charset="utf-8"><title>Walkthrough</title></head><body>
<h1>The page is not built</h1>
<p>Run <code>./walk setup</code>, or <code>npm ci &amp;&amp; npm run build</code> in
<code>src/walk_vr_bridge/web</code>, and load this page again.</p>
<p>The bridge itself runs: files and WebSocket are served.</p></body></html>
"""


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Content:
    """A file in memory."""

    data: bytes
    gzipped: bytes  # empty where it is not worth it
    media_type: str
    etag: str  # with its quotes
    cache_control: str


def content(data: bytes, media_type: str, cache_control: str = "no-cache", level: int = 6) -> Content:
    """Returns data ready to be served."""
    packed = gzip.compress(data, level, mtime=0) if media_type.startswith(_COMPRESSIBLE) else b""
    return Content(
        data=data,
        gzipped=packed if packed and len(packed) < 0.9 * len(data) else b"",
        media_type=media_type,
        etag=f'"{hashlib.sha256(data).hexdigest()[:32]}"',
        cache_control=cache_control,
    )


def as_answered(found: Content, if_none_match: str, accept_encoding: str) -> tuple[int, bytes, dict[str, str]]:
    """Returns status, body and headers of the answer to a request with these headers."""
    headers = {
        "Content-Type": found.media_type,
        "ETag": found.etag,
        "Cache-Control": found.cache_control,
        "Vary": "Accept-Encoding",
    }
    if found.etag in [tag.strip().removeprefix("W/") for tag in if_none_match.split(",")]:
        return 304, b"", headers
    if found.gzipped and "gzip" in accept_encoding:
        return 200, found.gzipped, {**headers, "Content-Encoding": "gzip"}
    return 200, found.data, headers


class Page:
    """The built page, read again when a file has changed."""

    def __init__(self, folder: Path) -> None:
        """Takes the folder that the build writes to; it need not be there."""
        self._folder = folder.resolve()
        self._kept: dict[str, tuple[int, Content]] = {}

    def get(self, name: str) -> Content | None:
        """Returns a file by its path below the folder, None where there is none; "" is the page itself."""
        path = self._path(name or PAGE)
        if path is None:
            return None if name else content(_NOT_BUILT.encode(), "text/html; charset=utf-8")
        changed = path.stat().st_mtime_ns
        kept = self._kept.get(name)
        if kept is None or kept[0] != changed:
            fixed = "public, max-age=31536000, immutable" if name.startswith("assets/") else "no-cache"
            kept = self._kept[name] = (changed, content(path.read_bytes(), _media_type(path), fixed))
        return kept[1]

    def _path(self, name: str) -> Path | None:
        if "\0" in name or "\\" in name:
            return None
        try:
            path = (self._folder / name).resolve()
        except (OSError, ValueError):
            return None
        inside = path.is_relative_to(self._folder) and not any(part.startswith(".") for part in Path(name).parts)
        return path if inside and path.is_file() else None


def _media_type(path: Path) -> str:
    known = {".js": "text/javascript; charset=utf-8", ".html": "text/html; charset=utf-8", ".wasm": "application/wasm",
             ".css": "text/css; charset=utf-8", ".webmanifest": "application/manifest+json"}  # fmt: skip
    return known.get(path.suffix) or mimetypes.guess_type(path.name)[0] or "application/octet-stream"
