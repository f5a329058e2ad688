#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A notebook of four cells: evidence and surface on a slice, what each pixel is worth, the mesh.

    python3 04_slices_and_mesh.py FOLDER OUT.png [RESOLUTION]

FOLDER: any data set of `vdbfuse formats`. Needs python3-matplotlib. Editors that know "# %%" run it cell by cell.
"""
# %% The data, the surface with its grids, the judgement
import sys

import matplotlib
import numpy as np
import vdbfuse

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

folder, out = sys.argv[1:3]
resolution = int(sys.argv[3]) if len(sys.argv) > 3 else 96
data = vdbfuse.read(folder)
mesh = vdbfuse.fuse(data, resolution=resolution, grids=True)
judged = vdbfuse.judge(data)
figure = plt.figure(figsize=(12, 10), constrained_layout=True)

# %% σ, the evidence for outside (blue) and inside (red), with the surface that the cut drew through it
axes = figure.add_subplot(2, 2, 1)
sigma, extent = mesh.slice("sigma", "y")
axes.imshow(sigma, extent=extent, cmap="RdBu", vmin=-5, vmax=5)
field, field_extent = mesh.slice("surface", "y")
axes.contour(np.flipud(field), [0], extent=field_extent, colors="black", linewidths=0.8)
axes.set_title("evidence for outside (blue) and inside (red)")

# %% ρ, the price of a surface: cheap where views agree
axes = figure.add_subplot(2, 2, 2)
rho, extent = mesh.slice("rho", "y")
picture = axes.imshow(rho, extent=extent, cmap="magma", vmin=0, vmax=1)
figure.colorbar(picture, ax=axes, shrink=0.8)
axes.set_title("price of a surface (dark: views agree)")

# %% What each pixel of the first view is worth
axes = figure.add_subplot(2, 2, 3)
view = judged[0]
axes.imshow(np.where(view.depth > 0, 1 - view.outlier, np.nan), cmap="gray", vmin=0, vmax=1)
axes.set_facecolor("lightsteelblue")
axes.set_title(f"reliability of the pixels of {view.name} (black: wrong)")

# %% The mesh, orange where it was invented
axes = figure.add_subplot(2, 2, 4, projection="3d")
shown = mesh.simplify(8000)
corners = shown.vertices[shown.triangles]
normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
light = np.abs(normals @ (0.3, -0.8, 0.5)) / np.maximum(np.linalg.norm(normals, axis=1), 1e-12)
support = np.minimum(shown.support[shown.triangles].mean(axis=1), 1)[:, np.newaxis]
base = support * np.array([0.75, 0.8, 0.85]) + (1 - support) * np.array([1.0, 0.6, 0.2])
faces = axes.plot_trisurf(*shown.vertices.T, triangles=shown.triangles.astype(np.int32))
faces.set_facecolor(np.clip(base * (0.35 + 0.65 * light[:, np.newaxis]), 0, 1))
low, high = map(np.array, shown.bounds)
axes.set_box_aspect(high - low)
axes.view_init(elev=15, azim=-70)
axes.set_axis_off()
axes.set_title(f"{len(mesh.triangles)} triangles (orange: invented)")
figure.savefig(out, dpi=100)
print(f"{out}: voxel {mesh.report['grid']['voxel']:.4g}, certified cut: {mesh.report['cut']['certified']}")
