// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include <polhode/equations/newton_engine.hpp>
#include <polhode/equations/newton_system.hpp>
#include <polhode/linear/block_cg.hpp>
#include <polhode/system/body_contacts.hpp>
#include <polhode/system/contact_springs.hpp>

namespace polhode {

/// Newton iterations for many bodies coupled by contacts, with joints, springs and motors among
/// them. Conjugate gradients replace a factorisation, on the motions that rows allow. The tangent
/// is the symmetric positive part of the true one, so Newton converges linearly. A step is solved
/// when the residual of every body is below a part of its weight, and rows hold to round-off. Most
/// bodies converge in a few iterations; from then on only the others, bodies in contact with them,
/// and bodies with interactions are moved.
class ContactCgEngine final : public NewtonEngine {
 public:
  /// Tolerated residual, as a part of a body's weight; in steps below 1 ms it decreases in
  /// proportion, to limit the momentum error. With friction or restitution below one it only shifts
  /// when energy is dissipated; with neither it is an energy error.
  static constexpr double kResidual = 1e-6;

  /// @throws InputError if suits() is false.
  explicit ContactCgEngine(const System& system, double residual = kResidual);
  [[nodiscard]] std::string name() const override { return "contact CG"; }
  void begin_step(const State& state, Trial& trial) override;
  Iteration iterate(const State& state, Trial& trial, bool refactor, double damping) override;
  [[nodiscard]] ConstraintCheck check(const State& state, Trial& trial) override;
  [[nodiscard]] int worst_body() const override { return worst_body_; }
  [[nodiscard]] std::string worst_other() const override { return contacts_->tightest(); }
  [[nodiscard]] bool may_grow() const override { return true; }
  void add_ground_wrench(double* force, double* moment) const override;
  void end_step(const State& state, Trial& trial) override;
  [[nodiscard]] double stored(const State& state) const override;
  Work commit(State& state, const Trial& trial) override;
  [[nodiscard]] BodyContacts* contacts() const override { return contacts_; }

  /// Iterations of conjugate gradients so far.
  [[nodiscard]] long inner_iterations() const { return inner_; }

  /// Whether the engine suits a system: bodies coupled by contacts, by joints without friction and
  /// stops, and by forces without a rest length, such as springs; beams and cables are too stiff.
  [[nodiscard]] static bool suits(const System& system);
  /// Number of bodies coupled to others by contacts alone.
  [[nodiscard]] static int free_bodies(const System& system);

 private:
  void start_inertia(const State& state, const StepContext& context);
  void find_free_motions(const State& state, const Trial& trial);
  void add_free_rows(const InteractionRef& ref, const PairTerms& terms);
  [[nodiscard]] Vec6 of_motion(int body, double per_speed) const;
  void add_wrenches(const InteractionRef& ref, const PairTerms& terms);
  void move(int body, const Vec3& u, const Vec3& theta);
  void evaluate(const State& state, const Trial& trial);
  void move_all();
  void move_late();
  void add_interaction(int interaction, const PairTerms& terms, const Trial& trial);
  [[nodiscard]] bool rows_hold() const;
  [[nodiscard]] bool solve(const Trial& trial);

  const System* system_;
  BodyContacts* contacts_;
  PointwiseContacts* pointwise_;
  InteractionSweep loads_;
  double tolerance_, enough_ = 0.0;
  linear::BlockCg cg_;
  bool slow_ = false;  ///< An increment of this step left a large part of the residual.
  /// Parts of a body's momentum rates and velocities at t_{n+1} that are determined by t_n.
  struct Inertia {
    Vec3 force, moment;  ///< Gravity and the part of the rates from t_n [N, N m].
    Vec3 v, W;           ///< [m/s, rad/s]
  };
  std::vector<BodyStep> steps_;  ///< By body, the ground last.
  std::vector<Inertia> inertia_;
  std::vector<Mat6> own_, blocks_;  ///< Of inertia alone; including loads, of bodies with loads.
  std::vector<int> acted_on_;       ///< Bodies with loads or joints, ascending.
  std::vector<int> coupled_;        ///< Those of them that are constrained or coupled to others.
  std::vector<linear::BlockCg::Tie> ties_;
  std::vector<linear::BlockCg::Row> rows_;
  std::vector<int> row_number_;                    ///< Of each of rows_.
  std::vector<double> start_lambda_;               ///< Of each of rows_.
  double rows_off_ = 0.0, rows_off_before_ = 0.0;  ///< Largest |g| [m or -].
  std::vector<Vec6> of_motion_, rhs_, x_, start_;  ///< rhs_: of the motion, loads and contacts.
  struct PerMass {
    double moved, turned;  ///< Inverse mass, and inverse mean moment of inertia.
  };
  std::vector<PerMass> per_mass_;
  std::vector<PointwiseContacts::FreeMotion> free_;  ///< By body.
  std::vector<PointwiseContacts::FreeRows> free_rows_;
  std::vector<double> far_;    ///< By body, its largest coordinate at t_n [m].
  std::vector<double> sizes_;  ///< By body: size of its residual [N² / kg].
  std::span<const ActingPoint> acting_;
  std::vector<int> moving_;  ///< Bodies that the iteration moves, ascending.
  std::vector<char> moves_;  ///< The same by body; the ground last.
  std::vector<char> ring_;   ///< Moving bodies before the ring grows.
  double merit_ = 0.0;       ///< Sum of sizes.
  double residual_ = 0.0, weight_ = 0.0;
  bool evaluated_ = false;
  int worst_body_ = -1, searches_ = 0;
  long inner_ = 0;
};

}  // namespace polhode
