// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <polhode/contact/closed_form_point.hpp>
#include <polhode/contact/contact_point.hpp>
#include <polhode/contact/contact_reports.hpp>
#include <polhode/contact/feature_pairs.hpp>
#include <polhode/geometry/broad_phase.hpp>
#include <polhode/system/body_contacts.hpp>
#include <polhode/system/contact_springs.hpp>
#include <polhode/system/impulsive_contacts.hpp>
#include <polhode/system/system.hpp>

namespace polhode::contact {

/// Contact law of two materials. Zero: chosen from the bodies (see docs/theory/contact.md).
struct ContactLaw {
  NormalPotential potential = NormalPotential::barrier;
  double stiffness = 0.0;       ///< k [N/m]; Hertz [N/m^{3/2}].
  double tolerance = 0.0;       ///< g_tol of the barrier [m].
  double reference_load = 0.0;  ///< Load of a point at gap 0 [N]; chooses the stiffness.
  double restitution = 0.0;     ///< e, 0 to 1.
  /// Hertz and linear: rebound by a damper instead (Gonthier, Carvalho and Martins), which needs
  /// some twenty steps per contact.
  bool damped = false;
  bool sensor = false;   ///< Reports contact, but exerts no force.
  FrictionLaw friction;  ///< Zero stiffness or damping: chosen.

  ContactLaw() { friction.stiffness = friction.turning_stiffness = 0.0; }
};

/// Friction and restitution of a material against itself, for pairs without a law of their own.
struct ContactMaterial {
  std::string name;
  double mu = 0.0;
  double restitution = 0.0;
};

/// A shape fixed to a body.
struct PlacedShape {
  int body = kGround;
  std::string name;
  geometry::Shape shape;
  int material = -1;                  ///< From add_material(); −1: the default law.
  std::uint32_t groups = 1;           ///< Collision groups of the shape.
  std::uint32_t meets = 0xffffffffu;  ///< Groups it collides with; both shapes have to agree.
  int owner = -2;  ///< Owner for exclude(), a number of the caller's; −2: the body.
};

/// All owners, in a switch.
inline constexpr int kEveryOwner = std::numeric_limits<int>::max();

struct BothPlaced;  // impulse_places.hpp

/// Contact between the shapes of bodies.
///
/// Candidates are found again when a body has moved by more than its margin; they are sorted, so
/// that sums do not depend on the search.
class ContactSet final : public BodyContacts, public PointwiseContacts, public ImpulsiveContacts {
 public:
  /// Adds a shape. @returns its number.
  int add_shape(PlacedShape shape);
  /// Adds a material. @returns its number. @throws InputError for values out of range.
  int add_material(const ContactMaterial& material);
  void set_default(const ContactLaw& law);
  /// Sets the law of two materials. @throws InputError for values out of range.
  void set_law(int material_a, int material_b, const ContactLaw& law);
  /// Makes contacts act by impulses. Of the laws only the coefficients of friction (isotropic,
  /// kinetic) and restitution are then used.
  void set_impulses(const ImpulseOptions& options) { impulses_ = options; }
  /// Excludes contact between the shapes of two owners (bodies, if none is given).
  void exclude(int owner_a, int owner_b);
  /// Adds a switch for the contact of two owners, or of one with kEveryOwner. Two shapes are in
  /// contact only while none of their switches is off.
  void add_switch(int owner_a, int owner_b, bool starts_off);
  /// Number of an existing switch.
  [[nodiscard]] int switch_of(int owner_a, int owner_b) const;
  /// Sets switches at an instant. Histories of points that disappear are dropped.
  void switch_over(State& state, std::span<const int> switches, bool off);
  /// Descriptions of shapes that would overlap if these were switched on.
  [[nodiscard]] std::vector<std::string> overlaps_if_on(const State& state,
                                                        std::span<const BodyStep> instants,
                                                        std::span<const int> switches);
  /// Distance of the shapes of two owners at an instant, at any distance and whether or not contact
  /// between them is allowed; negative: they overlap [m].
  [[nodiscard]] double distance(int owner_a, int owner_b, std::span<const BodyStep> instants) const;
  /// Whether contact between two shapes is allowed by bodies, groups and exclusions, with all
  /// switches on.
  [[nodiscard]] bool may_meet(const PlacedShape& a, const PlacedShape& b) const;

  [[nodiscard]] const std::vector<PlacedShape>& shapes() const { return shapes_; }
  [[nodiscard]] const ContactLaw& law(int shape_a, int shape_b) const;
  /// Results of the last step by pairs of nearby shapes; after stored() or at the start only gaps.
  [[nodiscard]] std::vector<ShapePairReport> reports() const;
  [[nodiscard]] std::vector<TouchingPoint> touching() const;
  /// Contact forces and moments about the centres of mass, last step, by body, world [N, N m].
  [[nodiscard]] const std::vector<Vec6>& wrenches() const { return wrenches_; }
  /// Energy lost in impacts and by friction and other dissipation since prepare() [J].
  [[nodiscard]] double lost_in_impacts() const { return lost_in_impacts_; }
  [[nodiscard]] double lost_by_friction() const { return lost_by_friction_; }
  /// Shapes that overlap by more than the tolerance at an instant, each pair at its deepest point.
  [[nodiscard]] std::vector<ShapeOverlap> deepest_overlaps(std::span<const BodyStep> instants);
  /// Descriptions of these overlaps: "a in b by 0.01 m".
  [[nodiscard]] std::vector<std::string> overlaps(std::span<const BodyStep> instants);
  /// Stores numbers of the caller's with the state, such as sums over the run.
  void keep_totals(State& state, const std::vector<double>& totals);
  [[nodiscard]] static std::vector<double> totals_in(const State& state);
  /// Checks the histories of a state that was read. @param where  First part of the message.
  /// @throws InputError for shapes and features that do not exist.
  void check_memory(const State& state, const std::string& where) const;
  [[nodiscard]] int point_count() const { return static_cast<int>(points_.size()); }

  ImpulsiveContacts* impulsive() override { return this; }
  PointwiseContacts* pointwise() override { return this; }
  void prepare(const System& system) override;
  bool begin_step(const State& state, std::span<const BodyStep> steps,
                  const StepContext& context) override;
  const std::vector<Participants>& pairs() const override { return pairs_; }
  bool cover(std::span<const BodyStep> steps, const StepContext& context,
             std::span<const Vec6> increments) override;
  void evaluate(std::span<const BodyStep> steps, const StepContext& context,
                std::span<PairTerms> terms) override;
  std::span<const ActingPoint> evaluate_pointwise(std::span<const BodyStep> steps,
                                                  const StepContext& context,
                                                  std::span<const char> moved) override;
  void predict(std::span<const BodyStep> steps, const StepContext& context,
               std::span<const FreeMotion> free, std::span<FreeRows> rows,
               std::vector<Vec6>& increments) const override;
  double filter(std::span<const BodyStep> steps, std::span<const Vec6> increments) override;
  double stored(const State& state, std::span<const BodyStep> instants) override;
  Work commit(State& state, std::span<const BodyStep> steps, const StepContext& context) override;
  bool touched() const override { return touched_; }
  Work impacts(State& state, std::vector<PairImpact>& list) override;
  void resting(const State& state, std::span<const int> bodies,
               std::vector<PairImpact>& list) override;
  void settled(State& state, std::span<const ResolvedImpact> impacts) override;
  std::string tightest() const override;

  const ImpulseOptions* impulses() const override { return impulses_ ? &*impulses_ : nullptr; }
  double touching_gap() const override;
  bool covers(std::span<const BodyStep> steps) const override;
  int find_points(std::span<const BodyStep> steps, const StepContext& context,
                  std::vector<ImpulsePoint>& list) override;
  void place_points(std::span<const BodyStep> steps, std::span<ImpulsePoint> list) const override;
  [[nodiscard]] double gap_after(std::span<const BodyStep> steps,
                                 const ImpulsePoint& point) const override;
  [[nodiscard]] std::pair<Vec3, Vec3> direction_after(std::span<const BodyStep> steps,
                                                      const ImpulsePoint& point) const override;
  [[nodiscard]] std::optional<std::pair<int, int>> passed(
      std::span<const BodyStep> steps) const override;
  void points_at(std::span<const BodyStep> instants,
                 std::vector<ContactInstant>& list) const override;
  [[nodiscard]] double part_on_one_side(std::span<const BodyStep> instants,
                                        std::span<const Vec6> increments) const override;
  [[nodiscard]] std::vector<ClosedRow> closed_rows(const State& state) const override;
  Work commit_impulses(State& state, std::span<const BodyStep> steps, const StepContext& context,
                       std::span<const ImpulsePoint> list, std::span<const ImpulseLoss> losses,
                       const ImpulseSearch& search) override;
  /// Contact search of the last step; all zero if contacts act by forces.
  [[nodiscard]] const ImpulseSearch& last_search() const { return search_; }

 private:
  struct Point {
    int a = 0, b = 0;      ///< Shapes, in the order of the feature pair.
    int pair = 0;          ///< Pair of bodies.
    bool swapped = false;  ///< The feature's side a is side b of the body pair.
    std::array<std::uint64_t, 2> key{};
    PointData data;
    double restitution = 0.0;
    double floor = 0.0;               ///< Of the band of a point that closes [m].
    double least_gap = 0.0;           ///< No step may end below this gap [m].
    bool damped = false;              ///< Rebounds by a damper.
    double damping_number = 0.0;      ///< c |w_pre| of a damped rebound [-].
    bool may_be_closed_form = false;  ///< Closed forms are valid at ρ∞ = 1.
    bool sensor = false;
    bool plain = false;              ///< They are valid in this step.
    double law_dt = 0.0;             ///< Step for which the law's constants were chosen [s].
    double mass = 0.0;               ///< Reduced mass of both bodies [kg].
    double rest_stiffness = 0.0;     ///< k of resting contact.
    double bristle_stiffness = 0.0;  ///< k_T, if the law does not give it [N/m].
    double rest_damping = 0.0;       ///< c of dissipative resting contact [s/m].
    bool open_stiffness = false;     ///< The law gives no stiffness.
    double force_n = 0.0;            ///< λ of the previous step, of a point closed at t_n [N].
    bool unresolved = false;         ///< Closes in an impact too short for its law and the step.
    double gap_n = 0.0;
    Vec3 normal_n = Vec3::Zero(), place_n = Vec3::Zero();  ///< At t_n, of an open point.
    bool listed = false;         ///< In the list of impulse points of this step.
    PointReport report;          ///< Of the last accepted step.
    bool touched = false;        ///< It was in contact in that step.
    double speed_n = 0.0;        ///< Along the normal at the start of the step [m/s].
    double impact_loss = 0.0;    ///< Of normal impulses [J].
    double friction_loss = 0.0;  ///< Of friction impulses [J].
    double absorbed = 0.0;       ///< Of a row: work of its normal impulse in the step [J].
    double gap_after = 0.0;      ///< Of a row, at the end of the step [m].
    Vec3 turned = Vec3::Zero();  ///< Of a row that acted: rotation of a relative to b in the step.
  };
  /// Sliding state of a point at the last iterate.
  struct Slide {
    Vec3 stretch = Vec3::Zero();  ///< Deflection of its bristle [m]; zero: it stuck.
    double share = 0.0;           ///< Part of the lagged stiffness that was applied.
    bool known = false;           ///< The step had an iterate already.
  };
  /// Placement of a body when candidates were found, and its margin from there.
  struct Reference {
    Vec3 r = Vec3::Zero();
    Mat3 Lambda = Mat3::Identity();
    double margin = -1.0;
  };

  static void damp_slide(Slide& before, PointForce& force);
  [[nodiscard]] double gravity_along(const Point& p, const Vec3& n) const;
  [[nodiscard]] double exit_speed(const Point& p, const Vec3& n, double speed) const;
  [[nodiscard]] static bool is_slack(const Point& p, double gap);
  [[nodiscard]] double slow_speed(const Point& p, double force, double dt) const;
  [[nodiscard]] double fallen(const Point& p, const Vec3& n) const;
  void set_phase(Point& p, ContactPhase phase) const;
  /// Floor of springs on shapes without bounds, whose overlap has no limit [m].
  static constexpr double kNoFloor = std::numeric_limits<double>::lowest();
  void set_band(Point& p, double stiffness, double upper, double lower) const;
  void start_band(Point& p) const;
  void store_again(Point& p, double stiffness, double energy) const;
  void keep_part(Point& p, double part) const;
  void damp_load(Point& p) const;
  void begin_phase(Point& p, double speed, double dt) const;
  [[nodiscard]] PairImpact row_at(const Point& p, const State& state) const;
  /// Whether contacts are rows of the step.
  [[nodiscard]] bool acts_by_rows() const { return impulses_ && impulses_->rigid; }
  /// Whether a row touches at t_{n+1}.
  [[nodiscard]] bool touches(const Point& p) const { return p.gap_after <= touching_gap(); }
  [[nodiscard]] std::optional<std::pair<int, int>> overlapping(
      std::span<const BodyStep> steps) const;
  [[nodiscard]] bool overlaps_at_end(const Point& p, const BodyStep& a, const BodyStep& b,
                                     double near) const;
  [[nodiscard]] bool meets_on_the_way(int point, const BodyStep& a, const BodyStep& b,
                                      double way) const;
  [[nodiscard]] std::optional<std::pair<int, int>> passing(std::span<const BodyStep> steps) const;
  bool add_turning(const Point& p, const State& state, const Vec3& n, StepRow& row) const;
  [[nodiscard]] bool crosses_now(const Point& p, const State& state) const;
  void find_rows(State& state, std::vector<PairImpact>& list);
  void close_rows(State& state, std::span<const ResolvedImpact> impacts);
  [[nodiscard]] double weight_now(const Point& p, const State& state) const;
  [[nodiscard]] std::optional<PairImpact> impact_of(Point& p, const State& state, Work& work);
  struct Followed;
  [[nodiscard]] Gap<double> gap_along(const Point& p, const FeaturePair& pair,
                                      std::span<const BodyStep> steps,
                                      std::span<const Vec6> increments, double part) const;
  [[nodiscard]] double advance_over_surface(int point, std::span<const BodyStep> steps,
                                            std::span<const Vec6> increments, double most);
  [[nodiscard]] double advance(const Followed& followed, std::span<const BodyStep> steps,
                               std::span<const Vec6> increments, double most);
  void load(const State& state);
  void save(State& state);
  [[nodiscard]] std::vector<ShapeOverlap> overlaps_at(const State& state,
                                                      std::span<const BodyStep> instants);
  [[nodiscard]] std::string words_of(const ShapeOverlap& overlap) const;
  [[nodiscard]] bool is_off(const PlacedShape& a, const PlacedShape& b) const;
  [[nodiscard]] static std::pair<int, int> owners(const PlacedShape& a, const PlacedShape& b);
  void refer(std::span<const BodyStep> steps, const StepContext& context);
  void find_candidates(double dt);
  void add_points(int a, int b, double dt, std::vector<Point>& points);
  void complete_law(Point& p, double dt) const;
  /// Lower bound of the gap at t_{n+1}, from the displacements of the bodies [m].
  [[nodiscard]] double least_gap_at_end(const Point& p, const BodyStep& a, const BodyStep& b) const;
  [[nodiscard]] double gap_at_end(int point, const BodyStep& a, const BodyStep& b) const;
  [[nodiscard]] double nearest_at_end(int point, std::span<const BodyStep> steps) const;
  [[nodiscard]] bool rolls_in(int point, const BodyStep& a, const BodyStep& b) const;
  [[nodiscard]] ImpulsePoint impulse_point(int point, const Gap<double>& at,
                                           std::span<const BodyStep> steps) const;
  [[nodiscard]] std::vector<Gap<double>> places_over_surface(int point, double reach,
                                                             const BothPlaced& at) const;
  [[nodiscard]] std::optional<double> gap_at_end_of(const ImpulsePoint& at,
                                                    std::span<const BodyStep> steps) const;
  void add_places_at(int point, const BodyStep& a, const BodyStep& b, ContactInstant made,
                     std::vector<ContactInstant>& list) const;
  void find_places(int point, std::span<const BodyStep> steps, double dt, bool again,
                   std::vector<ImpulsePoint>& list);
  [[nodiscard]] bool must_act(const ImpulsePoint& at, const BodyStep& a, const BodyStep& b,
                              double dt) const;
  /// Whether a point acts in a step that ends with this gap. @param least  Clearance of the
  /// tightest point so far, updated with tightest_ [m].
  [[nodiscard]] bool acts(int point, double gap_1, double& least);
  void open_or_close(std::span<const BodyStep> steps, const StepContext& context);
  void open_or_close(Point& p, SpherePairCache& balls, std::span<const BodyStep> steps,
                     const StepContext& context) const;
  void share_friction();
  void release_patches(std::span<const BodyStep> steps, double dt);
  [[nodiscard]] double margin_of(int body, const BodyStep& s, double dt) const;
  /// Fraction of the increments allowed by a bound on the rotation and displacement of one Newton
  /// step.
  [[nodiscard]] double sensible_part(std::span<const Vec6> increments) const;
  [[nodiscard]] double moved(int body, const Vec3& r, const Mat3& Lambda) const;
  void report_impulse(Point& p, const ImpulsePoint& at, const ImpulseLoss& loss, double dt);
  [[nodiscard]] const Reference& reference_of(int shape, const Reference& ground) const {
    const int body = shapes_[shape].body;
    return body == kGround ? ground : references_[body];
  }
  [[nodiscard]] const BodyStep& step_of(int shape, std::span<const BodyStep> steps) const {
    const int body = shapes_[shape].body;
    return body == kGround ? steps.back() : steps[body];
  }

  std::vector<PlacedShape> shapes_;
  std::vector<ContactMaterial> materials_;
  ContactLaw default_law_;
  std::map<std::pair<int, int>, ContactLaw> laws_;
  std::set<std::pair<int, int>> excluded_;
  struct Switch {
    std::pair<int, int> owners;  ///< The second may be kEveryOwner.
    [[nodiscard]] bool holds(const std::pair<int, int>& pair) const {
      return owners == pair || (owners.second == kEveryOwner &&
                                (owners.first == pair.first || owners.first == pair.second));
    }
    bool starts_off = false;
    bool off = false;  ///< In the state loaded or saved last.
  };
  std::vector<Switch> switches_;
  mutable std::map<std::pair<int, int>, ContactLaw> combined_;

  const System* system_ = nullptr;
  /// By body: its own mass and that of the solids attached to it [kg].
  std::vector<Mat3> inverse_inertia_;  ///< By body, in its axes [1/(kg m²)].
  std::vector<double> carried_mass_;
  double heaviest_ = 0.0;  ///< Largest of these among bodies with shapes [kg].
  std::vector<double> reach_of_body_, size_of_body_;
  /// Largest displacement of a body in one iteration of this step [m].
  std::vector<double> stride_;
  std::vector<Vec6> wrenches_;
  std::vector<Reference> references_;
  std::vector<Point> points_;
  std::vector<SpherePairCache> balls_;               ///< By point.
  std::vector<ActingPoint> acting_, acting_before_;  ///< At the last evaluation of forces.
  std::vector<Slide> slides_;                        ///< By point.
  bool renewed_ = true;                              ///< The points have changed since then.
  std::vector<Participants> pairs_;
  std::vector<int> settling_;  ///< Rows, or resting points near the impacts listed last.
  double step_length_ = 0.0;   ///< Of the last committed step [s].
  /// Longest step so far: choices that depend on the step are kept when a step is cut [s].
  double longest_step_ = 0.0;
  std::vector<double> saved_, totals_;
  bool loaded_ = false, touched_ = false;
  bool starts_ = false;  ///< The step is the first one.
  double lost_in_impacts_ = 0.0, lost_by_friction_ = 0.0;
  geometry::BroadPhase broad_;
  std::vector<geometry::Bounds> bounds_;
  std::vector<std::pair<int, int>> near_;
  int tightest_ = -1;
  bool pointwise_ = false;  ///< The evaluation is pointwise; closed forms differ in the last bit.
  std::optional<ImpulseOptions> impulses_;
  ImpulseSearch search_;
  /// Places of a point on a surface at the start of the step.
  struct PlacesAtStart {
    double reach = -1.0;  ///< All that are nearer are known [m].
    std::vector<Gap<double>> gaps;
  };
  std::map<int, PlacesAtStart> start_places_;  ///< By point.
};

}  // namespace polhode::contact
