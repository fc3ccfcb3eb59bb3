# SPDX-License-Identifier: BSD-3-Clause
"""Sections of page.py: what fabric and its contact are compared with, fine steps, a shell, closed forms."""
import math

from page_tables import name
from page_text import figure, markdown, value, values, where


def gathered(folder):
    rows = folder.table('gathered')
    looks = [column for column in rows[0] if column.startswith('apart_')]
    text = ['## A gathered curtain that touches itself\n',
            '44 x 40 nodes, 2 m x 1 m, hung on 0.5 m, in a gusty fan: once limp, once with the weight, shear and bending of a light cotton. Means '
            'are over 15 s, from the third second on; ± is their standard error, from means of one second each.\n',
            '- apart: RMS distance of the nodes from those of the finest run (first row), after the time in the header. It grows quickly because the '
            'motion is chaotic.',
            '- drag: force of the air along the fan\'s axis. depth: RMS distance of the nodes from the mean of their row. motion: kinetic energy. '
            'fine: the part of it in waves across the cloth that are shorter than eight links.',
            '- off: largest difference of the four means from the finest run, in standard errors; about 2 can be chance.\n']
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


def fabric(folder):
    rows, samples = folder.table('fabric'), folder.table('fabric_drape')
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


def hard_spot(folder):
    rows, motion = folder.table('hard_spot'), folder.table('hard_spot_motion')

    def early(row):
        track = where(motion, sheet=row['sheet'], method=row['method'], setting=row['setting'], t_s='0.1')
        return figure(value(track[0], 'error_m')) if track else '–'

    text = ['## The hard spot: a two-corner sheet dropped flat\n',
            'A sheet hung by two corners at 0.9 of its width. The error is the distance from our finest run (leapfrog, 256 substeps), at 0.1 s and at '
            'the last frame before the first snap. At the snap this reference favours our methods: strings that become taut before it cause small '
            'impacts, which springs give back and rods do not. After the snap, methods that agree at 0.1 s diverge, whatever their step. Misfit: '
            'largest of any link at any frame\'s end. Energy rise: above the start, at any frame.\n']
    for sheet in values(rows, 'sheet'):
        here = where(rows, sheet=sheet)
        snap = value(here[0], 't_snap_s')
        text += [f'### {sheet}, first snap after {figure(snap)} s\n', folder.picture(f'hard_spot_{sheet}.png', f'sheet {sheet}')]
        text.append(markdown(
            ['method', 'setting', 'frame, median [ms]', 'frame, longest [ms]', 'substeps a frame', 'misfit', 'error at 0.1 s [m]', 'error at the snap [m]', 'energy rise [J]', 'frames'],
            [[name(row['method']), row['setting'], figure(value(row, 'ms_median')), figure(value(row, 'ms_max')),
              figure(value(row, 'substeps')), figure(value(row, 'stretch')), early(row), figure(value(row, 'error_at_snap_m')),
              figure(value(row, 'energy_rise_J')), row['frames']] for row in here]))
    return text + [folder.picture('hard_spot_motion.png', 'the way apart')]


def closed_forms(folder):
    rows = folder.table('closed_forms')
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
            'Computing time of a frame (median, [ms]) of the fastest setting with an error below each bound; one core, 60 frames a second. Errors are '
            'relative; for the belt: how far the cloth creeps in 3 s [m], while the belt moves 20 m.\n',
            '- scarf: slides off a bar without friction, links of 15 mm; Atwood: a strap over such a bar with 75 and 50 g at its ends. The exact '
            'motion of both is a cosh. Links on the bar are chords of it, which alone may cost 2 %.',
            '- slope: a sheet slides down 30 degrees with friction 0.3 for half a second.',
            '- belt: a sheet on a belt that speeds up with 0.45 g, friction 0.5.',
            '- capstan: the largest load that a strap over a bar of friction 0.3 holds with 50 g at its other end, relative to Euler\'s e^(mu pi) with '
            'the strap\'s own weight. It is searched between 0.5 and 1.5, to a thousandth; an error of 0.5 means that nothing was held.\n',
            'PBD and XPBD push nodes out of what is solid in each iteration, with the friction of Macklin, Mueller, Chentanez, Kim (2014, '
            f'Eq. (24)). Settings tried of each: {tried}.\n',
            markdown(['problem', 'method'] + [f'{bound:g}' for bound in bounds] + ['smallest error'], body)]
