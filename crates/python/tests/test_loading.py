"""Order, threads, worker processes and pickling change no value."""

import contextlib
import multiprocessing
import pickle
import shutil
import threading
import unittest

import enfilade
import numpy as np

import datasets

LAYERS = ["color", "depth_meters", "semantic"]


def digest(sample):
    return {key: value.tobytes() if isinstance(value, np.ndarray) else value for key, value in sample.items()}


def open_small(root=None):
    return enfilade.Dataset(root or datasets.made(), layers=LAYERS, crop=(64, 80), crop_place="random", seed=3, tone_map=True)


held = None


def take(frames):
    global held
    held = frames


def item(index):
    return digest(held[index])


class Loading(unittest.TestCase):
    def setUp(self):
        self.frames = open_small()
        self.expected = [digest(sample) for sample in self.frames]

    def test_it_is_a_sequence(self):
        self.assertEqual(len(self.frames), 3)
        self.assertEqual(digest(self.frames[-1]), self.expected[2])
        self.assertEqual(self.frames.place(0), ("home", "cam_00", 0))
        for wrong in (3, -4):
            with self.assertRaises(IndexError):
                self.frames[wrong]
        self.assertEqual([digest(sample) for sample in self.frames.__getitems__([2, 0])], [self.expected[2], self.expected[0]])

    def test_pairs_of_frames_are_indices_of_its_samples(self):
        rows = ["scene_name,first_camera_name,first_frame_id,second_camera_name,second_frame_id"]
        rows += ["home,cam_00,2,cam_00,0", "home,cam_00,1,cam_07,0", "home,cam_00,0,cam_00,1"]
        list_of_pairs = datasets.folder() / "pairs-of-people.csv"
        list_of_pairs.write_text("\n".join(rows) + "\n")
        self.assertEqual(self.frames.pairs(list_of_pairs), [(2, 0), (0, 1)])
        with self.assertRaisesRegex(FileNotFoundError, "pairs.csv"):
            self.frames.pairs()

    def test_a_subclass_gives_its_own_samples_in_batches_too(self):
        class Named(enfilade.Dataset):
            def __getitem__(self, index):
                return super().__getitem__(index) | {"name": "/".join(map(str, self.place(index)))}

        class Plain(enfilade.Dataset):
            pass

        names = [sample["name"] for sample in Named(datasets.made(), layers="color").__getitems__([2, -3])]
        self.assertEqual(names, ["home/cam_00/2", "home/cam_00/0"])
        self.assertEqual(len(Plain(datasets.made(), layers="color").__getitems__([2, 0])), 2)

    def test_relative_paths_begin_where_the_dataset_was_opened(self):
        root = datasets.folder() / "relative"
        shutil.copytree(datasets.as_hypersim(), root)
        table = root / "metadata_camera_parameters.csv"
        table.rename(root / "cameras.csv")
        with contextlib.chdir(root):
            frames = enfilade.Dataset(".", layers="depth_meters", camera_table="cameras.csv")
        again = pickle.loads(pickle.dumps(frames))
        self.assertEqual([digest(sample) for sample in frames], [digest(sample) for sample in again])
        self.assertIn("K", frames[0])

    def test_arrays_are_not_copied_and_can_be_written_to(self):
        color = self.frames[0]["color"]
        self.assertTrue(color.flags.c_contiguous and color.flags.writeable and not color.flags.owndata)
        color[...] = 0

    def test_it_is_pickled_with_its_options(self):
        self.frames.set_epoch(4)
        again = pickle.loads(pickle.dumps(self.frames))
        self.assertEqual(again.epoch, 4)
        self.assertEqual([digest(sample) for sample in again], [digest(sample) for sample in self.frames])
        self.assertNotEqual([digest(sample) for sample in again], self.expected)

    def test_worker_processes_give_the_same_samples(self):
        for _ in self.frames.loader(threads=2):  # Threads of ours must not stand in the way of a fork.
            pass
        for method in multiprocessing.get_all_start_methods():
            with multiprocessing.get_context(method).Pool(2, take, (self.frames,)) as pool:
                self.assertEqual(pool.map_async(item, range(3)).get(120), self.expected, method)

    def test_threads_give_the_same_samples(self):
        found = {}
        threads = [threading.Thread(target=lambda i=i: found.update({i: item_of(self.frames, i % 3)})) for i in range(6)]
        item_of = lambda frames, i: digest(frames[i])
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual([found[i] for i in range(6)], self.expected * 2)

    def test_loaders_give_the_samples_of_their_epoch_whatever_the_threads(self):
        passes = []
        for threads, prefetch in ((1, 1), (3, 2), (2, 100)):
            loader = self.frames.loader(shuffle=True, threads=threads, prefetch=prefetch)
            passes.append([[digest(sample) for sample in loader] for _ in range(4)])
        self.assertEqual(passes[0], passes[1])
        self.assertEqual(passes[0], passes[2])
        for epoch, samples in enumerate(passes[0]):
            self.assertEqual(sorted(sample["index"] for sample in samples), [0, 1, 2])
            self.frames.set_epoch(epoch)
            self.assertEqual(samples, [digest(self.frames[sample["index"]]) for sample in samples])
        self.assertGreater(len({tuple(sample["index"] for sample in samples) for samples in passes[0]}), 1)

    def test_batches_are_stacked_samples(self):
        loader = self.frames.loader(batch_size=2)
        self.assertEqual(len(loader), 2)
        batches = list(loader)
        self.assertEqual([len(batch["index"]) for batch in batches], [2, 1])
        for batch in batches:
            for i, index in enumerate(batch["index"]):
                one = {key: value[i] for key, value in batch.items()}
                expected = self.frames[int(index)]
                for key in [*LAYERS, "mask", "K", "world_from_camera", "window", "frame"]:
                    self.assertTrue(np.array_equal(one[key], expected[key]), key)
                self.assertEqual((one["scene"], one["camera"]), (expected["scene"], expected["camera"]))
        self.assertEqual(len(list(self.frames.loader(batch_size=2, drop_last=True))), 1)

    def test_a_loader_may_be_left_in_the_middle(self):
        iterator = iter(self.frames.loader(threads=2))
        next(iterator)
        del iterator


class Choosing(unittest.TestCase):
    def test_scenes_cameras_and_sides_of_the_split(self):
        count = len(enfilade.Dataset(datasets.made(), layers="color", scenes="ho*", cameras=["cam_00"]))
        self.assertEqual(count, 3)
        sides = [datasets.made()]
        total = 0
        for side in ("train", "val", "test"):
            try:
                total += len(enfilade.Dataset(sides[0], layers="color", split=side))
            except ValueError as error:
                self.assertIn("no complete frame", str(error))
        self.assertEqual(total, 3)


if __name__ == "__main__":
    unittest.main()
