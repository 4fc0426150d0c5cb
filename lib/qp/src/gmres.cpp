#include "gmres.hpp"

#include <Eigen/Jacobi>
#include <cmath>
#include <vector>

#include "base/interruption.hpp"

namespace mortise::qp {

double gmres(const std::function<Eigen::VectorXd(Eigen::VectorXd& v)>& apply, const Eigen::VectorXd& b, double goal, int most,
             Eigen::VectorXd& z, int look)
{
  const double left_at_start = b.norm();
  std::vector<Eigen::VectorXd> basis{b / left_at_start}, applied_to;
  Eigen::MatrixXd triangle = Eigen::MatrixXd::Zero(most + 1, most);
  std::vector<Eigen::JacobiRotation<double>> turns;
  Eigen::VectorXd left = Eigen::VectorXd::Zero(most + 1);
  left[0] = left_at_start;
  int count = 0;
  const auto hopeless = [&] {
    const double part = std::log(std::abs(left[count]) / left_at_start) / std::log(goal / left_at_start);
    return count >= look && count > 2 * part * most;
  };
  while (count < most && std::abs(left[count]) > goal && !hopeless()) {
    stop_if_requested();
    Eigen::VectorXd next = apply(applied_to.emplace_back(basis.back()));
    for (int repeat = 0; repeat < 2; ++repeat)
      for (int i = 0; i <= count; ++i) {
        const double part = basis[static_cast<std::size_t>(i)].dot(next);
        triangle(i, count) += part;
        next -= part * basis[static_cast<std::size_t>(i)];
      }
    const double size = next.norm();
    if (!std::isfinite(size)) return std::numeric_limits<double>::infinity();
    triangle(count + 1, count) = size;
    for (int i = 0; i < count; ++i) triangle.col(count).applyOnTheLeft(i, i + 1, turns[static_cast<std::size_t>(i)].adjoint());
    Eigen::JacobiRotation<double> turn;
    turn.makeGivens(triangle(count, count), triangle(count + 1, count));
    triangle.col(count).applyOnTheLeft(count, count + 1, turn.adjoint());
    left.applyOnTheLeft(count, count + 1, turn.adjoint());
    turns.push_back(turn);
    ++count;
    if (size == 0) break;
    basis.push_back(next / size);
  }
  const Eigen::VectorXd y = triangle.topLeftCorner(count, count).triangularView<Eigen::Upper>().solve(left.head(count));
  for (int i = 0; i < count; ++i) z += y[i] * applied_to[static_cast<std::size_t>(i)];
  return std::abs(left[count]);
}

}  // namespace mortise::qp
