"""What `pointreel bench --plots` leaves in a folder's codecs.jsonl, as curves: a list of settings for each series."""
import json
import math
import os


def read(folder, file="codecs.jsonl"):
    """Series by name, each a list of results by rate; those that failed are left out."""
    series = {}
    with open(os.path.join(folder, file), encoding="utf-8") as lines:
        for line in lines:
            result = json.loads(line)
            if not result["failures"]:
                series.setdefault(result["series"], []).append(result)
    for results in series.values():
        results.sort(key=lambda result: result["bits_per_point"])
    return series


def max_error_m(result):
    """Each point to its own where that is known, else to the nearest one, the worse direction."""
    if "own_error" in result:
        return result["own_error"]["max_m"]
    return max(result[side]["max_m"] for side in ("nearest_decoded", "nearest_original"))


def rms_error_m(result):
    """To the nearest point, the worse direction."""
    return max(result[side]["rms_m"] for side in ("nearest_decoded", "nearest_original"))


def bits_at(results, bound_m):
    """The least rate of a series whose largest error is within the bound: a setting's own, or on the line between
    two settings over the logarithm of the error. None where every setting is off by more."""
    tolerance_m = 1e-6  # float32 distances
    points = sorted((max_error_m(result), result["bits_per_point"]) for result in results)
    within = [bits for error_m, bits in points if error_m <= bound_m + tolerance_m]
    if not within:
        return None
    best = min(within)
    for (error_a, bits_a), (error_b, bits_b) in zip(points, points[1:]):
        if 0 < error_a < bound_m < error_b:
            share = math.log(bound_m / error_a) / math.log(error_b / error_a)
            best = min(best, bits_a + share * (bits_b - bits_a))
    return best
