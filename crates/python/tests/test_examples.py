"""The examples of examples/python run, small."""

import contextlib
import importlib.util
import io
import unittest
from pathlib import Path

import datasets

FOLDER = Path(__file__).parents[3] / "examples/python"


def example(name):
    spec = importlib.util.spec_from_file_location(name, FOLDER / f"{name}.py")
    module = importlib.util.module_from_spec(spec)
    with contextlib.redirect_stdout(io.StringIO()):
        spec.loader.exec_module(module)
    return module


class Examples(unittest.TestCase):
    def test_every_example_is_run_here(self):
        names = {path.stem for path in FOLDER.glob("*.py")}
        self.assertEqual(names, {"render_in_memory", "your_own_camera", "load_for_training"})

    def test_depth_k_and_pose_agree_with_position(self):
        output, said = datasets.folder() / "in_memory.png", io.StringIO()
        with contextlib.redirect_stdout(said):
            frame = example("render_in_memory").main(output, (64, 48))
        self.assertTrue(output.read_bytes().startswith(b"\x89PNG"))
        self.assertLess(abs(example("render_in_memory").points_of(frame) - frame["position"]).max(), 1e-4)
        self.assertIn("parts are seen", said.getvalue())

    def test_a_walk_of_a_calibrated_camera(self):
        with contextlib.redirect_stdout(io.StringIO()):
            frames = example("your_own_camera").main(size=(64, 48), steps=2, samples=1)
        self.assertEqual([frame["optical_flow"].shape for frame in frames], [(48, 64, 2)] * 2)

    def test_batches_for_training(self):
        with contextlib.redirect_stdout(io.StringIO()):
            self.assertEqual(example("load_for_training").main(datasets.folder() / "training", (64, 48)), 2)


if __name__ == "__main__":
    unittest.main()
