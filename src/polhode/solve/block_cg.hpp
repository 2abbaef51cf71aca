// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <polhode/assembly/contact_springs.hpp>

namespace polhode {

/// Conjugate gradients for bodies that only springs between points couple: a symmetric positive
/// matrix of one 6×6 block a body and one spring a contact, never assembled. The inverse blocks,
/// springs included, precondition it.
class BlockCg {
 public:
  /// @param blocks  By body, the symmetric part counts. @returns false if one is not positive.
  [[nodiscard]] bool set(std::span<const Mat6> blocks, std::span<const ContactSpring> springs);
  /// x from zero until r·P⁻¹r is below `part` of what it was. @returns iterations done.
  int solve(std::span<const Vec6> rhs, std::vector<Vec6>& x, double part, int most);

 private:
  void multiply(const std::vector<Vec6>& p, std::vector<Vec6>& y) const;

  std::vector<Mat6> own_, inverse_;
  std::span<const ContactSpring> springs_;
  std::vector<Vec6> r_, z_, p_, y_;
};

}  // namespace polhode
