#include "orthonormal_columns.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace mortise::qp {

namespace {

constexpr double orthonormal = 1e-8;        // what rounding may leave of Q'Q - I
constexpr double largest_condition = 1e12;  // of V'V: beyond, its factor is rounding

// V'V over all ranks, the lower triangle.
Eigen::MatrixXd gram(const Eigen::MatrixXd& v, const Communicator& comm)
{
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(v.cols(), v.cols());
  if (v.size() > 0) result.selfadjointView<Eigen::Lower>().rankUpdate(v.transpose());  // else it divides by their number
  comm.sum_in_place({result.data(), static_cast<std::size_t>(result.size())});
  return result;
}

// V becomes V R^-1.
void multiply(Eigen::MatrixXd& v, const Eigen::MatrixXd& inverse)
{
  constexpr Eigen::Index part = 512;  // rows that stay in a cache
  Eigen::MatrixXd rows;
  for (Eigen::Index first = 0; first < v.rows(); first += part) {
    const auto count = std::min(part, v.rows() - first);
    rows.noalias() = v.middleRows(first, count) * inverse;
    v.middleRows(first, count) = rows;
  }
}

}  // namespace

OrthonormalColumns orthonormal_columns(Eigen::MatrixXd v, double least, const Communicator& comm)
{
  OrthonormalColumns result;
  const Eigen::MatrixXd products = gram(v, comm);
  const Eigen::VectorXd size = products.diagonal().cwiseSqrt();
  Eigen::MatrixXd r = Eigen::MatrixXd::Zero(v.cols(), v.cols()), inverse = r;  // of unit columns
  for (Eigen::Index j = 0; j < v.cols(); ++j) {
    if (!(size[j] > 0)) continue;
    const auto count = static_cast<Eigen::Index>(result.kept.size());
    Eigen::VectorXd row(count);
    for (Eigen::Index k = 0; k < count; ++k) {
      const auto before = result.kept[static_cast<std::size_t>(k)];
      row[k] = products(j, before) / (size[j] * size[before]);
    }
    const auto inverse_before = inverse.topLeftCorner(count, count).triangularView<Eigen::Upper>();
    row = inverse_before.transpose() * row;
    const double square = 1 - row.squaredNorm();
    if (!(square > least * least)) continue;
    Eigen::VectorXd column = inverse_before * row;
    if (!((1 + column.squaredNorm()) / square < largest_condition)) continue;
    r.col(count).head(count) = row;
    r(count, count) = std::sqrt(square);
    inverse.col(count).head(count) = -column / r(count, count);
    inverse(count, count) = 1 / r(count, count);
    v.col(count) = v.col(j) / size[j];
    result.kept.push_back(j);
  }
  const auto count = static_cast<Eigen::Index>(result.kept.size());
  v.conservativeResize(Eigen::NoChange, count);
  result.r = r.topLeftCorner(count, count);
  multiply(v, inverse.topLeftCorner(count, count));
  if (std::numeric_limits<double>::epsilon() * inverse.squaredNorm() > orthonormal) {
    const Eigen::MatrixXd again = gram(v, comm).llt().matrixU();
    multiply(v, again.triangularView<Eigen::Upper>().solve(Eigen::MatrixXd::Identity(count, count)));
    result.r = again * result.r;
  }
  result.r *= size(result.kept).asDiagonal();
  result.q = std::move(v);
  return result;
}

}  // namespace mortise::qp
