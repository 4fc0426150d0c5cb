#include "open_ends.hpp"

#include <fmt/format.h>

namespace mortise {

void add_open_ends(const friction::Result& solved, const Deck& deck, io::StateSummary& summary)
{
  const auto band = [](const friction::Undecided::Band& b) { return io::StateSummary::Contact::Band{b.points, b.cells}; };
  for (const auto& u : solved.undecided)
    summary.contacts[static_cast<std::size_t>(u.contact)].undecided = {band(u.rim), band(u.edge_of_stick)};
  for (const auto& s : solved.stuck)
    summary.stuck.push_back({deck.contacts[static_cast<std::size_t>(s.contact)].name,
                             s.points,
                             s.states,
                             {s.place[0], s.place[1], s.place[2]},
                             s.turns,
                             s.of});
}

void print_open_ends(const io::StateSummary& summary, Log& log)
{
  for (const auto& c : summary.contacts) {
    if (!c.undecided) continue;
    const auto& [rim, edge] = *c.undecided;
    if (rim.points > 0)
      log.line("  contact {}: rim known to {} cells; {} points may be open or closed", c.name, rim.cells, rim.points);
    if (edge.points > 0)
      log.line("  contact {}: edge of stick known to {} cells; {} points may stick or slip", c.name, edge.cells, edge.points);
  }
  for (const auto& s : summary.stuck) {
    const auto place = fmt::format("({:.5g}, {:.5g}, {:.5g})", s.place[0], s.place[1], s.place[2]);
    if (s.states == "at rest")
      log.line("  stuck: contact {}: no point changes its state any more, forces of {} points are not at rest; most at {}",
               s.contact, s.points, place);
    else
      log.line("  stuck: contact {}: {} points {} {}; most at {}, {} times in {} steps", s.contact, s.points,
               s.turns > 1 ? "take turns between" : "still change between", s.states, place, s.turns, s.steps);
  }
}

}  // namespace mortise
