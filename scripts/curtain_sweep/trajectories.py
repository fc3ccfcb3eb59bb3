# SPDX-License-Identifier: BSD-3-Clause
"""--hdf5 FILE: the trajectories of all runs.

    /                  attributes: scene, sweep (both as JSON)
    /N                 a group for every run; attributes: the parameters, exit_code, error
    /N/t               [s], shape [samples]
    /N/positions       [m], shape [samples, rows, columns, 3], first-layer nodes
    /N/velocities      [m/s], the same shape
"""
import json

from curtain_sweep.folder import replace
from curtain_sweep.problem import Unfinished
from curtain_sweep.results import cell, trajectory


def write_trajectories(path, folder, results, design, scene):
    """Writes the file completely or not at all. It is made in memory: HDF5 does not survive a disk that is full."""
    try:
        replace(path, image(path, folder, results, design, scene))
    except (RuntimeError, MemoryError) as error:
        raise Unfinished("%s: cannot be made: %s" % (path, str(error) or "not enough memory")) from error


def image(path, folder, results, design, scene):
    """The bytes of the file."""
    import h5py  # asked for before anything was started
    import numpy

    with h5py.File(path, "w", driver="core", backing_store=False) as file:
        file.attrs["scene"] = json.dumps(scene)
        file.attrs["sweep"] = json.dumps(design.given)
        for result in results:
            group = file.create_group(result.name)
            for parameter, value in zip(design.parameters, result.values):
                group.attrs[parameter.name] = value if isinstance(value, (bool, int, float, str)) else cell(value)
            group.attrs["exit_code"] = result.exit_code
            group.attrs["error"] = result.error
            states = trajectory(folder, result)
            if not states:
                continue
            rows = numpy.loadtxt(states, delimiter=",", skiprows=1, ndmin=2)
            shape = (-1, int(rows[-1, 1]) + 1, int(rows[-1, 2]) + 1, 3)
            group["t"] = rows[::shape[1] * shape[2], 0]
            group["positions"] = rows[:, 3:6].reshape(shape)
            group["velocities"] = rows[:, 6:9].reshape(shape)
        file.flush()
        return file.id.get_file_image()
