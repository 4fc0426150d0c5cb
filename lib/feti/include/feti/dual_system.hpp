// What the dual problems of all load states with the same rows have in common: subdomain operators, B, F, G and the feasible set.
// DualProblem adds to it what a load state has of its own.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/context.hpp"
#include "constraint/sliding_surface.hpp"
#include "feti/body_groups.hpp"
#include "feti/dual_operator.hpp"
#include "feti/free_motions.hpp"
#include "feti/options.hpp"
#include "qp/equality.hpp"
#include "qp/feasible_set.hpp"
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
  int contact = 0;  ///< that the node is of
  Local normal = -1;
  int tangents = 0;  ///< at normal + 1 ...
  Local disc = -1;   ///< index into FeasibleSet::discs(), -1 without friction
};

/// What the first load state that rows are made for does to bodies: of the motions that nothing resists those are gauged that it
/// leaves alone.
struct FirstLoads {
  const std::vector<Eigen::VectorXd>& forces;                         ///< f of each subdomain
  const std::vector<double>& opposed;                                 ///< of each body, see drive_limits(), forces; or none
  std::span<const constraint::SlidingSurface> sliding_surfaces = {};  ///< what surfaces in contact feel, apart from facets
};

/// Nothing in it changes. Heavy, and shared by the problems and the solver that are of it: neither copies nor moves.
class DualSystem {
 public:
  /// Looks for free rigid motions and gauges those that nothing loads. Throws Error(no_equilibrium), naming the body and its
  /// motion, if a load works on a motion that nothing resists. `decomposition` and `subdomains` outlive it. Collective.
  DualSystem(const partition::Decomposition& decomposition, const partition::NodeDirectory& directory,
             const partition::Interface& interface, const constraint::Constraints& constraints, const SubdomainSystem& subdomains,
             const FirstLoads& loads, const Options& options, const Context& context, Products products);
  DualSystem(const DualSystem&) = delete;
  DualSystem& operator=(const DualSystem&) = delete;

  const JumpOperator& jump() const { return *jump_; }                    ///< B
  const DualOperator& hessian() const { return *hessian_; }              ///< F
  const qp::EqualityConstraint& equality() const { return *equality_; }  ///< G
  /// Omega but for friction: discs have infinite radii. Slip bounds belong to who solves.
  const qp::FeasibleSet& set() const { return set_; }
  const ElasticRows* springs() const { return springs_.get(); }          ///< null if there are none
  const std::vector<NodeRows>& node_rows() const { return node_rows_; }  ///< one for each contact node of this rank
  /// Owned rows of components that a coupling leaves unknown: they have columns of G of their own.
  const std::vector<Local>& unknown_components() const { return unknown_components_; }
  /// An approximation of F^-1 for one solver, whose active set it follows; null if the options want none. The system outlives it.
  /// Throws as Preconditioner. Collective.
  std::unique_ptr<qp::ActiveSetPreconditioner> make_preconditioner() const;

  const partition::Decomposition& decomposition() const { return decomposition_; }
  const SubdomainSystem& subdomains() const { return subdomains_; }
  const Clusters& clusters() const { return subdomains_.clusters; }
  const BodyGroups& groups() const { return groups_; }
  int dimension() const { return decomposition_.catalogue.dimension; }
  /// The DirectSolver by which matrices of subdomains are factorized.
  const std::string& factorization() const { return options_.factorization; }
  const Communicator& communicator() const { return comm_; }
  /// Rows of B, and the sum of the kernels' dimensions, over all ranks.
  Global dual_unknowns() const { return static_cast<Global>(jump_->rows()->getGlobalNumElements()); }
  int kernel_dimension() const { return clusters().kernel_dimension(); }

  /// Where products with F solve by rounded factors (Products::rounded), F and d are those of K~^+, both: of forces f - B'lambda
  /// that balance, the energy and so the solution change by no more than this, whatever f does alone. DualProblem::displacement()
  /// is K^+ all the same. The largest of all subdomains of all ranks; 0 if F is exact.
  double rounding() const { return hessian_->products() == Products::rounded ? rounding_ : 0; }

  /// F x - d of a load state, with `product` for F, or, where subdomains are slender, at once (DualOperator::gradient()).
  /// Collective.
  void gradient(const Operator& product, const Vector& x, const qp::RightHandSide& right, Vector& gradient) const;
  /// Whether rounding bends some subdomain of some rank (any_slender()).
  bool slender() const { return slender_; }

  /// The motions that gauges hold, in the order of the gauges' rows, which are the last ones, from jump().contact_rows().second
  /// on. FreeMotion::work and force are those of the first loads.
  const std::vector<FreeMotion>& gauged() const { return gauged_; }
  /// Of each subdomain of this rank the unknowns of these motions, or none where another body moves.
  std::vector<std::vector<Eigen::VectorXd>> gauged_motions() const;
  /// Whether nothing resists any of them, no facets either.
  bool gauges_hold_free_motions() const;
  /// The sum of the forces of gauges on the bodies, where a gauge holds a free motion against the push of facets. Collective.
  Point gauge_force(const Vector& lambda) const;
  /// A length of each body, the same on every rank.
  const std::vector<double>& body_sizes() const { return sizes_; }
  /// "body "roller.3" moves along (0, 1, 0)": the largest rigid motion in a direction `nu` along which multipliers are unbounded.
  /// Collective.
  std::string unbounded_rigid_mode(const Eigen::VectorXd& nu) const;
  /// u - R nu, u of each subdomain of this rank.
  std::vector<Eigen::VectorXd> less_motion(std::vector<Eigen::VectorXd> u, const Eigen::VectorXd& nu) const;

 private:
  using MakeRows = std::function<std::unique_ptr<const JumpOperator>(std::span<const SubdomainRow> gauges)>;
  void make_rows(const MakeRows& rows, const constraint::Constraints& constraints, const FirstLoads& loads,
                 const Context& context);
  std::vector<SubdomainRow> gauge_rigid_modes(const std::vector<FreeMotion>& motions, const std::vector<double>& opposed_loads,
                                              const Context& context);
  void make_set(const constraint::Contacts& contacts);

  const partition::Decomposition& decomposition_;
  const SubdomainSystem& subdomains_;
  const Options options_;
  const Communicator& comm_;
  Timers& timers_;
  std::unique_ptr<const JumpOperator> jump_;
  BodyGroups groups_;
  std::unique_ptr<const ElasticRows> springs_;
  std::unique_ptr<const DualOperator> hessian_;
  std::unique_ptr<const qp::EqualityConstraint> equality_;
  qp::FeasibleSet set_;
  std::vector<NodeRows> node_rows_;
  std::vector<Local> unknown_components_;
  std::vector<FreeMotion> gauged_;
  std::vector<double> sizes_;  // of the bodies
  double rounding_ = 0;
  bool slender_ = false;
};

}  // namespace mortise::feti
