"""Object storage: S3, GCS, Azure and files."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from .. import _native


@dataclass(frozen=True)
class Entry:
    """An object in a store."""

    url: str
    """Address of the object."""
    size: int
    """Size, bytes."""
    etag: str | None
    """Identifier that the store assigned to the content."""
    last_modified: int
    """Time of the last write, ns since the epoch."""


@dataclass(frozen=True)
class Copied:
    """A copy of a bag with only the selected topics."""

    path: Path
    """Path of the copy."""
    bytes_read: int
    """Bytes read from the store."""
    bytes_total: int
    """Size of the whole bag, bytes."""
    messages: int
    """Number of messages copied one by one."""
    whole: list[str]
    """Files copied whole, with the reason."""


@dataclass(frozen=True)
class Store:
    """Access to object stores with these options (`endpoint`, `region`, `allow_http`, `access_key_id`, `secret_access_key`, ...).

    An address is `s3://`, `gs://`, `az://` or `file://` with a path, or a plain path. Environment variables (`AWS_*`, `GOOGLE_*`,
    `AZURE_*`) also apply; `options` take precedence.
    """

    options: Mapping[str, str] = field(default_factory=dict)

    def _all(self) -> dict[str, str]:
        return {key: str(value) for key, value in self.options.items()}

    def get(self, url: str) -> bytes:
        """Returns the content of an object."""
        return _native.store_get(url, self._all())

    def put(self, url: str, content: bytes) -> None:
        """Writes an object. Replaces an existing one."""
        _native.store_put(url, content, self._all())

    def put_if_absent(self, url: str, content: bytes) -> bool:
        """Writes an object unless the address already has one. Returns whether it was written."""
        return _native.store_put_if_absent(url, content, self._all())

    def list(self, url: str) -> list[Entry]:
        """Returns all objects in a folder and its subfolders, sorted by address."""
        return [Entry(*row) for row in _native.store_list(url, self._all())]

    def fingerprint(self, url: str) -> str:
        """Returns an identifier of the content at an address: a bag, a folder, or a document."""
        return _native.store_fingerprint(url, self._all())

    def thin_copy(self, url: str, topics: Sequence[str] | None, target: Path) -> Copied:
        """Copies a bag into a folder, with only these topics (`*/arm/state` matches every topic with this ending); with `None`, all topics."""
        path, *rest = _native.store_thin_copy(url, None if topics is None else list(topics), target, self._all())
        return Copied(Path(path), *rest)


def joined(folder: str, *parts: str) -> str:
    """Returns an address below `folder`."""
    return "/".join([folder.rstrip("/"), *parts])


def is_url(address: str) -> bool:
    """Whether an address is a URL and not a plain path."""
    return "://" in address


def local_path(address: str) -> Path | None:
    """Returns the path of a file or folder on this machine; `None` for any other address."""
    if not is_url(address):
        return Path(address)
    if address.startswith("file://"):
        from urllib.parse import unquote, urlsplit

        return Path(unquote(urlsplit(address).path))
    return None
