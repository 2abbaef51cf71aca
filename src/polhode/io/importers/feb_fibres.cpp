// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>

#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>
#include <polhode/io/importers/feb_law.hpp>

namespace polhode::io {

namespace {

constexpr double kDegree = 3.14159265358979323846 / 180.0;

}  // namespace

bool FebLaw::is_fibre(const std::string& type) { return fibre_law(type).law != nullptr; }

FebLaw::FibreLaw FebLaw::fibre_law(const std::string& type) {
  if (type == "fiber-exp-pow") return {"exponential", false};
  if (type == "fiber-exp-pow-uncoupled" || type == "uncoupled fiber-exp-pow")
    return {"exponential", true};
  if (type == "fiber-pow-linear") return {"power_linear", false};
  if (type == "fiber-pow-linear-uncoupled" || type == "uncoupled fiber-pow-linear")
    return {"power_linear", true};
  if (type == "fiber-exp-linear") return {"toe", false};
  if (type == "uncoupled fiber-exp-linear" || type == "fiber-exp-linear-uncoupled")
    return {"toe", true};
  return {};
}

std::optional<Mat3> FebLaw::axes(const Element& e) {
  const Element* given = file_.child(e, "mat_axis");
  if (given == nullptr) return Mat3::Identity();
  if (const std::string type = file_.type(*given); type != "vector") {
    file_.refuse(*given, format("<mat_axis> of type {} is not read", quote(type)),
                 "Give <mat_axis type=\"vector\"> with <a> and <d>.");
    return std::nullopt;
  }
  Mat3 Q;
  Q.col(0) = file_.direction(*given, "a", Vec3::UnitX());
  const Vec3 normal = Q.col(0).cross(file_.direction(*given, "d", Vec3::UnitY()));
  if (!(normal.norm() > 1e-9)) {
    file_.xml.fault(*given, "<a> and <d> are along one line", "Give two directions.");
    return std::nullopt;
  }
  Q.col(2) = normal.normalized();
  Q.col(1) = Q.col(2).cross(Vec3(Q.col(0)));
  return Q;
}

std::optional<Vec3> FebLaw::fibre_direction(const Element& e, const Mat3& outer) {
  for (const char* old : {"theta", "phi"})
    if (const Element* angle = file_.child(e, old)) {
      file_.refuse(*angle, format("<{}> outside <fiber> is not read", old),
                   "Give <fiber type=\"angles\">.");
      return std::nullopt;
    }
  const std::optional<Mat3> own = axes(e);
  if (!own) return std::nullopt;
  const Element* given = file_.child(e, "fiber");
  const std::string type = given == nullptr ? "" : file_.type(*given);
  std::optional<Vec3> a;
  if (given == nullptr) {
    a = Vec3::UnitX();
  } else if (type == "vector") {
    if (file_.child(*given, "vector") != nullptr)
      a = file_.direction(*given, "vector", Vec3::UnitX());
    else if (XmlFile::content(*given))
      a = file_.direction(e, "fiber", Vec3::UnitX());
  } else if (type == "angles") {
    const double theta = file_.number(*given, "theta").value_or(0.0) * kDegree;
    const double phi = file_.number(*given, "phi").value_or(90.0) * kDegree;
    a = Vec3(std::cos(theta) * std::sin(phi), std::sin(theta) * std::sin(phi), std::cos(phi));
  }
  if (!a) {
    file_.refuse(*given,
                 "only fibres of type \"vector\" or \"angles\" are read, which are the same "
                 "everywhere",
                 "Give <fiber type=\"vector\">.");
    return std::nullopt;
  }
  return Vec3(outer * *own * *a);
}

bool FebLaw::put_direction(const Element& e, const Mat3& outer, SourceNode fibre) {
  const std::optional<Vec3> a = fibre_direction(e, outer);
  if (!a) return false;
  make_.put(fibre, "direction", make_.direction(*a));
  local_.push_back(*a);
  fibres_.push_back(std::move(fibre));
  return true;
}

SourceNode FebLaw::fibre_node(const Element& e, const char* law,
                              std::initializer_list<std::array<const char*, 2>> parameters) {
  SourceNode fibre = make_.map();
  make_.put(fibre, "law", make_.text(law));
  for (const auto& [key, tag] : parameters)
    if (const auto value = file_.number(e, tag)) make_.put(fibre, key, make_.number(*value));
  return fibre;
}

bool FebLaw::put_fibre(const Element& e, const std::string& type, const Mat3& outer) {
  const FibreLaw law = fibre_law(type);
  const auto number = [&](const char* tag, double standard) {
    return file_.number(e, tag).value_or(standard);
  };
  isochoric_.push_back(law.isochoric);
  if (law.isochoric) bulk_ += number("k", 0.0);
  SourceNode fibre;
  if (const std::string name = law.law; name == "exponential") {
    for (const auto& [tag, none] : {std::pair{"mu", 0.0}, {"lam0", 1.0}})
      if (number(tag, none) != none) {
        file_.refuse(e, format("<{}> of {} is not read", tag, type), "Leave it out.");
        return false;
      }
    if (number("ksi", 0.0) == 0.0) return true;  // no fibres
    fibre = fibre_node(e, "exponential", {{"xi", "ksi"}, {"alpha", "alpha"}, {"beta", "beta"}});
  } else if (name == "power_linear") {
    if (number("E", 0.0) == 0.0) return true;
    fibre = fibre_node(e, "power_linear",
                       {{"modulus", "E"}, {"beta", "beta"}, {"straight_stretch", "lam0"}});
  } else {
    fibre = fibre_node(e, "toe",
                       {{"c3", "c3"}, {"c4", "c4"}, {"c5", "c5"}, {"straight_stretch", "lambda"}});
  }
  return put_direction(e, outer, std::move(fibre));
}

bool FebLaw::put_arterial_fibres(const Element& e, const Mat3& outer) {
  const std::optional<Mat3> own = axes(e);
  if (!own) return false;
  const auto number = [&](const char* tag) { return file_.number(e, tag).value_or(0.0); };
  if (number("k1") == 0.0) return true;
  const double gamma = number("gamma") * kDegree;
  for (const double side : {1.0, -1.0}) {
    SourceNode fibre =
        fibre_node(e, "exponential", {{"xi", "k1"}, {"alpha", "k2"}, {"dispersion", "kappa"}});
    const Vec3 a = outer * *own * Vec3(std::cos(gamma), side * std::sin(gamma), 0.0);
    make_.put(fibre, "direction", make_.direction(a));
    local_.push_back(a);
    fibres_.push_back(std::move(fibre));
    isochoric_.push_back(true);
  }
  return true;
}

}  // namespace polhode::io
