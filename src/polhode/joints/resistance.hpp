// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <vector>

#include <polhode/contact_laws/normal_law.hpp>
#include <polhode/joints/parts/configuration.hpp>
#include <polhode/joints/stop.hpp>
#include <polhode/system/free_coordinate.hpp>
#include <polhode/system/pair_terms.hpp>

namespace polhode {

/// Dry friction in a joint: what slips where the bodies of the joint rub on each other.
///
/// The slip force or moment is μ times what the joint's reaction presses together, and a constant
/// part. Below it a bristle of this stiffness holds. @eq{joint-friction-limit}
struct JointFriction {
  double mu = 0.0;           ///< Coefficient [-].
  double radius = 0.0;       ///< Of the pin, sleeve or ball; of a slider: arm of M about z [m].
  double face_radius = 0.0;  ///< Mean radius of the faces that take the axial force [m].
  double length = 0.0;  ///< Of the bearing [m]; 0: moments across the axis press nothing together.
  double constant = 0.0;   ///< Slip force [N] or moment [N m] without load.
  double stiffness = 1.0;  ///< Of the bristle [N/m]; of turns alone [N m/rad].
  double damping = 0.0;    ///< Of the bristle while it holds [N s/m], [N m s/rad].
};

/// Stops of one free coordinate: barriers at both ends, with restitution.
struct JointLimits {
  double lower = -std::numeric_limits<double>::infinity();  ///< [m] or [rad]
  double upper = std::numeric_limits<double>::infinity();
  contact::NormalLaw law;    ///< Of lasting contact with each; its tolerance is the band.
  double restitution = 0.0;  ///< Speed after an impact over that before [-].
  double inertia = 0.0;      ///< That impacts stop [kg] or [kg m²]; 0: the law's stiffness does.

  [[nodiscard]] bool within(double x) const { return x >= lower && x <= upper; }
};

/// What resists the free motion of a joint.
struct JointResistance {
  std::optional<JointFriction> friction;
  /// Of the displacement along z, or the distance of a link, and of the angle about z.
  std::optional<JointLimits> slide, turn;

  [[nodiscard]] bool any() const { return friction || slide || turn; }
};

/// How friction and stops of a joint stand at an instant.
struct ResistanceReport {
  /// On b, by free coordinate [N] or [N m]; of a ball in a's joint axes.
  std::array<double, 3> friction{};
  int count = 0;                   ///< Of them.
  bool slips = false;              ///< Over the last step.
  double slide = 0.0, turn = 0.0;  ///< Of the stops, along +z or apart, on b [N], [N m].
};

/// Friction and stops over the free coordinates of a revolute, prismatic, cylindrical, spherical or
/// universal joint, and the stops of a link with slack: evaluated beside the joint's parts, with
/// the same multipliers. The cross of a universal joint turns on two pins, x of a and y of b, each
/// of which slips by itself.
class Resistance {
 public:
  enum class Kind : unsigned char {
    revolute,
    prismatic,
    cylindrical,
    spherical,
    universal,
    link  ///< Stops of a distance alone.
  };

  /// The kind of the joint type of this name; nothing if it takes no resistance.
  [[nodiscard]] static std::optional<Kind> kind_of(const std::string& type);

  Resistance(Kind kind, const JointResistance& data) : kind_(kind), data_(data) {}

  [[nodiscard]] const JointResistance& data() const { return data_; }
  [[nodiscard]] bool has_limits() const { return data_.slide || data_.turn; }
  /// Of `memory` below: the bristle, whether it slips, and those of each coordinate with stops.
  [[nodiscard]] int memory_size() const {
    return 4 + kStopMemory * ((data_.slide ? 1 : 0) + (data_.turn ? 1 : 0));
  }

  /// What all functions want to know of the joint in a step.
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
  /// Least of the gaps left at t_{n+1}: 1 where a stop begins to act, 0 where its force is
  /// infinite.
  [[nodiscard]] double clearance(const View& view) const;
  /// Velocities that jump at the end of this step.
  void impacts(const View& view, std::vector<Impact>& list) const;
  [[nodiscard]] ResistanceReport report(const View& view) const;

 private:
  static constexpr int kMax = 3;
  struct Coordinate;
  struct Motion;
  struct Bristle;
  struct Slip;

  [[nodiscard]] Motion motion(const View& view, bool tangents) const;
  /// Coordinates with one cone of friction: those of a universal joint have one each.
  [[nodiscard]] int cones() const { return kind_ == Kind::universal ? 2 : 1; }
  [[nodiscard]] int cone_of(int coordinate) const {
    return kind_ == Kind::universal ? coordinate : 0;
  }
  [[nodiscard]] Slip slip(const View& view, int cone) const;
  [[nodiscard]] Bristle bristle(const View& view, const Motion& m) const;
  /// Calls what(limits, of the slide, memory of it).
  template <class What>
  void for_limits(What&& what) const;
  /// The stop that acts on a coordinate in the step.
  [[nodiscard]] Stop stop_of(const View& view, const JointLimits& limits, bool slides,
                             const Coordinate& c, int memory) const;

  Kind kind_;
  JointResistance data_;
};

}  // namespace polhode
