// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <optional>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/dynamics/extrapolation.hpp>
#include <polhode/simulation/order_choice.hpp>
#include <polhode/simulation/smooth_model.hpp>

namespace polhode {

namespace {

/// Largest order of extrapolation, and that with a fixed step unless one is given.
constexpr int kHighest = 12, kWithFixedStep = 6;
/// Order of automatic steps by composition.
constexpr int kComposed = 6;

[[noreturn]] void refuse_order(int order, const std::string& why, const std::string& hint) {
  throw InputError("analysis.order", format("is {}, but {}", order, why), hint);
}

/// Settings of a model that bear on its order.
class Settings {
 public:
  Settings(const System& system, const Model& model)
      : system_(system), model_(model), a_(model.analysis) {}

  [[nodiscard]] OrderChoice choose() const;

 private:
  [[nodiscard]] OrderChoice extrapolation() const;
  [[nodiscard]] OrderChoice composition(int order) const;
  [[nodiscard]] OrderChoice by_tolerance() const;
  /// The highest order of extrapolation for which the model is smooth enough, if there is one.
  [[nodiscard]] std::optional<int> highest_order() const;
  [[nodiscard]] std::optional<NotSmooth> rough(int order) const {
    return not_smooth(model_, system_, order, !a_.step);
  }
  /// Whether a step forward and the same step backward cancel.
  [[nodiscard]] bool symmetric() const {
    return a_.rho_inf == 1.0 && a_.momentum_rate == "momentum";
  }
  /// Whether nothing takes energy or supplies it.
  [[nodiscard]] bool conserves() const { return !system_.dissipates() && system_.conservative(); }

  const System& system_;
  const Model& model_;
  const AnalysisSpec& a_;
};

std::optional<int> Settings::highest_order() const {
  for (int order = kHighest; order >= 4; order -= 2)
    if (!rough(order)) return order;
  return std::nullopt;
}

/// Extrapolation as it is asked for, or as the only way to the order asked for.
OrderChoice Settings::extrapolation() const {
  const auto refuse = [](const std::string& why, const std::string& hint) {
    throw InputError("analysis.method", format("is extrapolation, but {}", why), hint);
  };
  if (a_.rho_inf != 1.0)
    refuse(
        format("rho_inf is {:g}: only the step with rho_inf: 1 is symmetric in time", a_.rho_inf),
        "Set rho_inf: 1, or order: 2");
  if (a_.momentum_rate != "momentum")
    refuse("only the step with momentum_rate: momentum is symmetric in time",
           "Set momentum_rate: momentum, or order: 2");
  OrderChoice choice;
  choice.order = a_.order.value_or(kWithFixedStep);
  choice.extrapolated = true;
  static_cast<void>(extrapolation_substeps(choice.order));
  choice.varies = !a_.order && !a_.step;
  if (choice.varies) choice.order = highest_order().value_or(4);
  if (const auto part = rough(choice.order))
    refuse(format("{} {}", part->what, part->why), part->hint);
  return choice;
}

OrderChoice Settings::composition(int order) const {
  if (order != 4 && order != 6 && order != 8)
    refuse_order(order, "only 2, 4, 6 and 8 exist by composition", "Use one of them");
  if (a_.rho_inf != 1.0)
    refuse_order(order,
                 format("rho_inf is {:g}: stages backward in time would add the energy that the "
                        "others dissipate",
                        a_.rho_inf),
                 "Set rho_inf: 1, or order: 2");
  if (system_.dissipates())
    refuse_order(order, "the model has dampers: stages backward in time would add energy",
                 "Set method: extrapolation, or order: 2");
  if (a_.momentum_rate != "momentum")
    refuse_order(order, "only the step with momentum_rate: momentum is symmetric in time",
                 "Set momentum_rate: momentum, or order: 2");
  if (order == 4 && !a_.step)
    refuse_order(order, "automatic steps exist for orders 2, 6 and 8 by composition",
                 "Give a step, or use order: 6");
  OrderChoice choice;
  choice.order = order;
  return choice;
}

OrderChoice Settings::by_tolerance() const {
  const std::string goal = format("for the tolerance of {:g}", *a_.tolerance);
  const auto two = [&](const std::string& why) {
    OrderChoice choice;
    choice.reason = format("Order 2 with automatic steps, {}: {}.\n", goal, why);
    return choice;
  };
  if (!symmetric()) return two("higher orders need rho_inf: 1 and momentum_rate: momentum");
  const auto continuous = std::ranges::find_if(
      model_.controllers, [](const ControllerSpec& controller) { return !controller.sample; });
  if (continuous != model_.controllers.end())
    return two(format("the controller '{}' is continuous and acts at the ends of steps",
                      continuous->name));
  if (a_.method == "composition" ? !system_.dissipates() : conserves())
    return {.order = kComposed,
            .extrapolated = false,
            .varies = false,
            .reason = format("Order {} by composition with automatic steps, {}: nothing in the "
                             "model dissipates.\n",
                             kComposed, goal)};
  if (a_.method == "composition")
    return two("compositions of higher order need a model without dampers");
  const std::optional<int> order = highest_order();
  if (!order) {
    const auto part = rough(4);
    return two(format("{} {}", part->what, part->why));
  }
  return {
      .order = *order,
      .extrapolated = true,
      .varies = true,
      .reason = format("Orders 4 to {} by extrapolation with automatic steps, {}: the model {}.\n",
                       *order, goal, system_.dissipates() ? "dissipates" : "is driven")};
}

OrderChoice Settings::choose() const {
  if (a_.type != "dynamics") return {};
  const bool contacts = system_.contacts() != nullptr;
  if (a_.method == "extrapolation" && a_.order != 2) return extrapolation();
  if (!a_.order) {
    if (!a_.tolerance || a_.step || contacts) return {};
    return by_tolerance();
  }
  const int order = *a_.order;
  if (order == 2) return {};
  if (contacts)
    throw InputError("analysis.order",
                     format("is {}, but orders above 2 cannot be combined with contacts", order),
                     "Use order: 2 for this model");
  // What a composition cannot do, and is not refused by name.
  const bool composes = !system_.dissipates() && order <= 8 && (order > 4 || a_.step);
  if (a_.method != "automatic" || composes || !symmetric()) return composition(order);
  OrderChoice choice = extrapolation();
  choice.reason =
      format("Order {} by extrapolation: {}.\n", order,
             system_.dissipates() ? "the model dissipates" : "it does not exist by composition");
  return choice;
}

}  // namespace

std::string OrderChoice::text() const {
  if (order == 2) return "order 2";
  return format("{} by {}", varies ? format("orders 4 to {}", order) : format("order {}", order),
                extrapolated ? "extrapolation" : "composition");
}

OrderChoice choose_order(const System& system, const Model& model) {
  return Settings(system, model).choose();
}

}  // namespace polhode
