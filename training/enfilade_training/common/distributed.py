"""Data-parallel training on several processes: torchrun starts them, torch's DistributedDataParallel averages their gradients.

    torchrun --nproc_per_node=8 -m enfilade_training.segmentation train ...

Each process is a replica. GPUs talk by NCCL, processors by gloo. Without torchrun there is one process, and nothing to say.
"""

import os
from dataclasses import dataclass
from typing import Any

import torch
import torch.distributed as dist
from torch import nn


@dataclass(frozen=True)
class Replica:
    """One of the processes that train together."""

    rank: int
    count: int
    device: torch.device

    @property
    def is_first(self) -> bool:
        """True for the one that writes files."""
        return self.rank == 0

    def __enter__(self) -> "Replica":
        return self

    def __exit__(self, *_: object) -> None:
        if dist.is_initialized():
            dist.destroy_process_group()

    def sum(self, values: torch.Tensor) -> torch.Tensor:
        """The sum over all replicas, on each of them."""
        if self.count == 1:
            return values
        total = values.detach().clone().to(self.device)
        dist.all_reduce(total)
        return total.to(values.device)

    def gather(self, value: Any) -> list[Any]:
        """The values of all replicas, by rank, on each of them."""
        if self.count == 1:
            return [value]
        values: list[Any] = [None] * self.count
        dist.all_gather_object(values, value)
        return values

    def wait(self) -> None:
        """Returns when all replicas are here."""
        if self.count > 1:
            dist.barrier()

    def parallel(self, network: nn.Module) -> nn.Module:
        """The network whose gradients are averaged over all replicas, with synchronised batch statistics."""
        network = synchronised(network.to(self.device), self)
        if self.count == 1:
            return network
        devices = [self.device.index] if self.device.type == "cuda" else None
        return nn.parallel.DistributedDataParallel(network, device_ids=devices, broadcast_buffers=False)


def join(device: str = "auto") -> Replica:
    """Joins the processes that torchrun started, as its environment variables say; use it as a context.

    device: "cpu", "cuda", or "auto", which is CUDA where there is one.
    """
    if device not in ("auto", "cpu", "cuda"):
        raise ValueError(f"the device is {device!r}, expected 'auto', 'cpu' or 'cuda'")
    if device == "cuda" and not torch.cuda.is_available():
        raise ValueError("the device is 'cuda', but torch finds no GPU; set it to 'cpu' or 'auto', or install a torch with CUDA")
    rank, count = int(os.environ.get("RANK", "0")), int(os.environ.get("WORLD_SIZE", "1"))
    chosen = torch.device("cpu")
    if device == "cuda" or (device == "auto" and torch.cuda.is_available()):
        local = int(os.environ.get("LOCAL_RANK", "0"))
        if local >= torch.cuda.device_count():
            raise ValueError(f"process {local} of this machine has no GPU of its own: there are {torch.cuda.device_count()}")
        chosen = torch.device("cuda", local)
        torch.cuda.set_device(chosen)
    if count > 1:
        dist.init_process_group("nccl" if chosen.type == "cuda" else "gloo")
    return Replica(rank, count, chosen)


def has_bfloat16(device: torch.device) -> bool:
    """True for GPUs that compute in bfloat16; older ones emulate it, which is slower than single precision."""
    return device.type == "cuda" and torch.cuda.is_bf16_supported(including_emulation=False)


def unwrapped(network: nn.Module) -> nn.Module:
    """The network inside of DistributedDataParallel, whose names of parameters do not depend on the number of replicas."""
    return network.module if isinstance(network, nn.parallel.DistributedDataParallel) else network


def synchronised(network: nn.Module, replica: Replica) -> nn.Module:
    """Makes every BatchNorm take its statistics over the batches of all replicas; parameters keep their names and values.

    Torch's own SyncBatchNorm refuses processors, where `SyncBatchNormCpu` takes its place.
    """
    if replica.count == 1:
        return network
    if replica.device.type == "cuda":
        return nn.SyncBatchNorm.convert_sync_batchnorm(network)
    for name, child in network.named_children():
        if isinstance(child, nn.BatchNorm2d):
            setattr(network, name, SyncBatchNormCpu.of(child))
        else:
            synchronised(child, replica)
    return network


class SyncBatchNormCpu(nn.BatchNorm2d):
    """Batch normalisation over the images of all replicas, by gloo (Ioffe and Szegedy 2015, with the sums taken over replicas).

    Replicas may have different numbers of images. In evaluation it is BatchNorm2d.
    """

    @classmethod
    def of(cls, layer: nn.BatchNorm2d) -> "SyncBatchNormCpu":
        """A layer with the parameters and statistics of `layer`."""
        made = cls(layer.num_features, layer.eps, layer.momentum, layer.affine, layer.track_running_stats)
        made.to(next(layer.parameters()).dtype if layer.affine else torch.float32).load_state_dict(layer.state_dict())
        return made.train(layer.training)

    def forward(self, input: torch.Tensor) -> torch.Tensor:
        """N x C x H x W, and so is the result."""
        if not self.training:
            return super().forward(input)
        self._check_input_dim(input)
        exact = input if input.dtype == torch.float64 else input.float()
        normalised, mean, variance, count = _Normalise.apply(exact, self.eps)
        if self.track_running_stats:
            with torch.no_grad():
                self.num_batches_tracked.add_(1)
                momentum = 1.0 / float(self.num_batches_tracked) if self.momentum is None else self.momentum
                # What is kept is the unbiased variance, as in BatchNorm2d.
                unbiased = variance * (count / (count - 1.0).clamp(min=1.0))
                self.running_mean.lerp_(mean, momentum)
                self.running_var.lerp_(unbiased, momentum)
        if self.affine:
            normalised = normalised * self.weight[:, None, None] + self.bias[:, None, None]
        return normalised.to(input.dtype)


class _Normalise(torch.autograd.Function):
    """(x - mean) / sqrt(variance + eps) with statistics of all replicas; sums are taken in double precision."""

    @staticmethod
    def forward(ctx: Any, x: torch.Tensor, eps: float) -> tuple[torch.Tensor, torch.Tensor, torch.Tensor, torch.Tensor]:
        wide, axes = x.double(), (0, 2, 3)
        size = torch.full((1,), x.numel() / x.shape[1], dtype=torch.float64)
        sums = _sum_of_all(torch.cat([wide.sum(axes), size]))
        count, mean = sums[-1], sums[:-1] / sums[-1]
        # The second pass, about the mean, keeps the digits that a sum of squares would lose.
        variance = _sum_of_all((wide - mean[:, None, None]).square().sum(axes)) / count
        inverse = (variance + eps).rsqrt()
        normalised = ((wide - mean[:, None, None]) * inverse[:, None, None]).to(x.dtype)
        ctx.save_for_backward(normalised, inverse, count)
        ctx.mark_non_differentiable(mean, variance, count)
        return normalised, mean.to(x.dtype), variance.to(x.dtype), count.to(x.dtype)

    @staticmethod
    def backward(ctx: Any, gradient: torch.Tensor, *_: Any) -> tuple[torch.Tensor, None]:
        normalised, inverse, count = ctx.saved_tensors
        wide, hat, axes = gradient.double(), normalised.double(), (0, 2, 3)
        sums = _sum_of_all(torch.stack([wide.sum(axes), (wide * hat).sum(axes)])) / count
        through = wide - sums[0][:, None, None] - hat * sums[1][:, None, None]
        return (through * inverse[:, None, None]).to(gradient.dtype), None


def _sum_of_all(values: torch.Tensor) -> torch.Tensor:
    if dist.is_initialized():
        dist.all_reduce(values)
    return values
