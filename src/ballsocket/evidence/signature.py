"""Detached Ed25519 signatures in the format of OpenSSH (SSHSIG), compatible with `ssh-keygen -Y`."""

from __future__ import annotations

from base64 import b64decode, b64encode
from dataclasses import dataclass
from hashlib import new, sha256
from pathlib import Path
from typing import TYPE_CHECKING

from ..core.checks import needs
from ..core.input_files import open_input

if TYPE_CHECKING:
    from cryptography.hazmat.primitives.asymmetric.ed25519 import Ed25519PrivateKey

NAMESPACE = "ballsocket"
"""Purpose of the signature; signatures for other purposes are refused."""

_MAGIC, _VERSION, _ALGORITHM = b"SSHSIG", (1).to_bytes(4, "big"), b"ssh-ed25519"
_HASHES = ("sha512", "sha256")
_BEGIN, _END = "-----BEGIN SSH SIGNATURE-----", "-----END SSH SIGNATURE-----"
_LINE_LENGTH = 70
_MAX_FILE_SIZE = 1 << 16
"""Largest size of a key file in bytes."""


class SignatureError(ValueError):
    """Error for an invalid signature, with the reason."""


@dataclass(frozen=True)
class PublicKey:
    """Ed25519 public key of 32 bytes."""

    point: bytes

    @property
    def blob(self) -> bytes:
        """Key in the wire format of SSH."""
        return _text(_ALGORITHM) + _text(self.point)

    @property
    def fingerprint(self) -> str:
        """Fingerprint of the key, as `ssh-keygen -l` prints it."""
        return "SHA256:" + b64encode(sha256(self.blob).digest()).decode("ascii").rstrip("=")


def check_extra() -> None:
    """Raise ImportError with the install command for a missing signature library."""
    needs("sign", "cryptography")


def read_private_key(path: Path) -> Ed25519PrivateKey:
    """Read an Ed25519 private key in the format of OpenSSH.

    Raises
    ------
    ValueError
        A file without such a key, or a key that is protected by a passphrase.
    OSError
        The file cannot be read.
    """
    check_extra()
    from cryptography.exceptions import UnsupportedAlgorithm
    from cryptography.hazmat.primitives.asymmetric.ed25519 import Ed25519PrivateKey
    from cryptography.hazmat.primitives.serialization import load_ssh_private_key

    try:
        key = load_ssh_private_key(_read_key_file(path), password=None)
    except TypeError as error:  # raised for a key that needs a password
        raise ValueError(
            f"{path.name} is protected by a passphrase: sign with ssh-keygen -Y sign -n {NAMESPACE} -f {path.name} "
            "checksums.txt, which writes the same file"
        ) from error
    except (ValueError, UnsupportedAlgorithm) as error:
        raise ValueError(f"{path.name} must be a private key of OpenSSH: make one with {_MAKE_KEY}") from error
    if not isinstance(key, Ed25519PrivateKey):
        raise ValueError(f"{path.name} must be an Ed25519 key: make one with {_MAKE_KEY}")
    return key


_MAKE_KEY = "ssh-keygen -t ed25519 -f key"


def public_key_of(key: Ed25519PrivateKey) -> PublicKey:
    """Return the public half of a private key."""
    return PublicKey(key.public_key().public_bytes_raw())


def read_public_key(path: Path) -> PublicKey:
    """Read an Ed25519 public key, such as `key.pub`.

    Raises
    ------
    ValueError
        A file without such a key, or with several.
    OSError
        The file cannot be read.
    """
    wrong = ValueError(f"{path.name} must be a public Ed25519 key: one line 'ssh-ed25519 AAAA... name' is needed")
    try:
        lines = [line.split() for line in _read_key_file(path).decode("utf-8").splitlines() if line.strip()]
        (words,) = lines
        if words[0] != _ALGORITHM.decode("ascii"):
            raise wrong
        return _public_key(b64decode(words[1], validate=True))
    except (ValueError, IndexError) as error:
        raise wrong from error


def sign(message: bytes, key: Ed25519PrivateKey) -> str:
    """Sign a message and return the text of the signature file."""
    signature = key.sign(_signed_bytes(message, "sha512"))
    blob = (
        _MAGIC
        + _VERSION
        + _text(public_key_of(key).blob)
        + _text(NAMESPACE.encode())
        + _text(b"")
        + _text(b"sha512")
        + _text(_text(_ALGORITHM) + _text(signature))
    )
    code = b64encode(blob).decode("ascii")
    lines = [code[start : start + _LINE_LENGTH] for start in range(0, len(code), _LINE_LENGTH)]
    return "\n".join([_BEGIN, *lines, _END]) + "\n"


def verify(message: bytes, signature: bytes) -> PublicKey:
    """Verify a signature with the key that it contains, and return the key; the caller decides on its trust.

    Raises
    ------
    SignatureError
        A signature that is damaged, of another purpose or algorithm, or of another message.
    """
    check_extra()
    from cryptography.exceptions import InvalidSignature
    from cryptography.hazmat.primitives.asymmetric.ed25519 import Ed25519PublicKey

    reader = _Reader(_unarmoured(signature))
    if reader.take(len(_MAGIC)) != _MAGIC or reader.take(4) != _VERSION:
        raise SignatureError("the signature is damaged: it is not an SSH signature of version 1")
    try:
        key = _public_key(reader.text())
    except ValueError as error:
        raise SignatureError("the signature is not of an Ed25519 key") from error
    namespace, _, algorithm, signed = (reader.text() for _ in range(4))
    reader.end()
    if namespace != NAMESPACE.encode():
        raise SignatureError(f"the signature is for the purpose {namespace[:40]!r}, not for {NAMESPACE!r}")
    if algorithm.decode("ascii", "replace") not in _HASHES:
        raise SignatureError(f"the signature has the hash {algorithm[:40]!r}; allowed: {', '.join(_HASHES)}")
    inner = _Reader(signed)
    kind, value = inner.text(), inner.text()
    inner.end()
    try:
        if kind != _ALGORITHM:
            raise InvalidSignature
        Ed25519PublicKey.from_public_bytes(key.point).verify(value, _signed_bytes(message, algorithm.decode("ascii")))
    except (InvalidSignature, ValueError) as error:
        raise SignatureError("the signature is of other checksums: the pack was changed after it was signed") from error
    return key


def _read_key_file(path: Path) -> bytes:
    """Read a key file of limited size."""
    with open_input(path) as stream:
        content = stream.read(_MAX_FILE_SIZE + 1)
    if len(content) > _MAX_FILE_SIZE:
        raise ValueError(f"{path.name} is larger than {_MAX_FILE_SIZE} bytes: choose a key file")
    return content


def _text(content: bytes) -> bytes:
    """Prefix bytes with their length, the string format of RFC 4251."""
    return len(content).to_bytes(4, "big") + content


def _signed_bytes(message: bytes, algorithm: str) -> bytes:
    """Return the bytes that are signed for a message."""
    parts = (NAMESPACE.encode(), b"", algorithm.encode(), new(algorithm, message).digest())
    return _MAGIC + b"".join(map(_text, parts))


def _public_key(blob: bytes) -> PublicKey:
    """Create a public key from the wire format of SSH."""
    reader = _Reader(blob)
    kind, point = reader.text(), reader.text()
    reader.end()
    if kind != _ALGORITHM or len(point) != 32:
        raise ValueError("no Ed25519 key")
    return PublicKey(point)


def _unarmoured(signature: bytes) -> bytes:
    """Decode the bytes between the first and the last line of a signature file."""
    try:
        lines = signature.decode("ascii").splitlines()
        if len(lines) < 3 or lines[0] != _BEGIN or lines[-1] != _END:
            raise ValueError("the first or the last line is missing")
        return b64decode("".join(lines[1:-1]), validate=True)
    except ValueError as error:
        raise SignatureError("the signature is damaged: its file is cut off or is not an SSH signature") from error


class _Reader:
    """Reader of the string format of RFC 4251 that refuses missing and additional bytes."""

    def __init__(self, content: bytes) -> None:
        self._content, self._position = content, 0

    def take(self, count: int) -> bytes:
        """Return the next bytes."""
        piece = self._content[self._position : self._position + count]
        if len(piece) < count:
            raise SignatureError("the signature is damaged: it ends too early")
        self._position += count
        return piece

    def text(self) -> bytes:
        """Return the next string."""
        return self.take(int.from_bytes(self.take(4), "big"))

    def end(self) -> None:
        """Refuse bytes after the end."""
        if self._position != len(self._content):
            raise SignatureError("the signature is damaged: bytes follow its end")
