# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Functions of arrays with the same bits on every machine; those of NumPy, SciPy and BLAS depend on the processor."""

import numpy as np

from glidar import _core


def _function(name):
    def of_each(x):
        x = np.asarray(x, np.float64)
        return _core.portable(name, np.ravel(x)).reshape(x.shape)

    return of_each


sin, cos, arcsin, cbrt, exp, log, ndtr, ndtri = (
    _function(name) for name in ("sin", "cos", "arcsin", "cbrt", "exp", "log", "ndtr", "ndtri"))


def length(vector):
    """The Euclidean norm of one vector; numpy.linalg.norm() calls BLAS."""
    vector = np.asarray(vector, np.float64)
    return np.sqrt((vector * vector).sum())
