#include "mesh/extent.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.hpp"
#include "base/timer.hpp"
#include "mesh/blocks.hpp"

namespace mortise::mesh {

namespace {

constexpr double rounding = std::numeric_limits<double>::epsilon();
constexpr double allowed_rounding = 1e-6;  // of the shortest edge

[[noreturn]] void refuse(const std::string& source, const std::string& body, const std::string& what)
{
  throw Error(ExitStatus::bad_input, fmt::format("{}: body \"{}\" {}", source, body, what));
}

// At least: number and place, and a row of Cells.
constexpr double bytes_a_node = sizeof(Global) + sizeof(Point), bytes_a_cell = sizeof(Global) + 2 * sizeof(Local);
constexpr double most_numbers = 9e18, most_pieces = 6;  // 63 bits; of a grid cell as tetrahedra

[[noreturn]] void not_enough(double cells, const std::string& what, const std::string& details)
{
  throw Error(ExitStatus::machine,
              fmt::format("not enough {} for the mesh of {:.3g} cells{}; take fewer cells", what, cells, details));
}

void require_bytes(double cells, double bytes)
{
  const double room = available_memory();
  if (bytes > room)
    not_enough(cells, "memory", fmt::format(": it alone takes {:.1f} GB, and {:.1f} GB are left", bytes / 1e9, room / 1e9));
}

// Where the corners of the box are moved.
Extent moved(const Extent& extent, const std::optional<Motion>& motion)
{
  if (!motion) return extent;
  Extent result{Point::Constant(HUGE_VAL), Point::Constant(-HUGE_VAL), extent.shortest_edge};
  for (int corner = 0; corner < 8; ++corner) {
    Point x;
    for (int axis = 0; axis < 3; ++axis) x[axis] = (corner >> axis & 1) != 0 ? extent.high[axis] : extent.low[axis];
    x = (*motion)(x);
    if (!x.allFinite()) return {x, x, extent.shortest_edge};
    result.low = result.low.cwiseMin(x);
    result.high = result.high.cwiseMax(x);
  }
  return result;
}

}  // namespace

std::vector<Extent> extents(const Mesh& mesh, std::size_t bodies)
{
  std::vector<Extent> result(bodies, {Point::Constant(HUGE_VAL), Point::Constant(-HUGE_VAL), HUGE_VAL});
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    auto& extent = result[static_cast<std::size_t>(mesh.cell_body[c])];
    const auto nodes = mesh.cells[c];
    for (const Local n : nodes) {
      extent.low = extent.low.cwiseMin(mesh.points[static_cast<std::size_t>(n)]);
      extent.high = extent.high.cwiseMax(mesh.points[static_cast<std::size_t>(n)]);
    }
    for (const auto& face : faces(first_order(mesh.cells.type[c])))
      for (std::size_t i = 0; i < face.nodes.size(); ++i) {
        const auto at = [&](std::size_t k) {
          return mesh.points[static_cast<std::size_t>(nodes[static_cast<std::size_t>(face.nodes[k % face.nodes.size()])])];
        };
        extent.shortest_edge = std::min(extent.shortest_edge, (at(i + 1) - at(i)).stableNorm());
      }
  }
  return result;
}

std::vector<Extent> block_extents(const Options& options, int dimension)
{
  std::vector<Extent> result;
  for (const auto& [name, block] : options.blocks) {
    Extent extent{Point::Zero(), Point::Zero(), HUGE_VAL};
    for (int axis = 0; axis < dimension; ++axis) {
      const auto a = static_cast<std::size_t>(axis);
      extent.low[axis] = options.scale * block.origin[a];
      extent.high[axis] = options.scale * (block.origin[a] + block.size[a]);
      extent.shortest_edge = std::min(extent.shortest_edge, options.scale * block.size[a] / block.cells[a]);
    }
    result.push_back(extent);
  }
  return result;
}

void require_resolved(const Layout& layout, const std::vector<Extent>& of_parts, const std::string& source)
{
  for (std::size_t b = 0; b < layout.bodies.size(); ++b) {
    const auto& body = layout.catalogue.bodies[b].name;
    const auto extent = moved(of_parts[static_cast<std::size_t>(layout.bodies[b].part)], layout.bodies[b].motion);
    if (!extent.low.allFinite() || !extent.high.allFinite())
      refuse(source, body, "has coordinates that are no finite numbers; look at its origin, mesh.scale and instances");
    const double size = (extent.high - extent.low).maxCoeff();
    if (size > largest_size || size < smallest_size)
      refuse(source, body,
             fmt::format("is {:.3g} long; expected {:g} to {:g}: choose another unit of length, or look at mesh.scale", size,
                         smallest_size, largest_size));
    const double distance = std::max(extent.low.cwiseAbs().maxCoeff(), extent.high.cwiseAbs().maxCoeff());
    if (rounding * distance > allowed_rounding * extent.shortest_edge)
      refuse(
          source, body,
          fmt::format("lies up to {:.3g} from the origin, where numbers are {:.1g} apart, and its shortest edge is {:.3g}: move "
                      "the model nearer to the origin, or make its smallest cells larger",
                      distance, rounding * distance, extent.shortest_edge));
  }
}

void require_room(const Options& options, int dimension, bool whole)
{
  double all = 0, bytes = 0;
  for (const auto& [name, block] : options.blocks) {
    const auto type = cell_type(block.element).value();
    const double cells = 1.0 * block.cells[0] * block.cells[1] * (dimension == 3 ? block.cells[2] : 1);
    const auto copies = options.instances.find(name);
    all += cells * (copies == options.instances.end() ? 1.0 : static_cast<double>(copies->second.size()));
    bytes += cells * (bytes_a_node + bytes_a_cell + sizeof(Local) * static_cast<double>(node_count(type)));
  }
  if (8 * most_pieces * all > most_numbers) not_enough(all, "numbers", "");
  if (whole) require_bytes(all, bytes);
}

void require_room(const Catalogue& assembly, int ranks)
{
  const auto cells = static_cast<double>(assembly.cell_count), nodes = static_cast<double>(assembly.node_count);
  require_bytes(cells, (cells * (bytes_a_cell + 4 * sizeof(Local)) + nodes * bytes_a_node) / ranks);
}

}  // namespace mortise::mesh
