// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/schema/field_table.hpp>

namespace polhode::io {

using enum FieldKind;

const FieldTable& import_fields() {
  static const FieldTable table{
      "import",
      "A file of another program whose bodies, joints and loads become those of this model. What "
      "this file "
      "gives for them in addition, or instead, is kept. Allowed in a file of its own, not in a "
      "part.",
      {
          {.name = "file",
           .kind = kText,
           .meaning =
               "URDF, xacro, MJCF, SDFormat or FEBio file, relative to the folder of this file.",
           .required = true},
          {.name = "base",
           .kind = kChoice,
           .meaning = "Whether the first link is fixed or moves freely.",
           .standard = "fixed",
           .choices = {"fixed", "floating"}},
          {.name = "fixed_joints",
           .kind = kChoice,
           .meaning = "Whether links connected by fixed joints are bodies of their own, welded, or "
                      "one body. Links without mass are always merged.",
           .standard = "weld",
           .choices = {"weld", "merge"}},
          {.name = "shapes",
           .kind = kChoice,
           .meaning = "Shapes that bodies get: visual for pictures, collision for contact.",
           .standard = "visual",
           .choices = {"visual", "collision", "none"}},
          {.name = "limits",
           .kind = kBoolean,
           .meaning = "Whether limits of joints are stops.",
           .standard = "true"},
          {.name = "friction",
           .kind = kBoolean,
           .meaning = "Whether joints have their dry friction.",
           .standard = "true"},
          {.name = "actuators",
           .kind = kBoolean,
           .meaning = "Whether actuators are motors and servos, with zero as their set points; "
                      "URDF and SDFormat have none.",
           .standard = "true"},
          {.name = "keyframe",
           .kind = kText,
           .meaning = "Keyframe of an MJCF at which the model starts: its name, or its number from "
                      "0 if it has none; none: the start is the reference.",
           .standard = "the first of the file",
           .since = "0.2"},
          {.name = "allow_partial",
           .kind = kBoolean,
           .meaning = "Whether what cannot be represented may be left out, with a note.",
           .standard = "false"},
          {.name = "package_paths",
           .kind = kNames,
           .meaning = "Folders that contain the packages of package:// names and the models of "
                      "model:// names, relative to the folder of this file."},
          {.name = "start",
           .kind = kVariables,
           .meaning = "Coordinate at the start by joint, in rad and m or with a unit; a list for "
                      "joints with several. Left out: 0, or the limit nearest to it."},
          {.name = "arguments",
           .kind = kVariables,
           .meaning = "Arguments of a xacro file by name."},
      }};
  return table;
}

}  // namespace polhode::io
