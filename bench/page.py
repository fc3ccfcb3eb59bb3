#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Writes README.md beside the benchmark's tables: bench/page.py FOLDER. Every figure comes from a table, and of every table
FOLDER/stamps.csv says at which commit, when and on what it was measured (bench/run).

Tables of different sources make no page, for their figures don't compare; with --mixed they do, and the page says so. With --check
it only says whether the page is up to date.
"""
import argparse
import collections
import csv
import math
import os
import sys

from page_engines import engines
from page_text import figure, markdown, value, values, where

PARSER = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
PARSER.add_argument('folder')
PARSER.add_argument('--mixed', action='store_true')
PARSER.add_argument('--check', action='store_true')
OPTIONS = PARSER.parse_args()
FOLDER = OPTIONS.folder
RIVALS = ('symplectic Euler', 'Runge-Kutta 4', 'Baraff-Witkin', 'PBD', 'XPBD', 'btSoftBody')
ELSEWHERE = ('engines',)  # made by bench/engines/run of sources that bench/run lacks, so not always of the other studies' engine; its text says of which


def table(name):
    path = os.path.join(FOLDER, name + '.csv')
    if not os.path.exists(path):
        return []
    with open(path, newline='') as file:
        return list(csv.DictReader(file))


def name(method):
    return method if method in RIVALS else f'**{method}**'


def picture(file, text):
    return f'![{text}]({file})\n' if os.path.exists(os.path.join(FOLDER, file)) else ''


def cheapest(rows, error):
    """The fastest row that is at least this true; None: there is none."""
    good = [row for row in rows if value(row, 'error_m') <= error]
    return min(good, key=lambda row: value(row, 'ms_min')) if good else None


def work_precision():
    rows = table('work_precision')
    text = ['## Work and precision\n', 'Root mean square over the free nodes of the distance from the exact chain (quadruple '
            'precision, test/truth) after one second, against the computing time of that second. Lines: the best of each '
            'method; dots: all settings that were tried.\n']
    for scene, what in (('swing', 'swing: 44 x 40 nodes, released straight at 45°'),
                        ('drop', 'drop: 11 x 40 nodes, released straight at 90°')):
        here = where(rows, scene=scene)
        if not here:
            continue
        text += [f'### {what}\n', picture(f'work_precision_{scene}.png', what)]
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
        text += ['### Chains of 1 to 43 rods, 40 side by side, released at 45°\n', picture('work_precision_chains.png', 'chains'),
                 'Least ms for one second with an error below 1 mm:\n']
        body = []
        for method in values(rows, 'method'):
            best = [cheapest(where(rows, scene=scene, method=method), 1e-3) for scene in scenes]
            body.append([name(method)] + ['–' if row is None else figure(value(row, 'ms_min')) for row in best])
        text.append(markdown(['rods'] + [s[6:] for s in chains] + ['43'], body))
    return text


def slopes():
    rows = table('slopes')
    body = [[name(m)] + [f"{figure(value(r, 'error_m'))} ({figure(value(r, 'order'))})" for r in where(rows, method=m)]
            for m in values(rows, 'method')]
    return ['## Order of our methods\n', picture('slopes.png', 'error against the step'),
            'Error in the swing [m] and, in brackets, the order seen from the row\'s last column to this one.\n',
            markdown(['substeps a frame'] + values(rows, 'substeps'), body)]


def closed_forms():
    rows = table('closed_forms')
    bounds = (0.1, 0.03, 0.01, 0.003)
    body, first = [], values(rows, 'problem')[0]
    tried = ', '.join(f"{method} {len(where(rows, problem=first, method=method))}" for method in values(rows, 'method'))
    for problem in values(rows, 'problem'):
        for method in values(rows, 'method'):
            here = where(rows, problem=problem, method=method)
            cells = [problem, name(method)]
            for bound in bounds:
                good = [row for row in here if value(row, 'error') <= bound]
                row = min(good, key=lambda row: value(row, 'ms_median')) if good else None
                cells.append('not reached' if row is None else f"{figure(value(row, 'ms_median'))}: {row['setting']}")
            sound = [value(row, 'error') for row in here if math.isfinite(value(row, 'error'))]
            body.append(cells + [figure(min(sound)) if sound else '–'])
    return ['## Contact against closed forms\n',
            'Fastest setting that keeps the error below a bound: median of a frame [ms], one core, 60 frames a second. The error is relative; '
            'of the belt it is the creep in 3 s, in which the belt goes 20 m [m].\n',
            '- scarf: slides off a bar without friction, links of 15 mm; Atwood: a strap over such a bar with 75 and 50 g at its ends. Both '
            'sink as cosh; links on the bar are chords of it, which alone may put the result off by 2 %.',
            '- slope: a sheet slides down 30 degrees with friction 0.3 for half a second.',
            '- belt: a sheet on a belt that speeds up with 0.45 g, friction 0.5.',
            '- capstan: the largest load that a strap over a bar of friction 0.3 holds with 50 g at its other end, over Euler\'s e^(mu pi) with '
            'the strap\'s own weight, sought between 0.5 and 1.5 to a thousandth: 0.5 off is nothing held.\n',
            'PBD and XPBD push nodes out of what is solid in each iteration, with the friction of Macklin, Mueller, Chentanez, Kim (2014, '
            f'Eq. (24)). Settings tried of each: {tried}.\n',
            markdown(['problem', 'method'] + [f'{bound:g}' for bound in bounds] + ['least error'], body)]


def gathered():
    rows = table('gathered')
    looks = [column for column in rows[0] if column.startswith('apart_')]
    text = ['## A gathered curtain that touches itself\n',
            '44 x 40 nodes, 2 m x 1 m, on 0.5 m, in a fan that gusts; limp, and of a fabric of a light cotton\'s weight, shear and bending. Means over '
            '15 s from the third second on, with the standard error of means of a second each.\n',
            '- apart: distance of the nodes from those of the finest run (the first row), RMS, after the time in the header. It grows quickly: '
            'the motion is chaotic, and no run stays near another for long.',
            '- drag: force of the air along the fan\'s axis. depth: of the folds, RMS of the nodes off their row\'s mean. motion: kinetic energy. '
            'fine: what of it is in waves across the cloth shorter than eight links.',
            '- off: the largest difference of the four means from those of the finest run, in standard errors of the difference; some 2 is chance.\n']
    for scene in values(rows, 'scene'):
        here = where(rows, scene=scene)
        finest = here[0]
        body = []
        for row in here:
            means = [f"{figure(value(row, kind) * scale, 3)} ± {figure(value(row, kind + '_error') * scale, 2)}"
                     for kind, scale in (('drag', 1.0), ('depth', 1e3), ('motion', 1e3), ('fine', 1e3))]
            off = max(abs(value(row, kind) - value(finest, kind)) / math.hypot(value(row, kind + '_error'), value(finest, kind + '_error'))
                      for kind in ('drag', 'depth', 'motion', 'fine'))
            setting = 'default' if row['substeps'] == '0' else 'substeps ' + row['substeps']
            body.append([name(row['method']), f"{setting}; tolerance {row['tolerance']}", figure(value(row, 'ms_median')), figure(value(row, 'ms_99')),
                         figure(value(row, 'substeps_mean'))] + [figure(1e3 * value(row, look)) for look in looks] + means
                        + ['' if row is finest else figure(off)])
        text += [f'### {scene}\n',
                 markdown(['method', 'setting', 'ms a frame, median', '99 %', 'substeps']
                          + [f"apart after {int(look.split('_')[1]) / 60:g} s [mm]" for look in looks]
                          + ['drag [N]', 'depth [mm]', 'motion [mJ]', 'fine [mJ]', 'off'], body)]
    return text


def fabric():
    rows, samples = table('fabric'), table('fabric_drape')
    body = []
    for case in values(rows, 'case'):
        for method in values(rows, 'method'):
            here = where(rows, case=case, method=method)
            body.append([case, name(method)] + [f"{figure(value(row, 'error'))} ({figure(value(row, 'ms_median'))}; {row['substeps']})" for row in here])
    drape = [[row['fabric'], name(row['method']) if row['method'] != 'shell' else 'shell',
              f"{row['size']} rings" if row['method'] == 'shell' else f"{row['size']} x {row['size']}",
              f"{figure(100 * value(row, 'coefficient'), 3)} ± {figure(100 * value(row, 'spread'))} %", figure(value(row, 'folds')),
              figure(value(row, 'seconds'))] for row in samples]
    return ['## Bending and drape\n',
            'A strip that stands out horizontally and sinks under its weight: drop of its end against the heavy elastica (test/truth), relative; in '
            'brackets ms a frame and substeps. Gamma = weight x length^3 / (width x rigidity): 1 sinks by an eighth of its length, 100 hangs.\n',
            markdown(['case', 'method'] + [f'{rods} rods' for rods in values(rows, 'rods')], body),
            'Cusick\'s drape test of isotropic fabrics beside an elastic shell of triangles (bench/shell, nothing of the engine in it): mean and spread of '
            'the starts, folds, and computing time a start. Both settle in one of several shapes.\n',
            markdown(['fabric', 'by', 'grid', 'drape coefficient', 'folds', 's a start'], drape)]


def energy():
    rows = table('energy')
    last = max(int(row['t_s']) for row in rows)
    body = []
    for method in values(rows, 'method'):
        for setting in values(where(rows, method=method), 'setting'):
            track = where(rows, method=method, setting=setting)
            end = [row for row in track if int(row['t_s']) == last]
            largest = max(abs(value(row, 'drift')) for row in track)
            body.append([name(method), setting, figure(value(end[0], 'drift')) if end else '–', figure(largest)])
    return ['## Energy\n', picture('energy.png', 'energy over time'),
            f'Undamped swing over {last} s: (E(t) - E(0)) / (E(0) - E(rest)), E of motion, gravity and springs, E(rest) of the '
            'cloth straight down. 0: kept; -1: all that can be lost.\n',
            markdown(['method', 'setting', f'after {last} s', 'largest at any second'], body)]


def modes():
    rows = table('modes')
    body = []
    for method in values(rows, 'method'):
        for setting in values(where(rows, method=method), 'setting'):
            here = where(rows, method=method, setting=setting)
            body.append([name(method), setting] + [figure(value(row, 'relative_error')) for row in here] +
                        [figure(value(here[0], 'decay_per_s')), figure(value(here[-1], 'decay_per_s'))])
    return ['## Small oscillations\n', picture('modes.png', 'errors of the frequencies'),
            'Relative error of the first five frequencies of the chain of 43 rods, and how fast the first and the fifth mode '
            'are damped (exact: 0).\n',
            markdown(['method', 'setting', '1', '2', '3', '4', '5', 'decay 1 [1/s]', 'decay 5 [1/s]'], body)]


def nets():
    rows = table('nets')
    body = []
    for method in values(rows, 'method'):
        for setting in values(where(rows, method=method), 'setting'):
            here = where(rows, method=method, setting=setting)
            errors = sorted(abs(value(row, 'relative_error')) for row in here)
            body.append([name(method), setting, figure(errors[len(errors) // 2]), figure(errors[-1]),
                         figure(max(value(row, 'stretch') for row in here)),
                         figure(max(value(row, 'ms_per_frame') for row in here))])
    return ['## Nets at rest\n', picture('nets.png', 'energy of nets at rest'),
            f"{len(where(rows, method=values(rows, 'method')[0]))} nets, 3 to 10 nodes wide, hung by two corners or hooks, after "
            '15 s: potential energy against the least there is.\n',
            markdown(['method', 'setting', 'median', 'worst', 'largest stretch', 'ms a frame, at most'], body)]


def wind():
    rows = table('wind')
    ratios = values(rows, 'r')
    body = [[name(m)] + [figure(value(row, 'tip_error_over_L')) for row in where(rows, method=m)]
            for m in values(rows, 'method')]
    return ['## Wind\n', picture('wind.png', 'chain in the wind'),
            'A chain in a uniform wind: distance of its tip at rest from the closed form, over its length; r = wind force over '
            'weight.\n', markdown(['r'] + ratios, body)]


def hard_spot():
    rows, motion = table('hard_spot'), table('hard_spot_motion')

    def early(row):
        track = where(motion, sheet=row['sheet'], method=row['method'], setting=row['setting'], t_s='0.1')
        return figure(value(track[0], 'error_m')) if track else '–'

    text = ['## The hard spot: a two-corner sheet dropped flat\n',
            'Hung by two corners at 0.9 of its width. Distance: from our finest run (leapfrog, 256 substeps) at the last frame '
            'before the first snap, and at 0.1 s. That run is ours, which favours our methods at the snap: strings that '
            'become taut before it cause small impacts, which springs give back and rods do not. From there on, methods that '
            'agree at 0.1 s diverge, whatever their step. Misfit: largest of any link at any frame\'s end, relative. Energy rise: above the start, '
            'at any frame.\n']
    for sheet in values(rows, 'sheet'):
        here = where(rows, sheet=sheet)
        snap = value(here[0], 't_snap_s')
        text += [f'### {sheet}, first snap after {figure(snap)} s\n', picture(f'hard_spot_{sheet}.png', f'sheet {sheet}')]
        text.append(markdown(
            ['method', 'setting', 'ms a frame, median', 'most', 'substeps', 'misfit', 'at 0.1 s [m]', 'at the snap [m]', 'energy rise [J]', 'frames'],
            [[name(row['method']), row['setting'], figure(value(row, 'ms_median')), figure(value(row, 'ms_max')),
              figure(value(row, 'substeps')), figure(value(row, 'stretch')), early(row), figure(value(row, 'error_at_snap_m')),
              figure(value(row, 'energy_rise_J')), row['frames']] for row in here]))
    return text + [picture('hard_spot_motion.png', 'the way apart')]


def gusts():
    rows, motion = table('gusts'), table('gusts_motion')
    body = []
    for row in rows:
        track = where(motion, wind=row['wind'], method=row['method'], setting=row['setting'])
        at = {time: next((value(m, 'error_m') for m in track if abs(value(m, 't_s') - time) < 1e-6), math.nan)
              for time in (1, 2)}
        body.append([row['wind'], name(row['method']), row['setting'], figure(value(row, 'ms_min')),
                     figure(value(row, 'ms_median')), figure(value(row, 'ms_max')), figure(value(row, 'substeps')),
                     figure(value(row, 'stretch')), figure(at[1]), figure(at[2])])
    return ['## The gathered curtain in its fan\n', picture('gusts.png', 'curtain in gusts'),
            picture('gusts_steady.png', 'curtain in a steady fan'),
            'config/scenes/curtain.yaml without the ball; distance [m] from our finest run after 1 and 2 s. The motion is '
            'chaotic: distances grow with time at any step.\n',
            markdown(['wind', 'method', 'setting', 'ms a frame, least median', 'median', 'most', 'substeps', 'stretch', '1 s', '2 s'],
                     body)]


def scaling():
    rows = table('scaling')
    text = ['## Scaling\n', 'Default settings of ours; a frame is 1/60 s. 60 frames from the start, or as many as 3 s of '
            'computing allow. Misfits are of those frames: where the numbers of threads differ in frames, they differ in misfits, too.\n']
    for file in ('scaling_swing.png', 'scaling_curtain.png', 'scaling_shape.png'):
        text.append(picture(file, 'time a frame against nodes'))
    body = []
    for row in rows:
        if row['series'] != 'both' and row['method'] != values(rows, 'method')[0]:
            continue
        body.append([row['scene'], f"{row['rows']} x {row['columns']}", row['nodes'], name(row['method']), row['setting'],
                     row['threads'], figure(value(row, 'ms_min')), figure(value(row, 'ms_median')), figure(value(row, 'ms_max')),
                     figure(value(row, 'substeps')), row['frames'], figure(value(row, 'stretch'))])
    memory = {(row['scene'], row['rows'], row['columns']): row['our_bytes_a_node'] for row in rows if row['series'] == 'both'}
    held = [[scene, f'{height} x {width}', figure(float(of), 3)] for (scene, height, width), of in memory.items()]
    return text + [markdown(['scene', 'grid', 'nodes', 'method', 'setting', 'threads', 'ms a frame, least median', 'median',
                             'most', 'substeps', 'frames', 'misfit'], body),
                   'Memory that a simulator holds after its first frame, bytes a node (small grids share pages with what was there):\n',
                   markdown(['scene', 'grid', 'bytes a node'], held)]


def stages():
    rows = table('stages')
    names = values(rows, 'stage')
    body = []
    for scene in values(rows, 'scene'):
        here = where(rows, scene=scene)
        total = sum(value(row, 'ms_per_frame') for row in here)
        body.append([scene, figure(total)] + [f"{100 * value(row, 'share'):.0f} %" for row in here])
    return ['## Time by stage\n', picture('stages.png', 'time by stage'), markdown(['scene', 'ms a frame'] + names, body)]


def contact():
    rows = table('contact')
    lines = ['## What contact costs\n',
             '44 x 40 nodes, one core, scenes with and without it made frame by frame in turns; medians of the frames, least of',
             'the repeats. Itself: `contact.self`.\n',
             '| scene | without | with | added | ratio | longest frame |', '|---|---|---|---|---|---|']
    for row in rows:
        lines.append('| %s | %.3f ms | %.3f ms | %.3f ms | %.2f | %.1f ms |' % (
            row['scene'], float(row['ms_without']), float(row['ms_with']), float(row['ms_added']), float(row['ratio_min']),
            float(row['ms_longest'])))
    return lines + ['']


def contact_frames():
    lines = ['## What frames take in contact\n',
             'Median, 99th percentile and longest frame, each the least of two runs (one run if it takes a minute). Substeps and',
             'sweeps: means of a frame; contacts: most at a frame\'s end. Sizes: frames 30 to 60 of a gathered curtain, blown.\n',
             '| scene | median | 99 % | longest | substeps | sweeps | contacts |', '|---|---|---|---|---|---|---|']
    for row in table('contact_frames'):
        lines.append('| %s | %s ms | %s ms | %s ms | %.1f | %.0f | %s |' % (
            row['scene'].replace(';', ','), figure(value(row, 'ms_median_min')), figure(value(row, 'ms_99_min')),
            figure(value(row, 'ms_longest_min')), float(row['substeps']), float(row['sweeps']), row['contacts']))
    return lines + ['\n']


def contact_peers():
    lines = ['## The same ball in the same curtain\n',
             '44 x 40 nodes, hung over their whole width; a ball of 0.3 m goes 0.4 m into it in a second and stays there for two. A frame of',
             'one core, the largest relative misfit of a link, and nodes that are in the ball at any frame (4 mm are to be kept). It is a run',
             'of its own: *beside other engines* has another one. btSoftBody',
             'takes the distance to the ball from a distance field with cells of 0.02 m, and corrects all of a penetration at once (*kKHR* = 1).\n',
             '| method | setting | median | longest | stretch | nodes inside | deepest |', '|---|---|---|---|---|---|---|']
    for row in table('contact_peers'):
        lines.append('| %s | %s | %s ms | %s ms | %s | %s | %s mm |' % (
            row['method'], row['setting'].replace(';', ','), figure(value(row, 'ms_median')), figure(value(row, 'ms_longest')),
            figure(value(row, 'stretch')), row['nodes_inside'], figure(value(row, 'deepest_mm'))))
    return lines + ['\n']


def ccd():
    body = [[row['set'], row['pair'], row['queries'], row['hits'], row['missed'], row['false_alarms'],
             figure(value(row, 'ns_min')), figure(value(row, 'ns_min_1mm'))] for row in table('ccd')]
    return ['## Continuous collision detection\n',
            'Public queries with exact answers (test/truth/ccd), a sixth of those of cloth and few of the others are impacts; the '
            'handcrafted ones touch and graze on purpose. Least of two runs, one core.\n',
            markdown(['set', 'pair', 'queries', 'impacts', 'missed', 'false alarms', 'ns a query', 'at 1 mm'], body)]


def features():
    rows = table('features')
    body = []
    for feature in values(rows, 'feature'):
        state = {row['state']: row for row in where(rows, feature=feature)}
        off = value(state['off'], 'instructions')

        def cells(name):
            if name not in state:
                return ['–', '–', '–', '–']
            row = state[name]
            count = value(row, 'instructions')
            return [row['what'].replace(';', ','), f'{count:.1f}', f'{count / off:.3f}', figure(value(row, 'ns_min'))]

        body.append([feature, f'{off:.1f}', figure(value(state['off'], 'ns_min'))] + cells('idle') + cells('active'))
    return ['## What features cost\n',
            'Instructions per node and frame (callgrind; they repeat) and ns per node and frame (median of the frames, least of the '
            'repeats), 44 x 40 nodes, one thread. Without the feature; with it but without effect (*in vain*: the motion is the same '
            'to the bit); at work, where the motion differs, and the cost of that difference is included. *Gathered to 60 %* hangs in a '
            'steady fan, where touching itself costs less than in the gusts of *what contact costs*. Where no other scene is named it '
            'is the swing: gravity alone, the cheapest motion there is. test/cost fails where a feature in vain costs more '
            'than its bound (1.02 unless bench/cost/features.cpp says why not).\n',
            markdown(['feature', 'without', 'ns', 'in vain', 'instructions', 'ratio', 'ns', 'at work', 'instructions', 'ratio',
                      'ns'], body)]


def sensing():
    body = [[row['view'].replace(';', ','), row['rays'], row['hits'], figure(value(row, 'ms_hierarchy')), figure(value(row, 'ms_look')),
             figure(value(row, 'ms_points'))] for row in table('sensing')]
    return ['## What a sensor sees\n',
            'Views of the curtain that ships, %s triangles, one core, least of the repeats: the hierarchy of boxes alone; a depth image, '
            'with the hierarchy, rays and noise; the points of it besides.\n' % table('sensing')[0]['triangles'],
            markdown(['view', 'rays', 'points', 'hierarchy [ms]', 'depth image [ms]', 'points [ms]'], body)]


WHERE = {'processor': 'processor', 'cores': 'cores', 'compiler': 'compiler', 'bullet': 'Bullet', 'effort': 'effort', 'repeats': 'repeats'}


def usual(stamps, column):
    """What most stamps have there."""
    return collections.Counter(stamp[column] for stamp in stamps.values()).most_common(1)[0][0]


def head(stamps):
    about = [f'- {title}: {usual(stamps, column)}' for column, title in WHERE.items()]
    return ['# Benchmark\n',
            'Generated by `bench/run` from the tables beside this page; do not edit. Our methods in **bold**, each at its '
            'default and at fixed substeps; the rivals (bench/rivals) in double precision, structure of arrays, compiled '
            'for this processor; Bullet as packaged, its soft body stepped without a world around it. Under *work and '
            'precision* the rivals are swept over their settings; elsewhere they run at a few settings, named in the tables, '
            'that did well there. Same scenes, same stop watch, same error measure; one core unless threads are named. Runs '
            'are repeated in turns for *work and precision*, *scaling* and the *gathered curtain*; elsewhere a setting '
            'is run once, unless its section says otherwise.\n',
            'Unless a section names another:\n',
            '\n'.join(about) + '\n',
            '**The sections are of different engines**: each says of which commit it is. Figures of one are not to be compared with those of '
            'another, nor are they those of the engine beside this page.\n' if differ(stamps) else '',
            'Bullet\'s links also resist shortening, so it takes part only where the weft is never slack; no rival has wind. Springs '
            'are as stiff as the step allows (dt*omega = 2 is the limit of symplectic Euler, 2.8 of Runge-Kutta 4). XPBD '
            'without compliance is PBD of stiffness 1 with the multipliers written down.\n']


def differ(stamps):
    """Studies were made of different sources."""
    return len({stamp['sources'] for study, stamp in stamps.items() if study not in ELSEWHERE}) > 1


def stamp_text(stamp, stamps):
    """When a study was measured and of what, and on what, as far as the head does not say it."""
    where = [f'{title}: {stamp[column]}' for column, title in WHERE.items() if stamp[column] != usual(stamps, column)]
    return f"Measured {stamp['date']} at commit {stamp['commit']}" + ''.join('; ' + text for text in where) + '.\n'


def main():
    sections = {'work_precision': work_precision, 'slopes': slopes, 'energy': energy, 'modes': modes, 'nets': nets, 'wind': wind,
                'hard_spot': hard_spot, 'gusts': gusts, 'scaling': scaling, 'stages': stages, 'contact': contact,
                'contact_frames': contact_frames, 'contact_peers': contact_peers, 'gathered': gathered, 'fabric': fabric,
                'closed_forms': closed_forms, 'engines': lambda: engines(table('engines'), table('stamps')), 'ccd': ccd,
                'features': features, 'sensing': sensing}
    all_stamps = {stamp['study']: stamp for stamp in table('stamps')}
    studies = [study for study in sections if table(study)]
    unknown = [study for study in studies if study not in all_stamps]
    if unknown:
        sys.exit(f"no stamp in {FOLDER}/stamps.csv says of which commit these are: {', '.join(unknown)}; bench/run measures them again")
    stamps = {study: all_stamps[study] for study in studies}
    if differ(stamps) and not (OPTIONS.mixed or OPTIONS.check):
        of = [' '.join([commit + ':'] + [study for study in studies if stamps[study]['commit'] == commit and study not in ELSEWHERE])
              for commit in values([stamps[study] for study in studies if study not in ELSEWHERE], 'commit')]
        sys.exit(f"tables of different sources make no page, but with --mixed ({FOLDER}): {'; '.join(of)}. bench/run measures again what is old")
    text = head(stamps)
    for study in studies:
        section = sections[study]()
        text += [section[0], stamp_text(stamps[study], stamps)] + section[1:]
    page = '\n'.join(part for part in text if part)
    path = os.path.join(FOLDER, 'README.md')
    if not OPTIONS.check:
        with open(path, 'w', encoding='utf-8') as file:
            file.write(page)
        return
    with open(path, encoding='utf-8') as file:
        if file.read() != page:
            sys.exit(f"{path} is not what the tables beside it say: run bench/page.py {FOLDER}{' --mixed' if differ(stamps) else ''}")


main()
