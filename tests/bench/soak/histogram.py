"""Histograms of /metrics: their difference between two moments, and quantiles as Prometheus computes them."""
import math


def buckets_of(metrics: dict, name: str, labels: str) -> dict:
    """Returns {upper bound: number up to it} of the histogram `name` with `labels`, as in `room="main"`."""
    start = f"{name}_bucket{{{labels},le=\""
    out = {float(key[len(start) : -2]): value for key, value in metrics.items() if key.startswith(start)}
    if not out:
        raise KeyError(f"/metrics has no histogram {name} with {labels}")
    return out


def difference(later: dict, earlier: dict) -> dict:
    """What was counted between; a histogram that began again (a room that moved) counts from its beginning."""
    if any(later[bound] < earlier.get(bound, 0.0) for bound in later):
        return dict(later)
    return {bound: count - earlier.get(bound, 0.0) for bound, count in later.items()}


def total(buckets: list[dict]) -> dict:
    """Adds histograms of the same bounds."""
    out = {}
    for one in buckets:
        for bound, count in one.items():
            out[bound] = out.get(bound, 0.0) + count
    return out


def quantile(buckets: dict, ratio: float) -> float:
    """Interpolates inside the bucket of the quantile; its lower bound for the last bucket; nan without counts."""
    bounds = sorted(buckets)
    if not bounds or buckets[bounds[-1]] == 0:
        return math.nan
    rank = ratio * buckets[bounds[-1]]
    below, low = 0.0, 0.0
    for bound in bounds:
        if buckets[bound] >= rank:
            if math.isinf(bound):
                return low
            share = (rank - below) / (buckets[bound] - below) if buckets[bound] > below else 1.0
            return low + (bound - low) * share
        below, low = buckets[bound], bound
    return low
