#include "sector_cuts.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.hpp"
#include "overlap.hpp"

namespace mortise::contact {

void require_one_surface(const Pair& pair, const PairSize& size, double gap, double covered, const Communicator& comm)
{
  constexpr double part_of_side = 1e-4, part_of_face = 0.05, uncovered = 0.05;
  const auto area = [&](const mesh::Surface& side) {
    double sum = 0;
    for (std::size_t f = 0; f < side.faces.size(); ++f) sum += corners_of(side, f).area();
    return comm.sum(sum);
  };
  const double part = comm.sum(covered) / std::max(area(pair.secondary), area(*pair.primary)), widest = comm.max(gap);
  const double allowed = part_of_side * size.extent + part_of_face * std::max(size.secondary_face, size.primary_face);
  if (part >= 1 - uncovered && widest <= allowed) return;
  const double angle = pair.options.cyclic->angle;
  throw Error(
      ExitStatus::bad_input,
      fmt::format("contact \"{}\": turned by {:.6g} degrees, the primary boundary does not lie on the secondary one: they have "
                  "{:.0f} % of the larger one in common and are up to {:.3g} apart; try angle: {:.6g}, which turns the "
                  "other way, or mend axis, center or the names of the cuts",
                  pair.options.name, angle, 100 * part, widest, -angle));
}

}  // namespace mortise::contact
