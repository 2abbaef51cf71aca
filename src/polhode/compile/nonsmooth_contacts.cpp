// SPDX-License-Identifier: Apache-2.0
#include <polhode/compile/nonsmooth_contacts.hpp>
#include <polhode/core/format.hpp>

namespace polhode {

ImpulseOptions impulse_options(const ContactsSpec& contacts) {
  ImpulseOptions options;
  options.rigid = contacts.rigid();
  if (contacts.sweeps > 0) options.sweeps = contacts.sweeps;
  if (contacts.sweep_tolerance > 0.0) options.tolerance = contacts.sweep_tolerance;
  return options;
}

void check_nonsmooth(const Model& model, std::vector<InputError>& faults) {
  if (!model.contacts.nonsmooth()) return;
  const auto refuse = [&](const std::string& where, const std::string& what, const char* other) {
    faults.emplace_back(where, what, format("Choose another contacts.default.law, or {}", other));
  };
  const auto holds = [&](const char* section, const std::string& name, const char* what) {
    refuse(format("{}.{}", section, name),
           format("{} in a model with the non-smooth contact law, which supports bodies with "
                  "contact and loads only",
                  what),
           "remove this");
  };
  if (!model.solids.empty()) holds("solids", model.solids.front().name, "is a deformable solid");
  if (!model.cables.empty()) holds("cables", model.cables.front().name, "is a cable");
  if (!model.beams.empty()) {
    holds("beams", model.beams.front().name, "is a beam");
  } else if (!model.joints.empty()) {
    holds("joints", model.joints.front().name, "is a joint");
  }
  const AnalysisSpec& a = model.analysis;
  if (a.type != "dynamics") return;  // bodies have no contact there
  if (!a.step)
    refuse("analysis.step", "is automatic, but the non-smooth law has no error estimate",
           "give a step");
  if (a.rho_inf != 1.0)
    refuse("analysis.rho_inf",
           format("is {:g}, but the non-smooth law uses the midpoint rule", a.rho_inf),
           "use rho_inf: 1");
  if (a.momentum_rate != "momentum")
    refuse("analysis.momentum_rate",
           format("is {}, but the non-smooth law uses the momentum form", a.momentum_rate),
           "use momentum_rate: momentum");
  if (a.solver != "automatic")
    refuse("analysis.solver", format("is {}, but the non-smooth law has its own solver", a.solver),
           "use solver: automatic");
}

void check_rigid(const Model& model, std::vector<InputError>& faults) {
  if (!model.contacts.rigid()) return;
  const auto refuse = [&](const std::string& where, const std::string& what, const char* hint) {
    faults.emplace_back(where, what, hint);
  };
  if (!model.solids.empty() || !model.cables.empty())
    refuse("contacts.default.law", "rigid is not available with deformable solids and cables yet",
           "Use law: barrier in this model");
  const AnalysisSpec& a = model.analysis;
  for (const JointSpec& joint : model.joints)
    for (const auto& [key, limits] :
         {std::pair("limits", joint.limits), std::pair("angle_limits", joint.angle_limits)}) {
      if (!limits || !(limits->band || limits->stiffness)) continue;
      refuse(format("joints.{}.{}.{}", joint.name, key, limits->band ? "band" : "stiffness"),
             "cannot be combined with the law rigid, with which stops do not give way",
             "Leave it out, or use law: barrier");
    }
  if (a.type != "dynamics") return;
  if (a.rho_inf != 1.0)
    refuse("analysis.rho_inf",
           format("is {:g}, but the law rigid uses the midpoint rule", a.rho_inf),
           "Use rho_inf: 1, or law: barrier");
  if (a.momentum_rate != "momentum")
    refuse("analysis.momentum_rate",
           format("is {}, but the law rigid uses the momentum form", a.momentum_rate),
           "Use momentum_rate: momentum, or law: barrier");
}

}  // namespace polhode
