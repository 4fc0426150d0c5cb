#include "face_integrals.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <map>

namespace mortise::contact {

namespace {

Eigen::VectorXd whole_face(const FaceGeometry& face)
{
  FaceGeometry mirror = face;
  std::reverse(mirror.nodes.begin(), mirror.nodes.end());
  Eigen::VectorXd result = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(face.nodes.size()));
  for (const auto& point : overlap(face, mirror, face.size())) result += point.weight * point.secondary.head(result.size());
  return result;
}

}  // namespace

std::vector<Point> corner_normals(const Side& side, const Places& places, std::size_t face)
{
  std::vector<Point> normals;
  for (std::size_t k = 0; k < side.faces[face].size(); ++k)
    normals.push_back(
        places.all[static_cast<std::size_t>(places.of_corner[static_cast<std::size_t>(side.faces.offset[face]) + k])].normal);
  return normals;
}

FaceIntegrals integrate(const Side& secondary, const Places& secondary_places, std::size_t face, const Side& primary,
                        const Places& primary_places, const Tree& tree, double reach)
{
  const auto own_normals = corner_normals(secondary, secondary_places, face);
  const FaceGeometry own = secondary.geometry(face);
  const auto n = static_cast<Eigen::Index>(own.nodes.size());
  FaceIntegrals result{Eigen::MatrixXd::Zero(n, n), Eigen::VectorXd::Zero(n), whole_face(own), Eigen::VectorXd::Zero(n), {}};
  Box box;
  for (const auto& p : own.nodes) box.extend(p);
  const Point margin = Point::Constant(1e-6 * own.size());
  box.min() -= margin;
  box.max() += margin;
  std::map<Local, Eigen::VectorXd> opposite;
  for (const int m : tree.swept(box, reach * own.normal())) {
    const FaceGeometry other = primary.geometry(static_cast<std::size_t>(m));
    const auto nodes = primary.faces[static_cast<std::size_t>(m)];
    const auto other_normals = corner_normals(primary, primary_places, static_cast<std::size_t>(m));
    for (const auto& point : overlap(own, other, reach)) {
      const Eigen::VectorXd phi = point.secondary.head(n);
      result.mass += point.weight * phi * phi.transpose();
      result.covered += point.weight * phi;
      result.rise += point.weight * (bulge(own, own_normals, point.secondary) + bulge(other, other_normals, point.primary)) * phi;
      for (std::size_t k = 0; k < nodes.size(); ++k)
        opposite.try_emplace(nodes[k], Eigen::VectorXd::Zero(n)).first->second +=
            point.weight * point.primary[static_cast<Eigen::Index>(k)] * phi;
    }
  }
  result.opposite.assign(opposite.begin(), opposite.end());
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

  // phi~ = T phi.
  const auto count = static_cast<Eigen::Index>(keep.size());
  Eigen::MatrixXd t = Eigen::MatrixXd::Zero(count, n);
  for (Eigen::Index k = 0; k < count; ++k) {
    t(k, keep[static_cast<std::size_t>(k)]) = 1;
    for (const auto d : drop) t(k, d) = 1.0 / static_cast<double>(count);
  }
  const Eigen::MatrixXd all = t * integrals.mass;  // integral phi~_k phi_j over all j
  Eigen::MatrixXd gram(count, count);
  Eigen::VectorXd d(count);
  for (Eigen::Index k = 0; k < count; ++k) {
    gram.col(k) = all.col(keep[static_cast<std::size_t>(k)]);
    d[k] = integrals.covered[keep[static_cast<std::size_t>(k)]];
  }
  // A sliver makes the shape functions nearly dependent on it; scaled by D what remains is their true dependence.
  const Eigen::VectorXd scale = d.cwiseSqrt().cwiseInverse();
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
      if (j == corner || std::abs(own(k, j)) > 1e-12 * d[k]) put(k, nodes[static_cast<std::size_t>(j)], false, own(k, j));
  }
  for (const auto& [node, integral] : integrals.opposite) {
    const Eigen::VectorXd values = a * (t * integral);
    for (Eigen::Index k = 0; k < count; ++k) put(k, node, true, -values[k]);
  }
  return rows;
}

}  // namespace mortise::contact
