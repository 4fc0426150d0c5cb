#include "analysis/restart.hpp"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>

#include "analysis/load_step_solver.hpp"
#include "io/files.hpp"
#include "io/output_directory.hpp"
#include "io/results.hpp"

namespace mortise::analysis {

namespace {

namespace fs = std::filesystem;

// Places in the table restart/run: the head, and then Record::counts.
namespace figure {
enum : std::size_t {
  steps,
  change,
  applications,
  preconditionings,
  outer_iterations,
  projected_gradient,
  equality,
  error,
  hessian_norm,
  precision,
  linear,
  energy,
  count
};
}
namespace head {
enum : std::size_t { format, ranks, time, kind, smaller, spent, count };
}
constexpr int format = 2;  // of the file. 1, without a number: multipliers and slip bounds as B's rows are scaled

io::Table column(const std::string& name, const std::string& description, const std::vector<double>& whole,
                 const Communicator& comm)
{
  io::Table table{name, description, 1, static_cast<Global>(whole.size()), {}, {}};
  if (comm.root())
    for (std::size_t i = 0; i < whole.size(); ++i) {
      table.row.push_back(static_cast<Global>(i));
      table.values.push_back(whole[i]);
    }
  return table;
}

std::vector<double> head_of(const Approach& approach, double time, const Communicator& comm)
{
  return {format,
          static_cast<double>(comm.size()),
          time,
          static_cast<double>(approach.kind),
          approach.smaller ? 1.0 : 0.0,
          static_cast<double>(approach.spent)};
}

// Figures by which another problem shows, though its deck is the same: a mesh or a file of temperatures that was changed.
struct Fingerprint {
  double linear;                      // r'b, where r is of no direction that models prefer
  double energy;                      // x'A x
  double linear_scale, energy_scale;  // what their rounding is relative to
};

Fingerprint fingerprint(const Vector& x, const Vector& gradient, const Vector& linear)
{
  Vector r(linear.getMap());
  auto values = view(r);
  const auto rows = linear.getMap()->getNodeElementList();
  for (Eigen::Index i = 0; i < values.size(); ++i)
    values[i] = std::sin(1.0 + static_cast<double>(rows[static_cast<Teuchos::Ordinal>(i)]));
  const double energy = x.dot(gradient) + x.dot(linear), norm = linear.norm2();
  return {r.dot(linear), energy, norm, std::abs(energy) + x.norm2() * norm};
}

bool differ(double a, double b, double scale)
{
  return !(std::abs(a - b) <= 1e-8 * scale);  // the same run again: 1e-12
}

[[noreturn]] void throw_not_resumable(const std::string& directory, const std::string& why)
{
  throw Error(ExitStatus::bad_input, fmt::format("--resume: {}: {}", directory, why));
}

}  // namespace

Restart::Restart(const model::Deck& deck, bool resume, const Communicator& comm) : directory_(deck.output.directory), comm_(comm)
{
  if (!resume) return;
  collectively(comm, [&] {
    if (!fs::exists(path(1)))
      throw_not_resumable(directory_,
                          "no run was ended there between two load states, so that there is nothing to go on from; run "
                          "the deck without it");
    if (io::text_of(directory_ + "/deck.yaml") != io::written_mark() + "\n" + write_deck(deck))
      throw_not_resumable(directory_,
                          "the run that was ended there was of another deck (see deck.yaml); run this one without it, or "
                          "into another directory");
    for (std::size_t index = 1; fs::exists(path(index)); ++index) {
      const auto numbers = io::read_table(path(index), "restart/run");
      if (numbers.size() != std::size_t{head::count} + figure::count || static_cast<int>(numbers[head::format]) != format)
        throw_not_resumable(directory_, path(index) +
                                            " is of another version of this program, in another format; run the deck "
                                            "without it");
      if (static_cast<int>(numbers[head::ranks]) != comm_.size())
        throw_not_resumable(directory_, fmt::format("the run that was ended there had {} ranks, not {}; take as many",
                                                    static_cast<int>(numbers[head::ranks]), comm_.size()));
      Record record;
      record.time = numbers[head::time];
      record.approach.kind = static_cast<Approach::Kind>(static_cast<int>(numbers[head::kind]));
      record.approach.smaller = numbers[head::smaller] != 0;
      record.approach.spent = static_cast<int>(numbers[head::spent]);
      if (!records_.empty() && (records_.front().approach.kind != record.approach.kind || records_.back().time >= record.time))
        break;  // left by an approach before
      record.counts.assign(numbers.begin() + head::count, numbers.end());
      record.file = path(index);
      records_.push_back(std::move(record));
    }
  });
}

std::string Restart::path(std::size_t index) const
{
  return fmt::format("{}/restart.{}.h5", directory_, index);
}

std::optional<Approach> Restart::approach() const
{
  if (records_.empty()) return {};
  return records_.front().approach;
}

const Record* Restart::find(const Approach& approach, double time) const
{
  for (const auto& record : records_)
    if (record.time == time && record.approach.kind == approach.kind) return &record;
  return nullptr;
}

void Restart::keep(std::size_t index, const Approach& approach, const StepState& state) const
{
  if (!state.solved.converged || find(approach, state.rows->acts.time)) return;
  const auto& problem = state.problem;
  const auto& solution = state.solved.solution;
  auto numbers = head_of(approach, state.rows->acts.time, comm_);
  std::vector<double> counts(figure::count);
  counts[figure::steps] = state.solved.steps;
  counts[figure::change] = state.solved.change;
  counts[figure::applications] = state.solved.applications;
  counts[figure::preconditionings] = state.solved.preconditionings;
  counts[figure::outer_iterations] = state.solved.outer_iterations;
  counts[figure::projected_gradient] = solution.projected_gradient;
  counts[figure::equality] = solution.equality;
  counts[figure::error] = solution.error;
  counts[figure::hessian_norm] = solution.hessian_norm;
  counts[figure::precision] = solution.precision;
  const auto print = fingerprint(solution.x, solution.gradient, problem.right_hand_side()->b);
  counts[figure::linear] = print.linear;
  counts[figure::energy] = print.energy;
  numbers.insert(numbers.end(), counts.begin(), counts.end());

  io::Table multipliers{"dual/multipliers", "forces of the rows", 1, problem.system().dual_unknowns(), {}, {}};
  const Eigen::VectorXd forces = problem.forces(solution.x);
  const auto rows = problem.jump().rows()->getNodeElementList();
  multipliers.row.assign(rows.begin(), rows.end());
  multipliers.values.assign(forces.begin(), forces.end());
  const auto count = static_cast<long long>(state.solved.slip_bounds.size());
  io::Table bounds{"dual/slip_bounds", "of tangential forces", 1, comm_.sum(count), {}, state.solved.slip_bounds};
  const Global first = comm_.offset(count);
  for (Global row = first; row < first + count; ++row) bounds.row.push_back(row);
  const std::vector<double> nu(solution.nu.begin(), solution.nu.end()),
      augmented(solution.augmented.begin(), solution.augmented.end());
  io::write_results(path(index),
                    {column("restart/run", "format, ranks, time, approach, figures of the solution", numbers, comm_),
                     column("restart/kernel", "multipliers of the equality constraints", nu, comm_),
                     column("restart/augmented", "those of the augmented Lagrangian", augmented, comm_), multipliers, bounds},
                    comm_);
}

void Restart::remove() const
{
  if (!comm_.root()) return;
  std::error_code ignored;
  for (std::size_t index = 1; fs::remove(path(index), ignored);) ++index;
}

feti::DualSolution solution_of(const Record& record, const feti::DualProblem& problem, const Operator& hessian)
{
  const auto& comm = problem.communicator();
  const auto discs = static_cast<long long>(problem.set().discs().size());
  const auto all_discs = comm.sum(discs);
  std::vector<double> multipliers, bounds, nu, augmented;
  collectively(comm, [&] {
    multipliers = io::read_table(record.file, "dual/multipliers");
    bounds = io::read_table(record.file, "dual/slip_bounds");
    nu = io::read_table(record.file, "restart/kernel");
    augmented = io::read_table(record.file, "restart/augmented");
    if (static_cast<Global>(multipliers.size()) != problem.system().dual_unknowns() ||
        static_cast<Eigen::Index>(nu.size()) != problem.equality().size() || static_cast<long long>(bounds.size()) != all_discs)
      throw Error(ExitStatus::bad_input,
                  "--resume: the mesh or its subdomains are not those of the run that was ended; run the deck without it");
  });
  const auto own_bounds = bounds.begin() + static_cast<std::ptrdiff_t>(comm.offset(discs));
  const auto rows = problem.jump().rows()->getNodeElementList();
  Eigen::VectorXd forces(static_cast<Eigen::Index>(rows.size()));
  for (Eigen::Index i = 0; i < forces.size(); ++i)
    forces[i] = multipliers[static_cast<std::size_t>(rows[static_cast<Teuchos::Ordinal>(i)])];
  const Vector x = problem.multipliers(forces);
  const auto right = problem.right_hand_side();
  Vector gradient(right->b.getMap());
  problem.system().gradient(hessian, x, *right, gradient);
  const auto print = fingerprint(x, gradient, right->b);
  if (differ(print.linear, record.counts[figure::linear], print.linear_scale) ||
      differ(print.energy, record.counts[figure::energy], print.energy_scale))
    throw Error(ExitStatus::bad_input,
                fmt::format("--resume: {}: a mesh or another file that the deck names was changed since this state was solved; "
                            "run the deck without it",
                            record.file));
  qp::Solution solution(x, gradient, Eigen::Map<const Eigen::VectorXd>(nu.data(), static_cast<Eigen::Index>(nu.size())));
  solution.converged = true;
  solution.projected_gradient = record.counts[figure::projected_gradient];
  solution.equality = record.counts[figure::equality];
  solution.error = record.counts[figure::error];
  solution.hessian_norm = record.counts[figure::hessian_norm];
  solution.precision = record.counts[figure::precision];
  solution.augmented = Eigen::Map<const Eigen::VectorXd>(augmented.data(), static_cast<Eigen::Index>(augmented.size()));
  feti::DualSolution result{std::move(solution), {own_bounds, own_bounds + static_cast<std::ptrdiff_t>(discs)}};
  result.converged = true;
  result.steps = static_cast<int>(record.counts[figure::steps]);
  result.change = record.counts[figure::change];
  result.applications = static_cast<int>(record.counts[figure::applications]);
  result.preconditionings = static_cast<int>(record.counts[figure::preconditionings]);
  result.outer_iterations = static_cast<int>(record.counts[figure::outer_iterations]);
  return result;
}

}  // namespace mortise::analysis
