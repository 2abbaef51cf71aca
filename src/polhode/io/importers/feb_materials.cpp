// SPDX-License-Identifier: Apache-2.0
#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>
#include <polhode/io/importers/feb_law.hpp>
#include <polhode/io/importers/feb_model.hpp>

namespace polhode::io {

bool FebLaw::put_isotropic(const Element& e) {
  const auto E = file_.number(e, "E"), v = file_.number(e, "v");
  if (!E || !v) {
    if (file_.child(e, "E") == nullptr || file_.child(e, "v") == nullptr)
      file_.xml.fault(e, "the material has no <E> or <v>", "Give both.");
    return false;
  }
  make_.put(node_, "youngs_modulus", make_.number(*E));
  make_.put(node_, "poisson_ratio", make_.number(*v));
  return true;
}

bool FebLaw::put_ogden_terms(const Element& e) {
  int count = 0;
  for (int k = 1; k <= 6; ++k) {
    const double c = file_.number(e, format("c{}", k).c_str()).value_or(0.0);
    const double m = file_.number(e, format("m{}", k).c_str()).value_or(1.0);
    if (c == 0.0) continue;
    ++count;
    make_.put(node_, format("c{}", count), make_.number(c));
    make_.put(node_, format("m{}", count), make_.number(m));
  }
  if (count > 0) return true;
  file_.xml.fault(e, "the material has no stiffness", "Give <c1> and <m1>.");
  return false;
}

bool FebLaw::has_pressure_model(const Element& e, int model) {
  const Element* given = file_.child(e, "pressure_model");
  if (given == nullptr || file_.number(e, "pressure_model") == model) return true;
  file_.refuse(*given, format("only <pressure_model> {} is read of this material", model),
               "Leave it out.");
  return false;
}

bool FebLaw::add_bulk(const Element& e, int model) {
  uncoupled_ = true;
  bulk_ += file_.number(e, "k").value_or(0.0);
  return has_pressure_model(e, model);
}

bool FebLaw::put_matrix(const Element& e, const std::string& type, const Mat3& outer) {
  const auto put = [&](const char* kind) { make_.put(node_, "type", make_.text(kind)); };
  const auto number = [&](const char* tag) { return file_.number(e, tag).value_or(0.0); };
  const auto copy = [&](const char* key, const char* tag) {
    make_.put(node_, key, make_.number(number(tag)));
  };
  if (type == "neo-hookean") {
    put("neo_hookean");
    return put_isotropic(e);
  }
  if (type == "isotropic elastic" || type == "st.venant-kirchhoff") {
    put("elastic");
    return put_isotropic(e);
  }
  if (type == "mooney-rivlin" || type == "trans iso mooney-rivlin") {
    put("mooney_rivlin_uncoupled");
    copy("c1", "c1");
    copy("c2", "c2");
    if (!add_bulk(e, 0)) return false;
    if (type == "mooney-rivlin") return true;
    if (const Element* active = file_.child(e, "active_contraction"))
      file_.refuse(*active, "<active_contraction> is not read", "Add a muscle to the model.");
    isochoric_.push_back(true);
    SourceNode fibre = fibre_node(e, "toe", {{"c3", "c3"}, {"c4", "c4"}, {"c5", "c5"}});
    make_.put(fibre, "straight_stretch", make_.number(file_.number(e, "lam_max").value_or(1.0)));
    return put_direction(e, outer, std::move(fibre));
  }
  if (type == "coupled mooney-rivlin") {
    put("mooney_rivlin");
    copy("c1", "c1");
    copy("c2", "c2");
    // The bulk term of FEBio is k/2 ln(J)^2, that of the model (lame - 4 c2)/2 ln(J)^2.
    make_.put(node_, "lame", make_.number(number("k") + 4.0 * number("c2")));
    return true;
  }
  if (type == "ogden") {
    put("ogden_uncoupled");
    return add_bulk(e, 0) && put_ogden_terms(e);
  }
  if (type == "ogden unconstrained") {
    put("ogden");
    copy("lame", "cp");
    return put_ogden_terms(e);
  }
  if (type == "veronda-westmann") {
    put("veronda_westmann");
    copy("c1", "c1");
    copy("c2", "c2");
    return add_bulk(e, 0);
  }
  if (type == "holzapfel-gasser-ogden") {
    put("holzapfel_gasser_ogden");
    copy("shear_modulus", "c");
    return add_bulk(e, 3) && put_arterial_fibres(e, outer);
  }
  file_.refuse(e, format("the material {} of type {} is not read", quote(name_), quote(type)),
               "Materials are rigid body, neo-Hookean, isotropic elastic, St.Venant-Kirchhoff, "
               "Mooney-Rivlin, trans iso Mooney-Rivlin, coupled Mooney-Rivlin, Ogden, Ogden "
               "unconstrained, Veronda-Westmann, Holzapfel-Gasser-Ogden, and mixtures of one of "
               "them with fibres; and viscoelastic ones of these.");
  return false;
}

bool FebLaw::put_law(const Element& e, const std::string& type, const Mat3& outer) {
  if (type == "viscoelastic" || type == "uncoupled viscoelastic") {
    if (&e == &at_) return put_viscoelastic(type);
    file_.refuse(e, "a viscoelastic material within another one is not read", "Give one of them.");
    return false;
  }
  if (type == "solid mixture" || type == "uncoupled solid mixture")
    return put_mixture(e, type, outer);
  return put_matrix(e, type, outer);
}

bool FebLaw::put_viscoelastic(const std::string& type) {
  constexpr int kTerms = 6;
  relaxes_ = true;
  const Element* part = file_.child(at_, "elastic");
  if (part == nullptr) {
    file_.xml.fault(at_, "the material has no <elastic>", "Give its elastic part.");
    return false;
  }
  const std::optional<Mat3> outer = axes(at_);
  const std::string kind = file_.type(*part);
  const bool uncoupled = type == "uncoupled viscoelastic";
  // The pressure is that of the outer material, whose standard model is another one.
  if (uncoupled && !has_pressure_model(at_, 0)) return false;
  if (uncoupled && kind == "holzapfel-gasser-ogden") {
    file_.refuse(*part, "Holzapfel-Gasser-Ogden in an uncoupled viscoelastic material is not read",
                 "Use a Mooney-Rivlin material with fibres: there the pressure is another one.");
    return false;
  }
  if (!outer || !put_law(*part, kind, *outer)) return false;
  if (uncoupled_ != uncoupled) {
    file_.refuse(*part,
                 uncoupled
                     ? "the elastic part of an uncoupled viscoelastic material is not uncoupled"
                     : "the elastic part of a viscoelastic material is uncoupled: its "
                       "pressure would relax, too",
                 uncoupled ? "Use a viscoelastic material." : "Use an uncoupled viscoelastic one.");
    return false;
  }
  bulk_ += uncoupled ? file_.number(at_, "k").value_or(0.0) : 0.0;
  static_cast<void>(file_.number(*part, "density"));  // not used by FEBio either
  std::vector<SourceNode> terms;
  for (int k = 1; k <= kTerms; ++k) {
    const double g = file_.number(at_, format("g{}", k).c_str()).value_or(0.0);
    const double t = file_.number(at_, format("t{}", k).c_str()).value_or(1.0);
    if (g == 0.0) continue;
    SourceNode& term = terms.emplace_back(make_.map());
    make_.put(term, "modulus_ratio", make_.number(g));
    make_.put(term, "time", make_.number(t));
  }
  if (terms.empty()) {
    file_.xml.fault(at_, "the material has no terms", "Give <g1> and <t1>.");
    return false;
  }
  make_.put(node_, "relaxation", make_.list(std::move(terms)));
  if (const double rest = file_.number(at_, "g0").value_or(1.0); rest != 1.0)
    make_.put(node_, "long_term_ratio", make_.number(rest));
  return true;
}

bool FebLaw::put_mixture(const Element& e, const std::string& type, const Mat3& around) {
  sum_of_coupled_ = type == "solid mixture";
  const std::optional<Mat3> turned = axes(e);
  if (!turned) return false;
  const Mat3 outer = around * *turned;
  if (!has_pressure_model(e, 0)) return false;
  std::vector<SourceNode> matrices;
  double density = 0.0;
  for (const Element* part = e.FirstChildElement("solid"); part != nullptr;
       part = part->NextSiblingElement("solid")) {
    file_.xml.mark_read(*part);
    const std::string kind = file_.type(*part);
    density += file_.number(*part, "density").value_or(1.0);
    if (is_fibre(kind)) {
      if (!put_fibre(*part, kind, outer)) return false;
      continue;
    }
    if (kind.find("fiber") != std::string::npos) {
      file_.refuse(*part, format("fibres of type {} are not read", quote(kind)),
                   "Fibres are fiber-exp-pow, fiber-pow-linear and fiber-exp-linear, and the same "
                   "uncoupled.");
      return false;
    }
    if (!sum_of_coupled_ && kind == "holzapfel-gasser-ogden") {
      file_.refuse(*part, "Holzapfel-Gasser-Ogden in an uncoupled mixture is not read",
                   "Give it by itself: the mixture has another pressure.");
      return false;
    }
    node_ = make_.map();
    if (!put_matrix(*part, kind, outer)) return false;
    matrices.push_back(std::move(node_));
  }
  if (matrices.empty()) {
    file_.refuse(e, "a mixture of fibres alone is not read", "Give one material and fibres.");
    return false;
  }
  std::optional<SourceNode> sum = matrices.size() == 1 ? std::optional(std::move(matrices.front()))
                                                       : sum_of_laws(make_, matrices);
  if (!sum) {
    file_.refuse(
        e, "a mixture of two materials that are not fibres, and not of one family, is not read",
        "Give one of them, and fibres; sums of neo-Hookean and coupled Mooney-Rivlin, of "
        "Mooney-Rivlin and Ogden, and of Ogden unconstrained are read.");
    return false;
  }
  node_ = std::move(*sum);
  for (const bool isochoric : isochoric_)
    if (isochoric != uncoupled_) {
      file_.refuse(e, "a mixture of materials with coupled and with uncoupled response is not read",
                   uncoupled_ ? "Use uncoupled fibres." : "Use fibres that are not uncoupled.");
      return false;
    }
  // The bulk modulus of the mixture, if it has one, stands for those of its parts.
  if (const double own = file_.number(e, "k").value_or(0.0); own != 0.0 && uncoupled_) bulk_ = own;
  if (sum_of_coupled_ && !relaxes_) {
    // FEBio's rule, also where the mixture has a density.
    make_.put(node_, "density", make_.number(density));
    if (file_.number(e, "density").value_or(density) != density)
      file_.approximated(e, format("the density of a solid mixture is the sum of those of its "
                                   "parts, {:g}; those without one have 1",
                                   density));
  }
  return true;
}

std::optional<SourceNode> FebLaw::read(const std::string& type) {
  if (!put_law(at_, type, Mat3::Identity())) return std::nullopt;
  if (!local_.empty()) own_ = axes(at_).value_or(Mat3::Identity());
  for (Vec3& direction : local_) direction = own_.transpose() * direction;
  if (uncoupled_) make_.put(node_, "bulk_modulus", make_.number(bulk_));
  if (fibres_.size() == 1) make_.put(node_, "fibre", std::move(fibres_[0]));
  if (fibres_.size() > 1) make_.put(node_, "fibre", make_.list(std::move(fibres_)));
  if (!sum_of_coupled_ || relaxes_)
    make_.put(node_, "density", make_.number(file_.number(at_, "density").value_or(1.0)));
  return std::move(node_);
}

void FebSolids::read_material(const XmlFile::Element& e, const std::string& type) {
  FebFile& file = model_.file;
  const std::string given = file.xml.text(e, "name").value_or("");
  const auto id = file.id(e);
  const std::string name = given.empty() ? format("material{}", id.value_or(0)) : given;
  if (type == "linear truss") {
    static_cast<void>(file.number(e, "v"));  // the area, which no force depends on
    trusses_[name] = {file.number(e, "E").value_or(0.0), file.number(e, "density").value_or(1.0)};
    if (!(trusses_[name].modulus > 0.0))
      file.xml.fault(e, format("<E> of {} is {}", quote(name), trusses_[name].modulus),
                     "Give a value above zero.");
    return;
  }
  if (type == "linear beam") return read_beam_material(e, name);
  FebLaw law(file, e, name);
  std::optional<SourceNode> node = law.read(type);
  if (!node) return;
  if (materials_.contains(name)) {
    file.xml.fault(e, format("the material {} stands twice", quote(name)), "Rename one of them.");
    return;
  }
  FebMaterial material;
  material.node = std::move(*node);
  material.uncoupled = law.uncoupled();
  material.fibres = law.local_directions();
  material.axes = law.own_axes();
  material.name = file.name(e, name, material_names_);
  materials_.emplace(name, std::move(material));
}

}  // namespace polhode::io
