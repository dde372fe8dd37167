"""Checks the types of the examples and the notebooks with mypy, and the stubs against the module with its stubtest.

    python check_types.py

checks with the module that is installed. The examples are checked strictly. Notebooks use a name for one thing after another, as people do in
notebooks, and libraries without types.
"""

import json
import subprocess
import sys
import tempfile
from pathlib import Path

EXAMPLES = Path(__file__).parents[3] / "examples"
# Checked by themselves they take minutes, or have no types.
LEFT_OUT = ("torch", "torchvision", "matplotlib", "h5py", "PIL", "IPython")

# Notebooks do not say of what an empty list will be.
UNSAID = ("--disable-error-code", "var-annotated")


def code_of(notebook):
    """The code of a notebook as a script; what is no Python there, for Jupyter alone, is left out."""
    cells = [cell["source"] for cell in json.loads(notebook.read_text())["cells"] if cell["cell_type"] == "code"]
    lines = [line for cell in cells for line in "".join(cell).splitlines() + [""]]
    return "\n".join(line for line in lines if not line.lstrip().startswith(("%", "!"))) + "\n"


def run(*arguments):
    return subprocess.run([sys.executable, "-m", *arguments], check=False).returncode


def main():
    with tempfile.TemporaryDirectory() as folder:
        settings = Path(folder) / "mypy.ini"
        sections = "".join(f"[mypy-{name}.*]\nfollow_imports = skip\nignore_missing_imports = True\n" for name in LEFT_OUT)
        settings.write_text(f"[mypy]\n{sections}")
        common = ["mypy", "--config-file", str(settings), "--cache-dir", str(Path(folder) / "cache")]
        failed = run(*common, "--strict", *map(str, sorted((EXAMPLES / "python").glob("*.py"))))
        for notebook in sorted((EXAMPLES / "notebooks").glob("*.ipynb")):
            script = Path(folder) / f"notebook_{notebook.stem.replace('-', '_')}.py"
            script.write_text(code_of(notebook))
            failed |= run(*common, "--check-untyped-defs", "--allow-redefinition", *UNSAID, str(script))
        failed |= run("mypy.stubtest", "enfilade", "--mypy-config-file", str(settings), "--ignore-missing-stub")
    sys.exit(failed)


if __name__ == "__main__":
    main()
