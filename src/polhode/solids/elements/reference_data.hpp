// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <new>
#include <span>
#include <string>
#include <vector>

#include <polhode/core/types.hpp>
#include <polhode/solids/elements/registry.hpp>

namespace polhode::solids {

/// Array of numbers aligned to a cache line.
class AlignedNumbers {
 public:
  explicit AlignedNumbers(std::size_t size)
      : data_(static_cast<double*>(::operator new(size * sizeof(double), kLine))) {
    std::uninitialized_fill_n(data_.get(), size, 0.0);
  }
  [[nodiscard]] double* data() { return data_.get(); }
  [[nodiscard]] const double* data() const { return data_.get(); }

 private:
  static constexpr std::align_val_t kLine{64};
  struct Free {
    void operator()(double* p) const { ::operator delete(p, kLine); }
  };
  std::unique_ptr<double, Free> data_;
};

/// Gradients, weights and positions of the undeformed elements, in blocks of `width`.
struct ReferenceData {
  int elements, blocks;
  std::vector<int> nodes;  ///< Padded to whole blocks with the last element.
  AlignedNumbers X, points, volumes, fibres;
  double volume = 0.0;

  /// @param families  Number of families of fibres.
  /// @param fibres  Direction of each family, the same in all elements or element after element.
  /// @throws InputError if an element is inverted or flat.
  ReferenceData(const std::string& where, const ElementKind& kind, std::span<const int> nodes,
                std::span<const Vec3> X, int families, std::span<const Vec3> fibres, int width);
};

/// ∂X/∂ξ at a reference point, for nodes X of one element.
[[nodiscard]] Mat3 reference_jacobian(const Mat& shape_gradients, std::span<const int> nodes,
                                      std::span<const Vec3> X);

/// Consistent mass of an element by the kind's own rule, n × n, row by row [kg].
void element_mass(const ElementKind& kind, double density, std::span<const int> nodes,
                  std::span<const Vec3> X, double* M);

}  // namespace polhode::solids
