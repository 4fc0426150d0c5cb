#include "feti/explicit_problem.hpp"

#include <algorithm>

#include "base/error.hpp"
#include "dirichlet_elimination.hpp"
#include "row_scaling.hpp"
#include "rows_on_root.hpp"

namespace mortise::feti {

namespace {

// Of each subdomain: how many rows and motions, where these start; which rows; W, H and C. Collective.
std::vector<double> parts_on_root(const DirichletElimination& elimination, std::size_t subdomains, const Communicator& comm)
{
  std::vector<double> parts;
  collectively(comm, [&] {
    for (std::size_t s = 0; s < subdomains; ++s) {
      const auto part = elimination.part(s);
      parts.insert(parts.end(),
                   {static_cast<double>(part.w.cols()), static_cast<double>(part.c.cols()), static_cast<double>(part.first)});
      for (const Global number : part.number) parts.push_back(static_cast<double>(number));
      for (const auto* matrix : {&part.w, &part.h, &part.c})
        parts.insert(parts.end(), matrix->data(), matrix->data() + matrix->size());
    }
  });
  return on_root(std::move(parts), comm);
}

// Of each row that is left: its number and its column of G. Collective.
std::vector<double> columns_on_root(const DirichletElimination& elimination, const SparseMatrix& g, const Communicator& comm)
{
  std::vector<double> columns;
  for (int c = 0; c < g.cols(); ++c) {
    const Global number = elimination.number()[static_cast<std::size_t>(c)];
    if (number < 0) continue;
    columns.push_back(static_cast<double>(number));
    const Eigen::VectorXd column = g.col(c);
    columns.insert(columns.end(), column.begin(), column.end());
  }
  return on_root(std::move(columns), comm);
}

// Of each row that gives way: its number and its compliance. Collective.
std::vector<double> compliance_on_root(const DirichletElimination& elimination, const JumpOperator& jump,
                                       const Communicator& comm)
{
  std::vector<double> giving;
  const auto& compliance = RowScaling::compliance_of(jump);
  for (Eigen::Index i = 0; i < compliance.size(); ++i)
    if (const Global number = elimination.number()[static_cast<std::size_t>(i)]; number >= 0 && compliance[i] > 0)
      giving.insert(giving.end(), {static_cast<double>(number), compliance[i]});
  return on_root(std::move(giving), comm);
}

// The numbers of the rows of springs, on every rank. Collective.
std::vector<int> rows_of_springs(const DirichletElimination& elimination, const ElasticRows& springs)
{
  const auto& number = elimination.number();
  const Eigen::Map<const Eigen::Matrix<Global, Eigen::Dynamic, 1>> own(number.data(), static_cast<Eigen::Index>(number.size()));
  const Eigen::VectorXd all = springs.gather(own.cast<double>());
  return {all.begin(), all.end()};
}

// W, H and C of the whole system.
struct WholeMatrices {
  Eigen::MatrixXd w, h, c;

  WholeMatrices(Eigen::Index rows, Eigen::Index motions)
      : w(Eigen::MatrixXd::Zero(rows, rows)), h(motions, rows), c(Eigen::MatrixXd::Zero(motions, motions))
  {
  }
  // G, as columns_on_root() has it.
  void set_columns(const std::vector<double>& columns)
  {
    for (std::size_t at = 0; at < columns.size(); at += 1 + static_cast<std::size_t>(h.rows()))
      h.col(static_cast<Eigen::Index>(columns[at])) = Eigen::Map<const Eigen::VectorXd>(&columns[at] + 1, h.rows());
  }
  // Of all subdomains, as parts_on_root() has them.
  void add_parts(const std::vector<double>& parts)
  {
    for (const double *at = parts.data(), *end = at + parts.size(); at < end;) {
      const auto count = static_cast<Eigen::Index>(at[0]), modes = static_cast<Eigen::Index>(at[1]),
                 first = static_cast<Eigen::Index>(at[2]);
      const double* const number = at + 3;
      const Eigen::Map<const Eigen::MatrixXd> part(number + count, count, count);
      const Eigen::Map<const Eigen::MatrixXd> kernel_part(part.data() + part.size(), modes, count);
      const Eigen::Map<const Eigen::MatrixXd> stiffness(kernel_part.data() + kernel_part.size(), modes, modes);
      for (Eigen::Index j = 0; j < count; ++j) {
        const auto column = static_cast<Eigen::Index>(number[j]);
        for (Eigen::Index i = 0; i < count; ++i) w(static_cast<Eigen::Index>(number[i]), column) += part(i, j);
        h.col(column).segment(first, modes) += kernel_part.col(j);
      }
      c.block(first, first, modes, modes) += stiffness;
      at = stiffness.data() + stiffness.size();
    }
  }
};

}  // namespace

ExplicitProblem::ExplicitProblem(const DualSystem& system, Global few)
    : system_(system),
      elimination_(std::make_unique<DirichletElimination>(system, few)),
      rows_(std::make_unique<RowsOnRoot>(elimination_->number(), system.communicator()))
{
  const auto& comm = system.communicator();
  const auto& g = system.equality().local();
  const auto parts = parts_on_root(*elimination_, system.jump().blocks().size(), comm);
  const auto columns = columns_on_root(*elimination_, g, comm);
  const auto set = rows_->to_root(system.set());
  const auto giving = compliance_on_root(*elimination_, system.jump(), comm);
  const auto* springs = system.springs();
  const auto spring_rows = springs ? rows_of_springs(*elimination_, *springs) : std::vector<int>();
  collectively(comm, [&] {
    if (!comm.root()) return;
    WholeMatrices whole(static_cast<Eigen::Index>(elimination_->count()), g.rows());
    whole.set_columns(columns);
    whole.add_parts(parts);
    for (std::size_t i = 0; i < giving.size(); i += 2)
      whole.w(static_cast<Eigen::Index>(giving[i]), static_cast<Eigen::Index>(giving[i])) += giving[i + 1];
    if (springs) whole.w(spring_rows, spring_rows) += springs->compliance();
    newton_ = std::make_unique<qp::CondensedNewton>(std::move(whole.w), std::move(whole.h), std::move(whole.c), set);
    separated_ = newton_->separated();
  });
  separated_ = comm.any(separated_);
  eliminated_ = elimination_->count() < system.dual_unknowns();
}

ExplicitProblem::~ExplicitProblem() = default;

void ExplicitProblem::apply(const MultiVector& x, MultiVector& y, Teuchos::ETransp, Scalar alpha, Scalar beta) const
{
  for (std::size_t column = 0; column < x.getNumVectors(); ++column) {
    const auto in = x.getVector(column);
    Eigen::VectorXd motions = Eigen::VectorXd::Zero(system_.equality().size());
    Vector result(system_.jump().rows());
    view(result) = rows_->map_on_root(view(elimination_->reduce(*in, motions)),
                                      [&](const Eigen::VectorXd& all) { return newton_->inverse_times(all); });
    elimination_->complete(*in, {}, result);
    y.getVectorNonConst(column)->update(alpha, result, beta);
  }
}

ExplicitProblem::Result ExplicitProblem::solve(const Vector& linear, Eigen::VectorXd e, const qp::FeasibleSet& set,
                                               const Result* near) const
{
  const auto& comm = system_.communicator();
  const Eigen::VectorXd right_side = e;
  const auto reduced = rows_->to_root(view(elimination_->reduce(linear, e)));
  const auto start = near ? rows_->to_root(view(near->x)) : std::vector<double>();
  const auto felt = near ? rows_->to_root(view(*near->reaction)) : std::vector<double>();
  const auto on_root = rows_->to_root(set);
  const auto map = [](const std::vector<double>& values) {
    return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
  };
  std::vector<double> x, nu, reaction;
  std::vector<long long> outcome;
  collectively(comm, [&] {
    if (!comm.root()) return;
    qp::CondensedNewton::Result from;
    if (near) from = {map(start), near->nu, near->converged, 0, map(felt)};
    const auto found = newton_->solve(map(reduced), e, on_root, near ? &from : nullptr);
    x.assign(found.x.begin(), found.x.end());
    nu.assign(found.nu.begin(), found.nu.end());
    reaction.assign(found.reaction.begin(), found.reaction.end());
    outcome = {found.converged ? 1 : 0, found.settled ? 1 : 0, found.slides ? 1 : 0};
  });
  comm.broadcast(nu);
  comm.broadcast(outcome);
  Result result{Vector(system_.jump().rows()), map(nu),         outcome[0] == 1,
                Vector(system_.jump().rows()), outcome[1] == 1, outcome[2] == 1};
  view(result.x) = rows_->from_root(std::move(x));
  view(*result.reaction) = rows_->from_root(std::move(reaction));
  elimination_->complete(linear, result.nu, result.x);
  const auto& equality = system_.equality();
  if (!comm.any(!system_.set().constrained().empty()) && equality.size() > 0) {
    // A body may be free to change its shape and have no other forces than those of G x = e: rounding of d is large beside them.
    const Eigen::VectorXd lacking = right_side - equality.apply(result.x);
    equality.add_transpose(1, equality.solve(lacking), result.x);
  }
  return result;
}

}  // namespace mortise::feti
