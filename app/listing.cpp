#include "listing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <set>

#include "fem/loads.hpp"
#include "mesh/curved_surface.hpp"

namespace mortise {

namespace {

std::string text(const Point& x)
{
  // No -0.
  const auto plain = [](double v) { return v == 0 ? 0.0 : v; };
  return fmt::format("({:.5g}, {:.5g}, {:.5g})", plain(x[0]), plain(x[1]), plain(x[2]));
}

// The instances but the first of each group.
std::set<std::string> further_instances(const mesh::Catalogue& catalogue)
{
  std::set<std::string> groups, further;
  for (const auto& body : catalogue.bodies)
    if (!body.instance.empty() && body.instance != body.group + ".1") further.insert(body.instance);
  return further;
}

void print_bodies(const partition::Decomposition& decomposition, const std::set<std::string>& further, const Context& context)
{
  const auto& bodies = decomposition.catalogue.bodies;
  constexpr double none = std::numeric_limits<double>::infinity();
  std::vector<double> cells(bodies.size(), 0.0), skins(bodies.size(), 0.0);
  std::vector<Point> low(bodies.size(), Point::Constant(none)), high(bodies.size(), Point::Constant(-none));
  for (const auto& subdomain : decomposition.subdomains) {
    const auto b = static_cast<std::size_t>(subdomain.body);
    cells[b] += static_cast<double>(subdomain.mesh.cells.size());
    if (subdomain.skin) skins[b] += 1;
    for (const auto& x : subdomain.mesh.points) {
      low[b] = low[b].cwiseMin(x);
      high[b] = high[b].cwiseMax(x);
    }
  }
  context.comm.sum_in_place(cells);
  context.comm.sum_in_place(skins);
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    if (further.contains(bodies[b].instance)) continue;
    for (int c = 0; c < 3; ++c) {
      low[b][c] = context.comm.min(low[b][c]);
      high[b][c] = context.comm.max(high[b][c]);
    }
    context.log.line("  body {}: {} {}, from {} to {}", bodies[b].name, cells[b], skins[b] > 0 ? "panels" : "cells", text(low[b]),
                     text(high[b]));
  }
  if (!further.empty()) context.log.line("  and {} more instances", further.size());
}

void print_boundaries(const partition::Decomposition& decomposition, const std::set<std::string>& further,
                      fem::Kinematics kinematics, const Context& context)
{
  const auto& names = decomposition.catalogue.boundaries;
  std::size_t left_out = 0;
  for (std::size_t b = 0; b < names.size(); ++b) {
    if (mesh::curved_surface(names[b])) continue;
    if (std::any_of(further.begin(), further.end(), [&](const auto& i) { return names[b].rfind(i + ".", 0) == 0; })) {
      ++left_out;
      continue;
    }
    std::vector<double> sums(7, 0.0);
    for (const auto& subdomain : decomposition.subdomains) {
      const auto m = fem::moments(subdomain.mesh, static_cast<int>(b), kinematics);
      sums[0] += m.area;
      for (std::size_t c = 0; c < 3; ++c) {
        sums[1 + c] += m.first[static_cast<Eigen::Index>(c)];
        sums[4 + c] += m.normal[static_cast<Eigen::Index>(c)];
      }
    }
    context.comm.sum_in_place(sums);
    const double area = sums[0];
    if (area == 0) {
      context.log.line("  boundary {}: empty", names[b]);
      continue;
    }
    Point centre(sums[1], sums[2], sums[3]), normal(sums[4], sums[5], sums[6]);
    const double size = centre.cwiseAbs().maxCoeff();
    for (int c = 0; c < 3; ++c) {  // what rounding leaves of a zero
      if (std::abs(centre[c]) < 1e-9 * size) centre[c] = 0;
      if (std::abs(normal[c]) < 1e-9 * area) normal[c] = 0;
    }
    context.log.line("  boundary {}: area {:.6g}, centre {}, mean normal {}", names[b], area, text(centre / area),
                     text(normal / area));
  }
  if (left_out > 0) context.log.line("  and {} more boundaries of instances", left_out);
}

}  // namespace

void print_listing(const partition::Decomposition& decomposition, fem::Kinematics kinematics, const Context& context)
{
  const auto further = further_instances(decomposition.catalogue);
  print_bodies(decomposition, further, context);
  print_boundaries(decomposition, further, kinematics, context);
}

}  // namespace mortise
