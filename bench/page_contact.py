# SPDX-License-Identifier: BSD-3-Clause
"""Sections of page.py: what contact costs."""
from page_text import figure, markdown, value


def contact(folder):
    rows = folder.table('contact')
    lines = ['## What contact costs\n',
             '44 x 40 nodes, one core. The scene with contact and the same scene without it are computed frame by frame in turns; figures are the',
             'lowest of the repeats\' medians. *(itself)*: with `contact.self`.\n',
             '| scene | without | with | added | ratio | longest frame |', '|---|---|---|---|---|---|']
    for row in rows:
        lines.append('| %s | %.3f ms | %.3f ms | %.3f ms | %.2f | %.1f ms |' % (
            row['scene'], float(row['ms_without']), float(row['ms_with']), float(row['ms_added']), float(row['ratio_min']),
            float(row['ms_longest'])))
    return lines + ['\n']


def contact_frames(folder):
    lines = ['## What frames take in contact\n',
             'Median, 99th percentile and longest frame, each the lower of two runs (one run if it takes a minute). Substeps and sweeps:',
             'means per frame. Contacts: maximum at a frame\'s end. Rows with *size*: frames 30 to 60 of a gathered curtain, blown.\n',
             '| scene | median | 99 % | longest | substeps | sweeps | contacts |', '|---|---|---|---|---|---|---|']
    for row in folder.table('contact_frames'):
        lines.append('| %s | %s ms | %s ms | %s ms | %.1f | %.0f | %s |' % (
            row['scene'].replace(';', ','), figure(value(row, 'ms_median_min')), figure(value(row, 'ms_99_min')),
            figure(value(row, 'ms_longest_min')), float(row['substeps']), float(row['sweeps']), row['contacts']))
    return lines + ['\n']


def contact_peers(folder):
    lines = ['## The same ball in the same curtain\n',
             '44 x 40 nodes, hung over their whole width; a ball of 0.3 m goes 0.4 m into it in a second and stays there for two. A frame of',
             'one core, the largest relative misfit of a link, and nodes that are in the ball at any frame (4 mm are to be kept). It is a run',
             'of its own: *beside other engines* has another one. btSoftBody',
             'takes the distance to the ball from a distance field with cells of 0.02 m, and corrects all of a penetration at once (*kKHR* = 1).\n',
             '| method | setting | median | longest | largest misfit | nodes inside | deepest |', '|---|---|---|---|---|---|---|']
    for row in folder.table('contact_peers'):
        lines.append('| %s | %s | %s ms | %s ms | %s | %s | %s mm |' % (
            row['method'], row['setting'].replace(';', ','), figure(value(row, 'ms_median')), figure(value(row, 'ms_longest')),
            figure(value(row, 'stretch')), row['nodes_inside'], figure(value(row, 'deepest_mm'))))
    return lines + ['\n']


def ccd(folder):
    body = [[row['set'], row['pair'], row['queries'], row['hits'], row['missed'], row['false_alarms'],
             figure(value(row, 'ns_min')), figure(value(row, 'ns_min_1mm'))] for row in folder.table('ccd')]
    return ['## Continuous collision detection\n',
            'Public queries with exact answers (test/truth/ccd). A sixth of those of cloth are impacts, and few of the handcrafted ones, which touch and '
            'graze on purpose. Times are the lower of two runs, on one core.\n',
            markdown(['set', 'pair', 'queries', 'impacts', 'missed', 'false alarms', 'ns a query', 'ns a query with 1 mm of minimum distance'], body)]
