#include "simulation.hpp"

#include <algorithm>
#include <map>
#include <tuple>

#include "base/error.hpp"
#include "constraint/normals.hpp"
#include "constraint/preload.hpp"
#include "constraint/renewal.hpp"
#include "constraint/supports.hpp"
#include "contact/slides.hpp"
#include "curved_faces.hpp"
#include "fem/stiffness.hpp"
#include "feti/placement.hpp"
#include "indefinite.hpp"
#include "report.hpp"

namespace mortise {

namespace {

// Of the estimated discretization error, at which the solver stops where the tolerance is auto.
constexpr double algebraic_part = 0.1;
// Of the size of the solution, whatever the discretization error is estimated to be.
constexpr double smallest_part = 1e-6, largest_part = 0.05;

// Factorizes every subdomain that is not a copy of an earlier one.
feti::Subdomains factors(const Deck& deck, const partition::Decomposition& decomposition, const Model& model,
                         const std::vector<partition::CopyOf>& copies, std::vector<SparseMatrix> stiffness)
{
  feti::Subdomains subdomains;
  for (std::size_t s = 0; s < copies.size(); ++s) {
    const auto& [original, rotation] = copies[s];
    if (original != s) {
      const auto& shared = subdomains[original];
      subdomains.push_back(rotation ? std::make_shared<feti::TurnedSubdomain>(shared, *rotation, deck.dimension()) : shared);
      continue;
    }
    const auto& subdomain = decomposition.subdomains[s];
    const auto& points = subdomain.mesh.points;
    try {
      subdomains.push_back(std::make_shared<feti::ElasticSubdomain>(std::move(stiffness[s]),
                                                                    fem::rigid_motions(points, deck.kinematics), points,
                                                                    deck.dimension(), deck.solver.subdomains.factorization));
    } catch (const Error& error) {
      if (error.status() != ExitStatus::bad_input) throw;
      const auto& body = decomposition.catalogue.bodies[static_cast<std::size_t>(subdomain.body)];
      throw Error(error.status(), why_indefinite(subdomain, model.materials(subdomain), body.name));
    }
  }
  return subdomains;
}

// The points of a contact by what does not change when other components are held: contact, node, and its place among the points
// of that node.
using PointKey = std::tuple<int, Global, int>;

std::map<PointKey, std::size_t> index(const constraint::Contacts& contacts)
{
  std::map<PointKey, std::size_t> result;
  for (std::size_t i = 0; i < contacts.points.size(); ++i) {
    PointKey key{contacts.points[i].contact, contacts.points[i].node, 0};
    while (!result.emplace(key, i).second) ++std::get<2>(key);
  }
  return result;
}

// A vector in the tangent plane of one point, from entries along its tangents, to entries along those of another.
template <class From, class To>
void turn(const constraint::ContactPoint& from, const constraint::ContactPoint& to, const From& entry, const To& take)
{
  Point v = Point::Zero();
  for (std::size_t t = 0; t < from.tangents.size(); ++t) v += entry(t) * from.tangents[t];
  for (std::size_t t = 0; t < to.tangents.size(); ++t) take(t, v.dot(to.tangents[t]));
}

// Slip remembered by one set of rows, for another one of the same contacts.
void carry_slip(const constraint::Contacts& from, constraint::Contacts& to)
{
  if (from.slipped.empty()) return;
  to.slipped.assign(to.rows.size(), 0.0);
  const auto old = index(from);
  for (const auto& [key, i] : index(to)) {
    const auto found = old.find(key);
    if (found == old.end()) continue;
    const auto &a = from.points[found->second], &b = to.points[i];
    turn(
        a, b, [&](std::size_t t) { return from.slipped[a.row + 1 + t]; },
        [&](std::size_t t, double slip) {
          to.slipped[b.row + 1 + t] = slip;
          to.rows.bound[b.row + 1 + t] += slip;
        });
  }
}

// Multipliers of one problem as a start for another one of the same assembly, where other components are held.
qp::Solution carry_multipliers(const feti::DualProblem& from, const constraint::Constraints& old, const qp::Solution& solution,
                               const feti::DualProblem& to)
{
  Vector x(to.jump().rows());
  const auto &old_ranges = from.jump().ranges(), &ranges = to.jump().ranges();
  const auto& now = to.constraints();
  {
    auto value = view(x);
    const auto before = view(solution.x);
    value.head(ranges.held) = before.head(old_ranges.held);
    const auto force = [&](Local row) { return before[row] * from.jump().scale()[row]; };
    const auto set = [&](Local row, double f) { value[row] = f / to.jump().scale()[row]; };
    std::map<std::pair<Global, int>, Local> held;
    for (std::size_t i = 0; i < old.held.size(); ++i)
      held[{old.held[i].node, old.held[i].component}] = old_ranges.held + static_cast<Local>(i);
    for (std::size_t i = 0; i < now.held.size(); ++i)
      if (const auto found = held.find({now.held[i].node, now.held[i].component}); found != held.end())
        set(ranges.held + static_cast<Local>(i), force(found->second));
    const auto points = index(old.contacts);
    for (const auto& [key, i] : index(now.contacts)) {
      const auto found = points.find(key);
      if (found == points.end()) continue;
      const auto &a = old.contacts.points[found->second], &b = now.contacts.points[i];
      const Local first = from.points()[found->second].normal, row = to.points()[i].normal;
      set(row, force(first));
      turn(
          a, b, [&](std::size_t t) { return force(first + 1 + static_cast<Local>(t)); },
          [&](std::size_t t, double f) { set(row + 1 + static_cast<Local>(t), f); });
    }
  }
  qp::Solution start(x, x, solution.nu);
  start.hessian_norm = solution.hessian_norm;
  start.precision = solution.precision;
  start.augmented = solution.augmented;
  return start;
}

}  // namespace

Simulation::Simulation(const Deck& deck, const partition::Decomposition& decomposition, const Model& model,
                       const LoadState& first, int spent, const Context& context)
    : deck_(deck), decomposition_(decomposition), model_(model), context_(context), multiplications_(spent)
{
  const auto scope = context.timers.scope("contact");
  support_nodes_ = model.support_nodes(context.comm);
  support_surfaces_ = model.support_surfaces();
  constrain(first);
}

void Simulation::constrain(const LoadState& state)
{
  const auto& comm = context_.comm;
  state_ = state;
  supports_ = model_.supports(state);
  pairs_ = model_.contact_pairs(state);
  auto normals = constraint::node_normals(supports_, support_surfaces_, comm);
  const auto aligned = constraint::take_aligned(supports_, normals);
  constraints_.held = constraint::hold(supports_, support_nodes_, deck_.dimension(), comm, aligned);
  constraints_.inclined = constraint::incline(supports_, normals, constraints_.held, comm);
  constraints_.contacts = contact::discretize(pairs_, constraints_.held, deck_.kinematics, comm, constraints_.inclined,
                                              curved_faces(deck_, decomposition_, pairs_), &initial_gaps_);
  place_rows();
  find_cuts();
}

void Simulation::place_rows()
{
  if (!directory_) return;
  constraints_.held = feti::place(constraints_.held, decomposition_, *directory_, context_.comm);
  constraints_.inclined = feti::place(constraints_.inclined, decomposition_, *directory_, context_.comm);
  constraints_.contacts = feti::place(constraints_.contacts, decomposition_, *directory_, context_.comm);
}

void Simulation::find_cuts()
{
  constraints_.cuts =
      constraint::find_cuts(constraints_.contacts, model_.preloads(state_, shortenings_), deck_.axisymmetric(), context_.comm);
}

// The present rows with the bounds of a new state; false if it has other rows.
bool Simulation::move_constraints(const LoadState& state)
{
  auto supports = model_.supports(state);
  const bool moved = !std::equal(supports.begin(), supports.end(), supports_.begin(), [](const auto& a, const auto& b) {
    return a.displacement == b.displacement && a.normal == b.normal;
  });
  if (moved) {
    // What is held along normals may stand in many rows.
    if (std::any_of(deck_.supports.begin(), deck_.supports.end(), [](const auto& s) { return s.normal.has_value(); }))
      return false;
    auto held = feti::place(constraint::hold(supports, support_nodes_, deck_.dimension(), context_.comm), decomposition_,
                            *directory_, context_.comm);
    if (!constraint::move_supports(constraints_, std::move(held), supports, supports_, context_.comm)) return false;
  }
  for (std::size_t c = 0; c < deck_.contacts.size(); ++c) {
    const double overlap = (state.contact[c] - state_.contact[c]) * deck_.contacts[c].interference;
    if (overlap != 0) constraint::add_interference(constraints_.contacts, static_cast<int>(c), overlap);
    pairs_[c].options.interference += overlap;
  }
  supports_ = std::move(supports);
  state_ = state;
  find_cuts();
  return true;
}

void Simulation::factorize(const std::vector<partition::CopyOf>& copies)
{
  auto& [comm, log, timers] = context_;
  std::vector<SparseMatrix> stiffness;
  {
    const auto scope = timers.scope("assembly");
    collectively(comm, [&] { stiffness = model_.stiffness(copies); });
  }
  for (std::size_t s = 0; s < copies.size(); ++s)
    floating_.nodal_stiffness.push_back(copies[s].original == s ? feti::nodal_stiffness(stiffness[s], deck_.dimension())
                                                                : floating_.nodal_stiffness[copies[s].original]);
  directory_.emplace(decomposition_, floating_.nodal_stiffness, comm);
  interface_ = partition::find_interface(decomposition_, *directory_, comm);
  place_rows();
  find_cuts();
  floating_.kinematics = deck_.kinematics;
  const auto scope = timers.scope("factorization");
  collectively(comm, [&] {
    floating_.clusters =
        feti::Clusters(decomposition_, interface_, factors(deck_, decomposition_, model_, copies, std::move(stiffness)),
                       floating_.nodal_stiffness, deck_.kinematics);
  });
}

void Simulation::build_problem()
{
  auto& [comm, log, timers] = context_;
  solver_.reset();
  problem_ = std::make_unique<feti::DualProblem>(decomposition_, *directory_, interface_, constraints_, floating_,
                                                 deck_.solver.subdomains, context_,
                                                 contact::slides(pairs_, constraints_.contacts, deck_.kinematics, comm));
  log.line("  dual problem: {} multipliers, {} kernel dimensions", problem_->dual_unknowns(), problem_->kernel_dimension());
  auto options = deck_.solver.programme;
  if (auto& most = options.max_multiplications.value) *most -= multiplications_;
  multiplications_before_ = multiplications_;
  solver_ = std::make_unique<friction::Solver>(*problem_, model_.friction_laws(), deck_.friction_loop, options, patience_);
}

// A new problem, with the multipliers and the slip of the present one; its rows are there already if they were `moved`.
void Simulation::rebuild(const LoadState& state, bool moved)
{
  const auto before = std::move(problem_);
  const auto old = constraints_;
  if (!moved) {
    constraints_ = {};
    constrain(state);
    carry_slip(old.contacts, constraints_.contacts);
  }
  build_problem();
  solved_->solution = carry_multipliers(*before, old, solved_->solution, *problem_);
}

void Simulation::solve(const LoadState& state, const friction::Observer& observer)
{
  auto& [comm, log, timers] = context_;
  {
    const auto scope = timers.scope("assembly");
    floating_.load = model_.loads(state, comm);
  }
  const auto scope = timers.scope("solve");
  if (!problem_) {
    build_problem();
  } else {
    const bool same_cuts = constraints_.cuts.empty() || state.locked == state_.locked;
    const bool moved = move_constraints(state);
    if (!moved || !same_cuts || !problem_->renew()) rebuild(state, moved);
  }
  const auto norms = [&](const Vector& lambda, const Eigen::VectorXd& nu) {
    const auto estimating = timers.scope("error estimate");
    return energy_norms(deck_, decomposition_, model_, state_, interface_, problem_->displacement(lambda, nu), comm);
  };
  const friction::Accuracy accuracy{[&](const Vector& lambda, const Eigen::VectorXd& nu) {
                                      const auto [error, solution] = norms(lambda, nu);
                                      return std::clamp(algebraic_part * error, smallest_part * solution,
                                                        largest_part * solution);
                                    },
                                    [&](const Vector& lambda, const Eigen::VectorXd& nu) { return norms(lambda, nu).solution; }};
  const auto count_on = [&](int step, double change, qp::Progress progress) {
    progress.multiplications += multiplications_before_;
    observer(step, change, progress);
  };
  auto found = solver_->solve(solved_ ? &solved_->solution : nullptr, accuracy, count_on);
  multiplications_ += found.multiplications;
  solved_ = std::make_unique<friction::Result>(std::move(found));
}

void Simulation::settle(const std::vector<Eigen::VectorXd>& displacement)
{
  shortenings_ = problem_->shortenings(solved_->solution.nu);
  const Vector jumps = problem_->jump().apply(displacement);
  const auto& ranges = problem_->jump().ranges();
  const Local count = ranges.extra - ranges.contacts;
  const Eigen::VectorXd lengths =
      view(jumps).segment(ranges.contacts, count).cwiseQuotient(problem_->jump().scale().segment(ranges.contacts, count));
  constraint::remember_slip(constraints_.contacts, {lengths.data(), static_cast<std::size_t>(count)});
}

}  // namespace mortise
