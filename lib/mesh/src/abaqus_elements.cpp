#include "abaqus_elements.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <map>

namespace mortise::mesh {

namespace {

// The corners of each of their edge nodes, in their order.
std::vector<std::pair<int, int>> abaqus_edges(CellType type)
{
  using enum CellType;
  switch (first_order(type)) {
    case line2:
      return {};  // programs disagree about the place of the middle node: see middle_last()
    case tri3:
      return {{0, 1}, {1, 2}, {2, 0}};
    case quad4:
      return {{0, 1}, {1, 2}, {2, 3}, {3, 0}};
    case tet4:
      return {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}};
    case hex8:
      return {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5}, {5, 6}, {6, 7}, {7, 4}, {0, 4}, {1, 5}, {2, 6}, {3, 7}};
    case prism6:
      return {{0, 1}, {1, 2}, {2, 0}, {3, 4}, {4, 5}, {5, 3}, {0, 3}, {1, 4}, {2, 5}};
    default:
      return {};
  }
}

}  // namespace

ElementType element_type(const std::string& name, int dimension)
{
  using enum CellType;
  static const std::map<int, CellType> solids{{4, tet4}, {8, hex8}, {6, prism6}, {10, tet10}, {20, hex20}, {15, prism15}};
  static const std::map<int, CellType> flat{{3, tri3}, {4, quad4}, {6, tri6}, {8, quad8}, {9, quad9}};
  static const std::map<int, CellType> lines{{2, line2}, {3, line3}};
  const auto begin = std::find_if(name.begin(), name.end(), [](unsigned char c) { return std::isdigit(c); });
  auto family = name.substr(0, static_cast<std::size_t>(begin - name.begin()));
  auto rest = std::string(begin, name.end());
  for (const char* in_space : {"S", "M", "SFM", "T", "B", "R", "DC"})  // S4R, M3D4, T3D2, B31, R3D4
    if (family == in_space && rest.size() > 1 && (rest[1] == 'D' || family == "B")) {
      const bool beam = family == "B";
      rest = rest.substr(beam ? 1 : 2);
      if (beam && !rest.empty()) rest = rest[0] == '1' ? "2" : "3";
    }
  if ((family == "C" || family == "DC") && rest.size() > 1 && rest[1] == 'D') rest = rest.substr(2);
  int nodes = 0;
  std::from_chars(rest.data(), rest.data() + rest.size(), nodes);
  const auto look_up = [&](const std::map<int, CellType>& table) -> ElementType {
    const auto found = table.find(nodes);
    return found == table.end() ? ElementType{{}, false} : ElementType{found->second, true};
  };
  if (family == "C" || family == "DC") return look_up(solids);
  for (const char* plane : {"CPE", "CPS", "CAX", "CGAX", "S", "M", "SFM", "STRI", "R", "DS"})
    if (family == plane) return look_up(flat);
  for (const char* line : {"T", "B", "F"})
    if (family == line) return dimension == 2 ? look_up(lines) : ElementType{};
  for (const char* none : {"MASS", "SPRING", "SPRINGA", "DASHPOT", "DASHPOTA", "GAPUNI", "ROTARYI", "CONN"})
    if (family == none) return {};
  return {{}, false};
}

std::vector<std::vector<int>> abaqus_faces(CellType first_order)
{
  using enum CellType;
  switch (first_order) {
    case tet4:
      return {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}};
    case hex8:
      return {{0, 1, 2, 3}, {4, 7, 6, 5}, {0, 4, 5, 1}, {1, 5, 6, 2}, {2, 6, 7, 3}, {3, 7, 4, 0}};
    case prism6:
      return {{0, 1, 2}, {3, 5, 4}, {0, 3, 4, 1}, {1, 4, 5, 2}, {2, 5, 3, 0}};
    case tri3:
      return {{0, 1}, {1, 2}, {2, 0}};
    case quad4:
      return {{0, 1}, {1, 2}, {2, 3}, {3, 0}};
    default:
      return {};
  }
}

std::vector<Local> cell(CellType type, const std::vector<Local>& theirs)
{
  const auto corners = static_cast<std::size_t>(corner_count(type));
  std::vector<Local> ours(theirs.begin(), theirs.begin() + static_cast<std::ptrdiff_t>(corners));
  if (type == first_order(type)) return ours;
  ours.resize(theirs.size(), -1);
  const auto edges = abaqus_edges(type);
  for (std::size_t e = 0; e < edges.size(); ++e) {
    std::vector<int> amid{edges[e].first, edges[e].second};
    std::sort(amid.begin(), amid.end());
    ours[static_cast<std::size_t>(node_amid(type, amid))] = theirs[corners + e];
  }
  if (type == CellType::quad9) ours[8] = theirs[8];
  return ours;
}

std::vector<Local> middle_last(std::vector<Local> nodes, const std::vector<Point>& points)
{
  const auto at = [&](std::size_t i) { return points[static_cast<std::size_t>(nodes[i])]; };
  std::size_t middle = 0;
  const auto off = [&](std::size_t i) { return (2 * at(i) - at((i + 1) % 3) - at((i + 2) % 3)).norm(); };
  for (std::size_t i = 1; i < 3; ++i)
    if (off(i) < off(middle)) middle = i;
  std::swap(nodes[middle], nodes[2]);
  return nodes;
}

}  // namespace mortise::mesh
