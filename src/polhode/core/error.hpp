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
  InputError(std::string_view where, std::string_view what, std::string_view mend);

  [[nodiscard]] const std::string& where() const { return where_; }
  [[nodiscard]] const std::string& what_is_wrong() const { return what_; }
  [[nodiscard]] const std::string& mend() const { return mend_; }

 private:
  std::string where_, what_, mend_;
};

}  // namespace polhode
