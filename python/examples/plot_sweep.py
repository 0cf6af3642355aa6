# %% [markdown]
# # Read a volume and plot a sweep
# Run it as `python plot_sweep.py FILE PICTURE`, or as a notebook in Jupyter or an editor that knows `# %%` cells.
# The picture has reflectivity and dealiased velocity of the lowest sweeps, and shows where the velocity is range folded.

# %%
import sys

import matplotlib.pyplot as plt
import numpy as np
from radar_colors import RANGE_FOLDED, REFLECTIVITY, VELOCITY

import stormcellar

file, picture = sys.argv[1:3]

# %% [markdown]
# A volume is a dict of xarray datasets, one for each sweep. `derive` adds the dealiased velocity, VRADDH.

# %%
volume = stormcellar.open_volume(file, derive="VELD")
sweeps = [dataset for name, dataset in volume.items() if name != "/"]
reflectivity = next(sweep for sweep in sweeps if "DBZH" in sweep)
velocity = next(sweep for sweep in sweeps if "VRADDH" in sweep)
print(velocity)

# %% [markdown]
# A gate without a value is NaN, and its state says why: 2 is range folded.

# %%
folded = (velocity["VRADDH_status"] == 2).where(velocity["VRADDH_status"] == 2)
print(f"{int(folded.sum())} of {folded.size} gates of velocity are range folded")


# %%
def plot(axes, sweep, values, title, **colors):
    """Plots values (azimuth, range) of a sweep within 150 km."""
    near = sweep["range"].values < 150_000
    azimuths = sweep["azimuth"].values
    before = np.append(azimuths[-1] - 360, azimuths[:-1])
    between = (azimuths + before) / 2
    edges = np.radians(np.append(between, between[0] + 360))
    km = sweep["range"].values[near] / 1000
    km = np.append(km, km[-1] + km[1] - km[0]) - (km[1] - km[0]) / 2
    axes.pcolormesh(np.outer(np.sin(edges), km), np.outer(np.cos(edges), km), values.values[:, near], **colors)
    axes.set_title(f"{title}, {float(sweep['sweep_fixed_angle']):.1f}°")
    axes.set_xlabel("km east of the radar")
    axes.set_aspect("equal")


figure, (left, right) = plt.subplots(1, 2, figsize=(13, 6.2), sharey=True, layout="constrained")
plot(left, reflectivity, reflectivity["DBZH"], "Reflectivity", **REFLECTIVITY)
plot(right, velocity, folded, "", cmap=RANGE_FOLDED)
plot(right, velocity, velocity["VRADDH"], "Velocity (purple: range folded)", **VELOCITY)
left.set_ylabel("km north of the radar")
for axes, unit in ((left, "dBZ"), (right, "m/s, positive away from the radar")):
    echo = axes.collections[-1]
    figure.colorbar(echo, ax=axes, label=unit, shrink=0.8, ticks=echo.norm.boundaries[:-1])
root = volume["/"]
figure.suptitle(f"{root.attrs['instrument_name']}, {str(root['time_coverage_start'].values)}")
figure.savefig(picture)
