// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <polhode/joints/joint.hpp>
#include <polhode/loads/spring_damper.hpp>
#include <polhode/system/interaction.hpp>

namespace polhode::interaction_tests {
namespace {

struct Sample : InteractionItem {
  static constexpr const char* kKind = "sample";
  void evaluate(const PairStep&, PairTerms&) const {}
  [[nodiscard]] bool conservative() const { return true; }
  [[nodiscard]] Work work(const PairStep&) const { return {}; }
};
/// A force whose losses would be unknown: "conservativ" is not a function of the interface.
struct Undeclared : InteractionItem {
  static constexpr const char* kKind = "undeclared";
  void evaluate(const PairStep&, PairTerms&) const {}
  [[nodiscard]] bool conservativ() const { return false; }
  [[nodiscard]] Work work(const PairStep&) const { return {}; }
};
/// A force without a work, as "wrk" is not a function of the interface.
struct Workless : InteractionItem {
  static constexpr const char* kKind = "workless";
  void evaluate(const PairStep&, PairTerms&) const {}
  [[nodiscard]] bool conservative() const { return true; }
  [[nodiscard]] Work wrk(const PairStep&) const { return {}; }
};
/// A barrier without impacts, whose name is misspelt.
struct SilentImpacts : Sample {
  [[nodiscard]] bool has_barrier() const { return true; }
  [[nodiscard]] double clearance(const PairStep&) const { return 0.5; }
  void impact(const PairStep&, std::vector<Impact>&) const {}
};
/// An interaction with a history that is never written: "comit" is not a function of the interface.
struct Misspelt : Sample {
  [[nodiscard]] int history_size() const { return 1; }
  void initialize(const PairStep&, double*) const {}
  void comit(const PairStep&, double*) const {}
};
struct Remembers : Misspelt {
  void commit(const PairStep&, double*) const {}
};
/// An interaction whose clearance is never queried, since has_barrier() is missing.
struct HalfBarrier : Sample {
  [[nodiscard]] double clearance(const PairStep&) const { return 0.5; }
};
/// Rows whose losses are missing in the energy balance.
struct SilentLoss : InteractionItem {
  static constexpr const char* kKind = "silent loss";
  void evaluate(const PairStep&, PairTerms&) const {}
  [[nodiscard]] int rows() const { return 1; }
  void acceleration_terms(const PairStep&, Vec6&) const {}
  [[nodiscard]] bool dissipates() const { return true; }
};
/// An interaction with rows but without their acceleration terms.
struct Rows : Sample {
  [[nodiscard]] int rows() const { return 1; }
};
/// An interaction with a wrong return type, to which a call would convert silently.
struct WrongType : Sample {
  [[nodiscard]] bool clearance(const PairStep&) const { return true; }
  [[nodiscard]] bool has_barrier() const { return true; }
};
struct NoKind : InteractionItem {
  void evaluate(const PairStep&, PairTerms&) const {}
};

static_assert(Interaction<Sample> && Interaction<Remembers>);
static_assert(Interaction<Joint> && Interaction<SpringDamper>);
static_assert(!Interaction<Misspelt>);
static_assert(!Interaction<Undeclared> && !Interaction<Workless> && !Interaction<SilentImpacts>);
static_assert(!Interaction<HalfBarrier>);
static_assert(!Interaction<SilentLoss>);
static_assert(!Interaction<Rows>);
static_assert(!HasInteractionFunctions<WrongType>);
static_assert(!HasInteractionFunctions<NoKind>);

TEST(Interaction, DetectsMisspeltFunctions) {
  EXPECT_TRUE(OwnFunctions<Misspelt>::history_size);
  EXPECT_FALSE(OwnFunctions<Misspelt>::commit);
  EXPECT_TRUE(OwnFunctions<Remembers>::commit);
  EXPECT_TRUE(OwnFunctions<Undeclared>::work);
  EXPECT_FALSE(OwnFunctions<Undeclared>::conservative);
  EXPECT_FALSE(OwnFunctions<Workless>::work);
}

}  // namespace
}  // namespace polhode::interaction_tests
