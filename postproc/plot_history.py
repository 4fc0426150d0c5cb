#!/usr/bin/python3
"""Plots how a run converged: residuals and active constraints over products with F, from history.csv.

    plot_history.py OUTPUT_DIRECTORY PICTURE.png
"""
import csv
import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    with open(pathlib.Path(sys.argv[1]) / "history.csv", newline="") as file:
        rows = [row for row in csv.DictReader(file) if row["stage"] == "outer"]
    products = [int(row["hessian_multiplications"]) for row in rows]
    figure, (residuals, active) = plt.subplots(2, 1, sharex=True, figsize=(7, 6))
    for name, label in (("projected_gradient", "projected gradient"), ("equality", "equality"), ("slip_bound_change", "change of slip bounds")):
        values = [float(row[name] or "nan") for row in rows]
        if name != "slip_bound_change" or int(rows[-1]["friction_step"]) > 1:
            residuals.semilogy(products, [v if v > 0 else float("nan") for v in values], "o-", markersize=3, label=label)
    residuals.set_ylabel("relative")
    residuals.legend()
    for name in ("open", "slipping"):
        active.step(products, [int(row[name]) for row in rows], where="post", label=name)
    active.set_ylabel("contact nodes")
    active.set_xlabel("products with F")
    active.legend()
    figure.tight_layout()
    figure.savefig(sys.argv[2], dpi=120)


if __name__ == "__main__":
    main()
