#include <algorithm>
#include <numbers>

#include "bem/boundary_operators.hpp"
#include "crossing.hpp"
#include "line_integrals.hpp"

namespace mortise::bem {

namespace {

// Of the box round a surface. Beyond it -ln (r / unit) is positive, and so is V, whatever the surface.
constexpr double sizes_a_unit = 4;

struct Box {
  Point low, high;
};
struct Scaled {
  std::vector<Line> lines;  // lengths over `unit`
  double unit;
};

Box box_round(const PlanePanels& panels)
{
  Box box{panels.points.front(), panels.points.front()};
  for (const auto& x : panels.points) {
    box.low = box.low.cwiseMin(x);
    box.high = box.high.cwiseMax(x);
  }
  return box;
}

Scaled scaled_lines(const PlanePanels& panels)
{
  const auto [low, high] = box_round(panels);
  Scaled result{{}, unit_of_length(panels)};
  const Point middle = (low + high) / 2;
  const auto number = [&](const Point& x) {
    const Point scaled = (x - middle) / result.unit;
    return std::complex<double>(scaled[0], scaled[1]);
  };
  for (std::size_t p = 0; p < panels.corners.size(); ++p)
    result.lines.push_back({number(panels.corner(p, 0)), number(panels.corner(p, 1))});
  return result;
}

// Double integrals of all pairs of panels: II ln (r / unit), II d d' / r^2, and the double layer, m x n, of n_y.d / (2 pi r^2).
struct PlaneLayers {
  Eigen::MatrixXd logarithm;
  std::array<Eigen::MatrixXd, 3> tensor;  // XX YY XY
  Eigen::MatrixXd double_layer;
};

PlaneLayers integrate_plane_layers(const PlanePanels& panels)
{
  const auto [lines, unit] = scaled_lines(panels);
  const auto m = panels.size();
  PlaneLayers layers{Eigen::MatrixXd(m, m), {}, Eigen::MatrixXd::Zero(m, panels.node_count())};
  layers.tensor.fill(Eigen::MatrixXd(m, m));
  const double length = unit / (2 * std::numbers::pi), squared = unit * unit;
  for (Eigen::Index x = 0; x < m; ++x)
    for (Eigen::Index y = x; y < m; ++y) {
      const auto of_x = static_cast<std::size_t>(x), of_y = static_cast<std::size_t>(y);
      const auto pair = integrate(lines[of_x], lines[of_y]);
      layers.logarithm(x, y) = layers.logarithm(y, x) = squared * pair.single;
      for (std::size_t c = 0; c < 3; ++c) layers.tensor[c](x, y) = layers.tensor[c](y, x) = squared * pair.tensor[c];
      for (std::size_t k = 0; k < 2; ++k) {
        layers.double_layer(x, panels.corners[of_y][k]) += length * pair.double_y[k];
        if (y != x) layers.double_layer(y, panels.corners[of_x][k]) += length * pair.double_x[k];
      }
    }
  return layers;
}

// 2 m x 2 m: factor (alone II ln (r / unit) I + II d d' / r^2).
Eigen::MatrixXd combine(const PlaneLayers& layers, double factor, double alone)
{
  const auto m = layers.logarithm.rows();
  Eigen::MatrixXd result(2 * m, 2 * m);
  for (Eigen::Index y = 0; y < m; ++y)
    for (Eigen::Index x = 0; x < m; ++x) {
      const double log = alone * layers.logarithm(x, y);
      auto block = result.block<2, 2>(2 * x, 2 * y);
      block(0, 0) = factor * (log + layers.tensor[0](x, y));
      block(1, 1) = factor * (log + layers.tensor[1](x, y));
      block(0, 1) = block(1, 0) = factor * layers.tensor[2](x, y);
    }
  return result;
}

// a d/ds, from columns of panels to those of nodes: u' is constant on a panel.
Eigen::MatrixXd times_slope(const PlanePanels& panels, const Eigen::MatrixXd& a)
{
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(a.rows(), 2 * panels.node_count());
  for (std::size_t p = 0; p < panels.corners.size(); ++p)
    for (const int k : {0, 1})
      result.middleCols<2>(2 * panels.corners[p][static_cast<std::size_t>(k)]) +=
          (k == 0 ? -1 : 1) / panels.area[p] * a.middleCols<2>(2 * static_cast<Eigen::Index>(p));
  return result;
}

}  // namespace

double unit_of_length(const PlanePanels& panels)
{
  const auto [low, high] = box_round(panels);
  return sizes_a_unit * (high - low).norm();
}

BoundaryOperators boundary_operators(const PlanePanels& panels, const fem::Material& material, Operators which)
{
  const auto layers = integrate_plane_layers(panels);
  require_border(panels, layers.double_layer);
  const auto m = panels.size();
  const double nu = material.poisson_ratio, mu = material.young_modulus / (2 * (1 + nu)), pi = std::numbers::pi;
  BoundaryOperators result{combine(layers, 1 / (8 * pi * mu * (1 - nu)), -(3 - 4 * nu)), {}, {}};

  // M / 2 + K_L u + (2 mu V - V_L) (M u), M u = (-u_2', u_1')
  Eigen::MatrixXd kernel = 2 * mu * result.v;
  for (const Eigen::Index c : {0, 1})
    for (Eigen::Index p = 0; p < m; ++p)
      for (Eigen::Index q = 0; q < m; ++q) kernel(2 * q + c, 2 * p + c) += layers.logarithm(q, p) / (2 * pi);
  for (Eigen::Index p = 0; p < m; ++p) {
    const Eigen::VectorXd first = kernel.col(2 * p);
    kernel.col(2 * p) = kernel.col(2 * p + 1);
    kernel.col(2 * p + 1) = -first;
  }
  result.k = times_slope(panels, kernel);
  for (Eigen::Index n = 0; n < panels.node_count(); ++n)
    for (Eigen::Index q = 0; q < m; ++q)
      for (const Eigen::Index c : {0, 1}) result.k(2 * q + c, 2 * n + c) += layers.double_layer(q, n);
  for (Eigen::Index q = 0; q < m; ++q)
    for (const Local n : panels.corners[static_cast<std::size_t>(q)])
      for (const Eigen::Index c : {0, 1}) result.k(2 * q + c, 2 * n + c) += panels.area[static_cast<std::size_t>(q)] / 4;
  if (which == Operators::of_tractions) return result;

  const Eigen::MatrixXd image = times_slope(panels, combine(layers, mu / (2 * pi * (1 - nu)), -1));
  result.d = times_slope(panels, image.transpose());
  return result;
}

}  // namespace mortise::bem
