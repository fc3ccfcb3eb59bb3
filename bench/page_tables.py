# SPDX-License-Identifier: BSD-3-Clause
"""The studies' tables and pictures, and how page.py names what is in them."""
import csv
import os

from page_text import value

RIVALS = ('symplectic Euler', 'Runge-Kutta 4', 'Baraff-Witkin', 'PBD', 'XPBD', 'btSoftBody')


class Folder:
    def __init__(self, path):
        self.path = path

    def table(self, study):
        """Its rows; none: it was not measured."""
        path = os.path.join(self.path, study + '.csv')
        if not os.path.exists(path):
            return []
        with open(path, newline='') as file:
            return list(csv.DictReader(file))

    def picture(self, file, text):
        return f'![{text}]({file})\n' if os.path.exists(os.path.join(self.path, file)) else ''


def name(method):
    return method if method in RIVALS else f'**{method}**'


def cheapest(rows, error):
    """The fastest row that is at least this true; None: there is none."""
    good = [row for row in rows if value(row, 'error_m') <= error]
    return min(good, key=lambda row: value(row, 'ms_min')) if good else None
