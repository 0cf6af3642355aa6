# %% [markdown]
# # A storm in three dimensions
# Run it as `python storm_3d.py FILE PICTURE`. It finds the strongest echo of a volume, grids 80 km about it, and draws the
# storm in three dimensions and as a cut from west to east.

# %%
import sys

import matplotlib.pyplot as plt
import numpy as np

import stormcellar

file, picture = sys.argv[1:3]

# %% [markdown]
# The strongest echo well above the ground is in a storm, because hills and birds are lower.

# %%
volume = stormcellar.Volume(file)
coarse = stormcellar.grid(volume, columns=240, rows=240, levels_m=[4000, 5000, 6000])
values = np.where(np.isnan(coarse.values()), -np.inf, coarse.values())
_, row, column = np.unravel_index(values.argmax(), values.shape)
latitude = coarse.center[0] + coarse.y_m[row] / 111_200
longitude = coarse.center[1] + coarse.x_m[column] / (111_200 * np.cos(np.radians(latitude)))
print(f"{values.max():.1f} dBZ at {latitude:.2f}, {longitude:.2f}")

# %%
storm = stormcellar.grid(volume, columns=160, rows=160, spacing_m=500, levels_m=np.arange(500, 18_001, 250),
                         center=(latitude, longitude))
states = storm.states()
print(storm, f"has {np.mean(states == stormcellar.CellState.not_seen):.0%} cells that no beam saw")

# %% [markdown]
# `draw` takes every option of `stormcellar frame`. Without `pixels=True` it returns a PNG, which a notebook shows.

# %%
solid = stormcellar.draw(storm, width=900, height=700, pixels=True)
ends = (latitude, longitude - 0.4, latitude, longitude + 0.4)
cut = stormcellar.draw(storm, "section", section=ends, width=900, height=700, pixels=True)

# %%
figure, panels = plt.subplots(1, 2, figsize=(18, 7), layout="constrained")
for axes, image in zip(panels, (solid, cut)):
    axes.imshow(image)
    axes.axis("off")
figure.savefig(picture)
