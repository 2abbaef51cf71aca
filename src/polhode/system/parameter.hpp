// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <optional>
#include <string>

namespace polhode {

/// A number that a kind of joint or load takes beside its frames or points: what the reader
/// accepts, what the reference page tells.
struct Parameter {
  std::string name;                ///< Key in the model file.
  std::string unit;                ///< SI, such as "N/m"; "-" for none.
  std::optional<double> standard;  ///< Value when left out; nothing: see `meaning`.
  double least = -std::numeric_limits<double>::infinity();  ///< Smallest value allowed.
  double most = std::numeric_limits<double>::infinity();    ///< Largest value allowed.
  std::string meaning;  ///< One line, with what holds when it is left out.
};

}  // namespace polhode
