"""Functions whose keywords are options that are declared once, in Rust: their signatures and doc strings have every one of them."""

import functools
import inspect

from . import _native


def explained(*declarations, module="enfilade"):
    """A decorator that puts the options of declarations into the signature and doc string of a function of `module`."""
    rows = [row for declaration in declarations for row in _native.declared(declaration)]
    options = [inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=default) for name, default, _ in rows]

    def decorated(function):
        signature = inspect.signature(function)
        own = [parameter for parameter in signature.parameters.values() if parameter.kind is not parameter.VAR_KEYWORD]
        places = [parameter for parameter in own if parameter.kind is not parameter.KEYWORD_ONLY]
        keywords = [parameter for parameter in own if parameter.kind is parameter.KEYWORD_ONLY]

        @functools.wraps(function)
        def call(*places, **keywords):
            return function(*places, **keywords)

        call.__module__ = module
        call.__signature__ = signature.replace(parameters=[*places, *options, *keywords])
        call.__doc__ = _described(function, rows)
        return call

    return decorated


def _described(documented, rows):
    """The doc string with a line for each option in place of `{options}`."""
    return documented.__doc__.replace("{options}", "\n".join(f"{name}: {sentence}" for name, _, sentence in rows))


export = explained("ExportOptions")(_native.export)
home = explained("HomeConfig")(_native.home)
import_scene = explained("FileSource")(_native.import_scene)
make = explained("ProductOptions")(_native.make)
_native.Config.demo = staticmethod(explained("Overrides", "RenderChoices")(_native.Config.demo))
_native.Config.read = staticmethod(explained("Overrides", "RenderChoices")(_native.Config.read))
_native.Dataset.__doc__ = _described(_native.Dataset, _native.declared("DatasetOptions"))
_native.Scene.home = staticmethod(explained("HomeConfig")(_native.Scene.home))
_native.Scene.read = staticmethod(explained("FileSource")(_native.Scene.read))
