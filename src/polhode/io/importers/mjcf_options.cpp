// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/importers/mjcf_options.hpp>

#include <map>
#include <string>

#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>

namespace polhode::io {

namespace {

using Element = XmlFile::Element;

/// Attributes of <option> and flags of a solver that is not ours.
constexpr const char* kSolverOptions[] = {
    "timestep",         "integrator",     "cone",          "jacobian",       "solver",
    "iterations",       "tolerance",      "ls_iterations", "ls_tolerance",   "noslip_iterations",
    "noslip_tolerance", "ccd_iterations", "ccd_tolerance", "sdf_iterations", "sdf_initpoints",
    "sleep_tolerance",  "impratio",       "o_margin",      "o_solref",       "o_solimp",
    "o_friction",       "magnetic",       "apirate",       "collision",      "mpr_iterations",
    "mpr_tolerance"};
constexpr const char* kSolverFlags[] = {
    "warmstart", "refsafe", "sensor",    "midphase", "eulerdamp",  "autoreset",
    "nativeccd", "island",  "energy",    "fwdinv",   "override",   "invdiscrete",
    "multiccd",  "sleep",   "diagexact", "ipc",      "speculative"};
constexpr const char* kPhysicsFlags[] = {"gravity", "constraint", "equality",     "frictionloss",
                                         "limit",   "contact",    "spring",       "damper",
                                         "passive", "clampctrl",  "filterparent", "actuation"};

}  // namespace

void read_options(MjcfFile& file, MjcfMedium& medium, Robot& robot, ImportOptions& options) {
  XmlFile& xml = file.xml;
  std::map<std::string, bool> on;
  std::vector<std::string> unread;
  const Element* first = nullptr;
  const auto of_solver = [&](const Element& e, const char* name, const char* what) {
    if (!xml.text(e, name)) return;
    if (first == nullptr) first = &e;
    unread.push_back(what + std::string(name));
  };
  for (const Element* e : file.sections("option")) {
    if (const auto g = xml.vector(*e, "gravity")) robot.gravity = *g;
    if (const auto value = xml.number(*e, "density")) medium.density = *value;
    if (const auto value = xml.number(*e, "viscosity")) medium.viscosity = *value;
    if (const auto wind = xml.vector(*e, "wind")) medium.wind = !wind->isZero(0.0);
    medium.at = e;
    if (const auto groups = xml.numbers(*e, "actuatorgroupdisable", 0, 31))
      file.flags.actuator_groups_off = *groups;
    for (const char* name : kSolverOptions) of_solver(*e, name, "");
    for (const Element* flag : xml.children(*e, "flag")) {
      for (const char* name : kSolverFlags) of_solver(*flag, name, "flag ");
      for (const char* name : kPhysicsFlags) {
        const auto word = xml.text(*flag, name);
        if (!word) continue;
        on[name] = *word != "disable";
        if (*word != "disable" && *word != "enable")
          xml.fault(*flag, format("'{}' of <flag> is {}", name, quote(*word)),
                    "Write enable or disable.");
      }
    }
  }
  if (!unread.empty())
    file.ignored.add(*first, format("<option> {}", name_list(unread, 12)),
                     "belongs to another solver");
  const auto is_on = [&](const char* name) {
    const auto found = on.find(name);
    return found == on.end() || found->second;
  };
  const bool constraints = is_on("constraint");
  file.flags.equality = constraints && is_on("equality");
  options.limits = options.limits && constraints && is_on("limit");
  options.friction = options.friction && constraints && is_on("frictionloss");
  file.flags.contact = constraints && is_on("contact");
  file.flags.springs = is_on("passive") && is_on("spring");
  file.flags.dampers = is_on("passive") && is_on("damper");
  file.flags.actuation = is_on("actuation");
  file.flags.control_bounds = is_on("clampctrl");
  file.flags.parents_do_not_touch = is_on("filterparent");
  if (!is_on("gravity")) robot.gravity.setZero();
  // Without springs and dampers MuJoCo leaves all passive forces out, those of the medium too.
  if (!file.flags.springs && !file.flags.dampers) medium.density = medium.viscosity = 0.0;
}

}  // namespace polhode::io
