"""Actions, the client's side."""

from .client import ActionClient
from .graph import get_action_names_and_types

__all__ = ["ActionClient", "get_action_names_and_types"]
