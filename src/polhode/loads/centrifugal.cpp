// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include <polhode/loads/centrifugal.hpp>
#include <polhode/math/hat.hpp>

namespace polhode {

OfTurningFrame::OfTurningFrame(std::string of, Participants pair, double mass,
                               const TurningFrame& frame)
    : frame_(frame), mass_(mass) {
  name = std::move(of);
  bodies = pair;
}

CentrifugalForce::CentrifugalForce(const BodyData& data, int body, const TurningFrame& frame)
    : OfTurningFrame(data.name, {kGround, body}, data.mass, frame),
      inertia_(data.point_mass ? Mat3::Zero() : data.inertia) {}

/// @eq{spin-body}
void CentrifugalForce::evaluate(const PairStep& step, PairTerms& t) const {
  const double factor = step.context.load_factor;
  const Vec3 omega = frame_.omega();
  const double square = factor * omega.squaredNorm();
  const Mat3 J = step.b.Lambda_n1 * inertia_ * step.b.Lambda_n1.transpose();
  const Vec3 L = J * omega;
  t.wrench_b << square * mass_ * frame_.arm(step.b.r_n1), -factor * omega.cross(L);
  if (!step.context.tangents) return;
  t.D_bb.topLeftCorner<3, 3>() = square * mass_ * frame_.across();
  t.D_bb.bottomRightCorner<3, 3>() = factor * hat(omega) * (hat(L) - J * hat(omega));
}

void CentrifugalCoupling::evaluate(const PairStep& step, PairTerms& t) const {
  const double factor = step.context.load_factor * frame_.speed * frame_.speed * mass_;
  const auto arm = [&](const BodyStep& body) -> Vec3 {
    return body.moves ? frame_.arm(body.r_n1) : Vec3::Zero();
  };
  const Vec3 f = factor * (arm(step.b) - arm(step.a));
  t.wrench_a.head<3>() = f;
  t.wrench_b.head<3>() = -f;
  if (step.context.tangents) {
    const Mat3 D = factor * frame_.across();
    t.D_aa.topLeftCorner<3, 3>() = t.D_bb.topLeftCorner<3, 3>() = -D;
    t.D_ab.topLeftCorner<3, 3>() = t.D_ba.topLeftCorner<3, 3>() = D;
  }
  clear_ground_sides(step, t);
}

}  // namespace polhode
