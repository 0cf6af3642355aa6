# %% [markdown]
# # Merge several radars
# Run it as `python mosaic.py FILE ... PICTURE`, with files of neighboring radars at about the same time. It merges them
# and plots the strongest reflectivity of each column.

# %%
import sys

import matplotlib.pyplot as plt
import numpy as np
from radar_colors import REFLECTIVITY

import stormcellar

*files, picture = sys.argv[1:]

# %% [markdown]
# All volumes are moved to one instant, so a storm that moves is not drawn twice.

# %%
volumes = [stormcellar.Volume(file, moments="REF") for file in files]
grid = stormcellar.mosaic(volumes, spacing_m=2000, levels_m=np.arange(1000, 13_000, 1000))
print(grid, "at", grid.time)

# %% [markdown]
# A column is *not seen* if no beam reaches any of its cells. Never draw it as clear air.

# %%
values, states = grid.values(), grid.states()
strongest = np.where(np.isnan(values), -np.inf, values).max(axis=0)
not_seen = (states == stormcellar.CellState.not_seen).all(axis=0)

# %%
figure, axes = plt.subplots(figsize=(9, 8), layout="constrained")
x_km, y_km = grid.x_m / 1000, grid.y_m / 1000
axes.pcolormesh(x_km, y_km, np.where(not_seen, 1, np.nan), cmap="Greys", vmin=0, vmax=4)
echo = axes.pcolormesh(x_km, y_km, np.where(strongest >= 5, strongest, np.nan), **REFLECTIVITY)
axes.set_aspect("equal")
axes.set_xlabel(f"km east of {grid.center[0]:.2f}° N, {-grid.center[1]:.2f}° W")
axes.set_ylabel("km north")
axes.set_title(f"{' '.join(sorted(volume.station for volume in volumes))}, {grid.time}Z (gray: not seen)")
figure.colorbar(echo, label="strongest reflectivity of the column, dBZ", shrink=0.8)
figure.savefig(picture)
