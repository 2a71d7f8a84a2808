# SPDX-License-Identifier: MIT
"""Draws a pattern, and a courtyard by a screen-space method next to ray tracing: python3 plots.py OUTPUT.png"""

import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

import nook


def positions_of(pixels):
    """World positions and normals of the pixels that show a surface, and which these are."""
    projection = np.linalg.inv(pixels.projection.reshape(4, 4).T)
    world = np.linalg.inv(pixels.world_to_camera.reshape(4, 4).T)
    height, width = pixels.depth.shape
    x, y = np.meshgrid((np.arange(width) + 0.5) / width * 2 - 1, 1 - (np.arange(height) + 0.5) / height * 2)
    rays = np.stack([x, y, np.zeros_like(x), np.ones_like(x)], axis=-1) @ projection.T
    rays = rays[..., :3] / -rays[..., 2:3]
    seen = np.isfinite(pixels.depth)
    view = rays[seen] * pixels.depth[seen][:, None]
    return view @ world[:3, :3].T + world[:3, 3], pixels.normals[seen] @ world[:3, :3].T, seen


def main(path):
    pattern = nook.pattern("disk", 9)
    level = nook.Level.load("builtin:courtyard")
    pixels = level.gbuffer(size=(320, 180))
    drawn = nook.shade(pixels, method="slices", radius=1.0)
    points, normals, seen = positions_of(pixels)
    rays = np.ones(seen.shape, np.float32)
    rays[seen] = level.visibility(points, normals, radius=1.0, rays=64, lift=0.001).visibility
    errors = nook.compare(drawn.visibility, rays)

    figure, (left, middle, right) = plt.subplots(1, 3, figsize=(10, 2.6), width_ratios=(1, 2, 2), layout="constrained")
    left.add_patch(plt.Circle((0, 0), 1, fill=False))
    left.scatter(*pattern.points.T, s=600 * pattern.weights)
    left.set(aspect="equal", title="9 samples", xticks=[], yticks=[])
    for axes, picture, title in ((middle, drawn.visibility, f"slices, RMSE {float(errors.rmse):.3f}"), (right, rays, "rays")):
        axes.imshow(picture, cmap="gray", vmin=0, vmax=1)
        axes.set(title=title, xticks=[], yticks=[])
    figure.savefig(path, dpi=80)


if __name__ == "__main__":
    main(sys.argv[1])
