"""The command lines of the programs that `cargo xtask` starts."""

import argparse

# What `cargo xtask` itself says: our programs, the folders for work, tables and the shared rooms.
GIVEN = ["measure", "exporter", "program", "work", "docs", "scenes"]


def parse(program, description, names, which):
    """The arguments of `cargo xtask <program>`, which may name `which`, as `names`."""
    parser = argparse.ArgumentParser(prog=f"cargo xtask {program}", description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument(names, nargs="*", help=f"only these {which}; the tables then go below the target folder")
    for name in GIVEN:
        parser.add_argument(f"--{name}", help=argparse.SUPPRESS)
    return parser.parse_args()
