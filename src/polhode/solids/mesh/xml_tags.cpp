// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <utility>

#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>
#include <polhode/solids/mesh/xml_tags.hpp>

namespace polhode::solids {
namespace {

constexpr std::string_view kXmlBlanks = " \t\r\n";
constexpr std::string_view kEndOfName = " \t\r\n/>=<\"'";

std::string decoded(std::string_view text) {
  static constexpr std::array<std::pair<std::string_view, char>, 5> kEntities{
      {{"&lt;", '<'}, {"&gt;", '>'}, {"&amp;", '&'}, {"&quot;", '"'}, {"&apos;", '\''}}};
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    char c = text[i];
    std::size_t length = 1;
    for (const auto& [entity, meaning] : kEntities)
      if (c == '&' && text.substr(i).starts_with(entity)) {
        c = meaning;
        length = entity.size();
        break;
      }
    result += c;
    i += length - 1;
  }
  return result;
}

}  // namespace

const std::string& XmlTag::operator[](std::string_view attribute) const {
  static const std::string kNone;
  const auto found = attributes.find(attribute);
  return found == attributes.end() ? kNone : found->second;
}

XmlTag XmlTags::next() {
  const std::string_view all = in_.bytes();
  while (true) {
    const std::size_t begin = all.find('<', in_.at());
    if (begin == std::string_view::npos) {
      in_.go_to(all.size());
      return {};
    }
    const std::string_view rest = all.substr(begin);
    const char* end = rest.starts_with("<!--") ? "-->" : rest.starts_with("<?") ? "?>" : nullptr;
    if (!end && rest.starts_with("<!")) end = ">";
    if (!end) {
      in_.go_to(begin + 1);
      break;
    }
    const std::size_t found = all.find(end, begin);
    if (found == std::string_view::npos) in_.refuse_end(end, false);
    in_.go_to(found + 1);
  }
  XmlTag tag;
  tag.at = in_.at() - 1;
  if (all.substr(in_.at()).starts_with('/')) {
    tag.closes = true;
    in_.go_to(in_.at() + 1);
  }
  std::size_t end = all.find_first_of(kEndOfName, in_.at());
  if (end == std::string_view::npos) in_.refuse_end("the end of a tag", false);
  tag.name = all.substr(in_.at(), end - in_.at());
  in_.go_to(end);
  while (true) {
    const std::size_t begin = all.find_first_not_of(kXmlBlanks, in_.at());
    if (begin == std::string_view::npos) in_.refuse_end("the end of a tag", false);
    in_.go_to(begin);
    if (all[begin] == '>') {
      in_.go_to(begin + 1);
      return tag;
    }
    if (all.substr(begin).starts_with("/>")) {
      tag.empty = true;
      in_.go_to(begin + 2);
      return tag;
    }
    end = all.find_first_of(kEndOfName, begin);
    if (end == std::string_view::npos || end == begin)
      in_.refuse("an attribute is expected here", kExportMeshAgain);
    const std::string name(all.substr(begin, end - begin));
    in_.go_to(end);
    tag.attributes[name] = attribute_value();
  }
}

std::string XmlTags::attribute_value() {
  const std::string_view all = in_.bytes();
  std::size_t at = all.find_first_not_of(kXmlBlanks, in_.at());
  if (at != std::string_view::npos && all[at] == '=') {
    at = all.find_first_not_of(kXmlBlanks, at + 1);
    if (at != std::string_view::npos && (all[at] == '"' || all[at] == '\'')) {
      const std::size_t end = all.find(all[at], at + 1);
      if (end == std::string_view::npos) in_.refuse_end("a quote", false);
      in_.go_to(end + 1);
      return decoded(all.substr(at + 1, end - at - 1));
    }
  }
  in_.refuse("an attribute has no value in quotes", kExportMeshAgain);
}

std::string_view XmlTags::text() {
  const std::string_view all = in_.bytes();
  const std::size_t begin = in_.at();
  std::size_t end = all.find('<', begin);
  if (end == std::string_view::npos) end = all.size();
  in_.go_to(end);
  return all.substr(begin, end - begin);
}

void XmlTags::skip(const XmlTag& tag) {
  if (tag.empty || tag.closes) return;
  int depth = 1;
  while (depth > 0) {
    const XmlTag inner = next();
    if (inner.name.empty()) in_.refuse_end(format("</{}>", tag.name), false);
    if (inner.name != tag.name) continue;
    if (inner.closes)
      --depth;
    else if (!inner.empty)
      ++depth;
  }
}

}  // namespace polhode::solids
