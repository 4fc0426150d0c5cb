#include "feti/dual_problem.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.hpp"
#include "neutral_motions.hpp"
#include "row_scaling.hpp"

namespace mortise::feti {

namespace {

// What rows feel of a motion that is free up to rounding.
constexpr double exactly_free = 1e-6;

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
      load_(std::move(load)),
      comm_(context.comm),
      opposed_loads_(std::move(opposed_loads))
{
  for (const auto& subdomain : system.clusters.subdomains()) rounding_ = std::max(rounding_, subdomain->rounding());
  rounding_ = comm_.max(rounding_);
  make_rows(directory, interface, {});
  gauge_rigid_modes(directory, interface, sliding_surfaces, context);
  groups_ = body_groups(decomposition, *jump_, constraints_.prescribed, comm_);
  if (!constraints_.springs.rows.empty()) springs_ = std::make_unique<ElasticRows>(constraints_.springs, *jump_, comm_);
  hessian_ = std::make_unique<DualOperator>(*jump_, system.clusters, context.timers, springs_.get());
  if (options.preconditioner != "none") {
    const auto kind = options.preconditioner == "lumped" ? Preconditioner::Kind::lumped : Preconditioner::Kind::dirichlet;
    preconditioner_ =
        std::make_unique<Preconditioner>(kind, decomposition, *jump_, system.clusters.subdomains(), system.nodal_stiffness,
                                         options.factorization, context.timers, comm_, springs_.get());
  }
  make_set();
  make_rhs();
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
  if (const auto more = unknowns(constraints_, *jump_, dimension()); !more.empty()) {
    g = with_unknowns(g, more, *jump_);
    balancing_multipliers_ = std::make_unique<Vector>(jump_->rows());
  }
  const auto size = g.rows();
  equality_ = std::make_unique<qp::EqualityConstraint>(std::move(g), Eigen::VectorXd::Zero(size), comm_);
}

Eigen::VectorXd DualProblem::bound() const
{
  Eigen::VectorXd c = jump_->bound();
  for (const auto& section : constraints_.pretension_sections)
    if (!section.preload.force)
      for (const auto& [row, part] : section.rows) {
        const auto at = jump_->ranges().contacts + static_cast<Local>(row);
        c[at] += jump_->scaling().factor[at] * (part * section.preload.shortening);
      }
  return c;
}

void DualProblem::be_exact()
{
  if (rounding() == 0) return;
  hessian_->be_exact();
  make_rhs();
}

void DualProblem::make_rhs()
{
  loaded_ = load_;
  system_.clusters.apply_inverse(loaded_, hessian_->rounded());
  Vector d = jump_->apply(loaded_);
  view(d) -= bound();
  if (linear_)
    linear_->assign(d);  // solvers refer to it
  else
    linear_ = std::make_unique<Vector>(d, Teuchos::Copy);

  Eigen::VectorXd e = load_coordinates(system_.clusters, load_, comm_);
  const auto kernels = e.size();
  std::vector<double> forces;
  for (const auto& unknown : unknowns(constraints_, *jump_, dimension())) forces.push_back(-unknown.force);
  const auto count = static_cast<Eigen::Index>(forces.size());
  e.conservativeResize(kernels + count);
  e.tail(count) = Eigen::Map<const Eigen::VectorXd>(forces.data(), count);
  if (balancing_multipliers_) {
    Eigen::VectorXd alone = Eigen::VectorXd::Zero(e.size());
    alone.tail(count) = e.tail(count);
    balancing_multipliers_->putScalar(0);
    equality_->add_transpose(1, equality_->solve(alone), *balancing_multipliers_);
  }
  equality_->set_right_side(std::move(e));
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
  load_ = std::move(load);
  last_.reset();
  jump_->update_rhs(constraints_.prescribed, constraints_.skew_supports, constraints_.contacts, constraints_.mean_motions);
  make_rhs();
  return true;
}

void DualProblem::gauge_rigid_modes(const partition::NodeDirectory& directory, const partition::Interface& interface,
                                    std::span<const constraint::SlidingSurface> sliding_surfaces, const Context& context)
{
  SparseMatrix g = coarse_rows(*jump_, system_.clusters, comm_);
  const auto motions = find_free_motions(decomposition_, *jump_, system_.clusters, system_.kinematics, g, constraints_,
                                         unknowns(constraints_, *jump_, dimension()), sliding_surfaces, load_, comm_);
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

Eigen::VectorXd DualProblem::forces(const Vector& lambda) const
{
  return view(lambda).cwiseProduct(jump_->scaling().factor);
}

Vector DualProblem::multipliers(const Eigen::VectorXd& forces) const
{
  Vector lambda(jump_->rows());
  view(lambda) = forces.cwiseQuotient(jump_->scaling().factor);
  return lambda;
}

Eigen::VectorXd DualProblem::jumps(const std::vector<Eigen::VectorXd>& u) const
{
  const Vector scaled = jump_->apply(u);
  return view(scaled).cwiseQuotient(jump_->scaling().factor);
}

Eigen::VectorXd DualProblem::given_way(const Vector& lambda) const
{
  return view(lambda).cwiseProduct(jump_->compliance()).cwiseQuotient(jump_->scaling().factor);
}

std::vector<double> DualProblem::radii(std::span<const double> slip_bounds) const
{
  std::vector<double> radii(slip_bounds.begin(), slip_bounds.end());
  for (std::size_t i = 0; i < radii.size(); ++i) radii[i] /= jump_->scaling().factor[set_.discs()[i].normal];
  return radii;
}

std::vector<double> DualProblem::slip_bounds(const qp::FeasibleSet& set) const
{
  std::vector<double> forces;
  for (const auto& disc : set.discs()) forces.push_back(jump_->scaling().factor[disc.normal] * disc.radius);
  return forces;
}

std::vector<Eigen::VectorXd> DualProblem::displacement(const Vector& lambda, const Eigen::VectorXd& nu) const
{
  const auto& clusters = system_.clusters;
  const auto values = view(lambda);
  if (comm_.any(!last_ || last_->lambda != values)) {
    auto elastic = jump_->apply_transpose(lambda);
    for (std::size_t s = 0; s < elastic.size(); ++s) elastic[s] = load_[s] - elastic[s];
    clusters.apply_inverse(elastic);
    last_.emplace(Elastic{values, std::move(elastic)});
  }
  return less_motion(last_->displacement, nu);
}

std::vector<Eigen::VectorXd> DualProblem::displacement_of_product(const Vector& lambda, const Eigen::VectorXd& nu) const
{
  const auto* response = hessian_->response(lambda);
  if (comm_.any(!response)) return displacement(lambda, nu);
  auto u = loaded_;
  for (std::size_t s = 0; s < u.size(); ++s) u[s] -= (*response)[s];
  return less_motion(std::move(u), nu);
}

// u - R nu.
std::vector<Eigen::VectorXd> DualProblem::less_motion(std::vector<Eigen::VectorXd> u, const Eigen::VectorXd& nu) const
{
  const auto& clusters = system_.clusters;
  for (std::size_t s = 0; s < u.size(); ++s) u[s] -= clusters.motion(s, nu.segment(clusters.first(s), clusters.modes()));
  return u;
}

Eigen::VectorXd DualProblem::least_motion(const Vector& lambda, const Eigen::VectorXd& nu, double negligible_force) const
{
  constexpr double no_force = 1e-9;   // of the largest contact force: the next node may just touch
  constexpr Eigen::Index most = 600;  // amplitudes: more would take seconds
  const auto& contacts = constraints_.contacts;
  const bool unbonded = std::find(contacts.bonded.begin(), contacts.bonded.end(), false) != contacts.bonded.end();
  if (!comm_.any(unbonded)) return nu;
  const Bodies bodies = aggregate(decomposition_, system_.clusters, system_.kinematics, load_, comm_);
  if (bodies.aggregate.cols() > most) return nu;

  const Local first = jump_->ranges().dirichlet, count = jump_->ranges().end - first;
  const auto kernels = system_.clusters.kernel_dimension();
  const Eigen::VectorXd unscale = jump_->scaling().factor.segment(first, count).cwiseInverse();
  const SparseMatrix g = equality_->local().middleCols(first, count);
  FeltMotions felt{unscale.asDiagonal() * SparseMatrix(SparseMatrix(g.transpose()).leftCols(kernels) * bodies.aggregate),
                   Eigen::VectorXd::Ones(count), Eigen::VectorXd::Constant(count, std::numeric_limits<double>::infinity())};
  const auto u = displacement(lambda, nu);
  const Eigen::VectorXd force = forces(lambda), jump = jumps(u);
  double largest = 0;
  for (const auto& rows : node_rows_) largest = std::max(largest, std::abs(force[rows.normal]));
  const double least = std::max(no_force * comm_.max(largest), negligible_force);
  for (std::size_t i = 0; i < contacts.nodes.size(); ++i) {
    const auto& rows = node_rows_[i];
    if (contacts.bonded[i] || force[rows.normal] > least) continue;
    felt.closed.segment(rows.normal - first, 1 + rows.tangents).setZero();
    felt.gap[rows.normal - first] = contacts.rows.bound[contacts.nodes[i].row] - jump[rows.normal];
  }
  const Eigen::VectorXd change = towards_rest(felt, mean_amplitudes(decomposition_, bodies, u, comm_), comm_);
  Eigen::VectorXd result = nu;
  result.head(kernels) -= bodies.aggregate * change;
  return result;
}

std::string DualProblem::unbounded_rigid_mode(const Eigen::VectorXd& nu) const
{
  const auto frames = body_frames(decomposition_, comm_);
  RigidMotion fastest;
  double speed = -1;
  for (std::size_t b = 0; b < frames.size(); ++b) {
    const auto motion =
        rigid_part(decomposition_, system_.clusters, system_.kinematics, frames[b], static_cast<int>(b), -nu, comm_);
    const double v = motion.translation.norm() + motion.rotation.norm() * frames[b].radius;
    if (v <= speed) continue;
    fastest = motion;
    speed = v;
  }
  const auto body = static_cast<std::size_t>(fastest.body);
  return fmt::format("body \"{}\" {}", decomposition_.catalogue.bodies[body].name, describe(fastest, frames[body].radius));
}

Point DualProblem::gauge_force(const Vector& lambda) const
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

std::vector<double> DualProblem::loads_of_bodies() const
{
  std::vector<double> loads(decomposition_.catalogue.bodies.size(), 0.0);
  for (std::size_t s = 0; s < load_.size(); ++s)
    for (Eigen::Index i = 0; i < load_[s].size(); i += dimension())
      loads[static_cast<std::size_t>(decomposition_.subdomains[s].body)] += load_[s].segment(i, dimension()).norm();
  comm_.sum_in_place(loads);
  return loads;
}

double DualProblem::imbalance(const std::vector<Eigen::VectorXd>& u, const Vector& lambda, double negligible_force) const
{
  const auto forces = jump_->apply_transpose(lambda);
  std::vector<Eigen::VectorXd> given;
  for (std::size_t s = 0; s < forces.size(); ++s) given.push_back(load_[s] - forces[s]);
  const auto inner = system_.clusters.inner_forces(given);
  double residual = 0, size = 0;
  for (std::size_t s = 0; s < u.size(); ++s) {
    residual += (system_.clusters.subdomains()[s]->apply(u[s]) + forces[s] - load_[s] + inner[s]).squaredNorm();
    size += load_[s].squaredNorm() + forces[s].squaredNorm();
    for (Eigen::Index i = 0; i < u[s].size(); ++i) {  // what rounding makes of a rigid motion is no force
      const double k = system_.nodal_stiffness[s][static_cast<std::size_t>(i / decomposition_.catalogue.dimension)];
      size += std::pow(1e-6 * k * u[s][i], 2);
    }
  }
  size = std::max(comm_.sum(size), negligible_force * negligible_force);
  return size > 0 ? std::sqrt(comm_.sum(residual) / size) : 0;
}

std::vector<double> DualProblem::shortenings(const Eigen::VectorXd& nu) const
{
  std::vector<double> result;
  Eigen::Index next = kernel_dimension();
  for (const auto& section : constraints_.pretension_sections)
    result.push_back(section.preload.force ? nu[next++] : section.preload.shortening);
  return result;
}

Eigen::Index DualProblem::first_coupling_motion() const
{
  const auto& sections = constraints_.pretension_sections;
  const auto unknown = [](const auto& section) { return section.preload.force.has_value(); };
  return kernel_dimension() + std::count_if(sections.begin(), sections.end(), unknown);
}

}  // namespace mortise::feti
