"""A recorder that has found what it shall record."""


def start_recorder(ros, excavator, bag, topics, *words):
    """`excavator record`, once it has opened each topic and is seen there; publishers of all of them have to be there."""
    readers = {topic: ros.node.count_subscribers(topic) for topic in topics}
    recorder = ros.start(excavator, "record", "-o", bag, *words, *topics)

    def is_there(topic):
        return f"recording {topic} " in recorder.output() and ros.node.count_subscribers(topic) > readers[topic]

    for topic in topics:
        ros.spin_until(lambda topic=topic: is_there(topic), f"the recorder on {topic}")
    return recorder


def bag_states(bag):
    """The messages of a bag with one topic, in the order of the bag."""
    from rosbags.highlevel import AnyReader

    with AnyReader([bag]) as reader:
        return [reader.deserialize(data, connection.msgtype) for connection, _, data in reader.messages()]
