# SPDX-License-Identifier: Apache-2.0
"""Rotations, vectorised: each function accepts one rotation or N of them.

Rotation vectors (3,) or (N, 3) [rad], Cayley vectors χ = 2 tan(angle/2) n (3,) or (N, 3) [-],
quaternions (w, x, y, z) (4,) or (N, 4), matrices (3, 3) or (N, 3, 3). All transform body components to
world components. Returned quaternions have w ≥ 0, returned rotation vectors angles in [0, π].
"""

from __future__ import annotations

from typing import Any, Callable

import numpy as np

from . import _native

__all__ = ["cayley_from_matrix", "matrix_from_cayley", "matrix_from_quaternion", "matrix_from_rotation_vector",
           "quaternion_from_matrix", "quaternion_from_rotation_vector", "rotation_vector_from_matrix",
           "rotation_vector_from_quaternion"]


def _many(function: "Callable[[Any], Any]", values: Any, shape: "tuple[int, ...]") -> Any:
    array = np.ascontiguousarray(values, dtype=float)
    if array.shape[-len(shape) :] != shape or array.ndim > len(shape) + 1:
        rows = f"(N, {', '.join(map(str, shape))})"
        raise ValueError(f"the array must have the shape {shape} or {rows}, but has {array.shape}")
    if array.ndim == len(shape):
        return function(array[np.newaxis])[0]
    return function(array)


def matrix_from_rotation_vector(v: Any) -> Any:
    """Exponential map."""
    return _many(_native.matrix_from_rotation_vector, v, (3,))


def rotation_vector_from_matrix(R: Any) -> Any:
    """Inverse of matrix_from_rotation_vector()."""
    return _many(_native.rotation_vector_from_matrix, R, (3, 3))


def matrix_from_cayley(chi: Any) -> Any:
    """Cayley transform."""
    return _many(_native.matrix_from_cayley, chi, (3,))


def cayley_from_matrix(R: Any) -> Any:
    """Inverse of matrix_from_cayley(); NaN for a rotation by π, which has no Cayley vector."""
    return _many(_native.cayley_from_matrix, R, (3, 3))


def quaternion_from_rotation_vector(v: Any) -> Any:
    """Unit quaternions."""
    return _many(_native.quaternion_from_rotation_vector, v, (3,))


def rotation_vector_from_quaternion(q: Any) -> Any:
    """Inverse of quaternion_from_rotation_vector(); q may have any non-zero length."""
    return _many(_native.rotation_vector_from_quaternion, q, (4,))


def matrix_from_quaternion(q: Any) -> Any:
    """Rotation matrices; q may have any non-zero length."""
    return _many(_native.matrix_from_quaternion, q, (4,))


def quaternion_from_matrix(R: Any) -> Any:
    """Inverse of matrix_from_quaternion()."""
    return _many(_native.quaternion_from_matrix, R, (3, 3))
