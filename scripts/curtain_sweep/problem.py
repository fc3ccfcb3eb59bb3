# SPDX-License-Identifier: BSD-3-Clause
"""What ends a sweep with one message."""
import difflib


class Problem(Exception):
    """Bad input: nothing was started. Exit code 2."""


class Unfinished(Exception):
    """Runs are missing that the same command makes up for. Exit code 4."""


def near(name, names):
    """', did you mean …?', or nothing."""
    close = difflib.get_close_matches(name, list(names), n=1)
    return ", did you mean %s?" % close[0] if close else ""
