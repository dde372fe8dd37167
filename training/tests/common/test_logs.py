import tempfile
import unittest
from pathlib import Path

import torch

from enfilade_training.common import logs


class Logging(unittest.TestCase):
    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.lines = self.folder / "metrics.jsonl"

    def test_numbers_become_lines_and_scalars(self) -> None:
        with logs.Logs(self.folder) as log:
            log.write("train", 1, {"loss": 0.5, "note": "x"})
            log.scalar("images_per_second", 1, 12.0)
            log.picture("sample", 1, torch.zeros(3, 4, 4, dtype=torch.uint8))
        self.assertEqual(logs.read(self.lines), [{"kind": "train", "step": 1, "loss": 0.5, "note": "x"}])
        from tensorboard.backend.event_processing.event_accumulator import EventAccumulator

        events = EventAccumulator(str(self.folder / "tensorboard"))
        events.Reload()
        self.assertEqual([(event.step, event.value) for event in events.Scalars("train/loss")], [(1, 0.5)])
        self.assertEqual(events.Tags()["images"], ["sample"])

    def test_a_resumed_run_drops_what_lies_beyond_its_checkpoint(self) -> None:
        with logs.Logs(self.folder) as log:
            for step in range(1, 5):
                log.write("train", step, {"loss": 1.0 / step})
        whole = self.lines.read_text()
        self.lines.write_text(whole + '{"kind": "tra')
        with logs.Logs(self.folder, step=2) as log:
            for step in range(3, 5):
                log.write("train", step, {"loss": 1.0 / step})
        self.assertEqual(self.lines.read_text(), whole)


if __name__ == "__main__":
    unittest.main()
