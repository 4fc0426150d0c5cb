#include "fem/loads.hpp"

#include <cmath>

#include "geometry.hpp"

namespace mortise::fem {

namespace {

// The rules of the faces integrate shape function times area vector exactly, warped quadrilaterals included; times its length
// exactly on parallelograms. Calls visit(shape values, area vector of the integration point, nodes).
template <class Visit>
void for_each_point(const mesh::Mesh& mesh, int boundary, int dimension, const Visit& visit)
{
  for (std::size_t f = 0; f < mesh.facets.cells.size(); ++f) {
    if (mesh.facets.boundary[f] != boundary) continue;
    const auto nodes = mesh.facets.cells[f];
    const Element& face = element(mesh.facets.cells.type[f]);
    for (std::size_t q = 0; q < face.points(); ++q) {
      Eigen::Matrix<double, 3, 2> tangents = Eigen::Matrix<double, 3, 2>::Zero();  // in 2D the first alone
      for (int i = 0; i < face.nodes; ++i)
        tangents.leftCols(face.dimension) +=
            mesh.points[static_cast<std::size_t>(nodes[static_cast<std::size_t>(i)])] * face.gradient[q].row(i);
      Point normal;
      if (dimension == 3)
        normal = Point(tangents.col(0)).cross(Point(tangents.col(1)));
      else
        normal = Point(tangents(1, 0), -tangents(0, 0), 0);
      visit(face.shape[q], Point(face.weight[q] * normal), nodes);
    }
  }
}

void add(const Eigen::VectorXd& shape, const Point& force, std::span<const Local> nodes, int dimension, Eigen::VectorXd& f)
{
  for (std::size_t i = 0; i < nodes.size(); ++i)
    f.segment(nodes[i] * dimension, dimension) += shape[static_cast<Eigen::Index>(i)] * force.head(dimension);
}

}  // namespace

double area(const mesh::Mesh& mesh, int boundary, int dimension)
{
  double sum = 0;
  for_each_point(mesh, boundary, dimension,
                 [&](const Eigen::VectorXd&, const Point& normal, std::span<const Local>) { sum += normal.norm(); });
  return sum;
}

void add_pressure(const mesh::Mesh& mesh, int boundary, int dimension, double pressure, Eigen::VectorXd& f)
{
  for_each_point(mesh, boundary, dimension, [&](const Eigen::VectorXd& shape, const Point& normal, std::span<const Local> nodes) {
    add(shape, -pressure * normal, nodes, dimension, f);
  });
}

void add_traction(const mesh::Mesh& mesh, int boundary, int dimension, const Point& traction, Eigen::VectorXd& f)
{
  for_each_point(mesh, boundary, dimension, [&](const Eigen::VectorXd& shape, const Point& normal, std::span<const Local> nodes) {
    add(shape, normal.norm() * traction, nodes, dimension, f);
  });
}

void add_acceleration(const mesh::Mesh& mesh, int dimension, double density, const Point& acceleration, Eigen::VectorXd& f)
{
  CellGeometry cell(dimension);
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    cell.gather(mesh, c);
    cell.evaluate();
    for (std::size_t q = 0; q < cell.volumes().size(); ++q)
      add(cell.element().shape[q], density * cell.volumes()[q] * acceleration, mesh.cells[c], dimension, f);
  }
}

}  // namespace mortise::fem
