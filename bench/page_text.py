# SPDX-License-Identifier: BSD-3-Clause
"""Rows of a table, as csv.DictReader reads them, and the text that page.py makes of them."""
import math


def value(row, column):
    try:
        return float(row[column])
    except ValueError:
        return math.nan


def values(rows, column):
    return list(dict.fromkeys(row[column] for row in rows))


def where(rows, **wanted):
    return [row for row in rows if all(row[key] == text for key, text in wanted.items())]


def figure(number, digits=2):
    """Short and readable: 0.62, 12, 1.3e-07; blown up or missing: a dash."""
    if not math.isfinite(number) or abs(number) > 1e6:
        return '–'
    if number != 0 and not 1e-3 <= abs(number) < 1e5:
        return f'{number:.{digits - 1}e}'
    return f'{number:.{digits}g}' if abs(number) < 10 ** digits - 0.5 else f'{number:.0f}'


def markdown(header, rows):
    lines = ['| ' + ' | '.join(header) + ' |', '|' + '---|' * len(header)]
    return '\n'.join(lines + ['| ' + ' | '.join(row) + ' |' for row in rows]) + '\n'
