"""The grasps on the scan as the camera saw it, drawn as SVG."""

from __future__ import annotations

import base64
import struct
import zlib

import numpy as np
import numpy.typing as npt

import cloudtouch as ct

Floats = npt.NDArray[np.float64]

#: Verdicts and their colours (Okabe and Ito's, which colour-blind readers tell apart), drawn in this order.
COLOURS = {
    "in_collision": ("#d55e00", "in collision"),
    "undecided": ("#666666", "undecided"),
    "uncertain": ("#e69f00", "uncertain"),
    "free": ("#0072b2", "free"),
}
WIDTH, HEIGHT = 900, 660
#: Where the picture begins, and the edge of its pixels.
LEFT, TOP, CELL = 20, 80, 3
#: So many of a verdict are drawn.
GRASPS = 40
#: Finger tips beyond the palm, m.
REACH = 0.06


def draw(path: str, points: Floats, poses: Floats, batch: ct.Batch) -> None:
    """Each grasp is a line from its palm to its finger tips, with a dot at the tips."""
    low, high = (np.percentile(points[:, :2] / points[:, 2:], share, axis=0) for share in (0.5, 99.5))
    scale = min((WIDTH - 2 * LEFT) / (high - low)[0], (HEIGHT - TOP - 50) / (high - low)[1])

    def pixels(places: Floats) -> Floats:
        return (LEFT, TOP) + scale * (places[:, :2] / places[:, 2:] - low)

    shares = {name: float(np.mean(batch.verdict == name)) for name in COLOURS}
    image = base64.b64encode(png(shaded(pixels(points) - (0, TOP), points[:, 2]))).decode()
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" font-family="sans-serif">',
        '<rect width="100%" height="100%" fill="white"/>',
        f'<text x="{LEFT}" y="32" font-size="22">{len(batch):,} grasps tried on one depth image: '
        f"{shares['free']:.0%} are free</text>",
        f'<image y="{TOP}" width="{WIDTH}" height="{HEIGHT - TOP - 40}" href="data:image/png;base64,{image}"/>',
        f'<text x="{LEFT}" y="{HEIGHT - 14}" font-size="15">A line leads from the palm to the finger tips (dot); '
        f"{GRASPS} of each kind are drawn.</text>",
    ]
    for k, (name, (colour, words)) in enumerate(COLOURS.items()):
        parts.append(f'<circle cx="{30 + 215 * k}" cy="56" r="6" fill="{colour}"/>')
        parts.append(f'<text x="{42 + 215 * k}" y="61" font-size="15">{words} {shares[name]:.1%}</text>')
        chosen = poses[batch.verdict == name]
        palms = chosen[:, :3, 3]
        ends = [pixels(palms), pixels(palms + REACH * chosen[:, :3, 2])]
        shown = np.all([(end > (0, TOP)).all(axis=1) & (end < (WIDTH, HEIGHT - 40)).all(axis=1) for end in ends], axis=0)
        for (x, y), (u, v) in zip(*(end[shown][:GRASPS] for end in ends)):
            parts.append(f'<line x1="{x:.0f}" y1="{y:.0f}" x2="{u:.0f}" y2="{v:.0f}" stroke="{colour}" stroke-width="2"/>')
            parts.append(f'<circle cx="{u:.0f}" cy="{v:.0f}" r="3.5" fill="{colour}"/>')
    with open(path, "w", encoding="utf-8") as file:
        file.write("\n".join([*parts, "</svg>"]))


def shaded(pixels: Floats, depth: Floats) -> npt.NDArray[np.uint8]:
    """The nearest return of each cell, lit from the upper left; white where there is none."""
    width, height = WIDTH // CELL, (HEIGHT - TOP - 40) // CELL
    u, v = (pixels // CELL).astype(int).T
    inside = (u >= 0) & (u < width) & (v >= 0) & (v < height)
    near = np.full((height, width), np.inf)
    np.minimum.at(near, (v[inside], u[inside]), depth[inside])
    # A cell between returns takes the nearest of its neighbours.
    around = np.stack([np.roll(near, shift, (0, 1)) for shift in ((0, 1), (1, 0), (0, -1), (-1, 0), (1, 1), (-1, -1))])
    near = np.where(np.isinf(near), around.min(axis=0), near)
    # Means of five cells: the noise of one would be all that is seen.
    smooth = np.mean([np.roll(near, (i, j), (0, 1)) for i in (-1, 0, 1) for j in (-1, 0, 1)], axis=0)
    with np.errstate(invalid="ignore"):
        slope = (np.roll(smooth, -1, 0) - np.roll(smooth, 1, 0)) + (np.roll(smooth, -1, 1) - np.roll(smooth, 1, 1))
        grey = np.clip(205 + 3500 * slope, 130, 245)
    picture = np.where(np.isfinite(near), np.nan_to_num(grey, nan=180), 255)
    # What was rolled over the edge.
    picture[[0, 1, -2, -1]] = picture[:, [0, 1, -2, -1]] = 255
    return picture.astype(np.uint8)


def png(grey: npt.NDArray[np.uint8]) -> bytes:
    """A picture in shades of grey as a PNG file."""

    def chunk(kind: bytes, data: bytes) -> bytes:
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    height, width = grey.shape
    rows = b"".join(b"\0" + row.tobytes() for row in grey)
    head = struct.pack(">IIBBBBB", width, height, 8, 0, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b"")
