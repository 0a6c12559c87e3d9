"""Bags with topics of any type."""

from __future__ import annotations

import html
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path as FilePath
from typing import Any

from numpy.typing import NDArray

from . import _native
from ._errors import remark
from ._recording import Path


@dataclass(frozen=True)
class Topic:
    """A topic of a bag."""

    name: str
    """Name, such as `/joint_states`."""
    type: str
    """Message type, such as `sensor_msgs/msg/JointState`."""
    count: int
    """Number of readable messages."""
    rate: float | None
    """Mean number of messages per second, Hz; `None` for fewer than two messages."""


class Bag:
    """A bag: a rosbag2 folder, or a bare `.mcap` or `.db3` file. Messages of any type are decoded with the definitions in the bag::

        bag = excavator.Bag("my-bag")
        bag.topics
        bag.read("/joint_states", ["position[name=arm]", "header.stamp.sec"])
    """

    def __init__(self, path: Path) -> None:
        self._native = _native.Bag(path)
        self._content: tuple[list[Topic], list[str], float] | None = None

    def _info(self) -> tuple[list[Topic], list[str], float]:
        if self._content is None:
            topics, problems, duration = self._native.info()
            self._content = [Topic(*topic) for topic in topics], problems, duration
        return self._content

    @property
    def path(self) -> FilePath:
        """Path of the bag."""
        return self._native.path

    @property
    def topics(self) -> list[Topic]:
        """The topics, sorted by name. The first access reads the whole bag, because an index can list messages that the bag does not contain."""
        return self._info()[0]

    @property
    def problems(self) -> list[str]:
        """Problems of the bag, one line each."""
        return self._info()[1]

    @property
    def duration(self) -> float:
        """Time from the earliest message to the latest, s."""
        return self._info()[2]

    def __iter__(self) -> Iterator[Topic]:
        return iter(self.topics)

    def read(self, topic: str, fields: Sequence[str] | None = None) -> dict[str, NDArray[Any]]:
        """Returns one topic as columns, with one entry for each message.

        `fields` are paths like `pose.position.x`, `data[3]` or `position[name=arm]`. By default, every number of the first message is
        read, with at most 16 elements of each array. Numbers are `float64`, and `NaN` where a message lacks the element. Times are
        `int64`, ns since the epoch: `log_time`, `publish_time`, and `header_time` if the type has a header.
        """
        if isinstance(fields, str):
            fields = [fields]
        columns, undecodable = self._native.read(topic, None if fields is None else list(fields))
        if undecodable:
            remark([f"{self.path}: {undecodable} messages of {topic} that do not fit their definition were left out"])
        return columns

    def __repr__(self) -> str:
        return f"<Bag {self.path}>"

    def _repr_html_(self) -> str:
        heads = "".join(f"<th>{head}</th>" for head in ("topic", "type", "messages", "Hz"))
        rows = "".join(
            f"<tr><th>{html.escape(topic.name)}</th><td>{html.escape(topic.type)}</td><td>{topic.count}</td>"
            f"<td>{'' if topic.rate is None else f'{topic.rate:.4g}'}</td></tr>"
            for topic in self.topics
        )
        lead = f"{html.escape(str(self.path))}: {self.duration:.2f} s"
        return f"<p>{lead}</p><table><thead><tr>{heads}</tr></thead><tbody>{rows}</tbody></table>"
