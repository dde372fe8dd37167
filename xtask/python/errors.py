"""How far a picture is from the truth, and whether its noise has structure.

Pictures are linear RGB, height × width × 3. The truth is known by two references, `a` and `b`, that are independent of each other
and of the picture: (x − a)(x − b) is (x − truth)² in the mean, for the noise of the references drops out. What is left is noise
and bias of the picture alone. What errors are divided by must be nearly free of noise, or dark outliers of the references would count most:
it is a denoised picture of many samples, `clean`.
"""

import numpy as np

# Share of the pixels, those farthest from the truth, that errors leave out.
WORST = 0.001
# Brightness, of a picture scaled to a mean of 0.5, below which errors count less and less; squared.
DARK = 0.01
# Farthest pixels whose noise is compared, and the side of the squares whose noise is taken to be alike.
OFFSETS, ALIKE = 16, 16


def luminance(pictures):
    """Rec. 709 luminance of linear RGB, in double precision."""
    return pictures.astype(np.float64) @ [0.2126, 0.7152, 0.0722]


def blocks(picture, side):
    """Means of squares of so many pixels; what does not fill one, at the right and below, is left out."""
    height, width = (n // side for n in picture.shape[:2])
    squares = picture[: height * side, : width * side].astype(np.float64)
    return squares.reshape(height, side, width, side, *picture.shape[2:]).mean((1, 3))


def relmse(picture, a, b, clean, side=1):
    """Mean of (x − a)(x − b) / (clean² + 0.01) over pixels, or means of squares of `side` pixels, and channels.

    Pictures are scaled to a mean of 0.5; the worst 0.1 % are left out.
    """
    x, a, b, clean = (blocks(each, side) for each in (picture, a, b, clean))
    weight = 1 / (clean**2 + DARK * (2 * clean.mean()) ** 2)
    far = ((x - (a + b) / 2) ** 2 * weight).mean(-1).ravel()
    error = ((x - a) * (x - b) * weight).mean(-1).ravel()
    return float(error[np.argsort(far)[: round(len(far) * (1 - WORST))]].mean())


def correlation(picture, a, b):
    """Correlation of the noise of pixels that are apart by up to 16: `[rows down][columns right]`, columns from −16.

    Noise is luminance less the truth's, over its root mean square in squares of 16 × 16 pixels, and at most three of it, so that neither bright
    places nor single specks decide.
    """
    noise = luminance(picture) - (luminance(a) + luminance(b)) / 2
    squares = np.sqrt(blocks(noise**2, ALIKE)) + 1e-12
    squares = squares.repeat(ALIKE, 0).repeat(ALIKE, 1)
    z = np.clip(noise[: squares.shape[0], : squares.shape[1]] / squares, -3, 3)
    shape = [n + OFFSETS for n in z.shape]
    # Beyond the border are zeros, so nothing wraps around; each offset is divided by the number of its pairs.
    products, pairs = (np.fft.irfft2(np.abs(np.fft.rfft2(each, shape)) ** 2, shape) for each in (z, np.ones_like(z)))
    near = np.roll((products / np.maximum(pairs, 1)) / (z**2).mean(), OFFSETS, 1)
    return near[: OFFSETS + 1, : 2 * OFFSETS + 1]


def seconds_to(error, curve):
    """Core-seconds to `error` by `curve`, pairs of errors and core-seconds with the fewest samples first, on straight lines in log-log.

    No more than the first and no less than the last of its errors is asked for: the caller never leaves the curve.
    """
    errors, seconds = np.array(curve)
    falling = np.minimum.accumulate(errors)
    return float(np.exp(np.interp(-np.log(error), -np.log(falling), np.log(seconds))))


def to_equal_error(ours, peer):
    """Core-seconds of both to the least error that both reach, and their ratio, peer's over ours.

    Where even the first point of one curve has less error than the last of the other, the ratio is a bound, which `bound` says:
    "≥" if ours is the better, "≤" if the peer is.
    """
    error = max(min(ours[0]), min(peer[0]))
    bound = "≥" if error > ours[0][0] else "≤" if error > peer[0][0] else ""
    mine, others = seconds_to(error, ours), seconds_to(error, peer)
    return dict(error=error, ours=mine, peer=others, ratio=others / mine, bound=bound)


def agreement(one, other, side=16):
    """One picture over another less one: of the whole, in the median of blocks, and the share of blocks that are near."""
    one, other = luminance(one), luminance(other)
    difference = blocks(one, side) / blocks(other, side) - 1
    near = {f"within_{percent}": float((np.abs(difference) < percent / 100).mean()) for percent in (5, 10)}
    return dict(whole=float(one.mean() / other.mean() - 1), median=float(np.median(difference)), **near)
