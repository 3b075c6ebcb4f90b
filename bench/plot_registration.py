"""Draws what bench/registration measured, as the paper does: translation error against ratio.

usage: plot_registration.py FOLDER
"""
import json
import os
import statistics
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

from codec_style import in_order, style  # noqa: E402

LEAST_RATIO, LARGEST_RATIO = 45, 240
LARGEST_ERROR = 8  # that is drawn, in deviations of the original above its mean: where all that is close together is seen


def main():
    folder = sys.argv[1]
    name = os.path.basename(os.path.abspath(folder))
    with open(os.path.join(folder, "registration.jsonl"), encoding="utf-8") as lines:
        results = [json.loads(line) for line in lines]
    methods = list(dict.fromkeys(result["method"] for result in results))
    figure, both = plt.subplots(1, len(methods), figsize=(12, 5.5), layout="constrained")
    for axes, method in zip(both, methods):
        series = {}
        for result in results:
            if result["method"] == method:
                series.setdefault(result["series"], []).append(result)
        original = series.pop("original")[0]["translation_percent"]
        mean, deviation = statistics.mean(original), statistics.stdev(original)
        axes.axhspan(mean - deviation, mean + deviation, color="black", alpha=0.12, label="original, +- 1 deviation")
        axes.axhline(mean, color="black", linewidth=1)
        for label, points in in_order(series).items():
            points.sort(key=lambda result: result["bits_per_point"])
            ratios = [96 / point["bits_per_point"] for point in points]
            means = [statistics.mean(point["translation_percent"]) for point in points]
            deviations = [statistics.stdev(point["translation_percent"]) for point in points]
            axes.errorbar(ratios, means, deviations, label=label, elinewidth=0.6, capsize=1.5, **style(label))
        axes.set_ylim(max(0, mean - LARGEST_ERROR * deviation), mean + LARGEST_ERROR * deviation)
        axes.set_xlim(LEAST_RATIO, LARGEST_RATIO)
        axes.axvline(88.9, color="black", linewidth=0.8, linestyle=":")
        axes.set_xscale("log")
        ticks = [50, 60, 75, 88.9, 105, 125, 150, 200]
        axes.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
        axes.minorticks_off()
        axes.set_xlabel("ratio against 96 bits a point (88.9: the paper's)")
        axes.set_title(f"{method}: {name}")
        axes.grid(alpha=0.3)
    both[0].set_ylabel("translation error, % of the path")
    figure.supxlabel("Bars: one standard deviation over the sub-samplings. Lines that leave the picture go on in the tables.",
                     fontsize=8)
    handles, labels = both[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="center left", bbox_to_anchor=(1, 0.5), fontsize=8, frameon=False)
    for suffix in ("svg", "png"):
        figure.savefig(os.path.join(folder, f"registration.{suffix}"), bbox_inches="tight", dpi=110)


main()
