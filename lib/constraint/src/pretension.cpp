#include "constraint/pretension.hpp"

#include <fmt/format.h>

#include "base/error.hpp"

namespace mortise::constraint {

namespace {

// Length of the mean of unit normals below which a surface has no direction.
constexpr double least_mean = 0.5;

Point direction(const Contacts& contacts, const Preload& preload, bool axisymmetric, const Communicator& comm)
{
  std::vector<double> sums(4, 0.0);  // area times normal, area
  for (const auto& node : contacts.nodes) {
    if (node.contact != preload.contact) continue;
    for (int c = 0; c < 3; ++c) sums[static_cast<std::size_t>(c)] += node.area * node.normal[c];
    sums[3] += node.area;
  }
  comm.sum_in_place(sums);
  if (!(sums[3] > 0))
    throw Error(ExitStatus::bad_input, fmt::format("contact \"{}\": the two sides of its pretension section do not meet, so that "
                                                   "no bolt can be preloaded there; look at the "
                                                   "names of the boundaries or set a larger search_distance",
                                                   preload.name));
  const Point mean = Point(axisymmetric ? 0 : sums[0], sums[1], sums[2]) / sums[3];
  if (mean.norm() < least_mean)
    throw Error(ExitStatus::bad_input, fmt::format("contact \"{}\": the normals of its pretension section point all ways, so "
                                                   "that it cannot be drawn together; expected one "
                                                   "cut across the shank of a bolt{}",
                                                   preload.name, axisymmetric ? ", whose axis is the axis of revolution" : ""));
  return mean.normalized();
}

}  // namespace

std::vector<PretensionSection> find_pretension_sections(const Contacts& contacts, std::span<const Preload> preloads,
                                                        bool axisymmetric, const Communicator& comm)
{
  std::vector<PretensionSection> pretension_sections;
  for (const auto& preload : preloads) {
    PretensionSection section{preload, direction(contacts, preload, axisymmetric, comm), {}};
    for (const auto& node : contacts.nodes) {
      if (node.contact != preload.contact) continue;
      section.rows.push_back({node.row, node.weight * section.normal.dot(node.normal)});
      for (std::size_t t = 0; t < node.tangents.size(); ++t)
        section.rows.push_back({node.row + 1 + t, node.weight * section.normal.dot(node.tangents[t])});
    }
    pretension_sections.push_back(std::move(section));
  }
  return pretension_sections;
}

}  // namespace mortise::constraint
