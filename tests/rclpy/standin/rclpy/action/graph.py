"""Which actions there are."""

_FEEDBACK_TOPIC = "/_action/feedback"
_FEEDBACK_TYPE = "_FeedbackMessage"


def get_action_names_and_types(node):
    """An action is known by its feedback topic, as in rcl_action."""
    found = []
    for topic, types in node.get_topic_names_and_types():
        if topic.endswith(_FEEDBACK_TOPIC):
            actions = [name[: -len(_FEEDBACK_TYPE)] for name in types if name.endswith(_FEEDBACK_TYPE)]
            found.append((topic[: -len(_FEEDBACK_TOPIC)], actions))
    return found
