#include "constraint/springs.hpp"

#include <algorithm>
#include <map>
#include <tuple>

#include "base/error.hpp"
#include "constraint/normals.hpp"
#include "fem/loads.hpp"
#include "points.hpp"

namespace mortise::model {

namespace {

std::array<double, 3> components_of(const Point& x)
{
  return {x[0], x[1], x[2]};
}

// An entry of the matrix on its way to all ranks.
struct SpringPart {
  long long row, column;
  double value;
};

}  // namespace

// Rows, and what is known of their matrix on this rank.
struct Model::SpringMatrix {
  std::vector<constraint::SpringRow> rows;
  std::map<std::pair<std::size_t, std::size_t>, double> parts;  // row, column

  // The rows of one node and its components, of all ranks: each node once, ascending.
  struct PlacedNode {
    Global node;
    std::array<double, 3> at;
  };
};

// Along the axes of the model: A_ij = integral of N_i N_j k, k = k_n n n' + k_t (I - n n') or diag(k_x, k_y, k_z).
void Model::add_foundation(std::size_t support, const Communicator& comm, SpringMatrix& springs) const
{
  using Node = SpringMatrix::PlacedNode;
  const auto& options = deck_.supports[support];
  const auto& stiffness = options.stiffness;
  const int dimension = deck_.dimension();
  const auto [boundary, on_body] = select(options.boundary);
  const auto surface = partition::boundary_surface(decomposition_, boundary, on_body);
  std::vector<Node> nodes;
  for (std::size_t n = 0; n < surface.node_id.size(); ++n)
    nodes.push_back({surface.node_id[n], components_of(surface.points[n])});
  nodes = comm.all_gather(nodes);
  std::sort(nodes.begin(), nodes.end(),
            [](const Node& a, const Node& b) { return std::tie(a.node, a.at) < std::tie(b.node, b.at); });
  nodes.erase(std::unique(nodes.begin(), nodes.end(), [](const Node& a, const Node& b) { return a.node == b.node; }),
              nodes.end());

  std::vector<int> components;
  for (int c = 0; c < dimension; ++c)
    if (stiffness.normal || stiffness.along[static_cast<std::size_t>(c)]) components.push_back(c);
  const std::size_t first = springs.rows.size();
  for (const auto& node : nodes)
    for (const int c : components)
      springs.rows.push_back({{{node.node, c, 1.0}}, static_cast<int>(support), -1, components_of(Point::Unit(c)), node.at});
  const auto row_of = [&](Global node) {
    const auto at = std::lower_bound(nodes.begin(), nodes.end(), node, [](const Node& a, Global id) { return a.node < id; });
    return first + static_cast<std::size_t>(at - nodes.begin()) * components.size();
  };
  for (const auto& subdomain : decomposition_.subdomains) {
    if (!on_body[static_cast<std::size_t>(subdomain.body)]) continue;
    fem::for_each_point_of_boundary(
        subdomain.mesh, boundary, deck_.kinematics,
        [&](std::span<const Local> at, const Eigen::VectorXd& shape, const Point& area) {
          Eigen::Matrix3d k = Eigen::Matrix3d::Zero();
          if (stiffness.normal) {
            const Point normal = area.normalized();
            const Eigen::Matrix3d across = normal * normal.transpose();
            k = *stiffness.normal * across + *stiffness.tangential * (Eigen::Matrix3d::Identity() - across);
          } else {
            for (int c = 0; c < 3; ++c) k(c, c) = stiffness.along[static_cast<std::size_t>(c)].value_or(0);
          }
          k *= area.norm();
          for (std::size_t i = 0; i < at.size(); ++i)
            for (std::size_t j = 0; j < at.size(); ++j) {
              const auto row = row_of(subdomain.mesh.node_id[static_cast<std::size_t>(at[i])]),
                         column = row_of(subdomain.mesh.node_id[static_cast<std::size_t>(at[j])]);
              const double both = shape[static_cast<Eigen::Index>(i)] * shape[static_cast<Eigen::Index>(j)];
              for (std::size_t a = 0; a < components.size(); ++a)
                for (std::size_t b = 0; b < components.size(); ++b)
                  if (const double part = both * k(components[a], components[b]); part != 0)
                    springs.parts[{row + a, column + b}] += part;
            }
        });
  }
}

// Along normals alone, so that nothing is held sideways: the rows of each node are the normals of the faces round it, one where
// the boundary is smooth, and A_ij = integral of N_i N_j k_n n_i . n_j, n_i the normal of node i nearest to that of the face.
void Model::add_foundation_along_normals(std::size_t support, const Communicator& comm, SpringMatrix& springs) const
{
  const auto& options = deck_.supports[support];
  const int dimension = deck_.dimension();
  const auto [boundary, on_body] = select(options.boundary);
  constraint::Support along_normal{options.boundary};
  along_normal.normal = deck::Formula(0);
  const auto surface = partition::boundary_surface(decomposition_, boundary, on_body);
  auto normals = comm.all_gather(constraint::node_normals(std::span(&along_normal, 1), std::span(&surface, 1), comm));
  std::stable_sort(normals.begin(), normals.end(), [](const auto& a, const auto& b) { return a.node < b.node; });

  const std::size_t first = springs.rows.size();
  for (const auto& n : normals) {
    constraint::SpringRow row{{}, static_cast<int>(support), -1, n.direction, n.at};
    for (int c = 0; c < dimension; ++c)
      if (const double part = n.direction[static_cast<std::size_t>(c)]; part != 0) row.entries.push_back({n.node, c, part});
    row.along_normal = true;
    springs.rows.push_back(std::move(row));
  }
  const auto direction = [&](std::size_t i) {
    const auto& d = normals[i].direction;
    return Point(d[0], d[1], d[2]);
  };
  const auto nearest = [&](Global node, const Point& normal) {
    auto i = static_cast<std::size_t>(
        std::lower_bound(normals.begin(), normals.end(), node, [](const auto& n, Global id) { return n.node < id; }) -
        normals.begin());
    std::size_t best = i;
    for (; i < normals.size() && normals[i].node == node; ++i)
      if (direction(i).dot(normal) > direction(best).dot(normal)) best = i;
    return best;
  };
  for (const auto& subdomain : decomposition_.subdomains) {
    if (!on_body[static_cast<std::size_t>(subdomain.body)]) continue;
    fem::for_each_point_of_boundary(subdomain.mesh, boundary, deck_.kinematics,
                                    [&](std::span<const Local> at, const Eigen::VectorXd& shape, const Point& area) {
                                      std::vector<std::size_t> rows;
                                      for (const Local n : at)
                                        rows.push_back(nearest(subdomain.mesh.node_id[static_cast<std::size_t>(n)], area));
                                      for (std::size_t i = 0; i < rows.size(); ++i)
                                        for (std::size_t j = 0; j < rows.size(); ++j)
                                          springs.parts[{first + rows[i], first + rows[j]}] +=
                                              *options.stiffness.normal * area.norm() * shape[static_cast<Eigen::Index>(i)] *
                                              shape[static_cast<Eigen::Index>(j)] * direction(rows[i]).dot(direction(rows[j]));
                                    });
  }
}

constraint::Springs Model::springs(const LoadState& state, const Communicator& comm) const
{
  SpringMatrix found;
  const int dimension = deck_.dimension();
  const auto places = nodes_at_points(comm);
  const auto alone = [&](constraint::SpringRow row, double stiffness) {
    const std::size_t i = found.rows.size();
    found.rows.push_back(std::move(row));
    if (comm.root()) found.parts[{i, i}] = stiffness;
  };
  for (std::size_t i = 0; i < deck_.supports.size(); ++i) {
    const auto& support = deck_.supports[i];
    if (!support.stiffness.any() || !state.acting[i]) continue;
    if (support.points.empty()) {
      if (support.stiffness.normal && !support.stiffness.tangential)
        add_foundation_along_normals(i, comm, found);
      else
        add_foundation(i, comm, found);
      continue;
    }
    for (const auto& node : places.supports[i])
      for (int c = 0; c < dimension; ++c)
        if (const auto& k = support.stiffness.along[static_cast<std::size_t>(c)])
          alone({{{node.node, c, 1.0}}, static_cast<int>(i), -1, components_of(Point::Unit(c)), components_of(node.at)}, *k);
  }
  int number = 0;
  for (const auto& [name, options] : deck_.springs) {
    const auto& ends = places.springs[static_cast<std::size_t>(number)];
    const Point along = (ends[1].at - ends[0].at).normalized();
    constraint::SpringRow row{{}, -1, number++, components_of(along), components_of(ends[0].at)};
    for (int c = 0; c < dimension; ++c)
      if (along[c] != 0) {
        row.entries.push_back({ends[1].node, c, along[c]});
        row.entries.push_back({ends[0].node, c, -along[c]});
      }
    alone(std::move(row), options.stiffness);
  }

  std::vector<SpringPart> parts;
  for (const auto& [at, value] : found.parts)
    parts.push_back({static_cast<long long>(at.first), static_cast<long long>(at.second), value});
  std::vector<Eigen::Triplet<double>> entries;
  for (const auto& part : comm.all_gather(parts))
    entries.emplace_back(static_cast<int>(part.row), static_cast<int>(part.column), part.value);
  constraint::Springs result{std::move(found.rows), {}, {}};
  const auto size = static_cast<Eigen::Index>(result.rows.size());
  result.stiffness.resize(size, size);
  result.stiffness.setFromTriplets(entries.begin(), entries.end());
  return result;
}

}  // namespace mortise::model
