// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/importers/sdf_file.hpp>

#include <cmath>
#include <numbers>

#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>

namespace polhode::io {

namespace {

/// Size from which on a limit means none, as SDFormat's standard value does.
constexpr double kNoLimit = 1e16;

}  // namespace

void SdfFile::refuse(const Element& at, const std::string& what, const std::string& hint) {
  if (options.allow_partial)
    notes.push_back({ImportNote::Kind::left_out, xml.place(at), what});
  else
    xml.fault(at, what, hint + " Or allow a partial import.");
}

void SdfFile::approximated(const Element& at, std::string what) {
  notes.push_back({ImportNote::Kind::approximated, xml.place(at), std::move(what)});
}

std::string SdfFile::text(const Element& parent, const char* tag) {
  const Element* e = xml.child(parent, tag);
  return e == nullptr ? "" : XmlFile::content(*e).value_or("");
}

std::string SdfFile::required_text(const Element& parent, const char* tag) {
  std::string found = text(parent, tag);
  if (found.empty())
    xml.fault(parent, format("<{}> has no <{}>", parent.Name(), tag),
              format("Write <{}>...</{}>.", tag, tag));
  return found;
}

std::optional<double> SdfFile::number(const Element& parent, const char* tag) {
  const Element* e = xml.child(parent, tag);
  if (e == nullptr) return std::nullopt;
  const auto list = xml.content_numbers(*e, 1, 1);
  return list ? std::optional((*list)[0]) : std::nullopt;
}

std::optional<double> SdfFile::bound(const Element& parent, const char* tag) {
  std::string given = text(parent, tag);
  if (given.starts_with('+') || given.starts_with('-')) given.erase(0, 1);
  if (given == "inf" || given == "Inf" || given == "INF" || given == "infinity") return {};
  const auto value = number(parent, tag);
  return value && std::abs(*value) < kNoLimit ? value : std::nullopt;
}

double SdfFile::not_negative(const Element& parent, const char* tag) {
  const double value = number(parent, tag).value_or(0.0);
  if (value < 0.0)
    xml.fault(*xml.child(parent, tag), format("<{}> is {}", tag, value),
              "Give a value that is not negative.");
  return std::max(0.0, value);
}

std::optional<Vec3> SdfFile::vector(const Element& parent, const char* tag) {
  const Element* e = xml.child(parent, tag);
  if (e == nullptr) return std::nullopt;
  const auto list = xml.content_numbers(*e, 3, 3);
  return list ? std::optional(Vec3((*list)[0], (*list)[1], (*list)[2])) : std::nullopt;
}

bool SdfFile::truth(const Element& e, const std::string& what, const std::string& text,
                    bool standard) {
  std::string word = text;
  for (char& c : word) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  if (word == "true" || word == "1") return true;
  if (word == "false" || word == "0") return false;
  xml.fault(e, format("{} is {}", what, quote(text)), "Write true or false.");
  return standard;
}

bool SdfFile::boolean(const Element& parent, const char* tag, bool standard) {
  const Element* e = xml.child(parent, tag);
  const auto given = e == nullptr ? std::nullopt : XmlFile::content(*e);
  return given ? truth(*e, format("<{}>", tag), *given, standard) : standard;
}

bool SdfFile::flag(const Element& e, const char* attribute, bool standard) {
  const auto given = xml.text(e, attribute);
  return given ? truth(e, format("'{}' of <{}>", attribute, e.Name()), *given, standard) : standard;
}

SdfPose SdfFile::pose(const Element& parent) {
  SdfPose result;
  const Element* e = xml.child(parent, "pose");
  if (e == nullptr) return result;
  result.relative_to = xml.text(*e, "relative_to").value_or("");
  if (const auto old = xml.text(*e, "frame"); old && result.relative_to.empty())
    result.relative_to = *old;
  const bool degrees = flag(*e, "degrees", false);
  const std::string rotation = xml.text(*e, "rotation_format").value_or("euler_rpy");
  if (rotation != "euler_rpy" && rotation != "quat_xyzw") {
    xml.fault(*e, format("'rotation_format' is {}", quote(rotation)),
              "Write euler_rpy or quat_xyzw.");
    return result;
  }
  const bool quaternion = rotation == "quat_xyzw";
  const std::size_t count = quaternion ? 7 : 6;
  const auto values = xml.content_numbers(*e, count, count);
  if (!values) return result;
  const std::vector<double>& v = *values;
  result.pose.p = Vec3(v[0], v[1], v[2]);
  if (quaternion) {
    Quat turn(v[6], v[3], v[4], v[5]);
    const double largest = turn.coeffs().cwiseAbs().maxCoeff();
    if (largest > 0.0) turn.coeffs() /= largest;  // Squares of any numbers are finite then.
    if (largest > 0.0)
      result.pose.R = turn.normalized().toRotationMatrix();
    else
      xml.fault(*e, "the quaternion of <pose> is zero", "Write 0 0 0 1 for no rotation.");
    return result;
  }
  const double unit = degrees ? std::numbers::pi / 180.0 : 1.0;
  result.pose.R = rotation_of_rpy(unit * Vec3(v[3], v[4], v[5]));
  return result;
}

}  // namespace polhode::io
