# %% [markdown]
# # Figure 1 in ten lines
# Two forces of periods 2 and 10 on one mass: every pair of steps (h1, h2) on a grid of
# 1/200 is decided, none is guessed.

# %%
import matplotlib.pyplot as plt

import kickdrift as kd

figure1 = kd.map(
    lambda1="pi^2", lambda2="pi^2/25", step="1/200", h1=("1/200", "2/pi"), h2=("1/200", "7/2"), growth=True
)
fig, (left, right) = plt.subplots(1, 2, figsize=(9, 6), layout="constrained", sharey=True)
figure1.plot(left)
kd.curves().plot(right)
left.set_title(f"{figure1.document.data['unstable']} unstable of {figure1.verdict.size} pairs", pad=22)
right.set_title("resonances")
figure1

# %% [markdown]
# The same pairs by how fast they grow, and the fastest of them.

# %%
figure1.plot(colour="growth")
figure1.to_pandas().nlargest(3, "growth_rate")
