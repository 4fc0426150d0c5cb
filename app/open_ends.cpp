#include "open_ends.hpp"

#include <fmt/format.h>

#include <string>

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

namespace {

std::string count(long long n, const char* what)
{
  return fmt::format("{} {}{}", n, what, n == 1 ? "" : "s");
}

}  // namespace

void print_open_ends(const io::StateSummary& summary, Log& log)
{
  for (const auto& c : summary.contacts) {
    if (!c.undecided) continue;
    const auto& [rim, edge] = *c.undecided;
    if (rim.points > 0)
      log.line("  contact {}: rim known to {}; {} may be open or closed", c.name, count(rim.cells, "cell"),
               count(rim.points, "point"));
    if (edge.points > 0)
      log.line("  contact {}: edge of stick known to {}; {} may stick or slip", c.name, count(edge.cells, "cell"),
               count(edge.points, "point"));
  }
  for (const auto& s : summary.stuck) {
    const auto place = fmt::format("({:.5g}, {:.5g}, {:.5g})", s.place[0], s.place[1], s.place[2]);
    std::string what = "forces that are still to change";
    if (s.states != "at rest")
      what = fmt::format("{} between {} (there {} in {})", s.turns > 1 ? "turns" : "changes", s.states, count(s.turns, "time"),
                         count(s.steps, "step"));
    else if (s.steps > 0)
      what += fmt::format(", though none changed its state in {}", count(s.steps, "step"));
    log.line("  stuck: contact {}: {}, the worst at {}: {}", s.contact, count(s.points, "point"), place, what);
  }
}

}  // namespace mortise
