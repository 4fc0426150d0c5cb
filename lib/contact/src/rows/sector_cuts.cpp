#include "rows/sector_cuts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "base/error.hpp"
#include "contact/cyclic.hpp"
#include "integrals/overlap.hpp"

namespace mortise::contact {

namespace {

// How far cuts may be apart where their meshes alone do it.
double allowed(const PairSize& size)
{
  constexpr double part_of_side = 1e-4, part_of_face = 0.05;
  return part_of_side * size.extent + part_of_face * std::max(size.secondary_face, size.primary_face);
}

}  // namespace

void CutFit::note(double distance)
{
  if (!std::isfinite(distance)) return;
  widest = std::max(widest, distance);
  distances += distance;
  points += 1;
}

CutFit over_ranks(const CutFit& part, const Communicator& comm)
{
  return {comm.sum(part.covered), comm.max(part.widest), comm.sum(part.distances), comm.sum(part.points)};
}

void require_one_surface(const Pair& pair, const PairSize& size, const CutFit& fit, const Communicator& comm)
{
  constexpr double uncovered = 0.05;
  const auto area = [&](const mesh::Surface& side) {
    double sum = 0;
    for (std::size_t f = 0; f < side.faces.size(); ++f) sum += corners_of(side, f).area();
    return comm.sum(sum);
  };
  const double part = fit.covered / std::max(area(pair.secondary), area(*pair.primary));
  if (part >= 1 - uncovered && fit.widest <= allowed(size)) return;
  const double angle = pair.options.cyclic->angle;
  const std::string found = fit.meet() ? fmt::format("they have {:.0f} % of the larger one in common and are up to {:.3g} apart",
                                                     100 * part, fit.widest)
                                       : "they have nothing in common";
  throw Error(
      ExitStatus::bad_input,
      fmt::format("contact \"{}\": rotated by {:.6g} degrees, the primary boundary does not lie on the secondary one: {}; "
                  "try angle: {:.6g}, which turns the other way, or mend axis, center or the names of the cuts",
                  pair.options.name, angle, found, -angle));
}

bool may_be_rotated_wrongly(const Pair& pair, const PairSize& size, const CutFit& fit)
{
  return pair.options.cyclic && (!fit.meet() || fit.mean() > allowed(size));
}

Pair rotated_the_other_way(const Pair& pair)
{
  Pair result = pair;
  const auto motion = rotation_of(pair.options);
  mesh::Surface primary = *pair.primary;
  for (auto& x : primary.points)
    for (int twice = 0; twice < 2; ++twice) x = motion->rotation.transpose() * (x - motion->translation);
  result.options.cyclic->angle *= -1;
  result.primary = std::make_shared<const mesh::Surface>(std::move(primary));
  return result;
}

void require_this_way(const Pair& pair, const PairSize& size, const CutFit& fit, const CutFit& other_way)
{
  constexpr double nearer = 0.5;
  if (!other_way.meet() || (fit.meet() && other_way.mean() > nearer * fit.mean())) return;
  const double angle = pair.options.cyclic->angle;
  throw Error(
      ExitStatus::bad_input,
      fmt::format(
          "contact \"{}\": rotated by {:.6g} degrees, the primary boundary {}; rotated by {:.6g} degrees it lies {}: expected "
          "angle: {:.6g}, or the names of the cuts exchanged",
          pair.options.name, angle,
          fit.meet() ? fmt::format("lies {:.3g} from the secondary one on the average", fit.mean())
                     : std::string("does not meet the secondary one"),
          -angle, other_way.mean() > allowed(size) ? fmt::format("{:.3g} from it on the average", other_way.mean()) : "on it",
          -angle));
}

}  // namespace mortise::contact
