// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <polhode/dynamics/extrapolation.hpp>
#include <polhode/gradient/combination_derivative.hpp>
#include <polhode/gradient/step_derivative.hpp>
#include <polhode/math/cayley.hpp>
#include <polhode/math/quaternion.hpp>

namespace polhode {

CombinationDerivative::CombinationDerivative(const System& system)
    : system_(&system), combines_(system.initial_state().history.size(), 0) {
  for (const InteractionRef& ref : system.interactions()) {
    const InteractionTraits& traits = system.traits(ref);
    if (!traits.lazy_history)
      std::fill_n(combines_.begin() + ref.first_history, traits.history_size, 1);
  }
}

void CombinationDerivative::linearize(const State& before, double H,
                                      std::span<const State* const> members) {
  const std::size_t count = members.size();
  weights_ = member_weights(extrapolation_substeps(2 * static_cast<int>(count)));
  combined_ = *members.back();
  combined_.t = before.t + H;
  std::vector<std::vector<double>> memories;
  for (const State* member : members) memories.push_back(member->history);
  combined_.history = memory(memories);
  turns_.assign(static_cast<std::size_t>(system_->body_count()), {});
  for (int b = 0; b < system_->body_count(); ++b) {
    Turns& t = turns_[static_cast<std::size_t>(b)];
    const BodyMotion centre = system_->motion(*members.back(), b);
    Vec3 r = Vec3::Zero(), chi = Vec3::Zero(), v = Vec3::Zero(), omega = Vec3::Zero();
    t.by_last.setZero();
    for (std::size_t j = 0; j < count; ++j) {
      const BodyMotion m = system_->motion(*members[j], b);
      const double w = weights_[j];
      const Quat turn = m.q * centre.q.conjugate();
      const Vec3 chi_j = 2.0 / turn.w() * turn.vec();
      r += w * (m.r - centre.r);
      chi += w * chi_j;
      v += w * (m.v - centre.v);
      omega += w * (m.omega() - centre.omega());
      t.by_member.push_back(w * cayley_tangent(chi_j).transpose());
      t.by_last -= t.by_member.back() * cay(chi_j);
      t.Lambda.push_back(m.Lambda());
      t.omega.push_back(m.omega());
    }
    t.by_chi = cayley_tangent_inverse(chi).transpose();
    t.carried = cay(chi);
    BodyMotion m = centre;
    m.r += r;
    m.q = (quaternion_from_cayley(chi) * centre.q).normalized();
    m.v += v;
    t.omega_n1 = centre.omega() + omega;
    m.W = m.q.conjugate() * t.omega_n1;
    t.Lambda_n1 = m.Lambda();
    combined_.set_motion(system_->slot(b), m);
  }
}

std::vector<double> CombinationDerivative::memory(
    std::span<const std::vector<double>> members) const {
  std::vector<double> combined = members.back();
  for (std::size_t k = 0; k < combined.size(); ++k) {
    if (combines_[k] == 0) continue;
    double sum = 0.0;
    for (std::size_t j = 0; j + 1 < members.size(); ++j)
      sum += weights_[j] * (members[j][k] - members.back()[k]);
    combined[k] += sum;
  }
  return combined;
}

Vec CombinationDerivative::push(std::span<const Vec> members) const {
  Vec dy = Vec::Zero(members.front().size());
  for (std::size_t b = 0; b < turns_.size(); ++b) {
    const Turns& t = turns_[b];
    const auto at = kStateNumbers * static_cast<Eigen::Index>(b);
    const Vec3 last = members.back().segment<3>(at + 3);
    Vec3 dchi = t.by_last * last, domega = Vec3::Zero();
    for (std::size_t j = 0; j < members.size(); ++j) {
      const Vec& y = members[j];
      const Vec3 dphi = y.segment<3>(at + 3);
      dy.segment<3>(at) += weights_[j] * y.segment<3>(at);
      dy.segment<3>(at + 6) += weights_[j] * y.segment<3>(at + 6);
      dchi += t.by_member[j] * dphi;
      domega += weights_[j] * (dphi.cross(t.omega[j]) + t.Lambda[j] * y.segment<3>(at + 9));
    }
    const Vec3 dphi = t.by_chi * dchi + t.carried * last;
    dy.segment<3>(at + 3) = dphi;
    dy.segment<3>(at + 9) = t.Lambda_n1.transpose() * (domega - dphi.cross(t.omega_n1));
  }
  return dy;
}

std::vector<Vec> CombinationDerivative::pull(const Vec& mu) const {
  std::vector<Vec> members(weights_.size(), Vec::Zero(mu.size()));
  for (std::size_t b = 0; b < turns_.size(); ++b) {
    const Turns& t = turns_[b];
    const auto at = kStateNumbers * static_cast<Eigen::Index>(b);
    const Vec3 of_omega = t.Lambda_n1 * mu.segment<3>(at + 9);
    // −(dφ × ω)·m = dφ·(m × ω)
    const Vec3 of_phi = mu.segment<3>(at + 3) + of_omega.cross(t.omega_n1);
    const Vec3 of_chi = t.by_chi.transpose() * of_phi;
    for (std::size_t j = 0; j < members.size(); ++j) {
      Vec& y = members[j];
      y.segment<3>(at) = weights_[j] * mu.segment<3>(at);
      y.segment<3>(at + 6) = weights_[j] * mu.segment<3>(at + 6);
      y.segment<3>(at + 3) =
          t.by_member[j].transpose() * of_chi + weights_[j] * t.omega[j].cross(of_omega);
      y.segment<3>(at + 9) = weights_[j] * t.Lambda[j].transpose() * of_omega;
    }
    members.back().segment<3>(at + 3) +=
        t.by_last.transpose() * of_chi + t.carried.transpose() * of_phi;
  }
  return members;
}

}  // namespace polhode
