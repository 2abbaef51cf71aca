// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstring>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>
#include <polhode/solids/materials/kernels.hpp>
#include <polhode/solids/materials/laws.hpp>
#include <polhode/solids/materials/registry.hpp>

namespace polhode::solids {
namespace {

/// Parameter that all fibres have in common.
constexpr const char* kDispersion = "dispersion";

template <class... Law>
std::vector<MaterialKind> kinds_of(LawList<Law...>) {
  return {Law::kind()...};
}

/// Constructs the law of that number in the list and stores its bytes.
template <class Use, class... Law>
void with_law(LawList<Law...>, int index, const ParameterValues& values, const Use& use) {
  int i = 0;
  ((i++ == index ? use(Law::from(values)) : void()), ...);
}

const MaterialKind& find(const std::vector<MaterialKind>& kinds, std::string_view where,
                         std::string_view name, std::string_view what) {
  std::vector<std::string> names;
  for (const MaterialKind& kind : kinds) {
    if (kind.name == name || (!kind.also.empty() && kind.also == name)) return kind;
    names.push_back(kind.name);
  }
  throw InputError(where, format("the {} {} is not known", what, quote(name)),
                   did_you_mean(name, names) + "Use one of: " + name_list(names));
}

/// Reports errors of laws with the path of the material.
template <class Do>
void told_at(std::string_view where, const Do& act) {
  try {
    act();
  } catch (const InputError& e) {
    if (e.where() != "moduli") throw;
    throw InputError(where, e.what_is_wrong(), e.hint());
  }
}

}  // namespace

/// Maker of a Material.
struct MaterialMaker {
  std::string_view where;
  const MaterialDescription& description;

  std::unique_ptr<const Material> operator()() const {
    auto m = std::make_unique<Material>();
    m->kind_ = &find(material_kinds(), where, description.kind, "type");
    m->law_index_ = static_cast<int>(m->kind_ - material_kinds().data());
    const ParameterValues values = checked_values(where, *m->kind_, description.values);
    told_at(where, [&] {
      with_law(MaterialLaws{}, m->law_index_, values, [&](const auto& law) {
        static_assert(sizeof law <= sizeof m->law_);
        std::memcpy(m->law_.data(), &law, sizeof law);
        m->linear_ = law.linear();
      });
    });
    add_fibres(*m);
    m->viscous_ = viscous(*m);
    check_relaxation();
    m->relaxation_ = description.relaxation;
    m->long_term_ratio_ = description.long_term_ratio;
    return m;
  }

 private:
  void add_fibres(Material& m) const {
    const bool one = description.fibres.size() == 1;
    for (std::size_t i = 0; i < description.fibres.size(); ++i) {
      const FibreDescription& given = description.fibres[i];
      const std::string place = one ? format("{}.fibre", where) : format("{}.fibre.{}", where, i);
      const MaterialKind& kind = find(fibre_kinds(), place, given.law, "law");
      const ParameterValues values = checked_values(place, kind, given.values);
      Fibre fibre;
      fibre.index = static_cast<int>(&kind - fibre_kinds().data());
      fibre.dispersion = values.at(kDispersion);
      told_at(place, [&] {
        with_law(FibreLaws{}, fibre.index, values, [&](const auto& law) {
          static_assert(sizeof law <= sizeof fibre.law);
          std::memcpy(fibre.law.data(), &law, sizeof law);
        });
      });
      m.fibres_.push_back(fibre);
    }
  }

  void check_relaxation() const {
    const std::vector<Relaxation>& terms = description.relaxation;
    const double rest = description.long_term_ratio;
    if (terms.empty() && rest != 1.0)
      throw InputError(where, "'long_term_ratio' is given without 'relaxation'",
                       "Give the terms that relax, or leave it out");
    if (!std::isfinite(rest) || rest < 0.0)
      throw InputError(where, format("'long_term_ratio' is {:g}", rest),
                       "Give a ratio that is not negative");
    if (terms.size() > static_cast<std::size_t>(kMostRelaxations))
      throw InputError(
          format("{}.relaxation", where),
          format("there are {} terms, and at most {} are possible", terms.size(), kMostRelaxations),
          "Give fewer terms: one for each decade of time is usually enough");
    for (std::size_t i = 0; i < terms.size(); ++i) {
      const std::string place = format("{}.relaxation.{}", where, i);
      const auto check = [&](const char* name, double value) {
        if (!std::isfinite(value) || value <= 0.0)
          throw InputError(place, format("'{}' is {:g}", name, value), "Give a value above zero");
      };
      check("modulus_ratio", terms[i].ratio);
      check("time", terms[i].time);
    }
  }

  LinearModuli viscous(const Material& m) const {
    const std::string place = format("{}.viscosity", where);
    const double tau = description.relaxation_time;
    const LinearModuli own = description.viscous;
    const auto check = [&](const char* name, double value, bool good, const char* hint) {
      if (!std::isfinite(value) || !good)
        throw InputError(place, format("'{}' is {:g}", name, value), hint);
    };
    check("relaxation_time", tau, tau >= 0.0, "Give a time that is not negative");
    check("shear", own.shear, own.shear >= 0.0, "Give a viscosity that is not negative");
    check("lame", own.lame, own.lame >= -2.0 / 3.0 * own.shear,
          "Give at least -2/3 of 'shear': less would create energy");
    if (tau == 0.0) return own;
    if (own.lame != 0.0 || own.shear != 0.0)
      throw InputError(place, "'relaxation_time' and viscous moduli are both given",
                       "Give one or the other");
    const double shear = tau * m.linear().shear;
    return {m.uncoupled() ? -2.0 / 3.0 * shear : tau * m.linear().lame, shear};
  }
};

const std::vector<MaterialKind>& material_kinds() {
  static const std::vector<MaterialKind> kinds = kinds_of(MaterialLaws{});
  return kinds;
}

const std::vector<MaterialKind>& fibre_kinds() {
  static const std::vector<MaterialKind> kinds = [] {
    std::vector<MaterialKind> list = kinds_of(FibreLaws{});
    for (MaterialKind& kind : list)
      kind.parameters.push_back({kDispersion, "-", 0.0, 0.0, 1.0 / 3.0,
                                 "κ: spread of the directions, from 0, all along one, to 1/3, all "
                                 "alike"});
    return list;
  }();
  return kinds;
}

const MaterialKind& material_kind(std::string_view name) {
  return find(material_kinds(), "materials", name, "type");
}

const MaterialKind& fibre_kind(std::string_view name) {
  return find(fibre_kinds(), "fibre", name, "law");
}

std::unique_ptr<const Material> make_material(std::string_view where,
                                              const MaterialDescription& description) {
  return MaterialMaker{where, description}();
}

namespace {

/// n scalars in every lane.
template <int n>
struct alignas(64) Lanes {
  static constexpr int kMax = 8;
  double value[n * kMax];

  Lanes() = default;
  Lanes(const Eigen::Matrix<double, n, 1>& v, int width) {
    for (int i = 0; i < n; ++i)
      for (int l = 0; l < width; ++l) value[i * width + l] = v[i];
  }
};

}  // namespace

MaterialPoint discrete_stress(const Material& material, const Vec6& E_0, const Vec6& E_1,
                              const Vec3& A, bool whole) {
  const std::vector<Vec3> all(material.fibres().size(), A);
  return discrete_stress(material, E_0, E_1, std::span<const Vec3>(all), whole);
}

double strain_energy(const Material& material, const Vec6& E, const Vec3& A, bool whole) {
  const std::vector<Vec3> all(material.fibres().size(), A);
  return strain_energy(material, E, std::span<const Vec3>(all), whole);
}

MaterialPoint discrete_stress(const Material& material, const Vec6& E_0, const Vec6& E_1,
                              std::span<const Vec3> A, bool whole) {
  const MaterialKernels& kernels = material_kernels("baseline");
  const int w = kernels.width;
  const Lanes<6> E0(E_0, w), E1(E_1, w);
  Lanes<6> S;
  Lanes<36> D;
  kernels.laws[material.law_index()].stress(material.law(), whole, E0.value, E1.value, S.value,
                                            D.value);
  for (std::size_t f = 0; f < material.fibres().size(); ++f) {
    const Fibre& fibre = material.fibres()[f];
    const Lanes<3> a(A[f], w);
    kernels.fibres[fibre.index].add_stress(fibre.law.data(), material.uncoupled(), fibre.dispersion,
                                           a.value, E0.value, E1.value, S.value, D.value);
  }
  MaterialPoint point;
  for (int i = 0; i < 6; ++i) {
    point.S[i] = S.value[i * w];
    for (int j = 0; j < 6; ++j) point.D(i, j) = D.value[(6 * i + j) * w];
  }
  return point;
}

double strain_energy(const Material& material, const Vec6& E, std::span<const Vec3> A, bool whole) {
  const MaterialKernels& kernels = material_kernels("baseline");
  const Lanes<6> e(E, kernels.width);
  Lanes<1> W;
  kernels.laws[material.law_index()].energy(material.law(), whole, e.value, W.value);
  for (std::size_t f = 0; f < material.fibres().size(); ++f) {
    const Fibre& fibre = material.fibres()[f];
    const Lanes<3> a(A[f], kernels.width);
    kernels.fibres[fibre.index].add_energy(fibre.law.data(), material.uncoupled(), fibre.dispersion,
                                           a.value, e.value, W.value);
  }
  return W.value[0];
}

}  // namespace polhode::solids
