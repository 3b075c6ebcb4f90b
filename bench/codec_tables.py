"""Writes the tables of docs/BENCHMARKS.md anew, between its <!-- table NAME --> and <!-- end --> lines.

usage: codec_tables.py OUT DOCUMENT     OUT: the folder that bench/run fills, a folder a set
"""
import json
import math
import os
import re
import statistics
import sys

import codec_results

BOUNDS_CM = (1, 2, 5, 10, 20)
OURS = "mixture balanced"
# Student's t, two-sided, by degrees of freedom from 1.
T_5_PERCENT = (12.71, 4.30, 3.18, 2.78, 2.57, 2.45, 2.36, 2.31, 2.26, 2.23, 2.20, 2.18, 2.16, 2.14)
LEAST_RATIO = 60  # of the settings that the document lists for registration; the pictures have all


def markdown(header, rows):
    lines = ["| " + " | ".join(header) + " |", "|" + "---|" * len(header)]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows])


def table_equal_error(folder, file="codecs.jsonl"):
    """Bits per point of every series at the same largest error, and how many times ours that is."""
    series = codec_results.read(folder, file)
    ours = {cm: codec_results.bits_at(series[OURS], cm / 100) for cm in BOUNDS_CM}
    rows = []
    for name, results in series.items():
        bits = [codec_results.bits_at(results, cm / 100) for cm in BOUNDS_CM]
        if any(bits):
            cells = [f"{b:.2f} ({b / ours[cm]:.2f} x)" if b else "" for cm, b in zip(BOUNDS_CM, bits)]
            rows.append((min(b / ours[cm] for cm, b in zip(BOUNDS_CM, bits) if b), [name] + cells))
    return markdown(["codec"] + [f"{cm} cm" for cm in BOUNDS_CM], [row for _, row in sorted(rows)])


def table_equal_error_vpcc(folder):
    return table_equal_error(folder, "vpcc.jsonl")


def decibels(value):
    return "inf" if value is None else f"{value:.1f}"


def table_settings(folder):
    """Everything but the times."""
    rows = []
    for name, results in codec_results.read(folder).items():
        for r in results:
            nearest = r["nearest_decoded"], r["nearest_original"]
            worse = [100 * max(side[key] for side in nearest) for key in ("mean_m", "rms_m", "p95_m", "max_m")]
            kept = "".join(letter if r[key] else "-"
                           for letter, key in (("o", "keeps_order"), ("c", "keeps_count"), ("f", "carries_fields")))
            rows.append([
                name, r["settings"], f"{r['bits_per_point']:.3f}",
                f"{r['ratio_xyz32']:.1f} / {r['ratio_xyzi32']:.1f}",
                f"{100 * r['points_out'] / r['points_in']:.1f} % {kept}",
                f"{100 * r['own_error']['max_m']:.2f}" if "own_error" in r else "",
                " / ".join(f"{value:.2f}" for value in worse[:3]) + f" / {worse[3]:.4g}",
                " / ".join(decibels(peak[key]) for key in ("d1_db", "d2_db") for peak in r["psnr"]),
                f"{r['peak_memory_mib']:.0f}",
            ])
    return markdown(["codec", "settings", "bpp", "ratio to 96 / 128 bits", "points, kept", "own max, cm",
                     "nearest: mean / rms / p95 / max, cm", "D1 at 59.70 / 30 m, D2 likewise, dB", "MiB"], rows)


def table_speed(folder, file="codecs.jsonl"):
    """The setting of each series whose error is nearest to 5 cm, or the middle one."""
    rows = []
    for name, results in codec_results.read(folder, file).items():
        r = min(results, key=lambda r: abs(math.log(max(codec_results.rms_error_m(r), 1e-4) / 0.025)))
        times = [f"{r[side]['median']:.1f} / {r[side]['p95']:.1f}" for side in ("encode_ms", "decode_ms")]
        rows.append((r["encode_ms"]["median"],
                     [name, r["settings"], f"{r['bits_per_point']:.2f}"] + times + [str(r["rounds"])]))
    return markdown(["codec", "settings", "bpp", "encode ms, median / p95", "decode ms, median / p95", "rounds"],
                    [row for _, row in sorted(rows)])


def table_speed_rounds(folder):
    return table_speed(folder, "speed.jsonl")


def differs(values, base):
    """By Welch's t-test at 5 %: more than the spreads of both leave to chance."""
    squares = [statistics.variance(sample) / len(sample) for sample in (values, base)]
    freedom = sum(squares) ** 2 / sum(square ** 2 / (len(sample) - 1) for square, sample in zip(squares, (values, base)))
    t = abs(statistics.mean(values) - statistics.mean(base)) / math.sqrt(sum(squares))
    return t > T_5_PERCENT[min(int(freedom), len(T_5_PERCENT)) - 1]


def table_registration(folder, file="registration.jsonl"):
    """Error with its standard deviation over the seeds; in brackets the mean difference to the original's, bold where it
    is more than chance."""
    results, original = {}, {}
    with open(os.path.join(folder, file), encoding="utf-8") as lines:
        for r in map(json.loads, lines):
            if r["series"] == "original":
                original[r["method"]] = r
            results.setdefault((r["series"], r["settings"], r["bits_per_point"]), {})[r["method"]] = r
    rows = []
    for (name, settings, bits), by_method in sorted(results.items(), key=lambda item: -item[0][2]):
        if name != "original" and 96 / bits < LEAST_RATIO:
            continue
        row = [f"{name}, {settings}".strip(", "), f"{bits:.2f}", f"{96 / bits:.0f}"]
        for method, base in original.items():
            r = by_method[method]
            for key in ("translation_percent", "rotation_deg_per_100m"):
                values = r[key]
                cell = f"{statistics.mean(values):.2f} +- {statistics.stdev(values):.2f}"
                if name != "original":
                    difference = f"{statistics.mean(values) - statistics.mean(base[key]):+.2f}"
                    cell += f" (**{difference}**)" if differs(values, base[key]) else f" ({difference})"
                row.append(cell)
        rows.append(row)
    header = ["points", "bpp", "ratio"]
    for method in original:
        header += [f"{method}: translation %", "rotation deg/100 m"]
    return markdown(header, rows)


def table_registration_motion_unknown(folder):
    return table_registration(folder, "registration_motion_unknown.jsonl")


TABLES = {
    "equal-error": table_equal_error,
    "equal-error-vpcc": table_equal_error_vpcc,
    "settings": table_settings,
    "speed": table_speed,
    "speed-rounds": table_speed_rounds,
    "registration": table_registration,
    "registration-motion-unknown": table_registration_motion_unknown,
}


def main():
    out, document = sys.argv[1:]
    with open(document, encoding="utf-8") as file:
        text = file.read()

    def written(match):
        name, folder = match.group(1).split()
        try:
            table = TABLES[name](os.path.join(out, folder))
        except FileNotFoundError as error:
            print(f"codec_tables: {match.group(1)} left as it is: {error.filename} is not there")
            return match.group(0)
        return f"<!-- table {match.group(1)} -->\n\n{table}\n\n<!-- end -->"

    text = re.sub(r"<!-- table ([^>]*?) -->\n.*?<!-- end -->", written, text, flags=re.DOTALL)
    with open(document, "w", encoding="utf-8") as file:
        file.write(text)


main()
