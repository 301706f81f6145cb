# SPDX-License-Identifier: BSD-3-Clause
"""What scaling_study.py says: tables on the screen, scaling.csv, scaling.json, and a figure for each study."""

import csv
import dataclasses
import json

import matplotlib

matplotlib.use("Agg")  # no display needed

import matplotlib.pyplot as plt
import numpy

from performance_model import LEAST_SIZES, fit_power_law

RESOURCES = {  # name: key of a row, unit, units of the key in it
    "time": ("core_hours", "core-h", 1),
    "operations": ("flop", "flop", 1),
    "memory": ("peak_rss_bytes", "GB", 1e9),
}
LABELS = {"time": "core time", "operations": "operations", "memory": "memory of all ranks"}
COLOURS, MARKERS = plt.cm.tab10.colors, "os^Dv<>pP*"
# Table 1 of the paper: alpha, beta, gamma; time in node-hours of 48 cores, memory in GB.
PAPER = {
    "vessel": ("nodes", {"time": "0.106 + 1.54e-3 p^1.0", "operations": "1.27e12", "memory": "0.71 + 0.18 p^0.98"}),
    "network": ("vessels", {"time": "1.47e-9 p^1.05", "operations": "1.21e6 p^0.58", "memory": "8.14e-7 p^1.0"}),
    "coupled": ("vessels", {"time": "1.59e-9 p^1.04", "operations": "1.27e12 + 1.21e6 p^0.58", "memory": "8.22e-7 p^1.0"}),
}
COLUMNS = ["study", "size", "ranks", "threads", "cores", "nodes", "particles", "vessels", "p", "steps", "runs", "wall_s",
           "wall_min_s", "wall_max_s", "solve_s", "insitu_s", "output_s", "core_hours", "node_hours", "flop", "peak_rss_bytes",
           "speedup", "efficiency", "predicted_wall_s", "prediction_error"]


def groups(rows):
    """Rows that differ in p alone: a study, and where it compares sizes a layout, by its title."""
    by_title = {}
    for row in rows:
        title = f"sizes on {row['ranks']}x{row['threads']}" if row["study"] == "sizes" else row["study"]
        by_title.setdefault(title, []).append(row)
    return by_title


def size_name(row):
    return "cores" if row["study"] == "strong" else "vessels" if row["vessels"] else "particles"


def fit_resources(rows, model):
    """A PowerLaw, or None, for each group and resource that was measured."""
    fits = []
    for title, group in groups(rows).items():
        for name, (key, unit, scale) in RESOURCES.items():
            if any(row[key] is None for row in group):
                continue
            law = fit_power_law([row["p"] for row in group], [row[key] / scale for row in group])
            paper_size, paper = PAPER.get(model, (None, {}))
            comparable = paper_size == ("nodes" if group[0]["study"] == "strong" else size_name(group[0]))
            fits.append({"group": title, "resource": name, "unit": unit, "p": size_name(group[0]), "law": law,
                         "paper": paper[name] if comparable else None})
    return fits


def shown_law(law):
    if law is None:
        return f"none: fewer than {LEAST_SIZES} sizes"
    if law.gamma is None:
        return f"{law.alpha:.3g}"
    offset = f"{law.alpha:.3g} + " if law.alpha else ""
    return f"{offset}{law.beta:.3g} p^{law.gamma:.2f}{' (?)' if law.at_bound else ''}"


def print_table(header, rows):
    print("\n| " + " | ".join(header) + " |\n|" + " --- |" * len(header))
    for row in rows:
        print("| " + " | ".join(row) + " |")


def number(value, form=".3g"):
    return "-" if value is None else format(value, form)


def print_report(rows, ahead, fits, machines):
    print_table(["study", "size", "ranks x threads", "p", "wall (s)", "range", "solving (s)", "memory (MB)", "speedup",
                 "efficiency", "predicted (s)", "error"],
                [[row["study"], row["size"] or "-", f"{row['ranks']} x {row['threads']}", f"{row['p']:,} {size_name(row)}",
                  f"{row['wall_s']:.3g}", f"{row['wall_min_s']:.3g}-{row['wall_max_s']:.3g}", f"{row['solve_s']:.3g}",
                  f"{row['peak_rss_bytes'] / 1e6:.0f}", number(row.get("speedup")), number(row.get("efficiency"), ".0%"),
                  number(row.get("predicted_wall_s")), number(row.get("prediction_error"), "+.0%")] for row in rows])
    if ahead:
        print(f"\nPredictions, not measured; with nodes of {machines[0].cores_per_node} cores;")
        for where, machine in zip(("within a node", "between nodes"), machines):
            print(f"{where} {machine.latency_s:.3g} s a message, {machine.bandwidth_B_s:.3g} bytes/s, {machine.source}")
        print_table(["study", "ranks x threads", "nodes", "predicted (s)", "speedup", "efficiency"],
                    [[row["study"], f"{row['ranks']} x {row['threads']}", str(row["nodes"]), f"{row['predicted_wall_s']:.3g}",
                      number(row["speedup"]), number(row["efficiency"], ".0%")] for row in ahead])
    print("\nR(p) = alpha + beta p^gamma, Eq. (10). The paper's (Table 1) are node-hours of 48 cores, and GB; its p of a single "
          "vessel is nodes. (?): an exponent that the points do not determine.")
    print_table(["study", "resource", "p", "ours", "deviation", "the paper's"],
                [[fit["group"], f"{fit['resource']} ({fit['unit']})", fit["p"], shown_law(fit["law"]),
                  number(fit["law"] and fit["law"].deviation, ".1%"), fit["paper"] or "-"] for fit in fits])


def whole_decades(values):
    """Limits of a logarithmic axis that has labels at both ends."""
    return 10 ** numpy.floor(numpy.log10(min(values) * 0.99)), 10 ** numpy.ceil(numpy.log10(max(values) * 1.01))


def label_cores(axes):
    axes.set_xscale("log", base=2)
    axes.xaxis.set_major_formatter("{x:.0f}")
    axes.set(xlabel="cores")


def by_threads(rows):
    """(rows, marker, label) for each number of threads a rank."""
    for threads, marker in zip(sorted({row["threads"] for row in rows}), MARKERS):
        yield [row for row in rows if row["threads"] == threads], marker, f"{threads} thread{'s' * (threads > 1)} a rank"


def draw_resource(axes, rows, ahead, fits, name):
    key, unit, scale = RESOURCES[name]
    laws = {fit["group"]: fit["law"] for fit in fits if fit["resource"] == name}
    for colour, (title, group) in zip(COLOURS, groups(rows).items()):
        for some, marker, label in by_threads(group):
            axes.plot([row["p"] for row in some], [row[key] / scale for row in some], marker, color=colour,
                      markerfacecolor="none", label=title if group[0]["study"] == "sizes" else label)
        if laws[title]:
            curve = numpy.geomspace(min(row["p"] for row in group), max(row["p"] for row in group), 100)
            axes.plot(curve, laws[title](curve), color=colour, linewidth=1.2, label=f"fit: {shown_law(laws[title])}")
    if name == "time" and ahead:
        axes.plot([row["p"] for row in ahead], [row[key] for row in ahead], "k--", linewidth=1, label="prediction")
        rows = rows + ahead
    low, high = whole_decades([row[key] / scale for row in rows])
    axes.set(xscale="log", yscale="log", ylim=(low, 10 * high), ylabel=f"{LABELS[name]} ({unit})", xlabel=size_name(rows[0]))
    if rows[0]["study"] == "strong":
        label_cores(axes)
    else:
        axes.set_xlim(whole_decades([row["p"] for row in rows]))
        axes.xaxis.set_minor_formatter("")
    axes.legend(fontsize=7, frameon=False, loc="upper left")  # in the decade left free for it


def draw_comparison(axes, study, rows, ahead):
    """Speedup, Eq. (11), or efficiency, Eq. (12), over cores."""
    key, name = ("speedup", "speedup") if study == "strong" else ("efficiency", "parallel efficiency")
    cores = sorted({row["cores"] for row in rows + ahead})
    axes.plot(cores, cores if study == "strong" else [1] * len(cores), ":", color="0.5", label="ideal")
    for some, marker, label in by_threads(rows):
        axes.plot([row["cores"] for row in some], [row[key] for row in some], marker, color=COLOURS[0],
                  markerfacecolor="none", label=label)
    tested = [(row["cores"], row[key] * row["wall_s"] / row["predicted_wall_s"]) for row in rows if "predicted_wall_s" in row]
    if tested:
        axes.plot(*zip(*tested), "kD", markersize=9, markerfacecolor="none", label="predicted for these")
    if ahead:
        axes.plot([row["cores"] for row in ahead], [row[key] for row in ahead], "k--", linewidth=1, label="prediction")
    label_cores(axes)
    axes.set(ylabel=name)
    if study == "strong":
        axes.set_yscale("log", base=2)
        axes.yaxis.set_major_formatter("{x:g}")
    else:
        axes.set_ylim(0, 1.15 * max(1, *(row[key] for row in rows + ahead)))
    axes.legend(fontsize=7, frameon=False, loc="upper left" if study == "strong" else "best")


def draw_study(path, study, rows, ahead, fits):
    measured = [name for name, (key, _, _) in RESOURCES.items() if all(row[key] is not None for row in rows)]
    panels = len(measured) + (study != "sizes")
    figure, axes = plt.subplots(1, panels, figsize=(3.7 * panels, 3.6), layout="constrained", squeeze=False)
    for side, name in zip(axes[0], measured):
        draw_resource(side, rows, ahead, fits, name)
    if study != "sizes":
        draw_comparison(axes[0, -1], study, rows, ahead)
    for side in axes[0]:
        side.grid(True, alpha=0.3)
    figure.savefig(path, dpi=150)
    plt.close(figure)


def write_report(output, plan, model, about, machines, rows, ahead):
    fits = fit_resources(rows, model)
    print_report(rows, ahead, fits, machines)
    with open(output / "scaling.csv", "w", newline="", encoding="utf-8") as file:
        table = csv.DictWriter(file, COLUMNS)
        table.writeheader()
        table.writerows(rows + ahead)
    as_json = [{**fit, "law": fit["law"] and dataclasses.asdict(fit["law"])} for fit in fits]
    (output / "scaling.json").write_text(json.dumps(
        {"machine": about, "network": [dataclasses.asdict(machine) for machine in machines], "input": plan["input"], "set": plan["set"],
         "measured": rows, "predicted": ahead, "fits": as_json}, indent=2) + "\n", encoding="utf-8")
    print()
    for study in dict.fromkeys(row["study"] for row in rows):
        path = output / f"{study}.png"
        of_study, ahead_of_it = ([row for row in table if row["study"] == study] for table in (rows, ahead))
        draw_study(path, study, of_study, ahead_of_it, fits)
        print(path)
    print(output / "scaling.csv")
