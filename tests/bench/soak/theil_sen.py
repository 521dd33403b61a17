"""The slope of a line through points, robust against outliers: the median of the slopes of all pairs (Theil, Sen)."""
import math
import statistics


class Slope:
    """`value` with the interval `low` to `high` that has it with a probability of 95 % if the errors are independent.

    Samples of memory in a row are not quite independent, so the true interval is wider.
    """

    def __init__(self, value: float, low: float, high: float):
        self.value, self.low, self.high = value, low, high


def theil_sen(points: list[tuple[float, float]]) -> Slope:
    """Returns the slope of (x, y) points; needs two different x."""
    pairs = [(a, b) for k, a in enumerate(points) for b in points[k + 1 :] if a[0] != b[0]]
    if not pairs:
        raise ValueError(f"a slope needs points at two different x, there are {len(points)} points")
    slopes = sorted((b[1] - a[1]) / (b[0] - a[0]) for a, b in pairs)
    # Kendall's statistic of n points has this variance; Sen 1968 takes the slopes at its quantiles.
    count = len(points)
    width = 1.96 * math.sqrt(count * (count - 1) * (2 * count + 5) / 18.0)
    low = max(0, math.floor((len(slopes) - width) / 2.0))
    high = min(len(slopes) - 1, math.ceil((len(slopes) + width) / 2.0))
    return Slope(statistics.median(slopes), slopes[low], slopes[high])
