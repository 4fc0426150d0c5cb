// The dual problem of one load state, and the way back to displacements.
//
//     minimise  1/2 lambda'F lambda - lambda'd   subject to  G lambda = e,  lambda in Omega,
//     F = B K^+ B',  d = B K^+ f - c,  G = R'B',  e = R'f,     u = K^+ (f - B' lambda) - R nu,
//
// where K^+ and R are those of clusters of subdomains, or of each subdomain alone, nu are the multipliers of G lambda = e [Dostal
// et al., DD20, section 3]. Each pretension section that is tightened to a force, and each component of the motion of a rigid
// coupling's point that is unknown, adds a row to G, sum of part * lambda = -force, and its shortening or motion to nu.
//
// F, G and Omega are those of a DualSystem, which all load states with the same rows of B share; f and c, and so d and e, are the
// load state's own.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "constraint/constraints.hpp"
#include "feti/drives.hpp"
#include "feti/dual_system.hpp"
#include "qp/problem.hpp"

namespace mortise::feti {

/// A vector over the unknowns of each subdomain of this rank, shared and not written to.
using SharedField = std::shared_ptr<const std::vector<Eigen::VectorXd>>;

/// A value, cheap to copy: all large parts are shared, and nobody writes to them.
class DualProblem {
 public:
  /// With a system of its own, see DualSystem, whose first loads these are. `load`: f of each subdomain. `sliding_surfaces`,
  /// `opposed_loads`: see FirstLoads. `decomposition` and `subdomains` outlive it and its copies. Throws as DualSystem.
  /// Collective.
  DualProblem(const partition::Decomposition& decomposition, const partition::NodeDirectory& directory,
              const partition::Interface& interface, std::shared_ptr<const constraint::Constraints> constraints,
              const SubdomainSystem& subdomains, std::vector<Eigen::VectorXd> load, const Options& options,
              const Context& context, std::span<const constraint::SlidingSurface> sliding_surfaces = {},
              std::vector<double> opposed_loads = {}, Products products = Products::rounded);
  /// The problem of another load state on the same system: of the same rows with other bounds, and of other loads. Nothing if
  /// the loads drive a gauged motion that facets resist: then a new system has to be built. Throws Error(no_equilibrium) as the
  /// constructor does. Collective.
  std::optional<DualProblem> with_loads(std::shared_ptr<const constraint::Constraints> constraints,
                                        std::vector<Eigen::VectorXd> load, std::vector<double> opposed_loads = {}) const;

  const DualSystem& system() const { return *system_; }
  const std::shared_ptr<const DualSystem>& shared_system() const { return system_; }

  // The quadratic programme; vectors and operators are distributed as jump().rows(). Its unknowns are the multipliers of B's
  // rows, whose scaling nobody else knows: see forces() and the functions after it.
  const JumpOperator& jump() const { return system_->jump(); }                    ///< B
  const Operator& hessian() const { return system_->hessian(); }                  ///< F
  const qp::EqualityConstraint& equality() const { return system_->equality(); }  ///< G
  const qp::FeasibleSet& set() const { return system_->set(); }                   ///< Omega, see DualSystem::set()
  const std::vector<NodeRows>& node_rows() const { return system_->node_rows(); }
  int dimension() const { return system_->dimension(); }
  const Communicator& communicator() const { return system_->communicator(); }
  /// d and e, and what they come from, f and c; without RightHandSide::driven.
  std::shared_ptr<const qp::RightHandSide> right_hand_side() const { return right_; }
  /// The same with RightHandSide::driven where there are unknowns (see Unknown), which takes one product by `counted`, which
  /// counts those with F. Collective.
  std::shared_ptr<const qp::RightHandSide> driven_right_hand_side(qp::Hessian& counted) const;

  /// What the rows of B come from, in mesh numbering.
  const constraint::Constraints& constraints() const { return *constraints_; }
  /// f of each subdomain.
  const std::vector<Eigen::VectorXd>& load() const { return right_->f; }
  /// Of each body the sum of |nodal force| over its nodes. Collective.
  std::vector<double> loads_of_bodies() const;
  /// The loads on motions that gauges hold, where they are more than rounding and facets make of others.
  std::vector<UnresistedLoad> unresisted_loads() const;
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
  /// How far each row gives way by itself under these multipliers, a length; nothing but for rows between
  /// contact nodes, and for those of friction that have no entries.
  Eigen::VectorXd given_way(const Vector& lambda) const;
  /// Radii for the discs of set() from slip bounds, forces, one for each disc.
  std::vector<double> radii(std::span<const double> slip_bounds) const;
  /// The other way: the slip bounds, forces, that the radii of `set` stand for; it has the discs of set().
  std::vector<double> slip_bounds(const qp::FeasibleSet& set) const;

  /// u of each subdomain of this rank. Who asks again and again has Displacements. Collective.
  std::vector<Eigen::VectorXd> displacement(const Vector& lambda, const Eigen::VectorXd& nu) const;
  /// K^+ (f - B'lambda) of each subdomain: u but for R nu. Collective.
  std::vector<Eigen::VectorXd> elastic(const Vector& lambda) const;
  /// K^+ f of each subdomain, as F has K^+: d was made of it. A solution takes no more solves for it unless it was let go.
  SharedField response() const;
  /// What a solved state has no more use for: response().
  void let_go_of_response() { response_.reset(); }
  /// nu of the least displacements among those that lambda leaves, u = displacement(lambda, nu): bodies are moved back along
  /// rigid motions that no row with a force feels, as far as gaps let them. A roller that rests on one node of a flat side may
  /// roll until the next one touches. Contact forces below `negligible_force` count as none. Collective.
  Eigen::VectorXd least_motion(const Vector& lambda, const Eigen::VectorXd& nu, const std::vector<Eigen::VectorXd>& u,
                               double negligible_force = 0) const;
  /// ||K u + B'lambda + B0'mu - f|| over all subdomains, B0'mu the forces inside clusters, relative to
  /// (||f||^2 + ||B'lambda||^2 + ||1e-6 D u||^2)^1/2, D the nodal stiffness (what rounding makes of a rigid motion is no force),
  /// or to `negligible_force` if that is larger. Collective.
  double imbalance(const std::vector<Eigen::VectorXd>& u, const Vector& lambda, double negligible_force = 0) const;

 private:
  DualProblem(std::shared_ptr<const DualSystem> system, std::shared_ptr<const constraint::Constraints> constraints,
              std::vector<FreeMotion> gauged, std::vector<Eigen::VectorXd> load, std::vector<double> opposed_loads);
  void make_right_hand_side(std::vector<Eigen::VectorXd> load);
  Eigen::VectorXd bound() const;

  std::shared_ptr<const DualSystem> system_;
  std::shared_ptr<const constraint::Constraints> constraints_;
  std::vector<FreeMotion> gauged_;  // DualSystem::gauged() under these loads
  std::vector<double> opposed_loads_;
  SharedField response_;
  std::shared_ptr<const qp::RightHandSide> right_;
};

}  // namespace mortise::feti
