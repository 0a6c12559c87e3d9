"""The default context, and which middleware is below."""

from .context import Context

_default_context = Context()


def get_default_context():
    return _default_context


def get_rmw_implementation_identifier():
    """The stand-in speaks as rmw_cyclonedds does."""
    return "rmw_cyclonedds_cpp"
