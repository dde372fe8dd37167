import pickle
import unittest

import enfilade
import numpy as np


def by_numpy(prediction, truth, classes):
    known = truth != -1
    return np.bincount(truth[known] * classes + prediction[known], minlength=classes**2).reshape(classes, classes)


class Confusion(unittest.TestCase):
    def setUp(self):
        random = np.random.default_rng(1)
        self.truth = random.integers(-1, 13, (4, 37, 53))
        # Half of the predictions are right; class 12 is never predicted.
        self.prediction = np.where(random.random(self.truth.shape) < 0.5, self.truth, random.integers(0, 12, self.truth.shape)).clip(0, 11)

    def test_counts_and_scores_are_numpys(self):
        scores = enfilade.Confusion(13)
        for prediction, truth in zip(self.prediction, self.truth):
            scores.add(prediction, truth)
        matrix = by_numpy(self.prediction, self.truth, 13)
        np.testing.assert_array_equal(scores.counts, matrix)
        iou = np.diag(matrix) / (matrix.sum(0) + matrix.sum(1) - np.diag(matrix))
        np.testing.assert_allclose(scores.iou, iou, rtol=1e-15)
        self.assertAlmostEqual(scores.mean_iou, iou.mean(), places=14)
        self.assertAlmostEqual(scores.pixel_accuracy, np.trace(matrix) / matrix.sum(), places=14)
        self.assertEqual((scores.pixels, scores.classes), (matrix.sum(), 13))

    def test_integers_of_every_type_and_order_count_alike(self):
        expected = by_numpy(self.prediction, self.truth, 13)
        for signed, unsigned in ((np.int8, np.uint8), (np.int16, np.uint16), (np.int32, np.uint32), (np.int64, np.uint64)):
            scores = enfilade.Confusion(13)
            scores.add(self.prediction.astype(unsigned)[:, ::-1], self.truth.astype(signed)[:, ::-1])
            np.testing.assert_array_equal(scores.counts, expected)
        scores = enfilade.Confusion(13)
        scores.add(self.prediction.astype(np.uint16), np.where(self.truth < 0, 255, self.truth).astype(np.uint8), ignore=255)
        np.testing.assert_array_equal(scores.counts, expected)

    def test_arrays_in_fortrans_order_count_pixel_by_pixel(self):
        expected = by_numpy(self.prediction, self.truth, 13)
        for prediction, truth in ((self.prediction, np.asfortranarray(self.truth)), (np.asfortranarray(self.prediction), self.truth)):
            scores = enfilade.Confusion(13)
            scores.add(prediction, truth)
            np.testing.assert_array_equal(scores.counts, expected)

    def test_matrices_are_merged_pickled_and_made_of_counts(self):
        parts = [enfilade.Confusion(13) for _ in range(2)]
        for part, images in zip(parts, (slice(0, 1), slice(1, 4))):
            part.add(self.prediction[images], self.truth[images])
        counts = sum(part.counts for part in parts)
        parts[0].merge(parts[1])
        np.testing.assert_array_equal(parts[0].counts, counts)
        np.testing.assert_array_equal(counts, by_numpy(self.prediction, self.truth, 13))
        self.assertEqual(enfilade.Confusion(13, counts).mean_iou, parts[0].mean_iou)
        np.testing.assert_array_equal(pickle.loads(pickle.dumps(parts[0])).counts, counts)

    def test_classes_that_do_not_occur_do_not_count(self):
        scores = enfilade.Confusion(3)
        self.assertEqual((scores.mean_iou, scores.pixel_accuracy, scores.iou), (None, None, [None] * 3))
        scores.add(np.array([0, 0, 1]), np.array([0, 1, 1]))
        self.assertEqual((scores.iou, scores.mean_iou), ([0.5, 0.5, None], 0.5))
        self.assertIn("mean IoU 0.5000", repr(scores))

    def test_what_is_no_class_is_refused(self):
        scores, right = enfilade.Confusion(3), np.array([0, 1, 2])
        cases = [
            ((np.array([0, 1, 3]), right), ValueError, "prediction 3 at place 2 is no class: expected 0 to 2"),
            ((right, np.array([0, 7, -1])), ValueError, "true class 7 at place 1"),
            ((right, np.array([0, 2**64 - 1, 1], dtype=np.uint64)), ValueError, "true class .* at place 1"),
            ((right, np.array([[0, 1, 2]])), ValueError, "expected the same"),
            ((right.astype(float), right), TypeError, "an array of float64; expected a numpy array of integers"),
            (([0, 1], right), TypeError, "prediction is a .*list"),
        ]
        for arguments, error, said in cases:
            with self.assertRaisesRegex(error, said):
                scores.add(*arguments)
        self.assertEqual(scores.pixels, 0)
        for arguments, said in [((0,), "expected 1 to"), ((2, np.zeros((3, 3), dtype=np.int64)), "expected \\(2, 2\\)"), ((2, np.full((2, 2), -1)), "negative")]:
            with self.assertRaisesRegex(ValueError, said):
                enfilade.Confusion(*arguments)
        with self.assertRaisesRegex(ValueError, "a matrix of 2 classes, expected 3"):
            scores.merge(enfilade.Confusion(2))


if __name__ == "__main__":
    unittest.main()
