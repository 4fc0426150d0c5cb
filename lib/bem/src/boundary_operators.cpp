#include "bem/boundary_operators.hpp"

#include <numeric>

#include "crossing.hpp"
#include "pair_integrals.hpp"
#include "pressure_modes.hpp"

namespace mortise::bem {

namespace {

constexpr std::array<std::array<int, 2>, 6> tensor_places{{{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {0, 2}}};

struct Kelvin {
  double factor, alone;  // U = factor (alone / (4 pi r) I + d d' / (4 pi r^3))
};
Kelvin kelvin(const fem::Material& material)
{
  const double nu = material.poisson_ratio;
  return {(1 + nu) / (2 * material.young_modulus * (1 - nu)), 3 - 4 * nu};
}

// The k-th function of a panel, 1 in a node: M_ij = n_j d_i - n_i d_j = (g n' - n g')_ij, and the surface curl c = n x g.
struct Derivatives {
  std::size_t panel;
  Point g, n, c;

  Eigen::Matrix3d tangential() const { return g * n.transpose() - n * g.transpose(); }
};

// At each node, one for each of its panels.
std::vector<std::vector<Derivatives>> derivatives(const Panels& panels)
{
  std::vector<std::vector<Derivatives>> result(panels.points.size());
  for (std::size_t p = 0; p < panels.corners.size(); ++p)
    for (int k = 0; k < 3; ++k) {
      const Point g = panels.gradient(p, k);
      const Point& n = panels.normal[p];
      result[static_cast<std::size_t>(panels.corners[p][static_cast<std::size_t>(k)])].push_back({p, g, n, n.cross(g)});
    }
  return result;
}

// Of u = 1 in one node, in each of its three components.
struct Images {
  Eigen::Matrix<double, Eigen::Dynamic, 3> single, kelvin;  // V_L (M u), V (M u), 3 m
  Eigen::Matrix<double, 3, Eigen::Dynamic> curl;            // V_L c, m columns

  explicit Images(Eigen::Index m) : single(3 * m, 3), kelvin(3 * m, 3), curl(3, m) {}

  void make(const std::vector<Derivatives>& of, const Eigen::MatrixXd& v_single, const Eigen::MatrixXd& v)
  {
    const auto m = v_single.rows();
    single.setZero();
    kelvin.setZero();
    curl.setZero();
    for (const auto& f : of) {
      const auto p = static_cast<Eigen::Index>(f.panel);
      const Eigen::Matrix3d w = f.tangential();
      kelvin.noalias() += v.middleCols<3>(3 * p) * w;
      for (Eigen::Index q = 0; q < m; ++q) {
        single.middleRows<3>(3 * q) += v_single(q, p) * w;
        curl.col(q) += v_single(q, p) * f.c;
      }
    }
  }
};

// M / 2 + K_L of one node's function, in each component: added to three columns of K.
void add_laplace(const Panels& panels, const std::vector<Derivatives>& of, const Eigen::MatrixXd& double_layer, Eigen::Index node,
                 Eigen::Ref<Eigen::MatrixXd> columns)
{
  for (int c = 0; c < 3; ++c) {
    for (Eigen::Index q = 0; q < double_layer.rows(); ++q) columns(3 * q + c, c) += double_layer(q, node);
    for (const auto& f : of) columns(3 * static_cast<Eigen::Index>(f.panel) + c, c) += panels.area[f.panel] / 6;
  }
}

// (M .)' (2 mu V_L - 4 mu^2 V) (M u) + mu (2 tr Y I - Y): three columns of D.
void add_hypersingular(const std::vector<std::vector<Derivatives>>& functions, double mu, const Images& of,
                       Eigen::Ref<Eigen::MatrixXd> columns)
{
  const Eigen::Matrix<double, Eigen::Dynamic, 3> force = 2 * mu * of.single - 4 * mu * mu * of.kelvin;
  for (std::size_t a = 0; a < functions.size(); ++a) {
    Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
    for (const auto& f : functions[a]) {
      const auto p = static_cast<Eigen::Index>(f.panel);
      const Eigen::Matrix3d own = force.middleRows<3>(3 * p);
      const Point curl = mu * of.curl.col(p);
      sum += f.n * (f.g.transpose() * own) - f.g * (f.n.transpose() * own) - f.c * curl.transpose();
      sum.diagonal().array() += 2 * curl.dot(f.c);
    }
    columns.middleRows<3>(3 * static_cast<Eigen::Index>(a)) += sum;
  }
}

}  // namespace

LayerIntegrals integrate_layers(const Panels& panels, const fem::Material& material, double accuracy)
{
  const auto m = panels.size();
  const auto [factor, alone] = kelvin(material);
  LayerIntegrals layers{Eigen::MatrixXd(m, m), Eigen::MatrixXd(3 * m, 3 * m), Eigen::MatrixXd::Zero(m, panels.node_count())};
  const PairQuadrature quadrature(panels, accuracy);
  std::vector<std::size_t> others(static_cast<std::size_t>(m));
  std::iota(others.begin(), others.end(), 0U);
  std::vector<PairIntegrals> row(others.size());
  for (Eigen::Index x = 0; x < m; ++x) {
    const auto first = static_cast<std::size_t>(x);
    const auto rest = std::span(others).subspan(first);
    quadrature.integrate(first, rest, row);
    for (Eigen::Index y = x; y < m; ++y) {
      const auto& pair = row[static_cast<std::size_t>(y - x)];
      layers.single(y, x) = layers.single(x, y) = pair.single;
      Eigen::Matrix3d u = (factor * alone * pair.single) * Eigen::Matrix3d::Identity();
      for (std::size_t c = 0; c < 6; ++c) {
        const auto [i, j] = tensor_places[c];
        u(i, j) += factor * pair.tensor[c];
        if (i != j) u(j, i) += factor * pair.tensor[c];
      }
      layers.kelvin.block<3, 3>(3 * y, 3 * x) = u;
      layers.kelvin.block<3, 3>(3 * x, 3 * y) = u;
      for (std::size_t k = 0; k < 3; ++k) {
        layers.double_layer(x, panels.corners[static_cast<std::size_t>(y)][k]) += pair.double_y[k];
        if (y != x) layers.double_layer(y, panels.corners[first][k]) += pair.double_x[k];
      }
    }
  }
  return layers;
}

BoundaryOperators boundary_operators(const Panels& panels, const fem::Material& material, double accuracy, Operators which)
{
  auto layers = integrate_layers(panels, material, accuracy);
  const auto m = panels.size(), n = panels.node_count();
  const double mu = material.young_modulus / (2 * (1 + material.poisson_ratio));
  require_border(panels, layers.double_layer);
  const auto functions = derivatives(panels);
  BoundaryOperators result{std::move(layers.kelvin), Eigen::MatrixXd(3 * m, 3 * n), {}};
  if (which == Operators::all) result.d = Eigen::MatrixXd::Zero(3 * n, 3 * n);
  Images images(m);
  for (Eigen::Index node = 0; node < n; ++node) {
    const auto& own = functions[static_cast<std::size_t>(node)];
    images.make(own, layers.single, result.v);
    auto columns = result.k.middleCols<3>(3 * node);
    columns = 2 * mu * images.kelvin - images.single;
    add_laplace(panels, own, layers.double_layer, node, columns);
    if (which == Operators::all) add_hypersingular(functions, mu, images, result.d.middleCols<3>(3 * node));
  }
  make_exact_for_pressure(panels, material, layers.single, result);
  return result;
}

// Integral of the k-th function over a panel is 1 / D of its area.
template <int D>
Eigen::VectorXd nodal_forces(const PanelsIn<D>& panels, const Eigen::VectorXd& t)
{
  Eigen::VectorXd result = Eigen::VectorXd::Zero(D * panels.node_count());
  for (std::size_t p = 0; p < panels.corners.size(); ++p)
    for (const Local node : panels.corners[p])
      result.segment<D>(D * node) += panels.area[p] / D * t.segment<D>(D * static_cast<Eigen::Index>(p));
  return result;
}
template Eigen::VectorXd nodal_forces(const PanelsIn<2>&, const Eigen::VectorXd&);
template Eigen::VectorXd nodal_forces(const PanelsIn<3>&, const Eigen::VectorXd&);

}  // namespace mortise::bem
