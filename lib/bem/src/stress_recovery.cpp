#include "bem/stress_recovery.hpp"

#include <Eigen/QR>
#include <algorithm>

#include "bem/surface_stress.hpp"

namespace mortise::bem {

namespace {

constexpr int monomials = 10;
constexpr std::size_t fewest_nodes = 6;  // of a patch: else it gets a further ring of panels

using Monomials = Eigen::Matrix<double, monomials, 1>;
using Slopes = Eigen::Matrix<double, monomials, 3>;

Monomials values(const Point& s)
{
  return (Monomials() << 1, s[0], s[1], s[2], s[0] * s[0], s[1] * s[1], s[2] * s[2], s[0] * s[1], s[1] * s[2], s[0] * s[2])
      .finished();
}

Slopes slopes(const Point& s)
{
  return (Slopes() << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 2 * s[0], 0, 0, 0, 2 * s[1], 0, 0, 0, 2 * s[2], s[1], s[0], 0, 0, s[2],
          s[1], s[2], 0, s[0])
      .finished();
}

}  // namespace

StressRecovery::StressRecovery(const Panels& panels, const fem::Material& material)
    : panels_(panels), material_(material), around_(panels.points.size())
{
  for (std::size_t p = 0; p < panels.corners.size(); ++p)
    for (const Local c : panels.corners[p]) around_[static_cast<std::size_t>(c)].push_back(p);
}

LinearStress StressRecovery::at(Local node, const Eigen::VectorXd& u, const Eigen::VectorXd& t) const
{
  const Patch around = patch(node);
  const auto point = [&](Local k) -> const Point& { return panels_.points[static_cast<std::size_t>(k)]; };
  const Point& origin = point(node);
  double h = 0;
  for (const Local k : around.nodes) h = std::max(h, (point(k) - origin).norm());
  const double nu = material_.poisson_ratio, young = material_.young_modulus, mu = young / (2 * (1 + nu)),
               lambda = 2 * mu * nu / (1 - 2 * nu);

  const Eigen::Index rows = 3 * static_cast<Eigen::Index>(around.nodes.size() + around.panels.size() + 1);
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(rows, 3 * monomials);
  Eigen::VectorXd b = Eigen::VectorXd::Zero(rows);
  Eigen::Index row = 0;
  const Point own = u.segment<3>(3 * node);
  for (const Local k : around.nodes) {
    const Monomials v = values((point(k) - origin) / h);
    for (int m = 0; m < monomials; ++m) a.block<3, 3>(row, 3 * m).diagonal().setConstant(v[m]);
    b.segment<3>(row) = (u.segment<3>(3 * k) - own) / h;
    row += 3;
  }
  for (const std::size_t p : around.panels) {
    const Point middle = (panels_.corner(p, 0) + panels_.corner(p, 1) + panels_.corner(p, 2)) / 3, &n = panels_.normal[p];
    const Slopes g = slopes((middle - origin) / h);
    // sigma n = mu (grad v n + grad v' n) + lambda n div v of v = e_c p_m, whose gradient is e_c grad p_m'
    for (int m = 0; m < monomials; ++m) {
      const Point slope = g.row(m);
      a.block<3, 3>(row, 3 * m) =
          (mu * (slope.dot(n) * Eigen::Matrix3d::Identity() + slope * n.transpose()) + lambda * n * slope.transpose()) / young;
    }
    b.segment<3>(row) = t.segment<3>(3 * static_cast<Eigen::Index>(p)) / young;
    row += 3;
  }
  // mu (second derivatives of v) + (lambda + mu) grad div v
  for (int m = 4; m < monomials; ++m) {
    Eigen::Matrix3d hessian = Eigen::Matrix3d::Zero();
    const int i = m < 7 ? m - 4 : (m == 8 ? 1 : 0), j = m < 7 ? m - 4 : (m == 7 ? 1 : 2);
    hessian(i, j) += 1;
    hessian(j, i) += 1;
    a.block<3, 3>(row, 3 * m) = (mu * hessian.trace() * Eigen::Matrix3d::Identity() + (lambda + mu) * hessian) / young;
  }

  const Eigen::VectorXd c = Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd>(a).solve(b);
  LinearStress result;
  const auto stress = [&](const Slopes& g) -> fem::Stress {
    Eigen::Matrix3d gradient = Eigen::Matrix3d::Zero();
    for (int m = 0; m < monomials; ++m) gradient += c.segment<3>(3 * m) * g.row(m);
    return components(hooke(material_, gradient));
  };
  const Slopes here = slopes(Point::Zero());
  result.constant = stress(here);
  for (int k = 0; k < 3; ++k) result.slope.col(k) = stress(slopes(Point::Unit(k)) - here) / h;
  return result;
}

StressRecovery::Patch StressRecovery::patch(Local node) const
{
  Patch result{{node}, {}};
  for (int ring = 0; ring < 3 && result.nodes.size() < fewest_nodes; ++ring) {
    for (const Local k : result.nodes) {
      const auto& more = around_[static_cast<std::size_t>(k)];
      result.panels.insert(result.panels.end(), more.begin(), more.end());
    }
    std::sort(result.panels.begin(), result.panels.end());
    result.panels.erase(std::unique(result.panels.begin(), result.panels.end()), result.panels.end());
    for (const std::size_t p : result.panels)
      result.nodes.insert(result.nodes.end(), panels_.corners[p].begin(), panels_.corners[p].end());
    std::sort(result.nodes.begin(), result.nodes.end());
    result.nodes.erase(std::unique(result.nodes.begin(), result.nodes.end()), result.nodes.end());
  }
  return result;
}

Eigen::MatrixXd nodal_sums(const Panels& panels, const fem::Material& material, const Eigen::VectorXd& u,
                           const Eigen::VectorXd& t)
{
  const StressRecovery recovery(panels, material);
  Eigen::MatrixXd sums = Eigen::MatrixXd::Zero(panels.node_count(), 7);
  for (std::size_t p = 0; p < panels.corners.size(); ++p)
    for (const Local c : panels.corners[p]) sums(c, 6) += panels.area[p] / 3;
  for (Local n = 0; n < panels.node_count(); ++n) sums.row(n).head<6>() = sums(n, 6) * recovery.at(n, u, t).constant;
  return sums;
}

}  // namespace mortise::bem
