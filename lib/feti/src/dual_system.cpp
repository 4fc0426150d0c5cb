#include "feti/dual_system.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "driven_motions.hpp"
#include "exactly_free.hpp"
#include "feti/preconditioner_kind.hpp"
#include "gauge.hpp"
#include "unit_motions.hpp"

namespace mortise::feti {

namespace {

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

}  // namespace

DualSystem::DualSystem(const partition::Decomposition& decomposition, const partition::NodeDirectory& directory,
                       const partition::Interface& interface, const constraint::Constraints& constraints,
                       const SubdomainSystem& subdomains, const FirstLoads& loads, const Options& options, const Context& context,
                       Products products)
    : decomposition_(decomposition), subdomains_(subdomains), options_(options), comm_(context.comm), timers_(context.timers)
{
  for (const auto& subdomain : clusters().subdomains()) rounding_ = std::max(rounding_, subdomain->rounding());
  rounding_ = comm_.max(rounding_);
  slender_ = comm_.any(any_slender(clusters().subdomains()));
  const auto rows = [&](std::span<const SubdomainRow> gauges) {
    return std::make_unique<const JumpOperator>(decomposition, directory, interface, constraints.prescribed,
                                                constraints.skew_supports, constraints.contacts, gauges, comm_,
                                                constraints.mean_motions, constraints.springs);
  };
  make_rows(rows, constraints, loads, context);
  groups_ = body_groups(decomposition, *jump_, constraints.prescribed, comm_);
  if (!constraints.springs.rows.empty()) springs_ = std::make_unique<const ElasticRows>(constraints.springs, *jump_, comm_);
  hessian_ = std::make_unique<const DualOperator>(*jump_, clusters(), timers_, springs_.get(),
                                                  rounding_ > 0 ? products : Products::rounded);
  for (std::size_t i = 0; i < constraints.prescribed.size(); ++i)
    if (constraints.prescribed[i].unknown) unknown_components_.push_back(jump_->ranges().dirichlet + static_cast<Local>(i));
  make_set(constraints.contacts);
}

void DualSystem::gradient(const Operator& product, const Vector& x, const qp::RightHandSide& right, Vector& gradient) const
{
  if (slender_) return hessian_->gradient(x, right, gradient);
  product.apply(x, gradient);
  gradient.update(-1, right.b, 1);
}

// B with the rows of gauges, and G.
void DualSystem::make_rows(const MakeRows& rows, const constraint::Constraints& constraints, const FirstLoads& loads,
                           const Context& context)
{
  jump_ = rows({});
  SparseMatrix g = coarse_rows(*jump_, clusters(), comm_);
  for (const auto& frame : body_frames(decomposition_, comm_)) sizes_.push_back(frame.radius);
  const auto motions = find_free_motions(decomposition_, *jump_, clusters(), subdomains_.kinematics, g, constraints,
                                         unknowns(constraints, *jump_, dimension()), loads.sliding_surfaces, loads.forces, comm_);
  if (const auto gauges = gauge_rigid_modes(motions, loads.opposed, context); !gauges.empty()) {
    jump_ = rows(gauges);
    g = coarse_rows(*jump_, clusters(), comm_);
  }
  if (const auto more = unknowns(constraints, *jump_, dimension()); !more.empty()) g = with_unknowns(g, more, *jump_);
  equality_ = std::make_unique<const qp::EqualityConstraint>(std::move(g), comm_);
}

// The rows that hold the motions which nothing loads.
std::vector<SubdomainRow> DualSystem::gauge_rigid_modes(const std::vector<FreeMotion>& motions,
                                                        const std::vector<double>& opposed_loads, const Context& context)
{
  const auto& bodies = decomposition_.catalogue.bodies;
  std::vector<SubdomainRow> gauges;
  std::string loaded;
  int silent = 0;
  for (const auto& motion : motions) {
    const bool free = motion.sliding || motion.resistance < exactly_free;
    if (motion.work > limits_of(motion, opposed_loads).refused) {
      // What is hardly resisted is left to the solver; what nothing but facets resists has no equilibrium.
      if (free) loaded += driven_by_loads(motion, bodies, sizes_);
      continue;
    }
    gauges.push_back(gauge(motion, moves_alone(motion, motions), decomposition_, subdomains_.nodal_stiffness, comm_));
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
  return gauges;
}

void DualSystem::make_set(const constraint::Contacts& contacts)
{
  std::vector<qp::Bound> bounds;
  std::vector<qp::Disc> discs;
  for (std::size_t i = 0; i < contacts.nodes.size(); ++i) {
    NodeRows rows;
    rows.contact = contacts.nodes[i].contact;
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

std::unique_ptr<qp::ActiveSetPreconditioner> DualSystem::make_preconditioner() const
{
  const auto& kind = preconditioner_kind(options_.preconditioner).kind;
  if (!kind) return nullptr;
  return std::make_unique<Preconditioner>(*kind, decomposition_, *jump_, clusters().subdomains(), subdomains_.nodal_stiffness,
                                          set_.discs(), options_.factorization, timers_, comm_, springs_.get());
}

std::vector<Eigen::VectorXd> DualSystem::less_motion(std::vector<Eigen::VectorXd> u, const Eigen::VectorXd& nu) const
{
  for (std::size_t s = 0; s < u.size(); ++s) u[s] -= clusters().motion(s, nu.segment(clusters().first(s), clusters().modes()));
  return u;
}

std::string DualSystem::unbounded_rigid_mode(const Eigen::VectorXd& nu) const
{
  const auto frames = body_frames(decomposition_, comm_);
  RigidMotion fastest;
  double speed = -1;
  for (std::size_t b = 0; b < frames.size(); ++b) {
    const auto motion =
        rigid_part(decomposition_, clusters(), subdomains_.kinematics, frames[b], static_cast<int>(b), -nu, comm_);
    const double v = motion.translation.norm() + motion.rotation.norm() * frames[b].radius;
    if (v <= speed) continue;
    fastest = motion;
    speed = v;
  }
  const auto body = static_cast<std::size_t>(fastest.body);
  return fmt::format("body \"{}\" {}", decomposition_.catalogue.bodies[body].name, describe(fastest, frames[body].radius));
}

Point DualSystem::gauge_force(const Vector& lambda) const
{
  Vector gauges(lambda.getMap());
  const auto& ranges = jump_->ranges();
  // Owned rows keep the order of the gauges; which of them this rank owns says the row's number.
  const Global first = jump_->contact_rows().second;
  {
    auto value = view(gauges);
    const auto from = view(lambda);
    for (Local row = ranges.extra; row < ranges.end; ++row) {
      const auto& motion = gauged_[static_cast<std::size_t>(lambda.getMap()->getGlobalElement(row) - first)];
      if (motion.sliding || motion.resistance < exactly_free) value[row] = from[row];
    }
  }
  std::vector<double> sum(3, 0.0);
  const auto dimension = static_cast<std::size_t>(decomposition_.catalogue.dimension);
  for (const auto& f : jump_->apply_transpose(gauges))
    for (Eigen::Index i = 0; i < f.size(); ++i) sum[static_cast<std::size_t>(i) % dimension] -= f[i];
  comm_.sum_in_place(sum);
  return {sum[0], sum[1], sum[2]};
}

bool DualSystem::gauges_hold_free_motions() const
{
  return std::all_of(gauged_.begin(), gauged_.end(), [](const FreeMotion& motion) { return motion.resistance < exactly_free; });
}

std::vector<std::vector<Eigen::VectorXd>> DualSystem::gauged_motions() const
{
  std::vector<std::vector<Eigen::VectorXd>> result;
  for (const auto& gauged : gauged_) {
    auto& motion = result.emplace_back(decomposition_.subdomains.size());
    for (std::size_t s = 0; s < motion.size(); ++s)
      for (const auto& part : gauged.motions)
        if (part.body == decomposition_.subdomains[s].body)
          motion[s] = sample(part, decomposition_.subdomains[s].mesh.points, dimension());
  }
  return result;
}

}  // namespace mortise::feti
