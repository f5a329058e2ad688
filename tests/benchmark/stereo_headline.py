#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""From photographs alone to a mesh: visibility evidence beside constant ballooning, on the same photographs.

  tests/benchmark/stereo_headline.py build/bin/vdbfuse OUTDIR [--figure FOLDER] [--temple FOLDER]
                                     [--balloons 0.01,0.02,...] [--temple-balloons 0.05,...]

The figure with thin legs and a deep cavity in its chest: 72 textured photographs on a ring, rendered into
OUTDIR/figure unless --figure names a folder of them with truth.ply and scene.json. --temple: Middlebury's
templeSparseRing (default: temple-sparse-ring in $VDBFUSE_DATA; left out when it is not there). Every row is one run of
`vdbfuse fuse PHOTOGRAPHS MESH`. Prints tables as Markdown and writes them, the meshes and pictures from eight sides
into OUTDIR. Seconds are wall time of the whole command, with the share of matching.
"""
import argparse
import json
import os
import subprocess
import sys
import time
from pathlib import Path

# templeSparseRing's tight bounding box, from its README.
TEMPLE_BOX = "-0.073568,0.021728,-0.012445,0.028855,0.181892,0.062736"
REGIONS = ["cavity", "left leg", "right leg"]
HEADER = "| evidence | components | cavity open | left leg kept | right leg kept | IoU | invented share | triangles " \
         "| s (matching) |\n|---|---|---|---|---|---|---|---|---|"


def run(command):
    """Wall seconds, or nothing when the command failed; what it said goes to stderr then."""
    start = time.monotonic()
    done = subprocess.run([str(c) for c in command], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    if done.returncode != 0:
        print(f"{' '.join(map(str, command))}: {done.stderr.strip()}", file=sys.stderr)
        return None
    return time.monotonic() - start


def matching_seconds(report):
    steps = [s["name"] for s in report["steps"]]
    first = steps.index("plan")  # of the reconstruction
    return sum(s["seconds"] for s in report["steps"][:first])


def evaluation(tool, scan, name):
    """Regions and IoU as text; dashes where the truth is not known."""
    if not (scan / "truth.ply").exists():
        return ["–"] * (len(REGIONS) + 1)
    if run([tool, "evaluate", f"{name}.ply", scan / "truth.ply", "--regions", scan / "scene.json",
            "--json", f"{name}-evaluation.json"]) is None:
        sys.exit(1)
    found = json.loads(Path(f"{name}-evaluation.json").read_text())
    return [f"{100 * found['regions'][r]:.1f} %" for r in REGIONS] + [f"{found['iou']:.4f}"]


def row(tool, scan, name, up, label, options):
    seconds = run([tool, "fuse", scan, f"{name}.ply", "--json", f"{name}.json", "--overwrite", "--quiet", *options])
    if seconds is None:
        return f"| {label} | nothing is left" + " |" * 8
    run([tool, "render", f"{name}.ply", f"{name}.png", "--turntable", 8, "--up", up, "--size", "480x600", "--overwrite"])
    report = json.loads(Path(f"{name}.json").read_text())
    mesh = report["mesh"]
    cells = [label, mesh["components"], *evaluation(tool, scan, name), f"{100 * mesh['invented_area_share']:.0f} %",
             mesh["triangles"], f"{seconds:.1f} ({matching_seconds(report):.1f})"]
    return "| " + " | ".join(map(str, cells)) + " |"


def table(tool, scan, prefix, up, balloons, options=()):
    lines = [HEADER, row(tool, scan, f"{prefix}-visibility", up, "visibility", options)]
    print("\n".join(lines), flush=True)
    for balloon in balloons:
        constant = ["--rule", "constant", "--balloon", balloon]
        lines.append(row(tool, scan, f"{prefix}-balloon-{balloon}", up, f"constant {balloon}", [*options, *constant]))
        print(lines[-1], flush=True)
    return "\n".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("tool", type=Path)
    parser.add_argument("outdir", type=Path)
    parser.add_argument("--figure", type=Path)
    parser.add_argument("--temple", type=Path, default=Path(os.environ.get("VDBFUSE_DATA", "data")) / "temple-sparse-ring")
    parser.add_argument("--balloons", default="0.0005,0.002,0.004,0.0045,0.005,0.02,0.1")
    parser.add_argument("--temple-balloons", default="0.02,0.03,0.05")
    arguments = parser.parse_args()
    arguments.outdir.mkdir(parents=True, exist_ok=True)
    figure = arguments.figure or arguments.outdir / "figure"
    if not figure.exists() and run([arguments.tool, "synth", "figure", figure, "--arc", "ring", "--views", 72,
                                    "--textured", "--images-only"]) is None:
        sys.exit(1)
    text = "Figure, 72 photographs:\n\n"
    text += table(arguments.tool, figure, arguments.outdir / "figure", "z", arguments.balloons.split(","))
    if arguments.temple.exists():
        text += "\ntempleSparseRing, 16 photographs:\n\n"
        text += table(arguments.tool, arguments.temple, arguments.outdir / "temple", "y",
                      arguments.temple_balloons.split(","), [f"--bbox={TEMPLE_BOX}"])
    else:
        print(f"no {arguments.temple}: without the temple", file=sys.stderr)
    (arguments.outdir / "headline.md").write_text(text)


if __name__ == "__main__":
    main()
