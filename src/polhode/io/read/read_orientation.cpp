// SPDX-License-Identifier: Apache-2.0
#include <Eigen/LU>
#include <cctype>
#include <cmath>

#include <polhode/core/format.hpp>
#include <polhode/io/read/read_context.hpp>

namespace polhode::io {
namespace {

constexpr const char* kForms =
    "Use one of: axis with angle, quaternion, rotation_vector, euler, matrix.";

/// Tolerance for printed unit quaternions and orthogonal matrices.
constexpr double kPrinted = 1e-4;

Quat turn(const Vec3& axis, double angle) { return Quat(Eigen::AngleAxisd(angle, axis)); }

std::optional<Quat> from_quaternion(ReadContext& context, const SourceNode& node,
                                    const std::string& path, const Field& field) {
  const auto q = read_numbers(context, node, path, field, 4);
  if (!q) return std::nullopt;
  const Quat quaternion((*q)[0], (*q)[1], (*q)[2], (*q)[3]);
  if (std::abs(quaternion.norm() - 1.0) > kPrinted) {
    context.fault(node, path, "has length " + shown(quaternion.norm()) + " instead of 1",
                  "Give a unit quaternion [w, x, y, z].");
    return std::nullopt;
  }
  return quaternion.normalized();
}

std::optional<Quat> from_euler(ReadContext& context, const SourceNode& node,
                               const std::string& path) {
  Section section(context, node, context.tree.place_of(node), path, euler_fields());
  const auto sequence = section.text("sequence");
  const auto angles = section.vector("angles");
  if (!sequence || !angles) return std::nullopt;
  const std::string& s = *sequence;
  if (!check_euler_sequence(section, s)) return std::nullopt;
  Quat q = Quat::Identity();
  for (int k = 0; k < 3; ++k) {
    const char letter = s[static_cast<std::size_t>(k)];
    const bool about_body = letter >= 'x';
    const Quat next = turn(Vec3::Unit(letter - (about_body ? 'x' : 'X')), (*angles)[k]);
    q = about_body ? q * next : next * q;
  }
  return q.normalized();
}

std::optional<Quat> from_matrix(ReadContext& context, const SourceNode& node,
                                const std::string& path, const Field& field) {
  Mat3 R;
  if (!node.is_list() || node.children.size() != 3) {
    context.fault(node, path, "expects three rows of three numbers, but is " + node.description(),
                  "Write [[1, 0, 0], [0, 1, 0], [0, 0, 1]], for example.");
    return std::nullopt;
  }
  for (int row = 0; row < 3; ++row) {
    const auto numbers =
        read_vector(context, node.children[static_cast<std::size_t>(row)], path, field);
    if (!numbers) return std::nullopt;
    R.row(row) = numbers->transpose();
  }
  const double error = (R * R.transpose() - Mat3::Identity()).cwiseAbs().maxCoeff();
  if (!(error <= kPrinted)) {
    context.fault(node, path,
                  format("is not orthogonal: R R^T differs from the identity by {}", shown(error)),
                  "Give rows of length 1 at right angles, with enough digits.");
    return std::nullopt;
  }
  if (R.determinant() < 0.0) {
    context.fault(node, path, "is a reflection: its determinant is -1",
                  "Change the sign of one row; rotations have determinant +1.");
    return std::nullopt;
  }
  return Quat(R).normalized();
}

}  // namespace

bool check_euler_sequence(Section& section, const std::string& s, const char* key) {
  const auto all = [&](const std::string& letters) {
    return s.size() == 3 && s.find_first_not_of(letters) == std::string::npos;
  };
  if ((all("xyz") || all("XYZ")) && s[0] != s[1] && s[1] != s[2]) return true;
  section.fault(key, quote(s) + " is no Euler sequence",
                "Give three letters, neighbours different: lower case (zxz) for turns about the "
                "body's axes, upper case (XYZ) about the world's.");
  return false;
}

std::optional<Quat> read_orientation(ReadContext& context, const SourceNode& node,
                                     const std::string& path) {
  const FieldTable& table = orientation_fields();
  Section section(context, node, context.tree.place_of(node), path, table);
  if (!node.is_map()) return std::nullopt;
  int forms = 0;
  for (const char* form : {"axis", "quaternion", "rotation_vector", "euler", "matrix"})
    forms += section.has(form) ? 1 : 0;
  if (forms == 0 && section.has_unknown_key()) return std::nullopt;  // Already reported.
  if (forms != 1) {
    section.fault(forms == 0 ? "gives no rotation" : "gives more than one rotation", kForms);
    return std::nullopt;
  }
  if (section.has("axis") != section.has("angle")) {
    section.fault(section.has("axis") ? "'angle' is missing" : "'angle' requires 'axis'",
                  "Write {axis: z, angle: 30 deg}.");
    return std::nullopt;
  }
  if (const SourceNode* value = section.find("axis")) {
    const auto axis = read_direction(context, *value, section.path("axis"));
    const auto angle = section.number("angle");
    if (!axis || !angle) return std::nullopt;
    return turn(*axis, *angle);
  }
  if (const SourceNode* value = section.find("quaternion"))
    return from_quaternion(context, *value, section.path("quaternion"), table.at("quaternion"));
  if (const SourceNode* value = section.find("euler"))
    return from_euler(context, *value, section.path("euler"));
  if (const SourceNode* value = section.find("matrix"))
    return from_matrix(context, *value, section.path("matrix"), table.at("matrix"));
  const auto vector = section.vector("rotation_vector");
  if (!vector) return std::nullopt;
  const double angle = vector->norm();
  return angle > 0.0 ? turn(*vector / angle, angle) : Quat::Identity();
}

}  // namespace polhode::io
