#include "orthonormal_columns.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace mortise::qp {

namespace {

constexpr double orthonormal = 1e-8;  // what rounding may leave of Q'Q - I

// V'V over all ranks, the lower triangle.
Eigen::MatrixXd gram(const Eigen::MatrixXd& v, const Communicator& comm)
{
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(v.cols(), v.cols());
  result.selfadjointView<Eigen::Lower>().rankUpdate(v.transpose());
  comm.sum_in_place({result.data(), static_cast<std::size_t>(result.size())});
  return result;
}

// V becomes V R^-1. Returns about what rounding leaves of Q'Q - I if R'R was found as V'V.
double divide(Eigen::MatrixXd& v, const Eigen::MatrixXd& r)
{
  constexpr Eigen::Index part = 512;  // rows that stay in a cache
  const Eigen::MatrixXd inverse = r.triangularView<Eigen::Upper>().solve(Eigen::MatrixXd::Identity(r.rows(), r.cols()));
  Eigen::MatrixXd rows;
  for (Eigen::Index first = 0; first < v.rows(); first += part) {
    const auto count = std::min(part, v.rows() - first);
    rows.noalias() = v.middleRows(first, count) * inverse;
    v.middleRows(first, count) = rows;
  }
  return std::numeric_limits<double>::epsilon() * inverse.squaredNorm();
}

}  // namespace

OrthonormalColumns orthonormal_columns(Eigen::MatrixXd v, double least, const Communicator& comm)
{
  OrthonormalColumns result;
  const Eigen::MatrixXd products = gram(v, comm);
  const Eigen::VectorXd size = products.diagonal().cwiseSqrt();
  Eigen::MatrixXd lower = Eigen::MatrixXd::Zero(v.cols(), v.cols());  // of unit columns
  for (Eigen::Index j = 0; j < v.cols(); ++j) {
    const auto count = static_cast<Eigen::Index>(result.kept.size());
    Eigen::VectorXd row(count);
    for (Eigen::Index k = 0; k < count; ++k) {
      const auto before = result.kept[static_cast<std::size_t>(k)];
      row[k] = products(j, before) / (size[j] * size[before]);
    }
    lower.topLeftCorner(count, count).triangularView<Eigen::Lower>().solveInPlace(row);
    const double square = 1 - row.squaredNorm();
    if (!(size[j] > 0) || !(square > least * least)) continue;
    lower.row(count).head(count) = row.transpose();
    lower(count, count) = std::sqrt(square);
    if (count < j) v.col(count) = v.col(j);
    v.col(count) /= size[j];
    result.kept.push_back(j);
  }
  const auto count = static_cast<Eigen::Index>(result.kept.size());
  v.conservativeResize(Eigen::NoChange, count);
  result.r = lower.topLeftCorner(count, count).transpose();
  if (divide(v, result.r) > orthonormal) {
    const Eigen::MatrixXd again = gram(v, comm).llt().matrixU();
    divide(v, again);
    result.r = again * result.r;
  }
  result.r *= size(result.kept).asDiagonal();
  result.q = std::move(v);
  return result;
}

}  // namespace mortise::qp
