// Outer faces of bodies, to search.
#pragma once

#include <algorithm>
#include <array>
#include <map>
#include <utility>
#include <vector>

#include "base/communicator.hpp"
#include "mesh/mesh.hpp"

namespace mortise::contact {

// Outer faces of bodies, whole on every rank; a rank takes every ranks-th face, or those of a slab.
struct OuterFaces {
  std::vector<Point> points;
  std::vector<std::vector<Local>> faces;
  std::vector<int> body;

  // A box with a grid of quads on each side.
  void add_box(int number, const Point& origin, const Point& size, std::array<int, 3> cells)
  {
    std::map<std::array<int, 3>, Local> nodes;
    const auto node = [&](std::array<int, 3> i) {
      const auto [entry, fresh] = nodes.emplace(i, static_cast<Local>(points.size()));
      if (fresh)
        points.emplace_back(origin[0] + size[0] * i[0] / cells[0], origin[1] + size[1] * i[1] / cells[1],
                            origin[2] + size[2] * i[2] / cells[2]);
      return entry->second;
    };
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
      for (const bool high : {false, true})
        for (int i = 0; i < cells[u]; ++i)
          for (int j = 0; j < cells[v]; ++j) {
            std::vector<Local> face;
            for (const auto& [di, dj] : {std::pair(0, 0), std::pair(1, 0), std::pair(1, 1), std::pair(0, 1)}) {
              std::array<int, 3> at{};
              at[axis] = high ? cells[axis] : 0;
              at[u] = i + di;
              at[v] = j + dj;
              face.push_back(node(at));
            }
            if (!high) std::reverse(face.begin(), face.end());
            faces.push_back(face);
            body.push_back(number);
          }
    }
  }

  // A closed line, counter-clockwise.
  void add_line(int number, const std::vector<Point>& line)
  {
    const auto first = static_cast<Local>(points.size()), n = static_cast<Local>(line.size());
    points.insert(points.end(), line.begin(), line.end());
    for (Local i = 0; i < n; ++i) {
      faces.push_back({first + i, first + (i + 1) % n});
      body.push_back(number);
    }
  }

  mesh::Surface on_rank(const Communicator& comm) const
  {
    const auto ranks = static_cast<std::size_t>(comm.size());
    return of_rank(comm.rank(), [&](std::size_t f) { return static_cast<int>(f % ranks); });
  }

  // A rank's faces of a body lie together, beside those of others along x, from 0 to `length`; what lies above each other of two
  // bodies is on different ranks.
  mesh::Surface in_slabs(double length, const Communicator& comm) const
  {
    return of_rank(comm.rank(), [&](std::size_t f) {
      const double part = points[static_cast<std::size_t>(faces[f].front())][0] / length;
      return (std::clamp(static_cast<int>(part * comm.size()), 0, comm.size() - 1) + body[f]) % comm.size();
    });
  }

 private:
  template <class RankOf>
  mesh::Surface of_rank(int rank, const RankOf& rank_of) const
  {
    mesh::Surface result;
    for (std::size_t n = 0; n < points.size(); ++n) {
      result.points.push_back(points[n]);
      result.node_id.push_back(static_cast<Global>(n));
    }
    for (std::size_t f = 0; f < faces.size(); ++f) {
      if (rank_of(f) != rank) continue;
      result.faces.add(faces[f].size() == 2 ? mesh::CellType::line2 : mesh::CellType::quad4, faces[f]);
      result.face_id.push_back(static_cast<Global>(f));
      result.body.push_back(body[f]);
    }
    return result;
  }
};

}  // namespace mortise::contact
