# SPDX-License-Identifier: BSD-3-Clause
"""The section of bench/page.py on other engines, and how near they come."""
import math

from page_text import figure, markdown, value, values, where


BOUNDS = (0.1, 0.01, 0.001)


def picked(rows):
    """Of one engine's rows in a scene those that the page quotes: our default, and the fastest within each bound, with and without crossings."""
    chosen = [row for row in rows if row['engine'] == 'curtain_sim' and row['setting'].startswith('default')]
    for bound in BOUNDS:
        good = [row for row in rows if value(row, 'stretch_max') <= bound]
        for some in (good, [row for row in good if row['crossings_end'] == '0'], [row for row in good if row['nodes_inside'] == '0']):
            chosen += sorted(some, key=lambda row: value(row, 'ms_median'))[:1]
    return chosen


def engines(folder):
    """Of each engine's settings, from the fastest on, those that halve the overlength, and those that are quoted."""
    rows, stamps = folder.table('engines'), folder.table('stamps')
    body = []
    for scene in values(rows, 'scene'):
        for engine, alone in ((engine, alone) for engine in values(rows, 'engine') for alone in (False, True)):
            least = math.inf
            of_it = [row for row in where(rows, scene=scene, engine=engine) if ('without self-contact' in row['setting']) == alone]
            chosen = picked(of_it)
            for row in sorted(of_it, key=lambda row: value(row, 'ms_median')):
                halves = value(row, 'stretch_max') <= 0.5 * least
                if halves:
                    least = value(row, 'stretch_max')
                if halves or row in chosen:
                    body.append([scene, '**curtain_sim**' if engine == 'curtain_sim' else engine, row['setting'].replace(';', ','),
                                 '%s (%s) ms' % (figure(value(row, 'ms_median')), figure(value(row, 'ms_99'))), figure(value(row, 'stretch_max')),
                                 figure(value(row, 'stretch_rms')), '%s, %s mm' % (row['nodes_inside'], figure(value(row, 'deepest_mm'))),
                                 row['crossings_end']])
    stamp = where(stamps, study='engines')[0]
    return ['## Beside other engines\n',
            'The same cloth, wind and ball in NvCloth 1.1.6 (6e86b18), Jolt 5.5.1 (3b47ec3) and Bullet 3.27 (6c888f4). '
            '[bench/engines](../../bench/engines/README.md) builds them from their public sources for this processor '
            f'({stamp["compiler"]}; -O3 -march=native, which this package itself is not built with). Ours is commit {rows[0]["version"]}, with one '
            f'thread and scene files that set only what is named. All ran in turns on one core of an {stamp["processor"]}.\n',
            f'- frame: lowest median of {stamp["repeats"]} {"pass" if stamp["repeats"] == "1" else "passes"} ({spread(rows)}), 99th percentile in brackets.',
            '- misfit, RMS: largest and root mean square misfit of a link (of a weft: its overlength).',
            '- in the ball: nodes nearer to its centre than its radius at any frame\'s end, and how deep.',
            '- crossings: edges that cross triangles at the end, by brute force.\n',
            'For each engine, with and without self-contact, the table shows the fastest setting, each slower one that at least halves the misfit, '
            'our defaults, and the fastest within 0.1, 0.01 and 0.001, also among those without crossings. [engines.csv](engines.csv) has all.\n',
            'How near they come: two ratios to our default in the same scene, with or without self-contact like theirs. First, the smallest misfit of their '
            'settings that are as fast as ours, over our misfit. Second, the shortest time of their settings with at most ten times our misfit, over our time. '
            '*None*: no setting that was tried is such. At the finest settings the misfit varies by chance: a factor of two between two of them means nothing.\n',
            markdown(['scene', 'self-contact', 'engine', 'misfit over ours, as fast', 'time over ours, within ten times the misfit'],
                     nearest(rows)),
            '\nWind and the nonlinear part of air damping are computed outside of their timing and passed to them as accelerations of a frame. Their links also resist shortening; '
            'our wefts may fold, so our cloth starts flat and theirs in five waves. NvCloth: the frequency of its solver and its stiffness, tethers, phases from the top '
            'down or even and odd, self-collision of particles, which are 26 and 47 mm apart (10 and 19 in the finer cloth). A particle can pass between four others, 27 mm from each, if the distance of self-collision is less than that. At larger distances (30 and 40 mm, 12 and 16 in the finer cloth) NvCloth is given the rest positions, so that neighbours do not push each other. '
            'Jolt: soft bodies do not collide with themselves; LRA: long range attachments. Bullet: self-collision by clusters (*self clusters 0*: one per '
            'triangle); its distance field of the ball has cells of 20 mm, or of 250 mm, the default.\n',
            markdown(['scene', 'engine', 'setting', 'frame', 'misfit', 'RMS', 'in the ball', 'crossings'], body)]


def spread(rows):
    """By how much the medians of a setting's passes differ."""
    ratios = sorted(value(row, 'ms_median_most') / value(row, 'ms_median') for row in rows)
    return 'the greatest is %.0f %% larger at most, in nine of ten settings %.0f %%' % (
        100.0 * (ratios[-1] - 1.0), 100.0 * (ratios[9 * len(ratios) // 10] - 1.0))


def nearest(rows):
    """Of each scene, with and without self-contact, how near the other engines come to our default."""
    body = []
    for scene in values(rows, 'scene'):
        # What does not touch itself is compared with what does not, and Jolt's never does; the ball alone has one way.
        of_scene = where(rows, scene=scene)
        ways = [False, True] if any('without self-contact' in row['setting'] for row in of_scene) else [False]
        for way in ways:
            fits = [row for row in of_scene
                    if len(ways) == 1 or ('without self-contact' in row['setting'] or row['engine'] == 'Jolt') == way]
            ours = next(row for row in fits if row['engine'] == 'curtain_sim' and row['setting'] in ('default', 'default; without self-contact; five waves'))
            ms, misfit = value(ours, 'ms_median'), value(ours, 'stretch_max')
            for engine in values(fits, 'engine'):
                if engine == 'curtain_sim':
                    continue
                of_it = where(fits, engine=engine)
                quick = [value(row, 'stretch_max') / misfit for row in of_it if value(row, 'ms_median') <= ms]
                true = [value(row, 'ms_median') / ms for row in of_it if value(row, 'stretch_max') <= 10.0 * misfit]
                body.append([scene, '–' if len(ways) == 1 else 'no' if way else 'yes', engine, figure(min(quick)) if quick else 'none',
                             figure(min(true)) if true else 'none'])
    return body
