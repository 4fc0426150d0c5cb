#include "bem/stress_recovery.hpp"

#include <Eigen/QR>
#include <algorithm>

#include "base/dense.hpp"
#include "bem/representation.hpp"
#include "bem/surface_stress.hpp"

namespace mortise::bem {

namespace {

// Of degree 2 at most in D dimensions: 1, the coordinates, their products.
template <int D>
struct Quadratic {
  static constexpr int monomials = (D + 1) * (D + 2) / 2;
  static constexpr std::size_t fewest_nodes = D == 3 ? 6 : 5;  // of a patch: else it gets a further ring of panels
  using Monomials = Eigen::Matrix<double, monomials, 1>;
  using Slopes = Eigen::Matrix<double, monomials, 3>;
  /// The coordinates whose products the last monomials are.
  static std::array<int, 2> factors(int product)
  {
    if (product < D) return {product, product};
    return product == D ? std::array{0, 1} : product == D + 1 ? std::array{1, 2} : std::array{0, 2};
  }

  static Monomials values(const Point& s)
  {
    Monomials result;
    result[0] = 1;
    result.template segment<D>(1) = flattened<D>(s);
    for (int k = 0; D + 1 + k < monomials; ++k) result[D + 1 + k] = s[factors(k)[0]] * s[factors(k)[1]];
    return result;
  }

  static Slopes slopes(const Point& s)
  {
    Slopes result = Slopes::Zero();
    for (int i = 0; i < D; ++i) result(1 + i, i) = 1;
    for (int k = 0; D + 1 + k < monomials; ++k) {
      const auto [i, j] = factors(k);
      result(D + 1 + k, i) += s[j];
      result(D + 1 + k, j) += s[i];
    }
    return result;
  }
};

}  // namespace

template <int D>
StressRecovery<D>::StressRecovery(const PanelsIn<D>& panels, const fem::Material& material)
    : panels_(panels), material_(material), around_(panels.points.size())
{
  for (std::size_t p = 0; p < panels.corners.size(); ++p)
    for (const Local c : panels.corners[p]) around_[static_cast<std::size_t>(c)].push_back(p);
}

template <int D>
LinearStress StressRecovery<D>::at(Local node, const Eigen::VectorXd& u, const Eigen::VectorXd& t) const
{
  using Polynomial = Quadratic<D>;
  constexpr int monomials = Polynomial::monomials;
  using Vector = Eigen::Matrix<double, D, 1>;
  using Tensor = Eigen::Matrix<double, D, D>;
  const Patch around = patch(node);
  const auto point = [&](Local k) -> const Point& { return panels_.points[static_cast<std::size_t>(k)]; };
  const Point& origin = point(node);
  double h = 0;
  for (const Local k : around.nodes) h = std::max(h, (point(k) - origin).norm());
  const double nu = material_.poisson_ratio, young = material_.young_modulus, mu = young / (2 * (1 + nu)),
               lambda = 2 * mu * nu / (1 - 2 * nu);

  const Eigen::Index rows = D * static_cast<Eigen::Index>(around.nodes.size() + around.panels.size() + 1);
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(rows, D * monomials);
  Eigen::VectorXd b = Eigen::VectorXd::Zero(rows);
  Eigen::Index row = 0;
  const Vector own = u.segment<D>(D * node);
  for (const Local k : around.nodes) {
    const auto v = Polynomial::values((point(k) - origin) / h);
    for (int m = 0; m < monomials; ++m) a.block<D, D>(row, D * m).diagonal().setConstant(v[m]);
    b.segment<D>(row) = (u.segment<D>(D * k) - own) / h;
    row += D;
  }
  for (const std::size_t p : around.panels) {
    const Vector n = flattened<D>(panels_.normal[p]);
    const auto g = Polynomial::slopes((panels_.middle(p) - origin) / h);
    // sigma n = mu (grad v n + grad v' n) + lambda n div v of v = e_c p_m, whose gradient is e_c grad p_m'
    for (int m = 0; m < monomials; ++m) {
      const Vector slope = flattened<D>(g.row(m));
      a.block<D, D>(row, D * m) =
          (mu * (slope.dot(n) * Tensor::Identity() + slope * n.transpose()) + lambda * n * slope.transpose()) / young;
    }
    b.segment<D>(row) = t.segment<D>(D * static_cast<Eigen::Index>(p)) / young;
    row += D;
  }
  // mu (second derivatives of v) + (lambda + mu) grad div v
  for (int m = D + 1; m < monomials; ++m) {
    Tensor hessian = Tensor::Zero();
    const auto [i, j] = Polynomial::factors(m - D - 1);
    hessian(i, j) += 1;
    hessian(j, i) += 1;
    a.block<D, D>(row, D * m) = (mu * hessian.trace() * Tensor::Identity() + (lambda + mu) * hessian) / young;
  }

  const Eigen::VectorXd c = dense::minimum_norm(a, b);
  LinearStress result{{}, Eigen::Matrix<double, 6, 3>::Zero()};
  const auto stress = [&](const typename Polynomial::Slopes& g) -> fem::Stress {
    Eigen::Matrix3d gradient = Eigen::Matrix3d::Zero();
    for (int m = 0; m < monomials; ++m) gradient += lifted<D>(c.segment<D>(D * m)) * g.row(m);
    return components(hooke(material_, gradient));
  };
  const auto here = Polynomial::slopes(Point::Zero());
  result.constant = stress(here);
  for (int k = 0; k < D; ++k) result.slope.col(k) = stress(Polynomial::slopes(Point::Unit(k)) - here) / h;
  return result;
}

template <int D>
typename StressRecovery<D>::Patch StressRecovery<D>::patch(Local node) const
{
  Patch result{{node}, {}};
  for (int ring = 0; ring < 3 && result.nodes.size() < Quadratic<D>::fewest_nodes; ++ring) {
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

template class StressRecovery<2>;
template class StressRecovery<3>;

template <int D>
Eigen::MatrixXd nodal_sums(const PanelsIn<D>& panels, const fem::Material& material, const Eigen::VectorXd& u,
                           const Eigen::VectorXd& t)
{
  Eigen::MatrixXd sums = Eigen::MatrixXd::Zero(panels.node_count(), 7);
  for (std::size_t p = 0; p < panels.corners.size(); ++p)
    for (const Local c : panels.corners[p]) sums(c, 6) += panels.area[p] / D;
  if constexpr (D == 2) {
    sums.leftCols<6>() = sums.col(6).asDiagonal() * Representation(panels, material).evaluate(panels.points, u, t).stress;
  } else {
    const StressRecovery<D> recovery(panels, material);
    for (Local n = 0; n < panels.node_count(); ++n) sums.row(n).template head<6>() = sums(n, 6) * recovery.at(n, u, t).constant;
  }
  return sums;
}
template Eigen::MatrixXd nodal_sums(const PanelsIn<2>&, const fem::Material&, const Eigen::VectorXd&, const Eigen::VectorXd&);
template Eigen::MatrixXd nodal_sums(const PanelsIn<3>&, const fem::Material&, const Eigen::VectorXd&, const Eigen::VectorXd&);

}  // namespace mortise::bem
