// SPDX-License-Identifier: Apache-2.0
#include <polhode/view/glb.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>

#include <nlohmann/json.hpp>

#include <polhode/core/error.hpp>
#include <polhode/view/chunk.hpp>

namespace polhode {

namespace {

using Document = nlohmann::ordered_json;

constexpr int kFloat = 5126, kUnsigned = 5125;  // Component types of glTF, section 3.6.2.2.
constexpr std::array<std::array<double, 3>, 8> kPalette = {{{0.07, 0.24, 0.57},
                                                            {0.74, 0.35, 0.03},
                                                            {0.08, 0.36, 0.24},
                                                            {0.60, 0.16, 0.07},
                                                            {0.27, 0.20, 0.53},
                                                            {0.21, 0.47, 0.72},
                                                            {0.58, 0.47, 0.15},
                                                            {0.43, 0.14, 0.29}}};

/// Numbers of the file, and the views and accessors that refer to them.
class Numbers {
 public:
  Numbers(Document& views, Document& accessors) : views_(views), accessors_(accessors) {}

  std::size_t floats(const std::vector<float>& values, const char* type, std::size_t width,
                     bool bounds) {
    const std::size_t index =
        add(values.data(), 4 * values.size(), kFloat, type, values.size() / width);
    if (bounds) {
      std::vector<double> low(width, INFINITY), high(width, -INFINITY);
      for (std::size_t i = 0; i < values.size(); ++i) {
        low[i % width] = std::min(low[i % width], static_cast<double>(values[i]));
        high[i % width] = std::max(high[i % width], static_cast<double>(values[i]));
      }
      accessors_[index]["min"] = low;
      accessors_[index]["max"] = high;
    }
    return index;
  }
  std::size_t integers(const std::vector<std::uint32_t>& values) {
    return add(values.data(), 4 * values.size(), kUnsigned, "SCALAR", values.size());
  }
  [[nodiscard]] const std::string& bytes() const { return bytes_; }

 private:
  std::size_t add(const void* data, std::size_t size, int component, const char* type,
                  std::size_t count) {
    views_.push_back({{"buffer", 0}, {"byteOffset", bytes_.size()}, {"byteLength", size}});
    bytes_.append(static_cast<const char*>(data), size);
    accessors_.push_back({{"bufferView", views_.size() - 1},
                          {"componentType", component},
                          {"count", count},
                          {"type", type}});
    return accessors_.size() - 1;
  }

  Document &views_, &accessors_;
  std::string bytes_;
};

template <class Number>
std::vector<Number> numbers(const SceneData& scene, const Document& packed) {
  const std::size_t words = packed["n"].get<std::size_t>() * packed["w"].get<std::size_t>();
  std::vector<Number> values(words);
  if (words == 0) return values;
  const std::string bytes = unpack_words(scene.chunks[packed["c"].get<std::size_t>()], words,
                                         packed["w"].get<std::size_t>());
  std::memcpy(values.data(), bytes.data(), bytes.size());
  return values;
}

const Document* channel(const Document& manifest, const char* path) {
  for (const Document& c : manifest["channels"])
    if (c["path"] == path) return &c["data"];
  return nullptr;
}

/// Row of a body at each frame, out of all bodies; quaternions as x, y, z, w.
std::vector<float> rows(const std::vector<float>& all, std::size_t bodies, std::size_t body,
                        std::size_t width) {
  std::vector<float> values;
  for (std::size_t at = body * width; at < all.size(); at += bodies * width) {
    if (width == 3) {
      values.insert(values.end(), {all[at], all[at + 1], all[at + 2]});
      continue;
    }
    const std::array<double, 4> q = {all[at + 1], all[at + 2], all[at + 3], all[at]};
    const double size = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    for (double c : q) values.push_back(static_cast<float>(c / size));
  }
  return values;
}

std::string little_endian(std::uint32_t value) {
  std::string text;
  for (int b = 0; b < 4; ++b) text += static_cast<char>(value >> (8 * b));
  return text;
}

Document material_of(const std::array<double, 3>& color) {
  return {{"pbrMetallicRoughness",
           {{"baseColorFactor", {color[0], color[1], color[2], 1.0}},
            {"metallicFactor", 0.05},
            {"roughnessFactor", 0.6}}},
          {"doubleSided", true}};
}

/// Linear parts of red, green and blue of "#rrggbb", which is in sRGB (IEC 61966-2-1).
std::array<double, 3> linear_color(const std::string& text) {
  std::array<double, 3> color{};
  for (std::size_t k = 0; k < 3; ++k) {
    const double x = std::stoi(text.substr(1 + 2 * k, 2), nullptr, 16) / 255.0;
    color[k] = x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4);
  }
  return color;
}

std::string block(const char* type, std::string bytes, char filling) {
  bytes.resize((bytes.size() + 3) / 4 * 4, filling);
  return little_endian(static_cast<std::uint32_t>(bytes.size())) + std::string(type, 4) + bytes;
}

}  // namespace

std::string scene_glb(const SceneData& scene) {
  const Document m = Document::parse(scene.manifest);
  const Document *position = channel(m, "packed/bodies/position"),
                 *orientation = channel(m, "packed/bodies/orientation");
  if (position == nullptr || orientation == nullptr || m["meshes"].empty())
    throw InputError("glb", "there are no bodies with shapes in these results",
                     "Name results of a model with bodies");
  Document file = {{"asset", {{"version", "2.0"}, {"generator", "Polhode"}}},
                   {"scene", 0},
                   {"scenes", {{{"nodes", {0}}}}}};
  Document views = Document::array(), accessors = Document::array(), meshes = Document::array(),
           nodes = Document::array(), channels = Document::array(), samplers = Document::array(),
           materials = Document::array();
  Numbers data(views, accessors);
  for (const auto& color : kPalette) materials.push_back(material_of(color));
  std::vector<std::array<std::size_t, 2>> shapes;  // Accessors of points and corners.
  for (const Document& mesh : m["meshes"])
    shapes.push_back({data.floats(numbers<float>(scene, mesh["points"]), "VEC3", 3, true),
                      data.integers(numbers<std::uint32_t>(scene, mesh["triangles"]))});
  // glTF has y up; here it is opposite to gravity, z if there is none.
  const Document gravity = m.value("gravity", Document::array({0.0, 0.0, -1.0}));
  const bool y_up = std::abs(gravity[1].get<double>()) > std::abs(gravity[2].get<double>());
  Document root = {{"name", m["title"].get<std::string>().empty() ? "Model" : m["title"]}};
  if (!y_up) root["rotation"] = {-std::sqrt(0.5), 0.0, 0.0, std::sqrt(0.5)};
  nodes.push_back(root);

  const std::vector<float> r = numbers<float>(scene, *position),
                           q = numbers<float>(scene, *orientation);
  std::vector<float> time;
  for (double t : m["time"]) time.push_back(static_cast<float>(t));
  const bool moves = time.size() > 1;
  const std::size_t clock = moves ? data.floats(time, "SCALAR", 1, true) : 0;
  const std::size_t count = m["bodies"].size();
  Document children = Document::array();
  for (std::size_t i = 0; i < count; ++i) {
    const Document& body = m["bodies"][i];
    const Document parts = body.value("parts", Document::array());
    Document part_nodes = Document::array();
    const std::size_t own = nodes.size();
    nodes.push_back({{"name", body["name"]}});
    std::size_t material = i % kPalette.size();
    if (const auto color = body.find("color"); color != body.end()) {
      material = materials.size();
      materials.push_back(material_of(linear_color(*color)));
    }
    for (const Document& part : parts) {
      if (!part.contains("mesh")) continue;
      const auto& [points, corners] = shapes[part["mesh"].get<std::size_t>()];
      meshes.push_back({{"primitives",
                         {{{"attributes", {{"POSITION", points}}},
                           {"indices", corners},
                           {"material", material}}}}});
      Document node = {{"mesh", meshes.size() - 1}, {"translation", part["p"]}};
      if (part.contains("q"))
        node["rotation"] = {part["q"][1], part["q"][2], part["q"][3], part["q"][0]};
      part_nodes.push_back(nodes.size());
      nodes.push_back(std::move(node));
    }
    if (part_nodes.empty()) {
      nodes.erase(nodes.end() - 1);
      continue;
    }
    children.push_back(own);
    nodes[own]["children"] = part_nodes;
    const std::vector<float> place = rows(r, count, i, 3), turn = rows(q, count, i, 4);
    nodes[own]["translation"] = {place[0], place[1], place[2]};
    nodes[own]["rotation"] = {turn[0], turn[1], turn[2], turn[3]};
    if (!moves || body.value("fixed", false)) continue;
    const auto animate = [&](const std::vector<float>& values, const char* type, std::size_t width,
                             const char* what) {
      samplers.push_back({{"input", clock},
                          {"output", data.floats(values, type, width, false)},
                          {"interpolation", "LINEAR"}});
      channels.push_back(
          {{"sampler", samplers.size() - 1}, {"target", {{"node", own}, {"path", what}}}});
    };
    animate(place, "VEC3", 3, "translation");
    animate(turn, "VEC4", 4, "rotation");
  }
  if (children.empty())
    throw InputError("glb", "no body of these results has a shape that ends",
                     "Name results of a model with bodies");
  nodes[0]["children"] = children;
  file["nodes"] = nodes;
  file["meshes"] = meshes;
  file["materials"] = materials;
  file["accessors"] = accessors;
  file["bufferViews"] = views;
  file["buffers"] = {{{"byteLength", data.bytes().size()}}};
  if (!channels.empty())
    file["animations"] = {{{"name", "motion"}, {"channels", channels}, {"samplers", samplers}}};
  const std::string body = block("JSON", file.dump(), ' ') + block("BIN\0", data.bytes(), '\0');
  return "glTF" + little_endian(2) + little_endian(static_cast<std::uint32_t>(12 + body.size())) +
         body;
}

}  // namespace polhode
