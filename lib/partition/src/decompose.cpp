#include "partition/decompose.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <queue>
#include <set>
#include <tuple>

#include "base/error.hpp"
#include "mesh/blocks.hpp"
#include "mesh/extent.hpp"
#include "mesh/instances.hpp"
#include "mesh/read.hpp"
#include "mesh/topology.hpp"
#include "partition/skin.hpp"
#include "transfer.hpp"

namespace mortise::partition {

namespace {

// How many subdomains each part gets, of which there are `copies`. A total is met as far as copies allow: the next ones go where
// subdomains are largest.
// Surfaces are not cut: they have 0 nodes here.
std::vector<int> subdomain_counts(const std::vector<long long>& nodes, const std::vector<int>& copies, int dimension,
                                  const Options& options)
{
  std::vector<int> counts(nodes.size(), 1);
  if (!options.subdomains) {
    const double aim = options.unknowns_per_subdomain.value_or(usual_size);
    for (std::size_t b = 0; b < nodes.size(); ++b)
      counts[b] = std::max(1, static_cast<int>(std::lround(dimension * static_cast<double>(nodes[b]) / aim)));
    return counts;
  }
  std::priority_queue<std::pair<double, std::size_t>> largest;  // nodes a subdomain, part
  for (std::size_t b = 0; b < nodes.size(); ++b)
    if (nodes[b] > 0) largest.emplace(static_cast<double>(nodes[b]), b);
  for (auto total = std::accumulate(copies.begin(), copies.end(), 0); total < *options.subdomains && !largest.empty();) {
    const auto b = largest.top().second;
    largest.pop();
    if (total + copies[b] > *options.subdomains) continue;
    total += copies[b];
    if (++counts[b] < nodes[b]) largest.emplace(static_cast<double>(nodes[b]) / counts[b], b);  // no more than there can be cells
  }
  return counts;
}

struct Share {
  std::vector<Subdomain> subdomains;
  std::vector<Global> first, clusters;
};

// The subdomains of a part, cluster by cluster.
struct PieceOfPart {
  int cluster;
  std::vector<Local> cells;
};

std::vector<std::vector<PieceOfPart>> cut_parts(const mesh::Mesh& parts, const mesh::Layout& layout, int dimension,
                                                const Options& options)
{
  int count = 0;
  for (const auto& body : layout.bodies) count = std::max(count, body.part + 1);
  std::vector<int> copies(static_cast<std::size_t>(count), 0);
  for (const auto& body : layout.bodies) ++copies[static_cast<std::size_t>(body.part)];
  std::vector<std::vector<Local>> of_part(copies.size());
  for (std::size_t c = 0; c < parts.cells.size(); ++c)
    of_part[static_cast<std::size_t>(parts.cell_body[c])].push_back(static_cast<Local>(c));
  std::vector<mesh::Mesh> pieces;
  std::vector<long long> nodes;
  mesh::Submeshes submeshes(parts);
  for (const auto& list : of_part) {
    pieces.push_back(submeshes(list));
    const bool surface = !list.empty() && mesh::dimension(pieces.back().cells.type[0]) < dimension;
    nodes.push_back(surface ? 0 : static_cast<long long>(pieces.back().node_count()));
  }
  const auto counts = subdomain_counts(nodes, copies, dimension, options);
  std::vector<std::vector<PieceOfPart>> result(copies.size());
  mesh::Cells before;  // of the part before this one: rollers in a row have one mesh, and are cut alike
  std::vector<int> label;
  for (std::size_t p = 0; p < copies.size(); ++p) {
    if (nodes[p] == 0)
      label.assign(of_part[p].size(), 0);
    else if (p == 0 || nodes[p - 1] == 0 || counts[p] != counts[p - 1] || pieces[p].cells != before)
      label = cut(pieces[p].cells, counts[p]);
    auto& list = result[p];
    list.resize(static_cast<std::size_t>(label.empty() ? 0 : 1 + *std::max_element(label.begin(), label.end())));
    for (std::size_t c = 0; c < label.size(); ++c) list[static_cast<std::size_t>(label[c])].cells.push_back(of_part[p][c]);
    for (std::size_t s = 0; s < list.size(); ++s) list[s].cluster = static_cast<int>(s);
    if (options.subdomains_per_cluster > 1) {
      const auto clusters = cluster(pieces[p].cells, label, options.subdomains_per_cluster);
      for (std::size_t s = 0; s < list.size(); ++s) list[s].cluster = clusters[s];
      std::stable_sort(list.begin(), list.end(),
                       [](const PieceOfPart& a, const PieceOfPart& b) { return a.cluster < b.cluster; });
    }
    before = std::move(pieces[p].cells);
    pieces[p] = {};
  }
  return result;
}

// Rank 0 cuts the mesh of the parts, once each, and sends each rank its subdomains of their copies; the others pass an empty
// mesh.
Share distribute(const mesh::Mesh& parts, const mesh::Layout& layout, int dimension, const Options& options,
                 const Communicator& comm)
{
  std::vector<std::vector<PieceOfPart>> of_part;
  struct Piece {
    int body;
    std::size_t number;  // among those of the part
  };
  std::vector<Piece> pieces;
  std::vector<long long> weight;
  Share share;
  const auto part_of = [&](int body) { return static_cast<std::size_t>(layout.bodies[static_cast<std::size_t>(body)].part); };
  collectively(comm, [&] {
    if (!comm.root()) return;
    of_part = cut_parts(parts, layout, dimension, options);
    for (int b = 0; b < static_cast<int>(layout.bodies.size()); ++b) {
      const auto& list = of_part[part_of(b)];
      for (std::size_t i = 0; i < list.size(); ++i) {
        if (i == 0 || list[i].cluster != list[i - 1].cluster) share.clusters.push_back(static_cast<Global>(pieces.size()));
        pieces.push_back({b, i});
        weight.push_back(static_cast<long long>(list[i].cells.size()));
      }
    }
    share.clusters.push_back(static_cast<Global>(pieces.size()));
  });
  comm.broadcast(weight);
  comm.broadcast(share.clusters);
  share.first = deal(weight, share.clusters, comm.size());
  mesh::Submeshes submeshes(parts);
  for (int rank = 0; rank < comm.size(); ++rank) {  // one rank after the other, so that rank 0 holds one copy at a time
    std::vector<std::vector<char>> send(static_cast<std::size_t>(comm.size()));
    if (comm.root())
      for (Global s = share.first[static_cast<std::size_t>(rank)]; s < share.first[static_cast<std::size_t>(rank) + 1]; ++s) {
        const auto& [body, number] = pieces[static_cast<std::size_t>(s)];
        auto piece = submeshes(of_part[part_of(body)][number].cells);
        pack({s, body, mesh::instantiate(std::move(piece), layout.bodies[static_cast<std::size_t>(body)], body)},
             send[static_cast<std::size_t>(rank)]);
      }
    const auto received = comm.exchange(send);
    if (rank == comm.rank()) share.subdomains = unpack(received[0]);
  }
  return share;
}

// Grid indices where the i-th of `parts` pieces of `cells` cells begins.
int grid_start(int cells, int parts, int i)
{
  return static_cast<int>(static_cast<long long>(cells) * i / parts);
}

// Clusters of about `size` subdomains along each axis of a grid, as near to cubes as the grid allows.
std::array<int, 3> clusters_an_axis(const std::array<int, 3>& parts, int size)
{
  std::array<int, 3> order{0, 1, 2}, clusters{};
  std::sort(order.begin(), order.end(), [&](int a, int b) { return std::pair(parts[a], a) < std::pair(parts[b], b); });
  double left = size;  // subdomains of a cluster in the axes that follow: where one is short the others make up for it
  for (int i = 0; i < 3; ++i) {
    const int count = parts[order[i]];
    const double length = std::min(std::pow(left, 1.0 / (3 - i)), static_cast<double>(count));
    clusters[order[i]] = std::max(1, static_cast<int>(std::lround(count / length)));
    left = std::max(1.0, left * clusters[order[i]] / count);
  }
  return clusters;
}

Share generate_grid(const mesh::Options& mesh, const Options& options, int dimension, const mesh::Layout& layout,
                    const Communicator& comm)
{
  struct Box {
    int body;
    long long cluster;
    std::array<int, 3> first, last;
    long long cells() const { return static_cast<long long>(last[0] - first[0]) * (last[1] - first[1]) * (last[2] - first[2]); }
  };
  std::vector<Box> boxes;
  for (int b = 0; b < static_cast<int>(layout.bodies.size()); ++b) {
    const auto grid = mesh::grid_of(mesh, dimension, layout.bodies[static_cast<std::size_t>(b)].part);
    auto parts = options.counts.at(layout.catalogue.bodies[static_cast<std::size_t>(b)].group);
    if (dimension == 2) parts[2] = 1;
    const auto clusters = clusters_an_axis(parts, options.subdomains_per_cluster);
    for (int k = 0; k < parts[2]; ++k)
      for (int j = 0; j < parts[1]; ++j)
        for (int i = 0; i < parts[0]; ++i) {
          const std::array<int, 3> at{i, j, k};
          Box box{b, 0, {}, {}};
          for (std::size_t c = 3; c-- > 0;) {
            box.first[c] = grid_start(grid[c], parts[c], at[c]);
            box.last[c] = grid_start(grid[c], parts[c], at[c] + 1);
            const auto along = ((at[c] + 1LL) * clusters[c] - 1) / parts[c];  // the last that begins at or before this one
            box.cluster = box.cluster * clusters[c] + along;
          }
          boxes.push_back(box);
        }
  }
  std::stable_sort(boxes.begin(), boxes.end(),
                   [](const Box& a, const Box& b) { return std::tie(a.body, a.cluster) < std::tie(b.body, b.cluster); });
  Share share;
  std::vector<long long> weight;
  for (std::size_t s = 0; s < boxes.size(); ++s) {
    if (s == 0 || boxes[s].body != boxes[s - 1].body || boxes[s].cluster != boxes[s - 1].cluster)
      share.clusters.push_back(static_cast<Global>(s));
    weight.push_back(boxes[s].cells());
  }
  share.clusters.push_back(static_cast<Global>(boxes.size()));
  share.first = deal(weight, share.clusters, comm.size());
  const auto rank = static_cast<std::size_t>(comm.rank());
  for (Global s = share.first[rank]; s < share.first[rank + 1]; ++s) {
    const auto& box = boxes[static_cast<std::size_t>(s)];
    const auto& instance = layout.bodies[static_cast<std::size_t>(box.body)];
    auto piece = mesh::generate(mesh, dimension, instance.part, box.first, box.last);
    share.subdomains.push_back({s, box.body, mesh::instantiate(std::move(piece), instance, box.body)});
  }
  return share;
}

// All blocks as one mesh.
mesh::Mesh generate_whole(const mesh::Options& options, int dimension, const mesh::Catalogue& catalogue)
{
  mesh::Mesh whole;
  const auto append = [](mesh::Cells& to, const mesh::Cells& from, Local base) {
    for (std::size_t c = 0; c < from.size(); ++c) {
      std::vector<Local> nodes(from[c].begin(), from[c].end());
      for (auto& n : nodes) n += base;
      to.add(from.type[c], nodes);
    }
  };
  for (int b = 0; b < static_cast<int>(catalogue.bodies.size()); ++b) {
    const auto piece = mesh::generate(options, dimension, b, {0, 0, 0}, mesh::grid_of(options, dimension, b));
    const auto node_base = static_cast<Local>(whole.points.size()), cell_base = static_cast<Local>(whole.cells.size());
    whole.node_id.insert(whole.node_id.end(), piece.node_id.begin(), piece.node_id.end());
    whole.points.insert(whole.points.end(), piece.points.begin(), piece.points.end());
    append(whole.cells, piece.cells, node_base);
    whole.cell_id.insert(whole.cell_id.end(), piece.cell_id.begin(), piece.cell_id.end());
    whole.cell_body.insert(whole.cell_body.end(), piece.cell_body.begin(), piece.cell_body.end());
    append(whole.facets.cells, piece.facets.cells, node_base);
    for (const Local parent : piece.facets.parent) whole.facets.parent.push_back(parent + cell_base);
    whole.facets.boundary.insert(whole.facets.boundary.end(), piece.facets.boundary.begin(), piece.facets.boundary.end());
  }
  return whole;
}

void broadcast(mesh::Catalogue& catalogue, const Communicator& comm)
{
  const auto share = [&](std::string& text) { comm.broadcast(text); };
  std::vector<long long> head{catalogue.dimension,
                              static_cast<long long>(catalogue.bodies.size()),
                              static_cast<long long>(catalogue.boundaries.size()),
                              catalogue.node_count,
                              catalogue.cell_count,
                              static_cast<long long>(catalogue.volumes.size()),
                              static_cast<long long>(catalogue.node_sets.size())};
  comm.broadcast(head);
  catalogue.dimension = static_cast<int>(head[0]);
  catalogue.bodies.resize(static_cast<std::size_t>(head[1]));
  catalogue.boundaries.resize(static_cast<std::size_t>(head[2]));
  catalogue.node_count = head[3];
  catalogue.cell_count = head[4];
  for (auto& body : catalogue.bodies) {
    share(body.name);
    share(body.group);
    share(body.instance);
  }
  catalogue.volumes.resize(static_cast<std::size_t>(head[5]));
  for (auto& volume : catalogue.volumes) share(volume);
  for (auto& boundary : catalogue.boundaries) share(boundary);
  catalogue.node_sets.resize(static_cast<std::size_t>(head[6]));
  for (auto& set : catalogue.node_sets) {
    share(set.name);
    comm.broadcast(set.nodes);
    comm.broadcast(set.weights);
  }
}

// Where the copies of the blocks are.
mesh::Layout layout_of_blocks(const mesh::Options& mesh, int dimension, mesh::Catalogue catalogue)
{
  std::vector<Global> nodes, cells;
  std::set<std::pair<int, int>> on;
  const auto bodies = static_cast<int>(catalogue.bodies.size()), sides = 2 * dimension;
  for (int b = 0; b <= bodies; ++b) {
    const auto first = mesh::first_numbers(mesh, dimension, b);
    nodes.push_back(first.node);
    cells.push_back(first.cell);
    for (int side = 0; b < bodies && side < sides; ++side) on.emplace(b * sides + side, b);
  }
  return mesh::lay_out(std::move(catalogue), mesh.instances, nodes, cells, on);
}

// Where the copies of a file's bodies are.
mesh::Layout layout_of_file(const mesh::Options& mesh, const mesh::Assembly& assembly)
{
  const auto bodies = assembly.catalogue.bodies.size();
  std::vector<Global> nodes(bodies + 1, 0), cells(bodies + 1, 0);  // bodies stand one after the other
  const auto& whole = assembly.mesh;
  for (std::size_t c = 0; c < whole.cells.size(); ++c) {
    const auto next = static_cast<std::size_t>(whole.cell_body[c]) + 1;
    cells[next] = static_cast<Global>(c) + 1;
    for (const Local n : whole.cells[c]) nodes[next] = std::max(nodes[next], static_cast<Global>(n) + 1);
  }
  std::set<std::pair<int, int>> on;
  for (std::size_t f = 0; f < whole.facets.parent.size(); ++f)
    on.emplace(whole.facets.boundary[f], whole.cell_body[static_cast<std::size_t>(whole.facets.parent[f])]);
  return mesh::lay_out(assembly.catalogue, mesh.instances, nodes, cells, on);
}

}  // namespace

int Decomposition::rank_of(Global subdomain) const
{
  return static_cast<int>(std::upper_bound(first.begin(), first.end(), subdomain) - first.begin()) - 1;
}

Decomposition decompose(const mesh::Options& mesh, const Options& options, int dimension, const Context& context)
{
  const auto& comm = context.comm;
  mesh::Assembly assembly;  // of the parts
  mesh::Layout layout;      // of the assembly; of files on rank 0 alone, but for the catalogue
  const bool grid = options.method == "grid";
  {
    const auto scope = context.timers.scope("mesh");
    collectively(comm, [&] {
      if (mesh.file.empty()) {
        mesh::require_room(mesh, dimension, !grid && comm.root());
        assembly.catalogue = mesh::block_catalogue(mesh, dimension);
        // Local numbers have 31 bits, and a cell with its nodes takes some 100 bytes of the rank that cuts the mesh.
        const auto largest = std::numeric_limits<Local>::max() / 32;
        if (!grid && std::max(assembly.catalogue.cell_count, assembly.catalogue.node_count) > largest)
          throw Error(ExitStatus::machine,
                      fmt::format("not enough memory to cut a mesh of {} cells in one piece (at most {}); take fewer cells, or "
                                  "decomposition.method grid",
                                  assembly.catalogue.cell_count, largest));
      } else if (comm.root()) {
        assembly = mesh::read(mesh, dimension);
      }
      if (mesh.file.empty())
        layout = layout_of_blocks(mesh, dimension, assembly.catalogue);
      else if (comm.root())
        layout = layout_of_file(mesh, assembly);
      if (comm.root()) mesh::require_room(layout.catalogue, comm.size());
      if (mesh.file.empty()) {
        mesh::require_resolved(layout, mesh::block_extents(mesh, dimension), "mesh.blocks");
        if (!grid && comm.root()) assembly.mesh = generate_whole(mesh, dimension, assembly.catalogue);
      } else if (comm.root()) {
        mesh::require_resolved(layout, mesh::extents(assembly.mesh, assembly.catalogue.bodies.size()), mesh.file);
      }
    });
    broadcast(layout.catalogue, comm);
    for (const auto& warning : assembly.warnings) context.log.warning("{}: {}", mesh.file, warning);
  }
  const auto scope = context.timers.scope("partition");
  auto share =
      grid ? generate_grid(mesh, options, dimension, layout, comm) : distribute(assembly.mesh, layout, dimension, options, comm);
  return {std::move(layout.catalogue), std::move(share.subdomains), std::move(share.first), std::move(share.clusters)};
}

mesh::Surface boundary_surface(const Decomposition& decomposition, int boundary, const std::vector<bool>& on_body)
{
  mesh::Surface surface;
  // Copies of a node in several subdomains are one node of the surface.
  for (const auto& subdomain : decomposition.subdomains) {
    if (!on_body[static_cast<std::size_t>(subdomain.body)]) continue;
    const auto& facets = subdomain.mesh.facets;
    for (std::size_t f = 0; f < facets.cells.size(); ++f)
      if (facets.boundary[f] == boundary)
        for (const Local n : facets.cells[f]) surface.node_id.push_back(subdomain.mesh.node_id[static_cast<std::size_t>(n)]);
  }
  std::sort(surface.node_id.begin(), surface.node_id.end());
  surface.node_id.erase(std::unique(surface.node_id.begin(), surface.node_id.end()), surface.node_id.end());
  surface.points.resize(surface.node_id.size());
  for (const auto& subdomain : decomposition.subdomains) {
    if (!on_body[static_cast<std::size_t>(subdomain.body)]) continue;
    const auto& mesh = subdomain.mesh;
    for (std::size_t f = 0; f < mesh.facets.cells.size(); ++f) {
      if (mesh.facets.boundary[f] != boundary) continue;
      std::vector<Local> face;
      for (const Local n : mesh.facets.cells[f]) {
        const auto node = static_cast<std::size_t>(n);
        const auto at =
            std::lower_bound(surface.node_id.begin(), surface.node_id.end(), mesh.node_id[node]) - surface.node_id.begin();
        face.push_back(static_cast<Local>(at));
        surface.points[static_cast<std::size_t>(at)] = mesh.points[node];
      }
      surface.faces.add(mesh.facets.cells.type[f], face);
      surface.face_id.push_back(face_number(mesh, f));
      surface.body.push_back(subdomain.body);
    }
  }
  return surface;
}

}  // namespace mortise::partition
