# %% [markdown]
# # Climatology of a day
# Run it as `python climatology.py FILE ... PICTURE`, with the files of one radar in a day. It shows in what share of
# the volumes a column had rain (20 dBZ), and the strongest reflectivity of each column.

# %%
import sys

import matplotlib.pyplot as plt
import numpy as np
from radar_colors import REFLECTIVITY

import stormcellar

*files, picture = sys.argv[1:]
RAIN_DBZ = 20

# %% [markdown]
# All grids have the same cells, so counting is arithmetic. Only cells that the radar sees count.

# %%
seen = echo = 0
strongest = -np.inf
volumes = sorted((stormcellar.Volume(file, moments="REF") for file in files), key=lambda volume: volume.start)
for volume in volumes:
    grid = stormcellar.grid(volume, columns=300, rows=300, levels_m=np.arange(1000, 13_000, 1000))
    values = np.where(np.isnan(grid.values()), -np.inf, grid.values()).max(axis=0)
    seen = seen + (grid.states() != stormcellar.CellState.not_seen).any(axis=0)
    echo = echo + (values >= RAIN_DBZ)
    strongest = np.maximum(strongest, values)
percent = np.where(seen > 0, 100 * echo / np.maximum(seen, 1), np.nan)
print(f"{len(volumes)} volumes; {np.count_nonzero(echo)} of {echo.size} columns had rain")

# %%
figure, (left, right) = plt.subplots(1, 2, figsize=(13, 6.2), sharey=True, layout="constrained")
x_km, y_km = grid.x_m / 1000, grid.y_m / 1000
share = left.pcolormesh(x_km, y_km, np.where(percent > 0, percent, np.nan), cmap="viridis_r", vmin=0, vmax=100)
most = right.pcolormesh(x_km, y_km, np.where(strongest >= 5, strongest, np.nan), **REFLECTIVITY)
left.set_title(f"Share of volumes with at least {RAIN_DBZ} dBZ")
right.set_title("Strongest reflectivity")
left.set_ylabel("km north of the radar")
figure.colorbar(share, ax=left, label="%", shrink=0.8)
figure.colorbar(most, ax=right, label="dBZ", shrink=0.8)
for axes in (left, right):
    axes.set_aspect("equal")
    axes.set_xlabel("km east of the radar")
figure.suptitle(f"{volumes[0].station}, {volumes[0].start.astype('datetime64[s]')} to {volumes[-1].start.astype('datetime64[s]')} UTC")
figure.savefig(picture)
