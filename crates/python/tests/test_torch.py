"""torch's DataLoader takes the dataset as it is, with and without worker processes."""

import importlib.util
import multiprocessing
import unittest

import enfilade
import numpy as np

import datasets

HAS_TORCH = importlib.util.find_spec("torch") is not None
if HAS_TORCH:
    import torch
    from torch.utils.data import DataLoader

LAYERS = ["color", "depth_meters", "semantic"]
ARRAYS = [*LAYERS, "mask", "K", "world_from_camera"]


@unittest.skipUnless(HAS_TORCH, "torch is not installed")
class TorchDataLoader(unittest.TestCase):
    def setUp(self):
        self.frames = enfilade.Dataset(datasets.made(), layers=LAYERS, crop=(64, 80), crop_place="random", seed=3, tone_map=True)

    def check(self, batch, indices):
        for key in ARRAYS:
            expected = torch.from_numpy(np.stack([self.frames[i][key] for i in indices]))
            self.assertEqual(batch[key].dtype, expected.dtype)
            self.assertTrue(torch.equal(batch[key], expected), key)
        self.assertEqual(batch["index"].tolist(), indices)
        self.assertEqual(batch["scene"], [self.frames[i]["scene"] for i in indices])

    def test_batches_are_the_same_whatever_starts_the_workers(self):
        for _ in self.frames.loader(threads=2):  # Threads of ours must not stand in the way of a fork.
            pass
        plain = list(DataLoader(self.frames, batch_size=2))
        self.assertEqual([len(batch["index"]) for batch in plain], [2, 1])
        for method in [None, *multiprocessing.get_all_start_methods()]:
            with self.subTest(method):
                workers = {} if method is None else {"num_workers": 2, "multiprocessing_context": method}
                batches = list(DataLoader(self.frames, batch_size=2, **workers))
                self.assertEqual(len(batches), 2)
                self.check(batches[0], [0, 1])
                self.check(batches[1], [2])

    def test_shuffled_batches_are_those_of_the_generator(self):
        order = torch.randperm(3, generator=torch.Generator().manual_seed(5)).tolist()
        for workers in (0, 2):
            sampler = torch.utils.data.SubsetRandomSampler(range(3), generator=torch.Generator().manual_seed(5))
            found = [batch["index"].item() for batch in DataLoader(self.frames, sampler=sampler, num_workers=workers)]
            self.assertEqual(found, order)

    def test_the_epoch_reaches_the_workers(self):
        windows = []
        for epoch in (0, 1):
            self.frames.set_epoch(epoch)
            for workers in (0, 2):
                batch = next(iter(DataLoader(self.frames, batch_size=3, num_workers=workers)))
                windows.append([side.tolist() for side in batch["window"]])
        self.assertEqual(windows[0], windows[1])
        self.assertEqual(windows[2], windows[3])
        self.assertNotEqual(windows[0], windows[2])

    def test_batches_of_a_subclass_are_of_its_own_samples(self):
        class Brighter(enfilade.Dataset):
            def __getitem__(self, index):
                sample = super().__getitem__(index)
                return sample | {"color": 2 * sample["color"]}

        batch = next(iter(DataLoader(Brighter(datasets.made(), layers="color"), batch_size=3)))
        plain = enfilade.Dataset(datasets.made(), layers="color")
        self.assertTrue(torch.equal(batch["color"], torch.from_numpy(np.stack([2 * sample["color"] for sample in plain]))))

    def test_batches_of_ours_become_tensors_without_a_copy(self):
        batch = next(iter(self.frames.loader(batch_size=3)))
        self.check({key: torch.from_numpy(batch[key]) for key in [*ARRAYS, "index"]} | {"scene": batch["scene"]}, [0, 1, 2])
        tensor = torch.from_numpy(batch["color"])
        tensor[0, 0, 0, 0] = 17
        self.assertEqual(batch["color"][0, 0, 0, 0], 17)


if __name__ == "__main__":
    unittest.main()
