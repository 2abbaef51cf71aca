// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <Eigen/Eigenvalues>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/solids/cell_stability.hpp>
#include <polhode/solids/elements/extrapolation.hpp>
#include <polhode/solids/elements/reference_data.hpp>
#include <polhode/solids/solid_elements.hpp>

namespace polhode::solids {
namespace {

Mat3 symmetric(const double* v) {
  Mat3 m;
  m << v[0], v[3], v[5], v[3], v[1], v[4], v[5], v[4], v[2];
  return m;
}

/// Principal stretches from the mean of C, largest first.
Vec3 stretches(const double* C) {
  const Eigen::SelfAdjointEigenSolver<Mat3> eigen(symmetric(C), Eigen::EigenvaluesOnly);
  return eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt().reverse();
}

/// Unit vector of the smallest principal stretch, in the undeformed shape.
Vec3 direction_of_least(const double* C) {
  return Eigen::SelfAdjointEigenSolver<Mat3>(symmetric(C)).eigenvectors().col(0);
}

double poisson_ratio(LinearModuli moduli) {
  return 0.5 * moduli.lame / (moduli.lame + moduli.shear);
}

class SolidGroup final : public SolidElements {
 public:
  explicit SolidGroup(SolidElementsDescription d)
      : name_(std::move(d.name)),
        kind_(element_kind(d.element)),
        sizes_(kind_.sizes()),
        material_(std::move(d.material)),
        density_(d.density),
        X_(d.X.begin(), d.X.end()),
        kernels_(element_kernels(d.isa)),
        reference_(name_, kind_, d.connectivity, X_, static_cast<int>(material_->fibres().size()),
                   d.fibres, kernels_.width),
        to_nodes_(extrapolation(kind_)) {
    if (!kind_.warning.empty()) warnings_.push_back(format("{}: {}.", name_, kind_.warning));
    if (const double ratio = poisson_ratio(material_->linear()); ratio > kind_.most_poisson)
      warnings_.push_back(
          format("{}: {} locks with a Poisson's ratio of {:.6g}: too stiff where the volume cannot "
                 "change. Use tet10, or hex8_q1p0 with an uncoupled material.",
                 name_, kind_.name, ratio));
    const MaterialKernels& laws = material_kernels(d.isa);
    data_.elements = reference_.elements;
    data_.blocks = reference_.blocks;
    data_.nodes = reference_.nodes.data();
    data_.X = reference_.X.data();
    data_.points = reference_.points.data();
    data_.volumes = reference_.volumes.data();
    data_.to_nodes = to_nodes_.data();
    data_.law = material_->law();
    data_.law_kernel = laws.laws[material_->law_index()];
    if (material_->has_fibres()) {
      data_.fibres = reference_.fibres.data();
      for (const Fibre& fibre : material_->fibres())
        families_.push_back({fibre.law.data(), laws.fibres[fibre.index], fibre.dispersion});
      data_.families = families_.data();
      data_.family_count = static_cast<int>(families_.size());
    }
    data_.volume_kernel = laws.volumes[static_cast<int>(material_->kind().volume)];
    data_.uncoupled = material_->uncoupled();
    data_.bulk = material_->bulk_modulus();
    data_.conserving = d.conserving;
    data_.viscous = material_->viscous();
    data_.viscous_lame = material_->viscous_moduli().lame;
    data_.viscous_shear = material_->viscous_moduli().shear;
    if (const std::size_t terms = material_->relaxation().size(); terms > 0)
      data_.memory_size = kMemorySize * (1 + static_cast<int>(terms));
    data_.first_memory = static_cast<std::ptrdiff_t>(reference_.elements) * sizes_.history();
  }

  std::string kind() const override { return kind_.name; }
  const std::string& name() const override { return name_; }
  int size() const override { return reference_.elements; }
  int nodes_per_element() const override { return sizes_.nodes; }
  std::span<const int> nodes(int element) const override {
    return std::span(reference_.nodes)
        .subspan(static_cast<std::size_t>(element) * sizes_.nodes, sizes_.nodes);
  }
  bool conservative() const override { return data_.conserving && !dissipates(); }
  bool dissipates() const override { return data_.viscous || data_.memory_size > 0; }
  std::size_t history_size() const override {
    return static_cast<std::size_t>(reference_.elements) *
           static_cast<std::size_t>(sizes_.history() + sizes_.points * data_.memory_size);
  }
  std::size_t scratch_size() const override {
    return static_cast<std::size_t>(reference_.blocks) * kernels_.width * sizes_.scratch();
  }

  const ElementKind& element() const override { return kind_; }
  const Material& material() const override { return *material_; }
  const std::vector<std::string>& warnings() const override { return warnings_; }
  double volume() const override { return reference_.volume; }

  bool mass(int element, double* M) const override {
    element_mass(kind_, density_, nodes(element), X_, M);
    return true;
  }

  void initialize(double* history) const override { std::fill_n(history, history_size(), 0.0); }

  void begin_step(const double* history, double* scratch) const override {
    const int n = sizes_.modes(), W = kernels_.width;
    for (int b = 0; b < reference_.blocks && sizes_.scratch() > 0; ++b) {
      double* kept = scratch + static_cast<std::size_t>(b) * W * sizes_.scratch();
      for (int l = 0; l < W; ++l) {
        const double* h = history_of(history, b * W + l);
        for (int k = 0; k < n; ++k) {
          kept[k * W + l] = h[k];
          kept[(sizes_.at_move() + k) * W + l] = 0.0;
        }
        if (sizes_.mean_dilatation) kept[l] = kept[W + l] = h[0];
      }
    }
  }

  ElementReport evaluate(const NodeStep& step, const double* history, double* scratch,
                         const Mat3& turn, const ElementSink& sink) const override {
    ElementStep s = motion(step, history, scratch, turn);
    s.force = sink.force;
    s.tangent = sink.tangent;
    s.slots = sink.slots;
    kernels_.kinds[kind_.kernel].evaluate(data_, s);
    return {s.least_volume, s.worst_element};
  }

  double advance(const double* du, const Mat3& turn, double* scratch) const override {
    if (sizes_.scratch() == 0) return 0.0;
    ElementStep s;
    s.scratch = scratch;
    set_turn(turn, s);
    return kernels_.kinds[kind_.kernel].advance(data_, s, du);
  }

  std::size_t unknowns_size() const override {
    return static_cast<std::size_t>(reference_.blocks) * kernels_.width * moved_packs();
  }
  void get_unknowns(const double* scratch, double* unknowns) const override {
    const std::size_t n = moved_packs() * kernels_.width, all = sizes_.scratch() * kernels_.width;
    for (int b = 0; b < reference_.blocks; ++b) std::copy_n(scratch + b * all, n, unknowns + b * n);
  }
  void set_unknowns(const double* unknowns, double* scratch) const override {
    const std::size_t n = moved_packs() * kernels_.width, all = sizes_.scratch() * kernels_.width;
    for (int b = 0; b < reference_.blocks; ++b) std::copy_n(unknowns + b * n, n, scratch + b * all);
  }

  double difference(const double* history, const double* other_history) const override {
    double most = 0.0;
    for (int e = 0; e < reference_.elements; ++e) {
      const int first = e * sizes_.history();
      for (int k = first; k < first + sizes_.modes(); ++k)
        most = std::max(most, std::abs(history[k] - other_history[k]));
    }
    return most;
  }

  void commit(const NodeStep& step, double* history, const double* scratch) const override {
    const int n = sizes_.modes(), W = kernels_.width;
    if (data_.memory_size > 0) {
      const ElementStep s = motion(step, history, const_cast<double*>(scratch), Mat3::Identity());
      kernels_.kinds[kind_.kernel].remember(data_, s, history);
    }
    if (sizes_.history() == 0) return;
    for (int e = 0; e < reference_.elements; ++e) {
      double* h = history + static_cast<std::size_t>(e) * sizes_.history();
      const double* kept = scratch + static_cast<std::size_t>(e / W) * W * sizes_.scratch() + e % W;
      for (int k = 0; k < n; ++k) {
        if (step.rate != 0.0) h[n + k] = (kept[k * W] - h[k]) / step.context.dt;
        h[k] = kept[k * W];
      }
      if (sizes_.mean_dilatation) h[0] = kept[0];
    }
  }

  Work work(const NodeStep& step, const double* history, const double* scratch) const override {
    const ElementStep s = motion(step, history, const_cast<double*>(scratch), Mat3::Identity());
    Work w;
    double power = 0.0;
    kernels_.kinds[kind_.kernel].work(data_, s, &w.stored, &power);
    if (step.x_n != step.x_n1) w.dissipated = step.context.dt * power;
    return w;
  }

  bool sample(const NodeStep& instant, const double* history,
              std::span<ElementSample> samples) const override {
    const int n = sizes_.nodes;
    std::vector<double> nodal(static_cast<std::size_t>(reference_.elements) * n * kNodalSize);
    each_sample(
        instant, history,
        [&](int e, const double* v) {
          ElementSample& to = samples[e];
          to.cauchy = symmetric(v);
          to.principal_stretches = stretches(v + 6);
          to.strain_energy_density = v[12];
          to.volume = v[13];
          to.cauchy_at_nodes.clear();
          to.energy_at_nodes.clear();
          for (int a = 0; a < n; ++a) {
            const double* at = nodal.data() + (static_cast<std::size_t>(e) * n + a) * kNodalSize;
            to.cauchy_at_nodes.push_back(symmetric(at));
            to.energy_at_nodes.push_back(at[6]);
          }
        },
        nodal.data());
    return true;
  }

  LeastStretch least_stretch(const NodeStep& instant, const double* history) const override {
    LeastStretch least{std::numeric_limits<double>::infinity(), -1};
    each_sample(instant, history, [&](int e, const double* v) {
      const double s = stretches(v + 6)[2];
      if (!(s >= least.value)) least = {s, e, direction_of_least(v + 6)};
    });
    return least;
  }

  std::string stretch_warning(const LeastStretch& least) const override {
    if (least.element < 0 || !(least.value < 1.0)) return {};
    const double bound = least_stretch_of(least);
    if (least.value >= bound) return {};
    return format(
        "{}: element {} is compressed to {:.2f} of its length; {} of this shape has spurious modes "
        "below {:.2g}. Use hex8_q1p0 with an uncoupled material, a quadratic element, or cells "
        "that "
        "are longer in the direction of the pressure.",
        name_, least.element, least.value, kind_.name, bound);
  }

 private:
  /// Stretch below which an element has spurious modes: that of its kind, or of its shape if flat.
  [[nodiscard]] double least_stretch_of(const LeastStretch& least) const {
    if (kind_.least_stretch == 0.0 || kind_.shape != "hex8" || material_->has_fibres())
      return kind_.least_stretch;
    const std::span<const int> list = nodes(least.element);
    const auto edge = [&](std::size_t i) {
      return Vec3(X_[static_cast<std::size_t>(list[i])] - X_[static_cast<std::size_t>(list[0])]);
    };
    const std::array<Vec3, 3> edges{edge(1), edge(3), edge(4)};
    Vec3 size, along;
    for (int i = 0; i < 3; ++i) {
      const Vec3& e = edges[static_cast<std::size_t>(i)];
      size[i] = e.norm();
      along[i] = std::abs(e.dot(least.direction)) / size[i];
    }
    Eigen::Index axis = 0;
    along.maxCoeff(&axis);
    return std::max(kind_.least_stretch,
                    stable_stretch(kind_.name, material_, size, static_cast<int>(axis)));
  }

  /// Leading packs of a block's scratch that advance() changes: enhanced modes, or the pressures of
  /// mean dilatation.
  [[nodiscard]] std::size_t moved_packs() const {
    return static_cast<std::size_t>(sizes_.mean_dilatation ? 2 : sizes_.modes());
  }
  [[nodiscard]] const double* history_of(const double* history, int lane) const {
    return history +
           static_cast<std::size_t>(std::min(lane, reference_.elements - 1)) * sizes_.history();
  }

  static void set_turn(const Mat3& turn, ElementStep& s) {
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) s.turn[3 * i + j] = turn(i, j);
  }

  [[nodiscard]] ElementStep motion(const NodeStep& step, const double* history, double* scratch,
                                   const Mat3& turn) const {
    ElementStep s;
    if (data_.memory_size > 0)
      s.memory = {*material_, step.rate != 0.0 ? step.context.dt : step.context.relaxation_time,
                  step.alpha_f};
    s.x_n = step.x_n;
    s.x_n1 = step.x_n1;
    s.v_n = step.v_n;
    s.v_n1 = step.v_n1;
    s.alpha_f = step.alpha_f;
    s.rate = step.rate;
    s.dt = step.context.dt;
    s.mixed_point = step.mixed_point;
    s.history = history;
    s.scratch = scratch;
    set_turn(turn, s);
    return s;
  }

  template <class Use>
  void each_sample(const NodeStep& instant, const double* history, const Use& use,
                   double* nodal = nullptr) const {
    const ElementStep s = motion(instant, history, nullptr, Mat3::Identity());
    std::vector<double> values(static_cast<std::size_t>(reference_.elements) * kSampleSize);
    kernels_.kinds[kind_.kernel].sample(data_, s, values.data(), nodal);
    for (int e = 0; e < reference_.elements; ++e)
      use(e, values.data() + static_cast<std::size_t>(e) * kSampleSize);
  }

  std::string name_;
  const ElementKind& kind_;
  const ElementSizes& sizes_;
  std::shared_ptr<const Material> material_;
  double density_;
  std::vector<Vec3> X_;
  const ElementKernels& kernels_;
  ReferenceData reference_;
  Extrapolation to_nodes_;
  std::vector<FibreFamily> families_;
  ElementData data_;
  std::vector<std::string> warnings_;
};

void check(const SolidElementsDescription& d) {
  const std::size_t n = static_cast<std::size_t>(element_kind(d.element).sizes().nodes);
  if (!d.material) throw InputError(d.name, "there is no material", "Name a material of the model");
  if (!(d.density > 0.0) || !std::isfinite(d.density))
    throw InputError(d.name, format("the density is {:g} kg/m³", d.density),
                     "Give a positive density");
  if (d.connectivity.empty() || d.connectivity.size() % n != 0)
    throw InputError(
        d.name,
        format("{} node numbers do not form elements of {} nodes", d.connectivity.size(), n),
        "Give at least one element, with all its nodes");
  for (std::size_t i = 0; i < d.connectivity.size(); ++i)
    if (d.connectivity[i] < 0 || static_cast<std::size_t>(d.connectivity[i]) >= d.X.size())
      throw InputError(d.name,
                       format("element {} names node {}, but there are {} (the first is 0)", i / n,
                              d.connectivity[i], d.X.size()),
                       "Give numbers of nodes that exist");
  if (!d.material->relaxation().empty() && !d.conserving)
    throw InputError(d.name, "the stress of its material relaxes, and 'stress' is midpoint",
                     "Use stress: conserving");
  if (!d.material->has_fibres()) return;
  const std::size_t elements = d.connectivity.size() / n, families = d.material->fibres().size();
  if (d.fibres.size() != families && d.fibres.size() != families * elements)
    throw InputError(d.name,
                     format("the material has fibres, and {} directions are given for {} elements",
                            d.fibres.size(), elements),
                     "Give one direction for each family, or for each family in each element");
  for (const Vec3& direction : d.fibres)
    if (!(direction.norm() > 0.0) || !direction.allFinite())
      throw InputError(d.name, "a fibre direction is zero or not finite",
                       "Give a vector of any length but zero");
}

}  // namespace

const SolidElements* as_solid(const ElementGroup& group) {
  const std::vector<ElementKind>& kinds = element_kinds();
  const bool is_solid = std::any_of(kinds.begin(), kinds.end(), [&](const ElementKind& kind) {
    return kind.name == group.kind();
  });
  return is_solid ? static_cast<const SolidElements*>(&group) : nullptr;
}

std::unique_ptr<SolidElements> make_solid_elements(SolidElementsDescription d) {
  check(d);
  if (!d.material->has_fibres()) d.fibres.clear();
  const ElementKind& kind = element_kind(d.element);
  if (kind.sizes().mean_dilatation && !d.material->uncoupled())
    throw InputError(
        d.name,
        format("'{}' needs an uncoupled material, not '{}'", kind.name, d.material->kind().name),
        "Use mooney_rivlin_uncoupled, or another element");
  return std::make_unique<SolidGroup>(std::move(d));
}

}  // namespace polhode::solids
