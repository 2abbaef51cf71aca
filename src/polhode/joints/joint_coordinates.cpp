// SPDX-License-Identifier: Apache-2.0
// Free coordinates of a joint: their names, values and rates.
#include <algorithm>

#include <polhode/joints/joint.hpp>
#include <polhode/joints/rod_coordinates.hpp>
#include <polhode/math/exp_map.hpp>

namespace polhode {

namespace {

constexpr const char* kAxisName[3] = {"x", "y", "z"};
constexpr const char* kRotationName[3] = {"rx", "ry", "rz"};

}  // namespace

int Joint::angles() const {
  if (rod_ != RodKind::none || parts_.distance) return 0;
  return parts_.axes == 2 ? 1 : parts_.axes == 1 ? 2 : 0;
}

FreeAngle Joint::angle(int i) const {
  const Mat3 &R_a = user_frames_.R_a, &R_b = user_frames_.R_b;
  if (parts_.axes == 2) return {R_a.col(kX), R_a.col(kY), R_b.col(kX), false};
  if (i == 0) return {R_a.col(kY), R_a.col(kZ), R_b.col(kY), false};  // About x of a.
  return {R_b.col(kX), R_b.col(kZ), R_a.col(kX), true};               // About y of b.
}

std::optional<FreeAngle> Joint::axis_angle() const {
  if (parts_.axes != 2) return std::nullopt;
  return angle(0);
}

std::optional<FreeAngle> Joint::free_angle(const std::string& coordinate) const {
  const std::vector<std::string> names = coordinate_names();
  const auto first = names.end() - angles();  // angles come last
  if (coordinate.empty()) return angles() == 1 ? std::optional<FreeAngle>(angle(0)) : std::nullopt;
  const auto found = std::find(first, names.end(), coordinate);
  if (found == names.end()) return std::nullopt;
  return angle(static_cast<int>(found - first));
}

std::optional<FreeDisplacement> Joint::free_displacement(const std::string& coordinate) const {
  std::optional<FreeDisplacement> found;
  for (int k = 0; k < 3; ++k) {
    if (!translation_free(k) || (!coordinate.empty() && coordinate != kAxisName[k])) continue;
    if (found) return std::nullopt;
    found = FreeDisplacement{user_frames_.Z_a, user_frames_.Z_b,
                             user_frames_.R_a.col((k - shift_ + 3) % 3)};
  }
  return found;
}

bool Joint::translation_free(int user_axis) const {
  if (parts_.coincident || parts_.distance || rod_ != RodKind::none) return false;
  for (int i = 0; i < parts_.planes; ++i)
    if ((parts_.plane[static_cast<std::size_t>(i)].normal + shift_) % 3 == user_axis) return false;
  return true;
}

std::vector<std::string> Joint::coordinate_names() const {
  std::vector<std::string> names;
  for (int k = 0; k < 3; ++k)
    if (translation_free(k)) names.emplace_back(kAxisName[k]);
  if (rod_ != RodKind::none) return RodCoordinates::names(rod_);
  if (parts_.distance) return names;
  if (parts_.equal_turns) return {kRotationName[kX], kRotationName[kY]};
  if (parts_.axes == 0) names.insert(names.end(), kRotationName, kRotationName + 3);
  if (parts_.axes == 1)
    for (int i : {kX, kY}) names.emplace_back(kRotationName[(i + shift_) % 3]);
  if (parts_.axes == 2) names.emplace_back(kRotationName[(kZ + shift_) % 3]);
  return names;
}

JointCoordinates Joint::coordinates(const BodyStep& a, const BodyStep& b,
                                    const double* history) const {
  JointCoordinates c;
  const auto add = [&](double value, double rate) {
    c.value[static_cast<std::size_t>(c.count)] = value;
    c.rate[static_cast<std::size_t>(c.count++)] = rate;
  };
  for (int k = 0; k < 3; ++k) {
    if (!translation_free(k)) continue;
    const FreeDisplacement s{user_frames_.Z_a, user_frames_.Z_b,
                             user_frames_.R_a.col((k - shift_ + 3) % 3)};
    add(s.at_n1(a, b), s.rate_at_n1(a, b));
  }
  const Vec3 omega_a = a.Lambda_n1 * a.W_n1, omega_b = b.Lambda_n1 * b.W_n1;
  const Mat3 R_a = a.Lambda_n1 * user_frames_.R_a;
  if (rod_ != RodKind::none) {
    const Vec3 z_a = a.Lambda_n1 * user_frames_.Z_a, z_b = b.Lambda_n1 * user_frames_.Z_b;
    const Vec3 u = (b.r_n1 - a.r_n1) + (z_b - z_a);
    const Vec3 u_dot = b.v_n1 + omega_b.cross(z_b) - a.v_n1 - omega_a.cross(z_a);
    const RodCoordinates rod(rod_, R_a.transpose() * u,
                             R_a.transpose() * (u_dot - omega_a.cross(u)));
    for (int k = 0; k < rod.count; ++k) add(rod.value[k], rod.rate[k]);
    return c;
  }
  if (parts_.distance) return c;
  if (parts_.axes == 0) {
    const Vec3 chi = log_map(R_a.transpose() * (b.Lambda_n1 * user_frames_.R_b));
    const Vec3 omega = R_a.transpose() * (omega_b - omega_a);
    const Vec3 rate = parts_.equal_turns ? rotation_vector_rate(chi, omega) : omega;
    for (int k = 0; k < (parts_.equal_turns ? 2 : 3); ++k) add(chi[k], rate[k]);
    if (parts_.equal_turns) return c;
  }
  for (int i = 0; i < angles(); ++i)
    add(angle(i).at_n1(a, b, history[i]), angle(i).rate_at_n1(a, b));
  return c;
}

}  // namespace polhode
