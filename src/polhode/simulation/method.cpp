// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <thread>

#include <polhode/beams/slide_on_beam.hpp>
#include <polhode/compile/contact_law_choice.hpp>
#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/core/threads.hpp>
#include <polhode/engines/contact_cg_engine.hpp>
#include <polhode/engines/nonsmooth_engine.hpp>
#include <polhode/engines/sparse_engine.hpp>
#include <polhode/engines/tree_engine.hpp>
#include <polhode/engines/unilateral_rows.hpp>
#include <polhode/model/endless.hpp>
#include <polhode/simulation/method.hpp>
#include <polhode/simulation/order_choice.hpp>
#include <polhode/surface_contact/edge_contact.hpp>
#include <polhode/surface_contact/surface_contact.hpp>
#include <polhode/system/barrier_constraint.hpp>

namespace polhode {

namespace {

/// Newton tolerances. Higher orders resolve smaller errors; in solids the remaining error of a step
/// excites many vibrations.
constexpr double kToleranceBodies = 1e-5, kToleranceSolids = 1e-6, kToleranceHighOrder = 1e-7;
constexpr double kToleranceExtrapolated = 1e-9;
/// Likewise for extrapolated automatic steps: this part of their tolerance, within the bounds.
constexpr double kPartOfTolerance = 1e-3, kLeastOfTolerance = 1e-12, kMostOfTolerance = 1e-7;
/// Iteration limits: for bodies and joints, and for solids, which may reuse a factorisation.
constexpr int kIterations = 12, kIterationsSolids = 30;
/// With surfaces of solids in contact: their forces follow from tiny displacements.
constexpr double kToleranceSurfaces = 1e-9;
/// With points that slide along beams: their positions are the rows of constraints.
constexpr double kToleranceSlides = 1e-10;
/// With cables among them: the rounding of the length of a stiff segment moves light nodes
/// sideways.
constexpr double kToleranceCables = 1e-7;
/// With contact, whose stiffness turns a small error of a gap into a large error of the force.
constexpr double kToleranceContact = 1e-12;
constexpr int kIterationsContact = 40;
/// Number of bodies coupled only by contact from which on conjugate gradients are used.
constexpr int kManyBodies = 50;
/// Default tolerance of automatic steps.
constexpr double kDefaultError = 1e-6;
/// Number of bodies from which on a run takes all processors.
constexpr int kBodiesForThreads = 40;
/// Number of loops open at one body below which the tree elimination is always faster.
constexpr int kFewOpenLoops = 6;
/// Ratio of the operation rates of the tree elimination and the block LU.
constexpr double kTreeAdvantage = 2.5;

JacobianPolicy jacobian_policy(const std::string& word) {
  if (word == "automatic") return JacobianPolicy::automatic;
  if (word == "every_iteration") return JacobianPolicy::every_iteration;
  if (word == "every_step") return JacobianPolicy::every_step;
  if (word == "never") return JacobianPolicy::never;
  throw InputError("analysis.jacobian", format("'{}' is not known", word),
                   "Use one of: automatic, every_iteration, every_step, never");
}

/// Number of threads: the model's, that of all runs, or one for each processor where members of an
/// extrapolated step take much longer than handing them over.
int number_of_threads(const System& system, const AnalysisSpec& a) {
  if (a.threads) return *a.threads;
  if (threads_of_runs() > 0) return threads_of_runs();
  if (system.body_count() < kBodiesForThreads) return 1;
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

/// Newton tolerance of extrapolated steps: that of automatic ones follows theirs.
double extrapolated_tolerance(const AnalysisSpec& a) {
  if (a.step || !a.tolerance) return kToleranceExtrapolated;
  return std::clamp(kPartOfTolerance * *a.tolerance, kLeastOfTolerance, kMostOfTolerance);
}

/// Whether surfaces of solids may be in contact.
bool has_surfaces(const System& system) {
  for (int g = 0; g < system.nodes().group_count(); ++g)
    if (system.nodes().group(g).barrier_constraint()) return true;
  return false;
}

/// Whether points slide along beams: exact constraints, whose multipliers need converged positions.
bool has_slides(const System& system) {
  for (int g = 0; g < system.nodes().group_count(); ++g)
    if (as_slide(system.nodes().group(g))) return true;
  return false;
}

bool has_touching_cables(const System& system) {
  for (int g = 0; g < system.nodes().group_count(); ++g) {
    const std::string kind = system.nodes().group(g).kind();
    if (kind == surface_contact::kCableContact || kind == surface_contact::EdgeContact::kCablesKind)
      return true;
  }
  return false;
}

/// Whether bodies are connected by beams or cables, which are loops for the tree.
bool has_elastic_pairs(const System& system) {
  for (const InteractionRef& ref : system.interactions())
    if (ref.rows == 0 && ref.a != kGround && ref.b != kGround && system.traits(ref).reach > 0.0)
      return true;
  return false;
}

/// The law of contacts, and why they are not rows where the model could have been given them.
std::string contact_narration(const System& system, const Model& model) {
  if (!model.contacts.present || model.contacts.nonsmooth()) return {};
  if (UnilateralRows::of(system))
    return "Contacts: rows of the step, as exact as joints (law rigid).\n";
  const ContactLawChoice choice = choose_contact_law(model);
  if (choice.law == "rigid") return {};
  return format("Contacts: forces (law {}), {}.\n", model.contacts.standard.potential,
                choice.reason);
}

std::unique_ptr<NewtonEngine> choose_engine(const System& system, const AnalysisSpec& a,
                                            MomentumRate rate, JacobianPolicy policy,
                                            std::string& narration) {
  const bool tree_fits = rate == MomentumRate::momentum && policy != JacobianPolicy::every_step &&
                         policy != JacobianPolicy::never;
  if (a.solver == "tree" && !tree_fits)
    throw InputError(
        "analysis.solver",
        "'tree' needs momentum_rate: momentum, and jacobian: automatic or every_iteration",
        "Use solver: block_lu with this momentum_rate or jacobian");
  if (NonsmoothEngine::has_impulses(system)) {
    narration += "Solver: impulses by projected Gauss-Seidel, as contacts are non-smooth.\n";
    return std::make_unique<NonsmoothEngine>(system);
  }
  if (system.contacts()) {
    if (a.solver == "tree")
      throw InputError("analysis.solver", "'tree' does not support contacts",
                       "Use solver: automatic, block_lu, klu or sparse_lu");
    if (a.solver == "automatic" && !UnilateralRows::of(system) && rate == MomentumRate::momentum &&
        a.rho_inf == 1.0 && ContactCgEngine::suits(system) &&
        ContactCgEngine::free_bodies(system) >= kManyBodies) {
      narration += format("Solver: conjugate gradients, as contact alone couples {} bodies.\n",
                          ContactCgEngine::free_bodies(system));
      return std::make_unique<ContactCgEngine>(
          system, a.newton_tolerance > 0.0 ? a.newton_tolerance : ContactCgEngine::kResidual);
    }
  }
  const bool rows = UnilateralRows::of(system);
  if (rows && a.solver == "tree")
    throw InputError("analysis.solver", "'tree' does not support stops with the law rigid",
                     "Use solver: automatic, block_lu, klu or sparse_lu");
  const bool solids = !system.nodes().empty();
  if (solids && a.solver == "tree")
    throw InputError("analysis.solver",
                     has_surfaces(system) ? "'tree' does not support contacts"
                                          : "'tree' does not support deformable solids",
                     "Use solver: automatic, block_lu, klu or sparse_lu");
  const bool given = a.solver != "automatic" && a.solver != "tree";
  const std::string solver = given ? a.solver : "block_lu";
  const NodeFactor factor =
      policy == JacobianPolicy::every_iteration || has_surfaces(system) || system.contacts()
          ? NodeFactor::every_iteration
          : NodeFactor::automatic;
  if (solids || system.contacts() || rows || given)
    return std::make_unique<SparseEngine>(system, solver, rate, factor);
  if (!tree_fits) {
    narration += "Solver: block LU, as 'tree' does not support this momentum_rate or jacobian.\n";
    return std::make_unique<SparseEngine>(system, solver, rate);
  }
  auto tree = std::make_unique<TreeEngine>(system, a.isa);
  const bool elastic = has_elastic_pairs(system);
  if (a.solver == "tree" || (!elastic && tree->plan().most_open <= kFewOpenLoops)) return tree;
  auto sparse = std::make_unique<SparseEngine>(system, solver, rate);
  if (tree->flops() < kTreeAdvantage * sparse->solver().factor_flops()) return tree;
  narration += elastic ? "Solver: block LU, as beams or cables connect bodies.\n"
                       : format("Solver: block LU, as up to {} kinematic loops pass one body.\n",
                                tree->plan().most_open);
  return sparse;
}

}  // namespace

Method choose_method(const System& system, const Model& model) {
  const AnalysisSpec& a = model.analysis;
  Method m;
  m.ga = GeneralizedAlpha::from_spectral_radius(a.rho_inf);
  m.kernels = &lane_kernels(a.isa);
  const JacobianPolicy policy = jacobian_policy(a.jacobian);
  StepControl& c = m.control;
  const OrderChoice choice = choose_order(system, model);
  m.narration = choice.reason + contact_narration(system, model);
  m.scheme = choice.text();
  c.order = choice.order;
  c.extrapolated = choice.extrapolated;
  c.varies = choice.varies;
  c.step = a.step;
  c.tolerance = a.tolerance.value_or(kDefaultError);
  c.horizon = is_endless(a) ? kEndlessHorizon : a.duration;
  c.min_step = a.min_step.value_or(0.0);
  c.max_step = a.max_step.value_or(0.0);
  c.conserving = a.conserving;
  c.lagged = std::ranges::any_of(
      model.controllers, [](const ControllerSpec& controller) { return !controller.sample; });
  c.threads = number_of_threads(system, a);
  c.newton.tolerance = a.newton_tolerance > 0.0  ? a.newton_tolerance
                       : c.extrapolated          ? extrapolated_tolerance(a)
                       : has_slides(system)      ? kToleranceSlides
                       : c.order > 4             ? kToleranceHighOrder
                       : !system.nodes().empty() ? kToleranceSolids
                                                 : kToleranceBodies;
  c.newton.max_iterations =
      a.max_iterations.value_or(system.nodes().empty() ? kIterations : kIterationsSolids);
  c.newton.jacobian = policy;
  c.newton.line_search = a.line_search;
  c.newton.max_rotation = a.max_step_rotation;
  if (system.contacts() || UnilateralRows::of(system)) {
    if (a.newton_tolerance <= 0.0) c.newton.tolerance = kToleranceContact;
    c.newton.max_iterations = a.max_iterations.value_or(kIterationsContact);
    if (a.jacobian == "automatic") c.newton.jacobian = JacobianPolicy::every_iteration;
    c.newton.line_search = false;  // the engine has its own
  }
  if ((system.contacts() || has_surfaces(system)) && a.rho_inf < 1.0)
    m.narration += format(
        "Warning: rho_inf is {:g}. Numerical damping takes energy from every contact, so "
        "restitution and rebound heights are too small. Use rho_inf: 1 unless this is intended.\n",
        a.rho_inf);
  if (has_surfaces(system)) {
    if (a.newton_tolerance <= 0.0)
      c.newton.tolerance = has_touching_cables(system) ? kToleranceCables : kToleranceSurfaces;
    if (a.jacobian == "automatic") c.newton.jacobian = JacobianPolicy::every_iteration;
  }
  m.engine = choose_engine(system, a, momentum_rate(a.momentum_rate), policy, m.narration);
  return m;
}

}  // namespace polhode
