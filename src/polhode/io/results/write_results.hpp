// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <polhode/io/results/hdf5_file.hpp>
#include <polhode/simulation/simulation_details.hpp>
#include <polhode/simulation/solid_contact_fields.hpp>
#include <polhode/simulation/solid_report.hpp>

namespace polhode::io {

/// Provenance of results, stored with them.
struct Provenance {
  std::string version{};  ///< Of Polhode.
  std::string solver{}, instruction_set{};
  std::string model_file{};              ///< Name without folders.
  std::string model_text{};              ///< As read, overrides not applied.
  std::vector<std::string> overrides{};  ///< As given with --set.
};

/// Names and shapes that determine the layout of a results file.
struct ResultsLayout {
  struct JointEntry {
    std::string name, type;
    int coordinates = 0;  ///< Free coordinates reported.
    int friction = 0;     ///< Number of them with friction; 0: none.
    int stops = 0;        ///< Number of them with limits.
    bool driven = false;  ///< Its frame has a prescribed motion.
  };
  struct LoadEntry {
    std::string name, type;
  };
  struct SolidEntry {
    std::string name;
    const solids::Mesh* mesh = nullptr;  ///< Must outlive the file.
    std::vector<Vec3> reference;         ///< Nodes at the start, world [m].
    std::vector<std::string> interfaces;
    bool touches = false;  ///< Has fields of contact.
  };
  struct BeamEntry {
    std::string name;
    std::vector<Vec3> reference;  ///< Nodes at the start, world [m].
  };
  struct CableEntry {
    std::string name;
    std::size_t pieces = 0;
  };
  std::string title{};
  std::vector<std::string> bodies{};
  std::vector<bool> nodes{};  ///< Of beams and cables: bodies without a named view.
  std::vector<JointEntry> joints{};
  std::vector<LoadEntry> loads{};
  std::vector<SolidEntry> solids{};
  std::vector<BeamEntry> beams{};
  std::vector<CableEntry> cables{};
  bool impulses = false;  ///< Of joints are reported.
  bool has_contacts = false;
  std::vector<std::string> contacts{};  ///< Recorded pairs of bodies: "a+b".

  [[nodiscard]] int coordinates() const;   ///< Of all joints.
  [[nodiscard]] int load_numbers() const;  ///< Of all loads.
  [[nodiscard]] bool is_node(std::size_t body) const { return body < nodes.size() && nodes[body]; }
};

/// Results at one time. Lists have one entry per body, joint, coordinate or number of a load of the
/// layout.
struct ResultsFrame {
  double t = 0.0;
  std::vector<Vec3> position, velocity,
      angular_velocity;           ///< Centre of mass, world [m, m/s, rad/s].
  std::vector<Quat> orientation;  ///< Body to world.
  std::vector<double> coordinates, rates, loads;
  /// Numbers of joints with these quantities, see JointReport.
  std::vector<double> friction, slips, stops, power, work;
  std::vector<Vec3> force, moment;             ///< Of a on b, at the joint's point on b, world.
  std::vector<Vec3> impulse, angular_impulse;  ///< Of joints, see JointReport; may be empty.
  std::vector<SolidReport> solids;
  std::vector<SolidContactFields> solid_contacts;        ///< By solid; empty without contact.
  std::vector<std::vector<InterfaceReport>> interfaces;  ///< By solid.
  std::vector<BeamReport> beams;
  std::vector<CableReport> cables;
  bool has_contacts = false;
  std::vector<ContactReport> contacts;
  ContactLosses losses;
  Balance balance;
  double energy_drift = 0.0;                             ///< See drifts() [-].
  double dt = 0.0;                                       ///< Length of the last step [s].
  std::int64_t steps = 0, iterations = 0, rejected = 0;  ///< Since the start.
  bool between_steps = false;  ///< Interpolated between the ends of a step.
};

[[nodiscard]] ResultsLayout results_layout(const Simulation& simulation);
[[nodiscard]] ResultsFrame results_frame(const Simulation& simulation);

/// The results file of a run, see docs/reference/results_file.md.
class ResultsFile {
 public:
  /// Starts a new file. @throws FileError
  ResultsFile(const std::string& path, const ResultsLayout& layout, const Provenance& provenance);
  /// Continues a file whose frames up to time t are kept. @throws FileError, InputError
  static ResultsFile append_to(const std::string& path, const ResultsLayout& layout, double t);

  void append(const ResultsFrame& frame);  ///< @throws FileError
  /// Stores the reasons not to trust the run, none if it is trusted, and its warnings, of which the
  /// last are left out if they are very many. @throws FileError
  void conclude(const std::vector<std::string>& distrust, const std::vector<std::string>& warnings);
  [[nodiscard]] std::size_t frames() const { return file_.frames(); }
  /// Time of the last frame; nothing if there is none.
  [[nodiscard]] std::optional<double> last_time() const { return file_.last_time(); }
  void sync() { file_.sync(); }    ///< Waits until the disk has all frames. @throws FileError
  void close() { file_.close(); }  ///< @throws FileError

 private:
  explicit ResultsFile(Hdf5File file) : file_(std::move(file)) {}
  void conclude_with(const char* trusted, const std::vector<std::string>& distrust,
                     std::vector<std::string> warnings);

  Hdf5File file_;
  std::vector<double> numbers_;
};

}  // namespace polhode::io
