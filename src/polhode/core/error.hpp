// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

namespace polhode {

/// The model or an argument is wrong, and the user can mend it.
///
/// The message has three parts, always in this order: where, what (with the
/// value that was given and its unit), and how to mend it.
class InputError : public std::invalid_argument {
 public:
  InputError(std::string_view where, std::string_view what, std::string_view hint);

  [[nodiscard]] const std::string& where() const { return where_; }
  [[nodiscard]] const std::string& what_is_wrong() const { return what_; }
  [[nodiscard]] const std::string& hint() const { return hint_; }

 private:
  std::string where_, what_, hint_;
};

/// Equations of a model that cannot be solved: a matrix that is too large or has no inverse, an
/// eigenvalue problem that does not converge. Nobody's fault; the message says what to try.
class SolveError : public std::runtime_error {
 public:
  /// Reads "what. hint."
  SolveError(std::string_view what, std::string_view hint);
};

}  // namespace polhode
