// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <initializer_list>
#include <optional>
#include <string>
#include <vector>

#include <polhode/io/importers/feb_file.hpp>

namespace polhode::io {

/// A material of an FEBio file that is read as one of a model: a matrix with families of fibres.
class FebLaw {
 public:
  using Element = XmlFile::Element;

  /// @param name  As in the file, for messages.
  FebLaw(FebFile& file, const Element& e, std::string name)
      : file_(file), at_(e), name_(std::move(name)), make_(file.make(e)), node_(make_.map()) {}

  /// Reads a material of a type; nothing, with an error, if it is unknown or wrong.
  std::optional<SourceNode> read(const std::string& type);
  /// Whether it is of an uncoupled type, of which hexahedra are three-field elements.
  [[nodiscard]] bool uncoupled() const { return uncoupled_ && !sum_of_coupled_; }
  /// Directions of its fibres, family by family, in the axes of its own <mat_axis>.
  [[nodiscard]] const std::vector<Vec3>& local_directions() const { return local_; }
  [[nodiscard]] const Mat3& own_axes() const { return own_; }

 private:
  /// A law of fibres; null if the type is none.
  struct FibreLaw {
    const char* law = nullptr;
    bool isochoric = false;
  };
  static FibreLaw fibre_law(const std::string& type);
  static bool is_fibre(const std::string& type);

  bool put_law(const Element& e, const std::string& type, const Mat3& outer);
  bool put_mixture(const Element& e, const std::string& type, const Mat3& outer);
  /// Reads a material whose stress relaxes: its elastic part, and the terms of its series.
  bool put_viscoelastic(const std::string& type);
  bool put_matrix(const Element& e, const std::string& type, const Mat3& outer);
  bool put_isotropic(const Element& e);
  bool put_ogden_terms(const Element& e);
  /// Whether a material has the pressure model that is read; else an error.
  bool has_pressure_model(const Element& e, int model);
  /// Adds k to the bulk modulus.
  bool add_bulk(const Element& e, int model);
  bool put_fibre(const Element& e, const std::string& type, const Mat3& outer);
  bool put_arterial_fibres(const Element& e, const Mat3& outer);
  bool put_direction(const Element& e, const Mat3& outer, SourceNode fibre);
  SourceNode fibre_node(const Element& e, const char* law,
                        std::initializer_list<std::array<const char*, 2>> parameters);
  /// Direction in the world's axes; nothing after an error. @param outer  Axes of a mixture.
  std::optional<Vec3> fibre_direction(const Element& e, const Mat3& outer);
  /// Axes of <mat_axis>, by columns; nothing after an error.
  std::optional<Mat3> axes(const Element& e);

  FebFile& file_;
  const Element& at_;
  std::string name_;
  NodeBuilder make_;
  SourceNode node_;
  std::vector<SourceNode> fibres_;
  std::vector<Vec3> local_;      ///< Their directions: of the world, until all are read.
  Mat3 own_ = Mat3::Identity();  ///< Axes of the material as a whole.
  bool relaxes_ = false;         ///< It is a viscoelastic one, of which others are parts.
  std::vector<bool> isochoric_;  ///< By family, also those without stiffness.
  bool uncoupled_ = false, sum_of_coupled_ = false;
  double bulk_ = 0.0;  ///< Of an uncoupled material [Pa].
};

/// A material whose energy is the sum of those of several, without density, bulk modulus and
/// fibres; nothing if no material of a model is.
[[nodiscard]] std::optional<SourceNode> sum_of_laws(const NodeBuilder& make,
                                                    const std::vector<SourceNode>& laws);

}  // namespace polhode::io
