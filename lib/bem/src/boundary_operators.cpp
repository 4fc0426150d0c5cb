#include "bem/boundary_operators.hpp"

#include <numeric>

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

// Of the functions of all panels, three each: the matrix of M_ij = n_j d_i - n_i d_j, and the curl n x grad.
struct Derivatives {
  std::vector<Eigen::Matrix3d> tangential;
  std::vector<Point> curl;
};
Derivatives derivatives(const Panels& panels)
{
  Derivatives result;
  for (std::size_t p = 0; p < panels.corners.size(); ++p)
    for (int k = 0; k < 3; ++k) {
      const Point g = panels.gradient(p, k);
      const Point& n = panels.normal[p];
      result.tangential.push_back(g * n.transpose() - n * g.transpose());
      result.curl.push_back(n.cross(g));
    }
  return result;
}

// result += a (M u): column blocks of a by panel, of result by node.
void add_times_tangential(const Panels& panels, const Derivatives& of, const Eigen::MatrixXd& a, double factor,
                          Eigen::MatrixXd& result)
{
  for (std::size_t p = 0; p < panels.corners.size(); ++p)
    for (int k = 0; k < 3; ++k)
      result.middleCols<3>(3 * panels.corners[p][static_cast<std::size_t>(k)]) +=
          a.middleCols<3>(3 * static_cast<Eigen::Index>(p)) * (factor * of.tangential[3 * p + static_cast<std::size_t>(k)]);
}

// result += (M .)' a: row blocks of a by panel, of result by node.
void add_tangential_times(const Panels& panels, const Derivatives& of, const Eigen::MatrixXd& a, Eigen::MatrixXd& result)
{
  // Column by column, since matrices stand by columns.
  for (Eigen::Index c = 0; c < a.cols(); ++c)
    for (std::size_t p = 0; p < panels.corners.size(); ++p)
      for (int k = 0; k < 3; ++k)
        result.col(c).segment<3>(3 * panels.corners[p][static_cast<std::size_t>(k)]) +=
            of.tangential[3 * p + static_cast<std::size_t>(k)].transpose() *
            a.col(c).segment<3>(3 * static_cast<Eigen::Index>(p));
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
  BoundaryOperators result{std::move(layers.kelvin), {}, {}};

  const auto of = derivatives(panels);

  // V (M u), which K and D need, and with it K = M / 2 + K_L u - V_L (M u) + 2 mu V (M u).
  Eigen::MatrixXd image = Eigen::MatrixXd::Zero(3 * m, 3 * n);
  add_times_tangential(panels, of, result.v, 2 * mu, image);
  result.k = image;
  Eigen::MatrixXd single_image = Eigen::MatrixXd::Zero(3 * m, 3 * n);
  for (Eigen::Index p = 0; p < m; ++p)
    for (int k = 0; k < 3; ++k) {
      const auto& w = of.tangential[static_cast<std::size_t>(3 * p + k)];
      const Eigen::Index node = 3 * panels.corners[static_cast<std::size_t>(p)][static_cast<std::size_t>(k)];
      for (int j = 0; j < 3; ++j)
        for (Eigen::Index q = 0; q < m; ++q) single_image.col(node + j).segment<3>(3 * q) += layers.single(q, p) * w.col(j);
    }
  result.k -= single_image;
  for (Eigen::Index node = 0; node < n; ++node)
    for (Eigen::Index q = 0; q < m; ++q)
      for (int c = 0; c < 3; ++c) result.k(3 * q + c, 3 * node + c) += layers.double_layer(q, node);
  for (Eigen::Index q = 0; q < m; ++q)
    for (std::size_t k = 0; k < 3; ++k)
      for (int c = 0; c < 3; ++c)
        result.k(3 * q + c, 3 * panels.corners[static_cast<std::size_t>(q)][k] + c) +=
            panels.area[static_cast<std::size_t>(q)] / 6;
  make_exact_for_pressure(panels, material, layers.single, result);
  if (which == Operators::of_tractions) return result;

  // (M v)' (2 mu V_L - 4 mu^2 V) (M u)
  image = 2 * mu * single_image - 2 * mu * image;
  result.d = Eigen::MatrixXd::Zero(3 * n, 3 * n);
  add_tangential_times(panels, of, image, result.d);

  // Surface curls c = n x grad, constant on a panel: Y_ij = c_i' V_L c_j, to which mu (tr Y I - Y) belongs.
  std::array<Eigen::MatrixXd, 3> curl_image;
  for (int j = 0; j < 3; ++j) {
    auto& x = curl_image[static_cast<std::size_t>(j)] = Eigen::MatrixXd::Zero(m, n);
    for (std::size_t p = 0; p < panels.corners.size(); ++p)
      for (int k = 0; k < 3; ++k)
        x.col(panels.corners[p][static_cast<std::size_t>(k)]) +=
            of.curl[3 * p + static_cast<std::size_t>(k)][j] * layers.single.col(static_cast<Eigen::Index>(p));
  }
  for (int j = 0; j < 3; ++j)
    for (Eigen::Index b = 0; b < n; ++b) {
      const auto x = curl_image[static_cast<std::size_t>(j)].col(b);
      for (std::size_t p = 0; p < panels.corners.size(); ++p)
        for (int k = 0; k < 3; ++k) {
          const Eigen::Index a = panels.corners[p][static_cast<std::size_t>(k)];
          const Point y = mu * x[static_cast<Eigen::Index>(p)] * of.curl[3 * p + static_cast<std::size_t>(k)];
          for (int i = 0; i < 3; ++i) {
            result.d(3 * a + i, 3 * b + i) += 2 * y[j];
            result.d(3 * a + i, 3 * b + j) -= y[i];
          }
        }
    }
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
