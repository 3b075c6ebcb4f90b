"""How the curve of each codec looks, by the name of its series."""

# Ours stand out. The same image codec has one colour on both grids, and a broken line on the uniform one.
STYLES = {
    "mixture fast": ("#f4a582", "o"),
    "mixture balanced": ("#d6191b", "o"),
    "mixture max": ("#67001f", "o"),
    "planes sensor fast": ("#92c5de", "o"),
    "planes sensor balanced": ("#2b7bba", "o"),
    "planes": ("#08306b", "o"),
    "G-PCC predictive, corrected": ("#525252", "X"),
    "G-PCC predictive": ("#000000", "s"),
    "G-PCC octree": ("#969696", "s"),
    "V-PCC": ("#bdbdbd", "s"),
    "Draco": ("#1b9e77", "D"),
    "Cloudini": ("#66c2a4", "D"),
    "PCL octree, a point a voxel": ("#8c6d1f", "^"),
    "PCL octree": ("#d9b44a", "^"),
    "JPEG XL": ("#7b3294", "v"),
    "PNG-16": ("#c994c7", "v"),
    "JPEG-LS": ("#e7298a", "v"),
    "JPEG": ("#bcbd22", "v"),
    "H.264 lossless": ("#a6761d", "P"),
    "H.264": ("#e66101", "P"),
    "H.265 lossless": ("#fdb863", "P"),
    "xz": ("#999999", "x"),
    "zstd": ("#bbbbbb", "x"),
}


def prefix_of(name):
    return max((prefix for prefix in STYLES if name.startswith(prefix)), key=len, default=None)


def is_ours(name):
    return name.startswith(("mixture", "planes"))


def style(name):
    prefix = prefix_of(name)
    if prefix is None:
        return {"color": "#444444", "marker": "."}
    colour, marker = STYLES[prefix]
    dashed = "uniform" in name and not is_ours(name) or "groups" in name
    return {
        "color": colour,
        "linestyle": "--" if dashed else "-",
        "linewidth": 2.4 if is_ours(name) else 1.2,
        "marker": marker,
        "markersize": 6 if is_ours(name) else 4,
        "zorder": 3 if is_ours(name) else 2,
    }


def in_order(series):
    """Series by name, in the order of the list above."""
    order = list(STYLES)

    def place(item):
        prefix = prefix_of(item[0])
        return (len(order) if prefix is None else order.index(prefix), item[0])

    return dict(sorted(series.items(), key=place))
