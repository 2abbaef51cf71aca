// SPDX-License-Identifier: Apache-2.0
// Senses of modes in a turning frame, and their frequencies in the world.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <polhode/statics/turning_model.hpp>

namespace polhode {

namespace {

/// Part of a mode's resultants that must be of one sense.
constexpr double kOneSense = 0.999;
/// Resultants of a mode, as a part of those of a rigid motion of this kinetic energy, below which
/// they are rounding or the unevenness of a mesh [-].
constexpr double kResultant = 1e-5;
/// Energy of a motion that the model allows without stiffness, as a part of the terms of its sum,
/// and its constraints' rate, as a part of its size.
constexpr double kNoEnergy = 1e-12, kAllowed = 1e-9;
/// Part of a mode that is such a motion, and its |λ| as a part of the largest: a double eigenvalue
/// zero is found as one of the size of the root of rounding.
constexpr double kSameMotion = 0.999, kSplitZero = 1e-3;

/// Rate of growth or decay, as a part of |λ|, that is rounding where nothing dissipates: then
/// eigenvalues are imaginary or come in pairs, one growing, one decaying.
constexpr double kNoRate = 1e-6;
/// Asymmetry of a stiffness up to which it has a potential.
constexpr double kPotential = 1e-7;

using Fields = std::array<Vec, 6>;

/// Rigid motions, each of unit modal mass: translations along e_1, e_2 and the axis, and rotations
/// about these through the point of the axis next to the centre of mass.
Fields rigid_fields(const System& system, const State& state, const TurningFrame& frame,
                    ModalMatrices& m) {
  Mat3 axes;
  axes.col(2) = frame.axis;
  axes.col(0) = frame.axis.unitOrthogonal();
  axes.col(1) = axes.col(2).cross(axes.col(0));
  // A field by the displacement at a place and the rotation.
  const auto field = [&](auto&& at, const Vec3& rotation) {
    Vec x = Vec::Zero(m.n());
    for (int b = 0; b < system.body_count(); ++b) {
      x.segment<3>(6 * b) = at(system.motion(state, b).r);
      if (!system.bodies()[b].point_mass) x.segment<3>(6 * b + 3) = rotation;
    }
    for (int i = 0; i < system.nodes().count(); ++i) {
      const Vec3 d = at(Vec3(Eigen::Map<const Vec3>(state.node_x.data() + 3 * i)));
      for (int c = 0; c < 3; ++c)
        if (const int u = m.K().unknown(i, c); u >= 0) x[u] = d[c];
    }
    return x;
  };
  const Vec along = field([&](const Vec3&) -> Vec3 { return frame.axis; }, Vec3::Zero());
  const Vec place =
      field([&](const Vec3& x) -> Vec3 { return frame.axis * frame.axis.dot(x - frame.through); },
            Vec3::Zero());
  const Vec M_along = m.mass_times(along);
  const double mass = along.dot(M_along);
  const Vec3 centre = frame.through + (mass > 0.0 ? place.dot(M_along) / mass : 0.0) * frame.axis;
  Fields fields;
  for (int k = 0; k < 3; ++k) {
    const Vec3 e = axes.col(k);
    fields[k] = field([&](const Vec3&) -> Vec3 { return e; }, Vec3::Zero());
    fields[k + 3] = field([&](const Vec3& x) -> Vec3 { return e.cross(x - centre); }, e);
  }
  for (Vec& x : fields)
    if (const double square = x.dot(m.mass_times(x)); square > 0.0) x /= std::sqrt(square);
  return fields;
}

/// Whether the model allows a motion and gives it no stiffness.
bool moves_freely(ModalMatrices& m, const Vec& x) {
  Vec all = Vec::Zero(m.K().size()), y;
  all.head(m.n()) = x;
  m.K().times(all, y);
  return y.tail(m.rows()).norm() <= kAllowed * x.norm() &&
         std::abs(x.dot(m.stiffness_times(x))) <= kNoEnergy * m.energy_scale(x);
}

/// Replaces what was found of the motion x, which is free, by itself. Its eigenvalue is a double
/// zero, which rounding splits.
/// @param fastest  A rate of the model [rad/s].
void take_free(ModalMatrices& m, const Vec& x, double fastest, std::vector<Mode>& modes) {
  double highest = fastest;
  for (const Mode& mode : modes) highest = std::max(highest, std::abs(mode.eigenvalue));
  const Vec M_x = m.mass_times(x);
  bool found = false;
  std::erase_if(modes, [&](Mode& mode) {
    if (mode.rigid || !(std::abs(mode.eigenvalue) <= kSplitZero * highest)) return false;
    double part = std::pow(M_x.dot(mode.shape), 2);
    if (mode.shape_imag.size() > 0) part += std::pow(M_x.dot(mode.shape_imag), 2);
    if (part < kSameMotion) return false;
    if (found) return true;
    found = true;
    mode.eigenvalue = 0.0;
    mode.frequency = mode.damping = mode.omega_squared = 0.0;
    mode.kind = ModeKind::free;
    mode.rigid = true;
    mode.shape = x;
    mode.shape_imag.resize(0);
    return false;
  });
}

/// Removes rates that are rounding from a mode of a model without dissipation.
void drop_rate(Mode& mode) {
  const double size = std::abs(mode.eigenvalue);
  if (mode.eigenvalue.imag() <= 0.0 || std::abs(mode.eigenvalue.real()) > kNoRate * size) return;
  mode.eigenvalue.real(0.0);
  mode.damping = 0.0;
  mode.kind = ModeKind::oscillation;
}

/// @eq{spin-whirl}
void name_whirl(const Fields& M_fields, double Omega, Mode& mode) {
  const auto part = [&](int k) {
    return std::complex<double>(M_fields[k].dot(mode.shape), mode.shape_imag.size() > 0
                                                                 ? M_fields[k].dot(mode.shape_imag)
                                                                 : 0.0);
  };
  const std::complex<double> i(0.0, 1.0);
  double with = 0.0, against = 0.0, on_axis = 0.0;
  for (const int k : {0, 3}) {
    with += 0.5 * std::norm(part(k) + i * part(k + 1));
    against += 0.5 * std::norm(part(k) - i * part(k + 1));
    on_axis += std::norm(part(k + 2));
  }
  const double all = with + against + on_axis, omega = mode.eigenvalue.imag();
  if (!(all > kResultant)) return;
  const auto set = [&](double in_world) {
    mode.whirl = in_world >= 0.0 ? Whirl::forward : Whirl::backward;
    mode.world_frequency = std::abs(in_world) / (2.0 * std::numbers::pi);
  };
  // Positive about the axis. The spin is, if Ω is.
  const double sense = Omega < 0.0 ? -1.0 : 1.0;
  if (with > kOneSense * all) set(sense * (Omega + omega));
  if (against > kOneSense * all) set(sense * (Omega - omega));
  if (on_axis > kOneSense * all) {
    mode.whirl = Whirl::none;
    mode.world_frequency = omega / (2.0 * std::numbers::pi);
  }
}

}  // namespace

const char* whirl_name(Whirl whirl) {
  switch (whirl) {
    case Whirl::unknown:
      return "unknown";
    case Whirl::none:
      return "none";
    case Whirl::forward:
      return "forward";
    case Whirl::backward:
      return "backward";
  }
  return "";
}

void find_whirl(const System& system, const State& state, const TurningFrame& frame,
                ModalMatrices& m, std::vector<Mode>& modes) {
  Fields fields = rigid_fields(system, state, frame, m);
  for (const int k : {2, 5})
    if (moves_freely(m, fields[k])) take_free(m, fields[k], std::abs(frame.speed), modes);
  for (Vec& x : fields) x = m.mass_times(x);
  if (!m.dissipates() && m.asymmetry() <= kPotential)
    for (Mode& mode : modes) drop_rate(mode);
  for (Mode& mode : modes) {
    if (mode.rigid) {
      mode.whirl = Whirl::none;
      mode.world_frequency = 0.0;
    } else if (frame.speed == 0.0) {
      mode.whirl = Whirl::none;
      mode.world_frequency = std::abs(mode.eigenvalue.imag()) / (2.0 * std::numbers::pi);
    } else if (mode.eigenvalue.imag() > 0.0) {
      name_whirl(fields, frame.speed, mode);
    }
  }
}

}  // namespace polhode
