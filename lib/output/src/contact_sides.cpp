#include "output/contact_sides.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace mortise::output {

namespace {

// The gaps of a secondary side; at nodes too far from the other side to have one the largest of the faces round them.
std::vector<double> gaps_shown(const mesh::Surface& surface, const contact::SurfaceState& state)
{
  std::vector<double> result = state.gap;
  for (std::size_t f = 0; f < surface.faces.size(); ++f) {
    double largest = 0;
    for (const Local n : surface.faces[f])
      if (const auto i = static_cast<std::size_t>(n); state.near[i]) largest = std::max(largest, state.gap[i]);
    for (const Local n : surface.faces[f])
      if (const auto i = static_cast<std::size_t>(n); !state.near[i]) result[i] = std::max(result[i], largest);
  }
  return result;
}

// The faces of one side behind those of the sides before. Returns the numbers of those with a node that is near.
std::vector<std::size_t> add_faces(const mesh::Surface& surface, const std::vector<char>& near, io::Piece& piece)
{
  std::vector<std::size_t> shown;
  const auto base = static_cast<Local>(piece.points.size());
  piece.points.insert(piece.points.end(), surface.points.begin(), surface.points.end());
  for (std::size_t f = 0; f < surface.faces.size(); ++f) {
    std::vector<Local> nodes(surface.faces[f].begin(), surface.faces[f].end());
    if (std::any_of(nodes.begin(), nodes.end(), [&](Local n) { return near[static_cast<std::size_t>(n)] != 0; }))
      shown.push_back(piece.cells.size());
    for (auto& n : nodes) n += base;
    piece.cells.add(surface.faces.type[f], nodes);
  }
  return shown;
}

void add_values(const std::vector<double>& values, io::Field& field)
{
  field.values.insert(field.values.end(), values.begin(), values.end());
}

void add_vectors(const std::vector<Point>& vectors, io::Field& field)
{
  for (const auto& v : vectors) field.values.insert(field.values.end(), v.begin(), v.end());
}

}  // namespace

io::Piece contact_sides(std::span<const contact::Pair> pairs, std::span<const contact::SurfaceState> states)
{
  io::Piece piece;
  io::Field pressure{"contact_pressure", 1, {}}, recovered{"contact_pressure_recovered", 1, {}},
      traction{"contact_traction", 3, {}}, gap{"gap", 1, {}}, slip{"slip", 3, {}}, status{"contact_status", 1, {}, true},
      index{"contact", 1, {}, true};
  std::vector<std::string> names;
  std::vector<std::size_t> shown;
  for (std::size_t c = 0; c < pairs.size(); ++c) {
    const auto& surface = pairs[c].secondary;
    const auto& state = states[c];
    names.push_back(fmt::format("{}: {}", c, pairs[c].options.name));
    for (const std::size_t f : add_faces(surface, state.near, piece)) shown.push_back(f);
    index.values.resize(piece.cells.size(), static_cast<double>(c));
    add_values(state.pressure, pressure);
    add_values(state.recovered_pressure, recovered);
    add_vectors(state.traction, traction);
    add_values(gaps_shown(surface, state), gap);
    add_vectors(state.slip, slip);
    status.values.insert(status.values.end(), state.status.begin(), state.status.end());
  }
  piece.point_fields = {pressure, recovered, traction, gap, slip, status};
  piece.cell_fields = {index};
  piece.words = {{"contact_status: words", {"0: open", "1: sticks, or closed without friction", "2: slips"}},
                 {"contact: names", std::move(names)}};
  return io::part_of(piece, shown);
}

}  // namespace mortise::output
