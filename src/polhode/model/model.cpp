// SPDX-License-Identifier: Apache-2.0
#include <string_view>

#include <polhode/base/error.hpp>
#include <polhode/base/format.hpp>
#include <polhode/model/model.hpp>

namespace polhode {

namespace {

template <class Spec>
int index_of(const std::vector<Spec>& specs, const std::string& name, const char* what,
             std::string names) {
  for (std::size_t i = 0; i < specs.size(); ++i) {
    if (specs[i].name == name) return static_cast<int>(i);
    names += (names.empty() ? "" : ", ") + specs[i].name;
  }
  throw InputError(
      what == std::string_view("body") ? "bodies" : "joints", format("unknown {} '{}'", what, name),
      names.empty() ? format("The model has no {}", what) : format("Use one of: {}", names));
}

}  // namespace

int Model::body_index(const std::string& name) const {
  return name == "ground" ? kGround : index_of(bodies, name, "body", "ground");
}

int Model::joint_index(const std::string& name) const {
  return index_of(joints, name, "joint", "");
}

}  // namespace polhode
