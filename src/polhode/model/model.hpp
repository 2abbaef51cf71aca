// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <polhode/core/source_location.hpp>
#include <polhode/core/time_function.hpp>
#include <polhode/core/types.hpp>
#include <polhode/dynamics/turning_frame.hpp>
#include <polhode/joints/enforcement.hpp>
#include <polhode/joints/frame_motion.hpp>
#include <polhode/loads/load_function.hpp>
#include <polhode/model/beam_spec.hpp>
#include <polhode/model/contact_spec.hpp>
#include <polhode/model/controller_spec.hpp>
#include <polhode/model/event_spec.hpp>
#include <polhode/model/material_spec.hpp>
#include <polhode/model/probe_spec.hpp>
#include <polhode/model/solid_spec.hpp>

namespace polhode {

/// Description of a shape of a body, for drawing, mass and contact, in body axes.
struct ShapeSpec {
  /// box, sphere, cylinder, capsule, cone, ellipsoid, tube, mesh, hull, height_field, plane.
  std::string type;
  std::vector<double> sizes;     ///< As in the file, full lengths [m]; plane: its normal.
  std::string file;              ///< Mesh file, resolved against the model file's folder.
  double scale = 1.0;            ///< Of a mesh file: metres per unit.
  std::vector<Vec3> points;      ///< Of a hull [m].
  std::vector<double> heights;   ///< Of a height field, row by row [m].
  int columns = 0;               ///< Of a height field.
  double spacing = 0.0;          ///< Of a height field [m].
  Vec3 position = Vec3::Zero();  ///< Of the shape in body coordinates [m].
  Quat orientation = Quat::Identity();
  std::optional<double> density;  ///< [kg/m^3]; else the body's.
  ContactSideSpec contact;
  SourceLocation place;
};

/// Description of a rigid body; all vectors in SI.
struct BodySpec {
  std::string name;
  SourceLocation place;
  bool fixed = false;
  bool point_mass = false;
  double mass = 0.0;             ///< [kg], resolved (from shapes if not given).
  Mat3 inertia = Mat3::Zero();   ///< About the centre of mass, body axes [kg m^2], resolved.
  Vec3 position = Vec3::Zero();  ///< Centre of mass, world [m], resolved.
  Quat orientation = Quat::Identity();
  Vec3 com = Vec3::Zero();       ///< Centre of mass in the body coordinates the user writes [m].
  Vec3 velocity = Vec3::Zero();  ///< Of the centre of mass, world [m/s].
  Vec3 angular_velocity = Vec3::Zero();  ///< World [rad/s].
  std::vector<ShapeSpec> shapes;         ///< In the user's body coordinates (subtract com for Z).
  std::string node_of;                   ///< Name of the beam or cable it is a node of, or empty.
  ContactSideSpec contact;               ///< Of all its shapes.
  std::string color;                     ///< In pictures, "#rrggbb"; empty: chosen by the page.
};

/// Description of a joint's dry friction; absent values are chosen from the bodies' weights.
struct JointFrictionSpec {
  double mu = 0.0;           ///< [-]
  double radius = 0.0;       ///< Of pin, sleeve or ball; of a slider: arm of its twist [m].
  double face_radius = 0.0;  ///< Mean radius of the faces with the axial force [m].
  double length = 0.0;       ///< Of the bearing [m]; 0: moments normal to the axis have no effect.
  double constant = 0.0;     ///< Slip force [N] or moment [N m] without load.
  std::optional<double> stiffness{}, damping{};  ///< Of the bristle [N/m], [N s/m] or by angle.
};

/// Stops of a joint's angle [rad] or displacement [m].
struct JointLimitsSpec {
  std::optional<double> lower{}, upper{};
  double restitution = 0.0;                   ///< [-]
  std::optional<double> band{}, stiffness{};  ///< Width of the stop's barrier; [N/m] or [N m/rad].
};

/// Description of a joint. Frames are body-fixed, relative to each centre of mass (ground: the
/// world).
struct JointSpec {
  std::string name, type;
  SourceLocation place;
  int a = kGround, b = kGround;  ///< Indices into Model::bodies.
  Vec3 Z_a = Vec3::Zero(),
       Z_b = Vec3::Zero();  ///< Joint point from the centre of mass, body axes [m].
  Mat3 R_a = Mat3::Identity(),
       R_b = Mat3::Identity();  ///< Joint axes as columns, body components; z is the joint's axis.
  std::vector<std::string> free;             ///< Generic joint: subset of x, y, z, rx, ry, rz.
  std::map<std::string, double> parameters;  ///< Further values of the kind, e.g. distance.
  std::optional<JointFrictionSpec> friction;
  std::optional<JointLimitsSpec> limits;  ///< Of the angle; with a displacement, of that.
  /// Of the angle of a joint that also has a displacement.
  std::optional<JointLimitsSpec> angle_limits;
  std::optional<FrameMotion> motion;            ///< Prescribed, of the frame on a.
  std::optional<JointEnforcement> enforcement;  ///< None: exact, by multipliers.
  JointStrengthSpec breaks;                     ///< None: it never breaks.
  bool assembled_start = false;  ///< Given with at_body or moving: the start must be assembled.
};

/// A coordinate of a coupling in addition to its first one.
struct CoordinateSpec {
  std::string joint, coordinate;  ///< Of the joint; "": its only one.
  double factor = 1.0;            ///< First coordinate per this one, SI.
};

/// Description of a load; the relevant fields depend on the type (see loads/registry).
struct LoadSpec {
  std::string name, type;  ///< force, moment, spring_damper, torsional_spring, gravity ...
  SourceLocation place;
  int a = kGround, b = kGround;  ///< Bodies; single-body loads act on b.
  std::string joint;             ///< Of a torsional spring or motor.
  std::string coordinate;        ///< Of a motor: "x" ... "rz"; "": the joint's only one.
  std::string drive;             ///< Of a motor: meaning of `value`, a key of LoadKind::drives.
  Vec3 Z_a = Vec3::Zero(),
       Z_b = Vec3::Zero();  ///< Points from the centres of mass, body axes (ground: world) [m].
  bool body_fixed = false;  ///< Components rotate with the body (follower).
  std::optional<TimeVector>
      vector;             ///< Force [N], moment [N m], traction [Pa] or acceleration [m/s^2].
  TimeFunctionPtr value;  ///< Pressure [Pa], or the function of a motor.
  int solid = -1;         ///< Of a load on a solid: index into Model::solids.
  /// Solids at the two ends of a spring, in whose mesh's own coordinates Z_a or Z_b then is; -1: a
  /// body or the ground. `solid` is one of them.
  std::array<int, 2> end_solids{-1, -1};
  std::vector<solids::Selection> selection;  ///< Its nodes or faces; empty: all.
  bool follower = false;           ///< A pressure that follows the surface and its present area.
  std::string keeps = "momentum";  ///< Of a follower pressure: whether momentum or work is exact.
  std::map<std::string, double>
      parameters;  ///< stiffness, damping, free_length, free_angle ... SI. Absent = default.
  /// Laws of a coordinate or a rate by key, SI: functions of that instead of time.
  std::map<std::string, TimeFunctionPtr> laws;
  std::map<std::string, std::string> words;             ///< Choices by key.
  std::map<std::string, Mat6> matrices;                 ///< By key, SI.
  std::string joint_2, coordinate_2;                    ///< Of a gear: its second coordinate.
  std::vector<CoordinateSpec> others{};                 ///< Of a coupling.
  Mat3 R_a = Mat3::Identity(), R_b = Mat3::Identity();  ///< Axes of a bushing, as Z_a and Z_b.
  /// Function given in code, in addition to vector or value: of the point of a force or moment, of
  /// the coordinate of a motor or the distance of an axial force.
  LoadFunction of_motion{};
  PartAxes part_axes{};  ///< Axes of of_motion.

  /// Whether it connects a point of a solid to another point.
  [[nodiscard]] bool has_end_on_solid() const { return end_solids[0] >= 0 || end_solids[1] >= 0; }
  /// Whether it has numbers to record: all but loads on the nodes and faces of solids.
  [[nodiscard]] bool reports() const { return solid < 0 || has_end_on_solid(); }
};

struct OutputSpec {
  std::optional<double> every;  ///< [s]; left out: every step.
  /// Records may be between the ends of automatic steps, see DenseOutput; else steps end at them.
  bool between_steps = true;
  std::vector<ProbeSpec> probes;
  bool paraview = false, csv = true, hdf5 = true;
};

/// Type and settings of the analysis.
struct AnalysisSpec {
  std::string type = "dynamics";    ///< dynamics | statics | modes.
  double duration = 1.0;            ///< [s]
  std::optional<double> step;       ///< [s]; absent: automatic.
  std::optional<double> tolerance;  ///< Error per step for automatic steps [-].
  double rho_inf = 1.0;
  std::optional<int> order;  ///< 2 to 12; absent: 2, or chosen from tolerance.
  /// Way to orders above 2: automatic | composition | extrapolation.
  std::string method = "automatic";
  std::string momentum_rate = "momentum";  ///< momentum | kinematic | kinematic_corrected.
  std::string solver = "automatic";        ///< automatic | tree | block_lu | klu | sparse_lu.
  std::string jacobian = "automatic";      ///< every_iteration | every_step | automatic | never.
  std::string isa = "automatic";           ///< automatic | baseline | avx2 | avx512.
  bool conserving = true;                  ///< Potentials in discrete-gradient form.
  double newton_tolerance = 0.0;           ///< 0: default of the order [-].
  std::optional<int> max_iterations;       ///< Absent: 12; solids 30; statics 25.
  bool line_search = true;
  double max_step_rotation = 2.0;  ///< Largest |Theta| of a step [-].
  /// Largest displacement by the assembly [m or rad]; 0: default.
  double assembly_tolerance = 0.0;
  std::optional<double> min_step, max_step;  ///< [s]
  bool smooth_multipliers = true;            ///< Smooth-multiplier start (rigid.md 7.3).
  std::optional<int> load_steps;  ///< Statics: equal parts of the load; absent: automatic.
  /// Statics: end of a history, along which functions of time act as they stand [s]; absent: all
  /// loads grow to their full size.
  std::optional<double> history;
  int count = 10;                     ///< Number of modes.
  std::string about = "equilibrium";  ///< Modes: equilibrium | start.
  /// Modes: speeds of a steady spin, in whose frame they are seen [rad/s]; none: at rest.
  std::vector<double> spin;
  std::optional<Vec3> spin_axis;        ///< Absent: that of the velocities at the start.
  std::optional<Vec3> spin_through;     ///< A point of the axis [m]; absent: likewise, or origin.
  std::string spin_ground = "stands";   ///< stands | turns.
  std::optional<TurningFrame> turning;  ///< Statics in this frame; set for modes about a spin.
  double checkpoint_every = 0.0;        ///< Wall-clock seconds; 0: only at the end.
  /// Threads of one run, which do not change its results; absent: chosen by the model's size.
  std::optional<int> threads;
  SourceLocation place;
};

/// The model as described by the user: plain data, SI units, with names and source locations.
struct Model {
  std::string title;
  std::string source_file;      ///< "" when built in code.
  Vec3 gravity = Vec3::Zero();  ///< [m/s^2]
  std::vector<BodySpec> bodies;
  std::vector<JointSpec> joints;
  std::vector<LoadSpec> loads;
  std::vector<MaterialSpec> materials;
  std::vector<SolidSpec> solids;
  std::vector<BeamSpec> beams;        ///< Meshed: their nodes are among the bodies.
  std::vector<CableLineSpec> cables;  ///< Divided into segments.
  ContactsSpec contacts;
  std::vector<EventSpec> events;
  std::vector<ControllerSpec> controllers;
  AnalysisSpec analysis;
  OutputSpec output;

  [[nodiscard]] int body_index(
      const std::string& name) const;  ///< kGround for "ground"; throws InputError if unknown.
  [[nodiscard]] const std::string& body_name(int body) const;  ///< "ground" for kGround.
  /// Name of a side of contact.
  [[nodiscard]] const std::string& side_name(const Side& side) const;
  [[nodiscard]] int joint_index(const std::string& name) const;  ///< Throws InputError if unknown.
  [[nodiscard]] int material_index(
      const std::string& name) const;                            ///< Throws InputError if unknown.
  [[nodiscard]] int solid_index(const std::string& name) const;  ///< Throws InputError if unknown.
  [[nodiscard]] int load_index(const std::string& name) const;   ///< Likewise.
  [[nodiscard]] int beam_index(const std::string& name) const;   ///< Likewise.
  [[nodiscard]] int cable_index(const std::string& name) const;  ///< Likewise.
  [[nodiscard]] int controller_index(const std::string& name) const;  ///< Likewise.
  [[nodiscard]] int probe_index(const std::string& name) const;  ///< In output.probes; likewise.
};

/// An object of a model whose numbers are reported in a run.
struct Reported {
  std::string where;              ///< Path of the request, for messages.
  const ProbeSpec* of = nullptr;  ///< Owned by the model.
};
/// Probes, and channels of events and controllers.
[[nodiscard]] std::vector<Reported> reported(const Model& model);

}  // namespace polhode
