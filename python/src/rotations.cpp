// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <polhode/core/error.hpp>
#include <polhode/math/cayley.hpp>
#include <polhode/math/exp_map.hpp>
#include <polhode/math/quaternion.hpp>

#include "parts.hpp"

namespace polhode::python {

namespace {

template <std::size_t... kDims>
using Rows = nb::ndarray<const double, nb::shape<-1, kDims...>, nb::c_contig, nb::device::cpu>;
using Matrix = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

Quat quaternion(const double* q) { return {q[0], q[1], q[2], q[3]}; }
void put(double* out, const Mat3& R) { Eigen::Map<Matrix>{out} = R; }
void put(double* out, const Vec3& v) { Eigen::Map<Vec3>{out} = v; }
void put(double* out, const Quat& q) {
  const Quat s = shown(q);
  out[0] = s.w(), out[1] = s.x(), out[2] = s.y(), out[3] = s.z();
}

/// Applies a function to each of N rows of `in` numbers; results of `shape` are contiguous.
template <class F>
Array each(const double* data, std::size_t rows, std::size_t in, std::vector<std::size_t> shape,
           F&& f) {
  std::size_t out = 1;
  for (const std::size_t n : shape) out *= n;
  std::vector<double> result(rows * out);
  {
    const nb::gil_scoped_release unlocked;
    for (std::size_t i = 0; i < rows; ++i) put(result.data() + i * out, f(data + i * in));
  }
  shape.insert(shape.begin(), rows);
  return array_of(std::move(result), shape);
}

}  // namespace

void bind_rotations(nb::module_& m) {
  m.def("matrix_from_rotation_vector", [](Rows<3> v) {
    return each(v.data(), v.shape(0), 3, {3, 3},
                [](const double* x) { return exp_map(Vec3(x[0], x[1], x[2])); });
  });
  m.def("rotation_vector_from_matrix", [](Rows<3, 3> R) {
    return each(R.data(), R.shape(0), 9, {3},
                [](const double* x) { return log_map(Mat3(Eigen::Map<const Matrix>(x))); });
  });
  m.def("matrix_from_cayley", [](Rows<3> v) {
    return each(v.data(), v.shape(0), 3, {3, 3},
                [](const double* x) { return Mat3(cay(Vec3(x[0], x[1], x[2]))); });
  });
  m.def("cayley_from_matrix", [](Rows<3, 3> R) {
    return each(R.data(), R.shape(0), 9, {3}, [](const double* x) {
      return try_cayley_vector(Mat3(Eigen::Map<const Matrix>(x)))
          .value_or(Vec3::Constant(std::nan("")));
    });
  });
  m.def("quaternion_from_rotation_vector", [](Rows<3> v) {
    return each(v.data(), v.shape(0), 3, {4}, [](const double* x) {
      return quaternion_from_rotation_vector(Vec3(x[0], x[1], x[2]));
    });
  });
  m.def("rotation_vector_from_quaternion", [](Rows<4> q) {
    return each(q.data(), q.shape(0), 4, {3},
                [](const double* x) { return rotation_vector(quaternion(x).normalized()); });
  });
  m.def("matrix_from_quaternion", [](Rows<4> q) {
    return each(q.data(), q.shape(0), 4, {3, 3},
                [](const double* x) { return quaternion(x).normalized().toRotationMatrix(); });
  });
  m.def("quaternion_from_matrix", [](Rows<3, 3> R) {
    return each(R.data(), R.shape(0), 9, {4},
                [](const double* x) { return Quat(Mat3(Eigen::Map<const Matrix>(x))); });
  });
}

}  // namespace polhode::python
