#include "face_integrals.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace mortise::contact {

namespace {

using Small = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 9, 9>;  // of two faces' nodes, without allocation

// Calls add(weight, shape functions of the face) at the integration points of a whole facet.
template <class Add>
void over_facet(const Side& side, std::size_t facet, const Add& add)
{
  const FaceGeometry geometry = side.geometry(facet);
  FaceGeometry mirror = geometry;
  std::reverse(mirror.nodes.begin(), mirror.nodes.end());
  const auto all = overlap(geometry, mirror, geometry.size(), side.second_order(static_cast<std::size_t>(side.face_of[facet])));
  for (const auto& point : all.points)
    add(point.weight * side.thickness(facet, point.secondary), side.shape_in_face(facet, point.secondary, all.frame, point.at));
}

// Integrals of the face's shape functions over one of its facets.
Eigen::VectorXd whole_facet(const Side& side, std::size_t facet)
{
  Eigen::VectorXd result =
      Eigen::VectorXd::Zero(static_cast<Eigen::Index>(side.faces[static_cast<std::size_t>(side.face_of[facet])].size()));
  over_facet(side, facet, [&](double weight, const FaceShape& phi) { result += weight * phi; });
  return result;
}

}  // namespace

Eigen::MatrixXd multiplier_basis(mesh::CellType type)
{
  const auto n = static_cast<Eigen::Index>(mesh::node_count(type)), corners = static_cast<Eigen::Index>(mesh::corner_count(type));
  Eigen::MatrixXd basis = Eigen::MatrixXd::Identity(n, n);
  if (n == corners) return basis;
  const auto& middles = mesh::middles(type);
  const auto along = [&](Eigen::Index m, int c) {
    const auto& ends = middles[static_cast<std::size_t>(m - corners)];
    return std::find(ends.begin(), ends.end(), c) != ends.end();
  };
  for (Eigen::Index m = corners; m < n; ++m) {
    const auto ends = middles[static_cast<std::size_t>(m - corners)].size();
    basis(m, m) = ends == 2 ? 0.5 : 0.25;
    for (int c = 0; c < static_cast<int>(corners); ++c)
      if (along(m, c)) basis(c, m) = ends == 2 ? 0.25 : 1.0 / 16;
    if (ends == 2) continue;
    for (Eigen::Index e = corners; e < m; ++e) basis(e, m) = 0.125;  // the centre of a quadrilateral, and its four edges
  }
  return basis;
}

std::vector<Point> corner_normals(const Side& side, const Places& places, std::size_t facet)
{
  std::vector<Point> normals;
  for (std::size_t k = 0; k < side.facets[facet].size(); ++k)
    normals.push_back(
        places.all[static_cast<std::size_t>(places.of_corner[static_cast<std::size_t>(side.facets.offset[facet]) + k])].normal);
  return normals;
}

FaceIntegrals integrate(const Side& secondary, const Places& secondary_places, std::size_t face, const Side& primary,
                        const Places& primary_places, const Tree& tree, double reach)
{
  const Eigen::MatrixXd basis = multiplier_basis(secondary.faces.type[face]);
  const auto n = basis.rows();
  const bool second_order = secondary.second_order(face);
  Small mass = Small::Zero(n, n), gram = Small::Zero(n, n);
  FaceShape covered = FaceShape::Zero(n), rise = FaceShape::Zero(n);
  Eigen::VectorXd whole = Eigen::VectorXd::Zero(n);
  std::map<Local, Eigen::VectorXd> opposite;
  for (auto facet = static_cast<std::size_t>(secondary.first_facet[face]);
       facet < static_cast<std::size_t>(secondary.first_facet[face + 1]); ++facet) {
    const FaceGeometry own = secondary.geometry(facet);
    const Bulge own_bulge(own, corner_normals(secondary, secondary_places, facet));
    whole += basis * whole_facet(secondary, facet);
    Box box;
    for (const auto& p : own.nodes) box.extend(p);
    const Point margin = Point::Constant(1e-6 * own.size());
    box.min() -= margin;
    box.max() += margin;
    for (const int met : tree.swept(box, reach * own.normal())) {
      const auto m = static_cast<std::size_t>(met), other_face = static_cast<std::size_t>(primary.face_of[m]);
      const FaceGeometry other = primary.geometry(m);
      const auto common = overlap(own, other, reach, second_order || primary.second_order(other_face));
      if (common.points.empty()) continue;
      const Bulge other_bulge(other, corner_normals(primary, primary_places, m));
      const auto nodes = primary.faces[other_face];
      Small across = Small::Zero(n, static_cast<Eigen::Index>(nodes.size()));
      for (const auto& point : common.points) {
        const double weight = point.weight * secondary.thickness(facet, point.secondary);
        const FaceShape phi = secondary.shape_in_face(facet, point.secondary, common.frame, point.at);
        FaceShape theta = phi;
        if (second_order) theta.noalias() = basis * phi;
        const FaceShape weighted = weight * theta;
        mass.noalias() += weighted * phi.transpose();
        gram.noalias() += weighted * theta.transpose();
        covered += weighted;
        rise += (own_bulge(point.secondary) + other_bulge(point.primary)) * weighted;
        across.noalias() += weighted * primary.shape_in_face(m, point.primary, common.frame, point.at).transpose();
      }
      for (std::size_t k = 0; k < nodes.size(); ++k)
        opposite.try_emplace(nodes[k], Eigen::VectorXd::Zero(n)).first->second += across.col(static_cast<Eigen::Index>(k));
    }
  }
  return {mass, gram, covered, whole, rise, {opposite.begin(), opposite.end()}};
}

FaceIntegrals integrate_whole(const Side& secondary, std::size_t face)
{
  const Eigen::MatrixXd basis = multiplier_basis(secondary.faces.type[face]);
  const auto n = basis.rows();
  FaceIntegrals result{Eigen::MatrixXd::Zero(n, n), Eigen::MatrixXd::Zero(n, n), Eigen::VectorXd::Zero(n),
                       Eigen::VectorXd::Zero(n),    Eigen::VectorXd::Zero(n),    {}};
  for (auto facet = static_cast<std::size_t>(secondary.first_facet[face]);
       facet < static_cast<std::size_t>(secondary.first_facet[face + 1]); ++facet)
    over_facet(secondary, facet, [&](double weight, const FaceShape& phi) {
      const FaceShape theta = basis * phi;
      result.mass += weight * theta * phi.transpose();
      result.gram += weight * theta * theta.transpose();
      result.covered += weight * theta;
    });
  result.whole = result.covered;
  return result;
}

FaceRows dual_rows(const FaceIntegrals& integrals, const std::vector<bool>& kept, std::span<const Local> nodes,
                   std::span<const Local> places)
{
  const auto n = static_cast<Eigen::Index>(nodes.size());
  std::vector<Eigen::Index> keep, drop;
  for (Eigen::Index i = 0; i < n; ++i) (kept[static_cast<std::size_t>(i)] ? keep : drop).push_back(i);
  FaceRows rows{Eigen::VectorXd::Zero(n), Eigen::VectorXd::Zero(n), {}};
  if (keep.empty() || integrals.covered.sum() <= 0) return rows;

  // theta~ = T theta.
  const auto count = static_cast<Eigen::Index>(keep.size());
  Eigen::MatrixXd t = Eigen::MatrixXd::Zero(count, n);
  for (Eigen::Index k = 0; k < count; ++k) {
    t(k, keep[static_cast<std::size_t>(k)]) = 1;
    for (const auto d : drop) t(k, d) = 1.0 / static_cast<double>(count);
  }
  const Eigen::MatrixXd all = t * integrals.mass, products = t * integrals.gram;  // integral theta~_k phi_j, theta~_k theta_j
  Eigen::MatrixXd gram(count, count);
  Eigen::VectorXd d(count), scale(count);
  for (Eigen::Index k = 0; k < count; ++k) {
    const auto corner = keep[static_cast<std::size_t>(k)];
    gram.col(k) = products.col(corner);
    d[k] = integrals.covered[corner];
    // A sliver makes the functions nearly dependent on it; scaled to one size what remains is their true dependence.
    scale[k] = 1 / std::sqrt(std::max(integrals.gram(corner, corner), std::numeric_limits<double>::min()));
  }
  const Eigen::FullPivLU<Eigen::MatrixXd> factor(scale.asDiagonal() * gram * scale.asDiagonal());
  Eigen::MatrixXd a;
  if (factor.rcond() > 1e-9)
    a = d.asDiagonal() * Eigen::MatrixXd(scale.asDiagonal() * factor.solve(Eigen::MatrixXd(scale.asDiagonal())));
  else  // too thin for a dual basis of its own: the shape functions themselves, which keep the sums
    a = Eigen::MatrixXd::Identity(count, count);

  const auto put = [&](Eigen::Index k, Local node, bool primary, double value) {
    if (value != 0)
      rows.terms.push_back({places[static_cast<std::size_t>(keep[static_cast<std::size_t>(k)])], node, primary, value});
  };
  const Eigen::MatrixXd own = a * all;
  const Eigen::VectorXd rise = a * (t * integrals.rise);
  for (Eigen::Index k = 0; k < count; ++k) {
    const auto corner = keep[static_cast<std::size_t>(k)];
    rows.d[corner] = d[k];
    rows.rise[corner] = rise[k];
    for (Eigen::Index j = 0; j < n; ++j)
      if (j == corner || std::abs(own(k, j)) > 1e-12 * std::abs(d[k]))
        put(k, nodes[static_cast<std::size_t>(j)], false, own(k, j));
  }
  for (const auto& [node, integral] : integrals.opposite) {
    const Eigen::VectorXd values = a * (t * integral);
    for (Eigen::Index k = 0; k < count; ++k) put(k, node, true, -values[k]);
  }
  return rows;
}

}  // namespace mortise::contact
