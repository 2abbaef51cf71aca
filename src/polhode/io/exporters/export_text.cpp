// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/exporters/export_text.hpp>

#include <cmath>
#include <cstdlib>
#include <filesystem>

#include <polhode/core/format.hpp>

namespace polhode::io {

std::string number_text(double x) { return x == 0.0 ? "0" : format("{}", x); }

std::string numbers_text(std::initializer_list<double> list) {
  std::string text;
  for (const double x : list) text += (text.empty() ? "" : " ") + number_text(x);
  return text;
}

std::string vector_text(const Vec3& x) { return numbers_text({x.x(), x.y(), x.z()}); }

Vec3 rpy_of_rotation(const Mat3& R) {
  // After the yaw is taken away, whatever it is, the rest is a pitch and a roll.
  const double yaw = std::atan2(R(1, 0), R(0, 0));
  const double c = std::cos(yaw), s = std::sin(yaw);
  const double pitch = std::atan2(-R(2, 0), c * R(0, 0) + s * R(1, 0));
  const double roll = std::atan2(-(c * R(1, 2) - s * R(0, 2)), c * R(1, 1) - s * R(0, 1));
  return {roll, pitch, yaw};
}

std::string colour_text(const std::string& colour) {
  if (colour.size() != 7 || colour[0] != '#') return "";
  const long all = std::strtol(colour.c_str() + 1, nullptr, 16);
  const auto part = [&](int shift) { return static_cast<double>((all >> shift) & 0xff) / 255.0; };
  return format("{:.4g} {:.4g} {:.4g} 1", part(16), part(8), part(0));
}

std::string path_from(const std::string& file, const std::string& path) {
  namespace fs = std::filesystem;
  std::error_code ignored;
  const fs::path folder = fs::absolute(file, ignored).lexically_normal().parent_path();
  return fs::absolute(path, ignored)
      .lexically_normal()
      .lexically_proximate(folder)
      .generic_string();
}

std::string title_of(const Model& model, const std::string& file) {
  return model.title.empty() ? std::filesystem::path(file).stem().string() : model.title;
}

}  // namespace polhode::io
