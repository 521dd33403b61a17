"""Compares what the soak measured with its bounds."""
import math
import statistics

import histogram
from theil_sen import theil_sen

# A descriptor that is being accepted or closed while it is counted.
DESCRIPTORS_BOUND = 1.0


class Verdict:
    def __init__(self):
        self.lines, self.missed = [], []

    def say(self, line: str):
        self.lines.append(line)

    def check(self, name: str, value: float, bound: float, unit: str, more: str = ""):
        """A value that is not a number has missed its bound."""
        held = value <= bound
        line = f"{name}: {value:.4g} {unit}{more} (bound {bound:g} {unit})"
        self.lines.append(("ok      " if held else "MISSED  ") + line)
        if not held:
            self.missed.append(line)


def thirds(values: list) -> tuple[float, float]:
    """Medians of the first and of the last third."""
    third = max(1, len(values) // 3)
    return statistics.median(values[:third]), statistics.median(values[-third:])


def judge(rows: list[dict], ticks: list[dict], load: dict, arguments, tick_rate_hz: float) -> Verdict:
    """`rows`: samples after the warm-up; `ticks`: histograms of the ticks between them; `load`: JSON of the bench."""
    out = Verdict()
    calm = [row for row in rows if row["calm"]]
    out.say(f"{len(rows)} samples after the warm-up, {len(calm)} of them with the first scene only")
    if len(calm) < 3:
        out.missed.append(f"{len(calm)} samples to judge by, 3 are needed: run longer")
        return out
    for process in ("server", "edge", "nats"):
        slopes = {}
        for kind in ("rss_mb", "pss_mb", "anonymous_mb"):
            slopes[kind] = theil_sen([(row["time_s"] / 3600.0, row[f"{process}_{kind}"]) for row in calm])
        rss = slopes["rss_mb"]
        more = f", 95 % {rss.low:.3g} to {rss.high:.3g}; Pss {slopes['pss_mb'].value:.3g}, anonymous {slopes['anonymous_mb'].value:.3g}"
        size = statistics.median(row[f"{process}_rss_mb"] for row in calm)
        if process == "nats":  # not ours
            out.say(f"        memory of nats: {rss.value:.4g} MB/h{more}; {size:.1f} MB")
            continue
        out.check(f"memory of {process}", rss.value, arguments.memory_mb_per_h, "MB/h", more + f"; {size:.1f} MB")
        # Sockets of clients come and go with the clients.
        others = [row[f"{process}_descriptors"] - row[f"{process}_connections"] for row in calm]
        first, last = thirds(others)
        out.check(f"descriptors of {process} without clients, growth", last - first, DESCRIPTORS_BOUND, "", f", {first:g} to {last:g}")
        first, last = thirds([row[f"{process}_threads"] for row in calm])
        out.say(f"        threads of {process}: {first:g} in the first third, {last:g} in the last")
    tick_s = 1.0 / tick_rate_hz
    times = histogram.total(ticks)
    p50_ms, p99_ms = (1e3 * histogram.quantile(times, ratio) for ratio in (0.5, 0.99))
    out.check("tick p99", p99_ms, 1e3 * tick_s, "ms", f", p50 {p50_ms:.3g} ms, {times[math.inf]:.0f} ticks")
    factors = [row["real_time_factor"] for row in calm]
    out.say(f"        real-time factor: median {statistics.median(factors):.3f}, least {min(factors):.3f}")
    budget_ms = arguments.ack_budget_ms if arguments.ack_budget_ms is not None else 50.0 + 1e3 * tick_s
    out.check("ack p99", load["answer_p99_ms"], budget_ms, "ms", f", p50 {load['answer_p50_ms']:.3g} ms, {load['answers']} answers")
    out.check("ack p99 of boats that come and go", load["heavy_answer_p99_ms"], 1000.0 + budget_ms, "ms", f", {load['heavy_answers']} answers")
    for name in ("unanswered", "undecodable", "nonfinite", "watchdog_nonfinite"):
        out.check(name, load[name], 0.0, "")
    out.say(f"        rejected {load['rejected']}, reconnects {load['reconnects']} ({load['resumed']} resumed), ended by the "
            f"other side {load['ended']}, refused {load['refused']}, frames {load['frames']} ({load['decoded']} decoded)")  # fmt: skip
    return out
