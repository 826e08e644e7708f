# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The certificate that the bridge makes for itself, kept across restarts."""

from __future__ import annotations

import dataclasses
import datetime
import ipaddress
import os
from collections.abc import Sequence
from pathlib import Path

from cryptography import x509
from cryptography.hazmat.primitives import hashes, serialization
from cryptography.hazmat.primitives.asymmetric import ec
from cryptography.x509.oid import ExtendedKeyUsageOID, NameOID

DAYS = 397
"""What browsers accept at most."""

_RENEW = datetime.timedelta(days=14)  # so that it does not run out while a study goes on
_HOUR = datetime.timedelta(hours=1)


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Certificate:
    """Where certificate and key are, and by what a user recognises it."""

    certificate: Path
    key: Path
    fingerprint: str  # SHA-256, as browsers show it


def certificate(folder: Path, names: Sequence[str]) -> Certificate:
    """Returns the certificate in the folder, or makes one where there is none that is valid for the names.

    Args:
        folder: Made if it is not there; nobody else may read it.
        names: Host names and IP addresses.
    """
    folder.mkdir(parents=True, exist_ok=True, mode=0o700)
    own, key = folder / "certificate.pem", folder / "key.pem"
    found = _load(own, key)
    if found is None or not _serves(found, names):
        found = _make(own, key, names)
    key.chmod(0o600)
    digest = found.fingerprint(hashes.SHA256()).hex().upper()
    pairs = ":".join(digest[at : at + 2] for at in range(0, len(digest), 2))
    return Certificate(certificate=own, key=key, fingerprint=pairs)


def _load(own: Path, key: Path) -> x509.Certificate | None:
    try:
        found = x509.load_pem_x509_certificate(own.read_bytes())
        secret = serialization.load_pem_private_key(key.read_bytes(), None)
    except (OSError, ValueError):
        return None
    form = (serialization.Encoding.DER, serialization.PublicFormat.SubjectPublicKeyInfo)
    fits = secret.public_key().public_bytes(*form) == found.public_key().public_bytes(*form)
    return found if fits else None


def _serves(found: x509.Certificate, names: Sequence[str]) -> bool:
    now = datetime.datetime.now(datetime.UTC)
    if not found.not_valid_before_utc <= now <= found.not_valid_after_utc - _RENEW:
        return False
    own = found.extensions.get_extension_for_class(x509.SubjectAlternativeName).value
    return all(_general_name(name) in own for name in names)


def _make(own: Path, key: Path, names: Sequence[str]) -> x509.Certificate:
    secret = ec.generate_private_key(ec.SECP256R1())
    subject = x509.Name([x509.NameAttribute(NameOID.COMMON_NAME, "walkthrough bridge")])
    now = datetime.datetime.now(datetime.UTC)
    made = (
        x509.CertificateBuilder()
        .subject_name(subject)
        .issuer_name(subject)
        .public_key(secret.public_key())
        .serial_number(x509.random_serial_number())
        # An hour back: the clock of a headset may be behind.
        .not_valid_before(now - _HOUR)
        .not_valid_after(now - _HOUR + datetime.timedelta(days=DAYS))
        .add_extension(x509.SubjectAlternativeName([_general_name(name) for name in names]), critical=False)
        .add_extension(x509.BasicConstraints(ca=False, path_length=None), critical=True)
        .add_extension(x509.ExtendedKeyUsage([ExtendedKeyUsageOID.SERVER_AUTH]), critical=False)
        .sign(secret, hashes.SHA256())
    )
    form = (serialization.Encoding.PEM, serialization.PrivateFormat.PKCS8, serialization.NoEncryption())
    _write_secret(key, secret.private_bytes(*form))
    own.write_bytes(made.public_bytes(serialization.Encoding.PEM))
    return made


def _write_secret(path: Path, data: bytes) -> None:
    # Made with its mode, not changed afterwards: in between somebody could read it.
    path.unlink(missing_ok=True)
    with os.fdopen(os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600), "wb") as file:
        file.write(data)


def _general_name(name: str) -> x509.GeneralName:
    try:
        return x509.IPAddress(ipaddress.ip_address(name))
    except ValueError:
        return x509.DNSName(name)
