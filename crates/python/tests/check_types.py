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
LEFT_OUT = ("tqdm", "torch", "torchvision", "matplotlib", "h5py", "PIL", "IPython")

# Notebooks do not say of what an empty list will be.
UNSAID = ("--disable-error-code", "var-annotated")

# What only stubs have: names of types. What is there otherwise than mypy can see: defaults that are more than numbers and words show as `...`
# in the signatures of functions in Rust; and the word for classes that others can extend is newer than Python 3.11.
ALLOWED = r"""
enfilade\.(CameraModel|JudgedShape|Layer|Lens|MeshComparison|Names|Path|Sample|Selected|Shape|ShapeDetection|ShapeObject|Split|Surface)
enfilade\.farm\.(Path|Price)
enfilade\.(Config\.from_dict|Confusion\.add|Dataset|Dataset\.__new__|NyuV2|compare_meshes|home|farm\.submit)
"""


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
        allowed = Path(folder) / "allowed.txt"
        allowed.write_text(ALLOWED)
        stubtest = ["mypy.stubtest", "enfilade", "--mypy-config-file", str(settings), "--ignore-missing-stub"]
        failed |= run(*stubtest, "--allowlist", str(allowed), "--ignore-unused-allowlist")
    sys.exit(failed)


if __name__ == "__main__":
    main()
