// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <polhode/io/importers/mjcf_file.hpp>

namespace polhode::io {

/// Values of an actuator after the defaults of its class. A class has one set of them, to which
/// every tag of <default> adds what it says, in the order of the file, as in MuJoCo 4.0: a tag of
/// another kind than the one before it, other than `general`, begins anew with gain, bias and
/// dynamics.
struct MjcfActuator {
  const XmlFile::Element* at = nullptr;
  std::string kind;  ///< Its own tag.
  std::string name, joint, tendon, site, reference;
  bool in_parent = false;  ///< Its moment on a ball or free joint has the axes of the parent.
  double group = 0.0;
  std::vector<double> gear{1.0, 0.0, 0.0, 0.0, 0.0, 0.0};
  std::string gain_type = "fixed", bias_type = "none", dynamics = "none";
  std::vector<double> gain{1.0, 0.0, 0.0}, bias{0.0, 0.0, 0.0};
  double time = 1.0;  ///< Constant of the dynamics [s].
  /// A range; it acts if it is given and not switched off.
  struct Range {
    std::vector<double> bounds;  ///< None or two.
    std::string limited = "auto";
    /// Bounds that act; empty: none.
    [[nodiscard]] std::vector<double> active(bool automatic) const;
  };
  Range control, force, activation;
  double inherited = 0.0;  ///< Part of the range of its joint that the control has.
  double damping = 0.0, armature = 0.0;
  bool damping_is_polynomial = false;
  double delay = 0.0;

  /// Whether it has a state of its own.
  [[nodiscard]] bool has_activation() const { return dynamics != "none" || kind == "muscle"; }
};

/// Whether a tag is one of <actuator>.
[[nodiscard]] bool is_actuator(std::string_view tag);

/// Values of the actuator that a tag describes.
[[nodiscard]] MjcfActuator actuator_values(MjcfFile& file, const XmlFile::Element& e);

/// All actuators of a file.
[[nodiscard]] std::vector<MjcfActuator> actuators_of(MjcfFile& file);

}  // namespace polhode::io
