// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <initializer_list>
#include <string>

#include <tinyxml2.h>

#include <polhode/io/exporters/export_notes.hpp>
#include <polhode/model/model.hpp>

namespace polhode::io {

/// The shortest text that reads as the same number; "0" also for −0.
[[nodiscard]] std::string number_text(double x);
/// Numbers with spaces between them.
[[nodiscard]] std::string numbers_text(std::initializer_list<double> list);
[[nodiscard]] std::string vector_text(const Vec3& x);

/// Roll, pitch, yaw about fixed axes of R = Rz(yaw) Ry(pitch) Rx(roll), exact to rounding at
/// pitches of ±90 degrees, too.
[[nodiscard]] Vec3 rpy_of_rotation(const Mat3& R);

/// The colour "#rrggbb" of a body as "r g b 1" between 0 and 1; "" if it has none.
[[nodiscard]] std::string colour_text(const std::string& colour);

/// Path of a file as seen from the folder of another file.
[[nodiscard]] std::string path_from(const std::string& file, const std::string& path);

/// Title of a model, or the name of the file without its ending.
[[nodiscard]] std::string title_of(const Model& model, const std::string& file);

/// A tag of an XML file, closed at the end of its scope.
class XmlTag {
 public:
  XmlTag(tinyxml2::XMLPrinter& out, const char* name) : out_(out) { out_.OpenElement(name); }
  ~XmlTag() { out_.CloseElement(); }
  XmlTag(const XmlTag&) = delete;
  XmlTag& operator=(const XmlTag&) = delete;

  XmlTag& put(const char* attribute, const std::string& text) {
    out_.PushAttribute(attribute, text.c_str());
    return *this;
  }
  XmlTag& put(const char* attribute, double x) { return put(attribute, number_text(x)); }
  XmlTag& put(const char* attribute, const Vec3& x) { return put(attribute, vector_text(x)); }

 private:
  tinyxml2::XMLPrinter& out_;
};

}  // namespace polhode::io
