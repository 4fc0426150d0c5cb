#include "face_integrals.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

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

// Integrals of the shape functions of a triangle or a quadrilateral, projected along its normal.
Eigen::Vector4d whole_of(const FaceGeometry& face)
{
  if (face.type == mesh::CellType::tri3) return face.area() / 3 * Eigen::Vector4d(1, 1, 1, 0);
  // The Jacobian of the map from [-1, 1]^2 is linear, a + b s + c t, and so integral N_i J = a + (b s_i + c t_i) / 3.
  const auto& x = face.nodes;
  const Point normal = face.normal();
  const auto parts = [&](const Point& u, const Point& v) { return u.cross(v).dot(normal); };
  const Point along = 0.25 * (x[1] + x[2] - x[0] - x[3]), up = 0.25 * (x[2] + x[3] - x[0] - x[1]);
  const Point twist = 0.25 * (x[0] - x[1] + x[2] - x[3]);
  const double a = parts(along, up), b = parts(along, twist) / 3, c = parts(twist, up) / 3;
  return {a - b - c, a + b - c, a + b + c, a - b + c};
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
      table([](mesh::CellType t) -> Eigen::MatrixXd { return make_basis(t).transpose().partialPivLu().inverse(); });
  return inverses[static_cast<std::size_t>(type)];
}

Integrator::Integrator(const Side& secondary, const Places& secondary_places, const Side& primary, const Places& primary_places,
                       const Tree& tree, double reach)
    : secondary_(secondary),
      secondary_places_(secondary_places),
      primary_(primary),
      primary_places_(primary_places),
      tree_(tree),
      reach_(reach),
      slot_(primary.points.size(), -1)
{
}

void Integrator::reset(std::size_t face)
{
  const auto n = static_cast<Eigen::Index>(secondary_.faces[face].size());
  result_.mass.setZero(n, n);
  result_.gram.setZero(n, n);
  result_.covered.setZero(n);
  result_.whole.setZero(n);
  result_.rise.setZero(n);
  for (const Local node : result_.nodes) slot_[static_cast<std::size_t>(node)] = -1;
  result_.nodes.clear();
  result_.opposite.clear();
}

// Calls add(weight, shape functions of the face) at the integration points of a whole facet.
template <class Add>
void Integrator::over_facet(std::size_t facet, const Add& add)
{
  const FaceGeometry geometry = secondary_.geometry(facet);
  FaceGeometry mirror = geometry;
  std::reverse(mirror.nodes.begin(), mirror.nodes.end());
  overlap(geometry, mirror, geometry.size(), secondary_.second_order(static_cast<std::size_t>(secondary_.face_of[facet])),
          overlap_);
  for (const auto& point : overlap_.points)
    add(point.weight * secondary_.thickness(facet, point.secondary),
        secondary_.shape_in_face(facet, point.secondary, overlap_.frame, point.at));
}

void Integrator::add_whole(std::size_t facet)
{
  const auto face = static_cast<std::size_t>(secondary_.face_of[facet]);
  const auto type = secondary_.faces.type[face];
  if (!secondary_.second_order(face) && type != mesh::CellType::line2) {
    result_.whole += whole_of(secondary_.geometry(facet)).head(result_.whole.size());
    return;
  }
  FaceShape sum = FaceShape::Zero(result_.whole.size());
  over_facet(facet, [&](double weight, const FaceShape& phi) { sum += weight * phi; });
  result_.whole += multiplier_basis(type) * sum;
}

// Adds the integrals over what two facets have in common: Vector and Matrix have room for the nodes of both faces.
template <class Vector, class Matrix>
void Integrator::add_points(std::size_t facet, std::size_t other, const Bulge& own_bulge, Vector zero, Matrix square,
                            Matrix across)
{
  const auto face = static_cast<std::size_t>(secondary_.face_of[facet]),
             other_face = static_cast<std::size_t>(primary_.face_of[other]);
  const Bulge other_bulge(primary_, primary_places_, other);
  const auto& basis = multiplier_basis(secondary_.faces.type[face]);
  constexpr bool first_order = Vector::SizeAtCompileTime == 4;
  const auto n = result_.covered.size();
  const auto nodes = primary_.faces[other_face];
  Vector covered = zero, rise = zero;
  Matrix mass = square, gram = square;
  for (const auto& point : overlap_.points) {
    const double weight = point.weight * secondary_.thickness(facet, point.secondary);
    const double bulge = own_bulge(point.secondary) + other_bulge(point.primary);
    if constexpr (first_order) {
      const Vector weighted = weight * point.secondary;
      mass.noalias() += weighted * point.secondary.transpose();
      covered += weighted;
      rise += bulge * weighted;
      across.noalias() += weighted * point.primary.transpose();
    } else {
      const FaceShape phi = secondary_.shape_in_face(facet, point.secondary, overlap_.frame, point.at);
      FaceShape theta = phi;
      if (secondary_.second_order(face)) theta.noalias() = basis * phi;
      const FaceShape weighted = weight * theta;
      mass.noalias() += weighted * phi.transpose();
      gram.noalias() += weighted * theta.transpose();
      covered += weighted;
      rise += bulge * weighted;
      across.noalias() += weighted * primary_.shape_in_face(other, point.primary, overlap_.frame, point.at).transpose();
    }
  }
  result_.mass += mass.topLeftCorner(n, n);
  result_.gram += (first_order ? mass : gram).topLeftCorner(n, n);
  result_.covered += covered.head(n);
  result_.rise += rise.head(n);
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    auto& slot = slot_[static_cast<std::size_t>(nodes[k])];
    if (slot < 0) {
      slot = static_cast<Local>(result_.nodes.size());
      result_.nodes.push_back(nodes[k]);
      result_.opposite.emplace_back(FaceShape::Zero(n));
    }
    result_.opposite[static_cast<std::size_t>(slot)] += across.col(static_cast<Eigen::Index>(k)).head(n);
  }
}

void Integrator::add_pair(std::size_t facet, std::size_t other, const Bulge& own_bulge)
{
  const bool second_order = secondary_.second_order(static_cast<std::size_t>(secondary_.face_of[facet]));
  const auto other_face = static_cast<std::size_t>(primary_.face_of[other]);
  if (!overlap(secondary_.geometry(facet), primary_.geometry(other), reach_, second_order || primary_.second_order(other_face),
               overlap_))
    return;
  if (!second_order && !primary_.second_order(other_face))
    return add_points<Eigen::Vector4d, Eigen::Matrix4d>(facet, other, own_bulge, Eigen::Vector4d::Zero(), Eigen::Matrix4d::Zero(),
                                                        Eigen::Matrix4d::Zero());
  const auto n = result_.covered.size(), m = static_cast<Eigen::Index>(primary_.faces[other_face].size());
  add_points<FaceShape, SmallMatrix>(facet, other, own_bulge, FaceShape::Zero(n), SmallMatrix::Zero(n, n),
                                     SmallMatrix::Zero(n, m));
}

const FaceIntegrals& Integrator::integrate(std::size_t face)
{
  reset(face);
  for (auto facet = static_cast<std::size_t>(secondary_.first_facet[face]);
       facet < static_cast<std::size_t>(secondary_.first_facet[face + 1]); ++facet) {
    add_whole(facet);
    const FaceGeometry own = secondary_.geometry(facet);
    const Bulge own_bulge(secondary_, secondary_places_, facet);
    Box box;
    for (const auto& p : own.nodes) box.extend(p);
    const Point margin = Point::Constant(1e-6 * own.size());
    box.min() -= margin;
    box.max() += margin;
    tree_.swept(box, reach_ * own.normal(), met_);
    for (const int other : met_) add_pair(facet, static_cast<std::size_t>(other), own_bulge);
  }
  return result_;
}

const FaceIntegrals& Integrator::integrate_whole(std::size_t face)
{
  reset(face);
  const auto& basis = multiplier_basis(secondary_.faces.type[face]);
  for (auto facet = static_cast<std::size_t>(secondary_.first_facet[face]);
       facet < static_cast<std::size_t>(secondary_.first_facet[face + 1]); ++facet)
    over_facet(facet, [&](double weight, const FaceShape& phi) {
      const FaceShape theta = basis * phi;
      result_.mass += weight * theta * phi.transpose();
      result_.gram += weight * theta * theta.transpose();
      result_.covered += weight * theta;
    });
  result_.whole = result_.covered;
  return result_;
}

void FaceStore::add(const FaceIntegrals& face)
{
  first_value_.push_back(values_.size());
  first_node_.push_back(nodes_.size());
  n_.push_back(static_cast<int>(face.covered.size()));
  const auto put = [&](const auto& matrix) { values_.insert(values_.end(), matrix.data(), matrix.data() + matrix.size()); };
  put(face.mass);
  put(face.gram);
  put(face.covered);
  put(face.whole);
  put(face.rise);
  for (const auto& column : face.opposite) put(column);
  nodes_.insert(nodes_.end(), face.nodes.begin(), face.nodes.end());
}

FaceStore::View FaceStore::operator[](std::size_t i)
{
  const Eigen::Index n = n_[i];
  const std::size_t end = i + 1 < first_node_.size() ? first_node_[i + 1] : nodes_.size();
  const auto nodes = std::span<const Local>(nodes_).subspan(first_node_[i], end - first_node_[i]);
  double* at = values_.data() + first_value_[i];
  double *gram = at + n * n, *covered = gram + n * n, *whole = covered + n, *rise = whole + n, *opposite = rise + n;
  return {Matrix(at, n, n),
          Matrix(gram, n, n),
          Vector(covered, n),
          Vector(whole, n),
          Vector(rise, n),
          nodes,
          Matrix(opposite, n, static_cast<Eigen::Index>(nodes.size()))};
}

void make_dual(FaceStore::View& face, std::span<const char> kept)
{
  const auto n = face.covered.size();
  Few<Eigen::Index, 9> keep, drop;
  for (Eigen::Index i = 0; i < n; ++i) (kept[static_cast<std::size_t>(i)] ? keep : drop).push_back(i);
  if (keep.empty() || face.covered.sum() <= 0) {
    face.mass.setZero();
    face.covered.setZero();
    face.rise.setZero();
    face.opposite.setZero();
    return;
  }

  // theta~ = T theta.
  const auto count = static_cast<Eigen::Index>(keep.size());
  SmallMatrix t = SmallMatrix::Zero(count, n);
  for (Eigen::Index k = 0; k < count; ++k) {
    t(k, keep[static_cast<std::size_t>(k)]) = 1;
    for (const auto d : drop) t(k, d) = 1.0 / static_cast<double>(count);
  }
  const SmallMatrix products = t * face.gram;  // integral theta~_k theta_j
  SmallMatrix gram(count, count);
  FaceShape d(count), scale(count);
  for (Eigen::Index k = 0; k < count; ++k) {
    const auto corner = keep[static_cast<std::size_t>(k)];
    gram.col(k) = products.col(corner);
    d[k] = face.covered[corner];
    // A sliver makes the functions nearly dependent on it; scaled to one size what remains is their true dependence.
    scale[k] = 1 / std::sqrt(std::max(face.gram(corner, corner), std::numeric_limits<double>::min()));
  }
  const Eigen::FullPivLU<SmallMatrix> factor(SmallMatrix(scale.asDiagonal() * gram * scale.asDiagonal()));
  SmallMatrix a = SmallMatrix::Identity(count, count);  // too thin for a dual basis of its own: theta~, which keeps the sums
  if (factor.rcond() > 1e-9) a = d.asDiagonal() * SmallMatrix(scale.asDiagonal() * factor.solve(SmallMatrix(scale.asDiagonal())));

  // psi = all theta, with rows of zeros for the dropped nodes.
  SmallMatrix all = SmallMatrix::Zero(n, n);
  const SmallMatrix rows = a * t;
  FaceShape sums = FaceShape::Zero(n);
  for (Eigen::Index k = 0; k < count; ++k) {
    all.row(keep[static_cast<std::size_t>(k)]) = rows.row(k);
    sums[keep[static_cast<std::size_t>(k)]] = d[k];
  }
  face.covered = sums;
  face.mass = SmallMatrix(all * face.mass);
  face.rise = FaceShape(all * face.rise);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j)
      if (i != j && std::abs(face.mass(i, j)) <= 1e-12 * std::abs(sums[i])) face.mass(i, j) = 0;
  for (Eigen::Index j = 0; j < face.opposite.cols(); ++j) face.opposite.col(j) = FaceShape(-all * face.opposite.col(j));
}

}  // namespace mortise::contact
