// The whole dual problem of an assembly: subdomain operators, B, F, G, e, d and the feasible set, and the way back to
// displacements.
//
//     minimise  1/2 lambda'F lambda - lambda'd   subject to  G lambda = e,  lambda in Omega,
//     F = B K^+ B',  d = B K^+ f - c,  G = R'B',  e = R'f,     u = K^+ (f - B' lambda) - R nu,
//
// where K^+ and R are those of clusters of subdomains, or of each subdomain alone, nu are the multipliers of G lambda = e [Dostal
// et al., DD20, section 3]. Each pretension section that is tightened to a force, and each component of the motion of a rigid
// coupling's point that is unknown, adds a row to G, sum of part * lambda = -force, and its shortening or motion to nu.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/context.hpp"
#include "feti/body_groups.hpp"
#include "feti/drives.hpp"
#include "feti/dual_operator.hpp"
#include "feti/free_motions.hpp"
#include "feti/options.hpp"
#include "feti/preconditioner.hpp"
#include "qp/problem.hpp"

namespace mortise::feti {

/// Stiffness and kernel of what floats: the clusters of this rank's subdomains, in the order of Decomposition::subdomains.
struct SubdomainSystem {
  Clusters clusters;
  std::vector<std::vector<double>> nodal_stiffness;  ///< as given to the NodeDirectory
  fem::Kinematics kinematics = fem::Kinematics::solid;
};

/// Where the multipliers of a contact node stand in the dual vector of this rank.
struct NodeRows {
  Local normal = -1;
  int tangents = 0;  ///< at normal + 1 ...
  Local disc = -1;   ///< index into FeasibleSet::discs(), -1 without friction
};

/// Heavy: neither copies nor moves, for its parts refer to each other.
class DualProblem {
 public:
  /// `load`: f of each subdomain. Looks for free rigid motions and gauges those that nothing loads. `sliding_surfaces`: what
  /// surfaces in contact feel, apart from facets. `opposed_loads`: of each body, see drive_limits(), forces; or none. Throws
  /// Error(no_equilibrium), naming the body and its motion, if a load works on a motion that nothing resists. `decomposition` and
  /// `system` outlive it. Collective.
  DualProblem(const partition::Decomposition& decomposition, const partition::NodeDirectory& directory,
              const partition::Interface& interface, constraint::Constraints constraints, const SubdomainSystem& system,
              std::vector<Eigen::VectorXd> load, const Options& options, const Context& context,
              std::span<const constraint::SlidingSurface> sliding_surfaces = {}, std::vector<double> opposed_loads = {});
  DualProblem(const DualProblem&) = delete;
  DualProblem& operator=(const DualProblem&) = delete;
  /// Another right-hand side, of the same rows with other bounds, and of other loads; everything else stays. Returns false, and
  /// changes nothing, if the new loads drive a gauged motion that facets resist: then a new problem has to be built.
  /// Throws Error(no_equilibrium) as the constructor does. Collective.
  bool update_rhs(constraint::Constraints constraints, std::vector<Eigen::VectorXd> load, std::vector<double> opposed_loads = {});

  // The quadratic programme; vectors and operators are distributed as jump().rows(). Its unknowns are the multipliers of B's
  // rows, whose scaling nobody else knows: see forces() and the functions after it.
  const JumpOperator& jump() const { return *jump_; }                    ///< B
  const Operator& hessian() const { return *hessian_; }                  ///< F
  const qp::EqualityConstraint& equality() const { return *equality_; }  ///< G
  /// d and e, and what they come from, f and c; without RightHandSide::driven.
  std::shared_ptr<const qp::RightHandSide> right_hand_side() const { return right_; }
  /// The same with RightHandSide::driven where there are unknowns (see Unknown), which takes one product by `counted`, which
  /// counts those with F. Collective.
  std::shared_ptr<const qp::RightHandSide> driven_right_hand_side(qp::Hessian& counted) const;
  /// Omega but for friction: discs have infinite radii. Slip bounds belong to who solves.
  const qp::FeasibleSet& set() const { return set_; }
  qp::ActiveSetPreconditioner* preconditioner() const { return preconditioner_.get(); }  ///< null if the options want none
  const ElasticRows* springs() const { return springs_.get(); }                          ///< null if there are none
  const std::vector<NodeRows>& node_rows() const { return node_rows_; }  ///< one for each contact node of this rank

  /// Where factors are rounded to single precision (SubdomainOperator::rounding), F and d are those of K~^+, both: of forces f -
  /// B'lambda that balance, the energy and so the solution change by no more than rounding(), whatever f does alone.
  /// displacement() is K^+ all the same. From be_exact() on F and d are those of K^+, too, at three times the price of a product:
  /// for what compares them with matrices.
  void be_exact();
  /// The largest of all subdomains of all ranks; 0 if F is exact.
  double rounding() const { return hessian_->rounded() ? rounding_ : 0; }

  /// What the rows of B come from, in mesh numbering.
  const constraint::Constraints& constraints() const { return constraints_; }
  /// f of each subdomain.
  const std::vector<Eigen::VectorXd>& load() const { return right_->f; }
  /// Of each body the sum of |nodal force| over its nodes. Collective.
  std::vector<double> loads_of_bodies() const;
  const BodyGroups& groups() const { return groups_; }
  int dimension() const { return decomposition_.catalogue.dimension; }
  const Clusters& clusters() const { return system_.clusters; }
  /// The DirectSolver by which matrices of subdomains are factorized.
  const std::string& factorization() const { return factorization_; }
  const Communicator& communicator() const { return comm_; }
  /// Rows of B, and the sum of the kernels' dimensions, over all ranks.
  Global dual_unknowns() const { return static_cast<Global>(jump_->rows()->getGlobalNumElements()); }
  int kernel_dimension() const { return system_.clusters.kernel_dimension(); }
  /// The shortening of each of constraints().pretension_sections, given or found: a length, the same on every rank.
  std::vector<double> shortenings(const Eigen::VectorXd& nu) const;
  /// Where in nu the unknown motions of rigid couplings begin, in the order of constraint::unknown_motions(): behind the kernels'
  /// coordinates and the shortenings that are unknown.
  Eigen::Index first_coupling_motion() const;

  // Between the unknowns of the quadratic programme and what engineers measure, of owned rows as they were given.
  /// The force of each row, of gluing rows that between the copies.
  Eigen::VectorXd forces(const Vector& lambda) const;
  /// The other way.
  Vector multipliers(const Eigen::VectorXd& forces) const;
  /// What is left between row . u and the bound of each row, a length, where the programme has this gradient and nu.
  Eigen::VectorXd gaps(const Vector& gradient, const Eigen::VectorXd& nu) const;
  /// The other way.
  Vector gradient(const Eigen::VectorXd& gaps, const Eigen::VectorXd& nu) const;
  /// row . u of each row, a length. Collective.
  Eigen::VectorXd jumps(const std::vector<Eigen::VectorXd>& u) const;
  /// How far each row gives way by itself under these multipliers, a length: see JumpOperator::compliance().
  Eigen::VectorXd given_way(const Vector& lambda) const;
  /// Radii for the discs of set() from slip bounds, forces, one for each disc.
  std::vector<double> radii(std::span<const double> slip_bounds) const;
  /// The other way: the slip bounds, forces, that the radii of `set` stand for; it has the discs of set().
  std::vector<double> slip_bounds(const qp::FeasibleSet& set) const;

  /// u of each subdomain of this rank. Collective.
  std::vector<Eigen::VectorXd> displacement(const Vector& lambda, const Eigen::VectorXd& nu) const;
  /// The same without a solution of every subdomain if the last product was that with lambda: a difference of what loads and
  /// multipliers do alone, which loses figures where these are large beside it, as on thin plates. Collective.
  std::vector<Eigen::VectorXd> displacement_of_product(const Vector& lambda, const Eigen::VectorXd& nu) const;
  /// nu of the least displacements among those that lambda leaves: bodies are moved back along rigid motions that no row with a
  /// force feels, as far as gaps let them. A roller that rests on one node of a flat side may roll until the next one touches.
  /// Contact forces below `negligible_force` count as none. Collective.
  Eigen::VectorXd least_motion(const Vector& lambda, const Eigen::VectorXd& nu, double negligible_force = 0) const;
  /// "body "roller.3" moves along (0, 1, 0)": the largest rigid motion in a direction `nu` along which multipliers are unbounded.
  /// Collective.
  std::string unbounded_rigid_mode(const Eigen::VectorXd& nu) const;
  /// The sum of the forces of gauges on the bodies, where a gauge holds a free motion against the push of facets. Collective.
  Point gauge_force(const Vector& lambda) const;
  /// Whether nothing resists any of the motions that gauges hold, no facets either.
  bool gauges_hold_free_motions() const;
  /// These motions, in the order of the gauges' rows, which are the last ones, from jump().contact_rows().second on: of each
  /// subdomain of this rank the unknowns, or none where another body moves.
  std::vector<std::vector<Eigen::VectorXd>> gauged_motions() const;
  /// The loads on motions that gauges hold, where they are more than rounding and facets make of others.
  std::vector<UnresistedLoad> unresisted_loads() const;
  /// ||K u + B'lambda + B0'mu - f|| over all subdomains, B0'mu the forces inside clusters, relative to
  /// (||f||^2 + ||B'lambda||^2 + ||1e-6 D u||^2)^1/2, D the nodal stiffness (what rounding makes of a rigid motion is no force),
  /// or to `negligible_force` if that is larger. Collective.
  double imbalance(const std::vector<Eigen::VectorXd>& u, const Vector& lambda, double negligible_force = 0) const;

 private:
  void gauge_rigid_modes(const partition::NodeDirectory& directory, const partition::Interface& interface,
                         std::span<const constraint::SlidingSurface> sliding_surfaces, const std::vector<Eigen::VectorXd>& load,
                         const Context& context);
  void make_rows(const partition::NodeDirectory& directory, const partition::Interface& interface,
                 std::span<const SubdomainRow> gauges);
  void make_equality(SparseMatrix g);
  void make_set();
  void make_rhs(std::vector<Eigen::VectorXd> load);
  Eigen::VectorXd bound() const;
  std::vector<Eigen::VectorXd> less_motion(std::vector<Eigen::VectorXd> u, const Eigen::VectorXd& nu) const;
  static DriveLimits limits(const FreeMotion& motion, const std::vector<double>& opposed_loads);

  const partition::Decomposition& decomposition_;
  constraint::Constraints constraints_;
  const SubdomainSystem& system_;
  std::string factorization_;
  const Communicator& comm_;
  std::unique_ptr<JumpOperator> jump_;
  BodyGroups groups_;
  std::unique_ptr<ElasticRows> springs_;
  std::unique_ptr<DualOperator> hessian_;
  std::unique_ptr<Preconditioner> preconditioner_;
  std::unique_ptr<qp::EqualityConstraint> equality_;
  std::shared_ptr<const qp::RightHandSide> right_;  // replaced, never written to
  qp::FeasibleSet set_;
  std::vector<NodeRows> node_rows_;
  std::vector<FreeMotion> gauged_;
  std::vector<double> opposed_loads_;
  std::vector<double> sizes_;  // of the bodies
  // K^+ (f - B'lambda) of the last lambda that was asked for: an error, a norm and how far displacements fit ask in turn.
  struct Elastic {
    Eigen::VectorXd lambda;
    std::vector<Eigen::VectorXd> displacement;
  };
  mutable std::optional<Elastic> last_;
  std::vector<Eigen::VectorXd> loaded_;  // K^+ f, as F has K^+
  double rounding_ = 0;
};

}  // namespace mortise::feti
