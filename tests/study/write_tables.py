#!/usr/bin/env python3
"""Writes what the documents and the server say of the trade study, from docs/plots/trade.json:

    write_tables.py [--root FOLDER]                      the tables and the errors that the server tells
    write_tables.py [--root FOLDER] --check              only compares; exit code 1 and the names of files that differ
    write_tables.py [--root FOLDER] --take FILE COMMIT   first makes trade.json of FILE, which `spindrift-study --suite trade` wrote

A table stands in a document between the marks `<!-- study:NAME -->` and `<!-- /study -->`; every function table_NAME below is one.
`./dev study --update` runs all of it.
"""
import argparse
import datetime
import json
import pathlib
import re
import sys

HERE = pathlib.Path(__file__).resolve()
FIGURES = "docs/plots/trade.json"
DOCUMENTS = ["docs/study.md", "docs/accuracy.md"]
ERRORS = "server/scenes/fidelity_errors.txtpb"  # text of proto/spindrift/v1/fidelity_errors.proto
MARKED = re.compile(r"(<!-- study:(\w+) -->\n).*?(<!-- /study -->)", re.DOTALL)
LEVELS = ["draft", "balanced", "fine", "reference"]
LEVEL = "fidelity"  # the knob of the rows that are fidelity levels
SIMPLER = [("dispersion", "off"), ("bulk", "linear"), ("bulk, dispersion", "linear, off")]
SUFFICES = 0.05  # the error of "a level suffices"
ROW = ["knob", "setting", "refused", "cost_ms_per_s", "height_rms_ratio", "device_mb", "stream_mbit_per_s", "on_front"]
COST = ["knob", "setting", "cost_ms_per_s", "device_mb", "pass_ms_per_s"]


def digits(value, count=3):
    """A number with `count` digits, without an exponent."""
    rounded = float(f"{value:.{count - 1}e}")
    return f"{rounded:.0f}" if abs(rounded) >= 10 ** (count - 1) else f"{rounded:.{count}g}"


def percent(ratio, count=2):
    return f"{digits(100 * ratio, count)} %"


def seconds(ms):
    return f"{digits(ms / 1000, 2)} s"


def rounded(value):
    """The value with five digits in every number: what is kept."""
    if isinstance(value, float):
        return float(f"{value:.5g}")
    if isinstance(value, list):
        return [rounded(one) for one in value]
    return {key: rounded(one) for key, one in value.items()} if isinstance(value, dict) else value


def taken(results, commit):
    """What is kept of the results of the program."""
    kept = {"suite": "trade", "date": datetime.datetime.now(datetime.timezone.utc).date().isoformat(), "commit": commit}
    kept |= {key: results[key] for key in ["device", "threads", "state_hashes"]}
    kept["scenes"] = [
        {**scene, "rows": [{key: row[key] for key in ROW} for row in scene["rows"]]} for scene in results["scenes"]
    ]
    kept |= {key: results[key] for key in ["over_all_scenes", "known"]}
    kept["costs"] = [{key: row[key] for key in COST} for row in results["costs"]]
    return rounded(kept)


def written(figures):
    """JSON with one row per line."""
    text = json.dumps(figures, indent=1)
    # The innermost objects and lists on one line each.
    inner = re.compile(r"([\[{])\n\s+([^\[\]{}]*?)\s*\n\s*([\]}])")
    for _ in range(2):
        text = inner.sub(lambda m: m[1] + re.sub(r",\n\s+", ", ", m[2]) + m[3], text)
    return text + "\n"


def errors_text(figures):
    """What the server tells of each scene: the error at each level."""
    lines = [
        "# Written by tests/study/write_tables.py from docs/plots/trade.json; `./dev study --update` measures it again.",
        f'measured_on: "{figures["date"]}"',
        f'commit: "{figures["commit"]}"',
    ]
    for scene in figures["scenes"]:
        ratios = ", ".join(digits(row_of(scene, LEVEL, level)["height_rms_ratio"], 2) for level in LEVELS)
        lines.append(f'scenes {{ name: "{scene["scene"]}" error_ratios: [{ratios}] }}')
    return "\n".join(lines) + "\n"


def row_of(scene, knob, setting):
    return next((row for row in scene["rows"] if (row["knob"], row["setting"]) == (knob, setting)), None)


def mean_of(figures, level):
    return next(mean for mean in figures["over_all_scenes"] if mean["setting"] == level)


def table(figures, head, rows):
    """A Markdown table with the date and the commit of its figures."""
    lines = [head, ["---"] * len(head), *rows]
    text = "\n".join("| " + " | ".join(line) + " |" for line in lines)
    stamp = f"Measured {figures['date']} at `{figures['commit']}`, {figures['threads']} hardware threads, {figures['device']}."
    return f"{text}\n\n{stamp}\n"


def table_levels(figures):
    head = ["scene", "simulated", *[level.upper() for level in LEVELS]]
    rows = []
    for scene in figures["scenes"]:
        cells = [row_of(scene, LEVEL, level) for level in LEVELS]
        cells = [f"{seconds(row['cost_ms_per_s'])}, {percent(row['height_rms_ratio'])}" for row in cells]
        rows.append([scene["scene"], f"{scene['seconds']:g} s", *cells])
    means = [mean_of(figures, level) for level in LEVELS]
    cells = [f"x {digits(mean['cost_ratio'], 2)}, x {digits(mean['error_ratio'], 2)}" for mean in means]
    return table(figures, head, [*rows, ["geometric mean over BALANCED", "", *cells]])


def table_means(figures):
    scales = {
        "draft": ("x 0.5", "x 0.7", "as they are"),
        "balanced": ("as they are",) * 3,
        "fine": ("x 1.5", "x 1.7", "as they are"),
        "reference": ("x 2.5", "x 2.2", "half as long"),
    }
    rows = []
    for level in LEVELS:
        mean = mean_of(figures, level)
        rows.append([level.upper(), *scales[level], f"x {digits(mean['cost_ratio'], 2)}", f"x {digits(mean['error_ratio'], 2)}"])
    return table(figures, ["level", "wave cells per side", "particles across", "steps", "cost", "error"], rows)


def table_models(figures):
    """BALANCED as it is, and with a simpler wave: cost and error."""
    rows = []
    for scene in figures["scenes"]:
        choices = [row_of(scene, knob, setting) for knob, setting in SIMPLER]
        if not any(choices):
            continue
        cells = []
        for row in [row_of(scene, LEVEL, "balanced"), *choices]:
            if row is None:
                cells.append("-")
            elif row["refused"]:
                cells.append("refused")
            else:
                cells.append(f"{seconds(row['cost_ms_per_s'])}, {percent(row['height_rms_ratio'])}")
        rows.append([scene["scene"], *cells])
    return table(figures, ["scene", "BALANCED", "without dispersion", "BULK_LINEAR", "BULK_LINEAR without dispersion"], rows)


def table_known(figures):
    rows = []
    for known in figures["known"]:
        errors = known["error_ratio"]
        # From the first level on from which no finer one is worse than the bound.
        enough = next((LEVELS[i].upper() for i in range(len(LEVELS)) if max(errors[i:]) <= SUFFICES), "none")
        rows.append([known["name"], known["source"], *[percent(error) for error in errors], enough])
    head = ["error of", "compared with", *[level.upper() for level in LEVELS], f"within {100 * SUFFICES:.0f} % from"]
    return table(figures, head, rows)


def table_knobs(figures):
    """BALANCED with one setting changed: cost and error over those of BALANCED in each scene that has it."""
    scenes = [scene for scene in figures["scenes"] if any(row["knob"] == "seed" for row in scene["rows"])]
    simpler = [knob for knob, _ in SIMPLER]
    names = []
    for scene in scenes:
        for row in scene["rows"]:
            name = (row["knob"], row["setting"])
            if row["knob"] != LEVEL and row["knob"] not in simpler and name not in names:
                names.append(name)
    knobs = [knob for knob, _ in names]
    names.sort(key=lambda name: knobs.index(name[0]))  # the settings of a knob together
    rows = []
    for name in names:
        cells = []
        for scene in scenes:
            row, balanced = row_of(scene, *name), row_of(scene, LEVEL, "balanced")
            if row is None or row["refused"]:
                cells.append("-" if row is None else "refused")
                continue
            cost = digits(row["cost_ms_per_s"] / balanced["cost_ms_per_s"], 2)
            error = digits(row["height_rms_ratio"] / balanced["height_rms_ratio"], 2)
            cells.append(f"x {cost}, x {error}{' *' if row['on_front'] else ''}")
        rows.append([*name, *cells])
    return table(figures, ["setting changed", "to", *[scene["scene"] for scene in scenes]], rows)


def table_streams(figures):
    rows = []
    for scene in figures["scenes"]:
        cells = [row_of(scene, LEVEL, level) for level in LEVELS]
        rows.append([scene["scene"], *[f"{digits(row['device_mb'], 2)} MB, {digits(row['stream_mbit_per_s'], 2)} Mbit/s" for row in cells]])
    return table(figures, ["scene", *[level.upper() for level in LEVELS]], rows)


def table_costs(figures):
    def passes(row, names):
        found = [row["pass_ms_per_s"][name] for name in names if name in row["pass_ms_per_s"]]
        return f"{100 * sum(found) / sum(row['pass_ms_per_s'].values()):.0f} %" if found else "-"

    rows = []
    for row in figures["costs"]:
        ms = row["cost_ms_per_s"]
        cells = [digits(ms), digits(row["device_mb"])]
        rows.append([row["knob"], row["setting"], *cells, passes(row, ["grid"]), passes(row, ["sph", "pbf"]), passes(row, ["wave"])])
    head = ["parts", "size", "ms per simulated second", "MB on the device", "grid", "sph / pbf", "wave"]
    return table(figures, head, rows)


def files_of(root, figures):
    """What every file has to contain, by its name."""
    out = {FIGURES: written(figures), ERRORS: errors_text(figures)}
    for name in DOCUMENTS:
        text = (root / name).read_text(encoding="utf-8")
        out[name] = MARKED.sub(lambda mark: mark[1] + globals()[f"table_{mark[2]}"](figures) + mark[3], text)
    return out


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--root", type=pathlib.Path, default=HERE.parents[2])
    parser.add_argument("--check", action="store_true")
    parser.add_argument("--take", nargs=2, metavar=("FILE", "COMMIT"))
    arguments = parser.parse_args()
    if arguments.take:
        results = json.loads(pathlib.Path(arguments.take[0]).read_text(encoding="utf-8"))
        figures = taken(results, arguments.take[1])
    else:
        figures = json.loads((arguments.root / FIGURES).read_text(encoding="utf-8"))
    differing = []
    for name, text in files_of(arguments.root, figures).items():
        file = arguments.root / name
        if file.is_file() and file.read_text(encoding="utf-8") == text:
            continue
        differing.append(name)
        if not arguments.check:
            file.write_text(text, encoding="utf-8")
    for name in differing:
        print(f"{name}: differs from {FIGURES}: run `./dev study --update`" if arguments.check else f"wrote {name}")
    return 1 if arguments.check and differing else 0


if __name__ == "__main__":
    sys.exit(main())
