"""How far long work has come: a bar of tqdm where that is installed, else a line on standard error."""

import sys


def bar(progress, title):
    """A bar, or None. `progress` asks for one (True) or for none (False); None shows it in notebooks and terminals."""
    if progress is None:
        progress = _in_notebook() or (sys.stderr is not None and sys.stderr.isatty())
    if not progress:
        return None
    try:
        from tqdm.auto import tqdm
    except ImportError:
        return _Line(title)
    return _Bar(tqdm, title)


def _in_notebook():
    ipython = sys.modules.get("IPython")
    shell = ipython.get_ipython() if ipython is not None else None
    return shell is not None and "IPKernelApp" in shell.config


class _Bar:
    """One of tqdm, which starts again with each part of the work."""

    FORMAT = "{desc}{percentage:3.0f}%|{bar}| {elapsed}<{remaining}"

    def __init__(self, tqdm, title):
        self._title = title
        self._part = None
        self._bar = tqdm(total=1, desc=title, bar_format=self.FORMAT)

    def update(self, what, done, total):
        if self._part != (what, total):
            self._part = (what, total)
            self._bar.set_description(f"{self._title}: {what}", refresh=False)
            self._bar.reset(total=max(total, 1))
        self._bar.n = done
        self._bar.refresh()

    def close(self, whole):
        if whole:
            self._bar.set_description(self._title, refresh=False)
            self._bar.n = self._bar.total
            self._bar.refresh()
        self._bar.close()


class _Line:
    """A line that is written over and over."""

    def __init__(self, title):
        self._title = title
        self._length = 0

    def update(self, what, done, total):
        self._write(f"{self._title}: {what} {100 * done // max(total, 1)} %")

    def close(self, whole):
        if whole:
            self._write(f"{self._title}: done")
        if self._length:
            print(file=sys.stderr)

    def _write(self, text):
        print("\r" + text.ljust(self._length), end="", file=sys.stderr, flush=True)
        self._length = len(text)
