// SPDX-License-Identifier: Apache-2.0
#include <polhode/geometry/read_collada.hpp>

#include <charconv>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <unordered_map>

#include <tinyxml2.h>
#include <Eigen/Geometry>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>

namespace polhode::geometry {

namespace {

using Tag = tinyxml2::XMLElement;
using Transform = Eigen::Affine3d;

/// Nodes of a scene one in the other, all nodes, and triangles of all of them, at most. A short
/// file may have many, as instances are nested.
constexpr int kDeepestNode = 200;
constexpr std::size_t kMostNodes = 1'000'000, kMostTriangles = 20'000'000;
constexpr const char* kWriteAgain = "Export the file again, or convert it to STL or OBJ";

/// Reader of one document.
class Collada {
 public:
  Collada(const std::string& name, const Tag& root) : name_(name) {
    list_ids(root);
    if (const Tag* asset = root.FirstChildElement("asset"))
      if (const Tag* unit = asset->FirstChildElement("unit"))
        if (const char* meter = unit->Attribute("meter")) {
          const auto values = numbers(*unit, meter);
          if (values.size() != 1 || !(values[0] > 0.0))
            refuse(*unit, format("the unit '{}' is no length", meter));
          unit_ = values[0];
        }
    const Tag* scene = scene_of(root);
    if (scene != nullptr)
      add_content(*scene, Transform::Identity(), 0);
    else
      for (const Tag* library = root.FirstChildElement("library_geometries"); library != nullptr;
           library = library->NextSiblingElement("library_geometries"))
        for (const Tag* e = library->FirstChildElement("geometry"); e != nullptr;
             e = e->NextSiblingElement("geometry"))
          add_geometry(*e, Transform::Identity());
  }

  TriangleSurface take() { return std::move(surface_); }

 private:
  [[noreturn]] void refuse(const Tag& at, const std::string& what) const {
    throw InputError(format("{}:{}", name_, at.GetLineNum()), what, kWriteAgain);
  }

  void list_ids(const Tag& e) {
    if (const char* id = e.Attribute("id")) ids_.emplace(id, &e);
    for (const Tag* inner = e.FirstChildElement(); inner != nullptr;
         inner = inner->NextSiblingElement())
      list_ids(*inner);
  }

  /// Tag that an attribute "#id" of another one names.
  const Tag& named(const Tag& e, const char* attribute) const {
    const char* given = e.Attribute(attribute);
    const std::string id = given != nullptr && *given == '#' ? given + 1 : "";
    const auto found = ids_.find(id);
    if (found != ids_.end()) return *found->second;
    refuse(e, format("<{}> names '{}', which is not in the file", e.Name(),
                     given == nullptr ? "" : given));
  }

  /// The scene that is shown, otherwise the first one; null if there is none.
  const Tag* scene_of(const Tag& root) const {
    if (const Tag* scene = root.FirstChildElement("scene"))
      if (const Tag* shown = scene->FirstChildElement("instance_visual_scene"))
        return &named(*shown, "url");
    const Tag* library = root.FirstChildElement("library_visual_scenes");
    return library == nullptr ? nullptr : library->FirstChildElement("visual_scene");
  }

  std::vector<double> numbers(const Tag& at, const char* text) const {
    std::vector<double> list;
    const char* end = text + std::char_traits<char>::length(text);
    const auto is_blank = [](char c) { return c == ' ' || c == '\n' || c == '\t' || c == '\r'; };
    while (true) {
      while (text != end && is_blank(*text)) ++text;
      if (text == end) return list;
      if (*text == '+') ++text;
      double value = 0.0;
      const auto [next, fault] = std::from_chars(text, end, value);
      if (fault != std::errc() || (next != end && !is_blank(*next)) || !std::isfinite(value))
        refuse(at, format("<{}> has something that is not a finite number", at.Name()));
      list.push_back(value);
      text = next;
    }
  }
  std::vector<double> numbers(const Tag& e) const {
    const char* text = e.GetText();
    return text == nullptr ? std::vector<double>{} : numbers(e, text);
  }
  std::vector<double> numbers(const Tag& e, std::size_t count) const {
    std::vector<double> list = numbers(e);
    if (list.size() != count)
      refuse(e, format("<{}> has {} numbers, not {}", e.Name(), list.size(), count));
    return list;
  }
  /// A whole number of an attribute, or its standard value.
  std::size_t whole(const Tag& e, const char* attribute, std::size_t standard) const {
    const char* text = e.Attribute(attribute);
    if (text == nullptr) return standard;
    const auto list = numbers(e, text);
    if (list.size() != 1 || list[0] < 0.0 || list[0] > 1e9 || list[0] != std::floor(list[0]))
      refuse(e, format("'{}' of <{}> is no count", attribute, e.Name()));
    return static_cast<std::size_t>(list[0]);
  }

  /// A tag of a node that moves its content; nothing if it is another one.
  std::optional<Transform> motion(const Tag& e) const {
    const std::string_view kind = e.Name();
    Transform T = Transform::Identity();
    if (kind == "matrix") {
      const auto m = numbers(e, 16);
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 4; ++j) T(i, j) = m[static_cast<std::size_t>(4 * i + j)];
    } else if (kind == "translate") {
      const auto v = numbers(e, 3);
      T.translation() = Vec3(v[0], v[1], v[2]);
    } else if (kind == "rotate") {
      const auto v = numbers(e, 4);
      const Vec3 axis(v[0], v[1], v[2]);
      if (axis.norm() > 0.0)
        T.linear() = Eigen::AngleAxisd(v[3] * std::numbers::pi / 180.0, axis.normalized())
                         .toRotationMatrix();
    } else if (kind == "scale") {
      const auto v = numbers(e, 3);
      T.linear() = Vec3(v[0], v[1], v[2]).asDiagonal();
    } else if (kind == "skew" || kind == "lookat") {
      refuse(e, format("<{}> of a node is not read", kind));
    } else {
      return std::nullopt;
    }
    return T;
  }

  /// Adds what a node or scene contains. @param frame  Where it stands, in the scene.
  void add_content(const Tag& e, Transform frame, int depth) {
    if (depth > kDeepestNode || ++nodes_ > kMostNodes)
      refuse(e, "the nodes contain each other, or too many");
    for (const Tag* inner = e.FirstChildElement(); inner != nullptr;
         inner = inner->NextSiblingElement()) {
      const std::string_view kind = inner->Name();
      if (const auto moved = motion(*inner))
        frame = frame * *moved;
      else if (kind == "node")
        add_content(*inner, frame, depth + 1);
      else if (kind == "instance_node")
        add_content(named(*inner, "url"), frame, depth + 1);
      else if (kind == "instance_geometry")
        add_geometry(named(*inner, "url"), frame);
      else if (kind == "instance_controller")
        refuse(*inner, "a geometry that bones deform is not read");
    }
  }

  void add_geometry(const Tag& e, const Transform& frame) {
    const Tag* mesh = e.FirstChildElement("mesh");
    if (mesh == nullptr) {
      if (e.FirstChildElement("convex_mesh") != nullptr || e.FirstChildElement("spline") != nullptr)
        refuse(e, "a geometry without a <mesh> is not read");
      return;
    }
    std::map<const Tag*, std::size_t> first;  // Number of the first point by <vertices>.
    for (const Tag* part = mesh->FirstChildElement(); part != nullptr;
         part = part->NextSiblingElement()) {
      const std::string_view kind = part->Name();
      if (kind == "triangles" || kind == "trifans" || kind == "tristrips" || kind == "polylist" ||
          kind == "polygons")
        add_part(*part, kind, frame, first);
    }
  }

  /// Adds the points of <vertices> once for each geometry of the scene.
  std::size_t add_points(const Tag& vertices, const Transform& frame,
                         std::map<const Tag*, std::size_t>& first) {
    const auto [entry, is_new] = first.try_emplace(&vertices, surface_.points.size());
    if (!is_new) return entry->second;
    for (const Tag* input = vertices.FirstChildElement("input"); input != nullptr;
         input = input->NextSiblingElement("input")) {
      const char* semantic = input->Attribute("semantic");
      if (semantic == nullptr || std::string_view(semantic) != "POSITION") continue;
      const Tag& source = named(*input, "source");
      const Tag* common = source.FirstChildElement("technique_common");
      const Tag* accessor = common == nullptr ? nullptr : common->FirstChildElement("accessor");
      const Tag* array = source.FirstChildElement("float_array");
      if (accessor == nullptr || array == nullptr)
        refuse(source, "the source of points has no <float_array> or <accessor>");
      const std::vector<double> values = numbers(*array);
      const std::size_t stride = whole(*accessor, "stride", 1),
                        from = whole(*accessor, "offset", 0), count = whole(*accessor, "count", 0);
      if (stride < 3 || (count > 0 && from + (count - 1) * stride + 3 > values.size()))
        refuse(*accessor,
               format("{} points are declared, but there are {} numbers", count, values.size()));
      if (surface_.points.size() + count > 3 * kMostTriangles)
        refuse(*accessor, format("there are more than {} points", 3 * kMostTriangles));
      for (std::size_t i = 0; i < count; ++i) {
        const double* x = values.data() + from + i * stride;
        surface_.points.push_back(unit_ * (frame * Vec3(x[0], x[1], x[2])));
        if (!surface_.points.back().allFinite())
          refuse(*array, "a point of the scene is too far away");
      }
      return entry->second;
    }
    refuse(vertices, "<vertices> has no input of POSITION");
  }

  void add_part(const Tag& part, std::string_view kind, const Transform& frame,
                std::map<const Tag*, std::size_t>& first) {
    std::size_t place = 0, stride = 1;
    const Tag* vertices = nullptr;
    for (const Tag* input = part.FirstChildElement("input"); input != nullptr;
         input = input->NextSiblingElement("input")) {
      const std::size_t offset = whole(*input, "offset", 0);
      stride = std::max(stride, offset + 1);
      const char* semantic = input->Attribute("semantic");
      if (semantic == nullptr || std::string_view(semantic) != "VERTEX") continue;
      place = offset;
      vertices = &named(*input, "source");
    }
    if (vertices == nullptr) refuse(part, format("<{}> has no input of VERTEX", kind));
    if (part.FirstChildElement("ph") != nullptr) refuse(part, "polygons with holes are not read");
    const std::size_t base = add_points(*vertices, frame, first);
    const std::size_t count = surface_.points.size() - base;
    const bool mirrored = frame.linear().determinant() < 0.0;
    std::vector<double> sizes;
    if (kind == "polylist")
      if (const Tag* lengths = part.FirstChildElement("vcount")) sizes = numbers(*lengths);
    for (const Tag* p = part.FirstChildElement("p"); p != nullptr; p = p->NextSiblingElement("p")) {
      const std::vector<double> values = numbers(*p);
      if (values.size() % stride != 0)
        refuse(*p, format("<p> has {} numbers, no multiple of {}", values.size(), stride));
      std::vector<int> corners;
      for (std::size_t k = place; k < values.size(); k += stride) {
        const double v = values[k];
        if (!(v >= 0.0) || v >= static_cast<double>(count) || v != std::floor(v))
          refuse(*p, format("point {} is used, but there are {} points", v, count));
        corners.push_back(static_cast<int>(base + static_cast<std::size_t>(v)));
      }
      add_polygons(*p, kind, corners, sizes, mirrored);
    }
  }

  void add_polygons(const Tag& p, std::string_view kind, const std::vector<int>& corners,
                    const std::vector<double>& sizes, bool mirrored) {
    const auto add = [&](std::size_t a, std::size_t b, std::size_t c) {
      if (mirrored) std::swap(b, c);
      surface_.triangles.push_back({corners[a], corners[b], corners[c]});
      if (surface_.triangles.size() > kMostTriangles)
        refuse(p, format("there are more than {} triangles", kMostTriangles));
    };
    const auto fan = [&](std::size_t begin, std::size_t size) {
      for (std::size_t k = 2; k < size; ++k) add(begin, begin + k - 1, begin + k);
    };
    if (kind == "triangles") {
      if (corners.size() % 3 != 0) refuse(p, "the corners are no whole triangles");
      for (std::size_t k = 0; k < corners.size(); k += 3) fan(k, 3);
    } else if (kind == "tristrips") {
      for (std::size_t k = 2; k < corners.size(); ++k)
        k % 2 == 0 ? add(k - 2, k - 1, k) : add(k - 1, k - 2, k);
    } else if (kind == "polylist") {
      std::size_t begin = 0;
      for (const double size : sizes) {
        if (size < 0.0 || size != std::floor(size) ||
            size > static_cast<double>(corners.size() - begin))
          refuse(p, "<vcount> is of other polygons than <p>");
        fan(begin, static_cast<std::size_t>(size));
        begin += static_cast<std::size_t>(size);
      }
      if (begin != corners.size()) refuse(p, "<vcount> is of other polygons than <p>");
    } else {
      fan(0, corners.size());
    }
  }

  const std::string& name_;
  double unit_ = 1.0;
  std::size_t nodes_ = 0;
  std::unordered_map<std::string, const Tag*> ids_;
  TriangleSurface surface_;
};

}  // namespace

TriangleSurface parse_collada(const std::string& name, std::string_view text) {
  tinyxml2::XMLDocument document;
  if (document.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS ||
      document.RootElement() == nullptr)
    throw InputError(format("{}:{}", name, std::max(1, document.ErrorLineNum())),
                     "the text is not XML", kWriteAgain);
  const Tag& root = *document.RootElement();
  if (std::string_view(root.Name()) != "COLLADA")
    throw InputError(format("{}:{}", name, root.GetLineNum()),
                     format("the file's tag is <{}>, not <COLLADA>", root.Name()), kWriteAgain);
  return Collada(name, root).take();
}

}  // namespace polhode::geometry
