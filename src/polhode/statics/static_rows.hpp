// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include <polhode/equations/trial.hpp>
#include <polhode/impulses/row_problem.hpp>
#include <polhode/linear/kkt.hpp>
#include <polhode/system/body_contacts.hpp>
#include <polhode/system/impulsive_contacts.hpp>
#include <polhode/system/unilateral_stops.hpp>

namespace polhode {

/// Unilateral rows of an equilibrium: contacts of rigid shapes, and stops of joints, that are rows
/// as in a step in time. A row has a force p ≥ 0 with p g = 0 and g ≥ 0 at the equilibrium;
/// contacts that touched at the last one have Coulomb friction against the slip since then. Rows
/// share a load by the smallest forces, whatever their order. @eq{statics-rows}
class StaticRows {
 public:
  explicit StaticRows(const System& system);

  /// Starts from an equilibrium: what touches there has friction from there on.
  void begin(const State& last);
  /// Takes the forces that were committed with a state.
  void recall(const State& state);
  /// Finds the rows where the bodies of the trial are.
  /// @param last  The equilibrium that began, with the histories of the iterates.
  void place(const State& last, const Trial& trial);

  /// Adds the forces of the rows. @param s  Their scale. @param noise  Their rounding, unscaled.
  void add_forces(double s, Vec& rhs, Vec& noise) const;
  /// Appends to the matrix of bodies and joints the change of the rows' forces with the bodies, and
  /// if `hold` the rows that act, as rows of joints.
  void extend(linear::KktTopology& topology, linear::KktValues& values, double s, bool hold) const;
  /// Increments of bodies with rows, by the row problem.
  /// @param respond  Solves with the matrix, in place.
  /// @param x  Increments without further forces of rows; with them.
  /// @returns whether it is solved; unsolved() is the message if not.
  [[nodiscard]] bool solve(double s, const std::function<void(Vec&)>& respond, Vec& x);
  [[nodiscard]] const std::string& unsolved() const { return unsolved_; }
  /// Part of these increments in which no two bodies pass each other.
  [[nodiscard]] double free_part() const { return part_; }
  /// Forces after this part of the increments.
  void move(double part);
  /// Largest gap of a closed row, overlap, or slip of a point that sticks or does not roll, as a
  /// part of what counts as none.
  [[nodiscard]] double miss() const;
  [[nodiscard]] double accuracy() const { return accuracy_; }  ///< Gaps that count as none [m].
  [[nodiscard]] double largest_force() const;
  /// Gives points that left static friction the kinetic coefficient. @returns whether there are
  /// any.
  [[nodiscard]] bool lose_static_friction();
  /// Whether a contact with friction that was open at the last equilibrium carries load.
  [[nodiscard]] bool closes() const;
  /// Remembers those contacts.
  void note_closing();
  /// Smallest gap of these contacts [m]; infinite: they are not near.
  [[nodiscard]] double gap_of_closing() const;
  /// Bodies that overlap: "body 'a' and the ground would overlap"; empty: none.
  [[nodiscard]] std::string overlap() const;
  /// Contact whose force pulls, exceeds its friction, or does not oppose its slip; empty: none.
  [[nodiscard]] std::string inadmissible() const;
  /// Contacts with friction at the last equilibrium.
  [[nodiscard]] std::vector<std::string> with_friction() const;
  /// Bodies that move and that had a contact with friction at the last equilibrium.
  [[nodiscard]] std::vector<int> bodies_with_friction() const;
  /// Keeps what slips, as the equilibrium becomes the last one.
  void freeze();
  /// Stores forces, and which rows are closed and slip, in an equilibrium.
  void commit(State& state);

  /// Rows that act: "the contact of body 'a' and the ground: 4 points, sticking".
  [[nodiscard]] std::vector<std::string> held() const;
  /// Contacts and stops that touch, with a force or without.
  [[nodiscard]] std::vector<std::string> touching() const;
  /// Contacts whose friction is at its bound, and that slide.
  [[nodiscard]] std::vector<std::string> sliding() const;

 private:
  /// Forces of a contact on a, world.
  struct Forces {
    double normal = 0.0;           ///< [N]
    Vec3 friction = Vec3::Zero();  ///< In the tangent plane [N].
    double torsion = 0.0;          ///< About the normal [N m].
    Vec3 rolling = Vec3::Zero();   ///< In the tangent plane [N m].
  };
  /// A contact point with its forces.
  struct Contact : Forces {
    ContactInstant at;
    Forces next;                  ///< After the increment.
    bool listed = false;          ///< It is a row of this search.
    bool closed_n = false;        ///< It touched at the last equilibrium.
    bool kinetic = false;         ///< Its friction is that of sliding.
    Vec3 place_n = Vec3::Zero();  ///< There.
    Vec3 slip = Vec3::Zero();     ///< Since then, in the tangent plane [m].
    Vec3 turn = Vec3::Zero();     ///< Rotation of a relative to b since then [rad].
    bool slides = false;          ///< With frozen_: it slips.
    [[nodiscard]] double mu_along() const { return kinetic ? at.friction : at.static_friction; }
    [[nodiscard]] bool rubs() const { return at.friction > 0.0; }
  };
  /// A stop of an interaction.
  struct Stop : UnilateralStop {
    double force = 0.0, next = 0.0;         ///< At the iterate, and after the increment [N].
    Eigen::Matrix<double, 12, 12> by = {};  ///< Derivative of (by_a, by_b) by the increments.
  };
  struct Row {
    int a = kGround, b = kGround;
    Vec6 on_a, on_b;   ///< Wrenches of a unit force, also the derivatives of `way`.
    double way = 0.0;  ///< Gap, or slip.
    double given = 0.0;
    int source = 0;  ///< A contact or, numbered behind them, a stop.
    Vec3 direction = Vec3::Zero();
    int part = 0;  ///< 0 normal, 1 friction, 2 torsion, 3 rolling.
  };
  void take_instants();
  void take_points();
  void place_stops(const State& last, const Trial& trial);
  void differentiate(Stop& stop, const PairView& view) const;
  void put_rows();
  void put_contact(int source);
  void take_forces(const Vec& forces);
  void limit(const Vec& x);
  [[nodiscard]] Row row_of(const Contact& c, int source, const Vec3& direction, int part) const;
  [[nodiscard]] Eigen::Matrix<double, 12, 12> stiffness_of(const Contact& c) const;
  [[nodiscard]] bool sticks(const Contact& c) const;
  [[nodiscard]] static double friction_part(const Contact& c);
  [[nodiscard]] bool acts(double force) const;
  [[nodiscard]] bool list_violated(const Vec& x);
  [[nodiscard]] std::string names_of(int a, int b) const;
  [[nodiscard]] std::string rubbing_name(const Contact& c) const;
  [[nodiscard]] static double change(const Row& row, const Vec& x) {
    return (row.a == kGround ? 0.0 : row.on_a.dot(x.segment<6>(6 * row.a))) +
           (row.b == kGround ? 0.0 : row.on_b.dot(x.segment<6>(6 * row.b)));
  }

  const System* system_;
  BodyContacts* contacts_ = nullptr;        ///< Null: none.
  ImpulsiveContacts* impulsive_ = nullptr;  ///< Likewise.
  double touching_, accuracy_ = 0.0;        ///< Gaps that count as closed, and as no gap [m].
  StepContext context_;                     ///< Of the search for candidates.
  std::vector<BodyStep> steps_, instants_;  ///< By body, the ground last.
  std::vector<Contact> points_, anchors_;   ///< At the iterate, and at the last equilibrium.
  std::vector<Stop> stops_;                 ///< Of all interactions.
  std::vector<Row> rows_;
  std::vector<ImpulseRows> blocks_;
  std::vector<double> lengths_;
  std::vector<std::array<std::uint64_t, 2>> closing_;
  std::string unsolved_;
  double part_ = 1.0;     ///< See free_part().
  double stride_ = 1.0;   ///< Factor of the largest displacement of an increment.
  bool strides_ = false;  ///< The increment has it.
  bool frozen_ = false;   ///< What slips is known, and stays.
};

}  // namespace polhode
