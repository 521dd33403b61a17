"""The parts of a discrete-event simulation: a queue of events, workers that do one job at a time, and samples."""
import heapq
import math


class EventQueue:
    """Events in the order of their time; events at the same time run in the order in which they were added."""

    def __init__(self):
        self.now_s = 0.0
        self._events = []
        self._count = 0

    def at(self, time_s: float, action):
        self._count += 1
        heapq.heappush(self._events, (max(time_s, self.now_s), self._count, action))

    def every(self, interval_s: float, phase_s: float, action):
        def again():
            action()
            self.at(self.now_s + interval_s, again)

        self.at(self.now_s + phase_s, again)

    def run_until(self, end_s: float):
        while self._events and self._events[0][0] <= end_s:
            self.now_s, _, action = heapq.heappop(self._events)
            action()
        self.now_s = end_s


class Worker:
    """Does one job at a time, in the order in which they come: a thread, or the sending side of a network link."""

    def __init__(self):
        self.free_at_s = 0.0
        self.busy_s = 0.0

    def do(self, now_s: float, work_s: float) -> float:
        """Returns when the job will be done."""
        self.free_at_s = max(self.free_at_s, now_s) + work_s
        self.busy_s += work_s
        return self.free_at_s


class Samples:
    """Values with weights, for quantiles."""

    def __init__(self):
        self._values = []
        self.weight = 0.0

    def add(self, value: float, weight: float = 1.0):
        self._values.append((value, weight))
        self.weight += weight

    def quantile(self, share: float, factor: float = 1.0) -> float | None:
        """Returns the quantile times `factor`; None if there are no values."""
        if not self._values:
            return None
        left = share * self.weight
        self._values.sort()
        for value, weight in self._values:
            left -= weight
            if left <= 0.0:
                return value * factor
        return self._values[-1][0] * factor


def log_normal(random, median: float, p99: float) -> float:
    """Draws from the log-normal distribution with this median and this 99 % quantile."""
    if median <= 0.0:
        return 0.0
    return median * math.exp(random.gauss(0.0, math.log(max(p99, median) / median) / 2.326))
