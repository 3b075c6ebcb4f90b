"""Draws what `pointreel bench --plots FOLDER` measured: rate against largest error, rms error and speed.

usage: plot_codecs.py FOLDER
"""
import os
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

import codec_results  # noqa: E402
from codec_style import COLOURS, style  # noqa: E402


def draw(axes, series, value, label):
    for name, results in series.items():
        points = [(result["bits_per_point"], value(result)) for result in results if value(result) > 0]
        if points:
            axes.plot(*zip(*points), label=name, **style(name))
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlabel("bits per input point, geometry only")
    axes.set_ylabel(label)
    ticks = [0.25, 0.5, 1, 2, 4, 8, 16, 32, 64]
    axes.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
    axes.minorticks_off()
    axes.grid(alpha=0.3)


def in_centimetres(axes, ticks_cm):
    axes.set_yticks([cm / 100 for cm in ticks_cm], [f"{cm:g} cm" if cm < 100 else f"{cm / 100:g} m" for cm in ticks_cm])
    axes.minorticks_off()


def save(figure, folder, name):
    for suffix in ("svg", "png"):
        figure.savefig(os.path.join(folder, f"{name}.{suffix}"), bbox_inches="tight", dpi=110)
    plt.close(figure)


def legend(figure, axes):
    handles, labels = axes.get_legend_handles_labels()
    figure.legend(handles, labels, loc="center left", bbox_to_anchor=(1, 0.5), fontsize=8, frameon=False)


def in_order(series):
    order = list(COLOURS)

    def place(item):
        prefixes = [prefix for prefix in order if item[0].startswith(prefix)]
        return (order.index(max(prefixes, key=len)) if prefixes else len(order), item[0])

    return dict(sorted(series.items(), key=place))


def main():
    folder = sys.argv[1]
    name = os.path.basename(os.path.abspath(folder))
    series = in_order(codec_results.read(folder))
    for title, file, error, ticks in (
        ("Rate against the largest error", "rate_max_error", codec_results.max_error_m,
         [0.1, 0.5, 1, 2, 5, 10, 20, 50, 100, 500, 2000]),
        ("Rate against the rms distance to the nearest point", "rate_rms_error", codec_results.rms_error_m,
         [0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50]),
    ):
        figure, axes = plt.subplots(figsize=(8, 5.5), layout="constrained")
        draw(axes, series, error, "error, the worse direction")
        in_centimetres(axes, ticks)
        axes.set_title(f"{title}: {name}")
        legend(figure, axes)
        save(figure, folder, file)

    figure, both = plt.subplots(1, 2, figsize=(12, 5.5), layout="constrained", sharey=True)
    for axes, side in zip(both, ("encode", "decode")):
        draw(axes, series, lambda result, side=side: result[f"{side}_ms"]["median"], "ms a sweep, median")
        axes.set_yticks([2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000], [2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000])
        axes.minorticks_off()
        axes.axhline(100, color="black", linewidth=0.8, linestyle=":")
        axes.set_title(f"Rate against time to {side}: {name}")
    both[1].set_ylabel("")
    both[0].annotate("the sensor's own pace", (0.98, 100), xycoords=("axes fraction", "data"), ha="right", va="bottom",
                     fontsize=8)
    legend(figure, both[0])
    save(figure, folder, "rate_speed")


main()
