# %% [markdown]
# # Compare with Py-ART
# Run it as `python compare_with_pyart.py FILE PICTURE`. It reads a volume with stormcellar and with Py-ART, compares each
# field gate by gate, and plots the lowest sweep of both.

# %%
import sys
import time

import matplotlib.pyplot as plt
import numpy as np
import pyart
from radar_colors import REFLECTIVITY

import stormcellar

file, picture = sys.argv[1:3]

# %% [markdown]
# `to_pyart()` makes a `pyart.core.Radar`, so every function of Py-ART takes it.

# %%
began = time.perf_counter()
ours = stormcellar.Volume(file).to_pyart()
between = time.perf_counter()
theirs = pyart.io.read_nexrad_archive(file)
for field in theirs.fields.values():
    field["data"]  # Py-ART reads a field when it is used
print(f"stormcellar {between - began:.2f} s, Py-ART {time.perf_counter() - between:.2f} s")

# %%
columns = np.rint((theirs.range["data"] - ours.range["data"][0]) / np.diff(ours.range["data"][:2])[0]).astype(int)
inside = (columns >= 0) & (columns < ours.ngates)
for name in theirs.fields:
    mine = ours.fields[name]["data"][:, columns[inside]]
    right = theirs.fields[name]["data"][:, inside]
    both = ~np.ma.getmaskarray(mine) & ~np.ma.getmaskarray(right)
    largest = np.abs(np.ma.getdata(mine)[both] - np.ma.getdata(right)[both]).max(initial=0)
    print(f"{name:28} {int(both.sum()):9} gates in both, the largest difference is {largest:.3f}")

# %%
figure, panels = plt.subplots(1, 2, figsize=(13, 6.2), sharey=True, layout="constrained")
for axes, radar, title in zip(panels, (ours, theirs), ("stormcellar", "Py-ART")):
    pyart.graph.RadarDisplay(radar).plot(
        "reflectivity", 0, ax=axes, fig=figure, title=f"Read by {title}", colorbar_flag=axes is panels[1], **REFLECTIVITY)
    axes.set_aspect("equal")
    axes.set_xlim(-150, 150)
    axes.set_ylim(-150, 150)
figure.savefig(picture)
