#include "rows/tied_by_others.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <map>
#include <set>

#include "base/dense.hpp"

namespace mortise::contact {

namespace {

// Of the mean square distance from the middle.
constexpr double least_spread = 0.05;

// Points with weights.
class Scatter {
 public:
  void add(const Point& x, double weight)
  {
    weight_ += weight;
    sum_ += weight * x;
    squares_ += weight * x * x.transpose();
  }

  // The mean square distance in the direction in which it is second largest; in plane models largest.
  double second(int dimension) const
  {
    if (!(weight_ > 0)) return 0;
    const Point middle = sum_ / weight_;
    const Eigen::Matrix3d mean = squares_ / weight_ - middle * middle.transpose();
    return dense::space_eigenvalues(mean)[dimension == 3 ? 1 : 2];
  }

 private:
  double weight_ = 0;
  Point sum_ = Point::Zero();
  Eigen::Matrix3d squares_ = Eigen::Matrix3d::Zero();
};

class Pads {
 public:
  Pads(const Side& secondary, CutFaces& faces, const std::vector<char>& stay, int dimension)
      : secondary_(secondary), faces_(faces), stay_(stay), dimension_(dimension), at_node_(secondary.points.size())
  {
    for (const std::size_t f : faces.round())
      for (const Local n : secondary.faces[f]) at_node_[static_cast<std::size_t>(n)].push_back(f);
  }

  // Whether the others hold what a face meets.
  bool held(std::size_t face)
  {
    std::set<Local> met;  // nodes of the primary side
    std::vector<std::pair<std::size_t, std::size_t>> left;
    std::set<std::size_t> near;
    for (const Local n : secondary_.faces[face])
      near.insert(at_node_[static_cast<std::size_t>(n)].begin(), at_node_[static_cast<std::size_t>(n)].end());
    for (const std::size_t f : near)
      for (const std::size_t i : faces_.pieces(f)) {
        const auto nodes = faces_.piece(i).nodes;
        if (f == face) met.insert(nodes.begin(), nodes.end());
        left.emplace_back(f, i);
      }
    Rows all, rest;
    for (bool more = true; more;) {
      more = std::erase_if(left, [&](const auto& entry) {
               const auto piece = faces_.piece(entry.second);
               if (std::ranges::none_of(piece.nodes, [&](Local n) { return met.contains(n); })) return false;
               met.insert(piece.nodes.begin(), piece.nodes.end());
               add(entry.first, piece, all, rest);
               return true;
             }) > 0;
    }
    return spread(rest) > least_spread * spread(all);
  }

 private:
  struct Row {
    double weight = 0;
    Point moment = Point::Zero();
  };
  using Rows = std::map<std::size_t, Row>;  // of surface nodes

  double spread(const Rows& rows) const
  {
    Scatter points;
    for (const auto& [p, row] : rows) points.add(row.moment / row.weight, row.weight);
    return points.second(dimension_);
  }

  // Where functions are left out the others of their piece take over their share alike, as in make_dual().
  void add(std::size_t face, const PieceStore::View& piece, Rows& all, Rows& rest) const
  {
    Few<Point, most_functions> points;
    Row left_out;
    int others = 0;
    for (Eigen::Index k = 0; k < piece.covered.size(); ++k) {
      points.push_back(point_of(face, piece, k));
      if (!(piece.covered[k] > 0)) continue;
      auto& row = all[faces_.surface_node_of(face, piece, k)];
      row.weight += piece.covered[k];
      row.moment += piece.covered[k] * points[static_cast<std::size_t>(k)];
      if (stay_[faces_.surface_node_of(face, piece, k)]) {
        ++others;
      } else {
        left_out.weight += piece.covered[k];
        left_out.moment += piece.covered[k] * points[static_cast<std::size_t>(k)];
      }
    }
    for (Eigen::Index k = 0; k < piece.covered.size(); ++k) {
      const auto p = faces_.surface_node_of(face, piece, k);
      if (!(piece.covered[k] > 0) || !stay_[p]) continue;
      auto& row = rest[p];
      row.weight += piece.covered[k] + left_out.weight / others;
      row.moment += piece.covered[k] * points[static_cast<std::size_t>(k)] + left_out.moment / others;
    }
  }

  Point point_of(std::size_t face, const PieceStore::View& piece, Eigen::Index k) const
  {
    if (piece.point_facet.empty())
      return secondary_.points[static_cast<std::size_t>(secondary_.faces[face][static_cast<std::size_t>(k)])];
    Point at = Point::Zero();
    const Local facet = piece.point_facet[static_cast<std::size_t>(k)];
    if (facet < 0) return at;  // no function
    const auto corners = secondary_.facets[static_cast<std::size_t>(facet)];
    for (std::size_t c = 0; c < corners.size(); ++c)
      at += piece.points(k, static_cast<Eigen::Index>(c)) * secondary_.points[static_cast<std::size_t>(corners[c])];
    return at;
  }

  const Side& secondary_;
  CutFaces& faces_;
  const std::vector<char>& stay_;
  int dimension_;
  std::vector<std::vector<std::size_t>> at_node_;  // faces
};

}  // namespace

std::vector<char> tied_by_others(const Side& secondary, CutFaces& faces, const std::vector<char>& aside,
                                 const std::vector<char>& stay, int dimension)
{
  std::vector<char> result = aside;
  if (std::ranges::none_of(aside, [](char a) { return a != 0; })) return result;
  Pads pads(secondary, faces, stay, dimension);
  for (const std::size_t f : faces.round()) {
    const auto nodes = faces.surface_nodes_of(f);
    if (std::ranges::none_of(nodes, [&](Local p) { return result[static_cast<std::size_t>(p)] != 0; })) continue;
    bool covered = false;
    for (const std::size_t i : faces.pieces(f)) covered = covered || faces.piece(i).covered.sum() > 0;
    if (!covered || pads.held(f)) continue;
    for (const Local p : nodes) result[static_cast<std::size_t>(p)] = 0;
  }
  return result;
}

}  // namespace mortise::contact
