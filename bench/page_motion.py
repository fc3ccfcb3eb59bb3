# SPDX-License-Identifier: BSD-3-Clause
"""Sections of page.py: motion without contact, its error against its cost."""
import math

from page_tables import cheapest, name
from page_text import figure, markdown, value, values, where


def work_precision(folder):
    rows = folder.table('work_precision')
    text = ['## Work and precision\n', 'Root mean square over the free nodes of the distance from the exact chain (quadruple '
            'precision, test/truth) after one second, against the computing time of that second. Lines: the best of each '
            'method; dots: all settings that were tried.\n']
    for scene, what in (('swing', 'swing: 44 x 40 nodes, released straight at 45°'),
                        ('drop', 'drop: 11 x 40 nodes, released straight at 90°')):
        here = where(rows, scene=scene)
        if not here:
            continue
        text += [f'### {what}\n', folder.picture(f'work_precision_{scene}.png', what)]
        text += ['Fastest setting that keeps the error below a bound, ms for the second (minimum; median in brackets):\n']
        bounds = (1e-2, 1e-3, 1e-4)
        body = []
        for method in values(here, 'method'):
            cells = [name(method)]
            for bound in bounds:
                row = cheapest(where(here, method=method), bound)
                cells.append('not reached' if row is None else
                             f"{figure(value(row, 'ms_min'))} ({figure(value(row, 'ms_median'))}): {row['setting']}")
            body.append(cells)
        text.append(markdown(['method'] + [f'{1e3 * bound:g} mm' for bound in bounds], body))
    chains = [s for s in values(rows, 'scene') if s.startswith('chain_')]
    if chains:
        scenes = chains + ['swing']
        text += ['### Chains of 1 to 43 rods, 40 side by side, released at 45°\n', folder.picture('work_precision_chains.png', 'chains'),
                 'Shortest computing time [ms] for one second with an error below 1 mm:\n']
        body = []
        for method in values(rows, 'method'):
            best = [cheapest(where(rows, scene=scene, method=method), 1e-3) for scene in scenes]
            body.append([name(method)] + ['–' if row is None else figure(value(row, 'ms_min')) for row in best])
        text.append(markdown(['method \\ rods'] + [s[6:] for s in chains] + ['43'], body))
    return text


def slopes(folder):
    rows = folder.table('slopes')
    body = [[name(m)] + [f"{figure(value(r, 'error_m'))} ({figure(value(r, 'order'))})" for r in where(rows, method=m)]
            for m in values(rows, 'method')]
    return ['## Order of our methods\n', folder.picture('slopes.png', 'error against the step'),
            'Error in the swing [m] and, in brackets, the order seen from the row\'s last column to this one.\n',
            markdown(['substeps a frame'] + values(rows, 'substeps'), body)]


def energy(folder):
    rows = folder.table('energy')
    last = max(int(row['t_s']) for row in rows)
    body = []
    for method in values(rows, 'method'):
        for setting in values(where(rows, method=method), 'setting'):
            track = where(rows, method=method, setting=setting)
            end = [row for row in track if int(row['t_s']) == last]
            largest = max(abs(value(row, 'drift')) for row in track)
            body.append([name(method), setting, figure(value(end[0], 'drift')) if end else '–', figure(largest)])
    return ['## Energy\n', folder.picture('energy.png', 'energy over time'),
            f'Undamped swing over {last} s: (E(t) - E(0)) / (E(0) - E(rest)), E of motion, gravity and springs, E(rest) of the '
            'cloth straight down. 0: kept; -1: all that can be lost.\n',
            markdown(['method', 'setting', f'after {last} s', 'largest at any second'], body)]


def modes(folder):
    rows = folder.table('modes')
    body = []
    for method in values(rows, 'method'):
        for setting in values(where(rows, method=method), 'setting'):
            here = where(rows, method=method, setting=setting)
            body.append([name(method), setting] + [figure(value(row, 'relative_error')) for row in here] +
                        [figure(value(here[0], 'decay_per_s')), figure(value(here[-1], 'decay_per_s'))])
    return ['## Small oscillations\n', folder.picture('modes.png', 'errors of the frequencies'),
            'Relative error of the first five frequencies of the chain of 43 rods, and how fast the first and the fifth mode '
            'are damped (exact: 0).\n',
            markdown(['method', 'setting', '1', '2', '3', '4', '5', 'decay 1 [1/s]', 'decay 5 [1/s]'], body)]


def nets(folder):
    rows = folder.table('nets')
    body = []
    for method in values(rows, 'method'):
        for setting in values(where(rows, method=method), 'setting'):
            here = where(rows, method=method, setting=setting)
            errors = sorted(abs(value(row, 'relative_error')) for row in here)
            body.append([name(method), setting, figure(errors[len(errors) // 2]), figure(errors[-1]),
                         figure(max(value(row, 'stretch') for row in here)),
                         figure(max(value(row, 'ms_per_frame') for row in here))])
    return ['## Nets at rest\n', folder.picture('nets.png', 'energy of nets at rest'),
            f"{len(where(rows, method=values(rows, 'method')[0]))} nets, 3 to 10 nodes wide, hung by two corners or hooks, after "
            '15 s: potential energy against the least there is.\n',
            markdown(['method', 'setting', 'median', 'worst', 'largest stretch', 'ms a frame, at most'], body)]


def wind(folder):
    rows = folder.table('wind')
    ratios = values(rows, 'r')
    body = [[name(m)] + [figure(value(row, 'tip_error_over_L')) for row in where(rows, method=m)]
            for m in values(rows, 'method')]
    return ['## Wind\n', folder.picture('wind.png', 'chain in the wind'),
            'A chain in a uniform wind: distance of its tip at rest from the closed form, over its length; r = wind force over '
            'weight.\n', markdown(['method \\ r'] + ratios, body)]


def gusts(folder):
    rows, motion = folder.table('gusts'), folder.table('gusts_motion')
    body = []
    for row in rows:
        track = where(motion, wind=row['wind'], method=row['method'], setting=row['setting'])
        at = {time: next((value(m, 'error_m') for m in track if abs(value(m, 't_s') - time) < 1e-6), math.nan)
              for time in (1, 2)}
        body.append([row['wind'], name(row['method']), row['setting'], figure(value(row, 'ms_min')),
                     figure(value(row, 'ms_median')), figure(value(row, 'ms_max')), figure(value(row, 'substeps')),
                     figure(value(row, 'stretch')), figure(at[1]), figure(at[2])])
    return ['## The gathered curtain in its fan\n', folder.picture('gusts.png', 'curtain in gusts'),
            folder.picture('gusts_steady.png', 'curtain in a steady fan'),
            'config/scenes/curtain.yaml without the ball; distance [m] from our finest run after 1 and 2 s. The motion is '
            'chaotic: distances grow with time at any step.\n',
            markdown(['wind', 'method', 'setting', 'frame [ms]: lowest median of the runs', 'median of the runs', 'longest frame of the last run',
                      'substeps a frame', 'misfit', 'distance after 1 s [m]', 'after 2 s [m]'],
                     body)]
