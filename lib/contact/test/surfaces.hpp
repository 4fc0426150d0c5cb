// Surfaces to search, and all rows that come of them.
#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <map>
#include <memory>
#include <random>
#include <vector>

#include "contact/cyclic.hpp"
#include "contact/mortar.hpp"

namespace mortise::contact {

// A grid of nx x ny faces over [x0, x1] x [y0, y1] at height z(x, y), looking up or down; each rank holds every ranks-th face.
struct Grid {
  int nx, ny;
  double x0, x1, y0, y1;
  bool up;
  bool triangles = false;
  Global first_id = 0;
  double disturb = 0;  // of the inner nodes, part of the cell size
  bool teeth = false;  // of the last column every second triangle is left out
};

template <class Height>
mesh::Surface surface(const Grid& g, const Height& height, const Communicator& comm)
{
  std::vector<Point> points;
  std::mt19937 generator(static_cast<unsigned>(g.nx));
  std::uniform_real_distribution<double> shift(-g.disturb, g.disturb);
  for (int j = 0; j <= g.ny; ++j)
    for (int i = 0; i <= g.nx; ++i) {
      const bool inner = i > 0 && i < g.nx && j > 0 && j < g.ny;
      const double x = g.x0 + (g.x1 - g.x0) * (i + (inner ? shift(generator) : 0)) / g.nx,
                   y = g.y0 + (g.y1 - g.y0) * (j + (inner ? shift(generator) : 0)) / g.ny;
      points.push_back(height(x, y));
    }
  std::vector<std::vector<int>> faces;
  for (int j = 0; j < g.ny; ++j)
    for (int i = 0; i < g.nx; ++i) {
      const int a = i + (g.nx + 1) * j, b = a + 1, c = b + g.nx + 1, d = a + g.nx + 1;
      if (g.triangles) {
        if (!g.teeth || i + 1 < g.nx) faces.push_back({a, b, c});
        faces.push_back({a, c, d});
      } else {
        faces.push_back({a, b, c, d});
      }
    }
  mesh::Surface result;
  std::map<int, Local> local;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    if (static_cast<int>(f) % comm.size() != comm.rank()) continue;
    for (const int n : faces[f]) local.emplace(n, 0);
  }
  for (auto& [n, index] : local) {
    index = static_cast<Local>(result.points.size());
    result.points.push_back(points[static_cast<std::size_t>(n)]);
    result.node_id.push_back(g.first_id + n);
  }
  for (std::size_t f = 0; f < faces.size(); ++f) {
    if (static_cast<int>(f) % comm.size() != comm.rank()) continue;
    std::vector<Local> nodes;
    for (const int n : faces[f]) nodes.push_back(local.at(n));
    if (!g.up) std::reverse(nodes.begin(), nodes.end());
    result.faces.add(g.triangles ? mesh::CellType::tri3 : mesh::CellType::quad4, nodes);
    result.face_id.push_back(g.first_id + static_cast<Global>(f));
    result.body.push_back(0);
  }
  return result;
}

// The side with nodes in the middle of its edges (and faces), and turned about the origin.
inline mesh::Surface second_order(const mesh::Surface& side, mesh::CellType type, const Eigen::Matrix3d& rotation,
                                  Global first_id)
{
  mesh::Surface result = side;
  result.faces = {};
  std::map<Global, Local> middles;
  const auto middle = [&](std::span<const Local> ends) {
    Point at = Point::Zero();
    Global least = side.node_id[static_cast<std::size_t>(ends[0])] - first_id, most = least;
    for (const Local n : ends) {
      at += side.points[static_cast<std::size_t>(n)] / static_cast<double>(ends.size());
      least = std::min(least, side.node_id[static_cast<std::size_t>(n)] - first_id);
      most = std::max(most, side.node_id[static_cast<std::size_t>(n)] - first_id);
    }
    const Global id = first_id + (ends.size() == 2 ? 1000 : 20000) + 100 * least + most;
    const auto [found, added] = middles.try_emplace(id, static_cast<Local>(result.points.size()));
    if (added) result.points.push_back(at), result.node_id.push_back(id);
    return found->second;
  };
  for (std::size_t f = 0; f < side.faces.size(); ++f) {
    const std::vector<Local> corners(side.faces[f].begin(), side.faces[f].end());
    auto nodes = corners;
    for (std::size_t k = 0; k < corners.size(); ++k)
      nodes.push_back(middle(std::vector{corners[k], corners[(k + 1) % corners.size()]}));
    if (type == mesh::CellType::quad9) nodes.push_back(middle(corners));
    result.faces.add(type, nodes);
  }
  for (auto& x : result.points) x = rotation * x;
  return result;
}

// All points and rows on every rank.
struct Gathered {
  struct Entry {
    Global node;
    int component;
    double coefficient;
  };
  struct Row {
    std::vector<Entry> entries;
    double bound;
    Global node;
    double area, weight;
    Point normal;
    bool is_normal;
  };
  std::vector<Row> rows;
};

inline Gathered gather_rows(const constraint::Contacts& contacts, const Communicator& comm)
{
  std::vector<double> stream;
  for (const auto& point : contacts.nodes)
    for (std::size_t r = point.row; r <= point.row + point.tangents.size(); ++r) {
      stream.insert(stream.end(),
                    {static_cast<double>(contacts.rows[r].size()), contacts.rows.bound[r], static_cast<double>(point.node),
                     point.area, point.weight, point.normal[0], point.normal[1], point.normal[2], r == point.row ? 1.0 : 0.0});
      for (const auto& e : contacts.rows[r])
        stream.insert(stream.end(), {static_cast<double>(e.node), static_cast<double>(e.component), e.coefficient});
    }
  stream = comm.all_gather(stream);
  Gathered result;
  for (std::size_t at = 0; at < stream.size();) {
    Gathered::Row row;
    const auto count = static_cast<std::size_t>(stream[at]);
    row.bound = stream[at + 1];
    row.node = static_cast<Global>(stream[at + 2]);
    row.area = stream[at + 3];
    row.weight = stream[at + 4];
    row.normal = Point(stream[at + 5], stream[at + 6], stream[at + 7]);
    row.is_normal = stream[at + 8] == 1;
    at += 9;
    for (std::size_t e = 0; e < count; ++e, at += 3)
      row.entries.push_back({static_cast<Global>(stream[at]), static_cast<int>(stream[at + 1]), stream[at + 2]});
    result.rows.push_back(row);
  }
  return result;
}

inline constexpr Global primary_ids = 100000;

// Coordinates of every node, whole.
inline std::map<Global, Point> nodes_of(const Pair& pair, const Communicator& comm)
{
  std::vector<double> flat;
  for (const auto* side : {&pair.secondary, pair.primary.get()})
    for (std::size_t n = 0; n < side->points.size(); ++n)
      flat.insert(flat.end(),
                  {static_cast<double>(side->node_id[n]), side->points[n][0], side->points[n][1], side->points[n][2]});
  std::map<Global, Point> result;
  flat = comm.all_gather(flat);
  for (std::size_t i = 0; i < flat.size(); i += 4)
    result[static_cast<Global>(flat[i])] = Point(flat[i + 1], flat[i + 2], flat[i + 3]);
  return result;
}

inline Pair make_pair(const mesh::Surface& secondary, const mesh::Surface& primary, Law law)
{
  Options options;
  options.law = law;
  return {options, secondary, std::make_shared<const mesh::Surface>(primary)};
}

// The faces below the edge of a side in the plane where a coordinate is 0, which look out of the body; new nodes from `first_id` on.
// On rank 0.
inline mesh::Surface cut_below(const mesh::Surface& side, int coordinate, Global first_id, const Communicator& comm)
{
  mesh::Surface result;
  std::map<Global, Point> edge;
  for (std::size_t n = 0; n < side.points.size(); ++n)
    if (side.points[n][coordinate] == 0) edge[side.node_id[n]] = side.points[n];
  std::vector<double> flat;
  for (const auto& [id, x] : edge) flat.insert(flat.end(), {static_cast<double>(id), x[0], x[1], x[2]});
  flat = comm.all_gather(flat);
  if (!comm.root()) return result;
  for (std::size_t i = 0; i < flat.size(); i += 4) edge[static_cast<Global>(flat[i])] = Point(flat[i + 1], flat[i + 2], flat[i + 3]);
  for (const auto& [id, x] : edge) result.node_id.push_back(id), result.points.push_back(x);
  const auto count = static_cast<Local>(edge.size());
  for (Local n = 0; n < count; ++n) {
    result.node_id.push_back(first_id + n);
    result.points.push_back(result.points[static_cast<std::size_t>(n)] - Point(0, 0, 1));
    if (n + 1 == count) continue;
    std::vector<Local> face{n, n + 1, n + 1 + count, n + count};
    if (coordinate == 1) std::ranges::reverse(face);
    result.faces.add(mesh::CellType::quad4, face);
    result.face_id.push_back(first_id + n);
    result.body.push_back(0);
  }
  return result;
}

// A bond of the cuts x = 0 and y = 0 below a side that is a quarter of the whole.
inline Pair bond_of_quarter(const mesh::Surface& side, const Communicator& comm)
{
  Options cut;
  cut.law = Law::bonded;
  cut.cyclic.emplace();
  cut.cyclic->angle = 90;
  return {cut, cut_below(side, 0, 300000, comm), std::make_shared<const mesh::Surface>(rotated(cut_below(side, 1, 400000, comm), cut))};
}

}  // namespace mortise::contact
