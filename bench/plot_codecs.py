"""Draws what `pointreel bench --plots FOLDER` measured: rate against largest error, rms error and speed.

usage: plot_codecs.py FOLDER
"""
import os
import sys
import textwrap

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

import codec_results  # noqa: E402
from codec_style import in_order, style  # noqa: E402

LOSSLESS = ("xz", "zstd")
LEAST_ERROR_M = 0.0005
LARGEST_ERROR_M = 0.5  # of settings that are drawn: those that lose points are off by metres somewhere


def draw(axes, series, value, ylabel):
    for name, results in series.items():
        points = [(result["bits_per_point"], value(result)) for result in results]
        axes.plot(*zip(*points), label=name, **style(name))
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlabel("bits per input point, geometry only")
    axes.set_ylabel(ylabel)
    ticks = [0.25, 0.5, 1, 2, 4, 8, 16, 32, 64]
    axes.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
    bits = [result["bits_per_point"] for results in series.values() for result in results]
    axes.set_xlim(min(bits) / 1.2, max(bits) * 1.2)
    axes.minorticks_off()
    axes.grid(alpha=0.3)


def in_centimetres(axes, ticks_cm):
    axes.set_yticks([cm / 100 for cm in ticks_cm], [f"{cm:g} cm" for cm in ticks_cm])
    axes.minorticks_off()


def with_settings(series, wanted):
    """The settings that are wanted; series that have none are left out."""
    kept = {name: [result for result in results if wanted(result)] for name, results in series.items()}
    return {name: results for name, results in kept.items() if results}


def save(figure, axes, folder, name):
    handles, labels = axes.get_legend_handles_labels()
    figure.legend(handles, labels, loc="center left", bbox_to_anchor=(1, 0.5), fontsize=9, frameon=False)
    for suffix in ("svg", "png"):
        figure.savefig(os.path.join(folder, f"{name}.{suffix}"), bbox_inches="tight", dpi=110)
    plt.close(figure)


def draw_error(folder, series, name, title, error):
    shown = with_settings(series, lambda result: LEAST_ERROR_M < error(result) < LARGEST_ERROR_M)
    figure, axes = plt.subplots(figsize=(8.5, 6), layout="constrained")
    draw(axes, shown, error, "error, the worse direction")
    in_centimetres(axes, [0.5, 1, 2, 5, 10, 20, 50])
    axes.set_title(title)
    hidden = [other for other in series if other not in shown and other not in LOSSLESS]
    if hidden:
        figure.supxlabel("\n".join(textwrap.wrap(f"Not drawn, off by more than {LARGEST_ERROR_M:g} m at every setting: "
                                                 + "; ".join(hidden) + ".", 150)), fontsize=7.5)
    save(figure, axes, folder, name)


def draw_speed(folder, series, name):
    figure, both = plt.subplots(1, 2, figsize=(12.5, 6), layout="constrained", sharey=True)
    for axes, side in zip(both, ("encode", "decode")):
        draw(axes, series, lambda result, side=side: result[f"{side}_ms"]["median"], "ms a sweep, median")
        axes.set_yticks([2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000], [2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000])
        axes.minorticks_off()
        axes.axhline(100, color="black", linewidth=0.8, linestyle=":")
        axes.set_title(f"Time to {side}: {name}")
    both[1].set_ylabel("")
    both[0].annotate("the sensor's own pace", (0.02, 100), xycoords=("axes fraction", "data"), va="bottom",
                     fontsize=8)
    save(figure, both[0], folder, "rate_speed")


def main():
    folder = sys.argv[1]
    name = os.path.basename(os.path.abspath(folder))
    series = in_order(codec_results.read(folder))
    draw_error(folder, series, "rate_max_error", f"Rate against the largest error: {name}", codec_results.max_error_m)
    draw_error(folder, series, "rate_rms_error", f"Rate against the rms distance to the nearest point: {name}",
               codec_results.rms_error_m)
    draw_speed(folder, series, name)


main()
