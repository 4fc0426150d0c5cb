#include "initial_gaps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

namespace mortise {

namespace {

constexpr std::size_t most_lines = 40;

// 0 for what rounding leaves of it.
double plain(double gap, double touching)
{
  return std::abs(gap) <= contact::gap_rounding * touching ? 0 : gap;
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

// What is no farther than surfaces that touch but for their meshes or their fit; "" if all of it touches.
std::string near(const contact::InitialGap& gap)
{
  if (!(gap.near_area > (1 + 1e-6) * gap.touching_area)) return "";
  return fmt::format(", {:.4g} within {:.2g}", gap.near_area, gap.touching);
}

// Which side has points and fields, if not the one that the deck calls secondary.
std::string exchange(const contact::Options& contact)
{
  if (!contact.exchanged) return "";
  return fmt::format("; points and fields on {}, far softer than {}", contact.secondary, contact.primary);
}

}  // namespace

void print_initial_gaps(const std::vector<contact::InitialGap>& gaps, const model::Contacts& contacts, bool all, Log& log)
{
  std::vector<std::size_t> met;  // contacts that have points
  for (std::size_t c = 0; c < gaps.size(); ++c)
    if (gaps[c].area > 0) met.push_back(c);
  const std::size_t count = all ? met.size() : std::min(most_lines, met.size());
  for (const std::size_t c : std::span(met).first(count))
    log.line("  contact {}: initial gap {:.3g} to {:.3g}, {:.4g} of {:.4g} touches{}{}{}", contacts[c].name,
             plain(gaps[c].smallest, gaps[c].touching), plain(gaps[c].largest, gaps[c].touching), gaps[c].touching_area,
             gaps[c].area, near(gaps[c]), instead(gaps[c], contacts[c]), exchange(contacts[c]));
  if (count < met.size()) log.line("  and {} more contacts, which --check lists", met.size() - count);
}

}  // namespace mortise
