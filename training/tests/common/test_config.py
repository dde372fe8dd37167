import tempfile
import unittest
from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal

from enfilade_training.common import config
from enfilade_training.common.config import ConfigError


@dataclass(frozen=True)
class Inner:
    rate: float = 0.5
    sides: tuple[int, int] = (4, 4)
    kind: Literal["a", "b"] = "a"


@dataclass(frozen=True)
class Outer:
    name: str
    folder: Path | None = None
    inner: Inner = field(default_factory=Inner)
    shares: tuple[float, ...] = ()

    def __post_init__(self) -> None:
        if not self.name:
            raise ValueError("name is empty, expected a name")


class Config(unittest.TestCase):
    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.path = Path(folder.name) / "a.toml"

    def read(self, text: str, *overrides: str) -> Outer:
        self.path.write_text(text)
        return config.read(Outer, self.path, overrides)

    def refused(self, text: str, *overrides: str) -> str:
        with self.assertRaises(ConfigError) as caught:
            self.read(text, *overrides)
        return str(caught.exception)

    def test_a_file_becomes_dataclasses_and_defaults_fill_it(self) -> None:
        found = self.read('name = "x"\nshares = [1, 0.5]\n[inner]\nrate = 2\nsides = [3, 5]\n')
        self.assertEqual(found, Outer("x", None, Inner(2.0, (3, 5)), (1.0, 0.5)))
        self.assertIs(type(found.inner.rate), float)

    def test_overrides_win_and_may_be_plain_text(self) -> None:
        found = self.read('name = "x"', "inner.rate=0.25", "name=two words", "folder=out/a", "inner.sides=[1, 2]")
        self.assertEqual(found, Outer("two words", Path("out/a"), Inner(0.25, (1, 2))))

    def test_plain_data_comes_back(self) -> None:
        found = self.read('name = "x"\nfolder = "y"\n[inner]\nkind = "b"\n')
        plain = config.to_dict(found)
        self.assertEqual(plain["folder"], "y")
        self.assertEqual(config.from_dict(Outer, plain, "memory"), found)
        other = config.to_dict(self.read('name = "z"\nfolder = "y"\n'))
        self.assertEqual(config.differences(plain, other), ["inner.kind", "name"])

    def test_unknown_keys_are_refused_with_what_is_expected(self) -> None:
        said = self.refused('name = "x"\n[inner]\nrat = 1\n')
        for part in ["a.toml", "[inner]", "'rat'", "did you mean 'rate'?", "rate, sides, kind"]:
            self.assertIn(part, said)
        self.assertIn("the top level", self.refused('name = "x"\nnothing_like_it = 1\n'))

    def test_wrong_values_are_refused_with_place_and_expectation(self) -> None:
        cases = {
            "inner.rate='fast'": ["inner.rate", "'fast'", "a number"],
            "inner.rate=true": ["inner.rate", "True", "a number"],
            "inner.sides=[1]": ["inner.sides", "2 values"],
            "inner.sides=[1, 2.5]": ["inner.sides.1", "2.5", "a whole number"],
            "inner.kind='c'": ["inner.kind", "'c'", "'a', 'b'"],
            "inner=3": ["inner", "a table"],
            "name=''": ["name is empty"],
            "name": ["--set name", "table.key=value"],
        }
        for override, parts in cases.items():
            said = self.refused('name = "x"', override)
            for part in parts:
                self.assertIn(part, said)

    def test_a_missing_key_or_file_and_broken_toml_are_named(self) -> None:
        self.assertIn("lacks the key 'name', expected a text", self.refused(""))
        self.assertIn("is no TOML", self.refused("name = "))
        with self.assertRaisesRegex(ConfigError, "nothing.toml: cannot be read"):
            config.read(Outer, self.path.with_name("nothing.toml"))


if __name__ == "__main__":
    unittest.main()
