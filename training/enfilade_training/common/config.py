"""Settings of an experiment: one TOML file becomes one tree of dataclasses.

The fields of the dataclasses are the keys that there are; a field without a default must be given. Known types are bool, int, float,
str, Path, Literal, `X | None`, `tuple[X, ...]`, `tuple[X, Y]`, and dataclasses, which are tables. Whatever does not fit is a
`ConfigError` that names the file, the key, what was found and what was expected.
"""

import dataclasses
import difflib
import tomllib
import types
import typing
from pathlib import Path
from typing import Any


class ConfigError(ValueError):
    """Settings that cannot be used."""


def read(cls: type, path: str | Path, overrides: typing.Sequence[str] = ()) -> Any:
    """Reads `path` into an instance of the dataclass `cls`.

    overrides: of the form `table.key=value`, as after `--set`; the value is TOML, or else taken as text. Paths are taken as they are
    written, so they start from the folder in which the program runs.
    """
    path = Path(path)
    try:
        settings = tomllib.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise ConfigError(f"{path}: cannot be read ({error.strerror}); name a TOML file, such as one of training/configs") from error
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise ConfigError(f"{path}: is no TOML ({error})") from error
    for override in overrides:
        _override(settings, override)
    return from_dict(cls, settings, str(path))


def from_dict(cls: type, settings: dict[str, Any], source: str) -> Any:
    """Makes an instance of the dataclass `cls`; `source` stands at the beginning of messages."""
    return _table(cls, settings, source, ())


def to_dict(config: Any) -> dict[str, Any]:
    """Plain data of an instance: dictionaries, lists, numbers, texts and None."""
    return _plain(dataclasses.asdict(config))


def differences(a: dict[str, Any], b: dict[str, Any], prefix: str = "") -> list[str]:
    """The keys at which two results of `to_dict` differ, as `table.key`."""
    found = []
    for key in sorted(a.keys() | b.keys()):
        one, other = a.get(key), b.get(key)
        if isinstance(one, dict) and isinstance(other, dict):
            found += differences(one, other, f"{prefix}{key}.")
        elif one != other:
            found.append(prefix + key)
    return found


def _override(settings: dict[str, Any], override: str) -> None:
    name, equals, text = override.partition("=")
    keys = name.strip().split(".")
    if not equals or not all(keys):
        raise ConfigError(f"--set {override}: expected table.key=value, such as --set train.epochs=2")
    try:
        value = tomllib.loads(f"value = {text}")["value"]
    except tomllib.TOMLDecodeError:
        value = text
    for key in keys[:-1]:
        settings = settings.setdefault(key, {})
        if not isinstance(settings, dict):
            raise ConfigError(f"--set {override}: {key!r} is a value and no table")
    settings[keys[-1]] = value


def _table(cls: type, settings: dict[str, Any], source: str, place: tuple[str, ...]) -> Any:
    hints = typing.get_type_hints(cls)
    fields = {field.name: field for field in dataclasses.fields(cls)}
    where = f"[{'.'.join(place)}]" if place else "the top level"
    for key in settings:
        if key not in fields:
            near = difflib.get_close_matches(key, fields, n=1)
            guess = f"; did you mean {near[0]!r}? It is" if near else ", expected"
            raise ConfigError(f"{source}: {where} has the unknown key {key!r}{guess} one of {', '.join(fields)}")
    values = {}
    for name, field in fields.items():
        if name in settings:
            values[name] = _value(hints[name], settings[name], source, (*place, name))
        elif field.default is dataclasses.MISSING and field.default_factory is dataclasses.MISSING:
            raise ConfigError(f"{source}: {where} lacks the key {name!r}, expected {_expected(hints[name])}")
    try:
        return cls(**values)
    except ConfigError:
        raise
    except ValueError as error:
        raise ConfigError(f"{source}: {where}: {error}") from error


def _value(hint: Any, found: Any, source: str, place: tuple[str, ...]) -> Any:
    def wrong() -> ConfigError:
        return ConfigError(f"{source}: {'.'.join(place)} is {found!r}, expected {_expected(hint)}")

    origin, arguments = typing.get_origin(hint), typing.get_args(hint)
    if origin in (types.UnionType, typing.Union):
        kinds = [kind for kind in arguments if kind is not type(None)]
        return None if found is None else _value(kinds[0], found, source, place)
    if origin is typing.Literal:
        if found not in arguments or isinstance(found, bool) != any(isinstance(value, bool) for value in arguments):
            raise wrong()
        return found
    if origin is tuple:
        if not isinstance(found, list | tuple):
            raise wrong()
        kinds = [arguments[0]] * len(found) if arguments[-1] is Ellipsis else arguments
        if len(kinds) != len(found):
            raise wrong()
        return tuple(_value(kind, value, source, (*place, str(i))) for i, (kind, value) in enumerate(zip(kinds, found)))
    if dataclasses.is_dataclass(hint):
        if not isinstance(found, dict):
            raise wrong()
        return _table(hint, found, source, place)
    if hint is float and isinstance(found, int | float) and not isinstance(found, bool):
        return float(found)
    if hint is Path and isinstance(found, str):
        return Path(found)
    if isinstance(found, bool) != (hint is bool) or not isinstance(found, hint):
        raise wrong()
    return found


def _expected(hint: Any) -> str:
    origin, arguments = typing.get_origin(hint), typing.get_args(hint)
    if origin in (types.UnionType, typing.Union):
        return _expected(next(kind for kind in arguments if kind is not type(None)))
    if origin is typing.Literal:
        return "one of " + ", ".join(map(repr, arguments))
    if origin is tuple:
        return f"a list of {_expected(arguments[0])}" if arguments[-1] is Ellipsis else f"a list of {len(arguments)} values"
    names = {bool: "true or false", int: "a whole number", float: "a number", str: "a text", Path: "a path"}
    return names.get(hint, "a table")


def _plain(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _plain(entry) for key, entry in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(entry) for entry in value]
    return str(value) if isinstance(value, Path) else value
