#include "fem/loads.hpp"

#include <cmath>

#include "cell_stress.hpp"
#include "elasticity.hpp"
#include "fem/stiffness.hpp"
#include "geometry.hpp"

namespace mortise::fem {

namespace {

// The rules of the faces integrate shape function times area vector exactly, warped quadrilaterals included; times its length
// exactly on parallelograms; also times a field that is linear in space on flat faces: of tri3, whose own rule has one point,
// that of rings. Calls visit(shape values, area vector of the integration point, nodes).
template <class Visit>
void for_each_point(const mesh::Mesh& mesh, int boundary, Kinematics kinematics, const Visit& visit)
{
  for (std::size_t f = 0; f < mesh.facets.cells.size(); ++f) {
    if (mesh.facets.boundary[f] != boundary) continue;
    const auto nodes = mesh.facets.cells[f];
    const Element& face = element(mesh.facets.cells.type[f], Kinematics::axisymmetric);
    for (std::size_t q = 0; q < face.points(); ++q) {
      Eigen::Matrix<double, 3, 2> tangents = Eigen::Matrix<double, 3, 2>::Zero();  // in 2D the first alone
      double x = 0;
      for (int i = 0; i < face.nodes; ++i) {
        const Point& node = mesh.points[static_cast<std::size_t>(nodes[static_cast<std::size_t>(i)])];
        tangents.leftCols(face.dimension) += node * face.gradient[q].row(i);
        x += face.shape[q][i] * node[0];
      }
      Point normal;
      if (kinematics == Kinematics::solid)
        normal = Point(tangents.col(0)).cross(Point(tangents.col(1)));
      else
        normal = Point(tangents(1, 0), -tangents(0, 0), 0);
      visit(face.shape[q], Point(thickness(kinematics, x) * face.weight[q] * normal), nodes);
    }
  }
}

void add(const Eigen::VectorXd& shape, const Point& force, std::span<const Local> nodes, int dimension, Eigen::VectorXd& f)
{
  for (std::size_t i = 0; i < nodes.size(); ++i)
    f.segment(nodes[i] * dimension, dimension) += shape[static_cast<Eigen::Index>(i)] * force.head(dimension);
}

Point place(const mesh::Mesh& mesh, const Eigen::VectorXd& shape, std::span<const Local> nodes)
{
  Point x = Point::Zero();
  for (std::size_t i = 0; i < nodes.size(); ++i)
    x += shape[static_cast<Eigen::Index>(i)] * mesh.points[static_cast<std::size_t>(nodes[i])];
  return x;
}

}  // namespace

double area(const mesh::Mesh& mesh, int boundary, Kinematics kinematics)
{
  double sum = 0;
  for_each_point(mesh, boundary, kinematics,
                 [&](const Eigen::VectorXd&, const Point& normal, std::span<const Local>) { sum += normal.norm(); });
  return sum;
}

Moments moments(const mesh::Mesh& mesh, int boundary, Kinematics kinematics, const Point& origin)
{
  Moments result;
  for_each_point(mesh, boundary, kinematics,
                 [&](const Eigen::VectorXd& shape, const Point& normal, std::span<const Local> nodes) {
                   const Point x = place(mesh, shape, nodes) - origin;
                   result.area += normal.norm();
                   result.first += normal.norm() * x;
                   result.normal += normal;
                   result.second += normal.norm() * x * x.transpose();
                 });
  return result;
}

void for_each_point_of_boundary(const mesh::Mesh& mesh, int boundary, Kinematics kinematics, const BoundaryVisitor& visit)
{
  for_each_point(mesh, boundary, kinematics, [&](const Eigen::VectorXd& shape, const Point& area, std::span<const Local> nodes) {
    visit(nodes, shape, area);
  });
}

Eigen::MatrixXd nodal_moments(const mesh::Mesh& mesh, int boundary, Kinematics kinematics, const Point& origin)
{
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(4, static_cast<Eigen::Index>(mesh.node_count()));
  for_each_point(mesh, boundary, kinematics,
                 [&](const Eigen::VectorXd& shape, const Point& normal, std::span<const Local> nodes) {
                   const Point x = place(mesh, shape, nodes) - origin;
                   for (std::size_t i = 0; i < nodes.size(); ++i) {
                     const double weight = shape[static_cast<Eigen::Index>(i)] * normal.norm();
                     result.col(nodes[i]) += weight * Eigen::Vector4d(1, x[0], x[1], x[2]);
                   }
                 });
  return result;
}

void add_pressure(const mesh::Mesh& mesh, int boundary, Kinematics kinematics, const ScalarField& pressure, Eigen::VectorXd& f)
{
  for_each_point(mesh, boundary, kinematics,
                 [&](const Eigen::VectorXd& shape, const Point& normal, std::span<const Local> nodes) {
                   add(shape, -pressure(place(mesh, shape, nodes)) * normal, nodes, dimension(kinematics), f);
                 });
}

void add_pressure(const mesh::Mesh& mesh, int boundary, Kinematics kinematics, double pressure, Eigen::VectorXd& f)
{
  add_pressure(
      mesh, boundary, kinematics, [pressure](const Point&) { return pressure; }, f);
}

void add_traction(const mesh::Mesh& mesh, int boundary, Kinematics kinematics, const VectorField& traction, Eigen::VectorXd& f)
{
  for_each_point(mesh, boundary, kinematics,
                 [&](const Eigen::VectorXd& shape, const Point& normal, std::span<const Local> nodes) {
                   add(shape, normal.norm() * traction(place(mesh, shape, nodes)), nodes, dimension(kinematics), f);
                 });
}

void add_traction(const mesh::Mesh& mesh, int boundary, Kinematics kinematics, const Point& traction, Eigen::VectorXd& f)
{
  add_traction(
      mesh, boundary, kinematics, [&traction](const Point&) { return traction; }, f);
}

void add_acceleration(const mesh::Mesh& mesh, Kinematics kinematics, const Materials& materials, const VectorField& acceleration,
                      Eigen::VectorXd& f)
{
  CellGeometry cell(kinematics);
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    cell.gather(mesh, c);
    cell.evaluate();
    const double density = materials[materials.index(c)].density;
    for (std::size_t q = 0; q < cell.volumes().size(); ++q) {
      const auto& shape = cell.element().shape[q];
      add(shape, density * cell.volumes()[q] * acceleration(place(mesh, shape, mesh.cells[c])), mesh.cells[c],
          dimension(kinematics), f);
    }
  }
}

void add_acceleration(const mesh::Mesh& mesh, Kinematics kinematics, const Materials& materials, const Point& acceleration,
                      Eigen::VectorXd& f)
{
  add_acceleration(
      mesh, kinematics, materials, [&acceleration](const Point&) { return acceleration; }, f);
}

namespace {

// What nodes of cells with incompatible modes feel of the modes' expansion. A constant temperature does not push them.
template <class Degrees>
void take_modes(const mesh::Mesh& mesh, const Materials& materials, Kinematics kinematics, const Degrees& degrees,
                Eigen::VectorXd& f)
{
  const int d = dimension(kinematics);
  const auto elasticity = elasticities(materials, kinematics);
  std::vector<CellFormulation> with_modes;
  for (const auto& law : elasticity) with_modes.emplace_back(Formulation::incompatible, law, kinematics);
  std::vector<double> warmer;
  CellGeometry cell(kinematics);
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    cell.gather(mesh, c);
    cell.evaluate();
    degrees(cell, c, warmer);
    const Eigen::VectorXd forces = with_modes[materials.index(c)].forces_of_modes(cell, warmer);
    for (int i = 0; i < cell.element().nodes; ++i)
      f.segment(mesh.cells[c][static_cast<std::size_t>(i)] * d, d) -= forces.segment(i * d, d);
  }
}

}  // namespace

void add_expansion(const mesh::Mesh& mesh, const Materials& materials, Kinematics kinematics,
                   const Temperature& temperature_change, Eigen::VectorXd& f, Formulation formulation)
{
  const int d = dimension(kinematics);
  const auto degrees = [&](const CellGeometry& cell, std::size_t c, std::vector<double>& warmer) {
    cell_temperature(temperature_change, cell, mesh, c, !takes_gradients(mesh.cells.type[c], formulation), warmer);
  };
  if (formulation == Formulation::incompatible && temperature_change.varying) take_modes(mesh, materials, kinematics, degrees, f);
  std::vector<double> warmer;
  CellGeometry cell(kinematics);
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    const auto& material = materials[materials.index(c)];
    if (material.orthotropic) {
      const Elasticity elasticity(material, kinematics);
      cell.gather(mesh, c);
      cell.evaluate();
      degrees(cell, c, warmer);
      for (std::size_t q = 0; q < cell.volumes().size(); ++q) {
        const Point x = place_of(cell, q);
        const Stress stress = warmer[q] * (elasticity.stiffness(x) * elasticity.expansion(x));
        const Eigen::VectorXd forces =
            cell.volumes()[q] *
            (strain_matrix(cell.gradient(q), cell.axisymmetric() ? cell.hoop(q).data() : nullptr).transpose() * stress);
        for (int i = 0; i < cell.element().nodes; ++i)
          f.segment(mesh.cells[c][static_cast<std::size_t>(i)] * d, d) += forces.segment(i * d, d);
      }
      continue;
    }
    const auto [lambda, mu] = lame(material, kinematics);
    // The stress that takes the free strain back: in plane stress lambda allows for the thickness, which stays free.
    const double modulus = ((kinematics == Kinematics::plane_stress ? 2 : 3) * lambda + 2 * mu) * material.thermal_expansion;
    cell.gather(mesh, c);
    cell.evaluate();
    degrees(cell, c, warmer);
    for (std::size_t q = 0; q < cell.volumes().size(); ++q) {
      const double stress = modulus * warmer[q];
      for (int i = 0; i < cell.element().nodes; ++i) {
        const Local node = mesh.cells[c][static_cast<std::size_t>(i)];
        f.segment(node * d, d) += stress * cell.volumes()[q] * cell.gradient(q).row(i).transpose();
        if (cell.axisymmetric()) f[node * d] += stress * cell.volumes()[q] * cell.hoop(q)[i];
      }
    }
  }
}

void add_acceleration(const mesh::Mesh& mesh, Kinematics kinematics, double density, const Point& acceleration,
                      Eigen::VectorXd& f)
{
  Material material;
  material.density = density;
  add_acceleration(mesh, kinematics, material, acceleration, f);
}

}  // namespace mortise::fem
