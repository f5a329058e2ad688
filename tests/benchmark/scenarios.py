#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The scenario matrix: synthetic scans with every kind of mistake, fused with every part switched off in turn.

    python3 tests/benchmark/scenarios.py --tool build/bin/vdbfuse --out matrix --meshes ../shared/data/meshes

writes OUT/results/SCENARIO/ROW.json one by one (a second start goes on where the first one stopped; remove a
file to have it made again), then OUT/matrix.csv, OUT/matrix.png and OUT/summary.txt, which says of each demand
whether it is met. What is not run is reported as missing, never as met.

Needs python3; for the picture python3-matplotlib, for the row `oracle` also python3-numpy and python3-pil.

Scans are made by `vdbfuse synth` and removed when their rows are done. Where a wall is measured behind the
object, the object's box and a tenth more are given with --bbox: without it, the wall is as good a surface as
the object. Everything else is default but for the voxel and what the row is about. The oracle is the judgement
of `vdbfuse judge`, with each measured pixel's outlier probability replaced by 0.1 % or 99.9 %, as the truth has
it; calibration, domain and pixels without a depth stay as found.
"""

import argparse
import fnmatch
import hashlib
import json
import os
import shutil
import signal
import subprocess
import sys
import time
from collections import namedtuple
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import scenario_report
from scenario_list import DATA, EACH_AT_LEAST, GROUPS, ROWS, UP, applies, coverage, scenarios

Size = namedtuple("Size", "pixels voxel")  # the voxel in diagonals of the object
SIZES = {"small": Size("320x240", 0.006), "full": Size("640x480", 0.003)}
ORACLE_LOG_ODDS = 6.9  # 0.1 %
TIME_LIMIT = 3600  # seconds, of one command


class Failed(Exception):
    """A command of the tool that did not do it, in one line."""


class Tool:
    def __init__(self, path, threads):
        self.path, self.threads = str(Path(path).resolve()), str(threads)
        libraries = sorted(Path(self.path).parent.parent.glob("libvdbfuse*.so*"))
        files = [Path(self.path), *(file for file in libraries if not file.is_symlink())]
        self.build = hashlib.sha256(b"".join(file.read_bytes() for file in files)).hexdigest()[:12]
        self.knows_judgement = "--judgement" in self.run("fuse", "--help")

    def run(self, *arguments):
        try:
            done = subprocess.run([self.path, *map(str, arguments)], capture_output=True, text=True,
                                  timeout=TIME_LIMIT)
        except subprocess.TimeoutExpired:
            raise Failed(f"{arguments[0]} took more than {TIME_LIMIT} s") from None
        if done.returncode in (130, -signal.SIGINT, -signal.SIGTERM):
            raise KeyboardInterrupt  # says nothing of the tool: no result is written
        if done.returncode != 0:
            last = (done.stderr.strip().splitlines() or ["nothing said"])[-1]
            raise Failed(f"{arguments[0]} ended with {done.returncode}: {last}")
        return done.stdout

    def work(self, *arguments):
        return self.run(*arguments, "--threads", self.threads)


def write_atomically(path, text):
    path.parent.mkdir(parents=True, exist_ok=True)
    temporary = path.with_name(path.name + ".new")
    temporary.write_text(text)
    os.replace(temporary, path)


def make_scan(tool, scenario, size, meshes, folder):
    scene = "figure" if scenario.scene == "figure" else meshes / f"{scenario.scene}.ply"
    tool.work("synth", scene, folder, "--views", scenario.views, "--arc", scenario.arc, "--size", size.pixels,
              "--background", scenario.background, "--up", UP[scenario.scene], "--oracle", "--quiet",
              *DATA[scenario.data])


def write_oracle(tool, scan, sensor_options, folder):
    """A judgement that knows: see the comment of this file, and judgement_folder.h for the codes."""
    import numpy
    from PIL import Image

    tool.work("judge", scan, folder, "--quiet", *sensor_options)
    for path in sorted((folder / "outliers").glob("*.png")):
        codes = numpy.array(Image.open(path)).astype(numpy.int64)
        wrong = numpy.array(Image.open(scan / "wrong" / path.name)) != 0
        log_odds = numpy.where(wrong, ORACLE_LOG_ODDS, -ORACLE_LOG_ODDS)
        measured = (codes >= 1) & (codes <= 65533)
        known = numpy.rint(1 + (log_odds + 16) / 32 * 65532).astype(numpy.int64)
        Image.fromarray(numpy.where(measured, known, codes).astype(numpy.uint16)).save(path)


def box_option(scan, scenario):
    if scenario.background == "none":
        return []
    bounds = json.loads((scan / "scene.json").read_text())["bounds"]
    margin = [0.1 * (high - low) for low, high in zip(bounds["min"], bounds["max"])]
    low = [x - m for x, m in zip(bounds["min"], margin)]
    high = [x + m for x, m in zip(bounds["max"], margin)]
    return ["--bbox=" + ",".join(f"{x:.6f}" for x in low + high)]


def fuse_options(tool, scenario, row, size, default, scan):
    box = box_option(scan, scenario)
    options = ROWS[row](scenario, size, default)
    if options is None:
        raise Failed("the default row, which this one needs, failed")
    if row == "oracle":
        judgement = scan / "judgement"
        write_oracle(tool, scan, box, judgement)
        options, box = ["--judgement", judgement], []
    grid = [] if "--resolution" in options else ["--voxel", f"{size.voxel:g}"]
    return [*box, *grid, *options]


def measure(tool, scenario, row, size, default, scan, mesh):
    """One cell of the matrix: fuse, evaluate, record."""
    report, verdict = scan / f"fuse-{mesh.stem}.json", scan / f"evaluate-{mesh.stem}.json"
    options = fuse_options(tool, scenario, row, size, default, scan)
    started = time.monotonic()
    tool.work("fuse", scan, mesh, "--quiet", "--overwrite", "--json", report, *options)
    seconds = time.monotonic() - started
    tool.work("evaluate", mesh, scan / "truth.ply", "--tau", f"{size.voxel / 2:g},{size.voxel:g}",
              "--deep", f"{2 * size.voxel:g}", "--json", verdict)
    fused, judged = json.loads(report.read_text()), json.loads(verdict.read_text())
    components, euler = judged["components"], judged["euler_number"]
    return {
        "status": "ok",
        "options": [str(option) for option in options],
        "iou": judged["iou"],
        "f_half_voxel": judged["fscore"][0],
        "f_voxel": judged["fscore"][1],
        "components": components,
        "open_edges": judged["open_edges"],
        "euler_number": euler,
        "genus": components - euler / 2,
        "false_outside_volume_deep": judged["false_outside_volume_deep"],
        "false_inside_volume_deep": judged["false_inside_volume_deep"],
        "seconds": round(seconds, 2),
        "cpu_seconds": round(sum(step["cpu_seconds"] for step in fused["steps"]), 2),
        "peak_memory_bytes": fused["peak_memory_bytes"],
        "noise_scale": fused["calibration"]["noise_scale"],
        "lambda": fused["options"].get("lambda"),
    }


class Matrix:
    def __init__(self, arguments, tool):
        self.tool, self.size, self.meshes = tool, SIZES[arguments.size], arguments.meshes
        self.size_name, self.out, self.keep_meshes = arguments.size, arguments.out, arguments.keep_meshes

    def path(self, scenario, row):
        return self.out / "results" / scenario.name / (row.replace("/", "_by_").replace("*", "_times_") + ".json")

    def read(self, scenario, row):
        path = self.path(scenario, row)
        return json.loads(path.read_text()) if path.exists() else None

    def run_scenario(self, scenario, rows):
        wanted = [row for row in rows if applies(scenario, row) and self.read(scenario, row) is None]
        if not self.tool.knows_judgement:
            wanted = [row for row in wanted if row != "oracle"]
        if not wanted:
            return
        scan = self.out / "scans" / scenario.name
        shutil.rmtree(scan, ignore_errors=True)
        scan.parent.mkdir(parents=True, exist_ok=True)
        try:
            make_scan(self.tool, scenario, self.size, self.meshes, scan)
            for row in wanted:
                self.run_cell(scenario, row, scan)
        finally:
            shutil.rmtree(scan, ignore_errors=True)

    def run_cell(self, scenario, row, scan):
        mesh = scan / (self.path(scenario, row).stem + ".ply")
        default = self.read(scenario, "default")
        default = default if default and default["status"] == "ok" else None
        try:
            record = measure(self.tool, scenario, row, self.size, default, scan, mesh)
        except Failed as failure:
            record = {"status": "failed", "message": str(failure)}
        record.update(scenario=scenario.name, row=row, size=self.size_name, build=self.tool.build)
        write_atomically(self.path(scenario, row), json.dumps(record, indent=2) + "\n")
        if self.keep_meshes and mesh.exists():
            kept = self.out / "meshes" / scenario.name
            kept.mkdir(parents=True, exist_ok=True)
            shutil.move(mesh, kept / mesh.name)
        words = record.get("message") or (f"IoU {record['iou']:.4f}  F {record['f_voxel']:.4f}  "
                                          f"{record['components']} components  {record['seconds']:.0f} s")
        print(f"{scenario.name:34} {row:16} {words}", flush=True)

    def results(self, chosen):
        found = {(s.name, row): self.read(s, row) for s in chosen for row in ROWS}
        return {key: record for key, record in found.items() if record is not None}

    def report(self, chosen):
        results = self.results(chosen)
        scenario_report.write_csv(self.out / "matrix.csv", chosen, results)
        text = scenario_report.summary(chosen, results)
        write_atomically(self.out / "summary.txt", text)
        print(text, end="")
        try:
            scenario_report.write_picture(self.out / "matrix.png", chosen, results)
        except ImportError as missing:
            print(f"no matrix.png: {missing}", file=sys.stderr)


def print_coverage(chosen):
    counts = coverage(chosen)
    print(f"{len(chosen)} scenarios, {sum(s.from_all_sides for s in chosen)} seen from all sides")
    for axis, values in counts.items():
        print(f"  {axis}: " + ", ".join(f"{value} {count}" for value, count in values.items()))
    return all(count >= EACH_AT_LEAST for values in counts.values() for count in values.values())


def parse_rows(text):
    rows = []
    for word in text.split(","):
        if word not in GROUPS and word not in ROWS:
            raise argparse.ArgumentTypeError(f"'{word}' is neither {', '.join(GROUPS)} nor one of {', '.join(ROWS)}")
        rows += [row for row in GROUPS.get(word, [word]) if row not in rows]
    return sorted(rows, key=list(ROWS).index)


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--check", action="store_true", help="test the list and the summary; runs nothing")
    parser.add_argument("--tool", type=Path, help="the program vdbfuse")
    parser.add_argument("--out", type=Path, help="folder of results")
    parser.add_argument("--meshes", type=Path, default=Path("."), help="folder of anchor.ply, armadillo.ply ...")
    parser.add_argument("--only", default="*", help="scenarios whose name matches, e.g. '*-full-*'")
    parser.add_argument("--rows", type=parse_rows, default=GROUPS["parts"],
                        help=f"of {', '.join(GROUPS)} and single rows: {', '.join(ROWS)} [parts]")
    parser.add_argument("--size", choices=SIZES, default="small")
    parser.add_argument("--jobs", type=int, default=1, help="scenarios at a time")
    parser.add_argument("--threads", type=int, default=0, help="of the tool; 0: all processors")
    parser.add_argument("--keep-meshes", action="store_true", help="in OUT/meshes")
    parser.add_argument("--report", action="store_true", help="only report what is there")
    arguments = parser.parse_args()
    if not arguments.check and not (arguments.tool and arguments.out):
        parser.error("--tool and --out are needed")
    return arguments


def refuse_other_size(out, size):
    settings = out / "settings.json"
    if settings.exists() and json.loads(settings.read_text())["size"] != size:
        sys.exit(f"{out} holds results of another size")
    write_atomically(settings, json.dumps({"size": size}) + "\n")


def run_all(matrix, todo, arguments):
    pool = ThreadPoolExecutor(max_workers=max(1, arguments.jobs))
    try:
        list(pool.map(lambda s: matrix.run_scenario(s, arguments.rows), todo))
    finally:
        pool.shutdown(cancel_futures=True)


def main():
    arguments = parse_arguments()
    if arguments.check:
        import scenario_check
        return scenario_check.run()
    chosen = scenarios()
    if not print_coverage(chosen):
        sys.exit("a value occurs too rarely")
    refuse_other_size(arguments.out, arguments.size)
    matrix = Matrix(arguments, Tool(arguments.tool, arguments.threads))
    if not matrix.tool.knows_judgement and "oracle" in arguments.rows:
        print("this tool has no fuse --judgement: the row oracle stays empty")
    absent = {s.scene for s in chosen if s.scene != "figure" and not (arguments.meshes / f"{s.scene}.ply").exists()}
    if absent:
        print(f"no {', '.join(sorted(absent))} in {arguments.meshes}: their scenarios stay empty")
    todo = [s for s in chosen if fnmatch.fnmatch(s.name, arguments.only) and s.scene not in absent]
    if not arguments.report:
        run_all(matrix, todo, arguments)
    matrix.report(chosen)
    return 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except (Failed, OSError) as failure:
        sys.exit(f"scenarios.py: {failure}")
    except KeyboardInterrupt:
        sys.exit(130)
