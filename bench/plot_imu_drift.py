#!/usr/bin/python3
"""Draws the table of imu_drift.

usage: plot_imu_drift.py TABLE.csv PICTURE.png

The poses integrated from the IMU against the true ones: from sweep to sweep, and since the first sweep.
"""
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    table = np.genfromtxt(sys.argv[1], delimiter=",", names=True)
    time_s = table["time_s"]
    figure, panels = plt.subplots(2, 2, figsize=(12, 7), sharex=True, layout="constrained")
    columns = (("step", "error from one sweep to the next", "bar"), ("drift", "drift since the first sweep", "line"))
    quantities = (("translation", "m", 100, "cm", "tab:blue"), ("rotation", "deg", 1, "deg", "tab:orange"))
    for column, (kind, title, drawing) in enumerate(columns):
        suffix = "_error" if kind == "step" else ""
        for axes, (quantity, unit, scale, shown_unit, colour) in zip(panels[:, column], quantities):
            values = scale * table[f"{kind}_{quantity}{suffix}_{unit}"]
            if drawing == "bar":
                axes.bar(time_s[1:], values[1:], 0.8 * np.median(np.diff(time_s)), color=colour)
                mean = values[1:].mean()
                axes.axhline(mean, color="black", linewidth=0.8, linestyle="--", label=f"mean {mean:.3g} {shown_unit}")
            else:
                axes.plot(time_s, values, color=colour, label=f"at the end {values[-1]:.3g} {shown_unit}")
            axes.set_ylabel(f"{quantity} [{shown_unit}]")
            axes.set_ylim(bottom=0)
            axes.margins(y=0.15)
            axes.grid(alpha=0.3)
            axes.legend(loc="upper left")
        panels[0, column].set_title(title, fontsize=10)
        panels[1, column].set_xlabel("time [s]")
    end = table[-1]
    figure.suptitle(f"Poses from the IMU against the true ones: {len(table)} sweeps, {end['travelled_m']:.0f} m, "
                    f"drift {100 * end['drift_translation_m'] / max(end['travelled_m'], 1e-9):.2f} % of the way")
    figure.savefig(sys.argv[2], dpi=100)


if __name__ == "__main__":
    main()
