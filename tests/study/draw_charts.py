#!/usr/bin/env python3
"""Draws the charts of a study: `draw_charts.py [--list] FOLDER`.

FOLDER holds accuracy.json, stability.json or trade.json, as `spindrift-study --suite SUITE --plot FOLDER` writes them;
the charts are SVG files beside them. --list prints their names and draws nothing, so it does not need matplotlib.
"""
import argparse
import dataclasses
import json
import math
import pathlib
import re
import sys

# Distinguishable for red-green colour-blind readers (Okabe & Ito 2008), and dark enough for print.
COLOURS = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#7a5c00", "#444444"]
MARKERS = ["o", "s", "^", "D", "v", "P", "X", "<", "*"]
LEVEL = "fidelity"  # the knob of the rows that are fidelity levels
COST_LABEL = "processor time per simulated second [ms]"
ERROR_LABEL = "RMS error of the water height [%]"


@dataclasses.dataclass
class Point:
    x: float
    y: float
    label: str = ""


@dataclasses.dataclass
class Series:
    """Points under one name in the legend. style: "line", "dashes", "dots" or "line and dots"."""

    name: str
    points: list[Point]
    style: str
    size: float = 5.0  # of a dot, in points
    colour: str = ""  # empty: the next of COLOURS
    marker: str = "o"
    is_bold: bool = False  # its labels


@dataclasses.dataclass
class Chart:
    name: str  # of the file, without ".svg"
    title: str
    x_label: str
    y_label: str
    series: list[Series]
    is_x_logarithmic: bool = False
    is_y_logarithmic: bool = False
    bound: tuple[float, str] | None = None  # a vertical line: position and text


@dataclasses.dataclass
class FieldChart:
    """Fields on the same cells side by side: (name, rows of values) each."""

    name: str
    title: str
    unit: str
    corners: tuple[float, float, float, float]  # x from, x to, z from, z to [m]
    panels: list[tuple[str, list[list[float]]]]


def accuracy_charts(results):
    """One chart for each figure of each case: measured points of others, lines of the simulation."""
    for case in results["cases"]:
        for field in case.get("fields", []):
            yield field_chart(field)
        for figure in case["figures"]:
            series = []
            experiments = 0
            for curve in figure["curves"]:
                points = [Point(x, y) for x, y in curve["points"]]
                if curve["is_measured"]:
                    series.append(Series(curve["name"], points, "dots", 5.5, "#444444", MARKERS[experiments]))
                    experiments += 1
                else:
                    series.append(line_of(curve["name"], points, series))
            logarithmic = figure["is_logarithmic"]
            name = f"accuracy_{figure['name']}"
            yield Chart(name, figure["title"], figure["x_label"], figure["y_label"], series, logarithmic, logarithmic)


def field_chart(field):
    columns, cell, step = field["columns_count"], field["cell_m"], field["step"]
    panels = []
    for panel in field["panels"]:
        values = [value * step for value in panel["steps"]]
        panels.append((panel["name"], [values[i : i + columns] for i in range(0, len(values), columns)]))
    x, z = field["first_x_m"], field["first_z_m"]
    corners = (x, x + columns * cell, z, z + len(panels[0][1]) * cell)
    return FieldChart(f"accuracy_{field['name']}", field["title"], field["unit"], corners, panels)


def line_of(name, points, others):
    """A line; a variant of another one ("A, leading edge" of "A") gets its colour and dashes."""
    for other in others:
        if name.startswith(f"{other.name}, "):
            return Series(name, points, "dashes", colour=other.colour)
    lines_count = sum(other.style == "line" for other in others)
    return Series(name, points, "line", colour=COLOURS[lines_count % len(COLOURS)])


def stability_charts(results):
    """One chart for each sweep: how much energy grew at each value."""
    for sweep in results["sweeps"]:
        kinds = {
            "stable": Series("stable", [], "dots", 7, COLOURS[0], "o"),
            "unstable": Series("unstable, recovered", [], "dots", 7, COLOURS[1], "X"),
            "lost": Series("lost", [], "dots", 8, "#000000", "*"),
        }
        for point in sweep["points"]:
            if point["refused"]:
                continue
            is_safe = point["frames_finite"] and point["well_after"] and point["slowest_step_s"] < 10
            kind = "stable" if point["stable"] else "unstable" if is_safe else "lost"
            label = f"watchdog {point['guard_count']}" if point["guard_count"] > 0 else ""
            kinds[kind].points.append(Point(point["value"], max(point["energy_growth"], 1e-6), label))
        values = [point["value"] for point in sweep["points"]]
        yield Chart(
            "stability_" + re.sub(r"[^A-Za-z0-9]", "_", sweep["name"]),
            f"Stability: {sweep['name']}",
            f"{sweep['name']} [{sweep['unit']}]" if sweep["unit"] else sweep["name"],
            "largest energy / initial or possible energy [-]",
            [series for series in kinds.values() if series.points],
            is_x_logarithmic=values[0] > 0 and values[-1] / values[0] >= 20,
            is_y_logarithmic=True,
            bound=(sweep["predicted_bound"], "bound by the rules") if "predicted_bound" in sweep else None,
        )


def trade_charts(results):
    """Cost against error: one chart of the fidelity levels of all scenes, and one for each scene with single changes."""
    scenes = results["scenes"]
    stamp = f" ({results['date']}, {results['commit']})" if "date" in results else ""
    series = []
    for index, scene in enumerate(scenes):
        points = [point for row, point in trade_points(scene) if row["knob"] == LEVEL]
        if index > 0:
            points = [dataclasses.replace(point, label="") for point in points]
        series.append(Series(scene["scene"], points, "line and dots", 5.5, marker=MARKERS[index % len(MARKERS)]))
    if len(scenes) > 1:
        yield trade_chart("trade", f"Cost of accuracy: fidelity levels{stamp}", series)
    for scene in scenes:
        levels, changes, front = [], [], []
        for row, point in trade_points(scene):
            if row["on_front"]:
                front.append(Point(point.x, point.y))
            if row["knob"] == LEVEL:
                levels.append(point)
            else:
                changes.append(point if row["on_front"] else dataclasses.replace(point, label=""))
        # Another seed is among the settings that are changed one at a time.
        if len(scenes) > 1 and not any(row["knob"] == "seed" for row in scene["rows"]):
            continue
        front.sort(key=lambda point: point.x)
        yield trade_chart(
            f"trade_{scene['scene']}",
            f"Cost of accuracy: {scene['scene']}{stamp}",
            [
                Series("no other is cheaper and closer, beyond chance", front, "line", colour="#999999"),
                Series("one setting of BALANCED changed", changes, "dots", 4.5, COLOURS[0], "o"),
                Series("fidelity levels", levels, "dots", 8, COLOURS[1], "s", is_bold=True),
            ],
        )


def trade_points(scene):
    """The rows of a scene that ran, each with its place in a chart."""
    for row in scene["rows"]:
        if not row["refused"]:
            label = row["setting"] if row["knob"] == LEVEL else f"{row['knob']} {row['setting']}"
            yield row, Point(row["cost_ms_per_s"], 100 * row["height_rms_ratio"], label)


def trade_chart(name, title, series):
    series = [one for one in series if one.points]
    return Chart(name, title, COST_LABEL, ERROR_LABEL, series, True, True, (1000.0, "one core, real time"))


SUITES = {"accuracy": accuracy_charts, "stability": stability_charts, "trade": trade_charts}


def charts_of(folder):
    """Every chart of the results in the folder."""
    files = [(folder / f"{suite}.json", draw) for suite, draw in SUITES.items()]
    found = [(file, draw) for file, draw in files if file.is_file()]
    if not found:
        names = ", ".join(file.name for file, _ in files)
        sys.exit(f"draw_charts: {folder}: none of {names} is there; `spindrift-study --plot {folder}` writes them")
    for file, draw in found:
        yield from draw(json.loads(file.read_text(encoding="utf-8")))


def load_matplotlib():
    """Sets matplotlib up for SVG files whose bytes depend on the numbers only."""
    try:
        import matplotlib
    except ImportError:
        sys.exit("draw_charts: matplotlib is missing: apt-get install python3-matplotlib")
    matplotlib.use("svg")
    matplotlib.rcParams.update({
        "svg.hashsalt": "spindrift",  # the same ids in every run
        "svg.fonttype": "none",  # text stays text
        "font.size": 10,
        "axes.titlesize": 12,
        "axes.grid": True,
        "axes.axisbelow": True,
        "grid.color": "#dddddd",
        "axes.spines.top": False,
        "axes.spines.right": False,
        "legend.frameon": False,
    })


def write_chart(chart, folder):
    from matplotlib import pyplot, ticker

    figure, axes = pyplot.subplots(figsize=(8, 5), dpi=72, layout="constrained")  # one unit of SVG is one point
    axes.set_title(chart.title)
    axes.set_xlabel(chart.x_label)
    axes.set_ylabel(chart.y_label)
    number = ticker.FuncFormatter(lambda value, _: f"{value:,.12g}")
    axes.set_xscale("log" if chart.is_x_logarithmic else "linear")
    axes.set_yscale("log" if chart.is_y_logarithmic else "linear")
    for axis in (axes.xaxis, axes.yaxis):
        if axis.get_scale() == "log":
            axis.set_major_locator(ticker.LogLocator(subs=(1, 2, 5)))
            axis.set_minor_formatter(ticker.NullFormatter())
            axis.set_major_formatter(number)
    colours = iter(COLOURS * 4)
    for series in chart.series:
        drawable = [point for point in series.points if is_drawable(chart, point)]
        colour = series.colour or next(colours)
        axes.plot(
            [point.x for point in drawable],
            [point.y for point in drawable],
            label=series.name,
            color=colour,
            linestyle={"dots": "none", "dashes": "--"}.get(series.style, "-"),
            marker=series.marker if "dots" in series.style else "",
            markersize=series.size,
            linewidth=1.5,
        )
    if chart.bound:
        place, text = chart.bound
        axes.axvline(place, color="#333333", linestyle="--", linewidth=1)
        axes.annotate(text, (place, 0), (4, 6), ("data", "axes fraction"), "offset points", fontsize=8.5)
    legend = axes.legend(fontsize=9)
    figure.draw_without_rendering()  # the places of everything so far
    write_labels(chart, axes, legend)
    figure.savefig(folder / f"{chart.name}.svg", metadata={"Date": None, "Creator": None})
    pyplot.close(figure)


def write_field_chart(chart, folder):
    from matplotlib import pyplot

    figure, all_axes = pyplot.subplots(1, len(chart.panels), figsize=(10, 4.2), dpi=72, layout="constrained", sharey=True)
    figure.suptitle(chart.title)
    # The waves under a hull are several times as high as those behind it.
    largest = 0.5 * max(abs(value) for _, rows in chart.panels for row in rows for value in row)
    for axes, (name, rows) in zip(all_axes, chart.panels):
        image = axes.imshow(rows, origin="lower", extent=chart.corners, cmap="RdBu_r", vmin=-largest, vmax=largest,
                            interpolation="none")  # the viewer enlarges the cells
        axes.set_title(name)
        axes.set_xlabel("x [m]")
        axes.grid(False)
    all_axes[0].set_ylabel("z [m]")
    figure.colorbar(image, ax=list(all_axes), label=f"elevation [{chart.unit}]", extend="both", shrink=0.8)
    figure.savefig(folder / f"{chart.name}.svg", metadata={"Date": None, "Creator": None})
    pyplot.close(figure)


def is_drawable(chart, point):
    """Infinite values, and zero on a logarithmic axis, have no place."""
    is_finite = math.isfinite(point.x) and math.isfinite(point.y)
    return is_finite and (point.x > 0 or not chart.is_x_logarithmic) and (point.y > 0 or not chart.is_y_logarithmic)


# Offsets of a label from its point, in points, with its alignments. The first that covers least is taken.
NEAR_PLACES = [
    ((6, 5), "left", "bottom"), ((6, -5), "left", "top"), ((-6, 5), "right", "bottom"), ((-6, -5), "right", "top"),
    ((0, 9), "center", "bottom"), ((0, -9), "center", "top"),
]
FAR_PLACES = [
    ((x, y), "left" if x > 0 else "right", "center") for x in (24, -24) for y in (20, -20, 36, -36, 52, -52)
]


def write_labels(chart, axes, legend):
    """Writes the labels of all points beside them, where they cover neither points, lines, legend nor each other."""
    taken = [legend.get_window_extent(), *(text.get_window_extent() for text in axes.texts)]
    labels = []
    for series in chart.series:
        drawable = [point for point in series.points if is_drawable(chart, point)]
        places = [axes.transData.transform((point.x, point.y)) for point in drawable]
        if "dots" in series.style:
            taken += [box_around(place, 0.5 * series.size + 1) for place in places]
        if series.style != "dots":
            taken += boxes_along(places)
        labels += [(series.is_bold, point) for point in drawable if point.label]
    if chart.bound:
        x = axes.transData.transform((chart.bound[0], 1))[0]
        taken += boxes_along([(x, axes.bbox.y0), (x, axes.bbox.y1)])
    labels.sort(key=lambda label: not label[0])  # bold ones have the first choice
    for is_bold, point in labels:
        label = axes.annotate(point.label, (point.x, point.y), (0, 0), textcoords="offset points", fontsize=8.5,
                              fontweight="bold" if is_bold else "normal", in_layout=False)
        covered = []
        for place in NEAR_PLACES + FAR_PLACES:
            put_label(label, place)
            box = label.get_window_extent()
            is_inside = axes.bbox.x0 <= box.x0 and box.x1 <= axes.figure.bbox.x1 and axes.bbox.y0 <= box.y0
            covered.append(box.count_overlaps(taken) + (0 if is_inside else 1000))
        chosen = (NEAR_PLACES + FAR_PLACES)[covered.index(min(covered))]
        put_label(label, chosen)
        taken.append(label.get_window_extent())
        if chosen in FAR_PLACES:
            leader = {"arrowstyle": "-", "color": "#999999", "linewidth": 0.6, "shrinkA": 1, "shrinkB": 3}
            axes.annotate("", (point.x, point.y), chosen[0], textcoords="offset points", arrowprops=leader, in_layout=False)


def put_label(label, place):
    offset, horizontal, vertical = place
    label.set(position=offset, horizontalalignment=horizontal, verticalalignment=vertical)


def box_around(place, half):
    from matplotlib.transforms import Bbox

    return Bbox.from_extents(place[0] - half, place[1] - half, place[0] + half, place[1] + half)


def boxes_along(places, step=4.0):
    """Small boxes along a line through `places`."""
    boxes = []
    for (x0, y0), (x1, y1) in zip(places, places[1:]):
        count = int(math.hypot(x1 - x0, y1 - y0) / step) + 1
        boxes += [box_around((x0 + (x1 - x0) * i / count, y0 + (y1 - y0) * i / count), 1) for i in range(count)]
    return boxes


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--list", action="store_true", help="print the names of the charts only")
    arguments = parser.parse_args()
    charts = list(charts_of(arguments.folder))
    if not arguments.list:
        load_matplotlib()
    for chart in charts:
        if not arguments.list:
            write = write_field_chart if isinstance(chart, FieldChart) else write_chart
            write(chart, arguments.folder)
        print(f"{chart.name}.svg")


if __name__ == "__main__":
    main()
