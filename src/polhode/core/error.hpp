// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

namespace polhode {

/// Error of the model or an argument that the user can correct.
///
/// The message has three parts, always in this order: where, what (with the value that was given
/// and its unit), and a hint how to correct it.
class InputError : public std::invalid_argument {
 public:
  InputError(std::string_view where, std::string_view what, std::string_view hint);

  [[nodiscard]] const std::string& where() const { return where_; }
  [[nodiscard]] const std::string& what_is_wrong() const { return what_; }
  [[nodiscard]] const std::string& hint() const { return hint_; }

 private:
  std::string where_, what_, hint_;
};

/// Equations of a model that cannot be solved: a matrix that is too large or singular, an
/// eigenvalue problem that does not converge. The message contains a hint what to try.
class SolveError : public std::runtime_error {
 public:
  /// The text is "what. hint."
  SolveError(std::string_view what, std::string_view hint);
};

}  // namespace polhode
