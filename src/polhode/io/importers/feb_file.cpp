// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/importers/feb_file.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>

#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>

namespace polhode::io {

namespace {

constexpr const char* kBetween = " \t\r\n,";
/// Whole numbers that one list may have.
constexpr std::size_t kMostIntegers = 5'000'000;

/// Parts of a text between blanks and commas.
std::vector<std::string_view> parts_of(std::string_view text, const char* between = kBetween) {
  std::vector<std::string_view> parts;
  while (true) {
    const std::size_t begin = text.find_first_not_of(between);
    if (begin == std::string_view::npos) return parts;
    text.remove_prefix(begin);
    const std::size_t end = std::min(text.find_first_of(between), text.size());
    parts.push_back(text.substr(0, end));
    text.remove_prefix(end);
  }
}

template <class T>
std::optional<T> whole_text(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  T value{};
  const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (text.empty() || fault != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

std::optional<double> finite(std::string_view text) {
  const auto value = whole_text<double>(text);
  return value && std::isfinite(*value) ? value : std::nullopt;
}

}  // namespace

std::string lower_case(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

void FebFile::refuse(const Element& at, const std::string& what, const std::string& hint) {
  xml.skip(at);
  if (options.allow_partial)
    notes.push_back({ImportNote::Kind::left_out, xml.place(at), what});
  else
    xml.fault(at, what, hint + " Or allow a partial import.");
}

void FebFile::approximated(const Element& at, std::string what) {
  notes.push_back({ImportNote::Kind::approximated, xml.place(at), std::move(what)});
}

std::vector<const FebFile::Element*> FebFile::children(const Element& parent) {
  std::vector<const Element*> list;
  for (const Element* e = parent.FirstChildElement(); e != nullptr; e = e->NextSiblingElement()) {
    xml.mark_read(*e);
    list.push_back(e);
  }
  return list;
}

const FebFile::Element* FebFile::child(const Element& parent, const char* tag) {
  const Element* found = xml.child(parent, tag);
  if (found != nullptr && found->NextSiblingElement(tag) != nullptr) {
    const Element& second = *found->NextSiblingElement(tag);
    xml.mark_read(second);
    xml.fault(second, format("<{}> stands twice in <{}>", tag, parent.Name()), "Keep one of them.");
  }
  return found;
}

std::string FebFile::text(const Element& parent, const char* tag) {
  const Element* e = child(parent, tag);
  return e == nullptr ? "" : XmlFile::content(*e).value_or("");
}

std::string FebFile::type(const Element& e) { return lower_case(xml.required_text(e, "type")); }

std::optional<std::vector<double>> FebFile::numbers(const Element& e, std::size_t least,
                                                    std::size_t most) {
  if (const auto given = xml.text(e, "type");
      given && lower_case(*given) != "const" && lower_case(*given) != "vector") {
    refuse(e, format("<{}> is a function of type {}", e.Name(), quote(*given)),
           "Give numbers, with a load controller for their course over time.");
    return std::nullopt;
  }
  const std::string text = XmlFile::content(e).value_or("");
  std::vector<double> list;
  bool sound = true;
  for (const std::string_view part : parts_of(text)) {
    const auto value = finite(part);
    sound = sound && value;
    if (value) list.push_back(*value);
  }
  if (sound && list.size() >= least && list.size() <= most) return list;
  const std::string shown = text.size() > 60 ? text.substr(0, 60) + "..." : text;
  xml.fault(e,
            format("<{}> is {}, not {}", e.Name(), quote(shown),
                   most == 1 ? "a number" : format("{} numbers", least)),
            "Give finite numbers.");
  return std::nullopt;
}

std::optional<double> FebFile::number(const Element& parent, const char* tag) {
  const Element* e = child(parent, tag);
  if (e == nullptr) return std::nullopt;
  refuse_controller(*e);
  const auto list = numbers(*e, 1, 1);
  return list ? std::optional((*list)[0]) : std::nullopt;
}

std::optional<Vec3> FebFile::vector(const Element& parent, const char* tag) {
  const Element* e = child(parent, tag);
  if (e == nullptr) return std::nullopt;
  refuse_controller(*e);
  const auto list = numbers(*e, 3, 3);
  return list ? std::optional(Vec3((*list)[0], (*list)[1], (*list)[2])) : std::nullopt;
}

Vec3 FebFile::direction(const Element& parent, const char* tag, const Vec3& standard) {
  const auto given = vector(parent, tag);
  if (!given) return standard;
  const double largest = given->cwiseAbs().maxCoeff();
  if (largest > 0.0) return (*given / largest).normalized();
  xml.fault(*xml.child(parent, tag), format("<{}> has no length", tag), "Give a direction.");
  return standard;
}

bool FebFile::boolean(const Element& parent, const char* tag, bool standard) {
  const Element* e = child(parent, tag);
  if (e == nullptr) return standard;
  const std::string word = lower_case(XmlFile::content(*e).value_or(""));
  if (word == "1" || word == "true") return true;
  if (word == "0" || word == "false") return false;
  xml.fault(*e, format("<{}> is {}, not 0 or 1", tag, quote(word)), "Write 0 or 1.");
  return standard;
}

void FebFile::skip_all(const Element& parent, std::initializer_list<const char*> tags) {
  for (const char* tag : tags)
    for (const Element* e : xml.children(parent, tag)) xml.skip(*e);
}

void FebFile::refuse_controller(const Element& e) {
  if (const auto number = controller(e))
    refuse(e, format("<{}> changes by the load controller {}", e.Name(), *number),
           "Give a constant.");
}

std::optional<int> FebFile::controller(const Element& e) {
  const auto text = xml.text(e, "lc");
  if (!text) return std::nullopt;
  const auto number = whole_text<int>(*text);
  if (!number)
    xml.fault(e, format("'lc' is {}, not the number of a load controller", quote(*text)),
              "Give the id of a load_controller.");
  else if (*number > 0)
    return number;
  return std::nullopt;
}

FebValue FebFile::value(const Element& parent, const char* tag, double standard) {
  const Element* e = child(parent, tag);
  if (e == nullptr) return {standard, std::nullopt, nullptr};
  const auto list = numbers(*e, 1, 1);
  return {list ? (*list)[0] : standard, controller(*e), e};
}

std::array<FebValue, 3> FebFile::vector_value(const Element& parent, const char* tag) {
  std::array<FebValue, 3> values;
  const Element* e = child(parent, tag);
  if (e == nullptr) return values;
  const auto list = numbers(*e, 3, 3);
  const auto lc = controller(*e);
  for (std::size_t k = 0; k < 3; ++k) values[k] = {list ? (*list)[k] : 0.0, lc, e};
  return values;
}

std::vector<std::int64_t> FebFile::integers(const Element& e) {
  std::vector<std::int64_t> list;
  const std::string text = XmlFile::content(e).value_or("");
  const auto fault = [&](std::string_view part) {
    xml.fault(e, format("{} in <{}> is no whole number", quote(std::string(part)), e.Name()),
              "Give whole numbers, such as 1,2,5:8.");
  };
  for (const std::string_view part : parts_of(text)) {
    const auto ends = parts_of(part, ":");
    std::int64_t range[3] = {0, 0, 1};
    bool sound = !ends.empty() && ends.size() <= 3 && part.back() != ':';
    for (std::size_t k = 0; sound && k < ends.size(); ++k) {
      const auto value = whole_text<std::int64_t>(ends[k]);
      sound = value.has_value() && *value >= 0 && *value <= INT32_MAX;
      if (sound) range[k] = *value;
    }
    if (!sound || range[2] < 1) {
      fault(part);
      return list;
    }
    if (ends.size() == 1) range[1] = range[0];
    for (std::int64_t k = range[0]; k <= range[1]; k += range[2]) {
      list.push_back(k);
      if (list.size() > kMostIntegers) {
        xml.fault(e, format("<{}> has more than {} numbers", e.Name(), kMostIntegers),
                  "Check its ranges.");
        return {};
      }
    }
  }
  return list;
}

std::optional<std::int64_t> FebFile::id(const Element& e, const char* key) {
  const std::string text = xml.required_text(e, key);
  if (text.empty()) return std::nullopt;
  const auto value = whole_text<std::int64_t>(text);
  if (value && *value >= 0) return value;
  xml.fault(e, format("'{}' is {}, not a whole number", key, quote(text)),
            "Give a number from 1 on.");
  return std::nullopt;
}

std::string FebFile::name(const Element& e, const std::string& wanted,
                          std::set<std::string>& taken) {
  const std::string allowed = allowed_name(wanted);
  std::string chosen = allowed;
  for (int k = 2; !taken.insert(chosen).second; ++k) chosen = format("{}_{}", allowed, k);
  if (chosen != wanted)
    approximated(e, format("{} is called {} in the model", quote(wanted), quote(chosen)));
  return chosen;
}

}  // namespace polhode::io
