#include "feti/dual_problem.hpp"

#include "driven_motions.hpp"
#include "exactly_free.hpp"
#include "row_scaling.hpp"

namespace mortise::feti {

namespace {

// K^+ f, as F has K^+.
SharedField response_to(std::vector<Eigen::VectorXd> load, const DualSystem& system)
{
  system.clusters().apply_inverse(load, system.hessian().products() == Products::rounded);
  return std::make_shared<const std::vector<Eigen::VectorXd>>(std::move(load));
}

}  // namespace

DualProblem::DualProblem(const partition::Decomposition& decomposition, const partition::NodeDirectory& directory,
                         const partition::Interface& interface, std::shared_ptr<const constraint::Constraints> constraints,
                         const SubdomainSystem& subdomains, std::vector<Eigen::VectorXd> load, const Options& options,
                         const Context& context, std::span<const constraint::SlidingSurface> sliding_surfaces,
                         std::vector<double> opposed_loads, Products products)
    : system_(std::make_shared<const DualSystem>(decomposition, directory, interface, *constraints, subdomains,
                                                 FirstLoads{load, opposed_loads, sliding_surfaces}, options, context, products)),
      constraints_(std::move(constraints)),
      gauged_(system_->gauged()),
      opposed_loads_(std::move(opposed_loads))
{
  make_right_hand_side(std::move(load));
}

DualProblem::DualProblem(std::shared_ptr<const DualSystem> system, std::shared_ptr<const constraint::Constraints> constraints,
                         std::vector<FreeMotion> gauged, std::vector<Eigen::VectorXd> load, std::vector<double> opposed_loads)
    : system_(std::move(system)),
      constraints_(std::move(constraints)),
      gauged_(std::move(gauged)),
      opposed_loads_(std::move(opposed_loads))
{
  make_right_hand_side(std::move(load));
}

void DualProblem::make_right_hand_side(std::vector<Eigen::VectorXd> load)
{
  response_ = response_to(load, *system_);
  Vector d = jump().apply(*response_);
  Eigen::VectorXd c = bound();
  view(d) -= c;

  Eigen::VectorXd e = load_coordinates(system_->clusters(), load, communicator());
  const auto kernels = e.size();
  std::vector<double> forces;
  for (const auto& unknown : unknowns(*constraints_, jump(), dimension())) forces.push_back(-unknown.force);
  const auto count = static_cast<Eigen::Index>(forces.size());
  e.conservativeResize(kernels + count);
  e.tail(count) = Eigen::Map<const Eigen::VectorXd>(forces.data(), count);
  right_ =
      std::make_shared<const qp::RightHandSide>(qp::RightHandSide{std::move(d), std::move(e), {}, std::move(load), std::move(c)});
}

// c of B u = c, B u <= c, as B's rows are scaled: the bounds of the jumps, and the shortenings that are given.
Eigen::VectorXd DualProblem::bound() const
{
  const auto& ranges = jump().ranges();
  Eigen::VectorXd c = Eigen::VectorXd::Zero(ranges.end);
  Local row = ranges.dirichlet;
  for (const auto& dof : constraints_->prescribed) c[row++] = dof.value;
  for (const auto& support : constraints_->skew_supports) c[row++] = support.value;
  for (const auto& mean : constraints_->mean_motions) c[row++] = mean.value;
  const auto& contacts = constraints_->contacts.rows;
  for (std::size_t r = 0; r < contacts.size(); ++r) c[ranges.contacts + static_cast<Local>(r)] = contacts.bound[r];
  c.array() *= RowScaling::of(jump()).array();
  for (const auto& section : constraints_->pretension_sections)
    if (!section.preload.force)
      for (const auto& [row, part] : section.rows) {
        const auto at = ranges.contacts + static_cast<Local>(row);
        c[at] += RowScaling::of(jump())[at] * (part * section.preload.shortening);
      }
  return c;
}

std::optional<DualProblem> DualProblem::with_loads(std::shared_ptr<const constraint::Constraints> constraints,
                                                   std::vector<Eigen::VectorXd> load, std::vector<double> opposed_loads) const
{
  const auto& decomposition = system_->decomposition();
  // What loads at the points of couplings work on a motion is not among the loads of the subdomains.
  if (!gauged_.empty() && !constraints->couplings.empty()) return {};
  std::string loaded;
  std::vector<FreeMotion> now;
  for (const auto& motion : gauged_) {
    now.push_back(loaded_by(motion, decomposition, load, communicator()));
    if (now.back().work <= limits_of(now.back(), opposed_loads).refused) continue;
    if (!motion.sliding && motion.resistance >= exactly_free) return {};
    loaded += driven_by_loads(now.back(), decomposition.catalogue.bodies, system_->body_sizes());
  }
  if (!loaded.empty()) throw_driven(loaded);
  return DualProblem(system_, std::move(constraints), std::move(now), std::move(load), std::move(opposed_loads));
}

SharedField DualProblem::response() const
{
  return response_ ? response_ : response_to(load(), *system_);
}

// Driven by the multipliers of least norm that balance the forces of the unknowns and move no body.
std::shared_ptr<const qp::RightHandSide> DualProblem::driven_right_hand_side(qp::Hessian& counted) const
{
  const auto count = right_->e.size() - system_->kernel_dimension();
  if (count == 0) return right_;
  Eigen::VectorXd alone = Eigen::VectorXd::Zero(right_->e.size());
  alone.tail(count) = right_->e.tail(count);
  Vector balancing(jump().rows()), product(jump().rows());
  equality().add_transpose(1, equality().solve(alone), balancing);
  counted.apply(balancing, product);
  auto result = *right_;
  result.driven = std::move(product);
  return std::make_shared<const qp::RightHandSide>(std::move(result));
}

std::vector<UnresistedLoad> DualProblem::unresisted_loads() const
{
  std::vector<UnresistedLoad> result;
  for (const auto& motion : gauged_) {
    if (!motion.sliding && motion.resistance >= exactly_free) continue;
    const double limit = limits_of(motion, opposed_loads_).told;
    const auto body = static_cast<std::size_t>(motion.motions.front().body);
    if (motion.work > limit) result.push_back(unresisted_load(motion, limit, system_->body_sizes()[body]));
  }
  return result;
}

}  // namespace mortise::feti
