#include "pressure_modes.hpp"

#include <cmath>
#include <map>
#include <numeric>

namespace mortise::bem {

namespace {

// The closed surface that each panel lies on, 0, 1, ..: panels with a common node are on one, since fields that are linear on
// panels and continuous cannot tell two surfaces apart that touch in a node or an edge.
struct Sheets {
  std::vector<int> of_panel;
  int count = 0;
};

Sheets sheets(const Panels& panels)
{
  std::vector<Local> leader(panels.points.size());
  std::iota(leader.begin(), leader.end(), Local{0});
  const auto find = [&](Local node) {
    const auto at = [&](Local n) -> Local& { return leader[static_cast<std::size_t>(n)]; };
    while (at(node) != node) node = at(node) = at(at(node));
    return node;
  };
  for (const auto& corners : panels.corners)
    for (std::size_t k = 1; k < 3; ++k) leader[static_cast<std::size_t>(find(corners[0]))] = find(corners[k]);
  Sheets result;
  std::map<Local, int> number;
  for (const auto& corners : panels.corners)
    result.of_panel.push_back(number.emplace(find(corners[0]), static_cast<int>(number.size())).first->second);
  result.count = static_cast<int>(number.size());
  return result;
}

// D u for one u, 3 n (boundary_operators.hpp).
Eigen::VectorXd hypersingular(const Panels& panels, double mu, const Eigen::MatrixXd& single, const Eigen::MatrixXd& v,
                              const Eigen::VectorXd& u)
{
  const auto m = panels.size();
  Eigen::VectorXd tangential = Eigen::VectorXd::Zero(3 * m);  // M u
  Eigen::MatrixXd curl = Eigen::MatrixXd::Zero(m, 9);         // c_k u_i at 3 k + i
  for (Eigen::Index p = 0; p < m; ++p) {
    const auto panel = static_cast<std::size_t>(p);
    const Point& n = panels.normal[panel];
    for (int corner = 0; corner < 3; ++corner) {
      const Point g = panels.gradient(panel, corner), c = n.cross(g);
      const Point value = u.segment<3>(3 * panels.corners[panel][static_cast<std::size_t>(corner)]);
      tangential.segment<3>(3 * p) += g * n.dot(value) - n * g.dot(value);
      for (int k = 0; k < 3; ++k) curl.row(p).segment<3>(3 * k) += c[k] * value.transpose();
    }
  }
  const Eigen::MatrixXd image = single * curl;
  Eigen::VectorXd moved = -4 * mu * mu * (v * tangential);
  const Eigen::MatrixXd of_panels = tangential.reshaped(3, m);
  const Eigen::MatrixXd smoothed = of_panels * single;  // V_L is symmetric
  moved += 2 * mu * smoothed.reshaped();
  Eigen::VectorXd result = Eigen::VectorXd::Zero(u.size());
  for (Eigen::Index p = 0; p < m; ++p) {
    const auto panel = static_cast<std::size_t>(p);
    const Point& n = panels.normal[panel];
    const double trace = image(p, 0) + image(p, 4) + image(p, 8);
    for (int corner = 0; corner < 3; ++corner) {
      const Point g = panels.gradient(panel, corner), c = n.cross(g);
      const Point w = moved.segment<3>(3 * p);
      Point force = n * g.dot(w) - g * n.dot(w) - mu * trace * c;
      for (int k = 0; k < 3; ++k) force += 2 * mu * c[k] * image.row(p).segment<3>(3 * k).transpose();
      result.segment<3>(3 * panels.corners[panel][static_cast<std::size_t>(corner)]) += force;
    }
  }
  return result;
}

}  // namespace

void make_exact_for_pressure(const Panels& panels, const fem::Material& material, const Eigen::MatrixXd& single,
                             BoundaryOperators& operators)
{
  auto& [v, k, d] = operators;
  const auto m = panels.size(), n = panels.node_count();
  const double mu = material.young_modulus / (2 * (1 + material.poisson_ratio));
  const double pressure = material.young_modulus / (1 - 2 * material.poisson_ratio);
  const auto surfaces = sheets(panels);
  Point low = panels.points.front(), high = low;
  for (const auto& x : panels.points) {
    low = low.cwiseMin(x);
    high = high.cwiseMax(x);
  }
  const Point centre = (low + high) / 2;

  const auto count = surfaces.count;
  Eigen::MatrixXd normals = Eigen::MatrixXd::Zero(3 * m, count), dilations = Eigen::MatrixXd::Zero(3 * n, count),
                  whole = dilations;
  Eigen::MatrixXd shifts = dilations;  // by a unit along x
  for (Eigen::Index p = 0; p < m; ++p) {
    const auto panel = static_cast<std::size_t>(p);
    const int s = surfaces.of_panel[panel];
    normals.col(s).segment<3>(3 * p) = panels.normal[panel];
    for (const Local node : panels.corners[panel]) {
      dilations.col(s).segment<3>(3 * node) = panels.points[static_cast<std::size_t>(node)] - centre;
      shifts(3 * node, s) = 1;
    }
  }
  for (int s = 0; s < count; ++s) whole.col(s) = nodal_forces(panels, normals.col(s));
  const Eigen::VectorXd inverse = normals.colwise().squaredNorm().cwiseInverse().transpose();

  const Eigen::MatrixXd found = k.transpose() * normals;
  Eigen::MatrixXd forces = Eigen::MatrixXd::Zero(3 * n, count);  // that K'n is to be
  for (int s = 0; s < count; ++s) {
    const Eigen::VectorXd of_dilation = hypersingular(panels, mu, single, v, dilations.col(s)) / pressure;
    for (int other = 0; other < count; ++other) {
      const auto all = whole.col(other);
      forces.col(s) += std::round((found.col(s) + of_dilation).dot(all) / all.squaredNorm()) * all;
    }
    forces.col(s) -= of_dilation;
  }
  const Eigen::MatrixXd weighted = normals * inverse.asDiagonal(), short_of = (forces - found).transpose();
  k.noalias() += weighted * short_of;

  Eigen::MatrixXd wanted = k * dilations;  // p V n
  const Eigen::MatrixXd of_shifts = k * shifts;
  for (Eigen::Index p = 0; p < m; ++p) {
    const auto panel = static_cast<std::size_t>(p);
    const Point middle = (panels.corner(panel, 0) + panels.corner(panel, 1) + panels.corner(panel, 2)) / 3 - centre;
    for (int s = 0; s < count; ++s)
      wanted.col(s).segment<3>(3 * p) -= std::round(of_shifts(3 * p, s) / panels.area[panel]) * panels.area[panel] * middle;
  }
  Eigen::MatrixXd left = (wanted / pressure - v * normals) * inverse.asDiagonal();
  const Eigen::MatrixXd both = weighted.transpose() * left;
  const Eigen::MatrixXd shared = (both + both.transpose()) / 4;
  left -= normals * shared;
  v.noalias() += left * normals.transpose();
  v.noalias() += normals * left.transpose();
}

}  // namespace mortise::bem
