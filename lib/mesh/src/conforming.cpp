#include "conforming.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "gmsh_file.hpp"
#include "mesh/topology.hpp"
#include "orient.hpp"

namespace mortise::mesh {

Groups group(const RawMesh& raw, const Options& options)
{
  Groups groups;
  std::map<std::string, std::string> owner;  // volume -> body of several volumes
  for (const auto& [body, volumes] : options.volumes)
    for (const auto& volume : volumes) owner.emplace(volume, body);
  std::vector<int> of_volume;
  for (const auto& volume : raw.volumes) {
    const auto found = owner.find(volume);
    const auto& name = found == owner.end() ? volume : found->second;
    const auto known = std::find(groups.names.begin(), groups.names.end(), name);
    of_volume.push_back(static_cast<int>(known - groups.names.begin()));
    if (known == groups.names.end()) groups.names.push_back(name);
  }
  const auto count = static_cast<int>(groups.names.size());
  for (std::size_t c = 0; c < raw.cells.size(); ++c) {
    const int own = of_volume[static_cast<std::size_t>(raw.volume[c])];
    const bool united = options.volumes.contains(groups.names[static_cast<std::size_t>(own)]);
    groups.of_cell.push_back(own);
    groups.label.push_back(raw.solid.empty() || united ? own : count + raw.solid[c]);
  }
  return groups;
}

namespace {

constexpr double same_place = 0.05;  // of an edge: one of two nodes may lie on a curve and the other one amid the corners
constexpr double far_nearer = 0.25;  // times the distance from where a node belongs

// Two cells of one body must meet with the same kind of face, in the same nodes, and on its two sides.
class FaceCheck {
 public:
  FaceCheck(const std::string& file, const RawMesh& raw, const Groups& groups) : file_(file), raw_(raw), groups_(groups) {}

  // A node in the middle that only one of them has would tear them.
  void require_same_kind(const CellFace& a, const CellFace& b) const
  {
    if (type(a) == type(b)) return;
    fail(file_,
         fmt::format("in body \"{}\" a face is a {} of one cell and a {} of its neighbour; mesh the whole body with one order "
                     "and one kind of elements (Mesh.SecondOrderIncomplete)",
                     body(a), name(type(a)), name(type(b))));
  }

  // Corners alone would tie the two cells at points, and they would gape between them. Two arcs that are far apart between the
  // same corners are a hole.
  void require_same_nodes(const CellFace& a, const CellFace& b) const
  {
    if (first_order(type(a)) == type(a)) return;
    const auto own = nodes(a), others = nodes(b);
    if (own == others) return;
    const Point &x = point(a.corners[0]), &y = point(a.corners[1]);
    const bool twice = std::ranges::all_of(own, [&](Local n) {
      return std::ranges::any_of(others, [&](Local m) { return (point(n) - point(m)).norm() <= same_place * (x - y).norm(); });
    });
    const auto refuse = [&](const char* cause) {
      fail(file_,
           fmt::format("elements {} and {} of body \"{}\" share the corners of a face near ({:.6g}, {:.6g}, {:.6g}), but not "
                       "the nodes between them: {}",
                       tag(a), tag(b), body(a), x[0], x[1], x[2], cause));
    };
    if (twice)
      refuse("these are twice, at the same places or nearly; merge them, or join the parts before they are made of second order");
    for (const auto* face : {&a, &b})
      if (is_out_of_order(face->cell))
        refuse(fmt::format("element {} has them in another order than the file's format asks for", tag(*face)).c_str());
  }

  // Cells that are right side out see a common face from its two sides; where they do not, one lies folded into the other.
  void require_two_sides(const CellFace& a, const CellFace& b) const
  {
    auto reversed = ring(b);
    std::reverse(reversed.begin() + (reversed.size() > 2 ? 1 : 0), reversed.end());
    if (ring(a) != reversed) overlap(a, b);
  }

  [[noreturn]] void overlap(const CellFace& a, const CellFace& b) const
  {
    const Point& x = point(a.corners[0]);
    fail(file_,
         fmt::format("elements {} and {} of body \"{}\" lie on the same side of their common face near ({:.6g}, {:.6g}, {:.6g}): "
                     "they overlap; a node there is out of place",
                     tag(a), tag(b), body(a), x[0], x[1], x[2]));
  }

  int group(const CellFace& face) const { return groups_.label[static_cast<std::size_t>(face.cell)]; }

 private:
  const Face& shape(const CellFace& face) const
  {
    return faces(raw_.cells.type[static_cast<std::size_t>(face.cell)])[static_cast<std::size_t>(face.face)];
  }
  CellType type(const CellFace& face) const { return shape(face).type; }
  const std::string& body(const CellFace& face) const
  {
    return groups_.names[static_cast<std::size_t>(groups_.of_cell[static_cast<std::size_t>(face.cell)])];
  }
  const Point& point(Local node) const { return raw_.points[static_cast<std::size_t>(node)]; }
  std::size_t tag(const CellFace& face) const { return raw_.tag[static_cast<std::size_t>(face.cell)]; }
  // All of them, ascending.
  std::vector<Local> nodes(const CellFace& face) const
  {
    std::vector<Local> result;
    for (const int k : shape(face).nodes)
      result.push_back(raw_.cells[static_cast<std::size_t>(face.cell)][static_cast<std::size_t>(k)]);
    std::ranges::sort(result);
    return result;
  }
  // Whether a node between two corners of a cell lies amid two others.
  bool is_out_of_order(Local cell) const
  {
    const auto nodes = raw_.cells[static_cast<std::size_t>(cell)];
    const CellType type = raw_.cells.type[static_cast<std::size_t>(cell)];
    const auto amid = [&](const auto& corners) {
      Point sum = Point::Zero();
      for (const int c : corners) sum += point(nodes[static_cast<std::size_t>(c)]) / static_cast<double>(corners.size());
      return sum;
    };
    for (std::size_t m = 0; m < middles(type).size(); ++m) {
      const Point& x = point(nodes[static_cast<std::size_t>(corner_count(type)) + m]);
      const double off = (x - amid(middles(type)[m])).norm();
      for (const auto& others : middles(type))
        if ((x - amid(others)).norm() < far_nearer * off) return true;
    }
    return false;
  }
  // Corners in their order about the normal that points out of the cell, of a ring the one with the smallest number first.
  std::vector<Local> ring(const CellFace& face) const
  {
    std::vector<Local> result;
    for (int i = 0; i < corner_count(type(face)); ++i)
      result.push_back(raw_.cells[static_cast<std::size_t>(face.cell)]
                                 [static_cast<std::size_t>(shape(face).nodes[static_cast<std::size_t>(i)])]);
    if (result.size() > 2) std::rotate(result.begin(), std::min_element(result.begin(), result.end()), result.end());
    return result;
  }

  const std::string& file_;
  const RawMesh& raw_;
  const Groups& groups_;
};

}  // namespace

void require_conforming(const std::string& file, const RawMesh& raw, std::span<const CellFace> faces, const Groups& groups,
                        int dimension)
{
  std::vector<CellFace> all(faces.begin(), faces.end());
  std::erase_if(all,
                [&](const CellFace& face) { return !is_solid(raw.cells.type[static_cast<std::size_t>(face.cell)], dimension); });
  const FaceCheck check(file, raw, groups);
  for (std::size_t i = 0; i + 1 < all.size(); ++i) {
    if (all[i].corners != all[i + 1].corners || check.group(all[i]) != check.group(all[i + 1])) continue;
    check.require_same_kind(all[i], all[i + 1]);
    check.require_same_nodes(all[i], all[i + 1]);
    check.require_two_sides(all[i], all[i + 1]);
    if (i + 2 < all.size() && all[i + 2].corners == all[i].corners && check.group(all[i + 2]) == check.group(all[i]))
      check.overlap(all[i], all[i + 2]);
  }
}

}  // namespace mortise::mesh
