# SPDX-License-Identifier: Apache-2.0
"""Rotations against SciPy's."""

import numpy as np
import numpy.typing as npt
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from polhode import rotations as so3

Array = npt.NDArray[np.float64]

_vectors: "st.SearchStrategy[Array]" = st.lists(st.tuples(*[st.floats(-1.8, 1.8)] * 3), min_size=1,
                                                max_size=20).map(np.array)


@settings(deadline=None)
@given(_vectors)
def test_all_forms_agree_with_scipy(v: Array) -> None:
    expected = Rotation.from_rotvec(v)
    R = so3.matrix_from_rotation_vector(v)
    q = so3.quaternion_from_rotation_vector(v)
    assert R == pytest.approx(expected.as_matrix(), abs=1e-14)
    clear = q[:, 0] > 1e-12  # at half a turn both signs are right
    assert q[clear] == pytest.approx(expected.as_quat(canonical=True)[clear][:, [3, 0, 1, 2]], abs=1e-14)
    assert so3.matrix_from_quaternion(q) == pytest.approx(R, abs=1e-14)
    near = np.linalg.norm(v, axis=1) < 3.1
    assert so3.rotation_vector_from_quaternion(q)[near] == pytest.approx(v[near], abs=1e-12)
    assert so3.rotation_vector_from_matrix(R)[near] == pytest.approx(v[near], abs=1e-7)
    assert so3.matrix_from_quaternion(so3.quaternion_from_matrix(R)) == pytest.approx(R, abs=1e-14)


@settings(deadline=None)
@given(_vectors)
def test_the_cayley_transform_turns_by_twice_the_arctangent_of_half_the_length(chi: Array) -> None:
    length = np.linalg.norm(chi, axis=1, keepdims=True)
    turn = np.where(length > 0, 2 * np.arctan(length / 2) / np.where(length > 0, length, 1), 1) * chi
    R = so3.matrix_from_cayley(chi)
    assert R == pytest.approx(Rotation.from_rotvec(turn).as_matrix(), abs=1e-14)
    assert so3.cayley_from_matrix(R) == pytest.approx(chi, abs=1e-12)


def test_one_rotation_comes_back_as_one() -> None:
    assert so3.matrix_from_rotation_vector([0, 0, np.pi / 2]).shape == (3, 3)
    assert so3.quaternion_from_matrix(np.eye(3)) == pytest.approx([1, 0, 0, 0])
    assert np.isnan(so3.cayley_from_matrix(np.diag([1.0, -1, -1]))).all()
    with pytest.raises(ValueError, match="shape"):
        so3.matrix_from_quaternion([1, 2, 3])
