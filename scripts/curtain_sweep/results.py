# SPDX-License-Identifier: BSD-3-Clause
"""results.csv: a row for every run that has been made, with its parameters, what curtain_batch returned and said, where it was made,
and its statistics."""
import csv
import io
import json
import os

from curtain_sweep.problem import Problem, near


def flat(value, name=""):
    """Entries of statistics by dotted name: stretch_max.warp, wrenches.ball.force[0]."""
    if isinstance(value, dict):
        for key, of in value.items():
            yield from flat(of, "%s.%s" % (name, key) if name else key)
    elif isinstance(value, list):
        for n, of in enumerate(value):
            yield from flat(of, "%s[%d]" % (name, n))
    else:
        yield name, value


class Result:
    """Of one run. ValueError: the text is not whole."""

    def __init__(self, name, values, host, text):
        self.name, self.values, self.host = name, values, host
        self.exit_code, self.error, self.metrics = 0, "", {}
        if text.startswith("exit "):
            first, end, said = text.partition("\n")
            if not end or not text.endswith("\n"):
                raise ValueError("cut short")
            self.exit_code = int(first[5:])
            self.error = " | ".join(said.replace("curtain_batch: ", "", 1).split("\n")).strip(" |")
            self.error = self.error or "crashed by signal %d" % (self.exit_code - 128)
        else:
            self.metrics = dict(flat(json.loads(text)))


def states(path):
    """Nodes of all the states in a file of trajectories."""
    with open(path, "rb") as file:
        return sum(part.count(b"\n") for part in iter(lambda: file.read(1 << 20), b"")) - 1


def read_result(folder, name, values, host, samples):
    """Of one run, with so many states in its trajectory; None: its files are not there, or not whole. The job log can't know that:
    the run was good, and then they were not brought from the other machine, or a power failure took them."""
    try:
        with open(folder.of("runs", name + ".result"), encoding="utf-8", errors="replace") as file:
            result = Result(name, values, host, file.read())
        whole = not samples or result.exit_code != 0 or states(folder.of("runs", name + ".csv")) == samples * result.metrics["nodes"]
    except (FileNotFoundError, ValueError, KeyError):
        return None
    return result if whole else None


def read_results(folder, scenes, runs, made, samples):
    """The runs that the job log has, in their order, if their files are whole."""
    results = []
    for n, (name, values) in enumerate(zip(scenes.names, runs)):
        host, _, code = made.get(n + 1, ("", "", -1))
        if code != 0:
            continue
        result = read_result(folder, name, values, host, samples)
        if result:
            results.append(result)
    return results


def names_of_metrics(results, wanted):
    """Those asked for, or all that any run has."""
    return wanted if wanted is not None else list(dict.fromkeys(name for result in results for name in result.metrics))


def check_metrics(wanted, known):
    """Refuses a metric that the statistics do not have."""
    for name in wanted:
        if name not in known:
            raise Problem("metrics: the statistics have no %s%s" % (name, near(name, known)))


def cell(value):
    """As text; numbers with all their digits."""
    return "" if value is None else value if isinstance(value, str) else json.dumps(value)


def table(results, design):
    """The text of results.csv."""
    metrics = names_of_metrics(results, design.metrics)
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(["run"] + [p.name for p in design.parameters] + ["exit_code", "error", "host"] + metrics)
    for result in results:
        writer.writerow([result.name] + [cell(value) for value in result.values] + [result.exit_code, result.error, result.host] +
                        [cell(result.metrics.get(name)) for name in metrics])
    return out.getvalue()


def trajectory(folder, result):
    """Path of a run's states; None: it has none."""
    path = folder.of("runs", result.name + ".csv")
    return path if result.exit_code == 0 and os.path.exists(path) else None
