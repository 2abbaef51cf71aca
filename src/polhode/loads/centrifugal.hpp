// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <polhode/dynamics/turning_frame.hpp>
#include <polhode/system/interaction.hpp>
#include <polhode/system/system.hpp>

namespace polhode {

/// Centrifugal force and moment on a body at rest in a turning frame, in statics times the load
/// factor. It is no load of the user's: its potential is not in any energy. @eq{spin-body}
class CentrifugalForce : public InteractionItem {
 public:
  static constexpr const char* kKind = "centrifugal force";
  /// @param data  Of the body: its name, mass and inertia. @param body  Its index in the system.
  CentrifugalForce(const BodyData& data, int body, const TurningFrame& frame);

  [[nodiscard]] bool conservative() const { return true; }
  [[nodiscard]] Work work(const PairStep& /*step*/) const { return {}; }
  void evaluate(const PairStep& step, PairTerms& terms) const;

 private:
  TurningFrame frame_;
  double mass_;
  Mat3 inertia_;
};

/// Centrifugal force of the mass that couples two bodies, in addition to those of the row sums.
/// @eq{spin-matrices} @eq{mass-coupling}
class CentrifugalCoupling : public InteractionItem {
 public:
  static constexpr const char* kKind = "centrifugal coupling";
  CentrifugalCoupling(std::string of, Participants pair, double mass, const TurningFrame& frame);

  [[nodiscard]] bool conservative() const { return true; }
  [[nodiscard]] Work work(const PairStep& /*step*/) const { return {}; }
  void evaluate(const PairStep& step, PairTerms& terms) const;

 private:
  TurningFrame frame_;
  double mass_;
};

}  // namespace polhode
