// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/importers/ignored_tags.hpp>

#include <polhode/core/format.hpp>

namespace polhode::io {

void IgnoredTags::attributes(const Element& element, std::initializer_list<const char*> names) {
  for (const char* name : names) static_cast<void>(xml_.text(element, name));
}

void IgnoredTags::skip(const Element& parent, std::initializer_list<const char*> tags) {
  for (const char* tag : tags) {
    for (const Element* e : xml_.children(parent, tag)) {
      xml_.skip(*e);
      add(*e, format("<{}> in <{}>", tag, parent.Name()), "has no influence on the motion");
    }
  }
}

void IgnoredTags::add(const SourceLocation& place, const std::string& what,
                      const std::string& why) {
  const auto [found, is_new] = kinds_.try_emplace(what, Kind{notes_.size(), 1});
  if (is_new) {
    notes_.push_back({ImportNote::Kind::ignored, place, what + " " + why});
    return;
  }
  notes_[found->second.note].what = format("{} {} ({} times)", what, why, ++found->second.times);
}

void IgnoredTags::add_unread() {
  for (const XmlFile::Unread& u : xml_.unread()) add(u.place, u.what, "is unknown");
}

}  // namespace polhode::io
