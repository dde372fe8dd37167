"""The package brings the command `enfilade`, as the program in Rust is."""

import os
import signal
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

import enfilade


def command(*words, **options):
    return subprocess.run([sys.executable, "-m", "enfilade", *words], capture_output=True, text=True, **options)


class Command(unittest.TestCase):
    def test_it_says_its_version_and_its_exit_codes_are_the_programs(self):
        done = command("--version")
        self.assertEqual((done.returncode, done.stdout), (0, f"enfilade {enfilade.__version__}\n"))
        self.assertEqual(command("nonsense").returncode, 2)
        missing = command("import", "gone.glb", "--check")
        self.assertEqual(missing.returncode, 1)
        self.assertIn("gone.glb", missing.stderr)

    def test_a_job_of_slurm_starts_the_command_that_is_on_the_path(self):
        with tempfile.TemporaryDirectory() as folder:
            planned = command("farm", "plan", "--demo", "--frames", "1", "--size", "32x24", "--samples", "1", "-o", "job", cwd=folder)
            self.assertEqual(planned.returncode, 0, planned.stderr)
            done = command("farm", "submit", "job", "--engine", "slurm", "--dry-run", cwd=folder)
            self.assertEqual(done.returncode, 0, done.stderr)
            (script,) = Path(folder).glob("*.sbatch")
            self.assertIn("\nenfilade --threads ", script.read_text())

    def test_its_advice_names_the_command_and_not_the_interpreter(self):
        with tempfile.TemporaryDirectory() as folder:
            done = command("run", "--demo", "out", "--frames", "1", "--size", "32x24", "--samples", "1", cwd=folder)
            self.assertIn(" enfilade run --demo out2 ", done.stdout)

    @unittest.skipIf(os.name == "nt", "Windows has no signal that a process can send to another so")
    def test_ctrl_c_ends_it_at_once(self):
        with tempfile.TemporaryDirectory() as folder:
            words = [sys.executable, "-m", "enfilade", "run", "--demo", "out", "--samples", "4096"]
            running = subprocess.Popen(words, cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            time.sleep(2)
            running.send_signal(signal.SIGINT)
            self.assertEqual(running.wait(timeout=10), -signal.SIGINT)
