// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <limits>

#include <polhode/core/format.hpp>
#include <polhode/io/schema/field_table.hpp>
#include <polhode/model/material_spec.hpp>
#include <polhode/solids/materials/registry.hpp>

namespace polhode::io {

using namespace dimensions;
using enum FieldKind;

namespace {

/// Range of a parameter; the smallest positive number, and the neighbours of round numbers, mean
/// open ends.
Range range_of(const Parameter& p) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const auto is_round = [](double x) { return std::isfinite(x) && 2.0 * x == std::round(2.0 * x); };
  Range range{p.least, p.most, false, false};
  if (p.least == std::numeric_limits<double>::min()) range = {0.0, p.most, true, false};
  if (const double below = std::nextafter(p.least, -kInfinity);
      is_round(below) && !is_round(p.least))
    range.least = below, range.above_least = true;
  if (const double above = std::nextafter(p.most, kInfinity); is_round(above) && !is_round(p.most))
    range.most = above, range.below_most = true;
  if (range.most == std::numeric_limits<double>::max()) range.most = kInfinity;
  return range;
}

/// Whether a parameter is required; one of an alternative is not.
bool is_required(const solids::MaterialKind& kind, const Parameter& p) {
  if (p.standard) return false;
  for (const auto& set : kind.alternatives)
    for (const std::string& name : set)
      if (name == p.name) return false;
  return true;
}

std::vector<Field> parameter_fields(const solids::MaterialKind& kind) {
  std::vector<Field> fields;
  for (const Parameter& p : kind.parameters) {
    const UnitReading unit = read_unit(p.unit);
    fields.push_back({.name = p.name,
                      .kind = kNumber,
                      .dimension = unit.unit ? unit.unit->dimension : kNone,
                      .meaning = sentence(p.meaning),
                      .standard = p.standard ? format("{:g}", *p.standard) : "",
                      .required = is_required(kind, p),
                      .range = range_of(p)});
  }
  return fields;
}

/// Description of the alternatives of parameters.
std::string alternatives_text(const solids::MaterialKind& kind) {
  std::string text;
  for (const auto& set : kind.alternatives) {
    std::string names;
    for (std::size_t i = 0; i < set.size(); ++i)
      names += (i == 0 ? "" : i + 1 == set.size() ? " and " : ", ") + set[i];
    text += (text.empty() ? " Give " : "; or ") + names;
  }
  return text.empty() ? text : text + ".";
}

Field type_field(const std::string& key, const std::string& meaning, const std::string& name) {
  return {.name = key, .kind = kChoice, .meaning = meaning, .required = true, .choices = {name}};
}

KindTable material_table(const std::string& name, const solids::MaterialKind& kind) {
  KindTable result{name,
                   {"material " + name, sentence(kind.meaning) + alternatives_text(kind), {}}};
  std::vector<Field>& fields = result.table.fields;
  fields = parameter_fields(kind);
  fields.insert(fields.begin(), type_field("type", "The kind of material.", name));
  fields.insert(fields.end(), {{.name = "density",
                                .kind = kNumber,
                                .dimension = kDensity,
                                .meaning = "Density of the undeformed material.",
                                .standard = "given with each solid",
                                .range = kPositive},
                               {.name = "viscosity",
                                .kind = kSection,
                                .meaning = "Kelvin-Voigt viscosity.",
                                .standard = "none",
                                .table = "viscosity"},
                               {.name = "relaxation",
                                .kind = kSections,
                                .meaning = "Terms of the stress that relax: Prony series.",
                                .standard = "none",
                                .table = "relaxation",
                                .since = "0.3"},
                               {.name = "long_term_ratio",
                                .kind = kNumber,
                                .meaning = "Ratio of the stress that stays to the elastic one.",
                                .standard = "1",
                                .range = kNotNegative,
                                .since = "0.3"},
                               {.name = "fibre",
                                .kind = kSections,
                                .meaning = "Fibres that carry tension only; several families.",
                                .standard = "none",
                                .table = "fibre"}});
  return result;
}

}  // namespace

const std::vector<KindTable>& material_tables() {
  static const std::vector<KindTable> tables = [] {
    std::vector<KindTable> list;
    for (const solids::MaterialKind& kind : solids::material_kinds()) {
      list.push_back(material_table(kind.name, kind));
      if (!kind.also.empty()) list.push_back(material_table(kind.also, kind));
    }
    return list;
  }();
  return tables;
}

const FieldTable& viscosity_fields() {
  static const FieldTable table{
      "viscosity",
      "Kelvin-Voigt viscosity: a relaxation time, or viscous moduli.",
      {
          {.name = "relaxation_time",
           .kind = kNumber,
           .dimension = kTime,
           .meaning = "Ratio of viscous to elastic moduli of the undeformed material.",
           .range = kPositive,
           .member = &ViscositySpec::relaxation_time},
          {.name = "shear",
           .kind = kNumber,
           .dimension = kViscosity,
           .meaning = "Shear viscosity: the stress is 2 times this times the rate of strain.",
           .standard = "0",
           .range = kNotNegative,
           .member = &ViscositySpec::shear},
          {.name = "lame",
           .kind = kNumber,
           .dimension = kViscosity,
           .meaning = "Viscous first Lamé constant: stress per rate of volume strain.",
           .standard = "0",
           .member = &ViscositySpec::lame},
      }};
  return table;
}

const FieldTable& relaxation_fields() {
  static const FieldTable table{
      "relaxation",
      "A term of the relaxation series: part of the stress that follows changes of the elastic "
      "stress at once and then decays.",
      {
          {.name = "modulus_ratio",
           .kind = kNumber,
           .meaning = "Ratio of this part to the elastic stress, right after a sudden change.",
           .required = true,
           .range = kPositive,
           .member = &RelaxationSpec::modulus_ratio,
           .since = "0.3"},
          {.name = "time",
           .kind = kNumber,
           .dimension = kTime,
           .meaning = "Relaxation time.",
           .required = true,
           .range = kPositive,
           .member = &RelaxationSpec::time,
           .since = "0.3"},
      }};
  return table;
}

const std::vector<KindTable>& fibre_tables() {
  static const std::vector<KindTable> tables = [] {
    std::vector<KindTable> list;
    for (const solids::MaterialKind& kind : solids::fibre_kinds()) {
      KindTable one{kind.name, {"fibre " + kind.name, sentence(kind.meaning), {}}};
      one.table.meaning += alternatives_text(kind);
      one.table.fields = parameter_fields(kind);
      one.table.fields.insert(one.table.fields.begin(),
                              type_field("law", "The law of the fibres.", kind.name));
      one.table.fields.push_back({.name = "direction",
                                  .kind = kDirection,
                                  .meaning = "Direction of the fibres, in the mesh's axes.",
                                  .required = true});
      list.push_back(std::move(one));
    }
    return list;
  }();
  return tables;
}

}  // namespace polhode::io
