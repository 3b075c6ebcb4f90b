"""How the curve of each codec looks, by the name of its series."""

# Ours stand out; the same image codec has one colour on both grids.
COLOURS = {
    "mixture fast": "#f4a582",
    "mixture balanced": "#d6191b",
    "mixture max": "#67001f",
    "planes sensor fast": "#92c5de",
    "planes sensor balanced": "#4393c3",
    "planes": "#2166ac",
    "G-PCC predictive": "#000000",
    "G-PCC octree": "#777777",
    "draco": "#1b9e77",
    "PCL octree, a point a voxel": "#b8860b",
    "PCL octree": "#e6ab02",
    "JPEG XL": "#7b3294",
    "PNG-16": "#c994c7",
    "JPEG-LS": "#e7298a",
    "JPEG": "#cccc00",
    "H.264 lossless": "#41b6c4",
    "H.264": "#225ea8",
    "H.265 lossless": "#7fcdbb",
    "xz": "#999999",
    "zstd": "#bbbbbb",
}


def style(name):
    for prefix in sorted(COLOURS, key=len, reverse=True):
        if name.startswith(prefix):
            ours = prefix.startswith(("mixture", "planes"))
            dashed = "uniform" in name and not ours or "groups" in name
            return {
                "color": COLOURS[prefix],
                "linestyle": "--" if dashed else "-",
                "linewidth": 2.4 if ours else 1.2,
                "marker": "o" if ours else ".",
                "markersize": 5,
                "zorder": 3 if ours else 2,
            }
    return {"color": "#444444", "marker": "."}
