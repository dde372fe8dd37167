"""The command lines of the programs that `cargo xtask` starts."""

import argparse
import json
import sys
from pathlib import Path

import comparison

# What `cargo xtask` itself says: our programs, the folders for work, tables and the shared rooms.
GIVEN = ["bench", "program", "work", "docs", "scenes"]


def parse(program, description, names, which, more=lambda parser: None):
    """The arguments of `cargo xtask <program>`, which may name `which`, as `names`; `more` adds others."""
    parser = argparse.ArgumentParser(prog=f"cargo xtask {program}", description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument(names, nargs="*", help=f"only these {which}; the tables then go below the target folder")
    more(parser)
    for name in GIVEN:
        parser.add_argument(f"--{name}", help=argparse.SUPPRESS)
    return parser.parse_args()


def comparing(parser):
    """The options of comparisons with a peer. With any but the last, too, the tables go below the target folder."""
    parser.add_argument("--size", help="WIDTHxHEIGHT of all pictures, multiples of 16")
    parser.add_argument("--samples", type=lambda text: [int(word) for word in text.split(",")], help="samples that both render, such as 2,4,8; references have the last, or 64 if it is more")
    parser.add_argument("--config", type=json.loads, default={}, help='fields of our RenderConfig as JSON, such as {"guiding": false}, for all but references')
    parser.add_argument("--any-program", action="store_true", help="takes our references of earlier programs where there are some, for the truth has not changed")


def chosen(names, known):
    if unknown := [name for name in names if name not in known]:
        sys.exit(f"no case {unknown[0]!r}; expected some of {', '.join(known)}")
    return names or known


def sizes(job, large):
    """Sizes of a case, and with each the samples of ours and of the peer."""
    if job.size or job.samples:
        return [(job.size or comparison.SIZE, [job.samples] * 2 if job.samples else [comparison.OURS, comparison.PEER])]
    usual = [(comparison.SIZE, [comparison.OURS, comparison.PEER])]
    return usual + [(comparison.LARGE, [comparison.LARGE_OURS, comparison.LARGE_PEER])] * large


def docs(job):
    """Where tables go: what only some cases or other settings tell does not replace the tables of all."""
    return Path(job.work) / "docs" if job.cases or job.size or job.samples or job.config else Path(job.docs)
