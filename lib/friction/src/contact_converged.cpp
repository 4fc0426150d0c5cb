#include "contact_converged.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "unresolved_nodes.hpp"

namespace mortise::friction {

namespace {

constexpr double known = 0.05;      // change of a pressure over the largest of the contact
constexpr double row_in_space = 4;  // points around n that press: a little more than 2 sqrt(pi n) at a disc of them
constexpr double row_in_planes = 2;
constexpr double part_of_row = 0.1;  // that may be open: a tenth of a cell at the rim

}  // namespace

bool contact_converged(const feti::DualProblem& problem, const Vector& x, const Vector& argument, const Vector& change)
{
  const auto& comm = problem.communicator();
  const auto& points = problem.constraints().contacts.nodes;
  const auto& bonded = problem.constraints().contacts.bonded;
  const auto value = view(x), differs = view(change), firmly = view(argument);
  int contacts = 0;
  for (const auto& point : points) contacts = std::max(contacts, point.contact + 1);
  contacts = static_cast<int>(comm.max(static_cast<long long>(contacts)));
  const auto count = static_cast<std::size_t>(contacts);
  std::vector<double> largest(count, 0.0), moved(count, 0.0), pressed(count, 0.0), undecided(count, 0.0);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (bonded[i]) continue;
    const auto& rows = problem.node_rows()[i];
    const auto c = static_cast<std::size_t>(points[i].contact);
    const double force = value[rows.normal], off = differs[rows.normal];
    pressed[c] += force > 0;
    if (points[i].cover < narrow_cover || !(points[i].area > 0)) continue;
    const double part = problem.jump().force(rows.normal, 1) / points[i].area;
    double square = off * off;
    for (int t = 1; t <= rows.tangents; ++t) square += differs[rows.normal + t] * differs[rows.normal + t];
    largest[c] = std::max(largest[c], part * force);
    moved[c] = std::max(moved[c], part * std::sqrt(square));
  }
  comm.sum_in_place(pressed);
  for (auto* values : {&largest, &moved})
    for (auto& v : *values) v = comm.max(v);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (bonded[i] || points[i].cover < narrow_cover || !(points[i].area > 0)) continue;
    const auto normal = problem.node_rows()[i].normal;
    const auto c = static_cast<std::size_t>(points[i].contact);
    const double off = std::abs(differs[normal]), pressure = problem.jump().force(normal, off) / points[i].area;
    undecided[c] += off >= std::abs(firmly[normal]) && pressure > negligible_change * largest[c];
  }
  comm.sum_in_place(undecided);
  const double all = count == 0 ? 0 : *std::max_element(largest.begin(), largest.end());
  for (std::size_t c = 0; c < count; ++c) {
    if (largest[c] < idle_pressure * all) continue;
    const double row = problem.dimension() == 3 ? row_in_space * std::sqrt(pressed[c]) : row_in_planes;
    if (moved[c] > known * largest[c] || undecided[c] > part_of_row * row) return false;
  }
  return true;
}

}  // namespace mortise::friction
