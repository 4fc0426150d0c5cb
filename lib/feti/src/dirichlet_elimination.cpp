#include "dirichlet_elimination.hpp"

#include <algorithm>

#include "base/error.hpp"
#include "base/interruption.hpp"

namespace mortise::feti {

namespace {

constexpr Eigen::Index columns_at_once = 64;

// K with the rows and columns of `prescribed` replaced by those of an identity.
SparseMatrix with_identity(const SparseMatrix& k, const std::vector<Local>& prescribed)
{
  std::vector<char> eliminated(static_cast<std::size_t>(k.cols()), 0);
  for (const Local u : prescribed) eliminated[static_cast<std::size_t>(u)] = 1;
  SparseMatrix result = k;
  result.prune([&](Eigen::Index i, Eigen::Index j, double) {
    return i == j || (eliminated[static_cast<std::size_t>(i)] == 0 && eliminated[static_cast<std::size_t>(j)] == 0);
  });
  for (const Local u : prescribed) result.coeffRef(u, u) = 1;
  return result;
}

// B_cf X B_cf' over the rows `kept` of a block.
Eigen::MatrixXd compliance(const JumpOperator::Block& block, const std::vector<std::size_t>& kept,
                           const ConstrainedSubdomain& subdomain)
{
  const auto count = static_cast<Eigen::Index>(kept.size());
  Eigen::MatrixXd result(count, count);
  for (Eigen::Index begin = 0; begin < count; begin += columns_at_once) {
    stop_if_requested();
    const auto columns = std::min(columns_at_once, count - begin);
    Eigen::MatrixXd u = Eigen::MatrixXd::Zero(block.size, columns);
    std::vector<double*> column;
    for (Eigen::Index c = 0; c < columns; ++c) {
      const auto r = kept[static_cast<std::size_t>(begin + c)];
      for (auto i = block.offset[r]; i < block.offset[r + 1]; ++i) u(block.unknown[i], c) += block.coefficient[i];
      column.push_back(u.col(c).data());
    }
    subdomain.apply_inverse(column);
    for (Eigen::Index r = 0; r < count; ++r) {
      result.block(r, begin, 1, columns).setZero();
      const auto row = kept[static_cast<std::size_t>(r)];
      for (auto i = block.offset[row]; i < block.offset[row + 1]; ++i)
        result.block(r, begin, 1, columns) += block.coefficient[i] * u.row(block.unknown[i]);
    }
  }
  return 0.5 * (result + result.transpose());
}

}  // namespace

ConstrainedSubdomain::ConstrainedSubdomain(const SubdomainOperator& subdomain, std::vector<Local> prescribed, int block,
                                           const std::string& factorization)
    : subdomain_(subdomain), prescribed_(std::move(prescribed))
{
  if (prescribed_.empty()) return;
  k_ = subdomain.regularised();
  solver_.emplace(factorization, with_identity(k_, prescribed_), block);
}

void ConstrainedSubdomain::apply_inverse(std::span<double* const> columns) const
{
  if (!solver_) return subdomain_.apply_inverse(columns);
  for (double* column : columns)
    for (const Local u : prescribed_) column[u] = 0;
  solver_->solve(columns);
}

Eigen::VectorXd ConstrainedSubdomain::displacement(const Eigen::VectorXd& values, Eigen::VectorXd forces) const
{
  Eigen::VectorXd u = Eigen::VectorXd::Zero(forces.size());
  u(prescribed_) = values;
  forces -= k_.selfadjointView<Eigen::Lower>() * u;
  double* const column = forces.data();
  apply_inverse({&column, 1});
  forces(prescribed_) = values;
  return forces;
}

Eigen::VectorXd ConstrainedSubdomain::reactions(const Eigen::VectorXd& u) const
{
  const Eigen::VectorXd all = k_.selfadjointView<Eigen::Lower>() * u;
  return all(prescribed_);
}

DirichletElimination::DirichletElimination(const DualSystem& system, Global few) : system_(system)
{
  choose(few);
  collectively(system.communicator(), [&] {
    for (std::size_t s = 0; s < rows_.size(); ++s) {
      stop_if_requested();
      std::vector<Local> prescribed;
      for (const auto& row : rows_[s]) prescribed.push_back(row.unknown);
      subdomains_.emplace_back(*system.clusters().subdomains()[s], std::move(prescribed), system.dimension(),
                               system.factorization());
    }
  });
}

// The kinds of rows, of those that this rank's subdomains touch: a skew one holds several unknowns, copies of one included,
// a single one just one. Collective.
Vector DirichletElimination::kinds_of_rows() const
{
  const auto& jump = system_.jump();
  const auto& ranges = jump.ranges();
  Vector entries(jump.rows()), touched(jump.touched_rows());
  {
    auto count = view(touched);
    for (const auto& block : jump.blocks())
      for (std::size_t r = 0; r < block.row.size(); ++r)
        count[block.row[r]] += static_cast<double>(block.offset[r + 1] - block.offset[r]);
  }
  entries.doExport(touched, jump.import(), Tpetra::ADD);
  {
    auto kind = view(entries);
    for (Local i = 0; i < ranges.end; ++i)
      kind[i] = i < ranges.dirichlet || i >= ranges.springs ? other : kind[i] == 1 ? single : skew;
    for (const Local row : system_.unknown_components()) kind[row] = other;
  }
  touched.doImport(entries, jump.import(), Tpetra::INSERT);
  return touched;
}

// The rows of a subdomain that hold one unknown each, an unknown once, and none at a node that a skew row holds.
std::vector<DirichletElimination::PrescribedRow> DirichletElimination::rows_to_eliminate(const JumpOperator::Block& block,
                                                                                         const Vector& kinds) const
{
  const auto kind = view(kinds);
  const auto dimension = static_cast<Local>(system_.dimension());
  std::vector<char> prescribed(static_cast<std::size_t>(block.size), 0);
  for (std::size_t r = 0; r < block.row.size(); ++r)
    if (kind[block.row[r]] == skew)
      for (auto i = block.offset[r]; i < block.offset[r + 1]; ++i)
        std::fill_n(prescribed.begin() + block.unknown[i] / dimension * dimension, dimension, 1);
  std::vector<PrescribedRow> rows;
  for (std::size_t r = 0; r < block.row.size(); ++r) {
    if (kind[block.row[r]] != single) continue;
    const auto unknown = block.unknown[block.offset[r]];
    if (auto& once = prescribed[static_cast<std::size_t>(unknown)]; once++ == 0)
      rows.push_back({block.row[r], unknown, block.coefficient[block.offset[r]]});
  }
  return rows;
}

void DirichletElimination::choose(Global few)
{
  const auto& jump = system_.jump();
  const auto& comm = system_.communicator();
  const Vector kinds = kinds_of_rows();
  Vector eliminated(jump.touched_rows());
  long long chosen = 0;
  for (const auto& block : jump.blocks()) {
    const auto& rows = rows_.emplace_back(rows_to_eliminate(block, kinds));
    for (const auto& row : rows) view(eliminated)[row.row] = 1;
    chosen += static_cast<long long>(rows.size());
  }
  if (comm.sum(chosen) <= few) {
    for (auto& rows : rows_) rows.clear();
    eliminated.putScalar(0);
  }
  Vector entries(jump.rows());
  entries.doExport(eliminated, jump.import(), Tpetra::ADD);
  auto number = view(entries);
  const auto left = static_cast<long long>(std::count(number.begin(), number.end(), 0.0));
  count_ = comm.sum(left);
  Global next = comm.offset(left);
  for (double& n : number) {
    number_.push_back(n == 0 ? next++ : -1);
    n = static_cast<double>(number_.back());
  }
  Vector touched(jump.touched_rows());
  touched.doImport(entries, jump.import(), Tpetra::INSERT);
  for (const double n : view(std::as_const(touched))) touched_number_.push_back(static_cast<Global>(n));
}

DirichletElimination::Part DirichletElimination::part(std::size_t subdomain) const
{
  const auto& block = system_.jump().blocks()[subdomain];
  const auto& body = subdomains_[subdomain];
  Part result;
  std::vector<std::size_t> kept;
  for (std::size_t r = 0; r < block.row.size(); ++r)
    if (const Global number = touched_number_[static_cast<std::size_t>(block.row[r])]; number >= 0) {
      kept.push_back(r);
      result.number.push_back(number);
    }
  result.w = compliance(block, kept, body);
  result.first = system_.clusters().first(subdomain);
  if (body.prescribed().empty()) return result;
  const auto& kernel = system_.clusters().subdomains()[subdomain]->kernel();
  result.h = Eigen::MatrixXd::Zero(kernel.cols(), static_cast<Eigen::Index>(kept.size()));
  result.c.resize(kernel.cols(), kernel.cols());
  for (Eigen::Index k = 0; k < kernel.cols(); ++k) {
    const Eigen::VectorXd prescribed = kernel(body.prescribed(), k);
    const auto y = body.displacement(prescribed, Eigen::VectorXd::Zero(block.size));
    result.c.row(k) = body.reactions(y).transpose() * kernel(body.prescribed(), Eigen::all);
    for (std::size_t r = 0; r < kept.size(); ++r)
      for (auto i = block.offset[kept[r]]; i < block.offset[kept[r] + 1]; ++i)
        result.h(k, static_cast<Eigen::Index>(r)) -= block.coefficient[i] * y[block.unknown[i]];
  }
  result.c = 0.5 * (result.c + result.c.transpose()).eval();
  return result;
}

// d_h / beta of a subdomain's eliminated rows.
Eigen::VectorXd DirichletElimination::at_prescribed(std::size_t subdomain, const Eigen::Ref<const Eigen::VectorXd>& touched) const
{
  Eigen::VectorXd values(static_cast<Eigen::Index>(rows_[subdomain].size()));
  auto value = values.begin();
  for (const auto& row : rows_[subdomain]) *value++ = touched[row.row] / row.coefficient;
  return values;
}

Vector DirichletElimination::reduce(const Vector& d, Eigen::VectorXd& e) const
{
  const auto& jump = system_.jump();
  Vector touched(jump.touched_rows());
  touched.doImport(d, jump.import(), Tpetra::INSERT);
  std::vector<Eigen::VectorXd> u;
  Eigen::VectorXd by_supports = Eigen::VectorXd::Zero(e.size());
  collectively(system_.communicator(), [&] {
    for (std::size_t s = 0; s < rows_.size(); ++s) {
      const auto& body = subdomains_[s];
      const auto& kernel = system_.clusters().subdomains()[s]->kernel();
      u.emplace_back(Eigen::VectorXd::Zero(jump.blocks()[s].size));
      if (rows_[s].empty()) continue;
      u[s] = body.displacement(at_prescribed(s, view(std::as_const(touched))), std::move(u[s]));
      by_supports.segment(system_.clusters().first(s), kernel.cols()) +=
          kernel(body.prescribed(), Eigen::all).transpose() * body.reactions(u[s]);
    }
  });
  system_.communicator().sum_in_place({by_supports.data(), static_cast<std::size_t>(by_supports.size())});
  e -= by_supports;
  Vector result = jump.apply(u);
  result.update(1, d, -1);
  auto values = view(result);
  for (std::size_t i = 0; i < number_.size(); ++i)
    if (number_[i] < 0) values[static_cast<Eigen::Index>(i)] = 0;
  return result;
}

void DirichletElimination::complete(const Vector& d, const Eigen::VectorXd& nu, Vector& x) const
{
  const auto& jump = system_.jump();
  for (std::size_t i = 0; i < number_.size(); ++i)
    if (number_[i] < 0) view(x)[static_cast<Eigen::Index>(i)] = 0;
  const auto forces = jump.apply_transpose(x);
  Vector touched(jump.touched_rows()), found(jump.touched_rows());
  touched.doImport(d, jump.import(), Tpetra::INSERT);
  collectively(system_.communicator(), [&] {
    for (std::size_t s = 0; s < rows_.size(); ++s) {
      if (rows_[s].empty()) continue;
      const auto& body = subdomains_[s];
      const auto& kernel = system_.clusters().subdomains()[s]->kernel();
      Eigen::VectorXd values = at_prescribed(s, view(std::as_const(touched)));
      if (nu.size() > 0) values -= kernel(body.prescribed(), Eigen::all) * nu.segment(system_.clusters().first(s), kernel.cols());
      const Eigen::VectorXd left = body.reactions(body.displacement(values, forces[s])) - forces[s](body.prescribed());
      for (std::size_t r = 0; r < rows_[s].size(); ++r)
        view(found)[rows_[s][r].row] = left[static_cast<Eigen::Index>(r)] / rows_[s][r].coefficient;
    }
  });
  Vector added(jump.rows());
  added.doExport(found, jump.import(), Tpetra::ADD);
  x.update(1, added, 1);
}

}  // namespace mortise::feti
