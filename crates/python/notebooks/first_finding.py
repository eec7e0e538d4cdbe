# ---
# jupyter:
#   jupytext:
#     text_representation:
#       extension: .py
#       format_name: percent
#   kernelspec:
#     display_name: Python 3
#     language: python
#     name: python3
# ---

# %% [markdown]
# # A first finding
#
# A fault is hidden in a simulated record. The diagnosis finds it, names it and gives its size; the
# extended model then gives the drift coefficients without its error. Open this file as a notebook with
# jupytext. It needs the wheel and pandas, no Rust.

# %%
import numpy as np

import gyrocal

# %% [markdown]
# ## Simulate a platform, and hide a fault in it
#
# Gyro y has a mass unbalance along a cross axis, which the bench description does not declare and the
# model of the calibration does not have.

# %%
scenario = {
    "seed": 39,
    "site": {"latitude_deg": 39.1},
    "platform": {
        "initial_angles_deg": [12.0, -25.0, 40.0],
        "initial_angles_sigma_deg": [0.01, 0.01, 0.01],
    },
    "gyros": {
        "bias_deg_per_h": [0.412, -0.287, 0.153],
        "g_deg_per_h_per_g": [-0.126, 0.214, 0.087],
        "gg_deg_per_h_per_g2": [0.041, -0.068, 0.023],
    },
    "hidden": [{"effect": "gyro_y.g_z", "size": 0.005}],
    "noise": {"accel_g": 1e-5, "gyro_deg_per_h": 0.002},
    "sampling": {"duration_s": 259200.0, "interval_s": 300.0},
}
truth = gyrocal.simulate(scenario)
truth

# %%
truth.record.to_pandas().describe()

# %% [markdown]
# ## Find it
#
# The diagnosis gets the record and the bench description: what an operator has.

# %%
found = gyrocal.diagnose(truth.record, truth.bench)
found

# %%
found.to_pandas().T

# %% [markdown]
# The cause is the hidden one, and its size lies within five standard deviations of the truth.

# %%
cause = found.findings[0]
size = cause.parameters[0]
hidden = truth.hidden[0].parameters[0]
assert cause.effect == truth.hidden[0].effect
assert abs(size.estimate - hidden.value) < 5 * size.sigma
f"{cause.effect}: {size.estimate:.5f} +- {size.sigma:.5f}, hidden {hidden.value} {size.unit}"

# %% [markdown]
# ## Coefficients with and without the cause
#
# The nominal model takes the fault for errors of its own coefficients. With the cause in the model
# they are those that were simulated.

# %%
calibrated = gyrocal.calibrate(truth.record, truth.bench, effects=[cause.effect])
table = calibrated.to_pandas().set_index("name")
extended = {one.name: one for one in calibrated.with_effects.coefficients}
true = {one.name: one.value for one in truth.coefficients}
table["true"] = true
table["extended"] = {name: one.estimate for name, one in extended.items()}
table["error, sigmas"] = (table["estimate"] - table["true"]) / table["sigma"]
sigmas = np.array([extended[name].sigma for name in table.index])
table["extended error, sigmas"] = (table["extended"] - table["true"]) / sigmas
table[["true", "estimate", "extended", "error, sigmas", "extended error, sigmas"]]

# %%
assert calibrated.verdict == "effects-found"
assert table["extended error, sigmas"].abs().max() < 5 < table["error, sigmas"].abs().max()

# %% [markdown]
# ## Gain
#
# In blocks of the record that the fit did not use, the extended model predicts better; without
# updates it stays nearer to the record.

# %%
gain = found.gain
assert gain.cross_validated_log_score_nats > 0
f"log score gained in cross-validation: {gain.cross_validated_log_score_nats:.1f} nats"

# %% [markdown]
# ## The next run
#
# A plan finds the attitude from which the next run says most about the coefficients.

# %%
planned = gyrocal.plan(truth.record, truth.bench, diagnosis=found, hours=24)
planned
