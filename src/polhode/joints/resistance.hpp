// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <vector>

#include <polhode/contact_laws/normal_law.hpp>
#include <polhode/joints/parts/configuration.hpp>
#include <polhode/joints/stop.hpp>
#include <polhode/system/force_pieces.hpp>
#include <polhode/system/free_coordinate.hpp>
#include <polhode/system/pair_terms.hpp>
#include <polhode/system/unilateral_row.hpp>

namespace polhode {

/// Dry friction in a joint, on the sliding surfaces of its bodies.
///
/// The slip force or moment is μ times the normal force due to the joint's reaction, plus a
/// constant part. Below it a bristle of this stiffness sticks. @eq{joint-friction-limit}
struct JointFriction {
  double mu = 0.0;           ///< Coefficient [-].
  double radius = 0.0;       ///< Of the pin, sleeve or ball; of a slider: arm of M about z [m].
  double face_radius = 0.0;  ///< Mean radius of the faces that carry the axial force [m].
  double length = 0.0;     ///< Of the bearing [m]; 0: moments normal to the axis cause no friction.
  double constant = 0.0;   ///< Slip force [N] or moment [N m] without load.
  double stiffness = 1.0;  ///< Of the bristle [N/m]; for rotations alone [N m/rad].
  double damping = 0.0;    ///< Of the sticking bristle [N s/m], [N m s/rad].
  double mass = 0.0;       ///< Of the joint's bodies, reduced [kg].
  /// Inertias of a and b about the joint, body axes; zero: does not move [kg m²].
  std::array<Mat3, 2> inertia{Mat3::Zero(), Mat3::Zero()};
};

/// Stops of one free coordinate: barriers at both limits, or rows that only push; with restitution.
struct JointLimits {
  double lower = -std::numeric_limits<double>::infinity();  ///< [m] or [rad]
  double upper = std::numeric_limits<double>::infinity();
  contact::NormalLaw law;    ///< Of resting contact with each; its tolerance is the band.
  double restitution = 0.0;  ///< Ratio of the speeds after and before an impact [-].
  /// Effective inertia in impacts [kg] or [kg m²]; 0: the law's stiffness is used.
  double inertia = 0.0;
  bool by_rows = false;  ///< Rows of the step instead of the law.
  double radius = 1.0;   ///< Of an angle: its gaps are lengths there [m].

  [[nodiscard]] bool within(double x) const { return x >= lower && x <= upper; }
};

/// Friction and stops of a joint.
struct JointResistance {
  std::optional<JointFriction> friction;
  /// Stops of the displacement along z, or of the distance of a link, and of the angle about z.
  std::optional<JointLimits> slide, turn;

  [[nodiscard]] bool any() const { return friction || slide || turn; }
};

/// Report of friction and stops of a joint at an instant.
struct ResistanceReport {
  /// On b, by free coordinate [N] or [N m]; of a ball in a's joint axes.
  std::array<double, 3> friction{};
  int count = 0;                   ///< Number of valid entries.
  bool slips = false;              ///< Over the last step.
  double slide = 0.0, turn = 0.0;  ///< Of the stops, along +z or apart, on b [N], [N m].
};

/// History of the friction of a joint.
struct BristleMemory {
  double bristle[3];  ///< [m]
  double slips;       ///< 1: yes.
};

/// Friction and stops of the free coordinates of a revolute, prismatic, cylindrical, spherical or
/// universal joint, and the stops of a link with slack, evaluated together with the joint's parts,
/// with the same multipliers. The cross of a universal joint rotates on two pins, x of a and y of
/// b, each with its own friction.
class Resistance {
 public:
  enum class Kind : unsigned char {
    revolute,
    prismatic,
    cylindrical,
    spherical,
    universal,
    link  ///< Only stops of a distance.
  };

  /// Kind of the joint type of this name; nothing if it supports no resistance.
  [[nodiscard]] static std::optional<Kind> kind_of(const std::string& type);

  Resistance(Kind kind, const JointResistance& data) : kind_(kind), data_(data) {}

  [[nodiscard]] const JointResistance& data() const { return data_; }
  /// Whether it has stops that are barriers.
  [[nodiscard]] bool has_barrier() const {
    return (data_.slide && !data_.slide->by_rows) || (data_.turn && !data_.turn->by_rows);
  }
  /// Whether its friction depends on the joint's reaction.
  [[nodiscard]] bool rubs_by_reaction() const { return data_.friction && data_.friction->mu > 0.0; }
  /// Whether it exerts forces besides stops that are rows.
  [[nodiscard]] bool has_forces() const { return data_.friction || has_barrier(); }
  /// Number of stops that are rows: ends of coordinates.
  [[nodiscard]] int rows() const;
  /// Entry of the memory with the UnilateralMemory of the first of them.
  [[nodiscard]] int row_entry() const {
    return static_cast<int>(kNumbersOf<BristleMemory> +
                            kNumbersOf<StopMemory> *
                                ((data_.slide ? 1U : 0U) + (data_.turn ? 1U : 0U)));
  }
  /// Numbers of `memory` below: a BristleMemory, a StopMemory for each coordinate with stops, and
  /// the records of stops that are rows.
  [[nodiscard]] int memory_size() const {
    return row_entry() + rows() * static_cast<int>(kNumbersOf<UnilateralMemory>);
  }

  /// Data of the joint in a step for all functions.
  struct View {
    const PairStep& step;
    const Configuration &q_n, &q_alpha, &q_n1;
    std::array<FreeAngle, 2> angle{};  ///< About z; about the two pins of a universal joint.
    std::array<double, 2> angle_n{};   ///< Their values at t_n [rad].
    const double* memory = nullptr;
  };

  /// Adds forces, tangents and the derivatives by the multipliers (to the columns of B).
  void add(const View& view, PairTerms& terms) const;
  [[nodiscard]] Work work(const View& view) const;
  void initialize(double* memory) const;
  void commit(const View& view, double* memory) const;
  /// Smallest clearance to the stops at t_{n+1}: 1 where a stop becomes active, 0 where its force
  /// is infinite.
  [[nodiscard]] double clearance(const View& view) const;
  /// Appends velocity jumps at the end of this step.
  void impacts(const View& view, std::vector<Impact>& list) const;
  void unilateral_rows(const View& view, std::vector<UnilateralRow>& list) const;
  /// Adds the wrenches of stops that are rows, by the forces in their records.
  /// @param memory  Of the step whose forces these are.
  void add_stops(const View& view, const double* memory, Vec6& on_a, Vec6& on_b) const;
  [[nodiscard]] ResistanceReport report(const View& view) const;
  /// Adds whether friction sticks, its direction after the last step, and whether it still opposes
  /// the motion: one that has turned around in a step slips to its end.
  void pieces(const View& view, ForcePieces& pieces) const;
  /// Adds the part of its load under which each stop rests. @param memory  As View::memory.
  void stop_pieces(const double* memory, ForcePieces& pieces) const;

 private:
  static constexpr int kMax = 3;
  struct Place;
  struct Coordinate;
  struct Motion;
  struct Bristle;
  struct Slip;

  [[nodiscard]] Motion motion(const View& view, bool tangents) const;
  /// Number of friction cones; a universal joint has one for each coordinate.
  [[nodiscard]] int cones() const { return kind_ == Kind::universal ? 2 : 1; }
  [[nodiscard]] int cone_of(int coordinate) const {
    return kind_ == Kind::universal ? coordinate : 0;
  }
  [[nodiscard]] Slip slip(const View& view, int cone) const;
  [[nodiscard]] Bristle bristle(const View& view, const Motion& m) const;
  /// The bristle over the step as it is left behind: after a turn of the motion without the
  /// deflection of the old direction.
  [[nodiscard]] Bristle left_bristle(const View& view, const Motion& m) const;
  /// Reduced inertia of the joint's bodies about a world axis [kg m²].
  [[nodiscard]] double inertia_about(const Vec3& axis, const BodyStep& a, const BodyStep& b) const;
  /// Rates of the coordinates including levers, of a ball in world axes, at an instant.
  [[nodiscard]] Vec3 rates(const View& view, const Configuration& q, const BodyStep& a,
                           const BodyStep& b) const;
  /// Calls what(limits, whether of the slide, its memory) for stops that are barriers.
  template <class What>
  void for_limits(What&& what) const;
  /// Calls what(limits, whether of the slide, +1 for the lower end, limit, its record's entry) for
  /// stops that are rows.
  template <class What>
  void for_ends(What&& what) const;
  /// Values of the displacement along z, or the distance, and of the angle about z.
  [[nodiscard]] Place place(const View& view, bool slides) const;
  /// Whether it exerts no force in the step: without friction, and away from all stops at both
  /// ends.
  [[nodiscard]] bool idle(const View& view) const;
  /// Active stop of a coordinate in the step.
  [[nodiscard]] Stop stop_of(const View& view, const JointLimits& limits, bool slides,
                             const Place& place, int memory) const;

  Kind kind_;
  JointResistance data_;
};

}  // namespace polhode
