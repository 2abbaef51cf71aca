// SPDX-License-Identifier: Apache-2.0
// Fixed and prescribed freedoms of rigid bodies, in all steps of a file or in some.
#include <algorithm>

#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>
#include <polhode/io/importers/feb_model.hpp>

namespace polhode::io {

namespace {

using Freedom = FebFreedom::Kind;
using Freedoms = std::array<FebFreedom, 6>;

constexpr const char* kFreedomNames[] = {"x", "y", "z", "rx", "ry", "rz"};

bool is_moved(const Freedoms& f) {
  return std::any_of(f.begin(), f.end(),
                     [](const FebFreedom& g) { return g.kind == Freedom::prescribed; });
}

/// Whether a rotation is prescribed as a whole, or fixed while the body is moved.
bool turns_as_prescribed(const Freedoms& f) {
  return is_moved(f) && std::none_of(f.begin() + 3, f.end(),
                                     [](const FebFreedom& g) { return g.kind == Freedom::free; });
}

/// Value of a freedom over time.
SourceNode freedom_node(FebModel& model, const FebFreedom& f, double factor = 1.0) {
  if (f.kind == Freedom::fixed) return model.curves.node(FebValue{});
  if (!f.by_step.empty()) return model.curves.node(*f.at, f.by_step, factor);
  return model.curves.node(f.value, factor);
}

/// Motion of the freedoms that are not free. @param turned  Whether the rotations are in it.
SourceNode motion_of(FebModel& model, const FebBody& body, const Freedoms& f, bool turned,
                     const NodeBuilder& make) {
  SourceNode motion = make.map();
  for (std::size_t k = 0; k < 3; ++k)
    if (f[k].kind != Freedom::free) make.put(motion, kFreedomNames[k], freedom_node(model, f[k]));
  if (!turned) return motion;
  const double degree = 3.14159265358979323846 / 180.0;
  SourceNode angles = make.list();
  for (std::size_t k = 3; k < 6; ++k)
    angles.children.push_back(freedom_node(model, f[k], body.euler ? degree : 1.0));
  if (body.euler) {
    SourceNode euler = make.map();
    make.put(euler, "sequence", make.text("XYZ"));
    make.put(euler, "angles", std::move(angles));
    make.put(motion, "euler", std::move(euler));
  } else {
    make.put(motion, "rotation_vector", std::move(angles));
  }
  return motion;
}

/// Freedoms that a joint to the ground takes, or a motion. @returns false after an error.
bool check_rotations(FebModel& model, const FebBody& body, const Freedoms& f) {
  const bool turned = turns_as_prescribed(f);
  int fixed = 0;
  for (std::size_t k = 3; k < 6; ++k) {
    if (f[k].kind == Freedom::prescribed && !turned) {
      model.file.refuse(*f[k].at, "a rotation is prescribed while another one is free",
                        "Fix or prescribe all of Ru, Rv, Rw, or use a joint.");
      return false;
    }
    if (f[k].kind == Freedom::fixed) ++fixed;
  }
  if (fixed == 1 && !turned)
    model.file.approximated(
        *body.at, format("one rotation of {} is fixed: an angle of its axes, where FEBio has a "
                         "component of the angular velocity",
                         quote(body.material)));
  return true;
}

/// A joint to the ground that takes freedoms. @returns its name.
std::string add_ground_joint(FebModel& model, const FebBody& body, const Freedoms& f,
                             const std::string& name) {
  const XmlFile::Element* at = body.at;
  for (const FebFreedom& g : f)
    if (g.at != nullptr) at = g.at;
  const NodeBuilder make = model.file.make(*at);
  SourceNode joint = make.map(), free = make.list();
  for (std::size_t k = 0; k < 6; ++k)
    if (f[k].kind == Freedom::free) free.children.push_back(make.text(kFreedomNames[k]));
  const bool all = free.children.empty();
  make.put(joint, "type", make.text(all ? "fixed" : "generic"));
  make.put(joint, "bodies", make.list({make.text("ground"), make.text(body.name)}));
  make.put(joint, "at", make.vector(body.com));
  make.put(joint, "axis", make.text("z"));
  make.put(joint, "x_axis", make.text("x"));
  if (!all) make.put(joint, "free", std::move(free));
  if (is_moved(f))
    make.put(joint, "motion", motion_of(model, body, f, turns_as_prescribed(f), make));
  return model.add_joint(*at, name, std::move(joint));
}

/// A freedom as it is in the first steps. @param count  Number of steps.
FebFreedom in_first_steps(const FebModel& model, const std::vector<Freedoms>& by_step,
                          std::size_t k, std::size_t count) {
  FebFreedom result = by_step[0][k];
  bool moved = false;
  for (std::size_t s = 0; s < count; ++s) {
    moved = moved || by_step[s][k].kind == Freedom::prescribed;
    if (by_step[s][k].kind == Freedom::prescribed) result.at = by_step[s][k].at;
  }
  if (!moved) return result;
  result.kind = Freedom::prescribed;
  result.by_step = model.spans([&](std::size_t s) -> std::optional<FebSpan> {
    const FebFreedom& f = by_step[s][k];
    if (s >= count) return FebSpan{0.0, 0.0, std::nullopt, false, true};
    if (f.kind != Freedom::prescribed) return std::nullopt;
    return FebSpan{0.0, 0.0, f.value, f.relative, false};
  });
  return result;
}

/// Whether one step fixes all freedoms.
bool fixes_all(const Freedoms& f) {
  return std::all_of(f.begin(), f.end(),
                     [](const FebFreedom& g) { return g.kind == Freedom::fixed; });
}

/// Whether a freedom is free.
bool is_free(const Freedoms& f) {
  return std::any_of(f.begin(), f.end(),
                     [](const FebFreedom& g) { return g.kind == Freedom::free; });
}

/// Freedoms of a body that some of the steps fix or prescribe.
void settle(FebModel& model, FebBody& body) {
  const std::size_t steps = model.steps.size();
  std::vector<Freedoms> by_step(steps, body.freedoms);
  for (const auto& [s, own] : body.in_step) {
    // A step that fixes a body that was free is a joint of its own, which holds it where it is.
    if (s > 0 && fixes_all(own) && is_free(by_step[s - 1])) {
      const std::string joint = add_ground_joint(model, body, own, body.name + "_fixed");
      model.steps[s].items.push_back(joint);
      continue;
    }
    for (std::size_t k = 0; k < 6; ++k)
      if (own[k].kind == Freedom::prescribed ||
          (own[k].kind == Freedom::fixed && by_step[s][k].kind == Freedom::free))
        by_step[s][k] = own[k];
  }
  std::map<std::size_t, Freedoms> until;  // By the number of steps in which they are not free.
  for (std::size_t k = 0; k < 6; ++k) {
    const auto free_in = [&](std::size_t s) { return by_step[s][k].kind == Freedom::free; };
    std::size_t count = 0;
    while (count < steps && !free_in(count)) ++count;
    for (std::size_t s = count; s < steps; ++s)
      if (!free_in(s)) {
        model.file.refuse(
            *by_step[s][k].at,
            format("{} of {} is free in one step and fixed or prescribed in a later one",
                   kFreedomNames[k], quote(body.material)),
            "Fix or prescribe it from the first step on, fix all six freedoms, or use a "
            "rigid_connector in this step.");
        return;
      }
    if (count > 0) until[count][k] = in_first_steps(model, by_step, k, count);
  }
  body.freedoms = until.contains(steps) ? until[steps] : Freedoms{};
  for (const auto& [count, freedoms] : until) {
    if (count == steps || !check_rotations(model, body, freedoms)) continue;
    const std::string joint =
        add_ground_joint(model, body, freedoms, format("{}_until_step{}", body.name, count + 1));
    model.steps[count].ended.push_back(joint);
  }
}

}  // namespace

void settle_feb_freedoms(FebModel& model) {
  for (FebBody& body : model.bodies)
    if (!body.in_step.empty()) settle(model, body);
}

void put_feb_freedoms(FebModel& model, const FebBody& body, const NodeBuilder& make,
                      SourceNode& node) {
  if (body.is_fixed()) {
    make.put(node, "fixed", make.boolean(true));
    return;
  }
  const Freedoms& f = body.freedoms;
  if (!check_rotations(model, body, f)) return;
  const bool moved = is_moved(f), turned = turns_as_prescribed(f);
  Freedoms rest;  // Held by a joint of their own: a body has `hold` or `motion`.
  SourceNode hold = make.list();
  for (std::size_t k = 0; k < 6; ++k) {
    if (f[k].kind == Freedom::free || (k < 3 && moved) || (k >= 3 && turned)) continue;
    hold.children.push_back(make.text(kFreedomNames[k]));
    rest[k] = f[k];
  }
  if (moved && !hold.children.empty())
    static_cast<void>(add_ground_joint(model, body, rest, body.name + "_hold"));
  else if (!hold.children.empty())
    make.put(node, "hold", std::move(hold));
  if (moved) make.put(node, "motion", motion_of(model, body, f, turned, make));
}

}  // namespace polhode::io
