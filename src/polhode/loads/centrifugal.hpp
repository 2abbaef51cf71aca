// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>

#include <polhode/dynamics/turning_frame.hpp>
#include <polhode/system/interaction.hpp>
#include <polhode/system/system.hpp>

namespace polhode {

/// Base of the forces of a turning frame on masses at rest in it, in statics times the load factor.
/// They are no loads of the user's: their potential is not in any energy.
class OfTurningFrame : public InteractionItem {
 public:
  [[nodiscard]] bool conservative() const { return true; }
  [[nodiscard]] Work work(const PairStep& /*step*/) const { return {}; }

 protected:
  OfTurningFrame(std::string of, Participants pair, double mass, const TurningFrame& frame);

  TurningFrame frame_;
  double mass_;
};

/// Centrifugal force and moment on a body. @eq{spin-body}
class CentrifugalForce : public OfTurningFrame {
 public:
  static constexpr const char* kKind = "centrifugal force";
  /// @param data  Of the body: its name, mass and inertia. @param body  Its index in the system.
  CentrifugalForce(const BodyData& data, int body, const TurningFrame& frame);

  void evaluate(const PairStep& step, PairTerms& terms) const;

 private:
  Mat3 inertia_;
};

/// Centrifugal force of the mass that couples two bodies, in addition to those of the row sums.
/// @eq{spin-matrices} @eq{mass-coupling}
class CentrifugalCoupling : public OfTurningFrame {
 public:
  static constexpr const char* kKind = "centrifugal coupling";
  CentrifugalCoupling(std::string of, Participants pair, double mass, const TurningFrame& frame)
      : OfTurningFrame(std::move(of), pair, mass, frame) {}

  void evaluate(const PairStep& step, PairTerms& terms) const;
};

}  // namespace polhode
