// SPDX-License-Identifier: Apache-2.0
// Time per element of forces, and of forces and tangents, of every kind of solid element.
//
//   benchmark_solid_elements [--benchmark_filter=hex8_eas9]
//
// The rate that is shown is elements per second; µs per element stand in the counter
// us_per_element.
#include <vector>

#include <benchmark/benchmark.h>

#include <polhode/core/error.hpp>
#include <polhode/solids/materials/registry.hpp>
#include <polhode/solids/mesh/generators.hpp>
#include <polhode/solids/solid_elements.hpp>

namespace polhode {
namespace {

/// A block of some thousand unknowns in a step, and room for what it computes.
class Block {
 public:
  Block(const solids::ElementKind& kind, const std::string& isa)
      : mesh_(solids::make_mesh("block", "block", {{"size", {1, 1, 1}}, {"cells", cells(kind)}},
                                kind.shape)),
        n_(kind.sizes().nodes) {
    const solids::MaterialDescription material =
        kind.sizes().mean_dilatation
            ? solids::MaterialDescription{.kind = "mooney_rivlin_uncoupled",
                                          .values = {{"c1", 1e6}, {"bulk_modulus", 1e9}}}
            : solids::MaterialDescription{
                  .kind = "neo_hookean",
                  .values = {{"youngs_modulus", 1e6}, {"poisson_ratio", 0.3}}};
    group_ = solids::make_solid_elements({.name = "block",
                                          .element = kind.name,
                                          .material = solids::make_material("material", material),
                                          .density = 1000.0,
                                          .connectivity = mesh_.blocks[0].nodes,
                                          .X = mesh_.nodes,
                                          .isa = isa});
    for (const Vec3& X : mesh_.nodes)
      for (int i = 0; i < 3; ++i) {
        x_n_.push_back(X[i] * (1.0 + 0.01 * i));
        x_n1_.push_back(x_n_.back() + 0.01 * X[(i + 1) % 3]);
        u_.push_back(x_n1_.back() - x_n_.back());
      }
    v_.assign(x_n_.size(), 0.0);
    force_.assign(x_n_.size(), 0.0);
    history_.assign(group_->history_size(), 0.0);
    scratch_.assign(group_->scratch_size(), 0.0);
    group_->begin_step(history_.data(), scratch_.data());
    // Every element has blocks of its own: the worst that assembly meets.
    for (int i = 0; i < group_->size() * n_ * n_; ++i) slots_.push_back(i);
    tangent_.assign(9 * slots_.size(), 0.0);
  }

  void evaluate(bool tangents) {
    const StepContext context{.ga = {}, .dt = 1e-3};
    const NodeStep step{.x_n = x_n_.data(),
                        .x_n1 = x_n1_.data(),
                        .u = u_.data(),
                        .v_n = v_.data(),
                        .v_n1 = v_.data(),
                        .context = context,
                        .alpha_f = 0.5,
                        .rate = 2e3};
    const ElementSink sink{force_.data(), tangents ? tangent_.data() : nullptr, slots_.data()};
    group_->evaluate(step, history_.data(), scratch_.data(), Mat3::Identity(), sink);
  }
  [[nodiscard]] int size() const { return group_->size(); }

 private:
  static std::vector<double> cells(const solids::ElementKind& kind) {
    const double n = kind.sizes().points == 27 ? 4.0 : 10.0;
    return {n, n, n};
  }

  solids::Mesh mesh_;
  int n_;
  std::unique_ptr<solids::SolidElements> group_;
  std::vector<double> x_n_, x_n1_, u_, v_, force_, history_, scratch_, tangent_;
  std::vector<int> slots_;
};

void run(benchmark::State& state, const solids::ElementKind& kind, const std::string& isa,
         bool tangents) {
  Block block(kind, isa);
  block.evaluate(true);
  for (auto _ : state) block.evaluate(tangents);
  const double elements = static_cast<double>(state.iterations()) * block.size();
  state.counters["us_per_element"] = benchmark::Counter(
      1e-6 * elements, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

}  // namespace
}  // namespace polhode

int main(int argc, char** argv) {
  using namespace polhode;
  benchmark::Initialize(&argc, argv);
  for (const char* isa : {"baseline", "avx2", "avx512"}) {
    try {
      (void)solids::element_kernels(isa);
    } catch (const InputError&) {
      continue;  // not on this machine
    }
    for (const solids::ElementKind& kind : solids::element_kinds())
      for (const bool tangents : {false, true})
        benchmark::RegisterBenchmark(
            (kind.name + "/" + (tangents ? "tangent" : "forces") + "/" + isa).c_str(),
            [&kind, isa, tangents](benchmark::State& s) { run(s, kind, isa, tangents); })
            ->Unit(benchmark::kMillisecond);
  }
  benchmark::RunSpecifiedBenchmarks();
}
