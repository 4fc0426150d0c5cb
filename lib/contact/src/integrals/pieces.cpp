#include "integrals/pieces.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/dense.hpp"
#include "integrals/covered_basis.hpp"

namespace mortise::contact {

namespace {

Eigen::MatrixXd make_basis(mesh::CellType type)
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

// make(type) of every type of face.
template <class Make>
std::array<Eigen::MatrixXd, mesh::cell_types> table(const Make& make)
{
  using enum mesh::CellType;
  std::array<Eigen::MatrixXd, mesh::cell_types> result;
  for (const auto type : {line2, tri3, quad4, line3, tri6, quad8, quad9}) result[static_cast<std::size_t>(type)] = make(type);
  return result;
}

// Points of a facet closer to dependence than this span no basis, and what a function sees below this part of the facet's cover
// is next to nothing.
constexpr double least_rcond = 1e-6, least_seen_part = 0.02;

double size_of(const Polygon& polygon)
{
  return polygon.size() == 2 ? (polygon[1] - polygon[0]).norm() : area_of(polygon);
}

// Of a facet's node: the next point that is covered; the node itself if it is, to rounding.
Plane covered_point(std::span<const Polygon> common, const Plane& node, double least, double rounding)
{
  Plane best = node;
  double distance = std::numeric_limits<double>::infinity();
  for (const auto& polygon : common) {
    if (size_of(polygon) < least) continue;
    const Plane at = nearest_in(polygon, node);
    if ((at - node).norm() < distance) best = at, distance = (at - node).norm();
  }
  return distance < rounding ? node : best;
}

// The shape functions stay; each belongs to the centre of what it covers.
void keep_shape_functions(PieceIntegrals& piece)
{
  piece.dual = false;
  for (Eigen::Index k = 0; k < piece.covered.size(); ++k)
    if (piece.covered[k] > 0) piece.points.row(k).head(piece.gram.cols()) = piece.gram.row(k) / piece.covered[k];
}

}  // namespace

const Eigen::MatrixXd& multiplier_basis(mesh::CellType type)
{
  static const auto bases = table(make_basis);
  return bases[static_cast<std::size_t>(type)];
}

const Eigen::MatrixXd& control_values(mesh::CellType type)
{
  static const auto inverses =
      table([](mesh::CellType t) -> Eigen::MatrixXd { return dense::inverse(make_basis(t).transpose()); });
  return inverses[static_cast<std::size_t>(type)];
}

namespace {

void transform(const SmallMatrix& change, PieceIntegrals& piece)
{
  piece.covered = FaceShape(change * piece.covered);
  piece.mass = SmallMatrix(change * piece.mass);
  piece.gram = SmallMatrix(change * piece.gram * change.transpose());
  piece.rise = FaceShape(change * piece.rise);
  for (auto& column : piece.opposite) column = FaceShape(change * column);
}

// One function, 1, for what is covered round its point.
void give_all_to(Eigen::Index k, const SmallMatrix& points, PieceIntegrals& piece)
{
  const auto r = piece.covered.size();
  SmallMatrix change = SmallMatrix::Zero(r, r);
  change.row(k).setOnes();
  transform(change, piece);
  piece.points.row(k).head(r) = points.row(k);
  for (Eigen::Index other = 0; other < r; ++other)
    if (other != k) piece.point_facet[static_cast<std::size_t>(other)] = -1;
}

}  // namespace

bool move_to(const SmallMatrix& points, double least, PieceIntegrals& piece)
{
  const auto r = piece.covered.size();
  const auto inverse = dense::inverse(points, least_rcond);
  if (!inverse) return false;
  const SmallMatrix change = inverse->transpose();
  const FaceShape covered = change * piece.covered;
  if (covered.minCoeff() < least * covered.sum()) return false;
  piece.points.leftCols(r) = points;
  transform(change, piece);
  piece.covered = piece.covered.cwiseMax(0);
  if (least <= 0) piece.whole = FaceShape(change * piece.whole).cwiseMax(0);
  return true;
}

void move_into(std::span<const Polygon> common, mesh::CellType type, const Few<Plane, 4>& nodes, const SmallMatrix& given,
               PieceIntegrals& piece)
{
  const auto r = piece.covered.size();
  double largest = 0, length = 0;
  for (const auto& polygon : common) largest = std::max(largest, size_of(polygon));
  for (const auto& node : nodes) length = std::max(length, (node - nodes[0]).norm());
  const Locator locator(type, nodes);
  SmallMatrix points = SmallMatrix::Identity(r, r);
  bool beside = false;  // a node looks past the border
  for (Eigen::Index k = 0; k < r; ++k) {
    const Plane& node = nodes[static_cast<std::size_t>(k)];
    Plane place = Plane::Zero();
    for (Eigen::Index c = 0; c < r; ++c) place += given(k, c) * nodes[static_cast<std::size_t>(c)];
    const Plane at = covered_point(common, node, slit * largest, 1e-9 * length);
    if (at == node || covered_point(common, place, slit * largest, 1e-9 * length) == place)
      points.row(k) = given.row(k);
    else
      points.row(k) = locator(at).head(r).transpose();
    beside = beside || at != node;
  }
  if (move_to(points, beside ? least_seen_part : of_rounding, piece)) return;
  for (Eigen::Index k = 0; k < r; ++k)
    if (beside && given(k, k) != 1 && points.row(k) == given.row(k)) return give_all_to(k, points, piece);
  if (beside) keep_shape_functions(piece);
}

void PieceStore::add(const PieceIntegrals& piece)
{
  shapes_.push_back({piece.facet, piece.dual, !piece.point_facet.empty(), piece.plane.rows() > 0, !piece.corner.empty(),
                     static_cast<int>(piece.mass.rows()), static_cast<int>(piece.mass.cols()), values_.size(), nodes_.size()});
  const auto put = [&](const auto& matrix) { values_.insert(values_.end(), matrix.data(), matrix.data() + matrix.size()); };
  put(piece.mass);
  put(piece.gram);
  if (!piece.point_facet.empty()) put(piece.points);
  put(piece.plane);
  put(piece.covered);
  put(piece.whole);
  put(piece.rise);
  for (const auto& column : piece.opposite) put(column);
  nodes_.insert(nodes_.end(), piece.point_facet.begin(), piece.point_facet.end());
  nodes_.insert(nodes_.end(), piece.corner.begin(), piece.corner.end());
  nodes_.insert(nodes_.end(), piece.beside.begin(), piece.beside.end());
  nodes_.insert(nodes_.end(), piece.nodes.begin(), piece.nodes.end());
}

void PieceStore::add(const View& piece)
{
  shapes_.push_back({piece.facet, piece.dual, !piece.point_facet.empty(), piece.plane.rows() > 0, !piece.corner.empty(),
                     static_cast<int>(piece.mass.rows()), static_cast<int>(piece.mass.cols()), values_.size(), nodes_.size()});
  const auto put = [&](const auto& matrix) { values_.insert(values_.end(), matrix.data(), matrix.data() + matrix.size()); };
  for (const auto& matrix : {piece.mass, piece.gram, piece.points, piece.plane}) put(matrix);
  for (const auto& vector : {piece.covered, piece.whole, piece.rise}) put(vector);
  put(piece.opposite);
  for (const auto& nodes : {piece.point_facet, piece.corner, piece.beside, piece.nodes})
    nodes_.insert(nodes_.end(), nodes.begin(), nodes.end());
}

PieceStore::View PieceStore::operator[](std::size_t i)
{
  const auto& shape = shapes_[i];
  const Eigen::Index r = shape.r, n = shape.n, points = shape.own_points ? r : 0, plane = shape.in_plane ? r : 0;
  const std::size_t end = i + 1 < shapes_.size() ? shapes_[i + 1].first_node : nodes_.size();
  const auto all = std::span<const Local>(nodes_).subspan(shape.first_node, end - shape.first_node);
  const auto corners = static_cast<std::size_t>(shape.corners ? r : 0);
  const auto after_points = all.subspan(static_cast<std::size_t>(points)), nodes = after_points.subspan(2 * corners);
  double* mass = values_.data() + shape.first_value;
  double *gram = mass + r * n, *at = gram + r * r, *in_plane = at + 4 * points, *covered = in_plane + 2 * plane,
         *whole = covered + r, *rise = whole + r;
  return {shape.facet,
          shape.dual,
          all.first(static_cast<std::size_t>(points)),
          after_points.first(corners),
          after_points.subspan(corners, corners),
          Matrix(mass, r, n),
          Matrix(gram, r, r),
          Matrix(at, points, 4),
          Matrix(in_plane, plane, 2),
          Vector(covered, r),
          Vector(whole, r),
          Vector(rise, r),
          nodes,
          Matrix(rise + r, r, static_cast<Eigen::Index>(nodes.size()))};
}

namespace {

using Numbers = Few<Eigen::Index, most_functions>;

// Shares the dropped functions of a face with points in its plane out so that linear fields stay in the basis: to those kept with
// weights b of least squares for which sum b = 1 and sum b_k x_k = x_d. Whether it could: the points that are kept must span the
// plane, and functions must keep positive integrals.
bool keep_linear(const PieceStore::View& piece, const Numbers& keep, const Numbers& drop, SmallMatrix& t)
{
  if (piece.plane.rows() == 0 || keep.size() < 3) return false;
  const auto count = static_cast<Eigen::Index>(keep.size());
  Plane middle = Plane::Zero();
  for (const auto k : keep) middle += piece.plane.row(k).transpose() / static_cast<double>(count);
  Eigen::MatrixXd a(3, count);
  for (Eigen::Index k = 0; k < count; ++k) a.col(k) << 1, piece.plane.row(keep[static_cast<std::size_t>(k)]).transpose() - middle;
  const double size = a.bottomRows(2).colwise().norm().maxCoeff();
  SmallMatrix shared = t;
  for (const auto d : drop) {
    Eigen::Vector3d x;
    x << 1, piece.plane.row(d).transpose() - middle;
    const Eigen::VectorXd b = dense::minimum_norm(a, x);
    if (!((a * b - x).norm() < 1e-9 * (1 + size))) return false;
    shared.col(d) = b;
  }
  if (!((shared * piece.covered).minCoeff() > 0)) return false;
  t = shared;
  return true;
}

}  // namespace

void make_dual(PieceStore::View& piece, std::span<const char> kept)
{
  const auto n = piece.covered.size();
  Numbers keep, drop;
  for (Eigen::Index i = 0; i < n; ++i) {
    if (!piece.point_facet.empty() && piece.point_facet[static_cast<std::size_t>(i)] < 0) continue;  // no function
    (kept[static_cast<std::size_t>(i)] ? keep : drop).push_back(i);
  }
  if (keep.empty() || piece.covered.sum() <= 0) {
    piece.mass.setZero();
    piece.covered.setZero();
    piece.rise.setZero();
    piece.opposite.setZero();
    return;
  }

  // theta~ = T theta.
  const auto count = static_cast<Eigen::Index>(keep.size());
  SmallMatrix t = SmallMatrix::Zero(count, n);
  for (Eigen::Index k = 0; k < count; ++k) {
    t(k, keep[static_cast<std::size_t>(k)]) = 1;
    for (const auto d : drop) t(k, d) = 1.0 / static_cast<double>(count);
  }
  const bool linear = !drop.empty() && keep_linear(piece, keep, drop, t);
  const SmallMatrix products = t * piece.gram;  // integral theta~_k theta_j
  SmallMatrix gram(count, count);
  FaceShape d(count), scale(count);
  for (Eigen::Index k = 0; k < count; ++k) {
    const auto corner = keep[static_cast<std::size_t>(k)];
    gram.col(k) = products.col(corner);
    d[k] = piece.covered[corner];
    // A sliver makes the functions nearly dependent on it; scaled to one size what remains is their true dependence.
    scale[k] = 1 / std::sqrt(std::max(piece.gram(corner, corner), std::numeric_limits<double>::min()));
  }
  if (linear) {
    gram = products * t.transpose();
    d = t * piece.covered;
  }
  SmallMatrix a = SmallMatrix::Identity(count, count);  // too thin for a dual basis of its own: theta~, which keeps the sums
  // Where a cut face's basis has lost linear fields with a function, resultants of dual functions need not lie in what is
  // covered; those of theta~ do.
  if (piece.dual && (piece.point_facet.empty() || drop.empty() || linear))
    if (const auto inverse = dense::inverse(scale.asDiagonal() * gram * scale.asDiagonal(), 1e-9))
      a = d.cwiseProduct(scale).asDiagonal() * *inverse * scale.asDiagonal();

  // psi = all theta, with rows of zeros for the dropped nodes.
  SmallMatrix all = SmallMatrix::Zero(n, n);
  const SmallMatrix rows = a * t;
  FaceShape sums = FaceShape::Zero(n);
  for (Eigen::Index k = 0; k < count; ++k) {
    all.row(keep[static_cast<std::size_t>(k)]) = rows.row(k);
    sums[keep[static_cast<std::size_t>(k)]] = d[k];
  }
  piece.covered = sums;
  piece.mass = SmallMatrix(all * piece.mass);
  piece.rise = FaceShape(all * piece.rise);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < piece.mass.cols(); ++j)
      if (std::abs(piece.mass(i, j)) <= 1e-12 * std::abs(sums[i])) piece.mass(i, j) = 0;
  for (Eigen::Index j = 0; j < piece.opposite.cols(); ++j) piece.opposite.col(j) = FaceShape(-all * piece.opposite.col(j));
}

}  // namespace mortise::contact
