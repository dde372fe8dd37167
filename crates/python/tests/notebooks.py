"""Runs notebooks from top to bottom, without Jupyter.

    python notebooks.py NOTEBOOK...

runs each in a temporary folder and stores in the file what its cells show: what is printed, the last value of a cell, pictures as PNG.
"""

import ast
import base64
import contextlib
import io
import json
import os
import sys
import tempfile
from pathlib import Path


def execute(notebook, name):
    """Runs the cells of a notebook in the current folder and puts what they show into it."""
    names = {"__name__": "__main__"}
    count = 0
    for number, cell in enumerate(notebook["cells"]):
        if cell["cell_type"] != "code":
            continue
        count += 1
        printed = io.StringIO()
        with contextlib.redirect_stdout(printed):
            value = evaluate("".join(cell["source"]), f"{name}, cell {number}", names)
        cell["execution_count"] = count
        cell["outputs"] = []
        if printed.getvalue():
            cell["outputs"].append({"output_type": "stream", "name": "stdout", "text": lines(printed.getvalue())})
        if value is not None:
            cell["outputs"].append({"output_type": "execute_result", "execution_count": count, "metadata": {}, "data": shown(value)})


def evaluate(source, place, names):
    """Runs a cell and gives the value of its last line, if that is an expression that does not end with a semicolon."""
    body = ast.parse(source, place).body
    last = body.pop() if body and isinstance(body[-1], ast.Expr) and not source.rstrip().endswith(";") else None
    exec(compile(ast.Module(body, []), place, "exec"), names)
    return eval(compile(ast.Expression(last.value), place, "eval"), names) if last else None


def shown(value):
    """What Jupyter would show of a value: pictures of Pillow, frames and figures of matplotlib as PNG, everything as text."""
    data = {}
    png = io.BytesIO()
    if hasattr(value, "savefig"):
        value.savefig(png, format="png", dpi=72, bbox_inches="tight")
        text = "<Figure>"
    elif hasattr(value, "getbands"):
        value.save(png, "png", optimize=True)
        text = f"<Image of {value.width} x {value.height}>"
    elif hasattr(value, "_repr_png_"):
        png.write(value._repr_png_() or b"")
        text = f"<{type(value).__name__}>"
    else:
        text = repr(value)
    if png.getvalue():
        data["image/png"] = base64.b64encode(png.getvalue()).decode() + "\n"
    return data | {"text/plain": lines(text)}


def lines(text):
    return text.splitlines(keepends=True)


def main():
    for path in map(Path, sys.argv[1:]):
        path = path.resolve()
        notebook = json.loads(path.read_text())
        with tempfile.TemporaryDirectory() as folder, contextlib.chdir(folder):
            execute(notebook, path.name)
        path.write_text(json.dumps(notebook, indent=1, ensure_ascii=False) + "\n")
        print(f"{path.name}: {path.stat().st_size / 1e3:.0f} kB")


if __name__ == "__main__":
    main()
