// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>
#include <vector>

#include <polhode/loads/load_description.hpp>
#include <polhode/system/parameter.hpp>

namespace polhode {

/// Object of a kind of load, which determines its entries in the model file.
enum class LoadPlace {
  body,     ///< A body, at a point: `body`, `at` or `at_body`.
  axis,     ///< An axis fixed in a body: `body`, `axis` or `axis_body`.
  points,   ///< Two points of two bodies: `bodies`, `at` or `at_body`.
  joint,    ///< The freedom of a joint: `joint`.
  joints,   ///< Free coordinates of two joints: `joints`.
  row,      ///< Free coordinates of any number of joints: `joints`, `factors`.
  surface,  ///< Two points of two bodies and axes on the first one.
  frames,   ///< Two frames of two bodies: `bodies`, `at` or `at_body`, `axis`.
  curves,   ///< Likewise, with an x axis on the second one.
  wheel,    ///< A point of a plane and the centre of a wheel, normal and axle.
  centres   ///< The centres of mass of two bodies: `bodies`.
};

/// A quantity reported by a load at an instant: one number, or a vector along the world's axes.
struct LoadChannel {
  std::string name;  ///< e.g. "length".
  std::string unit;  ///< As text for people, e.g. "m/s".
  int size = 1;      ///< 1 or 3.
};

/// A function of a coordinate or its rate of a kind of load.
struct LawParameter {
  std::string name;      ///< Key in the model file.
  std::string unit;      ///< Of the value, SI.
  std::string variable;  ///< x for a coordinate, v for a rate.
  std::string of;        ///< Unit of the variable, SI.
  std::string meaning;   ///< One line.
};

/// A choice of a kind of load, one word out of a list.
struct ChoiceParameter {
  std::string name;
  std::vector<std::string> choices;  ///< The first one is the default.
  std::string meaning;               ///< One line.
};

/// A type of load in the model file.
struct LoadKind {
  std::string name;     ///< "type" in the model file.
  std::string meaning;  ///< One line.
  LoadPlace place = LoadPlace::body;
  std::string vector;  ///< Key of its vector: force [N] or moment [N m]; "" for none.
  std::vector<Parameter> parameters;
  std::vector<TimeParameter> drives;  ///< One of them is given.
  bool turns = false;  ///< Exerts a moment even at the centre of mass; on a body, needs no point.
  void (*add)(System&, const LoadDescription&) = nullptr;
  std::vector<LoadChannel> channels;  ///< Reported quantities, see report.
  /// Values of the channels in order, for an item of its group and a step that ends at the instant.
  /// Forces and moments are those on body b.
  std::vector<double> (*report)(const InteractionGroup&, int item, const PairStep&) = nullptr;
  std::vector<LawParameter> laws{};
  std::vector<ChoiceParameter> words{};
  std::vector<Parameter> vectors{};   ///< Of three numbers each.
  std::vector<Parameter> matrices{};  ///< Of six rows of six numbers each, SI.
  /// Parameters, laws, vectors and matrices of which at least one must be given.
  std::vector<std::string> needs_one_of{};
  /// Prefixes of its curves in the plane of x and y: their `points` become the laws curve_x and
  /// curve_y, the value period, and the value open, 1 for a curve with ends.
  std::vector<std::string> curves{};
  /// Interactions of its group that a load makes, beside those of its further coordinates.
  int parts = 1;
  bool switches = true;  ///< Whether events may switch it.

  [[nodiscard]] int report_size() const;  ///< Number of values in a report.
  /// Key of a force or moment given in code as a function of the motion; "" for none.
  [[nodiscard]] std::string function_key() const;
};

/// Every load type; the order is that of the documentation.
[[nodiscard]] const std::vector<LoadKind>& load_kinds();

/// The load type of this name. @throws InputError that lists the names if it is unknown.
[[nodiscard]] const LoadKind& load_kind(std::string_view name);

}  // namespace polhode
