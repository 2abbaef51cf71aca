// SPDX-License-Identifier: Apache-2.0
#include <cctype>
#include <map>

#include <polhode/io/importers/feb_curves.hpp>

namespace polhode::io {

namespace {

/// Names of FEBio and of a model file.
const std::map<std::string, std::string, std::less<>>& names() {
  static const std::map<std::string, std::string, std::less<>> list{
      {"t", "t"},       {"pi", "pi"},       {"PI", "pi"},       {"sin", "sin"},   {"cos", "cos"},
      {"tan", "tan"},   {"asin", "asin"},   {"acos", "acos"},   {"atan", "atan"}, {"sinh", "sinh"},
      {"cosh", "cosh"}, {"tanh", "tanh"},   {"exp", "exp"},     {"ln", "log"},    {"log", "log10"},
      {"sqrt", "sqrt"}, {"abs", "abs"},     {"sgn", "sign"},    {"max", "max"},   {"min", "min"},
      {"H", "step"},    {"floor", "floor"}, {"atan2", "atan2"}, {"pow", "pow"}};
  return list;
}

}  // namespace

std::string expression_of_feb(const std::string& text, std::string& unknown) {
  std::string out;
  std::vector<bool> steps;  // By open bracket: whether it is that of a step.
  bool next_is_step = false;
  const auto letter = [](char c) {
    return std::isalpha(static_cast<unsigned char>(c)) || c == '_';
  };
  const auto digit = [](char c) { return std::isdigit(static_cast<unsigned char>(c)) || c == '.'; };
  for (std::size_t k = 0; k < text.size();) {
    std::size_t end = k + 1;
    if (letter(text[k])) {
      while (end < text.size() &&
             (letter(text[end]) || std::isdigit(static_cast<unsigned char>(text[end]))))
        ++end;
      const auto found = names().find(std::string_view(text).substr(k, end - k));
      if (found == names().end()) {
        unknown = text.substr(k, end - k);
        return "";
      }
      next_is_step = found->first == "H";
      out += found->second;
    } else if (digit(text[k])) {
      while (end < text.size() && digit(text[end])) ++end;
      if (end < text.size() && (text[end] == 'e' || text[end] == 'E')) {
        std::size_t power = end + 1;
        if (power < text.size() && (text[power] == '+' || text[power] == '-')) ++power;
        if (power < text.size() && std::isdigit(static_cast<unsigned char>(text[power]))) {
          while (power < text.size() && std::isdigit(static_cast<unsigned char>(text[power])))
            ++power;
          end = power;
        }
      }
      out += text.substr(k, end - k);
    } else if (text[k] == '(') {
      steps.push_back(next_is_step);
      next_is_step = false;
      out += '(';
    } else if (text[k] == ')') {
      if (!steps.empty()) {
        if (steps.back()) out += ", 0";
        steps.pop_back();
      }
      out += ')';
    } else if (std::string_view("+-*/^, \t\r\n").find(text[k]) != std::string_view::npos) {
      out += std::isspace(static_cast<unsigned char>(text[k])) ? ' ' : text[k];
    } else {
      unknown = text.substr(k, 1);
      return "";
    }
    k = end;
  }
  return out;
}

}  // namespace polhode::io
