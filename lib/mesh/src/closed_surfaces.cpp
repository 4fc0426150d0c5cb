#include "closed_surfaces.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

#include "gmsh_file.hpp"

namespace mortise::mesh {

namespace {

// Where a cell of a surface meets the next one: an edge, from `a` to `b` as the cell runs along it; in a plane the node at the
// end of a line, `b` = -1. `forward`: a < b, or the end that the line runs to.
struct Rim {
  Local low, high;
  std::size_t cell;
  bool forward;
};

std::vector<Rim> rims_of(const RawMesh& raw, std::size_t cell)
{
  const auto type = raw.cells.type[cell];
  const auto nodes = raw.cells[cell].first(static_cast<std::size_t>(corner_count(type)));
  if (mesh::dimension(type) == 1) return {{nodes[0], -1, cell, false}, {nodes[1], -1, cell, true}};
  std::vector<Rim> result;
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    const Local a = nodes[k], b = nodes[(k + 1) % nodes.size()];
    result.push_back({std::min(a, b), std::max(a, b), cell, a < b});
  }
  return result;
}

// One closed surface.
struct Sheet {
  int group;
  std::vector<std::size_t> cells;
  double volume = 0;  // enclosed, negative if normals point inward; in a plane the area
  Point low = Point::Constant(HUGE_VAL), high = Point::Constant(-HUGE_VAL);
  std::vector<std::size_t> around = {};  // sheets of the same group that enclose it
  int body = -1;

  bool may_hold(const Sheet& other) const
  {
    return (low.array() <= other.low.array()).all() && (high.array() >= other.high.array()).all();
  }
  bool may_cross(const Sheet& other) const
  {
    return (low.array() <= other.high.array()).all() && (high.array() >= other.low.array()).all();
  }
};

class Surfaces {
 public:
  Surfaces(RawMesh& raw, const std::vector<int>& group, const std::string& file, int dimension)
      : raw_(raw), group_(group), file_(file), dimension_(dimension), turned_(raw.cells.size(), false)
  {
    for (std::size_t c = 0; c < raw.cells.size(); ++c)
      if (mesh::dimension(raw.cells.type[c]) < dimension)
        for (const auto& rim : rims_of(raw, c)) rims_.push_back(rim);
    std::sort(rims_.begin(), rims_.end(), [&](const Rim& x, const Rim& y) {
      return std::tuple(x.low, x.high, group_[x.cell], x.cell) < std::tuple(y.low, y.high, group_[y.cell], y.cell);
    });
  }

  std::vector<int> bodies()
  {
    find_sheets();
    for (auto& sheet : sheets_) measure(sheet);
    for (std::size_t i = 0; i < sheets_.size(); ++i)
      for (std::size_t j = 0; j < sheets_.size(); ++j)
        if (i != j && sheets_[i].group == sheets_[j].group && sheets_[j].may_cross(sheets_[i]) && encloses(j, i))
          sheets_[i].around.push_back(j);
    return assign();
  }

 private:
  const Point& point(Local node) const { return raw_.points[static_cast<std::size_t>(node)]; }
  const std::string& name(std::size_t cell) const { return raw_.volumes[static_cast<std::size_t>(raw_.volume[cell])]; }
  [[noreturn]] void refuse(std::size_t cell, const Point& x, const char* what, const char* why) const
  {
    fail(file_,
         fmt::format("the surface of body \"{}\" {} near ({:.6g}, {:.6g}, {:.6g}): {}", name(cell), what, x[0], x[1], x[2], why));
  }

  // The other cell at each rim of a cell, and whether both run along it the same way.
  struct Next {
    std::size_t cell;
    bool alike;
  };
  std::vector<std::vector<Next>> neighbours() const
  {
    std::vector<std::vector<Next>> result(raw_.cells.size());
    for (std::size_t i = 0; i < rims_.size();) {
      std::size_t end = i + 1;
      while (end < rims_.size() && rims_[end].low == rims_[i].low && rims_[end].high == rims_[i].high &&
             group_[rims_[end].cell] == group_[rims_[i].cell])
        ++end;
      const auto& rim = rims_[i];
      const Point x = rim.high < 0 ? point(rim.low) : Point((point(rim.low) + point(rim.high)) / 2);
      if (end == i + 1)
        refuse(rim.cell, x, "is not closed",
               "a cell there has no neighbour; let neighbours share their nodes, or add the surface that is missing");
      if (end > i + 2)
        refuse(rim.cell, x, "meets itself",
               "more than two cells share an edge there; part them, leave out a surface that is there twice, or give the body "
               "volume cells");
      const auto& other = rims_[i + 1];
      if ((raw_.cells.type[rim.cell] == first_order(raw_.cells.type[rim.cell])) !=
          (raw_.cells.type[other.cell] == first_order(raw_.cells.type[other.cell])))
        refuse(rim.cell, x, "has cells of first and of second order", "they leave a gap; mesh it with one order");
      result[rim.cell].push_back({other.cell, rim.forward == other.forward});
      result[other.cell].push_back({rim.cell, rim.forward == other.forward});
      i = end;
    }
    return result;
  }

  // Connected cells, turned alike.
  void find_sheets()
  {
    const auto next = neighbours();
    std::vector<bool> seen(raw_.cells.size(), false);
    for (std::size_t seed = 0; seed < raw_.cells.size(); ++seed) {
      if (seen[seed] || mesh::dimension(raw_.cells.type[seed]) == dimension_) continue;
      Sheet sheet{group_[seed], {seed}};
      seen[seed] = true;
      for (std::size_t i = 0; i < sheet.cells.size(); ++i) {
        const auto cell = sheet.cells[i];
        for (const auto& [other, alike] : next[cell]) {
          const bool turned = turned_[cell] != alike;
          if (!seen[other]) {
            seen[other] = true;
            turned_[other] = turned;
            sheet.cells.push_back(other);
          } else if (turned_[other] != turned) {
            refuse(cell, point(raw_.cells[cell][0]), "has one side only", "it is no surface of a body");
          }
        }
      }
      sheets_.push_back(std::move(sheet));
    }
  }

  // The corners of a cell, as it is turned.
  std::vector<Point> corners(std::size_t cell) const
  {
    std::vector<Point> result;
    for (int k = 0; k < corner_count(raw_.cells.type[cell]); ++k)
      result.push_back(point(raw_.cells[cell][static_cast<std::size_t>(k)]));
    if (turned_[cell]) std::reverse(result.begin(), result.end());
    return result;
  }

  void measure(Sheet& sheet)
  {
    for (const auto cell : sheet.cells)
      for (const Local n : raw_.cells[cell]) {
        sheet.low = sheet.low.cwiseMin(point(n));
        sheet.high = sheet.high.cwiseMax(point(n));
      }
    const Point origin = (sheet.low + sheet.high) / 2;
    for (const auto cell : sheet.cells) {
      const auto x = corners(cell);
      if (x.size() == 2) {
        const Point a = x[0] - origin, b = x[1] - origin;
        sheet.volume += (a[0] * b[1] - a[1] * b[0]) / 2;
      }
      for (std::size_t k = 1; k + 1 < x.size(); ++k)
        sheet.volume += (x[0] - origin).dot((x[k] - origin).cross(x[k + 1] - origin)) / 6;
    }
    const double size = (sheet.high - sheet.low).maxCoeff();
    if (std::abs(sheet.volume) <= 1e-12 * std::pow(size, dimension_))
      refuse(sheet.cells[0], origin, "encloses nothing", "its volume is zero");
  }

  // How often a sheet goes round a point, by solid angles [Van Oosterom and Strackee, IEEE Trans. Biomed. Eng. 30 (1983)]; in a
  // plane by angles. Half of it where the point lies on the sheet.
  double winding(const Sheet& sheet, const Point& x) const
  {
    double angle = 0;
    for (const auto cell : sheet.cells) {
      auto r = corners(cell);
      for (auto& corner : r) corner -= x;
      if (r.size() == 2) angle += std::atan2(r[0][0] * r[1][1] - r[0][1] * r[1][0], r[0].dot(r[1]));
      for (std::size_t k = 1; k + 1 < r.size(); ++k) {
        const double a = r[0].norm(), b = r[k].norm(), c = r[k + 1].norm();
        angle += 2 * std::atan2(r[0].dot(r[k].cross(r[k + 1])),
                                a * b * c + r[0].dot(r[k]) * c + r[k].dot(r[k + 1]) * a + r[k + 1].dot(r[0]) * b);
      }
    }
    return std::abs(angle) / (dimension_ == 2 ? 2 * std::numbers::pi : 4 * std::numbers::pi);
  }

  // Whether a sheet encloses another one: all of its nodes, or none. Nodes where they touch say nothing.
  bool encloses(std::size_t outer, std::size_t inner) const
  {
    std::vector<Local> nodes;
    for (const auto cell : sheets_[inner].cells)
      for (int k = 0; k < corner_count(raw_.cells.type[cell]); ++k)
        nodes.push_back(raw_.cells[cell][static_cast<std::size_t>(k)]);
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    std::size_t in = 0, out = 0;
    for (const Local n : nodes) {
      const double turns = winding(sheets_[outer], point(n));
      if (turns > 0.99) ++in;
      if (turns < 0.01) ++out;
      if (in > 0 && out > 0)
        refuse(sheets_[inner].cells[0], point(n), "crosses itself",
               "two closed surfaces of a body must lie apart, or one in the other");
    }
    return in > 0 && sheets_[outer].may_hold(sheets_[inner]);
  }

  // An outer surface lies in an even number of others.
  std::vector<int> assign()
  {
    int count = 0;
    for (auto& sheet : sheets_)
      if (sheet.around.size() % 2 == 0) sheet.body = count++;
    std::vector<int> result(raw_.cells.size(), -1);
    for (auto& sheet : sheets_) {
      const bool cavity = sheet.body < 0;
      if (cavity) {  // of the one around it that lies in all the others
        const auto depth = [&](std::size_t i) { return sheets_[i].around.size(); };
        const auto closest = *std::max_element(sheet.around.begin(), sheet.around.end(),
                                               [&](std::size_t a, std::size_t b) { return depth(a) < depth(b); });
        sheet.body = sheets_[closest].body;
      }
      for (const auto cell : sheet.cells) {
        result[cell] = sheet.body;
        if ((sheet.volume < 0) != cavity) turned_[cell] = !turned_[cell];
      }
    }
    Cells cells;
    for (std::size_t c = 0; c < raw_.cells.size(); ++c) {
      const auto type = raw_.cells.type[c];
      if (turned_[c])
        cells.add(type, reversed(type, raw_.cells[c]));
      else
        cells.add(type, raw_.cells[c]);
    }
    raw_.cells = std::move(cells);
    return result;
  }

  RawMesh& raw_;
  const std::vector<int>& group_;
  const std::string& file_;
  int dimension_;
  std::vector<Rim> rims_;
  std::vector<bool> turned_;  // of each cell, against the file
  std::vector<Sheet> sheets_;
};

}  // namespace

std::vector<int> close_surfaces(RawMesh& raw, const std::vector<int>& group, const std::string& file, int dimension)
{
  const bool any =
      std::any_of(raw.cells.type.begin(), raw.cells.type.end(), [&](CellType type) { return mesh::dimension(type) < dimension; });
  if (!any) return std::vector<int>(raw.cells.size(), -1);
  return Surfaces(raw, group, file, dimension).bodies();
}

}  // namespace mortise::mesh
