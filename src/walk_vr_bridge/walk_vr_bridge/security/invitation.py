# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""What the user sees at the start: the address, as text and as a QR code, the fingerprint and the code to type."""

from __future__ import annotations

import io

import segno


def qr_code(text: str) -> str:
    """Returns a QR code for a terminal."""
    out = io.StringIO()
    segno.make(text, error="l", micro=False).terminal(out, compact=True, border=2)
    return out.getvalue()


def invitation(address: str, others: list[str], viewer: str, fingerprint: str) -> str:
    """Returns the text that lets people in; it holds tokens and belongs on the terminal only."""
    lines = [
        "",
        qr_code(address),
        f"Page, for editing: {address}",
        *(f"               or: {other}" for other in others),
        f"For looking on:    {viewer}",
        "The browser warns about the certificate once; it is this bridge if the SHA-256 fingerprint is",
        f"  {fingerprint[:47]}",
        f"  {fingerprint[48:]}",
        "Who has an address edits the walkthrough: show it to nobody else.",
        "",
    ]
    return "\n".join(lines)


def code_line(code: str) -> str:
    """Returns the line that shows a pairing code."""
    return f"Code to type in the headset, for five minutes and once: {code[:4]} {code[4:]}\n"
