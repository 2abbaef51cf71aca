// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <optional>
#include <string>

namespace polhode {

/// A numerical parameter of a kind of joint or load besides its frames or points, as accepted by
/// the reader and listed on the reference page.
struct Parameter {
  std::string name;                                         ///< Key in the model file.
  std::string unit;                                         ///< SI, such as "N/m"; "-" for none.
  std::optional<double> standard;                           ///< Default; none: see `meaning`.
  double least = -std::numeric_limits<double>::infinity();  ///< Minimum.
  double most = std::numeric_limits<double>::infinity();    ///< Maximum.
  std::string meaning;  ///< One line, including the default behaviour.
};

/// A function of time of a kind of load.
struct TimeParameter {
  std::string name;     ///< Key in the model file.
  std::string unit;     ///< SI.
  std::string meaning;  ///< One line.
};

}  // namespace polhode
