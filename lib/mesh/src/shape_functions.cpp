#include "mesh/shape_functions.hpp"

#include <Eigen/LU>
#include <algorithm>

#include "base/dense.hpp"

namespace mortise::mesh {

namespace {

using Exponents = std::array<int, 3>;

// The corners of the reference cells.
std::vector<Eigen::Vector3d> reference_corners(CellType first_order)
{
  switch (first_order) {
    case CellType::line2:
      return {{-1, 0, 0}, {1, 0, 0}};
    case CellType::tri3:
      return {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    case CellType::quad4:
      return {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
    case CellType::tet4:
      return {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    case CellType::prism6:
      return {{0, 0, -1}, {1, 0, -1}, {0, 1, -1}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}};
    default:
      return {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1}, {-1, -1, 1}, {1, -1, 1}, {1, 1, 1}, {-1, 1, 1}};
  }
}

// Exponents ignoring those that are one [Arnold and Awanou, The serendipity family of finite elements, FoCM 11 (2011)].
int superlinear_degree(const Exponents& e)
{
  int sum = 0;
  for (const int k : e) sum += k > 1 ? k : 0;
  return sum;
}

bool in_space(CellType type, int dimension, const Exponents& e)
{
  for (int c = dimension; c < 3; ++c)
    if (e[static_cast<std::size_t>(c)] > 0) return false;
  const int total = e[0] + e[1] + e[2], in_plane = e[0] + e[1], largest = std::max({e[0], e[1], e[2]});
  switch (type) {
    case CellType::tri3:
    case CellType::tet4:
      return total <= 1;
    case CellType::tri6:
    case CellType::tet10:
      return total <= 2;
    case CellType::prism6:
      return in_plane <= 1 && e[2] <= 1;
    case CellType::prism15:
      return in_plane <= 2 && e[2] <= (in_plane <= 1 ? 2 : 1);
    case CellType::prism18:
      return in_plane <= 2 && e[2] <= 2;
    case CellType::quad8:
    case CellType::hex20:
      return superlinear_degree(e) <= 2;
    default:
      return largest <= (type == first_order(type) ? 1 : 2);
  }
}

constexpr int most_nodes = 27;  // of a cell

double power(double x, int exponent)
{
  return exponent == 0 ? 1 : exponent == 1 ? x : x * x;
}

double derivative(double x, int exponent)
{
  return exponent == 0 ? 0 : exponent == 1 ? 1 : 2 * x;
}

double monomial(const Exponents& e, const Eigen::Vector3d& x)
{
  return power(x[0], e[0]) * power(x[1], e[1]) * power(x[2], e[2]);
}

}  // namespace

ShapeFunctions::ShapeFunctions(CellType type) : dimension_(dimension(type)), nodes_(reference_corners(first_order(type)))
{
  for (const auto& amid : middles(type)) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const int c : amid) sum += nodes_[static_cast<std::size_t>(c)];
    nodes_.push_back(sum / static_cast<double>(amid.size()));
  }
  for (int i = 0; i <= 2; ++i)
    for (int j = 0; j <= 2; ++j)
      for (int k = 0; k <= 2; ++k)
        if (in_space(type, dimension_, {i, j, k})) exponents_.push_back({i, j, k});
  const auto n = static_cast<Eigen::Index>(nodes_.size());
  Eigen::MatrixXd values(static_cast<Eigen::Index>(exponents_.size()), n);
  for (Eigen::Index m = 0; m < values.rows(); ++m)
    for (Eigen::Index i = 0; i < n; ++i)
      values(m, i) = monomial(exponents_[static_cast<std::size_t>(m)], nodes_[static_cast<std::size_t>(i)]);
  coefficients_ = dense::inverse(values);
}

void ShapeFunctions::evaluate(const Eigen::Vector3d& at, Eigen::Ref<Eigen::VectorXd> value, Eigen::MatrixXd* gradient) const
{
  Eigen::Matrix<double, Eigen::Dynamic, 1, 0, most_nodes, 1> monomials(count());
  Eigen::Matrix<double, Eigen::Dynamic, 3, 0, most_nodes, 3> slopes(count(), 3);
  for (Eigen::Index m = 0; m < monomials.size(); ++m) {
    const auto& e = exponents_[static_cast<std::size_t>(m)];
    monomials[m] = monomial(e, at);
    for (int c = 0; gradient && c < dimension_; ++c) {
      slopes(m, c) = 1;
      for (int b = 0; b < 3; ++b) {
        const int k = e[static_cast<std::size_t>(b)];
        slopes(m, c) *= b == c ? derivative(at[b], k) : power(at[b], k);
      }
    }
  }
  value = coefficients_.lazyProduct(monomials);
  if (gradient) *gradient = coefficients_.lazyProduct(slopes.leftCols(dimension_));
}

const ShapeFunctions& shape_functions(CellType type)
{
  static const auto table = [] {
    std::vector<ShapeFunctions> all;
    for (std::size_t t = 0; t < cell_types; ++t) all.emplace_back(static_cast<CellType>(t));
    return all;
  }();
  return table[static_cast<std::size_t>(type)];
}

}  // namespace mortise::mesh
