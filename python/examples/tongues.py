# %% [markdown]
# # Tongues, and where they close
# For a ratio of steps and of stiffnesses the unstable set is a list of intervals in s = h1² lambda1, with
# certified edges.

# %%
import kickdrift as kd

seven_thirds = kd.tongues("7/3", rho="1/25")
seven_thirds.plot()
seven_thirds.to_pandas()[["m", "a", "b", "lower_lo", "upper_hi", "width_lo"]]

# %% [markdown]
# The plane that they lie in, to move in: drag, zoom, point at a tongue, cut along a ratio.

# %%
kd.explore(lambda1="pi^2", lambda2="pi^2/25")

# %% [markdown]
# One edge to fifty digits, and a recheck of the whole list by exact signs at both ends of each edge.

# %%
print(kd.tongues("7/3", rho="1/25", m=4, digits=50)[0]["lower"])
kd.recheck(seven_thirds)

# %% [markdown]
# A closed tongue is a resonance that does not destabilize: Q = I or -I there, proven.

# %%
for row in kd.closings(max_sum=8):
    s, rho = row["s"]["exact"], row["rho"]["exact"]
    verdict = kd.decide(lambda1=s, lambda2=f"({s})*({rho})", h1=1, h2=f"{row['p']}/{row['q']}")
    print(f"{row['p']}/{row['q']}: s = {s}, rho = {rho}: {verdict.kind}")
    assert verdict.kind == "coexistence"
