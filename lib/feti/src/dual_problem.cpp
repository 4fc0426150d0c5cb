#include "feti/dual_problem.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.hpp"
#include "exactly_free.hpp"
#include "feti/preconditioner_kind.hpp"
#include "gauge.hpp"
#include "neutral_motions.hpp"
#include "row_scaling.hpp"

namespace mortise::feti {

namespace {

std::string describe(const FreeMotion& motion, const std::vector<mesh::Body>& bodies, const std::vector<double>& sizes)
{
  const auto& first = motion.motions.front();
  std::string text = fmt::format("body \"{}\" {}", bodies[static_cast<std::size_t>(first.body)].name,
                                 describe(first, sizes[static_cast<std::size_t>(first.body)]));
  if (motion.motions.size() > 1) text += fmt::format(", and {} other bodies with it", motion.motions.size() - 1);
  return text;
}

std::string driven_by_loads(const FreeMotion& motion, const std::vector<mesh::Body>& bodies, const std::vector<double>& sizes)
{
  constexpr double small = 1e-2;
  return fmt::format("\n  {}, driven by its loads{}", describe(motion, bodies, sizes),
                     motion.work < small ? fmt::format(" with {:.2g} % of them", 100 * motion.work) : "");
}

// Whether no other motion moves its bodies.
bool moves_alone(const FreeMotion& motion, const std::vector<FreeMotion>& all)
{
  const auto moves = [](const FreeMotion& other, int body) {
    return std::ranges::any_of(other.motions, [&](const RigidMotion& part) { return part.body == body; });
  };
  return std::ranges::none_of(all, [&](const FreeMotion& other) {
    return &other != &motion &&
           std::ranges::any_of(motion.motions, [&](const RigidMotion& part) { return moves(other, part.body); });
  });
}

[[noreturn]] void throw_driven(const std::string& motions)
{
  throw Error(ExitStatus::no_equilibrium,
              "no equilibrium: no support or contact resists these motions:" + motions +
                  "\nhold the body by a support, let a contact (perhaps with friction) reach it, or remove the load");
}

}  // namespace

DualProblem::DualProblem(const partition::Decomposition& decomposition, const partition::NodeDirectory& directory,
                         const partition::Interface& interface, constraint::Constraints constraints,
                         const SubdomainSystem& system, std::vector<Eigen::VectorXd> load, const Options& options,
                         const Context& context, std::span<const constraint::SlidingSurface> sliding_surfaces,
                         std::vector<double> opposed_loads)
    : decomposition_(decomposition),
      constraints_(std::move(constraints)),
      system_(system),
      factorization_(options.factorization),
      comm_(context.comm),
      opposed_loads_(std::move(opposed_loads))
{
  for (const auto& subdomain : system.clusters.subdomains()) rounding_ = std::max(rounding_, subdomain->rounding());
  rounding_ = comm_.max(rounding_);
  make_rows(directory, interface, {});
  gauge_rigid_modes(directory, interface, sliding_surfaces, load, context);
  groups_ = body_groups(decomposition, *jump_, constraints_.prescribed, comm_);
  if (!constraints_.springs.rows.empty()) springs_ = std::make_unique<ElasticRows>(constraints_.springs, *jump_, comm_);
  hessian_ = std::make_unique<DualOperator>(*jump_, system.clusters, context.timers, springs_.get());
  make_set();
  if (const auto& kind = preconditioner_kind(options.preconditioner).kind)
    preconditioner_ =
        std::make_unique<Preconditioner>(*kind, decomposition, *jump_, system.clusters.subdomains(), system.nodal_stiffness,
                                         set_.discs(), options.factorization, context.timers, comm_, springs_.get());
  make_rhs(std::move(load));
}

void DualProblem::make_rows(const partition::NodeDirectory& directory, const partition::Interface& interface,
                            std::span<const SubdomainRow> gauges)
{
  jump_ =
      std::make_unique<JumpOperator>(decomposition_, directory, interface, constraints_.prescribed, constraints_.skew_supports,
                                     constraints_.contacts, gauges, comm_, constraints_.mean_motions, constraints_.springs);
}

void DualProblem::make_equality(SparseMatrix g)
{
  if (const auto more = unknowns(constraints_, *jump_, dimension()); !more.empty()) g = with_unknowns(g, more, *jump_);
  equality_ = std::make_unique<qp::EqualityConstraint>(std::move(g), comm_);
}

// c of B u = c, as B's rows are scaled: the bounds of the jumps, and the shortenings that are given.
Eigen::VectorXd DualProblem::bound() const
{
  Eigen::VectorXd c = jump_->bound(constraints_);
  for (const auto& section : constraints_.pretension_sections)
    if (!section.preload.force)
      for (const auto& [row, part] : section.rows) {
        const auto at = jump_->ranges().contacts + static_cast<Local>(row);
        c[at] += RowScaling::of(*jump_)[at] * (part * section.preload.shortening);
      }
  return c;
}

void DualProblem::be_exact()
{
  if (rounding() == 0) return;
  hessian_->be_exact();
  make_rhs(right_->f);
}

void DualProblem::make_rhs(std::vector<Eigen::VectorXd> load)
{
  loaded_ = load;
  system_.clusters.apply_inverse(loaded_, hessian_->rounded());
  Vector d = jump_->apply(loaded_);
  Eigen::VectorXd c = bound();
  view(d) -= c;

  Eigen::VectorXd e = load_coordinates(system_.clusters, load, comm_);
  const auto kernels = e.size();
  std::vector<double> forces;
  for (const auto& unknown : unknowns(constraints_, *jump_, dimension())) forces.push_back(-unknown.force);
  const auto count = static_cast<Eigen::Index>(forces.size());
  e.conservativeResize(kernels + count);
  e.tail(count) = Eigen::Map<const Eigen::VectorXd>(forces.data(), count);
  right_ =
      std::make_shared<const qp::RightHandSide>(qp::RightHandSide{std::move(d), std::move(e), {}, std::move(load), std::move(c)});
}

// Driven by the multipliers of least norm that balance the forces of the unknowns and move no body.
std::shared_ptr<const qp::RightHandSide> DualProblem::driven_right_hand_side(qp::Hessian& counted) const
{
  const auto count = right_->e.size() - kernel_dimension();
  if (count == 0) return right_;
  Eigen::VectorXd alone = Eigen::VectorXd::Zero(right_->e.size());
  alone.tail(count) = right_->e.tail(count);
  Vector balancing(jump_->rows()), product(jump_->rows());
  equality_->add_transpose(1, equality_->solve(alone), balancing);
  counted.apply(balancing, product);
  auto result = *right_;
  result.driven = std::move(product);
  return std::make_shared<const qp::RightHandSide>(std::move(result));
}

DriveLimits DualProblem::limits(const FreeMotion& motion, const std::vector<double>& opposed_loads)
{
  double opposed = 0;
  for (const auto& part : motion.motions)
    if (!opposed_loads.empty()) opposed += opposed_loads[static_cast<std::size_t>(part.body)];
  return drive_limits(motion, motion.force > 0 ? opposed / motion.force : 0);
}

std::vector<UnresistedLoad> DualProblem::unresisted_loads() const
{
  std::vector<UnresistedLoad> result;
  for (const auto& motion : gauged_) {
    if (!motion.sliding && motion.resistance >= exactly_free) continue;
    const double limit = limits(motion, opposed_loads_).told;
    const auto body = static_cast<std::size_t>(motion.motions.front().body);
    if (motion.work > limit) result.push_back(unresisted_load(motion, limit, sizes_[body]));
  }
  return result;
}

bool DualProblem::update_rhs(constraint::Constraints constraints, std::vector<Eigen::VectorXd> load,
                             std::vector<double> opposed_loads)
{
  // What loads at the points of couplings work on a motion is not among the loads of the subdomains.
  if (!gauged_.empty() && !constraints.couplings.empty()) return false;
  std::string loaded;
  std::vector<FreeMotion> now;
  for (const auto& motion : gauged_) {
    now.push_back(loaded_by(motion, decomposition_, load, comm_));
    if (now.back().work <= limits(now.back(), opposed_loads).refused) continue;
    if (!motion.sliding && motion.resistance >= exactly_free) return false;
    loaded += driven_by_loads(now.back(), decomposition_.catalogue.bodies, sizes_);
  }
  if (!loaded.empty()) throw_driven(loaded);
  gauged_ = std::move(now);
  opposed_loads_ = std::move(opposed_loads);
  constraints_ = std::move(constraints);
  last_.reset();
  make_rhs(std::move(load));
  return true;
}

void DualProblem::gauge_rigid_modes(const partition::NodeDirectory& directory, const partition::Interface& interface,
                                    std::span<const constraint::SlidingSurface> sliding_surfaces,
                                    const std::vector<Eigen::VectorXd>& load, const Context& context)
{
  SparseMatrix g = coarse_rows(*jump_, system_.clusters, comm_);
  const auto motions = find_free_motions(decomposition_, *jump_, system_.clusters, system_.kinematics, g, constraints_,
                                         unknowns(constraints_, *jump_, dimension()), sliding_surfaces, load, comm_);
  for (const auto& frame : body_frames(decomposition_, comm_)) sizes_.push_back(frame.radius);
  const auto& bodies = decomposition_.catalogue.bodies;
  std::vector<SubdomainRow> gauges;
  std::string loaded;
  int silent = 0;
  for (const auto& motion : motions) {
    const bool free = motion.sliding || motion.resistance < exactly_free;
    if (motion.work > limits(motion, opposed_loads_).refused) {
      // What is hardly resisted is left to the solver; what nothing but facets resists has no equilibrium.
      if (free) loaded += driven_by_loads(motion, bodies, sizes_);
      continue;
    }
    gauges.push_back(gauge(motion, moves_alone(motion, motions), decomposition_, system_.nodal_stiffness, comm_));
    gauged_.push_back(motion);
    if (gauges.size() <= 10)
      context.log.line("  free rigid motion, set to zero: {}{}", describe(motion, bodies, sizes_),
                       motion.resistance < exactly_free ? ""
                       : motion.sliding                 ? " (facets aside)"
                                        : fmt::format(" (but for facets, which feel {:.1e} of it)", motion.resistance));
    else
      ++silent;
  }
  if (silent > 0) context.log.line("  ... and {} more free rigid motions", silent);
  if (!loaded.empty()) throw_driven(loaded);
  if (!gauges.empty()) {
    make_rows(directory, interface, gauges);
    g = coarse_rows(*jump_, system_.clusters, comm_);
  }
  make_equality(std::move(g));
}

void DualProblem::make_set()
{
  const auto& contacts = constraints_.contacts;
  std::vector<qp::Bound> bounds;
  std::vector<qp::Disc> discs;
  for (std::size_t i = 0; i < contacts.nodes.size(); ++i) {
    NodeRows rows;
    rows.normal = jump_->ranges().contacts + static_cast<Local>(contacts.nodes[i].row);
    rows.tangents = static_cast<int>(contacts.nodes[i].tangents.size());
    if (!contacts.bonded[i]) {
      bounds.push_back({rows.normal, 0});
      if (rows.tangents > 0) {
        rows.disc = static_cast<Local>(discs.size());
        qp::Disc disc{{rows.normal + 1, rows.tangents == 2 ? rows.normal + 2 : -1}};
        disc.normal = rows.normal;
        discs.push_back(disc);
      }
    }
    node_rows_.push_back(rows);
  }
  set_ = qp::FeasibleSet(std::move(bounds), std::move(discs));
}

}  // namespace mortise::feti
