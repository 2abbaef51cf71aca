// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <functional>
#include <set>
#include <string>
#include <vector>

#include <polhode/io/importers/feb_curves.hpp>
#include <polhode/io/importers/feb_file.hpp>
#include <polhode/io/importers/feb_mesh.hpp>
#include <polhode/io/importers/feb_solids.hpp>

namespace polhode::io {

/// One of the six freedoms of a rigid body: x, y, z, and the rotations about them.
struct FebFreedom {
  enum class Kind : unsigned char { free, fixed, prescribed };
  Kind kind = Kind::free;
  FebValue value;
  const XmlFile::Element* at = nullptr;
  bool relative = false;         ///< The value is added to that at the start of the step.
  std::vector<FebSpan> by_step;  ///< Value in each step, in place of `value`; empty: the same.
};

/// A rigid body: a material of type "rigid body".
struct FebBody {
  std::string material;  ///< As in the file.
  std::string name;      ///< In the model.
  std::int64_t id = 0;
  std::optional<std::int64_t> parent;  ///< Body to which it is locked, by its number.
  const XmlFile::Element* at = nullptr;
  geometry::MassProperties mesh;  ///< By integration; no mass without elements.
  Vec3 com = Vec3::Zero();        ///< FEBio's centre of mass, about which it rotates [m].
  Mat3 inertia = Mat3::Zero();    ///< As FEBio has it [kg m²].
  std::array<FebFreedom, 6> freedoms;
  bool euler = false;   ///< The rotations are angles about fixed axes x, y, z [deg].
  bool turned = false;  ///< A rotation is prescribed as a whole.
  /// Freedoms of single steps, by number of the step, in addition to those of all.
  std::map<std::size_t, std::array<FebFreedom, 6>> in_step;
  std::optional<Vec3> velocity, spin;
  std::vector<int> nodes;               ///< Of its elements, ascending.
  double volume = 0.0;                  ///< Of its elements [m³].
  std::set<std::string> groups, meets;  ///< Of contact; none: it does not touch.

  [[nodiscard]] bool is_fixed() const;
  [[nodiscard]] bool can_move()
      const;  ///< Whether a freedom is free, in one of the steps at least.
  /// Whether FEBio's centre of mass is that of the mesh.
  [[nodiscard]] bool is_centred() const;
};

/// A step of a file, or the whole file.
struct FebStep {
  const XmlFile::Element* at = nullptr;
  const XmlFile::Element* control = nullptr;
  double begin = 0.0, end = 0.0;   ///< [s]
  std::vector<std::string> items;  ///< Joints and loads that act in this step alone.
  std::vector<std::string> ended;  ///< Those that act from the start up to this step.
};

/// Places of a section in a file of several steps: outside them, in the first one, in any with
/// joints and loads that are switched, or in any with values that are zero in other steps.
enum class FebIn : unsigned char { file, start, step, values };

/// All that is read of an FEBio file, and the parts of the model that come from it.
struct FebModel {
  explicit FebModel(FebFile& f) : file(f), curves(f), solids(*this) {}
  FebModel(const FebModel&) = delete;
  FebModel& operator=(const FebModel&) = delete;

  FebFile& file;
  FebCurves curves;
  FebMesh mesh;
  std::vector<FebBody> bodies;
  FebSolids solids;
  bool dynamic = false;
  bool frames = false;  ///< Whether the log file asks for values that are in frames alone.
  double duration = 0.0;
  std::vector<FebStep> steps;     ///< One at least.
  const FebStep* step = nullptr;  ///< Whose section is read; null: one that acts from start to end.
  Vec3 gravity = Vec3::Zero();
  SourceNode joints, loads;
  std::set<std::string> joint_names, load_names;
  std::vector<std::string> switched;  ///< Contacts of the step that is read.
  /// Kind, "joint" or "load", and name of each connector; "" if it became none.
  std::vector<std::pair<std::string, std::string>> connectors;

  /// Number of the step that is read.
  [[nodiscard]] std::size_t step_number() const {
    return static_cast<std::size_t>(step - steps.data());
  }
  /// Value over all steps: null, held where it is then.
  /// @param of  Value of a step; null if it holds.
  [[nodiscard]] std::vector<FebSpan> spans(
      const std::function<std::optional<FebSpan>(std::size_t)>& of) const;
  /// Reads all sections of a name, in the file and in its steps.
  void each_section(const char* name, FebIn in,
                    const std::function<void(const XmlFile::Element&)>& read);
  /// Body of a tag that has its name or the number of its material; null after an error.
  FebBody* body(const XmlFile::Element& parent, const char* tag);
  /// Adds a joint or a load of a name, or of a similar one that is not taken. @returns the name.
  std::string add_joint(const XmlFile::Element& e, const std::string& name, SourceNode node);
  std::string add_load(const XmlFile::Element& e, const std::string& name, SourceNode node);
  /// Vector over time.
  SourceNode vector(const XmlFile::Element& at, const std::array<FebValue, 3>& values,
                    double factor = 1.0);
};

/// Reads materials: rigid bodies with the mass of their parts of the mesh, and those of solids.
void read_feb_materials(FebModel& model, const XmlFile::Element& section);
/// Bodies of a model file.
[[nodiscard]] SourceNode write_feb_bodies(FebModel& model);
/// Freedoms of a body as `fixed`, `hold` and `motion`.
void put_feb_freedoms(FebModel& model, const FebBody& body, const NodeBuilder& make,
                      SourceNode& node);
/// Reads <Rigid>.
void read_feb_rigid(FebModel& model, const XmlFile::Element& section);
/// Freedoms of bodies over several steps: those that are never free, and those that one of the
/// steps releases, as joints.
void settle_feb_freedoms(FebModel& model);
/// Reads one <rigid_connector>.
void read_feb_connector(FebModel& model, const XmlFile::Element& e);
/// Reads <Loads>.
void read_feb_loads(FebModel& model, const XmlFile::Element& section);
/// Reads requests for the log file as probes.
void read_feb_output(FebModel& model, const XmlFile::Element& section, SourceNode& probes);
/// Reads the steps of a file. @returns whether each has a <Control>.
bool read_feb_steps(FebModel& model);
/// Reads <Control> of all steps: whether the analysis is dynamic, and their times.
void read_feb_control(FebModel& model);
/// Analysis and output of a model file; after the load curves.
/// @param probes  Without keys: none.
void write_feb_control(FebModel& model, SourceNode probes, SourceNode& root);
/// Events that switch what acts in one step of several.
void write_feb_steps(FebModel& model, SourceNode& root);

/// Errors about elements without a domain and domains whose material does not exist.
/// @param materials  The section of materials; may be null.
void check_feb_domains(FebModel& model, const XmlFile::Element* materials);

}  // namespace polhode::io
