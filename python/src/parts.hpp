// SPDX-License-Identifier: Apache-2.0
// Parts of the extension polhode._native, each in a file of its own.
#pragma once

#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <polhode/core/types.hpp>

namespace polhode::python {

namespace nb = nanobind;

void bind_errors(nb::module_& m);
void bind_model(nb::module_& m);
void bind_held_loads(nb::module_& m);
void bind_recording(nb::module_& m);
void bind_engine(nb::module_& m);
void bind_results_reader(nb::module_& m);
void bind_rotations(nb::module_& m);
void bind_modes(nb::module_& m);
void bind_equations(nb::module_& m);
void bind_gradient(nb::module_& m);
void bind_workers(nb::module_& m);
void bind_batch(nb::module_& m);

using Array = nb::ndarray<nb::numpy, double>;
using Integers = nb::ndarray<nb::numpy, std::int64_t>;

/// An array that owns the numbers of a vector, without a copy.
template <class T>
nb::ndarray<nb::numpy, T> array_of(std::vector<T> numbers, const std::vector<std::size_t>& shape) {
  auto* kept = new std::vector<T>(std::move(numbers));
  nb::capsule owner(kept, [](void* p) noexcept { delete static_cast<std::vector<T>*>(p); });
  return {kept->data(), shape.size(), shape.data(), owner};
}

inline Array array_of(const Vec3& v) {
  return array_of(std::vector<double>{v[0], v[1], v[2]}, {3});
}

}  // namespace polhode::python
