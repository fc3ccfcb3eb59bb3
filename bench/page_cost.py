# SPDX-License-Identifier: BSD-3-Clause
"""Sections of page.py: what frames, parts and views cost."""
from page_tables import name
from page_text import figure, markdown, value, values, where


def scaling(folder):
    rows = folder.table('scaling')
    text = ['## Scaling\n', 'Default settings of ours; a frame is 1/60 s. 60 frames from the start, or as many as 3 s of '
            'computing allow. Misfits are of these frames. Runs with one and with two threads may differ in their number of frames, and then in misfit.\n']
    for file in ('scaling_swing.png', 'scaling_curtain.png', 'scaling_shape.png'):
        text.append(folder.picture(file, 'time a frame against nodes'))
    body = []
    for row in rows:
        if row['series'] != 'both' and row['method'] != values(rows, 'method')[0]:
            continue
        body.append([row['scene'], f"{row['rows']} x {row['columns']}", row['nodes'], name(row['method']), row['setting'],
                     row['threads'], figure(value(row, 'ms_min')), figure(value(row, 'ms_median')), figure(value(row, 'ms_max')),
                     figure(value(row, 'substeps')), row['frames'], figure(value(row, 'stretch'))])
    memory = {(row['scene'], row['rows'], row['columns']): row['our_bytes_a_node'] for row in rows if row['series'] == 'both'}
    held = [[scene, f'{height} x {width}', figure(float(each), 3)] for (scene, height, width), each in memory.items()]
    return text + [markdown(['scene', 'grid', 'nodes', 'method', 'setting', 'threads', 'frame [ms]: lowest median of the runs',
                             'median of the runs', 'longest frame of the last run', 'substeps a frame', 'frames', 'misfit'], body),
                   'Memory that a simulator holds after its first frame, bytes a node (small grids share pages with what was there):\n',
                   markdown(['scene', 'grid', 'bytes a node'], held)]


def stages(folder):
    rows = folder.table('stages')
    names = values(rows, 'stage')
    body = []
    for scene in values(rows, 'scene'):
        here = where(rows, scene=scene)
        total = sum(value(row, 'ms_per_frame') for row in here)
        body.append([scene, figure(total)] + [f"{100 * value(row, 'share'):.0f} %" for row in here])
    return ['## Time by stage\n', folder.picture('stages.png', 'time by stage'), 'Means of 300 frames:\n', markdown(['scene', 'frame [ms]'] + names, body)]


def features(folder):
    rows = folder.table('features')
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
            'Instructions (counted by callgrind, so they are the same in every run) and ns, per node and frame; 44 x 40 nodes, one thread; times are '
            'the lowest of the repeats\' medians. Three cases: without the feature; *idle*: with it but without effect, so the motion is the same '
            'to the bit; *active*: the motion differs, and the cost of that difference is included. *Gathered to 60 %* hangs in a '
            'steady fan, where touching itself costs less than in the gusts of *what contact costs*. Where no other scene is named it '
            'is the swing: gravity alone, the cheapest motion there is. test/cost fails where an idle feature costs more than its bound: 1.02, or '
            'more where bench/cost/features.cpp says why (a robot that moves past: 1.11; self-contact of flat cloth: 1.16).\n',
            markdown(['feature', 'without: instructions', 'ns', 'idle case', 'instructions', 'ratio', 'ns', 'active case', 'instructions', 'ratio',
                      'ns'], body)]


def sensing(folder):
    body = [[row['view'].replace(';', ','), row['rays'], row['hits'], figure(value(row, 'ms_hierarchy')), figure(value(row, 'ms_look')),
             figure(value(row, 'ms_points'))] for row in folder.table('sensing')]
    return ['## Cost of a sensor view\n',
            'Views of the curtain that ships, %s triangles, one core, least of the repeats: the hierarchy of boxes alone; a depth image, '
            'with the hierarchy, rays and noise; the points of it besides.\n' % folder.table('sensing')[0]['triangles'],
            markdown(['view', 'rays', 'points', 'hierarchy [ms]', 'depth image [ms]', 'points [ms]'], body)]
