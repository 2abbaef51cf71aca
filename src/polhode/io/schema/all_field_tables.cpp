// SPDX-License-Identifier: Apache-2.0
// Every table of the model file, in the order of the reference page.
#include <polhode/io/schema/field_table.hpp>

namespace polhode::io {

std::vector<const FieldTable*> all_field_tables() {
  std::vector<const FieldTable*> tables = {
      &model_fields(),       &part_fields(),    &import_fields(),       &units_fields(),
      &body_fields(),        &inertia_fields(), &orientation_fields(),  &euler_fields(),
      &body_motion_fields(), &motion_fields(),  &moving_euler_fields(), &moving_quaternion_fields(),
      &shape_fields(),       &mesh_fields(),    &hull_fields(),         &height_field_fields(),
      &contact_side_fields()};
  for (const KindTable& kind : joint_tables()) tables.push_back(&kind.table);
  for (const KindTable& kind : friction_tables()) tables.push_back(&kind.table);
  tables.push_back(&angle_limit_fields());
  tables.push_back(&stroke_limit_fields());
  tables.push_back(&distance_limit_fields());
  tables.push_back(&strength_fields());
  tables.push_back(&enforcement_fields());
  for (const KindTable& kind : load_tables()) tables.push_back(&kind.table);
  for (const KindTable& kind : material_tables()) tables.push_back(&kind.table);
  tables.push_back(&viscosity_fields());
  tables.push_back(&relaxation_fields());
  for (const KindTable& kind : fibre_tables()) tables.push_back(&kind.table);
  for (const KindTable& kind : section_tables()) tables.push_back(&kind.table);
  tables.push_back(&beam_fields());
  tables.push_back(&beam_contact_fields());
  tables.push_back(&cable_fields());
  tables.push_back(&cable_contact_fields());
  tables.push_back(&muscle_fields());
  tables.push_back(&obstacle_fields());
  tables.push_back(&solid_fields());
  tables.push_back(&solid_mesh_fields());
  tables.push_back(&solid_contact_fields());
  for (const KindTable& kind : mesh_generator_tables()) tables.push_back(&kind.table);
  for (const FieldTable* table : {&region_fields(),
                                  &prescribed_fields(),
                                  &selection_fields(),
                                  &plane_fields(),
                                  &box_fields(),
                                  &sphere_fields(),
                                  &contacts_fields(),
                                  &contact_law_fields(),
                                  &contact_material_fields(),
                                  &contact_combination_fields(),
                                  &contact_pair_fields(),
                                  &contact_sensor_fields(),
                                  &time_table_fields(),
                                  &law_table_fields(),
                                  &event_fields(),
                                  &condition_fields(),
                                  &controller_fields(),
                                  &controlled_value_fields(),
                                  &analysis_fields(),
                                  &output_fields(),
                                  &probe_fields()})
    tables.push_back(table);
  return tables;
}

}  // namespace polhode::io
