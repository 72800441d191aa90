# %% [markdown]
# # A table for a paper
# Where the trace and the prediction by resonance disagree, as a LaTeX table; and the Proposition with its witnesses.

# %%
import kickdrift as kd

found = kd.compare(max_sum=10, rho="1/25", samples=99)
print(found.to_latex()[:600])

# %%
proposition = kd.proposition(max=12)
assert proposition.holds
proposition.to_pandas().head()
