"""The quick tour of README in Python: simulate a gyro, fit a model, draw its noise budget.

    python3 noise_budget.py [OUT.png]
"""

import sys

import imunoise
import matplotlib
import numpy as np

matplotlib.use("Agg")
from matplotlib import pyplot as plt  # noqa: E402: after the choice of the engine

TO_DEG_H = np.rad2deg(1) * 3600  # rad/s in °/h


def allan(variance: np.ndarray) -> np.ndarray:
    """Allan deviation (°/h) of a wavelet variance ((rad/s)²)."""
    return np.sqrt(2 * variance) * TO_DEG_H


gyro = imunoise.simulate("WN(sigma2=2.5e-7) + AR1(sigma2=4e-11, phi=0.998) + RW(gamma2=5e-14)", rate=100,
                         samples=360_000, replicates=6, seed=42, unit="rad/s", channel="gyro_x")
report = imunoise.fit(gyro, "WN + AR1 + RW")
print(report["summary"])

budget = report["budget"]
tau = budget["scales_s"] / 2  # s: the wavelet averages over two Allan times
figure, (above, below) = plt.subplots(2, sharex=True, figsize=(7, 6), height_ratios=(3, 1), layout="constrained")
above.fill_between(tau, allan(budget["lower"]), allan(budget["upper"]), color="0.85", label="95 % under the model")
for term in report["terms"]:
    above.plot(tau, allan(term["variance"]), "--", lw=1, label=f"{term['name']}: {term['title']}")
above.plot(tau, allan(budget["model"]), "k", lw=1.5, label=report["model"])
above.plot(tau, allan(budget["measured"]), "o", ms=4, label="measured")
shown = allan(budget["measured"])
above.set(xscale="log", yscale="log", ylabel="Allan deviation (°/h)", title=f"gyro_x: {report['verdict']}, p = {report['p_value']:.2g}",
          ylim=(shown.min() / 5, shown.max() * 2))
above.legend(fontsize="small")
below.axhspan(-2, 2, color="0.9")
below.stem(tau, budget["residual"], basefmt="k-")
below.set(xlabel="averaging time τ (s)", ylabel="residual (σ)")
figure.savefig(sys.argv[1] if len(sys.argv) > 1 else "noise_budget.png", dpi=110)
