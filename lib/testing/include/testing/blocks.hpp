// Blocks of hexahedra cut by a grid, as tests of the dual problem need them: subdomains, supports, and rows that join two sides
// node by node.
#pragma once

#include <algorithm>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <tuple>

#include "constraint/supports.hpp"
#include "fem/loads.hpp"
#include "fem/stiffness.hpp"
#include "feti/dual_problem.hpp"
#include "testing/cut.hpp"

namespace mortise::feti {

struct Blocks : Quiet {
  partition::Decomposition decomposition;
  std::unique_ptr<partition::NodeDirectory> directory;
  partition::Interface interface;
  SubdomainSystem system;
  std::vector<Eigen::VectorXd> load;  // none yet
  constraint::Constraints constraints;

  struct Counts {
    std::string block;
    std::array<int, 3> counts;
  };
  using Rotation = std::function<std::optional<Eigen::Matrix3d>(const partition::Subdomain&)>;
  // `young`: of the subdomain with that number. `rotation`: of the subdomains that are made as rotated copies.
  Blocks(const std::map<std::string, mesh::BlockOptions>& blocks, const std::vector<Counts>& counts,
         const std::function<double(int)>& young, MPI_Comm mpi = MPI_COMM_WORLD, int subdomains_per_cluster = 1,
         const Rotation& rotation = {})
      : Quiet(mpi)
  {
    mesh::Options mesh;
    for (const auto& [name, block] : blocks) mesh.blocks[name] = block;
    partition::Options options;
    options.method = "grid";
    for (const auto& c : counts) options.counts[c.block] = c.counts;
    options.subdomains_per_cluster = subdomains_per_cluster;
    decomposition = partition::decompose(mesh, options, 3, context);
    Subdomains subdomains;
    for (const auto& s : decomposition.subdomains) {
      const auto rotated = rotation ? rotation(s) : std::nullopt;
      auto original = s.mesh;
      if (rotated)
        for (auto& point : original.points) point = rotated->transpose() * point;
      auto stiffness = fem::stiffness(original, fem::Material{young(static_cast<int>(s.id)), 0.3, 0, 0}, fem::Kinematics::solid);
      system.nodal_stiffness.push_back(nodal_stiffness(stiffness.diagonal(), 3));
      load.emplace_back(Eigen::VectorXd::Zero(stiffness.cols()));
      subdomains.push_back(std::make_shared<ElasticSubdomain>(
          std::move(stiffness), fem::rigid_motions(original.points, fem::Kinematics::solid), original.points, 3, "cholmod"));
      if (rotated) subdomains.back() = std::make_shared<RotatedSubdomain>(subdomains.back(), *rotated, 3);
    }
    directory = std::make_unique<partition::NodeDirectory>(decomposition, system.nodal_stiffness, comm);
    interface = partition::find_interface(decomposition, *directory, comm);
    system.clusters = Clusters(decomposition, interface, subdomains, system.nodal_stiffness, fem::Kinematics::solid);
  }

  // Of the constraints and loads as they are now; this outlives it.
  DualProblem problem(const Options& options = {}, Products products = Products::rounded) const
  {
    return {decomposition, *directory, interface, shared_constraints(), system, load, options, context, {}, {}, products};
  }
  std::shared_ptr<const constraint::Constraints> shared_constraints() const
  {
    return std::make_shared<const constraint::Constraints>(constraints);
  }

  int boundary(const std::string& name) const { return partition::boundary_index(decomposition, name); }
  mesh::Surface side(const std::string& name) const { return partition::side_of(decomposition, name); }

  void add_traction(const std::string& name, const Point& traction)
  {
    for (std::size_t s = 0; s < decomposition.subdomains.size(); ++s)
      fem::add_traction(decomposition.subdomains[s].mesh, boundary(name), fem::Kinematics::solid, traction, load[s]);
  }
  void dirichlet_rows(const std::vector<constraint::Support>& supports)
  {
    std::vector<constraint::SupportNodes> nodes;
    for (const auto& support : supports) {
      const auto surface = side(support.boundary);
      nodes.push_back({surface.node_id, surface.points});
    }
    constraints.prescribed = constraint::dirichlet_rows(supports, nodes, 3, comm);
  }

  struct Node {
    double x, y;
    Global id;
  };
  // All nodes of a side, by their places in its plane: the same order on the sides of a joint.
  std::vector<Node> nodes_of(const std::string& name) const
  {
    const auto surface = side(name);
    std::vector<Node> nodes;
    for (std::size_t i = 0; i < surface.points.size(); ++i)
      nodes.push_back({surface.points[i][0], surface.points[i][1], surface.node_id[i]});
    nodes = comm.all_gather(nodes);
    std::sort(nodes.begin(), nodes.end(), [](const Node& a, const Node& b) { return std::tie(a.x, a.y) < std::tie(b.x, b.y); });
    nodes.erase(std::unique(nodes.begin(), nodes.end(), [](const Node& a, const Node& b) { return a.id == b.id; }), nodes.end());
    return nodes;
  }

  // Normal and tangents of a joint whose secondary side is the upper one.
  static std::vector<Point> frame() { return {Point(0, 0, -1), Point(0.6, 0.8, 0), Point(0.8, -0.6, 0)}; }

  // Rows of one contact, node by node, each of area 1: point i stands on rank i % ranks.
  void join(const std::string& secondary, const std::string& primary, bool bonded, bool tangents = true)
  {
    const auto above = nodes_of(secondary), below = nodes_of(primary);
    auto& contacts = constraints.contacts;
    for (std::size_t i = 0; i < above.size(); ++i) {
      if (static_cast<int>(i) % comm.size() != comm.rank()) continue;
      auto axes = frame();
      if (!tangents) axes.resize(1);
      contacts.nodes.push_back({0, above[i].id, 1, axes[0], {axes.begin() + 1, axes.end()}, contacts.rows.size()});
      contacts.bonded.push_back(bonded);
      for (const auto& axis : axes) {
        for (int c = 0; c < 3; ++c)
          if (axis[c] != 0) {
            contacts.rows.entries.push_back({above[i].id, c, axis[c]});
            contacts.rows.entries.push_back({below[i].id, c, -axis[c]});
          }
        contacts.rows.close(0);
      }
    }
  }
};

}  // namespace mortise::feti
