"""The heads of Mesh R-CNN beyond Mask R-CNN: depth extent, voxels, and the refinement of meshes by graph convolutions."""

import math

import torch
import torch.nn.functional as F
from torch import nn

from .meshes import Meshes


class DepthHead(nn.Module):
    """Two layers, then the logarithm of the depth extent per pixel of the region's height, for each class."""

    def __init__(self, channels: int, side: int, classes: int, width: int = 1024):
        super().__init__()
        self.layers = nn.Sequential(nn.Flatten(), nn.Linear(channels * side * side, width), nn.ReLU(), nn.Linear(width, width), nn.ReLU())
        self.predictor = nn.Linear(width, classes)
        for layer in self.layers:
            if isinstance(layer, nn.Linear):
                nn.init.kaiming_uniform_(layer.weight, a=1)
                nn.init.zeros_(layer.bias)
        nn.init.normal_(self.predictor.weight, std=0.001)
        nn.init.zeros_(self.predictor.bias)

    def forward(self, features: torch.Tensor) -> torch.Tensor:
        """N x classes of features N x C x side x side."""
        return self.predictor(self.layers(features))

    @staticmethod
    def extent(predicted: torch.Tensor) -> torch.Tensor:
        """The extent itself, bounded as in the original."""
        return predicted.clamp(max=math.log(1000.0 / 16)).exp()


class VoxelHead(nn.Module):
    """Four convolutions, one that doubles the side, and a logit for each voxel along z: N x 2 side x 2 side x 2 side."""

    def __init__(self, channels: int, depth: int, convolutions: int = 4, width: int = 256):
        super().__init__()
        layers: list[nn.Module] = []
        for i in range(convolutions):
            layers += [nn.Conv2d(channels if i == 0 else width, width, 3, padding=1), nn.ReLU()]
        layers += [nn.ConvTranspose2d(width if convolutions else channels, width, 2, stride=2), nn.ReLU()]
        self.layers = nn.Sequential(*layers)
        self.predictor = nn.Conv2d(width, depth, 1)
        for layer in self.layers:
            if isinstance(layer, nn.Conv2d | nn.ConvTranspose2d):
                nn.init.kaiming_normal_(layer.weight, mode="fan_out", nonlinearity="relu")
                nn.init.zeros_(layer.bias)
        nn.init.normal_(self.predictor.weight, std=0.001)
        nn.init.zeros_(self.predictor.bias)

    def forward(self, features: torch.Tensor) -> torch.Tensor:
        """Logits by z, y, x of features N x C x side x side."""
        return self.predictor(self.layers(features))


def vert_align(features: torch.Tensor, meshes: Meshes) -> torch.Tensor:
    """The features (N x C x H x W) under each vertex of N meshes, V x C: bilinear between the middles of the outermost pixels, which lie
    at -1 and 1; beyond these, as at the border."""
    sampled = []
    for map_, vertices in zip(features, meshes.vertices.split(meshes.counts)):
        if not len(vertices):
            continue
        grid = vertices[None, :, None, :2].to(map_.dtype)
        taken = F.grid_sample(map_[None], grid, mode="bilinear", padding_mode="border", align_corners=True)
        sampled.append(taken[0, :, :, 0].t())
    return torch.cat(sampled) if sampled else features.new_zeros(0, features.shape[1])


class GraphConvolution(nn.Module):
    """W0 x_i plus the sum of W1 x_j over the neighbours j of i. Kipf and Welling 2017, as in PyTorch3D."""

    def __init__(self, inputs: int, outputs: int):
        super().__init__()
        self.own, self.neighbours = nn.Linear(inputs, outputs), nn.Linear(inputs, outputs)
        for layer in (self.own, self.neighbours):
            nn.init.normal_(layer.weight, std=0.01)
            nn.init.zeros_(layer.bias)

    def forward(self, x: torch.Tensor, edges: torch.Tensor) -> torch.Tensor:
        """Of features V x C; edges E x 2, each once."""
        sent = self.neighbours(x)
        total = torch.zeros_like(sent).index_add(0, edges[:, 0], sent[edges[:, 1]]).index_add(0, edges[:, 1], sent[edges[:, 0]])
        return self.own(x) + total


class RefinementStage(nn.Module):
    """Features of the image under each vertex, graph convolutions, and a step of each vertex of at most 1."""

    def __init__(self, image_features: int, vertex_features: int, width: int, convolutions: int):
        super().__init__()
        self.bottleneck = nn.Linear(image_features, width)
        inputs = [width + vertex_features + 3] + [width + 3] * (convolutions - 1)
        self.convolutions = nn.ModuleList(GraphConvolution(n, width) for n in inputs)
        self.offset = nn.Linear(width + 3, 3)
        nn.init.normal_(self.bottleneck.weight, std=0.01)
        nn.init.zeros_(self.bottleneck.bias)
        nn.init.zeros_(self.offset.weight)
        nn.init.zeros_(self.offset.bias)

    def forward(self, features: torch.Tensor, meshes: Meshes, edges: torch.Tensor, known: torch.Tensor | None) -> tuple[Meshes, torch.Tensor]:
        """The refined meshes, and the vertices' features for the next stage."""
        seen = F.relu(self.bottleneck(vert_align(features, meshes)))
        x = torch.cat([seen, meshes.vertices] if known is None else [known, seen, meshes.vertices], dim=1)
        for convolution in self.convolutions:
            known = F.relu(convolution(x, edges))
            x = torch.cat([known, meshes.vertices], dim=1)
        return meshes.moved(meshes.vertices + torch.tanh(self.offset(x))), known


class MeshHead(nn.Module):
    """Stages of refinement, each with its own weights."""

    def __init__(self, channels: int, stages: int = 3, convolutions: int = 3, width: int = 128):
        super().__init__()
        self.stages = nn.ModuleList(RefinementStage(channels, 0 if i == 0 else width, width, convolutions) for i in range(stages))

    def forward(self, features: torch.Tensor, meshes: Meshes) -> list[Meshes]:
        """The meshes after each stage. features: N x C x H x W, of N meshes' regions."""
        edges, _ = meshes.edges()
        refined, known = [], None
        for stage in self.stages:
            meshes, known = stage(features, meshes, edges, known)
            refined.append(meshes)
        return refined
