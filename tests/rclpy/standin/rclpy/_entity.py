"""What publishers, subscriptions, clients and services share: DDS readers and writers that a node owns."""

from cyclonedds.core import InstanceState, ReadCondition, SampleState, ViewState
from cyclonedds.pub import DataWriter
from cyclonedds.sub import DataReader
from cyclonedds.topic import Topic

from .qos import _to_dds

_ANY = ViewState.Any | SampleState.Any | InstanceState.Any


class Writer:
    def __init__(self, participant, topic, codec, profile, user_data=""):
        self.codec = codec
        qos = _to_dds(profile, user_data)
        self.dds = DataWriter(participant, Topic(participant, topic, codec.sample_type), qos=qos)

    def close(self):
        """Lets go of the DDS entity, which lives as long as somebody holds it."""
        self.dds = None

    def matched_readers(self):
        """Handles of the readers that this writer writes to."""
        return _matched(self.dds.get_matched_subscriptions)

    def user_data_of_readers(self):
        return [_user_data(self.dds.get_matched_subscription_data(handle)) for handle in self.matched_readers()]


class Reader:
    def __init__(self, participant, topic, codec, profile, user_data=""):
        self.codec = codec
        qos = _to_dds(profile, user_data)
        self.dds = DataReader(participant, Topic(participant, topic, codec.sample_type), qos=qos)
        self.condition = ReadCondition(self.dds, _ANY)

    def close(self):
        self.condition = self.dds = None

    def take(self):
        """The next sample, or None; samples without data (a writer left) are passed over."""
        while samples := self.dds.take(N=1):
            if samples[0].sample_info.valid_data:
                return samples[0]
        return None

    def matched_writers(self):
        """Handles of the writers that this reader hears."""
        return _matched(self.dds.get_matched_publications)

    def user_data_of_writers(self):
        return [_user_data(self.dds.get_matched_publication_data(handle)) for handle in self.matched_writers()]

    def user_data_of_writer(self, handle):
        return _user_data(self.dds.get_matched_publication_data(handle))


def _matched(ask):
    """The answer of a binding that counts the matched endpoints first and fetches them then.

    One that is matched in between makes it read past the list that it has made room for; asked again, it has counted that one.
    """
    while True:
        try:
            return ask()
        except IndexError:
            continue


def _user_data(endpoint):
    """The `key=value;` pairs that an endpoint announces; None when it has left."""
    if endpoint is None:
        return None
    for policy in endpoint.qos:
        if type(policy).__name__ == "Userdata":
            pairs = policy.data.decode(errors="replace").split(";")
            return dict(pair.split("=", 1) for pair in pairs if "=" in pair)
    return {}
