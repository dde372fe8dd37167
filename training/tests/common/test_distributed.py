import tempfile
import unittest
from pathlib import Path
from typing import Any
from unittest import mock

import torch
from torch import nn

from enfilade_training.common import distributed
from enfilade_training.common.distributed import Replica
from tests.ranks import run_on_ranks

STEPS = 3


def network() -> nn.Sequential:
    torch.manual_seed(1)
    layers = nn.Sequential(nn.Conv2d(3, 4, 3, padding=1), nn.BatchNorm2d(4), nn.ReLU(), nn.Conv2d(4, 2, 1), nn.BatchNorm2d(2))
    nn.init.uniform_(layers[1].weight, 0.5, 1.5)
    nn.init.uniform_(layers[1].bias, -1, 1)
    return layers.double()


def images() -> torch.Tensor:
    return torch.randn(STEPS, 6, 3, 5, 4, dtype=torch.float64, generator=torch.Generator().manual_seed(2)) * 3 + 10


def train(replica: Replica, shares: list[tuple[int, int]]) -> dict[str, Any]:
    """Some steps on this replica's share of each batch; the loss is the sum over the batch's images."""
    model = replica.parallel(network())
    optimizer = torch.optim.SGD(model.parameters(), lr=0.001, momentum=0.9)
    first, last = shares[replica.rank]
    for batch in images():
        part = batch[first:last].requires_grad_()
        # DistributedDataParallel averages gradients, and the sum is asked for.
        loss = model(part).pow(3).sum() * replica.count
        optimizer.zero_grad()
        loss.backward()
        optimizer.step()
    model.eval()
    with torch.no_grad():
        evaluated = model(images()[0])
    state = {name: value.clone() for name, value in distributed.unwrapped(model).state_dict().items()}
    # The gradient at the images does not go through the averaging.
    return {"state": state, "evaluated": evaluated, "input": part.grad / replica.count, "sum": float(replica.sum(torch.tensor(replica.rank + 1.0)))}


class Devices(unittest.TestCase):
    def test_emulated_bfloat16_does_not_count(self) -> None:
        for native in (True, False):
            with mock.patch("torch.cuda.is_bf16_supported", lambda including_emulation=True: native or including_emulation):
                self.assertEqual(distributed.has_bfloat16(torch.device("cuda")), native)
                self.assertFalse(distributed.has_bfloat16(torch.device("cpu")))


class SynchronisedStatistics(unittest.TestCase):
    def compare(self, shares: list[tuple[int, int]]) -> None:
        with tempfile.TemporaryDirectory() as folder:
            ranks = run_on_ranks("tests.common.test_distributed", "train", len(shares), Path(folder), shares=shares)
        whole = train(Replica(0, 1, torch.device("cpu")), [(0, 6)])
        for rank in ranks:
            self.assertEqual(rank["sum"], 3.0)
            self.assertEqual(rank["state"].keys(), whole["state"].keys())
            for name, value in whole["state"].items():
                torch.testing.assert_close(rank["state"][name], value, rtol=1e-9, atol=1e-12, msg=lambda text: f"{name}: {text}")
            torch.testing.assert_close(rank["evaluated"], whole["evaluated"], rtol=1e-9, atol=1e-9)
        torch.testing.assert_close(torch.cat([rank["input"] for rank in ranks]), whole["input"], rtol=1e-9, atol=1e-9)

    def test_two_replicas_train_like_one_process_with_the_whole_batch(self) -> None:
        torch.set_num_threads(1)
        self.compare([(0, 3), (3, 6)])

    def test_replicas_may_have_different_numbers_of_images(self) -> None:
        self.compare([(0, 1), (1, 6)])

    def test_the_gradient_is_that_of_finite_differences(self) -> None:
        layer = distributed._Normalise.apply
        x = torch.randn(3, 2, 2, 2, dtype=torch.float64, generator=torch.Generator().manual_seed(3), requires_grad=True)
        self.assertTrue(torch.autograd.gradcheck(lambda x: layer(x, 1e-5)[0], (x,)))

    def test_one_process_keeps_torchs_layers(self) -> None:
        layers = distributed.synchronised(network(), Replica(0, 1, torch.device("cpu")))
        self.assertIs(type(layers[1]), nn.BatchNorm2d)

    def test_the_layer_alone_is_batch_normalisation(self) -> None:
        ours = distributed.SyncBatchNormCpu.of(network()[1].float())
        theirs = network()[1].float()
        for momentum in [0.1, None]:
            ours.momentum = theirs.momentum = momentum
            for batch in torch.randn(4, 5, 4, 3, 3, generator=torch.Generator().manual_seed(4)) * 2 + 5:
                torch.testing.assert_close(ours(batch), theirs(batch), rtol=1e-5, atol=1e-5)
            for name, value in theirs.state_dict().items():
                torch.testing.assert_close(ours.state_dict()[name], value, rtol=1e-5, atol=1e-6)


class Joining(unittest.TestCase):
    def test_without_torchrun_there_is_one_process(self) -> None:
        with distributed.join("cpu") as replica:
            self.assertEqual((replica.rank, replica.count, replica.device.type), (0, 1, "cpu"))
            self.assertTrue(replica.is_first)
            self.assertEqual(replica.gather({"a": 1}), [{"a": 1}])

    def test_devices_that_are_not_there_are_refused(self) -> None:
        with self.assertRaisesRegex(ValueError, "'tpu', expected 'auto', 'cpu' or 'cuda'"):
            distributed.join("tpu")
        with mock.patch.object(torch.cuda, "is_available", return_value=False), self.assertRaisesRegex(ValueError, "finds no GPU"):
            distributed.join("cuda")


if __name__ == "__main__":
    unittest.main()
