#!/usr/bin/python3
"""Draws the tables of planes_study.

usage: plot_planes_study.py DIR [NAME]

Reads DIR/*.csv and writes a PNG beside each, and rate_error.png. NAME (default: that of DIR) goes into the titles.
"""
import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.ticker import FuncFormatter, NullFormatter, PercentFormatter

XYZ32_BPP = 96
# What Feng, Liu, Zhu report for KITTI.
PAPER_RATIO = {"single-frame": 59.7, "streaming": 88.9}
PAPER_SPEEDUP_4_CORES = {5: 3.8, 19: 5.4}
NORMAL_GROUP = 5

MODE_COLOURS = {"single-frame": "tab:blue", "streaming": "tab:orange"}
THRESHOLD_STYLES = {0.1: "o-", 0.5: "s--"}
PART_COLOURS = {"occupancy": "#4c78a8", "planes": "#72b7b2", "residual": "#e45756", "container": "#9d9d9d"}
SHARE_COLOURS = {"spatial": "#4c78a8", "temporal": "#f58518", "unfit": "#bab0ac"}


def read_table(path):
    return np.genfromtxt(path, delimiter=",", names=True, dtype=None, encoding="utf-8", ndmin=1)


def rows_where(table, **wanted):
    for name, value in wanted.items():
        same = np.isclose(table[name], value) if isinstance(value, float) else table[name] == value
        table = table[same]
    return table


def mode_label(table):
    """Legend entry for rows of one mode."""
    mode, group = table["mode"][0], table["group"][0]
    return f"{mode}, groups of {group} (motion: {table['motion'][0]})" if group > 1 else mode


def plain_ticks(axis, ticks):
    """Exactly these ticks, as plain numbers, on a logarithmic axis."""
    axis.set_ticks(ticks, labels=[f"{tick:g}" for tick in ticks])
    axis.set_minor_formatter(NullFormatter())
    axis.set_tick_params(which="minor", length=0)


def legend_beside(axes):
    """One legend for all panels, to the right of the last one."""
    axes.legend(loc="upper left", bbox_to_anchor=(1.01, 1), frameon=False, borderaxespad=0)


def draw_ratio_axis(axes):
    """Ratio on the left, the bits per point it stands for on the right."""
    axes.set_ylabel("compression ratio\n(float32 x, y, z : whole file)")
    axes.yaxis.set_major_formatter(FuncFormatter(lambda ratio, _: f"{ratio:g} : 1"))
    axes.margins(y=0.08)
    axes.set_ylim(bottom=0)
    right = axes.twinx()
    right.set_ylim(axes.get_ylim())
    ticks = [tick for tick in axes.get_yticks() if 0 < tick <= axes.get_ylim()[1]]
    right.set_yticks(ticks, labels=[f"{XYZ32_BPP / tick:.2g}" for tick in ticks])
    right.set_ylabel("bits per input point")
    axes.grid(alpha=0.3)


def draw_threshold(table, figure):
    axes = figure.subplots()
    for mode, colour in MODE_COLOURS.items():
        rows = rows_where(table, mode=mode)
        if len(rows) == 0:
            continue
        axes.plot(rows["threshold_m"], rows["ratio_xyz32"], "o-", color=colour, label=mode_label(rows))
        for row in rows:
            axes.annotate(f"{row['ratio_xyz32']:.0f}", (row["threshold_m"], row["ratio_xyz32"]),
                          (0, 7 if mode == "single-frame" else -14),
                          textcoords="offset points", ha="center", color=colour, fontsize=9)
    for mode, ratio in PAPER_RATIO.items():
        axes.axhline(ratio, color=MODE_COLOURS[mode], linestyle=":", label=f"paper, {mode}: {ratio}")
    axes.set_xscale("log")
    plain_ticks(axes.xaxis, sorted(set(table["threshold_m"])))
    axes.set_xlabel("threshold [m]: largest range error of a cell on a plane")
    draw_ratio_axis(axes)
    axes.legend(loc="upper left")


def draw_rate_error(table, figure):
    panels = figure.subplots(1, 2)
    measures = (("mean_error_m", "mean error of kept points [cm]", "each kept point to its own decoded point"),
                ("nearest_decoded_mean_m", "mean distance [cm]",
                 "every original point, lost ones too, to the nearest decoded"))
    for axes, (column, label, title) in zip(panels, measures):
        for mode, colour in MODE_COLOURS.items():
            rows = rows_where(table, mode=mode)
            if len(rows) == 0:
                continue
            axes.plot(rows["bpp"], 100 * rows[column], "o-", color=colour, label=mode_label(rows))
            for row in rows:
                right = mode == "streaming"
                axes.annotate(f"{row['threshold_m']:g} m", (row["bpp"], 100 * row[column]),
                              (6, 3) if right else (-6, -11), ha="left" if right else "right",
                              textcoords="offset points", color=colour, fontsize=9)
        axes.set_title(title, fontsize=10)
        axes.set_xlabel("bits per input point (whole file)")
        axes.set_ylabel(label)
        axes.margins(x=0.14, y=0.08)
        axes.set_ylim(bottom=0)
        axes.grid(alpha=0.3)
    panels[0].legend(title="labels: threshold")


def draw_resolution(table, figure):
    panels = figure.subplots(1, 3)
    cells = sorted({(row["azimuth_step_deg"], row["elevation_step_deg"]) for row in table})
    places = np.arange(len(cells))
    for mode, colour in MODE_COLOURS.items():
        for threshold_m, style in THRESHOLD_STYLES.items():
            rows = rows_where(table, mode=mode, threshold_m=threshold_m)
            if len(rows) == 0:
                continue
            rows = np.sort(rows, order="azimuth_step_deg")
            panels[0].plot(places, rows["bpp"], style, color=colour, label=f"{mode}, threshold {threshold_m:g} m")
        # Which points share a cell and how angles round does not depend on the threshold.
        panels[1].plot(places, 100 * rows["mean_angular_rounding_m"], "o-", color=colour, label=mode)
        panels[2].plot(places, 100 * (1 - rows["kept_share"]), "o-", color=colour, label=mode)
    for axes, title in zip(panels, ("rate [bits per input point]", "mean rounding to cell angles [cm]",
                                    "points lost to a nearer one in their cell [%]")):
        axes.set_title(title, fontsize=10)
        axes.set_xticks(places, labels=[f"{azimuth:.2f}\nx {elevation:.2f}" for azimuth, elevation in cells])
        axes.set_xlabel("cell: azimuth x elevation step [deg]")
        axes.set_ylim(bottom=0)
        axes.grid(alpha=0.3)
        axes.legend(fontsize=9)


def draw_group(table, figure):
    panels = figure.subplots(1, 2, sharey=True)
    lines = (("ratio_xyz32", "compression ratio", "o-", "tab:blue"),
             ("encode_sweeps_per_s", "encoding speed", "s-", "tab:green"),
             ("decode_sweeps_per_s", "decoding speed", "^--", "tab:olive"),
             ("mean_error_m", "mean error of kept points", "d-", "tab:red"))
    for axes, threshold_m in zip(panels, THRESHOLD_STYLES):
        rows = rows_where(table, threshold_m=threshold_m)
        normal = rows_where(rows, group=NORMAL_GROUP)
        if len(normal) == 0:
            axes.set_axis_off()
            continue
        for column, label, style, colour in lines:
            axes.plot(rows["group"], rows[column] / normal[column][0], style, color=colour, label=label)
        axes.axhline(1, color="grey", linewidth=0.8)
        ratio, encode, decode, error_m = (normal[column][0] for column, *_ in lines)
        axes.set_title(f"threshold {threshold_m:g} m; at 5 sweeps: {ratio:.1f} : 1, encode {encode:.0f} sweeps/s, "
                       f"decode {decode:.0f}, {100 * error_m:.1f} cm", fontsize=10)
        axes.set_xlabel(f"sweeps per group (motion: {rows['motion'][0]}, threads: {rows['threads'][0]})")
        axes.set_xticks(rows["group"])
        axes.grid(alpha=0.3)
    panels[0].set_ylim(bottom=0)
    panels[0].set_ylabel("relative to groups of 5")
    panels[0].legend(loc="lower left")


def draw_shares(table, figure):
    panels = figure.subplots(1, 2, sharey=True)
    labels = {"spatial": "plane of\nits own sweep", "temporal": "plane of the\nkey frame, new distance",
              "unfit": "on no plane\n(residual map)"}
    for axes, threshold_m in zip(panels, THRESHOLD_STYLES):
        rows = rows_where(table, threshold_m=threshold_m)
        below = np.zeros(len(rows))
        places = np.arange(len(rows))
        for kind, colour in SHARE_COLOURS.items():
            share = rows[f"{kind}_share"]
            axes.bar(places, share, 0.8, below, color=colour, label=f"{kind}: {labels[kind]}")
            for place, value, bottom in zip(places, share, below):
                if value > 0.03:
                    axes.text(place, bottom + value / 2, f"{100 * value:.0f}", ha="center", va="center", fontsize=9)
            below += share
        axes.set_title(f"threshold {threshold_m:g} m", fontsize=10)
        axes.set_xticks(places, labels=rows["group"])
        axes.set_xlabel(f"sweeps per group (motion: {rows['motion'][0]})")
    panels[0].yaxis.set_major_formatter(PercentFormatter(1))
    panels[0].set_ylabel("share of cells with a return [%]")
    legend_beside(panels[-1])


def draw_stacked_rate(axes, rows, labels):
    """Bars of bits per point by part, the sum above."""
    places = np.arange(len(rows))
    below = np.zeros(len(rows))
    for part, colour in PART_COLOURS.items():
        axes.bar(places, rows[f"{part}_bpp"], 0.75, below, color=colour, label=part)
        below += rows[f"{part}_bpp"]
    for place, row in zip(places, rows):
        axes.annotate(f"{row['bpp']:.2f}", (place, row["bpp"]), (0, 3), textcoords="offset points", ha="center")
    axes.set_xticks(places, labels=labels)
    axes.margins(y=0.12)
    axes.grid(axis="y", alpha=0.3)


def draw_tile(table, figure):
    modes = [mode for mode in MODE_COLOURS if mode in table["mode"]]
    panels = figure.subplots(2, len(modes), squeeze=False, sharey="row")
    residuals = {"auto": "residuals in steps of twice the threshold", "raw": "residuals as float32, as in the paper"}
    for column, mode in enumerate(modes):
        for line, (residual, what) in enumerate(residuals.items()):
            rows = rows_where(table, mode=mode, residual=residual)
            axes = panels[line][column]
            labels = [f"{row['tile']} x {row['tile']}\n{100 * row['unfit_share']:.0f} % unfit" for row in rows]
            draw_stacked_rate(axes, rows, labels)
            axes.set_title(f"{mode}: {what}", fontsize=10)
    for axes in panels[:, 0]:
        axes.set_ylabel("bits per input point")
    for axes in panels[-1]:
        axes.set_xlabel(f"cells per tile (threshold {table['threshold_m'][0]:g} m)")
    legend_beside(panels[0][-1])


def draw_motion(table, figure):
    panels = figure.subplots(1, 2)
    for axes, threshold_m in zip(panels, THRESHOLD_STYLES):
        rows = rows_where(table, threshold_m=threshold_m)
        labels = [f"{row['motion']}\ngroup {row['group']}\n{100 * row['temporal_share']:.0f} % temporal\n"
                  f"{100 * (1 - row['kept_share']):.0f} % lost" for row in rows]
        draw_stacked_rate(axes, rows, labels)
        axes.set_title(f"threshold {threshold_m:g} m", fontsize=10)
        axes.set_xlabel("motion given to the encoder; temporal: cells on key-frame planes;\n"
                        "lost: points behind a nearer one in their cell")
    panels[0].set_ylabel("bits per input point")
    legend_beside(panels[-1])


def draw_speedup(table, figure):
    most = table["threads"].max()
    by_group = rows_where(table, threads=most)
    by_threads = np.sort(rows_where(table, group=NORMAL_GROUP), order="threads")
    panels = figure.subplots(1, 2 if len(by_threads) > 1 else 1, squeeze=False)[0]
    for axes, rows, column, label in ((panels[0], by_group, "group", f"sweeps per group, on {most} threads"),
                                      (panels[-1], by_threads, "threads", f"threads, groups of {NORMAL_GROUP}")):
        if axes is panels[0] and column == "threads":
            continue
        places = np.arange(len(rows))
        for offset, what, colour in ((-0.2, "encode", "tab:green"), (0.2, "decode", "tab:olive")):
            bars = axes.bar(places + offset, rows[f"{what}_speedup"], 0.4, color=colour, label=what)
            axes.bar_label(bars, fmt="%.2f", fontsize=8, padding=2)
        axes.axhline(1, color="grey", linewidth=0.8)
        axes.set_xticks(places, labels=rows[column])
        axes.set_xlabel(label)
        axes.set_ylabel("speed-up over one thread (median of ratios)")
        axes.margins(y=0.1)
        axes.grid(axis="y", alpha=0.3)
    paper = ", ".join(f"{speedup} with groups of {group}" for group, speedup in PAPER_SPEEDUP_4_CORES.items())
    panels[0].legend(title=f"paper, 4 cores, encode: {paper}", title_fontsize=9, ncols=2, loc="upper left")
    panels[0].set_ylim(top=1.25 * panels[0].get_ylim()[1])


# Picture: table, drawing, size in inches, title.
PICTURES = {
    "threshold": ("threshold", draw_threshold, (8, 5.5), "Rate against threshold"),
    "rate_error": ("threshold", draw_rate_error, (12, 5), "Rate against error"),
    "resolution": ("resolution", draw_resolution, (14, 5), "Rate and quality against resolution"),
    "group": ("group", draw_group, (13, 5.5), "Sensitivity to the number of sweeps per group"),
    "shares": ("group", draw_shares, (12, 5.5), "How cells are coded"),
    "tile": ("tile", draw_tile, (11, 8), "Rate against tile size and residual coding"),
    "motion": ("motion", draw_motion, (13, 6), "Rate against the source of the motion"),
    "speedup": ("speedup", draw_speedup, (13, 5), "Parallel speed-up"),
}


def main():
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    folder = Path(sys.argv[1])
    name = sys.argv[2] if len(sys.argv) == 3 else folder.name
    for picture, (table_name, draw, size, title) in PICTURES.items():
        table = read_table(folder / f"{table_name}.csv")
        figure = plt.figure(figsize=size, layout="constrained")
        draw(table, figure)
        figure.suptitle(f"{title}: {name}, {table['sweeps'][0]} sweeps")
        figure.savefig(folder / f"{picture}.png", dpi=100)
        plt.close(figure)


if __name__ == "__main__":
    main()
