// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/importers/xml_file.hpp>

#include <charconv>
#include <cmath>
#include <filesystem>
#include <functional>

#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>
#include <polhode/io/importers/xml_parts.hpp>
#include <polhode/io/text/file_error.hpp>

namespace polhode::io {

namespace {

constexpr const char* kBlanks = " \t\r\n";

/// A finite number that is the whole text; nothing otherwise.
std::optional<double> number_of(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  if (text.starts_with('+') || (text.starts_with('-') && text.substr(1).starts_with('+')))
    return std::nullopt;
  double value = 0.0;
  const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (fault != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
    return std::nullopt;
  return value;
}

/// Whether a document type has declarations of entities.
bool declares_entities(std::string_view text) {
  return text.find("<!ENTITY") != std::string_view::npos;
}

}  // namespace

XmlFile::XmlFile(std::shared_ptr<const SourceText> source, Diagnostics& diagnostics)
    : source_(std::move(source)),
      diagnostics_(diagnostics),
      document_(std::make_unique<tinyxml2::XMLDocument>()) {
  const std::string& text = source_->text();
  const auto refuse = [&](int line, std::string what, std::string hint) {
    diagnostics_.add(place(line), "", std::move(what), std::move(hint));
    diagnostics_.throw_if_any();
  };
  if (text.size() > kMostXmlBytes)
    refuse(1, format("the file has {} bytes, more than {}", text.size(), kMostXmlBytes),
           "Build a model of this size in code.");
  if (text.find_first_not_of(kBlanks) == std::string::npos)
    refuse(0, "the file is empty", "Give a file with a model.");
  if (declares_entities(text)) {
    const auto at = static_cast<std::ptrdiff_t>(text.find("<!ENTITY"));
    refuse(1 + static_cast<int>(std::count(text.begin(), text.begin() + at, '\n')),
           "declarations of entities are not allowed", "Write the text out where it is used.");
  }
  if (text.find('\0') != std::string::npos || !is_utf8(text))
    refuse(1, "the text is not UTF-8", "Save the file as UTF-8.");
  const auto refuse_text = [&](const tinyxml2::XMLDocument& document) {
    std::string name = tinyxml2::XMLDocument::ErrorIDToName(document.ErrorID());
    for (char& c : name) c = c == '_' ? ' ' : static_cast<char>(std::tolower(c));
    if (name.starts_with("xml error ")) name.erase(0, 10);
    refuse(std::max(1, document.ErrorLineNum()), "the text is not XML: " + name,
           "Check the tag here and those above: each must be closed, and the file complete.");
  };
  if (document_->Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS) {
    if (document_->ErrorID() != tinyxml2::XML_ELEMENT_DEPTH_EXCEEDED) refuse_text(*document_);
    const int line = std::max(1, document_->ErrorLineNum());
    const auto parts = xml_parts(text);
    if (!parts)
      refuse(line, format("tags are nested more than {} deep", kDeepestXml),
             "No model needs that; look for a tag that is not closed.");
    parts_.push_back(source_);
    std::vector<bool> used(parts->size(), false);
    const std::function<void(tinyxml2::XMLNode&)> graft = [&](tinyxml2::XMLNode& parent) {
      for (tinyxml2::XMLNode* node = parent.FirstChild(); node != nullptr;
           node = node->NextSibling()) {
        Element* e = node->ToElement();
        if (e == nullptr) continue;
        if (std::string_view(e->Name()) == kPartTag) {
          const auto number = static_cast<std::size_t>(std::max(0, e->IntAttribute("number", 0)));
          if (number == 0 || number >= parts->size() || used[number])
            refuse(e->GetLineNum(), format("the tag <{}> is not allowed", kPartTag), "Remove it.");
          used[number] = true;
          tinyxml2::XMLDocument part;
          if (part.Parse((*parts)[number].data(), (*parts)[number].size()) != tinyxml2::XML_SUCCESS)
            refuse_text(part);
          tinyxml2::XMLNode* copy =
              parent.InsertAfterChild(node, part.RootElement()->DeepClone(document_.get()));
          locate_part(*copy, *part.RootElement());
          parent.DeleteChild(node);
          node = copy;
        }
        graft(*node);
      }
    };
    if (document_->Parse(parts->front().data(), parts->front().size()) != tinyxml2::XML_SUCCESS)
      refuse_text(*document_);
    graft(*document_);
  }
  root_ = document_->RootElement();
  if (root_ == nullptr) refuse(1, "the file has no tag", "Give a file with a model.");
  read_.insert(root_);
  bytes_ = text.size();
}

SourceLocation XmlFile::place(const SourceText& source, int line) {
  const std::string_view text = source.line(line);
  const std::size_t column = text.find_first_not_of(kBlanks);
  return {source.name(), line,
          line == 0 ? 0 : 1 + static_cast<int>(column == std::string_view::npos ? 0 : column)};
}

SourceLocation XmlFile::place(const Element& element) const {
  const auto found = included_.find(&element);
  return found == included_.end() ? place(element.GetLineNum())
                                  : place(*parts_[found->second.part], found->second.own_line);
}

int XmlFile::line(const Element& element) const {
  const auto found = included_.find(&element);
  return found == included_.end() ? element.GetLineNum() : found->second.line;
}

const XmlFile::Element* XmlFile::parse_included(const Element& at, const std::string& name,
                                                std::string text, tinyxml2::XMLDocument& part) {
  bytes_ += text.size();
  const bool sound = bytes_ <= kMostXmlBytes && !declares_entities(text) && is_utf8(text) &&
                     part.Parse(text.data(), text.size()) == tinyxml2::XML_SUCCESS &&
                     part.RootElement() != nullptr;
  if (!sound) {
    fault(at, format("the included file {} is not XML, or too large", quote(name)),
          "Check it, or leave it out.");
    return nullptr;
  }
  parts_.push_back(std::make_shared<SourceText>(name, std::move(text)));
  diagnostics_.know(parts_.back());
  return part.RootElement();
}

void XmlFile::locate(const tinyxml2::XMLNode& copy, const tinyxml2::XMLNode& original, int line) {
  if (copy.ToElement() != nullptr)
    included_[copy.ToElement()] = {line, parts_.size() - 1, original.GetLineNum()};
  const auto* below = original.FirstChild();
  for (const auto* node = copy.FirstChild(); node != nullptr; node = node->NextSibling()) {
    locate(*node, *below, line);
    below = below->NextSibling();
  }
}

void XmlFile::locate_part(const tinyxml2::XMLNode& copy, const tinyxml2::XMLNode& original) {
  if (copy.ToElement() != nullptr)
    included_[copy.ToElement()] = {original.GetLineNum(), 0, original.GetLineNum()};
  const auto* below = original.FirstChild();
  for (const auto* node = copy.FirstChild(); node != nullptr; node = node->NextSibling()) {
    locate_part(*node, *below);
    below = below->NextSibling();
  }
}

const XmlFile::Element* XmlFile::include_below(const Element& at, const std::string& path,
                                               const std::string& name) {
  tinyxml2::XMLDocument part;
  const Element* root = nullptr;
  try {
    root = parse_included(at, name, read_file(path), part);
  } catch (const FileError&) {
    fault(at, format("there is no file {} to include", quote(name)), "Check its name.");
  }
  if (root == nullptr) return nullptr;
  // Tags are handed out as const, but the document belongs to this object.
  auto* parent = const_cast<Element*>(&at);
  const tinyxml2::XMLNode* copy = parent->InsertEndChild(root->DeepClone(document_.get()));
  locate(*copy, *root, line(at));
  read_.insert(copy->ToElement());
  return copy->ToElement();
}

void XmlFile::include_files(const std::string& folder) {
  const std::function<void(tinyxml2::XMLElement&)> search = [&](tinyxml2::XMLElement& parent) {
    for (tinyxml2::XMLNode* node = parent.FirstChild(); node != nullptr;) {
      tinyxml2::XMLElement* e = node->ToElement();
      if (e != nullptr && std::string_view(e->Name()) == "include") {
        node = include_file(*e, folder);
        continue;
      }
      if (e != nullptr) search(*e);
      node = node->NextSibling();
    }
  };
  search(*document_->RootElement());
}

/// Puts the content of a file in the place of its tag. @returns what comes first there.
tinyxml2::XMLNode* XmlFile::include_file(tinyxml2::XMLElement& include, const std::string& folder) {
  tinyxml2::XMLNode* parent = include.Parent();
  tinyxml2::XMLNode* last = &include;
  const int at = line(include);
  // Not noted as read: the tag is deleted, and another one may get its place in memory.
  const char* given = include.Attribute("file");
  const std::string name = given == nullptr ? "" : given;
  const std::string path = (std::filesystem::path(folder) / name).string();
  const auto insert = [&](std::string text) {
    tinyxml2::XMLDocument part;
    const Element* root = parse_included(include, name, std::move(text), part);
    if (root == nullptr) return;
    for (const tinyxml2::XMLNode* child = root->FirstChild(); child != nullptr;
         child = child->NextSibling()) {
      last = parent->InsertAfterChild(last, child->DeepClone(document_.get()));
      locate(*last, *child, at);
    }
  };
  if (name.empty()) {
    fault(include, "<include> has no 'file'", "Write <include file=\"...\"/>.");
  } else {
    if (!included_files_.insert(path).second)
      fault(include, format("the file {} is included twice", quote(name)), "Include it once.");
    else
      try {
        insert(read_file(path));
      } catch (const FileError&) {
        fault(include, format("there is no file {} to include", quote(name)),
              "Names are relative to the folder of the model.");
      }
  }
  tinyxml2::XMLNode* first = include.NextSibling();
  parent->DeleteChild(&include);
  return first;
}

void XmlFile::fault(const Element& element, std::string what, std::string hint) {
  diagnostics_.add(place(element), "", std::move(what), std::move(hint));
}

const XmlFile::Element* XmlFile::child(const Element& parent, const char* name) {
  const Element* found = parent.FirstChildElement(name);
  if (found != nullptr) read_.insert(found);
  return found;
}

std::vector<const XmlFile::Element*> XmlFile::children(const Element& parent, const char* name) {
  std::vector<const Element*> list;
  for (const Element* e = parent.FirstChildElement(name); e != nullptr;
       e = e->NextSiblingElement(name)) {
    read_.insert(e);
    list.push_back(e);
  }
  return list;
}

void XmlFile::skip(const Element& element) {
  read_.insert(&element);
  for (const auto* a = element.FirstAttribute(); a != nullptr; a = a->Next()) read_.insert(a);
  for (const Element* e = element.FirstChildElement(); e != nullptr; e = e->NextSiblingElement())
    skip(*e);
}

std::optional<std::string> XmlFile::text(const Element& element, const char* attribute) {
  const tinyxml2::XMLAttribute* found = element.FindAttribute(attribute);
  if (found == nullptr) return std::nullopt;
  read_.insert(found);
  return found->Value();
}

std::string XmlFile::required_text(const Element& element, const char* attribute) {
  const auto value = text(element, attribute);
  if (!value || value->empty())
    fault(element, format("<{}> has no '{}'", element.Name(), attribute),
          format("Write <{} {}=\"...\"/>.", element.Name(), attribute));
  return value.value_or("");
}

std::optional<std::vector<double>> XmlFile::numbers(const Element& element, const char* attribute,
                                                    std::size_t least, std::size_t most) {
  const auto value = text(element, attribute);
  if (!value) return std::nullopt;
  return numbers_in(element, format("'{}' of <{}>", attribute, element.Name()), *value, least,
                    most);
}

std::optional<std::vector<double>> XmlFile::content_numbers(const Element& element,
                                                            std::size_t least, std::size_t most) {
  const auto value = content(element);
  if (!value) return std::nullopt;
  return numbers_in(element, format("<{}>", element.Name()), *value, least, most);
}

std::optional<std::string> XmlFile::content(const Element& element) {
  const tinyxml2::XMLNode* node = element.FirstChild();
  while (node != nullptr && node->ToText() == nullptr) node = node->NextSibling();
  const std::string_view all = node == nullptr ? "" : node->Value();
  const std::size_t first = all.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return std::nullopt;
  return std::string(all.substr(first, all.find_last_not_of(kBlanks) - first + 1));
}

std::optional<std::vector<double>> XmlFile::numbers_in(const Element& element,
                                                       const std::string& what,
                                                       const std::string& text, std::size_t least,
                                                       std::size_t most) {
  std::vector<double> list;
  std::string_view rest = text;
  bool sound = true;
  while (sound && rest.find_first_not_of(kBlanks) != std::string_view::npos) {
    rest.remove_prefix(rest.find_first_not_of(kBlanks));
    const std::size_t end = std::min(rest.find_first_of(kBlanks), rest.size());
    const auto number = number_of(rest.substr(0, end));
    sound = number.has_value();
    if (sound) list.push_back(*number);
    rest.remove_prefix(end);
  }
  if (sound && list.size() >= least && list.size() <= most) return list;
  const std::string wanted = most == 1       ? "a number"
                             : least == most ? format("{} numbers", most)
                                             : format("{} to {} numbers", least, most);
  fault(element, format("{} is {}, not {}", what, quote(text), wanted),
        most == 1       ? "Give a finite number."
        : least == most ? format("Give {} finite numbers.", most)
                        : format("Give {} to {} finite numbers.", least, most));
  return std::nullopt;
}

std::optional<double> XmlFile::number(const Element& element, const char* attribute) {
  const auto list = numbers(element, attribute, 1, 1);
  return list ? std::optional((*list)[0]) : std::nullopt;
}

std::optional<Vec3> XmlFile::vector(const Element& element, const char* attribute) {
  const auto list = numbers(element, attribute, 3, 3);
  return list ? std::optional(Vec3((*list)[0], (*list)[1], (*list)[2])) : std::nullopt;
}

void XmlFile::list_unread(const Element& element, std::vector<Unread>& list) const {
  for (const auto* a = element.FirstAttribute(); a != nullptr; a = a->Next())
    if (!read_.contains(a) && !std::string_view(a->Name()).starts_with("xmlns"))
      list.push_back(
          {place(element), format("attribute {} of <{}>", quote(a->Name()), element.Name())});
  for (const Element* e = element.FirstChildElement(); e != nullptr; e = e->NextSiblingElement()) {
    if (read_.contains(e))
      list_unread(*e, list);
    else
      list.push_back({place(*e), format("<{}> in <{}>", e->Name(), element.Name())});
  }
}

std::vector<XmlFile::Unread> XmlFile::unread() const {
  std::vector<Unread> list;
  list_unread(*root_, list);
  return list;
}

}  // namespace polhode::io
