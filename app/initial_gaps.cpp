#include "initial_gaps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

namespace mortise {

namespace {

// Of an interference: an overlap of the meshes below this part of it is their error.
constexpr double part_of_interference = 0.1;
constexpr std::size_t most_lines = 40;

// 0 for what rounding leaves of it.
double plain(double gap, double touching)
{
  return std::abs(gap) < 1e-6 * touching ? 0 : gap;
}

// Where another gap was taken than that of the meshes.
std::string instead(const contact::InitialGap& gap, const contact::Options& contact)
{
  const auto in_mesh = gap.least_in_mesh <= gap.largest_in_mesh ? fmt::format(", where the meshes have gaps of {:.3g} to {:.3g}",
                                                                              gap.least_in_mesh, gap.largest_in_mesh)
                                                                : std::string();
  if (contact.clearance) return "; by `clearance`" + in_mesh;
  if (contact.adjust && !in_mesh.empty()) return "; by `adjust`" + in_mesh;
  if (gap.on_one_surface > 0)
    return fmt::format("; the two faces are one surface in the geometry: gap 0 on {:.4g}{}", gap.on_one_surface, in_mesh);
  return "";
}

// By how much the sides overlap without being told to.
double unasked_overlap(const contact::InitialGap& gap, const contact::Options& contact)
{
  if (contact.law == contact::Law::bonded || !gap.overlaps()) return 0;
  const double overlap = gap.largest_overlap();
  const double asked = contact.interference > 0 ? part_of_interference * contact.interference : -contact.interference;
  return overlap > asked ? overlap : 0;
}

Warning overlap_warning(const contact::InitialGap& gap, const contact::Options& contact)
{
  const double overlap = gap.largest_overlap();
  Warning warning{
      "overlap",
      fmt::format("contact {}: the two sides overlap by {:.3g} at ({:.5g}, {:.5g}, {:.5g}) before any load, which presses them "
                  "together and which `interference` does not ask for",
                  contact.name, overlap, gap.at[0], gap.at[1], gap.at[2]),
      fmt::format(
          "if it is the meshes' error: `adjust: {:.2g}`, or `clearance: 0` where the two fit; if it is meant: `clearance: "
          "0, interference: {:.3g}`",
          1.1 * overlap, overlap + std::max(contact.interference, 0.0))};
  warning.at = Point(gap.at[0], gap.at[1], gap.at[2]);
  warning.contact = contact.name;
  warning.value = overlap;
  return warning;
}

}  // namespace

std::vector<Warning> report_initial_gaps(const std::vector<contact::InitialGap>& gaps, const model::Contacts& contacts, bool all,
                                         Log& log)
{
  std::vector<std::size_t> met;  // contacts that have points
  for (std::size_t c = 0; c < gaps.size(); ++c)
    if (gaps[c].area > 0) met.push_back(c);
  const std::size_t count = all ? met.size() : std::min(most_lines, met.size());
  for (const std::size_t c : std::span(met).first(count))
    log.line("  contact {}: initial gap {:.3g} to {:.3g}, {:.4g} of {:.4g} touches{}", contacts[c].name,
             plain(gaps[c].smallest, gaps[c].touching), plain(gaps[c].largest, gaps[c].touching), gaps[c].touching_area,
             gaps[c].area, instead(gaps[c], contacts[c]));
  if (count < met.size()) log.line("  and {} more contacts, which --check lists", met.size() - count);

  std::erase_if(met, [&](std::size_t c) { return unasked_overlap(gaps[c], contacts[c]) == 0; });
  std::stable_sort(met.begin(), met.end(), [&](std::size_t a, std::size_t b) { return gaps[a].smallest < gaps[b].smallest; });
  std::vector<Warning> warnings;
  for (const std::size_t c : met) warnings.push_back(overlap_warning(gaps[c], contacts[c]));
  return warnings;
}

}  // namespace mortise
