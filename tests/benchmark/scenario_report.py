# SPDX-License-Identifier: Apache-2.0
"""What the results of the scenario matrix say: a table (CSV), a picture, and for each demand whether it is met.

`results` is {(scenario name, row): record} everywhere; a record has `status` "ok" and the COLUMNS, or "failed"
and a `message`.
"""

import csv

from scenario_list import AXES, RESOLUTION, ROWS, SENSITIVITY, applies

COLUMNS = ["iou", "f_half_voxel", "f_voxel", "components", "open_edges", "euler_number", "genus",
           "false_outside_volume_deep", "false_inside_volume_deep", "seconds", "cpu_seconds",
           "peak_memory_bytes"]
F_VOXEL, F_TO_ORACLE, IOU_BELOW, IOU_SENSITIVITY = 0.995, 0.005, 0.005, 0.02


class Demand:
    """Collects the cases of one demand. Met only when there were cases, all of them good, and none missing."""

    def __init__(self, title):
        self.title, self.good, self.bad, self.missing, self.remarks = title, [], [], [], []

    def case(self, name, records, test):
        """`test`, called with the records, returns (holds, words)."""
        if any(record is None for record in records):
            self.missing.append(name)
        elif any(record["status"] != "ok" for record in records):
            self.bad.append(f"{name}: " + next(r["message"] for r in records if r["status"] != "ok"))
        else:
            holds, words = test(*records)
            (self.good if holds else self.bad).append(f"{name}: {words}")

    @property
    def verdict(self):
        if self.bad:
            return "NOT MET"
        return "met" if self.good and not self.missing else "MISSING"

    def text(self):
        total = len(self.good) + len(self.bad) + len(self.missing)
        lines = [f"{self.verdict}: {self.title} ({len(self.good)} of {total} hold, {len(self.bad)} do not, "
                 f"{len(self.missing)} not run)"]
        lines += [f"    {line}" for line in self.remarks]
        lines += [f"    not so: {line}" for line in self.bad]
        if self.missing:
            more = f" and {len(self.missing) - 6} more" if len(self.missing) > 6 else ""
            lines.append(f"    not run: {', '.join(self.missing[:6])}{more}")
        return "\n".join(lines)


def watertight(chosen, results):
    demand = Demand("default: one component and no open edge everywhere")
    for s in chosen:
        demand.case(s.name, [results.get((s.name, "default"))], lambda r: (
            r["components"] == 1 and r["open_edges"] == 0,
            f"{r['components']} components, {r['open_edges']} open edges"))
    return demand


def accurate(chosen, results):
    demand = Demand(f"default, from all sides by 24 views or more: F at one voxel >= {F_VOXEL:.1%}")
    for s in chosen:
        if s.from_all_sides and s.scene != "anchor":  # it has pockets that no view reaches
            demand.case(s.name, [results.get((s.name, "default"))],
                        lambda r: (r["f_voxel"] >= F_VOXEL, f"{r['f_voxel']:.2%}"))
    return demand


def near_oracle(chosen, results):
    demand = Demand(f"the same views: F at one voxel within {F_TO_ORACLE:.1%} of the oracle's")
    for s in chosen:
        if s.from_all_sides:
            demand.case(s.name, [results.get((s.name, row)) for row in ("default", "oracle")],
                        lambda r, o: (r["f_voxel"] >= o["f_voxel"] - F_TO_ORACLE,
                                      f"{r['f_voxel']:.2%}, oracle {o['f_voxel']:.2%}"))
    return demand


def never_below(chosen, results, row):
    demand = Demand(f"default nowhere below {row} by more than {IOU_BELOW} IoU")
    for s in chosen:
        default, other = results.get((s.name, "default")), results.get((s.name, row))
        if default and other and other["status"] != "ok":
            other = {"status": "ok", "iou": 0.0}  # who gives nothing is not better
        demand.case(s.name, [default, other], lambda r, o: (
            r["iou"] >= o["iou"] - IOU_BELOW, f"IoU {r['iou']:.4f}, {row} {o['iou']:.4f}"))
    return demand


def regret(chosen, results):
    """No bound is asked for: the worst is stated. Missing rows make it a lower bound, and it says so."""
    demand = Demand("worst regret of the default against the best setting of each scene, stated")
    rows = [row for row in ROWS if row not in ("default", "oracle") and row not in RESOLUTION]
    worst = []
    for s in chosen:
        default = results.get((s.name, "default"))
        others = {row: results.get((s.name, row)) for row in rows if applies(s, row)}
        ran = [(r["iou"], row) for row, r in others.items() if r and r["status"] == "ok"]
        if not default or default["status"] != "ok" or not ran:
            demand.missing.append(s.name)
            continue
        best, row = max(ran)
        worst.append((best - default["iou"], s.name, row))
        absent = [row for row, r in others.items() if r is None]
        if absent:
            demand.missing.append(f"{s.name} ({len(absent)} settings)")
        else:
            demand.good.append(s.name)
    for loss, name, row in sorted(worst, reverse=True)[:5]:
        demand.remarks.append(f"{max(loss, 0.0):.4f} IoU: {name}, against {row}")
    return demand


def insensitive(chosen, results):
    demand = Demand(f"lambda, mu, noise, a, b: IoU within {IOU_SENSITIVITY} of the default from all sides")
    for s in chosen:
        for row in SENSITIVITY:
            if s.from_all_sides:
                demand.case(f"{s.name} {row}", [results.get((s.name, "default")), results.get((s.name, row))],
                            lambda r, o: (abs(r["iou"] - o["iou"]) <= IOU_SENSITIVITY,
                                          f"IoU {o['iou']:.4f}, default {r['iou']:.4f}"))
    return demand


def same_at_every_resolution(chosen, results):
    demand = Demand("128, 256 and 512: the same genus and number of components from all sides")

    def same(*records):
        found = [(r["components"], r["genus"]) for r in records]
        return len(set(found)) == 1, "components and genus " + ", ".join(f"{c}/{g:g}" for c, g in found)

    for s in chosen:
        if s.from_all_sides:
            demand.case(s.name, [results.get((s.name, row)) for row in RESOLUTION], same)
    return demand


def demands(chosen, results):
    return [watertight(chosen, results), accurate(chosen, results), near_oracle(chosen, results),
            *(never_below(chosen, results, row) for row in ("paper", "tsdf", "one-v")),
            regret(chosen, results), insensitive(chosen, results), same_at_every_resolution(chosen, results)]


def summary(chosen, results):
    lines = [demand.text() for demand in demands(chosen, results)]
    builds = {record["build"] for record in results.values() if "build" in record}
    if len(builds) > 1:
        lines.append(f"CAREFUL: the results are of {len(builds)} different builds of the tool")
    return "\n".join(lines) + "\n"


def write_csv(path, chosen, results):
    with open(path, "w", newline="") as file:
        table = csv.writer(file)
        table.writerow([*AXES, "from_all_sides", "row", "status", *COLUMNS, "message"])
        for s in chosen:
            for row in ROWS:
                r = results.get((s.name, row))
                if applies(s, row) and r:
                    table.writerow([*s, int(s.from_all_sides), row, r["status"],
                                    *(r.get(column, "") for column in COLUMNS), r.get("message", "")])


def draw_panel(axes, chosen, rows, results, column):
    import numpy
    from matplotlib.colors import LogNorm

    wrong = numpy.full((len(chosen), len(rows)), numpy.nan)
    for y, s in enumerate(chosen):
        for x, row in enumerate(rows):
            r = results.get((s.name, row))
            if r is None:
                axes.text(x, y, "–", ha="center", va="center", color="grey", fontsize=7)
                continue
            if r["status"] != "ok":
                axes.text(x, y, "failed", ha="center", va="center", color="crimson", fontsize=7)
                continue
            wrong[y, x] = max(1 - r[column], 1e-3)
            whole = r["components"] == 1 and r["open_edges"] == 0
            axes.text(x, y, f"{r[column]:.3f}" + ("" if whole else "*"), ha="center", va="center",
                      fontsize=7, color="white" if wrong[y, x] > 0.08 else "black")
    image = axes.imshow(wrong, aspect="auto", cmap="YlOrRd", norm=LogNorm(1e-3, 1))
    axes.set_xticks(range(len(rows)), rows, rotation=40, ha="right", fontsize=8)
    axes.set_yticks(range(len(chosen)), [("● " if s.from_all_sides else "") + s.name for s in chosen],
                    fontsize=7)
    return image


def write_picture(path, chosen, results):
    """A heat map of IoU beside one of F at one voxel: scenarios down, settings across. Needs matplotlib."""
    import matplotlib
    matplotlib.use("Agg")
    from matplotlib import pyplot

    seen = {row for _, row in results}
    rows = [row for row in ROWS if row in seen]
    drawn = [s for s in chosen if any((s.name, row) in results for row in rows)]
    if not drawn:
        return
    figure, (left, right) = pyplot.subplots(1, 2, sharey=True, layout="constrained",
                                            figsize=(4 + 1.1 * len(rows), 2.4 + 0.24 * len(drawn)))
    image = draw_panel(left, drawn, rows, results, "iou")
    draw_panel(right, drawn, rows, results, "f_voxel")
    left.set_title("IoU"), right.set_title("F at one voxel")
    figure.colorbar(image, ax=[left, right], label="1 − value", shrink=0.6)
    figure.supxlabel("●: seen from all sides by 24 views or more · *: not one closed component · –: not run",
                     fontsize=8)
    figure.savefig(path, dpi=130)
    pyplot.close(figure)
