#include "feti/explicit_problem.hpp"

#include <algorithm>

#include "base/error.hpp"
#include "base/interruption.hpp"

namespace mortise::feti {

namespace {

constexpr Eigen::Index columns_at_once = 64;

// B_s K_s^+ B_s' over the rows that the subdomain takes part in.
Eigen::MatrixXd compliance(const JumpOperator::Block& block, const SubdomainOperator& subdomain)
{
  const auto count = static_cast<Eigen::Index>(block.row.size());
  Eigen::MatrixXd result(count, count);
  for (Eigen::Index begin = 0; begin < count; begin += columns_at_once) {
    end_if_told();
    const auto columns = std::min(columns_at_once, count - begin);
    Eigen::MatrixXd u = Eigen::MatrixXd::Zero(block.size, columns);
    std::vector<double*> column;
    for (Eigen::Index c = 0; c < columns; ++c) {
      const auto r = static_cast<std::size_t>(begin + c);
      for (auto i = block.offset[r]; i < block.offset[r + 1]; ++i) u(block.unknown[i], c) += block.coefficient[i];
      column.push_back(u.col(c).data());
    }
    subdomain.apply_inverse(column);
    for (Eigen::Index r = 0; r < count; ++r) {
      result.block(r, begin, 1, columns).setZero();
      for (auto i = block.offset[static_cast<std::size_t>(r)]; i < block.offset[static_cast<std::size_t>(r) + 1]; ++i)
        result.block(r, begin, 1, columns) += block.coefficient[i] * u.row(block.unknown[i]);
    }
  }
  return result;
}

// To rank 0, in the order of ranks. Whether all ranks have room for it is seen before any of them sends: one alone cannot stop.
std::vector<double> on_root(std::vector<double> values, const Communicator& comm)
{
  const auto arriving = static_cast<std::size_t>(comm.sum(static_cast<long long>(values.size())));
  collectively(comm, [&] {
    std::vector<double> room;
    room.reserve(values.size() + (comm.root() ? 3 * arriving : 0));  // as bytes, as numbers, and all of them
  });
  std::vector<std::vector<double>> send(static_cast<std::size_t>(comm.size()));
  send[0] = std::move(values);
  std::vector<double> all;
  for (const auto& part : comm.exchange(send)) all.insert(all.end(), part.begin(), part.end());
  return all;
}

}  // namespace

ExplicitProblem::ExplicitProblem(const DualProblem& problem) : problem_(problem)
{
  const auto& comm = problem.communicator();
  const auto& jump = problem.jump();
  const auto& blocks = jump.blocks();
  const auto size = static_cast<Eigen::Index>(problem.dual_unknowns());
  const auto touched = jump.touched_rows()->getNodeElementList();
  std::vector<double> entries;  // of each subdomain: how many rows, which ones, the matrix over them
  collectively(comm, [&] {
    for (std::size_t s = 0; s < blocks.size(); ++s) {
      const Eigen::MatrixXd part = compliance(blocks[s], *problem.clusters().subdomains()[s]);
      entries.push_back(static_cast<double>(part.rows()));
      for (const Local row : blocks[s].row) entries.push_back(static_cast<double>(touched[row]));
      entries.insert(entries.end(), part.data(), part.data() + part.size());
    }
  });
  entries = on_root(std::move(entries), comm);
  const auto& g = problem.equality().local();
  std::vector<double> columns;  // of each row: its number and its column of G
  for (int c = 0; c < g.cols(); ++c) {
    columns.push_back(static_cast<double>(jump.rows()->getGlobalElement(c)));
    const Eigen::VectorXd column = g.col(c);
    columns.insert(columns.end(), column.begin(), column.end());
  }
  columns = on_root(std::move(columns), comm);
  const qp::FeasibleSet set = whole_set();
  collectively(comm, [&] {
    if (!comm.root()) return;
    Eigen::MatrixXd f = Eigen::MatrixXd::Zero(size, size), all(g.rows(), size);
    for (std::size_t at = 0; at < entries.size();) {
      const auto count = static_cast<Eigen::Index>(entries[at]);
      const auto row = [&](Eigen::Index i) { return static_cast<Eigen::Index>(entries[at + 1 + static_cast<std::size_t>(i)]); };
      const Eigen::Map<const Eigen::MatrixXd> part(&entries[at] + 1 + count, count, count);
      for (Eigen::Index c = 0; c < count; ++c)
        for (Eigen::Index r = 0; r < count; ++r) f(row(r), row(c)) += 0.5 * (part(r, c) + part(c, r));
      at += static_cast<std::size_t>(1 + count + count * count);
    }
    for (std::size_t at = 0; at < columns.size(); at += 1 + static_cast<std::size_t>(g.rows()))
      all.col(static_cast<Eigen::Index>(columns[at])) = Eigen::Map<const Eigen::VectorXd>(&columns[at] + 1, g.rows());
    newton_ = std::make_unique<qp::CondensedNewton>(std::move(f), std::move(all), set);
  });
}

// The sets of all ranks as one; of use on rank 0.
qp::FeasibleSet ExplicitProblem::whole_set() const
{
  const auto& comm = problem_.communicator();
  const auto& set = problem_.set();
  const auto number = [&](Local i) { return i < 0 ? -1.0 : static_cast<double>(problem_.jump().rows()->getGlobalElement(i)); };
  std::vector<double> bounds, discs;
  for (const auto& bound : set.bounds()) bounds.insert(bounds.end(), {number(bound.index), bound.lower});
  for (const auto& disc : set.discs())
    discs.insert(discs.end(), {number(disc.index[0]), number(disc.index[1]), disc.radius, disc.centre[0], disc.centre[1],
                               number(disc.normal), disc.coefficient});
  bounds = on_root(std::move(bounds), comm);
  discs = on_root(std::move(discs), comm);
  std::vector<qp::Bound> all_bounds;
  std::vector<qp::Disc> all_discs;
  for (std::size_t i = 0; i < bounds.size(); i += 2) all_bounds.push_back({static_cast<Local>(bounds[i]), bounds[i + 1]});
  for (std::size_t i = 0; i < discs.size(); i += 7)
    all_discs.push_back({{static_cast<Local>(discs[i]), static_cast<Local>(discs[i + 1])},
                         discs[i + 2],
                         {discs[i + 3], discs[i + 4]},
                         static_cast<Local>(discs[i + 5]),
                         discs[i + 6]});
  return {std::move(all_bounds), std::move(all_discs)};
}

// A vector over the dual space, whole on rank 0 by the numbers of its rows.
std::vector<double> ExplicitProblem::to_root(const Eigen::Ref<const Eigen::VectorXd>& own) const
{
  const auto& rows = *problem_.jump().rows();
  std::vector<double> entries;  // number and value of each row
  for (Eigen::Index i = 0; i < own.size(); ++i)
    entries.insert(entries.end(), {static_cast<double>(rows.getGlobalElement(static_cast<Local>(i))), own[i]});
  entries = on_root(std::move(entries), problem_.communicator());
  std::vector<double> all(entries.size() / 2);
  for (std::size_t i = 0; i < entries.size(); i += 2) all[static_cast<std::size_t>(entries[i])] = entries[i + 1];
  return all;
}

void ExplicitProblem::from_root(std::vector<double> all, Vector& x) const
{
  problem_.communicator().broadcast(all);
  auto values = view(x);
  for (Eigen::Index i = 0; i < values.size(); ++i)
    values[i] = all[static_cast<std::size_t>(problem_.jump().rows()->getGlobalElement(static_cast<Local>(i)))];
}

void ExplicitProblem::apply(const MultiVector& x, MultiVector& y, Teuchos::ETransp, Scalar alpha, Scalar beta) const
{
  const auto& comm = problem_.communicator();
  for (std::size_t column = 0; column < x.getNumVectors(); ++column) {
    const auto in = x.getVector(column);
    auto all = to_root(view(*in));
    collectively(comm, [&] {
      if (!comm.root()) return;
      const auto solved =
          newton_->inverse_times(Eigen::Map<const Eigen::VectorXd>(all.data(), static_cast<Eigen::Index>(all.size())));
      all.assign(solved.begin(), solved.end());
    });
    Vector result(in->getMap());
    from_root(std::move(all), result);
    y.getVectorNonConst(column)->update(alpha, result, beta);
  }
}

ExplicitProblem::Result ExplicitProblem::solve() const
{
  const auto& comm = problem_.communicator();
  const auto linear = to_root(view(problem_.linear()));
  const qp::FeasibleSet set = whole_set();
  std::vector<double> x, nu;
  std::vector<long long> outcome;
  collectively(comm, [&] {
    if (!comm.root()) return;
    const auto found = newton_->solve(Eigen::Map<const Eigen::VectorXd>(linear.data(), static_cast<Eigen::Index>(linear.size())),
                                      problem_.equality().right_side(), set);
    x.assign(found.x.begin(), found.x.end());
    nu.assign(found.nu.begin(), found.nu.end());
    outcome = {found.settled ? 1 : 0, found.steps};
  });
  comm.broadcast(nu);
  comm.broadcast(outcome);
  Result result{Vector(problem_.jump().rows()),
                Eigen::Map<const Eigen::VectorXd>(nu.data(), static_cast<Eigen::Index>(nu.size())), outcome[0] == 1,
                static_cast<int>(outcome[1])};
  from_root(std::move(x), result.x);
  return result;
}

}  // namespace mortise::feti
