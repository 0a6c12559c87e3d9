"""Object storage: S3, GCS, Azure and files."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from .. import _native


@dataclass(frozen=True)
class Entry:
    """An object of a store."""

    url: str
    """Its address."""
    size: int
    """Its size, bytes."""
    etag: str | None
    """What the store calls its content."""
    last_modified: int
    """When it was written, ns since the epoch."""


@dataclass(frozen=True)
class Copied:
    """A copy of a bag with only the wanted topics."""

    path: Path
    """Where it is."""
    bytes_read: int
    """Bytes that were read from the store."""
    bytes_total: int
    """Bytes that the bag has."""
    messages: int
    """Messages that were copied one by one."""
    whole: list[str]
    """Files that were copied whole, with the reason."""


@dataclass(frozen=True)
class Store:
    """Stores with these options (`endpoint`, `region`, `allow_http`, `access_key_id`, `secret_access_key`, ...).

    An address is `s3://`, `gs://`, `az://` or `file://` with a path, or a plain path. Variables of the environment (`AWS_*`, `GOOGLE_*`,
    `AZURE_*`) count too; options go first.
    """

    options: Mapping[str, str] = field(default_factory=dict)

    def _all(self) -> dict[str, str]:
        return {key: str(value) for key, value in self.options.items()}

    def get(self, url: str) -> bytes:
        """The content of an object."""
        return _native.store_get(url, self._all())

    def put(self, url: str, content: bytes) -> None:
        """Writes an object, or replaces it."""
        _native.store_put(url, content, self._all())

    def put_if_absent(self, url: str, content: bytes) -> bool:
        """Writes an object only where there is none; says whether it did."""
        return _native.store_put_if_absent(url, content, self._all())

    def list(self, url: str) -> list[Entry]:
        """All objects below a folder, by address."""
        return [Entry(*row) for row in _native.store_list(url, self._all())]

    def fingerprint(self, url: str) -> str:
        """Identity of the content at an address: a bag, a folder, or a document."""
        return _native.store_fingerprint(url, self._all())

    def thin_copy(self, url: str, topics: Sequence[str] | None, target: Path) -> Copied:
        """Copies a bag into a folder, with only these topics (`*/arm/state`: all that end so); without topics, whole."""
        path, *rest = _native.store_thin_copy(url, None if topics is None else list(topics), target, self._all())
        return Copied(Path(path), *rest)


def joined(folder: str, *parts: str) -> str:
    """An address below another."""
    return "/".join([folder.rstrip("/"), *parts])


def is_url(address: str) -> bool:
    """Whether an address is a URL, or a plain path."""
    return "://" in address


def local_path(address: str) -> Path | None:
    """The file or folder that an address means, where it is on this machine."""
    if not is_url(address):
        return Path(address)
    if address.startswith("file://"):
        from urllib.parse import unquote, urlsplit

        return Path(unquote(urlsplit(address).path))
    return None
