"""Makes `from std_msgs.msg import String` work: packages appear from their definitions when they are imported."""

import importlib.machinery
import sys
import types

from . import _definitions, _messages

_MAKERS = {
    "msg": _messages.message_class,
    "srv": _messages.service_class,
    "action": _messages.action_class,
}


class _InterfaceModule(types.ModuleType):
    def __getattr__(self, name):
        if name.startswith("_"):
            raise AttributeError(name)
        package, kind = self.__name__.split(".")
        try:
            made = _MAKERS[kind](f"{package}/{kind}/{name}")
        except ImportError as error:
            raise AttributeError(f"module {self.__name__!r} has no interface {name!r}: {error}") from error
        setattr(self, name, made)
        return made


class _Finder:
    """Finds `pkg`, `pkg.msg`, `pkg.srv` and `pkg.action` of packages with known definitions."""

    def find_spec(self, name, path=None, target=None):
        package, _, kind = name.partition(".")
        if "." in kind or (kind and kind not in _MAKERS) or not _definitions.exists(package):
            return None
        return importlib.machinery.ModuleSpec(name, self, is_package=not kind)

    def create_module(self, spec):
        return (
            types.ModuleType(spec.name) if spec.submodule_search_locations is not None else _InterfaceModule(spec.name)
        )

    def exec_module(self, module):
        pass


def install():
    # at the end: a package that is really installed is found before
    if not any(isinstance(finder, _Finder) for finder in sys.meta_path):
        sys.meta_path.append(_Finder())
