# SPDX-License-Identifier: BSD-3-Clause
"""The parts of scripts/sweep: what to run (design, scenes), where it is kept (folder), who runs it (machines), what comes of it
(results, trajectories, summary)."""
