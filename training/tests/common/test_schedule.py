import unittest

import torch
from torch.optim.lr_scheduler import CosineAnnealingLR, LinearLR, MultiStepLR, SequentialLR

from enfilade_training.common.schedule import one_cycle_cosine, set_learning_rate, warmup_steps


def paper(epoch: float) -> float:
    return one_cycle_cosine(epoch, base=0.01, epochs=100, warmup_epochs=3)


class Schedule(unittest.TestCase):
    def test_known_values_of_the_papers_recipe(self) -> None:
        for epoch, rate in [(0, 1e-5), (1, 0.00334), (2, 0.00667), (3, 0.01), (51.5, 0.005), (99, 2.622e-6), (100, 0.0)]:
            self.assertAlmostEqual(paper(epoch), rate, delta=1e-8)

    def test_it_is_torchs_linear_warm_up_and_cosine(self) -> None:
        optimizer = torch.optim.SGD([torch.nn.Parameter(torch.zeros(1))], lr=0.01)
        parts = [LinearLR(optimizer, start_factor=1e-3, total_iters=3), CosineAnnealingLR(optimizer, T_max=97)]
        reference = SequentialLR(optimizer, parts, milestones=[3])
        for epoch in range(100):
            self.assertAlmostEqual(paper(epoch), optimizer.param_groups[0]["lr"], delta=1e-12)
            optimizer.step()
            reference.step()

    def test_it_rises_to_the_base_and_falls_to_zero_without_jumps(self) -> None:
        rates = [paper(i / 50) for i in range(5001)]
        peak = rates.index(max(rates))
        self.assertEqual(peak, 150)
        self.assertEqual(rates[: peak + 1], sorted(rates[: peak + 1]))
        self.assertEqual(rates[peak:], sorted(rates[peak:], reverse=True))
        self.assertLess(max(abs(b - a) for a, b in zip(rates, rates[1:])), 0.01 / 100)

    def test_without_warm_up_it_begins_at_the_base(self) -> None:
        self.assertEqual(one_cycle_cosine(0, base=0.02, epochs=10, warmup_epochs=0), 0.02)
        self.assertEqual(one_cycle_cosine(2, base=0.02, epochs=2, warmup_epochs=2), 0.02)

    def test_steps_are_torchs_after_the_warm_up(self) -> None:
        optimizer = torch.optim.SGD([torch.nn.Parameter(torch.zeros(1))], lr=0.02)
        reference = MultiStepLR(optimizer, [80, 100], gamma=0.1)
        for iteration in range(120):
            rate = warmup_steps(iteration, base=0.02, warmup_iterations=10, milestones=[80, 100])
            warmup = 0.1 + 0.9 * iteration / 10 if iteration < 10 else 1.0
            self.assertAlmostEqual(rate, warmup * optimizer.param_groups[0]["lr"], delta=1e-12)
            optimizer.step()
            reference.step()

    def test_all_groups_get_the_rate(self) -> None:
        optimizer = torch.optim.SGD([{"params": [torch.nn.Parameter(torch.zeros(1))]} for _ in range(2)], lr=1.0)
        set_learning_rate(optimizer, 0.125)
        self.assertEqual([group["lr"] for group in optimizer.param_groups], [0.125, 0.125])


if __name__ == "__main__":
    unittest.main()
