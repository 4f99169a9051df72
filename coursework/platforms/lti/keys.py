"""Signing keys of the tool: the newest signs; earlier keys stay public until they are retired."""

from __future__ import annotations

import base64
import calendar
import hashlib
import json
import os
import re
import secrets
import time
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any

from cryptography.hazmat.primitives import serialization
from cryptography.hazmat.primitives.asymmetric import rsa
from cryptography.hazmat.primitives.asymmetric.types import PrivateKeyTypes
from jwt.algorithms import RSAAlgorithm

from coursework.errors import BadInput, nearest

_BITS = 3072  #: as strong as a symmetric key of 128 bits
_SECRET = "session.secret"
_NAME = re.compile(r"(?P<at>\d{8}T\d{6}Z)-(?P<kid>[\w-]{43})\.pem")


@dataclass(frozen=True)
class SigningKey:
    """Signing key, with its private half in a file that only its owner can read."""

    kid: str  #: digest of the public half, RFC 7638
    made: str  #: as in ``20261204T093000Z``
    path: Path

    @property
    def private(self) -> rsa.RSAPrivateKey:
        """Return the private half.

        Raises
        ------
        BadInput
            The file cannot be read, is not an RSA key, or others than its owner may read it.
        """
        if os.name == "posix" and self.path.stat().st_mode & 0o077:
            raise BadInput("others may read the private key {file}: chmod 600 {file}", file=self.path)
        try:
            private_key = _private_key(self.path.read_bytes())
        except (OSError, ValueError, TypeError) as fault:
            raise BadInput(
                "{file} is not a private key: {error}; 'coursework lti keys rotate' makes another",
                file=self.path,
                error=type(fault).__name__,
            ) from fault
        if not isinstance(private_key, rsa.RSAPrivateKey):
            raise BadInput(
                "{file} is not an RSA key, which LTI signs with; 'coursework lti keys rotate' makes one",
                file=self.path,
            )
        return private_key

    @property
    def public(self) -> dict[str, Any]:
        """Return the public half as a JSON web key."""
        return {**_jwk(self.private), "kid": self.kid, "alg": "RS256", "use": "sig"}


class KeyFolder:
    """Keys of a service, in a folder of mode 700, each in a file of mode 600."""

    def __init__(self, folder: Path, clock: Callable[[], float] = time.time):
        self.folder, self._clock = folder, clock

    @property
    def keys(self) -> tuple[SigningKey, ...]:
        """Return the public keys; the last one signs."""
        named = (_NAME.fullmatch(path.name) for path in sorted(self.folder.glob("*.pem")))
        return tuple(SigningKey(m["kid"], m["at"], self.folder / m[0]) for m in named if m)

    @property
    def signing(self) -> SigningKey:
        """Return the newest key.

        Raises
        ------
        BadInput
            There is none.
        """
        if not self.keys:
            raise BadInput("no key in {folder}; 'coursework lti keys new' makes one", folder=self.folder)
        return self.keys[-1]

    @property
    def public(self) -> dict[str, Any]:
        """Return the public key set that ``/jwks`` serves."""
        return {"keys": [key.public for key in self.keys]}

    def new(self) -> SigningKey:
        """Create a key, which signs from now on; earlier keys stay public."""
        kid = "-"
        while kid.startswith("-"):  # a command would take such a name for an option
            private = rsa.generate_private_key(public_exponent=65537, key_size=_BITS)
            kid = _thumbprint(_jwk(private))
        pem = private.private_bytes(
            serialization.Encoding.PEM, serialization.PrivateFormat.PKCS8, serialization.NoEncryption()
        )
        at = time.strftime("%Y%m%dT%H%M%SZ", time.gmtime(max(self._clock(), self._after_the_last())))
        path = self.folder / f"{at}-{kid}.pem"
        self._write(path, pem)
        return SigningKey(kid, at, path)

    def _after_the_last(self) -> float:
        """Return the earliest time of creation of another key, since the second of creation identifies a
        key."""
        if not self.keys:
            return 0.0
        return calendar.timegm(time.strptime(self.keys[-1].made, "%Y%m%dT%H%M%SZ")) + 1.0

    def retire(self, kid: str) -> SigningKey:
        """Delete a key; tokens that it signed are refused from now on.

        Raises
        ------
        BadInput
            There is no such key, or it is the one that signs.
        """
        kids = [key.kid for key in self.keys]
        matching = [key for key in self.keys if kid and key.kid.startswith(kid)]
        if len(matching) != 1:
            raise BadInput("{kid!r} does not name exactly one key{near}", kid=kid, near=nearest(kid, kids))
        if matching[0] == self.signing:
            raise BadInput(
                "{kid} is the key that signs; 'coursework lti keys rotate' makes another first",
                kid=matching[0].kid,
            )
        matching[0].path.unlink()
        return matching[0]

    @property
    def secret(self) -> bytes:
        """Return the secret that signs the service's states and forms; create it at the first use."""
        path = self.folder / _SECRET
        if not path.exists():
            self._write(path, secrets.token_hex(32).encode())
        return path.read_bytes()

    def _write(self, path: Path, data: bytes) -> None:
        self.folder.mkdir(parents=True, exist_ok=True, mode=0o700)
        part = path.with_name(f".{path.name}.{secrets.token_hex(4)}")
        with os.fdopen(os.open(part, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600), "wb") as file:
            file.write(data)
            file.flush()
            os.fsync(file.fileno())
        try:
            with suppress(FileExistsError):  # another process was first
                os.link(part, path)
        finally:
            part.unlink()


# To check the primes of a key takes a fifth of a second of a processor.
@lru_cache(maxsize=8)
def _private_key(pem: bytes) -> PrivateKeyTypes:
    return serialization.load_pem_private_key(pem, None)


def _jwk(private: rsa.RSAPrivateKey) -> dict[str, Any]:
    jwk: dict[str, Any] = RSAAlgorithm.to_jwk(private.public_key(), as_dict=True)
    return {name: jwk[name] for name in ("e", "kty", "n")}


def _thumbprint(jwk: dict[str, Any]) -> str:
    digest = hashlib.sha256(json.dumps(jwk, separators=(",", ":"), sort_keys=True).encode()).digest()
    return base64.urlsafe_b64encode(digest).rstrip(b"=").decode()
