# %% [markdown]
# # A run on a cluster
# Here two workers of this machine; with dask-jobqueue's `SLURMCluster` in place of `LocalCluster` those of a cluster.
# What the store holds is not computed again: after an interruption the same call goes on.

# %%
import tempfile
from pathlib import Path

from distributed import Client, LocalCluster

import kickdrift.dask

folder = tempfile.TemporaryDirectory()
store = Path(folder.name) / "figure1.zarr"
with LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster, Client(cluster) as client:
    data = kickdrift.dask.map(
        store,
        client=client,
        lambda1="pi^2",
        lambda2="pi^2/25",
        step="1/400",
        h1=("1/400", "2/pi"),
        h2=("1/400", "7/2"),
        growth=True,
    )
data

# %%
import matplotlib.pyplot as plt

(data.growth_rate > 0).mean("h2").plot()
plt.xlabel("fast step h1")
plt.ylabel("share of slow steps h2 that grow")
