#include "post/interior.hpp"

#include <map>

#include "base/error.hpp"
#include "bem/plane_state.hpp"
#include "bem/representation.hpp"
#include "boundary_stress.hpp"
#include "fem/stress.hpp"
#include "mesh/shape_functions.hpp"

namespace mortise::post {

namespace {

// In a subdomain of boundary elements.
template <int D>
Values represent(const ElasticBodies& bodies, const StressField& stress, std::size_t s, std::span<const Point> points)
{
  const auto& constitution = bodies.constitution[s];
  const auto panels = bem::make_panels<D>(bodies.decomposition.subdomains[s].mesh);
  const bem::Representation<D> inside(panels, bem::in_plane(constitution.materials[0], bodies.kinematics));
  const auto& [u, t, recovered] = stress.surface[s];
  auto found = [&] {
    if constexpr (D == 2)
      return inside.evaluate(points, u, t);
    else
      return inside.evaluate(points, u, t, recovered);
  }();
  const auto particular = particular_solution(bodies, s);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    found.displacement.row(row) += particular.displacement(points[i]).transpose();
    found.stress.row(row) += particular.stress(points[i]).transpose();
    if (D == 2)
      found.stress(row, 2) =
          bem::stress_across_plane(constitution, bodies.kinematics, found.stress(row, 0) + found.stress(row, 1));
  }
  return {std::move(found.displacement), std::move(found.stress)};
}

Values represent(const ElasticBodies& bodies, const StressField& stress, std::size_t s, std::span<const Point> points)
{
  return fem::dimension(bodies.kinematics) == 2 ? represent<2>(bodies, stress, s, points)
                                                : represent<3>(bodies, stress, s, points);
}

void take_largest(const Values& values, std::span<const Point> points, int body, Found& largest)
{
  for (std::size_t i = 0; i < points.size(); ++i)
    largest.take(fem::von_mises(values.stress.row(static_cast<Eigen::Index>(i)).transpose()), points[i], body);
}

// In the middle of each cell; `stress` at all nodes.
Eigen::VectorXd von_mises_of_cells(const mesh::Cells& cells, const Eigen::MatrixXd& stress)
{
  Eigen::VectorXd result(static_cast<Eigen::Index>(cells.size()));
  for (std::size_t c = 0; c < cells.size(); ++c) {
    const auto& shape = mesh::shape_functions(cells.type[c]);
    Point middle = Point::Zero();
    for (int k = 0; k < mesh::corner_count(cells.type[c]); ++k) middle += shape.nodes()[static_cast<std::size_t>(k)];
    Eigen::VectorXd weight(shape.count());
    shape.evaluate(middle / mesh::corner_count(cells.type[c]), weight);
    fem::Stress sum = fem::Stress::Zero();
    for (Eigen::Index i = 0; i < weight.size(); ++i)
      sum += weight[i] * stress.row(cells[c][static_cast<std::size_t>(i)]).transpose();
    result[static_cast<Eigen::Index>(c)] = fem::von_mises(sum);
  }
  return result;
}

// In a cell of finite elements.
void interpolate(const ElasticBodies& bodies, const StressField& stress, const Eigen::VectorXd& displacement,
                 const PointInCell& place, Eigen::Index row, Values& values)
{
  const auto& cells = bodies.decomposition.subdomains[place.subdomain].mesh.cells;
  const Eigen::Index d = bodies.decomposition.catalogue.dimension;
  const auto& shape = mesh::shape_functions(cells.type[place.cell]);
  Eigen::VectorXd weight(shape.count());
  shape.evaluate(place.reference, weight);
  const bool mixed = !stress.by_material.empty();
  const auto& nodal = mixed ? stress.by_material[place.subdomain] : stress.nodal[place.subdomain];
  const Eigen::Index first = mixed ? 6 * stress.cell_block[place.subdomain][place.cell] : 0;
  for (Eigen::Index i = 0; i < weight.size(); ++i) {
    const Local node = cells[place.cell][static_cast<std::size_t>(i)];
    values.displacement.row(row).head(d) += weight[i] * displacement.segment(d * node, d).transpose();
    values.stress.row(row) += weight[i] * nodal.row(node).segment(first, 6);
  }
}

// At places of any subdomains of this rank.
Values evaluate(const ElasticBodies& bodies, const StressField& stress, const std::vector<Eigen::VectorXd>& displacement,
                const std::vector<PointInCell>& places, Found& largest)
{
  const auto count = static_cast<Eigen::Index>(places.size());
  Values result{Eigen::MatrixXd::Zero(count, 3), Eigen::MatrixXd::Zero(count, 6)};
  std::map<std::size_t, std::vector<Eigen::Index>> represented;  // of each subdomain of boundary elements
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto& place = places[static_cast<std::size_t>(i)];
    if (bodies.decomposition.subdomains[place.subdomain].skin)
      represented[place.subdomain].push_back(i);
    else
      interpolate(bodies, stress, displacement[place.subdomain], place, i, result);
  }
  for (const auto& [s, rows] : represented) {
    std::vector<Point> points;
    for (const auto row : rows) points.push_back(places[static_cast<std::size_t>(row)].at);
    const auto values = represent(bodies, stress, s, points);
    take_largest(values, points, bodies.decomposition.subdomains[s].body, largest);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      result.displacement.row(rows[i]) = values.displacement.row(static_cast<Eigen::Index>(i));
      result.stress.row(rows[i]) = values.stress.row(static_cast<Eigen::Index>(i));
    }
  }
  return result;
}

// At the nodes inside boundary elements, and in their cells.
void nodes_inside(const ElasticBodies& bodies, const StressField& stress, Interior& result, Found& largest)
{
  const auto& subdomains = bodies.decomposition.subdomains;
  result.nodes.resize(subdomains.size());
  result.cell_von_mises.resize(subdomains.size());
  for (std::size_t s = 0; s < subdomains.size(); ++s) {
    if (!subdomains[s].skin || is_surface_alone(subdomains[s])) continue;
    const auto& inside = subdomains[s].inside;
    const std::span points(inside.points.begin() + static_cast<std::ptrdiff_t>(subdomains[s].mesh.node_count()),
                           inside.points.end());
    auto& values = result.nodes[s] = represent(bodies, stress, s, points);
    take_largest(values, points, subdomains[s].body, largest);
    Eigen::MatrixXd nodal(static_cast<Eigen::Index>(inside.node_count()), 6);
    nodal << stress.nodal[s], values.stress;
    result.cell_von_mises[s] = von_mises_of_cells(inside.cells, nodal);
  }
}

}  // namespace

Interior evaluate_interior(const ElasticBodies& bodies, const Probes& probes, const std::vector<Eigen::VectorXd>& displacement,
                           StressField& stress, const Communicator& comm)
{
  Interior result;
  Found largest = stress.largest_von_mises;
  collectively(comm, [&] {
    if (probes.cells) nodes_inside(bodies, stress, result, largest);
    const auto evaluate_points = [&](const std::vector<PointInBody>& points) {
      std::vector<PointInCell> places;
      for (const auto& point : points) places.push_back(point.place);
      return evaluate(bodies, stress, displacement, places, largest);
    };
    result.points = evaluate_points(probes.points);
    result.sampled = evaluate_points(probes.sampled);
    for (const auto& plane : probes.planes)
      result.planes.push_back(evaluate(bodies, stress, displacement, plane.places, largest));
  });
  stress.largest_von_mises = largest_of_ranks({largest}, comm).front();
  return result;
}

}  // namespace mortise::post
