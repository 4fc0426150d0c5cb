#include "fem/patches.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "cell_stress.hpp"
#include "mesh/face_area.hpp"
#include "mesh/shape_functions.hpp"
#include "tensor.hpp"

namespace mortise::fem {

namespace {

// The monomials of a polynomial in space, by ascending order: 3 or 4 of the first, 6 or 10 of the second.
int term_count(int order, int dimension)
{
  return order == 1 ? 1 + dimension : (dimension == 2 ? 6 : 10);
}

template <int terms>
std::array<double, terms> monomials(const Point& x)
{
  if constexpr (terms == 3) return {1, x[0], x[1]};
  if constexpr (terms == 4) return {1, x[0], x[1], x[2]};
  if constexpr (terms == 6) return {1, x[0], x[1], x[0] * x[0], x[0] * x[1], x[1] * x[1]};
  if constexpr (terms == 10)
    return {1, x[0], x[1], x[2], x[0] * x[0], x[0] * x[1], x[0] * x[2], x[1] * x[1], x[1] * x[2], x[2] * x[2]};
}

// Where the parts of a block of a column of Patches::sums stand: the lower triangle of the normal equations, row by row, their
// right sides, one a term and component, the cells of second order, the area vectors and the sum of their lengths.
template <int terms>
struct Layout {
  static constexpr int right = terms * (terms + 1) / 2, seconds = right + 6 * terms, areas = seconds + 1, width = areas + 4;
};

bool simplex(mesh::CellType type)
{
  return mesh::corner_count(type) == mesh::dimension(type) + 1;
}

// Where the stress of a cell is one order more exact than elsewhere: of first order at its centre, of second order, its linear
// part, at its corners drawn in towards the centre, which of quadrilaterals and hexahedra are two Gauss's points an axis.
struct Samples {
  const Element* element = nullptr;
  Eigen::MatrixXd shape, stress;  // nodes x samples; integration points x samples

  void take(const Element& next, mesh::CellType type)
  {
    if (element == &next) return;
    element = &next;
    const auto& functions = mesh::shape_functions(type);
    const auto& linear = mesh::shape_functions(mesh::first_order(type));
    const auto& corners = linear.nodes();
    const bool single = !mesh::second_order(type);
    const auto count = single ? 1 : linear.count();
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    for (const auto& corner : corners) centre += corner / static_cast<double>(corners.size());
    const double line = 1 / std::sqrt(3.0);
    Eigen::Vector3d drawn = Eigen::Vector3d::Constant(line);
    if (simplex(type))
      drawn.setConstant(element->dimension == 3 ? 1 / std::sqrt(5.0) : 0.5);
    else if (linear.count() == 6)  // a prism
      drawn = {0.5, 0.5, line};
    shape.resize(functions.count(), count);
    Eigen::MatrixXd values(linear.count(), count);
    for (int i = 0; i < count; ++i) {
      const Eigen::Vector3d at =
          single ? centre : Eigen::Vector3d(centre + drawn.cwiseProduct(corners[static_cast<std::size_t>(i)] - centre));
      functions.evaluate(at, shape.col(i));
      linear.evaluate(at, values.col(i));
    }
    stress = element->extrapolation.topRows(linear.count()).transpose() * values;
  }
};

template <int terms>
void add_sample(const Point& from_node, double weight, const double* stress, double* block)
{
  const auto p = monomials<terms>(from_node);
  double* right = block + Layout<terms>::right;
  for (int i = 0; i < terms; ++i) {
    const double w = weight * p[static_cast<std::size_t>(i)];
    for (int j = 0; j <= i; ++j) *block++ += w * p[static_cast<std::size_t>(j)];
    for (int k = 0; k < 6; ++k) *right++ += w * stress[k];
  }
}

template <int terms>
using Polynomial = Eigen::Matrix<double, terms, 6, Eigen::RowMajor>;

// Solves A X = B of a symmetric positive definite A, whose lower triangle is given, in place: A = L L'. Eigen's would take
// seconds of the compiler's time for each of the five sizes.
template <int size>
void solve_positive(Eigen::Matrix<double, size, size>& a, Eigen::Matrix<double, size, 6, Eigen::RowMajor>& b)
{
  for (int j = 0; j < size; ++j) {
    for (int k = 0; k < j; ++k)
      for (int i = j; i < size; ++i) a(i, j) -= a(i, k) * a(j, k);
    const double pivot = 1 / std::sqrt(a(j, j));
    for (int i = j; i < size; ++i) a(i, j) *= pivot;
    for (int k = 0; k < j; ++k) b.row(j) -= a(j, k) * b.row(k);
    b.row(j) *= pivot;
  }
  for (int j = size - 1; j >= 0; --j) {
    for (int k = j + 1; k < size; ++k) b.row(j) -= a(k, j) * b.row(k);
    b.row(j) /= a(j, j);
  }
}

// The one of `size` leading terms that fits best. What the samples do not determine (one row of cells has no slope across) stays
// zero, by `diagonal` of the entries more on the diagonal; a constant is free of it.
template <int terms, int size>
Polynomial<terms> fit(const double* block, double diagonal)
{
  Polynomial<terms> polynomial = Polynomial<terms>::Zero();
  if (!(*block > 0)) return polynomial;
  Eigen::Matrix<double, size, size> normal = Eigen::Matrix<double, size, size>::Zero();
  Eigen::Matrix<double, size, 1> scale;
  const double* entry = block;
  for (int i = 0; i < size; ++i)
    for (int j = 0; j <= i; ++j) normal(i, j) = *entry++;
  for (int i = 0; i < size; ++i) scale[i] = 1 / std::sqrt(std::max(normal(i, i), 1e-300));
  for (int i = 0; i < size; ++i)
    for (int j = 0; j <= i; ++j) normal(i, j) *= scale[i] * scale[j];
  for (int i = 1; i < size; ++i) normal(i, i) += diagonal;
  Eigen::Matrix<double, size, 6, Eigen::RowMajor> right;
  for (int i = 0; i < size; ++i)
    right.row(i) = scale[i] * Eigen::Map<const Polynomial<terms>>(block + Layout<terms>::right).row(i);
  solve_positive<size>(normal, right);
  for (int i = 0; i < size; ++i) polynomial.row(i) = scale[i] * right.row(i);
  return polynomial;
}

template <int terms>
Patches sums_of(const mesh::Mesh& mesh, const Constitution& constitution, Kinematics kinematics, const Eigen::VectorXd& u,
                std::size_t blocks, int order)
{
  using Parts = Layout<terms>;
  Patches patches{order, std::vector<Local>(mesh.node_count(), -1), {}};
  Local corners = 0;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c)
    for (const Local n : mesh.cells[c].first(static_cast<std::size_t>(mesh::corner_count(mesh.cells.type[c]))))
      if (auto& row = patches.row[static_cast<std::size_t>(n)]; row < 0) row = corners++;
  patches.sums = Eigen::MatrixXd::Zero(Parts::width * static_cast<Eigen::Index>(blocks), corners);
  Samples samples;
  Stresses at_samples;
  std::vector<Point> places;
  std::vector<Local> on_face;
  const auto visit = [&](std::size_t c, const CellGeometry& cell, const Stresses& stress, const Elasticity&) {
    const auto type = mesh.cells.type[c];
    samples.take(cell.element(), type);
    at_samples.noalias() = stress.lazyProduct(samples.stress);
    const auto nodes = mesh.cells[c];
    double weight = 0;
    for (const double volume : cell.volumes()) weight += volume / static_cast<double>(at_samples.cols());
    places.assign(static_cast<std::size_t>(at_samples.cols()), Point::Zero());
    for (std::size_t q = 0; q < places.size(); ++q)
      for (std::size_t i = 0; i < nodes.size(); ++i)
        places[q] += samples.shape(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(q)) *
                     mesh.points[static_cast<std::size_t>(nodes[i])];
    const auto block_of = [&](Local n) {
      return patches.sums.col(patches.row[static_cast<std::size_t>(n)]).data() +
             Parts::width * static_cast<Eigen::Index>(constitution.materials.index(c));
    };
    for (const Local n : nodes.first(static_cast<std::size_t>(mesh::corner_count(type)))) {
      double* block = block_of(n);
      for (std::size_t q = 0; q < places.size(); ++q)
        add_sample<terms>(places[q] - mesh.points[static_cast<std::size_t>(n)], weight,
                          at_samples.col(static_cast<Eigen::Index>(q)).data(), block);
      block[Parts::seconds] += mesh::second_order(type);
    }
    for (const auto& face : mesh::faces(type)) {
      on_face.clear();
      for (const int k : face.nodes) on_face.push_back(nodes[static_cast<std::size_t>(k)]);
      const Point area = mesh::area_vector(mesh.points, on_face, face.type);
      const double length = area.norm();
      for (int i = 0; i < mesh::corner_count(face.type); ++i) {
        double* areas = block_of(on_face[static_cast<std::size_t>(i)]) + Parts::areas;
        for (int a = 0; a < 3; ++a) areas[a] += area[a];
        areas[3] += length;
      }
    }
  };
  for_each_cell(mesh, constitution.materials, kinematics, constitution.formulation, constitution.temperature_change, u, visit);
  return patches;
}

// Of x -> mirror x: the monomials at the image are this times those at x.
template <int terms>
Eigen::Matrix<double, terms, terms> mirrored_monomials(const Eigen::Matrix3d& mirror)
{
  constexpr int dimension = terms == 3 || terms == 6 ? 2 : 3;
  Eigen::Matrix<double, terms, terms> result = Eigen::Matrix<double, terms, terms>::Zero();
  result(0, 0) = 1;
  for (int i = 0; i < dimension; ++i)
    for (int k = 0; k < dimension; ++k) result(1 + i, 1 + k) = mirror(i, k);
  if constexpr (terms > 4) {
    int row = 1 + dimension;
    for (int i = 0; i < dimension; ++i)
      for (int j = i; j < dimension; ++j, ++row) {
        int column = 1 + dimension;
        for (int k = 0; k < dimension; ++k)
          for (int l = k; l < dimension; ++l, ++column)
            result(row, column) = mirror(i, k) * mirror(j, l) + (k == l ? 0 : mirror(i, l) * mirror(j, k));
      }
  }
  return result;
}

template <int terms>
void add_image(Patches& patches, Local corner, const Point& normal)
{
  using Parts = Layout<terms>;
  const Eigen::Matrix3d mirror = Eigen::Matrix3d::Identity() - 2 * normal * normal.transpose();
  const auto change = mirrored_monomials<terms>(mirror);
  auto column = patches.sums.col(corner);
  for (double* block = column.data(); block != column.data() + column.size(); block += Parts::width) {
    Eigen::Matrix<double, terms, terms> equations;
    double* entry = block;
    for (int i = 0; i < terms; ++i)
      for (int j = 0; j <= i; ++j) equations(i, j) = equations(j, i) = *entry++;
    const Eigen::Matrix<double, terms, terms> image = change.lazyProduct(equations).lazyProduct(change.transpose());
    entry = block;
    for (int i = 0; i < terms; ++i)
      for (int j = 0; j <= i; ++j) *entry++ += image(i, j);
    Eigen::Map<Polynomial<terms>> right(block + Parts::right);
    Polynomial<terms> stresses = change.lazyProduct(right);
    for (int i = 0; i < terms; ++i) stresses.row(i) = entries(mirror * tensor(stresses.row(i).transpose()) * mirror).transpose();
    right += stresses;
    block[Parts::seconds] *= 2;
    Eigen::Map<Point> area(block + Parts::areas);
    area += Point(mirror * area);
    block[Parts::areas + 3] *= 2;
  }
}

template <int terms>
Eigen::MatrixXd stresses_of(const mesh::Mesh& mesh, const Materials& materials, const Patches& patches, std::size_t blocks)
{
  using Parts = Layout<terms>;
  constexpr double last_resort = 1e-9;  // weight of a patch at the border, of one round a node inside
  constexpr double next_to_nothing = 1e-7;
  // Of the few samples at the border: edges that are slightly curved determine what straight ones do not, by rounding nearly.
  constexpr double little = 1e-3;
  const auto per_corner = static_cast<Eigen::Index>(blocks);
  const auto count = static_cast<std::size_t>(patches.sums.cols() * per_corner);
  std::vector<Polynomial<terms>> polynomial(count);
  std::vector<char> inside(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double* block = patches.sums.data() + i * Parts::width;
    constexpr int linear = terms == 3 || terms == 6 ? 3 : 4;
    const double* areas = block + Parts::areas;
    inside[i] = std::hypot(areas[0], areas[1], areas[2]) <= 1e-6 * areas[3];  // the faces round the node close
    const double diagonal = inside[i] ? next_to_nothing : little;
    polynomial[i] = block[Parts::seconds] > 0 ? fit<terms, terms>(block, diagonal) : fit<terms, linear>(block, diagonal);
  }
  Eigen::MatrixXd sums = Eigen::MatrixXd::Zero(7 * per_corner, static_cast<Eigen::Index>(mesh.node_count()));
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    const auto nodes = mesh.cells[c];
    const auto k = static_cast<Eigen::Index>(materials.index(c));
    const auto type = mesh.cells.type[c];
    const auto corners = nodes.first(static_cast<std::size_t>(mesh::corner_count(type)));
    // One stress a cell tells nothing of how it varies across a layer of such cells, which have it in themselves.
    const double at_border = mesh::second_order(type) || simplex(type) ? last_resort : 0;
    for (const Local n : nodes) {
      double* sum = sums.col(n).data() + 7 * k;
      const auto add = [&](double weight, std::size_t patch, const Point& place) {
        const auto p = monomials<terms>(place);
        for (int i = 0; i < terms; ++i)
          for (int a = 0; a < 6; ++a) sum[a] += weight * p[static_cast<std::size_t>(i)] * polynomial[patch](i, a);
        sum[6] += weight;
      };
      const auto patch_of = [&](Local m) {
        return static_cast<std::size_t>(patches.row[static_cast<std::size_t>(m)] * per_corner + k);
      };
      if (patches.row[static_cast<std::size_t>(n)] >= 0 && inside[patch_of(n)]) {
        const auto& own = polynomial[patch_of(n)];
        for (int a = 0; a < 6; ++a) sum[a] += own(0, a);
        sum[6] += 1;
        continue;
      }
      for (const Local m : corners)
        if (const double weight = inside[patch_of(m)] ? 1 : at_border; weight > 0)
          add(weight, patch_of(m), mesh.points[static_cast<std::size_t>(n)] - mesh.points[static_cast<std::size_t>(m)]);
    }
  }
  return sums.transpose();
}

// Calls with the number of terms as a constant.
template <class Work>
auto for_terms(int terms, const Work& work)
{
  switch (terms) {
    case 3:
      return work(std::integral_constant<int, 3>());
    case 4:
      return work(std::integral_constant<int, 4>());
    case 6:
      return work(std::integral_constant<int, 6>());
    default:
      return work(std::integral_constant<int, 10>());
  }
}

}  // namespace

int largest_order(const mesh::Mesh& mesh)
{
  return std::any_of(mesh.cells.type.begin(), mesh.cells.type.end(), mesh::second_order) ? 2 : 1;
}

Patches patch_sums(const mesh::Mesh& mesh, const Constitution& constitution, Kinematics kinematics, const Eigen::VectorXd& u,
                   std::size_t blocks, int order)
{
  return for_terms(term_count(order, dimension(kinematics)),
                   [&](auto terms) { return sums_of<terms.value>(mesh, constitution, kinematics, u, blocks, order); });
}

void add_mirror_image(Patches& patches, Local corner, const Point& normal, Kinematics kinematics)
{
  const Local row = patches.row[static_cast<std::size_t>(corner)];
  for_terms(term_count(patches.order, dimension(kinematics)), [&](auto terms) { add_image<terms.value>(patches, row, normal); });
}

Eigen::MatrixXd patch_stresses(const mesh::Mesh& mesh, const Materials& materials, Kinematics kinematics, const Patches& patches,
                               std::size_t blocks)
{
  return for_terms(term_count(patches.order, dimension(kinematics)),
                   [&](auto terms) { return stresses_of<terms.value>(mesh, materials, patches, blocks); });
}

}  // namespace mortise::fem
