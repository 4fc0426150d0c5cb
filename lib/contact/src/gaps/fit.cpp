#include "contact/fit.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace mortise::contact {

namespace {

// Of equal gaps that of the first place.
void take_smallest(InitialGap& all, double gap, const std::array<double, 3>& at)
{
  if (gap > all.smallest || (gap == all.smallest && at > all.at)) return;
  all.smallest = gap;
  all.at = at;
}

void take_largest_of_meshes(InitialGap& all, double gap, const std::array<double, 3>& at)
{
  if (gap < all.mesh_largest || (gap == all.mesh_largest && at > all.mesh_largest_at)) return;
  all.mesh_largest = gap;
  all.mesh_largest_at = at;
}

}  // namespace

double touching_gap(double extent, double face)
{
  return std::min(1e-4 * extent, 1e-3 * face);
}

double starting_gap(const Options& options, double mesh_gap, bool one_surface)
{
  if (options.clearance) return *options.clearance;
  if (options.adjust) return std::abs(mesh_gap) <= *options.adjust ? 0 : mesh_gap;
  return one_surface ? 0 : mesh_gap;
}

bool asks_geometry(const Options& options)
{
  return options.law != Law::bonded && !options.obstacle && !options.clearance && !options.adjust;
}

void note_gap(InitialGap& all, double gap, double mesh_gap, bool one_surface, double area, const Point& at)
{
  take_smallest(all, gap, {at[0], at[1], at[2]});
  all.largest = std::max(all.largest, gap);
  all.area += area;
  if (gap <= gap_rounding * all.touching) all.touching_area += area;
  if (gap <= all.touching) all.near_area += area;
  if (one_surface) all.on_one_surface += area;
  all.mesh_smallest = std::min(all.mesh_smallest, mesh_gap);
  take_largest_of_meshes(all, mesh_gap, {at[0], at[1], at[2]});
  if (gap == mesh_gap) return;
  all.least_in_mesh = std::min(all.least_in_mesh, mesh_gap);
  all.largest_in_mesh = std::max(all.largest_in_mesh, mesh_gap);
}

void note_turn(InitialGap& all, double turn, double rise, const Point& at)
{
  const std::array<double, 3> place{at[0], at[1], at[2]};
  if (turn > all.turn || (turn == all.turn && turn > 0 && place < all.turn_at))
    all.turn = turn, all.rise = rise, all.turn_at = place;
}

InitialGap over_ranks(InitialGap mine, const Communicator& comm)
{
  InitialGap result;
  result.touching = mine.touching, result.face = mine.face;
  for (const auto& part : comm.all_gather(std::vector{mine})) {
    if (part.area == 0) continue;
    take_smallest(result, part.smallest, part.at);
    result.largest = std::max(result.largest, part.largest);
    result.area += part.area;
    result.touching_area += part.touching_area;
    result.near_area += part.near_area;
    result.on_one_surface += part.on_one_surface;
    result.mesh_smallest = std::min(result.mesh_smallest, part.mesh_smallest);
    take_largest_of_meshes(result, part.mesh_largest, part.mesh_largest_at);
    result.least_in_mesh = std::min(result.least_in_mesh, part.least_in_mesh);
    result.largest_in_mesh = std::max(result.largest_in_mesh, part.largest_in_mesh);
    note_turn(result, part.turn, part.rise, Point(part.turn_at.data()));
  }
  return result;
}

}  // namespace mortise::contact
