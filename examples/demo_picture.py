#!/usr/bin/env python3
"""Draws a sweep before and after compression: two range images and the error between them.

usage: demo_picture.py ORIGINAL.bin DECODED.bin PICTURE.png

Both sweeps are KITTI files (float32 x, y, z, intensity). Cells are 0.18 deg of azimuth by 0.45 deg of elevation and
show their nearest range. The error of a cell is the largest distance from one of its original points to the nearest
decoded point.
"""
import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.colors import LogNorm, Normalize
from scipy.spatial import cKDTree

AZIMUTH_STEP_DEG = 0.18
ELEVATION_STEP_DEG = 0.45
COLUMNS = round(360 / AZIMUTH_STEP_DEG)
# Of a spinning LiDAR on a car; colours of ranges outside are clipped.
NEAREST_M, FARTHEST_M = 3.0, 80.0


def read_points(path):
    """(n, 3) float64 of the file's finite points."""
    points = np.fromfile(path, dtype="<f4").reshape(-1, 4)[:, :3].astype(np.float64)
    return points[np.isfinite(points).all(axis=1)]


def elevations_deg(points):
    return np.degrees(np.arctan2(points[:, 2], np.hypot(points[:, 0], points[:, 1])))


def cell_image(points, values, elevation_limits_deg, keep):
    """One value a cell, the least (np.fmin) or largest (np.fmax) of its points; NaN in empty cells.

    The top row looks up the most, the middle column forward; left is left. Points beyond the limits are left out.
    """
    low_deg, high_deg = elevation_limits_deg
    row = np.floor((high_deg - elevations_deg(points)) / ELEVATION_STEP_DEG).astype(int)
    azimuth_deg = np.degrees(np.arctan2(points[:, 1], points[:, 0]))
    column = np.floor((180 - azimuth_deg) / AZIMUTH_STEP_DEG).astype(int) % COLUMNS
    image = np.full((int(np.ceil((high_deg - low_deg) / ELEVATION_STEP_DEG)) + 1, COLUMNS), np.nan)
    inside = (row >= 0) & (row < len(image))
    keep.at(image, (row[inside], column[inside]), values[inside])
    return image


def draw_panel(figure, axes, image, title, label, colours, norm, high_deg):
    """Empty cells stay white."""
    shown = axes.imshow(image, cmap=colours, norm=norm, aspect="auto", interpolation="nearest",
                        extent=(180, -180, high_deg - len(image) * ELEVATION_STEP_DEG, high_deg))
    axes.set_title(title, loc="left", fontsize=12)
    axes.set_ylabel("elevation [deg]")
    axes.set_xticks(range(-180, 181, 45))
    bar = figure.colorbar(shown, ax=axes, pad=0.01, fraction=0.03, label=label)
    if isinstance(norm, LogNorm):
        ticks = [3, 5, 10, 20, 40, 80]
        bar.set_ticks(ticks, labels=[str(tick) for tick in ticks])
        bar.minorticks_off()


def draw(original, decoded, names, picture):
    # A handful of stray points must not squeeze the picture.
    limits_deg = tuple(np.percentile(elevations_deg(original), (0.05, 99.95)))
    errors_m = cKDTree(decoded).query(original, workers=-1)[0]
    ranges = LogNorm(NEAREST_M, FARTHEST_M, clip=True)
    p99_cm = 100 * np.percentile(errors_m, 99)

    figure, panels = plt.subplots(3, 1, figsize=(18, 9.5), sharex=True, constrained_layout=True)
    for axes, points, title in ((panels[0], original, f"before: {names[0]}, {len(original):,} points"),
                                (panels[1], decoded, f"after: {names[1]}, {len(decoded):,} points")):
        image = cell_image(points, np.linalg.norm(points, axis=1), limits_deg, np.fmin)
        draw_panel(figure, axes, image, title, "range [m]", "turbo_r", ranges, limits_deg[1])
    draw_panel(figure, panels[2], cell_image(original, 100 * errors_m, limits_deg, np.fmax),
               f"distance from each original point to the nearest decoded point: mean {100 * errors_m.mean():.2f} cm, "
               f"99 % under {p99_cm:.2f} cm, max {100 * errors_m.max():.2f} cm",
               "error [cm], clipped", "inferno", Normalize(0, max(p99_cm, 0.1), clip=True), limits_deg[1])
    panels[2].set_xlabel("azimuth [deg], 0 is forward, 90 is left")
    figure.savefig(picture, dpi=110)


def main():
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    original, decoded, picture = map(Path, sys.argv[1:])
    draw(read_points(original), read_points(decoded), (original.name, decoded.name), picture)
    print(picture)


if __name__ == "__main__":
    main()
