"""A job of a farm, from Python: planned, worked at by several, and collected as one machine would have made it."""

import csv
import os
import signal
import sys
import threading
import time
import unittest
from pathlib import Path

import enfilade
from enfilade import farm

import datasets

# Adds the sum of the frame's color, which is the only frame on the node.
PROGRAM = """\
import pathlib, sys
import enfilade
root, scene, camera, frame, out = sys.argv[1:]
(sample,) = enfilade.Dataset(root, layers=["color", "semantic"])
assert (sample["scene"], sample["camera"], sample["frame"]) == (scene, camera, int(frame))
pathlib.Path(out, "sum.txt").write_text(str(float(sample["color"].sum())))
print("summed", frame)
"""


def config(**farm_settings):
    """Two small frames of the demo's room, with what nodes do besides."""
    settings = enfilade.Config.demo(frames=2, size=(48, 36), samples=1).to_dict()
    settings["name"] = "farmed"
    if farm_settings:
        settings["farm"] = farm_settings
    return enfilade.Config.from_dict(settings)


def files(root):
    """All files by path, but for those that hold times."""
    paths = [path.relative_to(root) for path in Path(root).rglob("*") if path.is_file()]
    return {path: (root / path).read_bytes() for path in paths if path.parts[0] != ".enfilade" and path.name != "manifest_times.csv"}


class Farm(unittest.TestCase):
    def test_a_job_is_planned_worked_at_and_collected(self):
        here = datasets.folder() / "farm"
        here.mkdir()
        (here / "program.py").write_text(PROGRAM)
        words = [sys.executable, str(here / "program.py"), "{frame_dir}", "{scene}", "{camera}", "{frame}", "{out_dir}"]
        made = config(after_frame=words)
        summary = enfilade.run(here / "whole", made)
        self.assertIn("after_frame", " ".join(summary["warnings"]))

        # Tasks of one frame each, since a thousandth of a second is less than any takes.
        planned = farm.plan(here / "job", made, minutes=1e-6, cpus=2, price="0.0165,licence=0.00015/core-minute")
        self.assertEqual((planned["tasks"], planned["frames"], planned["scenes"], planned["warnings"]), (2, 2, 1, []))
        hours, price = planned["vcpu_hours"], planned["prices"][0]
        self.assertAlmostEqual(price["dollars"]["mean"], hours["mean"] * (0.0165 + 0.009))
        self.assertEqual(planned["job"], str(here / "job"))
        status = farm.status(here / "job")
        self.assertEqual((status["complete"], status["missing"], status["frames_done"]), (False, [0, 1], 0))
        with self.assertRaisesRegex(ValueError, "2 of 2 tasks are not done"):
            farm.collect(here / "job", here / "early")

        written = farm.submit(here / "job", "slurm", output=here / "slurm", dry_run=True, collect=here / "out", at_once=5)
        self.assertEqual([Path(path).name for path in written["files"]], ["enfilade-farmed.0.sbatch", "enfilade-farmed.collect.sbatch"])
        self.assertIn("#SBATCH --array=0-1%5\n", Path(written["files"][0]).read_text())
        self.assertEqual(written["jobs"], [])

        records = farm.work(here / "job", 0, scratch=here / "scratch") + farm.work(here / "job", shard=(1, 2), scratch=here / "scratch")
        self.assertEqual([(record["task"], record["ended"], record["committed"]) for record in records], [(0, "done", 1), (1, "done", 1)])
        self.assertTrue(farm.status(here / "job")["complete"])
        self.assertEqual(farm.submit(here / "job", "openjd", output=here / "none"), {"files": [], "jobs": []})

        told = farm.statistics(here / "job", price="1,licence=1", table=here / "attempts.csv")
        self.assertEqual(len(told["attempts"]), 2)
        self.assertGreater(told["after_frame_vcpu_s"], 0)
        rates = told["prices"][0]["dollars_by_rate"]
        self.assertAlmostEqual(rates["machine"], told["vcpu_hours"])
        self.assertAlmostEqual(rates["machine"] + rates["licence"], told["prices"][0]["dollars"])
        with open(here / "attempts.csv", newline="") as table:
            rows = list(csv.DictReader(table))
        self.assertEqual([row["cost_cloud_dollars"] == row["cost_vray_dollars"] for row in rows], [True, True])
        self.assertEqual(farm.statistics(here / "job")["prices"], [])

        farm.collect(here / "job", here / "out")
        whole, collected = files(here / "whole"), files(here / "out")
        added = {path: content for path, content in collected.items() if "after_frame" in path.parts}
        self.assertEqual(whole, {path: content for path, content in collected.items() if path not in added})
        frame = enfilade.Dataset(here / "out", layers="color")[1]
        path = Path("scenes", frame["scene"], "_detail", frame["camera"], "after_frame", f"frame.{frame['frame']:04}", "sum.txt")
        self.assertEqual((len(added), added[path]), (2, str(float(frame["color"].sum())).encode()))

    def test_a_program_that_fails_is_told_and_costs_no_rendering(self):
        here = datasets.folder() / "failing-job"
        here.mkdir()
        (here / "program.py").write_text("import sys\nsys.exit('no weights here')\n")
        job = here / "job"
        farm.plan(job, config(after_frame=[sys.executable, str(here / "program.py")]), minutes=1e-6)
        (record,) = farm.work(job, [1], scratch=here / "scratch")
        self.assertEqual(record["ended"], "permanent")
        self.assertRegex(record["error"], "(?s)after_frame: .*exit code 1.*no weights here")
        self.assertIn("no weights here", farm.status(job)["errors"]["1"])
        (here / "program.py").write_text("")
        (record,) = farm.work(job, "1", scratch=here / "scratch")
        self.assertEqual((record["ended"], record["committed"]), ("done", 1))

    @unittest.skipIf(os.name == "nt", "Windows has no signal that a process can send to itself so")
    def test_a_worker_that_is_interrupted_keeps_its_frame(self):
        job = datasets.folder() / "interrupted-job"
        farm.plan(job, enfilade.Config.demo(frames=1, size=(64, 48), samples=4096))

        def interrupt():
            while not list(job.glob("attempts/*.json")):
                time.sleep(0.02)
            time.sleep(0.5)
            os.kill(os.getpid(), signal.SIGINT)

        threading.Thread(target=interrupt, daemon=True).start()
        with self.assertRaises(KeyboardInterrupt):
            farm.work(job, 0, scratch=datasets.folder() / "node-scratch")
        status = farm.status(job)
        self.assertEqual((status["attempts"], status["complete"]), ({"transient": 1}, False))
        self.assertEqual(len(list(job.glob("kept/*/*/*.partial"))), 1)

    def test_what_cannot_be_is_refused(self):
        folder = datasets.folder() / "wrong-job"
        for refused, said in [
            (lambda: farm.status(folder), "wrong-job does not exist"),
            (lambda: farm.plan(folder, minutes=0), "cannot take 0 minutes"),
            (lambda: farm.plan(folder, price="cheap"), "is no number, and no table.*--price 0.04"),
            (lambda: farm.submit(folder, "pbs"), "engine is \"pbs\"; expected one of slurm, kubernetes"),
            (lambda: farm.submit(folder, "kubernetes"), "image is not given"),
            (lambda: farm.work(folder), "name either tasks"),
            (lambda: farm.work(folder, 1, shard=(0, 2)), "name either tasks"),
            (lambda: farm.work(folder, shard=(2, 2)), "with i below n"),
            (lambda: farm.work(folder, "1..3"), "no range of task numbers"),
            (lambda: farm.status("ftp://x/y"), "ftp://x/y"),
            (lambda: config(after_frame=["tool", "{frmae}"]), "in `farm`: after_frame: there is no placeholder {frmae}; did you mean {frame}"),
        ]:
            with self.assertRaisesRegex(ValueError, said):
                refused()


if __name__ == "__main__":
    unittest.main()
