"""Ours beside a peer, as rendered and as delivered: curves of error against core-seconds, and core-seconds to equal error.

Both render every case with several numbers of samples and several seeds, in turn, and twice with many for references. Each is held against its own
references, so that a difference of their materials or filters is no error of either.
"""

from dataclasses import asdict, dataclass

import numpy as np

import errors

# Samples per pixel at the usual size and at the large one. Ours begins with fewer, for its first pictures may be better than a peer's last; 8, 32
# and 128 are `--quality draft`, `normal` and `high`.
SIZE, OURS, PEER = "512x384", [2, 8, 32, 128], [8, 32, 128]
LARGE, LARGE_OURS, LARGE_PEER = "1024x768", [2, 8, 32], [8, 32]
# Seeds of measured pictures, and of references; the samples of those, at most. They need not be many, for their noise drops out in the mean; what
# is left of it is some 5 % of a delivered error, and more where a peer's pictures are very noisy.
SEEDS, REFERENCES, MOST = [1], [101, 102], 64
# Pixels, and the side of the squares whose means tell what is seen from farther away.
SIDES = {"": 1, "_blocks": 8}
KINDS = {"delivered": "delivered", "raw": "as rendered"}


@dataclass
class Point:
    """What one number of samples costs and leaves, the mean over seeds: as rendered and as delivered, of pixels and of blocks."""

    samples: int
    raw: float
    raw_blocks: float
    raw_core_s: float
    delivered: float
    delivered_blocks: float
    delivered_core_s: float


def measure(store, renderers, scene, size, counts):
    """Curve, bias, speed, memory and pictures of each renderer; `counts` holds the samples of each."""
    turns = [(seed, place, who) for seed in SEEDS for place in range(max(map(len, counts))) for who in range(len(renderers))]
    shots = {}
    for seed, place, who in turns:
        if place < len(counts[who]):
            shots[who, counts[who][place], seed] = store.shot(renderers[who], scene, size, counts[who][place], seed)
    many = min(MOST, max(map(max, counts)))
    return [told(store, renderers[who], scene, size, counts[who], many, {key[1:]: shot for key, shot in shots.items() if key[0] == who}) for who in range(len(renderers))]


def told(store, renderer, scene, size, counts, many, shots):
    """What `measure` returns of one renderer, whose references have `many` samples."""
    a, b = (store.shot(renderer, scene, size, many, seed, reference=True) for seed in REFERENCES)
    clean = np.mean([shots[counts[-1], seed].delivered for seed in SEEDS], axis=0)
    points = [point(n, [shots[n, seed] for seed in SEEDS], a.raw, b.raw, clean) for n in counts]
    best, last, pixels = points[-1], shots[counts[-1], SEEDS[0]], np.prod([int(n) for n in size.split("x")])
    # The noise that is left in a denoised reference belongs to it alone; the other reference and a measured picture are independent of it.
    floor = lambda side: float(np.mean([errors.relmse(one.delivered, other.raw, last.raw, clean, side) for one, other in ((a, b), (b, a))]))
    # Of few samples, so that the noise of the references hardly counts.
    few = counts[len(counts) > 1]
    near = np.mean([errors.correlation(shots[few, seed].raw, a.raw, b.raw) for seed in SEEDS], axis=0)
    facts = dict(
        points=[asdict(each) for each in points],
        reference_samples=many,
        floor=[floor(side) for side in SIDES.values()] if renderer.denoises_references else None,
        shift=float(last.delivered.mean() / last.raw.mean() - 1),
        rate=float(best.samples * pixels / best.raw_core_s / 1e6),
        variance=best.raw * best.samples,
        load_core_s=last.facts["load_core_s"],
        peak_mb=last.facts["peak_mb"],
        version=last.facts["version"],
        correlation=dict(samples=few, **correlation(near)),
    )
    return facts | dict(truth=(a.raw + b.raw) / 2, references=(a.raw, b.raw), shown={n: shots[n, SEEDS[0]] for n in counts})


def point(samples, shots, a, b, clean):
    of = lambda kind, side: float(np.mean([errors.relmse(getattr(shot, kind), a, b, clean, side) for shot in shots]))
    values = {f"{kind}{name}": of(kind, side) for kind in KINDS for name, side in SIDES.items()}
    seconds = {f"{kind}_core_s": float(np.median([shot.facts[f"{kind}_core_s"] for shot in shots])) for kind in KINDS}
    return Point(samples, **values, **seconds)


def correlation(near):
    """Along rows and columns at offsets 1 to 16, and the largest at any other, with its place (down, right)."""
    far = errors.OFFSETS
    others = np.abs(near)
    others[0], others[:, far] = 0, 0
    down, right = np.unravel_index(others.argmax(), others.shape)
    largest = [int(down), int(right) - far, float(near[down, right])]
    return dict(across=near[0, far + 1 :].tolist(), down=near[1:, far].tolist(), largest=largest)


def row(name, size, ours, peer):
    """A case: both curves, and the core-seconds of both to equal error of every kind."""
    # An error that is not above zero is lost in the noise of the references.
    told = lambda who, key: [p for p in who["points"] if p[key] > 0]
    curve = lambda who, kind, of: ([p[kind + of] for p in told(who, kind + of)], [p[f"{kind}_core_s"] for p in told(who, kind + of)])
    equal = {kind + of: errors.to_equal_error(curve(ours, kind, of), curve(peer, kind, of)) for kind in KINDS for of in SIDES}
    return dict(case=f"{name} {size}", ours=ours, peer=peer, equal=equal)


def report(r):
    ratios = ", ".join(f"{kind.replace('_', ' ')} {found['bound']}{found['ratio']:.2f}" for kind, found in r["equal"].items())
    print(f"{r['case']:40} to equal error {ratios}; M samples per core-s {r['ours']['rate']:.2f} / {r['peer']['rate']:.2f}", flush=True)
