// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <polhode/system/system.hpp>

namespace polhode {

/// The derivative of the combination of the members of an extrapolated step: places, velocities and
/// world angular velocities are sums with the members' weights, rotations a sum of Cayley vectors
/// from that of the last member. @eq{combination-derivative}
class CombinationDerivative {
 public:
  explicit CombinationDerivative(const System& system);

  /// Combines the ends of members. @param before  State at the start of the step.
  void linearize(const State& before, double H, std::span<const State* const> members);
  /// The combination, which is not yet projected onto the constraints.
  [[nodiscard]] const State& combined() const { return combined_; }
  [[nodiscard]] const std::vector<double>& weights() const { return weights_; }

  /// Derivative of the combination from those of the members.
  [[nodiscard]] Vec push(std::span<const Vec> members) const;
  /// Weights of the members from those of the combination.
  [[nodiscard]] std::vector<Vec> pull(const Vec& mu) const;
  /// Combines memories of interactions; turns that are counted now and then are those of the last
  /// member.
  [[nodiscard]] std::vector<double> memory(std::span<const std::vector<double>> members) const;

 private:
  /// Rotations of a body.
  struct Turns {
    std::vector<Mat3> by_member;  ///< Of the sum χ by dφ of a member, with its weight.
    Mat3 by_last;                 ///< Of χ by dφ of the last member, through all others.
    Mat3 by_chi;                  ///< Of dφ by dχ.
    Mat3 carried;                 ///< cay[χ]
    std::vector<Mat3> Lambda;     ///< By member.
    std::vector<Vec3> omega;      ///< Likewise.
    Mat3 Lambda_n1;
    Vec3 omega_n1;
  };
  const System* system_;
  std::vector<char> combines_;  ///< By entry of the memory.
  std::vector<double> weights_;
  std::vector<Turns> turns_;
  State combined_;
};

}  // namespace polhode
