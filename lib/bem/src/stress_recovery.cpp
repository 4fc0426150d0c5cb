#include "bem/stress_recovery.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <numbers>

#include "base/dense.hpp"
#include "bem/surface_stress.hpp"

namespace mortise::bem {

namespace {

// Weights in the fit, of displacements 1: forces, tractions of the largest panel round the node, and second derivatives of the
// wider fit. Chosen by stresses round cavities and at bores, of bodies in one piece and cut (regression/verification/inside.py).
constexpr double weight_of_forces = 4, weight_of_tractions = 0.3, weight_of_wider_fit = 0.1;

// Of degree 2 at most in D dimensions: 1, the coordinates, their products, squares over the root of 2. So the sum of the squares
// of coefficients of one degree is the same in any axes, and the solution of least coefficients.
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

  static double factor(int product) { return product < D ? std::numbers::sqrt2 / 2 : 1; }

  static Monomials values(const Point& s)
  {
    Monomials result;
    result[0] = 1;
    result.template segment<D>(1) = flattened<D>(s);
    for (int k = 0; D + 1 + k < monomials; ++k) result[D + 1 + k] = factor(k) * s[factors(k)[0]] * s[factors(k)[1]];
    return result;
  }

  static Slopes slopes(const Point& s)
  {
    Slopes result = Slopes::Zero();
    for (int i = 0; i < D; ++i) result(1 + i, i) = 1;
    for (int k = 0; D + 1 + k < monomials; ++k) {
      const auto [i, j] = factors(k);
      result(D + 1 + k, i) += factor(k) * s[j];
      result(D + 1 + k, j) += factor(k) * s[i];
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
LinearStress StressRecovery<D>::at(Local node, const SurfaceValues& values) const
{
  using Polynomial = Quadratic<D>;
  const Fit wider = fit(node, values, patch(node, 2), nullptr);
  const auto [c, h] = fit(node, values, patch(node, 1), &wider);
  const auto stress = [&](const typename Polynomial::Slopes& g) -> fem::Stress {
    Eigen::Matrix3d gradient = Eigen::Matrix3d::Zero();
    for (int m = 0; m < Polynomial::monomials; ++m) gradient += lifted<D>(c.template segment<D>(D * m)) * g.row(m);
    return components(hooke(material_, gradient));
  };
  LinearStress result{{}, Eigen::Matrix<double, 6, 3>::Zero()};
  const auto here = Polynomial::slopes(Point::Zero());
  result.constant = stress(here);
  for (int k = 0; k < D; ++k) result.slope.col(k) = stress(Polynomial::slopes(Point::Unit(k)) - here) / h;
  return result;
}

namespace {

// mu (second derivatives of v) + (lambda + mu) grad div v, of the coefficients of v.
template <int D>
Eigen::MatrixXd equilibrium(double mu, double lambda)
{
  using Polynomial = Quadratic<D>;
  using Tensor = Eigen::Matrix<double, D, D>;
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(D, D * Polynomial::monomials);
  for (int m = D + 1; m < Polynomial::monomials; ++m) {
    Tensor hessian = Tensor::Zero();
    const auto [i, j] = Polynomial::factors(m - D - 1);
    hessian(i, j) += Polynomial::factor(m - D - 1);
    hessian(j, i) += Polynomial::factor(m - D - 1);
    result.middleCols<D>(D * m) = mu * hessian.trace() * Tensor::Identity() + (lambda + mu) * hessian;
  }
  return result;
}

}  // namespace

template <int D>
typename StressRecovery<D>::Fit StressRecovery<D>::fit(Local node, const SurfaceValues& values, const Patch& around,
                                                       const Fit* wider) const
{
  using Polynomial = Quadratic<D>;
  constexpr int monomials = Polynomial::monomials;
  using Vector = Eigen::Matrix<double, D, 1>;
  using Tensor = Eigen::Matrix<double, D, D>;
  const auto point = [&](Local k) -> const Point& { return panels_.points[static_cast<std::size_t>(k)]; };
  const Point& origin = point(node);
  double h = 0, largest_area = 0;
  for (const Local k : around.nodes) h = std::max(h, (point(k) - origin).norm());
  for (const std::size_t p : around.panels) largest_area = std::max(largest_area, panels_.area[p]);
  const double nu = material_.poisson_ratio, young = material_.young_modulus, mu = young / (2 * (1 + nu)),
               lambda = 2 * mu * nu / (1 - 2 * nu);

  const Eigen::Index rows = D * static_cast<Eigen::Index>(around.nodes.size() + around.panels.size() + 2 + monomials);
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(rows, D * monomials);
  Eigen::VectorXd b = Eigen::VectorXd::Zero(rows);
  Eigen::Index row = 0;
  const Vector own = values.u.segment<D>(D * node);
  for (const Local k : around.nodes) {
    const auto v = Polynomial::values((point(k) - origin) / h);
    for (int m = 0; m < monomials; ++m) a.block<D, D>(row, D * m).diagonal().setConstant(v[m]);
    b.segment<D>(row) = (values.u.segment<D>(D * k) - own) / h;
    row += D;
  }
  // sigma n = mu (grad v n + grad v' n) + lambda n div v of v = e_c p_m, whose gradient is e_c grad p_m'
  const auto add_traction = [&](const typename Polynomial::Slopes& g, const Vector& n, double weight) {
    for (int m = 0; m < monomials; ++m) {
      const Vector slope = flattened<D>(g.row(m));
      a.block<D, D>(row, D * m) +=
          weight / young * (mu * (slope.dot(n) * Tensor::Identity() + slope * n.transpose()) + lambda * n * slope.transpose());
    }
  };
  for (const std::size_t p : around.panels) {
    const double weight = weight_of_tractions * std::sqrt(panels_.area[p] / largest_area);
    add_traction(Polynomial::slopes((panels_.middle(p) - origin) / h), flattened<D>(panels_.normal[p]), weight);
    b.segment<D>(row) = weight / young * values.t.segment<D>(D * static_cast<Eigen::Index>(p));
    row += D;
  }
  if (values.forces.size() > 0) {
    double area = 0;
    for (const std::size_t p : around_[static_cast<std::size_t>(node)]) area += panels_.area[p] / D;
    const double weight = weight_of_forces / area;
    const auto here = Polynomial::slopes(Point::Zero());
    add_traction(here, values.normals.row(node).head<D>().transpose(), weight);
    for (int k = 0; k < D; ++k)
      add_traction((Polynomial::slopes(Point::Unit(k)) - here) / h, values.normals.row(node).segment<D>(D + D * k).transpose(),
                   weight);
    b.segment<D>(row) = weight / young * values.forces.row(node).transpose();
    row += D;
  }
  a.middleRows<D>(row) = equilibrium<D>(mu, lambda) / young;
  row += D;
  if (wider) {
    const Eigen::Index first = D * (D + 1), count = D * monomials - first;
    a.block(row, first, count, count).diagonal().setConstant(weight_of_wider_fit);
    b.segment(row, count) = weight_of_wider_fit * h / wider->h * wider->coefficients.tail(count);
    row += count;
  }
  return {dense::minimum_norm(a.topRows(row), b.head(row)), h};
}

template <int D>
typename StressRecovery<D>::Patch StressRecovery<D>::patch(Local node, int rings) const
{
  Patch result{{node}, {}};
  for (int ring = 0; ring < rings || (ring < 3 && result.nodes.size() < Quadratic<D>::fewest_nodes); ++ring) {
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
Eigen::MatrixXd nodal_normals(const PanelsIn<D>& panels)
{
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(panels.node_count(), D + D * D);
  for (std::size_t p = 0; p < panels.corners.size(); ++p)
    for (int k = 0; k < D; ++k) {
      // integrals of phi_k and of phi_k x over a panel: area / D, that times the mean of its middle, D times, and its corner
      const Point arm = D * (panels.middle(p) - panels.corner(p, k)) / (D + 1);
      const Eigen::Matrix<double, 1, D> weighted = panels.area[p] / D * flattened<D>(panels.normal[p]).transpose();
      auto row = result.row(panels.corners[p][static_cast<std::size_t>(k)]);
      row.template head<D>() += weighted;
      for (int j = 0; j < D; ++j) row.template segment<D>(D + D * j) += arm[j] * weighted;
    }
  return result;
}
template Eigen::MatrixXd nodal_normals(const PanelsIn<2>&);
template Eigen::MatrixXd nodal_normals(const PanelsIn<3>&);

template <int D>
std::vector<LinearStress> recovered_stresses(const PanelsIn<D>& panels, const fem::Material& material,
                                             const SurfaceValues& values)
{
  const StressRecovery<D> recovery(panels, material);
  std::vector<LinearStress> result;
  for (Local n = 0; n < panels.node_count(); ++n) result.push_back(recovery.at(n, values));
  return result;
}
template std::vector<LinearStress> recovered_stresses(const PanelsIn<2>&, const fem::Material&, const SurfaceValues&);
template std::vector<LinearStress> recovered_stresses(const PanelsIn<3>&, const fem::Material&, const SurfaceValues&);

template <int D>
Eigen::VectorXd nodal_areas(const PanelsIn<D>& panels)
{
  Eigen::VectorXd result = Eigen::VectorXd::Zero(panels.node_count());
  for (std::size_t p = 0; p < panels.corners.size(); ++p)
    for (const Local c : panels.corners[p]) result[c] += panels.area[p] / D;
  return result;
}
template Eigen::VectorXd nodal_areas(const PanelsIn<2>&);
template Eigen::VectorXd nodal_areas(const PanelsIn<3>&);

}  // namespace mortise::bem
