#include "feti/subdomain_operator.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/dense.hpp"
#include "base/submatrix.hpp"

namespace mortise::feti {

namespace {

// Halves the nodes `levels` times across their longest extent and takes of each part the node nearest its centroid.
void spread(std::span<Local> nodes, std::span<const Point> points, int levels, std::vector<Local>& chosen)
{
  if (nodes.empty()) return;
  if (levels > 0) {
    Point low = points[nodes[0]], high = low;
    for (const Local n : nodes) {
      low = low.cwiseMin(points[n]);
      high = high.cwiseMax(points[n]);
    }
    Eigen::Index axis = 0;
    (high - low).maxCoeff(&axis);
    const auto middle = nodes.begin() + static_cast<std::ptrdiff_t>(nodes.size() / 2);
    std::nth_element(nodes.begin(), middle, nodes.end(),
                     [&](Local a, Local b) { return std::pair(points[a][axis], a) < std::pair(points[b][axis], b); });
    spread(nodes.first(nodes.size() / 2), points, levels - 1, chosen);
    spread(nodes.subspan(nodes.size() / 2), points, levels - 1, chosen);
    return;
  }
  Point centre = Point::Zero();
  for (const Local n : nodes) centre += points[n];
  centre /= static_cast<double>(nodes.size());
  chosen.push_back(*std::min_element(nodes.begin(), nodes.end(), [&](Local a, Local b) {
    return std::pair((points[a] - centre).squaredNorm(), a) < std::pair((points[b] - centre).squaredNorm(), b);
  }));
}

Eigen::MatrixXd rows_of(const Eigen::MatrixXd& kernel, std::span<const Local> nodes, int dimension)
{
  Eigen::MatrixXd rows(static_cast<Eigen::Index>(nodes.size()) * dimension, kernel.cols());
  for (std::size_t i = 0; i < nodes.size(); ++i)
    rows.middleRows(static_cast<Eigen::Index>(i) * dimension, dimension) = kernel.middleRows(nodes[i] * dimension, dimension);
  return rows;
}

// Smallest eigenvalue of R_I'R_I against its mean if the nodes were perfectly spread: 1 at best.
double quality(const Eigen::MatrixXd& kernel, std::span<const Local> nodes, int dimension)
{
  const Eigen::MatrixXd rows = rows_of(kernel, nodes, dimension);
  const double least = dense::symmetric_eigenvalues(rows.transpose() * rows)[0];
  return least * static_cast<double>(kernel.rows()) / static_cast<double>(rows.rows());
}

}  // namespace

bool any_slender(const Subdomains& subdomains)
{
  return std::ranges::any_of(subdomains, [](const auto& subdomain) { return subdomain->inaccuracy() > inaccurate; });
}

std::map<const SubdomainOperator*, std::vector<std::size_t>> by_original(const Subdomains& subdomains)
{
  std::map<const SubdomainOperator*, std::vector<std::size_t>> members;
  for (std::size_t s = 0; s < subdomains.size(); ++s) members[&subdomains[s]->original()].push_back(s);
  return members;
}

void apply_inverse(const Subdomains& subdomains, std::vector<Eigen::VectorXd>& v, bool rounded)
{
  std::vector<double*> columns;
  for (const auto& [original, list] : by_original(subdomains)) {
    columns.clear();
    for (const auto s : list) {
      subdomains[s]->rotate_back(v[s]);
      columns.push_back(v[s].data());
    }
    if (rounded)
      original->apply_rounded_inverse(columns);
    else
      original->apply_inverse(columns);
    for (const auto s : list) subdomains[s]->rotate(v[s]);
  }
}

std::vector<Local> fixing_nodes(std::span<const Point> points, const Eigen::MatrixXd& kernel, int dimension)
{
  std::vector<Local> all(points.size());
  std::iota(all.begin(), all.end(), 0);
  std::vector<Local> best;
  double best_quality = 0;
  // More nodes make the factor fuller, so the few are tried first; a slender or flat subdomain takes more.
  for (int levels = dimension - 1; levels <= 5; ++levels) {
    std::vector<Local> nodes;
    spread(all, points, levels, nodes);
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    const double found = quality(kernel, nodes, dimension);
    if (found > best_quality) {
      best = nodes;
      best_quality = found;
    }
    if (best_quality > 0.05) break;
  }
  if (best_quality > 1e-6) return best;
  // The middles of the slices of a beam stand on its axis and do not keep it from turning about that. What spans most of the
  // motions does [Businger and Golub, Numer. Math. 7 (1965)].
  const Eigen::VectorXi pivots = dense::pivoted_columns(kernel.transpose());
  for (Eigen::Index i = 0; i < kernel.cols(); ++i) best.push_back(static_cast<Local>(pivots[i] / dimension));
  std::sort(best.begin(), best.end());
  best.erase(std::unique(best.begin(), best.end()), best.end());
  return quality(kernel, best, dimension) < 1e-6 ? all : best;  // so few nodes, or so flat, that only all of them will do
}

std::vector<double> nodal_stiffness(const Eigen::VectorXd& diagonal, int dimension)
{
  std::vector<double> result(static_cast<std::size_t>(diagonal.size() / dimension));
  for (std::size_t n = 0; n < result.size(); ++n)
    result[n] = diagonal.segment(static_cast<Eigen::Index>(n) * dimension, dimension).mean();
  return result;
}

SparseMatrix fixing_term(const Eigen::VectorXd& diagonal, const Eigen::MatrixXd& kernel, std::span<const Point> points,
                         int dimension)
{
  const auto nodes = fixing_nodes(points, kernel, dimension);
  const Eigen::MatrixXd rows = rows_of(kernel, nodes, dimension);
  const double r = diagonal.mean();
  const Eigen::MatrixXd term = r * rows * dense::solve_symmetric(rows.transpose() * rows, rows.transpose());
  std::vector<Eigen::Triplet<double>> triplets;
  const auto unknown = [&](Eigen::Index i) {
    return nodes[static_cast<std::size_t>(i / dimension)] * dimension + static_cast<int>(i % dimension);
  };
  for (Eigen::Index i = 0; i < term.rows(); ++i)
    for (Eigen::Index j = 0; j <= i; ++j) triplets.emplace_back(unknown(i), unknown(j), term(i, j));
  SparseMatrix result(diagonal.size(), diagonal.size());
  result.setFromTriplets(triplets.begin(), triplets.end());
  return result;
}

namespace {

// Of a sparse K: K_bb, and what condenses the inside, if that is asked for.
class SparseInterface : public InterfaceStiffness {
 public:
  SparseInterface(const SparseMatrix& stiffness, const std::vector<int>& unknowns, bool condensed,
                  const std::string& factorization, int dimension)
      : lower_(submatrix(stiffness, unknowns, unknowns, true))
  {
    if (!condensed) return;
    std::vector<int> all(static_cast<std::size_t>(stiffness.rows())), inside;
    std::iota(all.begin(), all.end(), 0);
    std::set_difference(all.begin(), all.end(), unknowns.begin(), unknowns.end(), std::back_inserter(inside));
    if (inside.empty()) return;
    interior_ = std::make_unique<DirectSolver>(factorization, submatrix(stiffness, inside, inside, true), dimension);
    coupling_ = submatrix(stiffness, inside, unknowns, false);
  }

  Eigen::MatrixXd apply(const Eigen::MatrixXd& u) const override
  {
    Eigen::MatrixXd f = lower_.selfadjointView<Eigen::Lower>() * u;
    if (!interior_) return f;
    Eigen::MatrixXd inner = coupling_ * u;
    std::vector<double*> columns;
    for (Eigen::Index c = 0; c < inner.cols(); ++c) columns.push_back(inner.col(c).data());
    interior_->solve(columns);
    f -= coupling_.transpose() * inner;
    return f;
  }

 private:
  SparseMatrix lower_;     // K_bb
  SparseMatrix coupling_;  // K_ib
  std::unique_ptr<DirectSolver> interior_;
};

}  // namespace

// `lower` is taken by a swap: Eigen 3.4 has no move of sparse matrices.
ElasticSubdomain::ElasticSubdomain(SparseMatrix lower, Eigen::MatrixXd kernel, std::span<const Point> points, int dimension,
                                   const std::string& factorization, std::optional<double> most_rounded, double refined_from)
    : kernel_(std::move(kernel)), dimension_(dimension)
{
  stiffness_.swap(lower);
  column_block_ = has_column_blocks(stiffness_, dimension) ? dimension : 1;
  fixing_ = fixing_term(diagonal(), kernel_, points, dimension);
  solver_ = std::make_unique<DirectSolver>(factorization, stiffness_ + fixing_, dimension, most_rounded);
  if (rounding() > 0) return;
  if (const double measured = measured_inaccuracy(); measured > refined_from) inaccuracy_ = measured;
}

// Of a vector that all motions are part of, those of single nodes above all: what rounding makes of it is mostly the softest
// motion.
double ElasticSubdomain::measured_inaccuracy() const
{
  Eigen::VectorXd v(size());
  for (int i = 0; i < size(); ++i) v[i] = ((i * 0x9E3779B97F4A7C15) >> 63) != 0 ? 1 : -1;
  const Eigen::VectorXd nothing = Eigen::VectorXd::Zero(size());
  Eigen::VectorXd u = -residual(nothing.data(), v.data());
  double* const column = u.data();
  solver_->solve({&column, 1});
  return (u - v).norm() / v.norm();
}

void ElasticSubdomain::apply_inverse(std::span<double* const> columns) const
{
  return rounding() > 0 || inaccuracy_ > inaccurate ? refine(columns) : solver_->solve(columns);
}

void ElasticSubdomain::apply_rounded_inverse(std::span<double* const> columns) const
{
  return inaccuracy_ > inaccurate ? refine(columns) : solver_->solve(columns);
}

namespace {

// Each leaves a part of what double precision loses; where that is everything, more of them only add.
int steps_of_refinement(double inaccuracy)
{
  constexpr int least = 2, most = 8;
  constexpr double enough = 1e-12, everything = 0.5;
  if (inaccuracy >= everything || inaccuracy <= 0) return least;
  return std::clamp(static_cast<int>(std::ceil(std::log(enough) / std::log(inaccuracy))), least, most);
}

}  // namespace

// x += K~^+ (b - (K + r N) x) [Wilkinson, Rounding Errors in Algebraic Processes (1963)]: each step takes the error times
// rounding(); of a slender subdomain less is left the less inaccurate it is.
void ElasticSubdomain::refine(std::span<double* const> columns) const
{
  const int steps = steps_of_refinement(inaccuracy_);
  constexpr std::size_t at_once = 16;
  for (; !columns.empty(); columns = columns.subspan(std::min(at_once, columns.size()))) {
    const auto own = columns.first(std::min(at_once, columns.size()));
    Eigen::MatrixXd right(size(), static_cast<Eigen::Index>(own.size())), left(right.rows(), right.cols());
    std::vector<double*> corrections;
    for (std::size_t c = 0; c < own.size(); ++c) {
      const auto column = static_cast<Eigen::Index>(c);
      right.col(column) = Eigen::Map<const Eigen::VectorXd>(own[c], size());
      corrections.push_back(left.col(column).data());
    }
    solver_->solve(own);
    for (int step = 0; step < steps; ++step) {
      for (std::size_t c = 0; c < own.size(); ++c) {
        const auto column = static_cast<Eigen::Index>(c);
        left.col(column) = residual(right.col(column).data(), own[c]);
      }
      solver_->solve(corrections);
      for (std::size_t c = 0; c < own.size(); ++c)
        Eigen::Map<Eigen::VectorXd>(own[c], size()) += left.col(static_cast<Eigen::Index>(c));
    }
  }
}

// b - (K + r N) x. In extended precision where that of x itself in double precision is what counts: a residual of double
// precision has the error that is to be taken away.
Eigen::VectorXd ElasticSubdomain::residual(const double* b, const double* x) const
{
  const Eigen::Map<const Eigen::VectorXd> right(b, size()), left(x, size());
  if (inaccuracy_ <= inaccurate) return right - apply(left) - fixing_.selfadjointView<Eigen::Lower>() * left;
  ExtendedVector sums = right.cast<long double>();
  const ExtendedVector exact = left.cast<long double>();
  for (const SparseMatrix* matrix : {&stiffness_, &fixing_}) subtract_product(*matrix, exact, sums);
  return sums.cast<double>();
}

Eigen::VectorXd ElasticSubdomain::apply(const Eigen::VectorXd& u) const
{
  return symmetric_product(stiffness_, column_block_, u);
}

// The columns of the lower triangle begin with it; Eigen would search for it in each.
Eigen::VectorXd ElasticSubdomain::diagonal() const
{
  Eigen::VectorXd result(size());
  for (int j = 0; j < size(); ++j) result[j] = stiffness_.valuePtr()[stiffness_.outerIndexPtr()[j]];
  return result;
}

std::size_t ElasticSubdomain::foreseen_factor_bytes(const SparseMatrix& lower, const Eigen::MatrixXd& kernel,
                                                    std::span<const Point> points, int dimension)
{
  return Cholesky(lower + fixing_term(lower.diagonal(), kernel, points, dimension), dimension).factor_bytes();
}

std::unique_ptr<const InterfaceStiffness> ElasticSubdomain::interface_stiffness(const std::vector<int>& unknowns, bool condensed,
                                                                                const std::string& factorization) const
{
  return std::make_unique<SparseInterface>(stiffness_, unknowns, condensed, factorization, dimension_);
}

RotatedSubdomain::RotatedSubdomain(std::shared_ptr<const SubdomainOperator> original, const Eigen::Matrix3d& rotation,
                                   int dimension)
    : original_(std::move(original)), rotation_(rotation.topLeftCorner(dimension, dimension)), kernel_(original_->kernel())
{
  for (Eigen::Index i = 0; i < kernel_.rows(); i += dimension)
    kernel_.middleRows(i, dimension) = rotation_ * Eigen::MatrixXd(kernel_.middleRows(i, dimension));
}

void RotatedSubdomain::rotate_back(Eigen::VectorXd& v) const
{
  Eigen::Map<Eigen::MatrixXd> nodes(v.data(), rotation_.rows(), v.size() / rotation_.rows());
  nodes = rotation_.transpose() * nodes;
}

void RotatedSubdomain::rotate(Eigen::VectorXd& v) const
{
  Eigen::Map<Eigen::MatrixXd> nodes(v.data(), rotation_.rows(), v.size() / rotation_.rows());
  nodes = rotation_ * nodes;
}

void RotatedSubdomain::apply_inverse(std::span<double* const> columns) const
{
  for (double* column : columns) {
    Eigen::Map<Eigen::VectorXd> v(column, size());
    Eigen::VectorXd x = v;
    rotate_back(x);
    double* const pointer = x.data();
    original_->apply_inverse({&pointer, 1});
    rotate(x);
    v = x;
  }
}

Eigen::VectorXd RotatedSubdomain::apply(const Eigen::VectorXd& u) const
{
  Eigen::VectorXd v = u;
  rotate_back(v);
  v = original_->apply(v);
  rotate(v);
  return v;
}

// T K T' of a matrix of the original.
SparseMatrix RotatedSubdomain::rotated(const SparseMatrix& lower) const
{
  std::vector<Eigen::Triplet<double>> entries;
  for (int node = 0; node < size(); node += static_cast<int>(rotation_.rows()))
    for (int i = 0; i < rotation_.rows(); ++i)
      for (int j = 0; j < rotation_.cols(); ++j) entries.emplace_back(node + i, node + j, rotation_(i, j));
  SparseMatrix rotation(size(), size());
  rotation.setFromTriplets(entries.begin(), entries.end());
  const SparseMatrix whole = lower.selfadjointView<Eigen::Lower>();
  return SparseMatrix(rotation * whole * SparseMatrix(rotation.transpose())).triangularView<Eigen::Lower>();
}

}  // namespace mortise::feti
