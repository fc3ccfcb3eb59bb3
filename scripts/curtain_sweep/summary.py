# SPDX-License-Identifier: BSD-3-Clause
"""summary.png: metrics over parameters, a point a run; runs that failed are crosses at the bottom."""
from curtain_sweep.results import cell, names_of_metrics

USUAL = ["stretch_max.warp", "energy.final", "contacts_max", "wall_s"]
MOST = 5  # rows and columns of the picture


def numbers(values, order):
    """Values to draw by: themselves, or places of texts in an order, with the texts."""
    if all(isinstance(value, (int, float)) and not isinstance(value, bool) for value in values):
        return list(values), None
    texts = [cell(value) for value in values]
    ticks = list(dict.fromkeys(map(cell, order or values)))
    return [ticks.index(text) for text in texts], ticks


def plot(path, results, design):
    """Draws the picture; returns what was left out and why, or nothing."""
    try:
        import matplotlib
    except ImportError:
        return "summary.png is left out: python3-matplotlib is not installed"
    matplotlib.use("Agg")
    from matplotlib import pyplot

    good = [result for result in results if result.exit_code == 0]
    wanted = names_of_metrics(good, design.metrics or USUAL)
    metrics = [name for name in wanted if any(isinstance(r.metrics.get(name), (int, float)) for r in good)][:MOST]
    parameters = list(enumerate(design.parameters))[:MOST]
    if not metrics:
        return "summary.png is left out: no run has a number to draw"
    figure, axes = pyplot.subplots(len(metrics), len(parameters), sharey="row", sharex="col", squeeze=False,
                                   figsize=(1.5 + 2.8 * len(parameters), 0.8 + 2.2 * len(metrics)))
    for column, (n, parameter) in enumerate(parameters):
        places, ticks = numbers([result.values[n] for result in results], parameter.values)
        for row, name in enumerate(metrics):
            axis = axes[row][column]
            drawn = [(x, r.metrics[name]) for x, r in zip(places, results) if isinstance(r.metrics.get(name), (int, float))]
            axis.plot([x for x, _ in drawn], [y for _, y in drawn], ".", color="tab:blue")
            failed = [x for x, r in zip(places, results) if r.exit_code != 0]
            axis.plot(failed, [0.02] * len(failed), "x", color="tab:red", transform=axis.get_xaxis_transform())
            axis.grid(True, linewidth=0.3)
            if parameter.scale == "log":
                axis.set_xscale("log")
            if ticks:
                axis.set_xticks(range(len(ticks)))
                axis.set_xticklabels(ticks, rotation=30, ha="right")
            if column == 0:
                axis.set_ylabel(name)
            if row == len(metrics) - 1:
                axis.set_xlabel(parameter.name)
    figure.tight_layout()
    figure.savefig(path, dpi=100)
    pyplot.close(figure)
    return None
