#include "feti/unresolved_nodes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "pressures.hpp"

namespace mortise::feti {

namespace {

constexpr double active_set_tolerance = 1e-8;  // over the largest multiplier
constexpr double edge = 1e-6;                  // within so much of its radius a point slips
constexpr double at_rest = 0.05;               // change of a pressure over the largest of the contact that is still to come
constexpr double across = 0.7;                 // cosine of the cone that one looks through for a neighbour
constexpr double beside = 0.3;                 // cosine up to which a direction leads to another side
constexpr long probes = 64;

int contact_count(const DualProblem& problem)
{
  int count = 0;
  for (const auto& node : problem.constraints().contacts.nodes) count = std::max(count, node.contact + 1);
  return static_cast<int>(problem.communicator().max(static_cast<long long>(count)));
}

// Length of the tangential part of a point.
double tangential(const NodeRows& rows, const Eigen::Ref<const Eigen::VectorXd>& values)
{
  return rows.tangents > 0 ? values.segment(rows.normal + 1, rows.tangents).norm() : 0.0;
}

// Flags of this rank's points, as one place for each of its contacts.
int band(const DualProblem& problem, int contact, const std::vector<bool>& open)
{
  const auto& comm = problem.communicator();
  const auto& nodes = problem.constraints().contacts.nodes;
  struct Sent {
    double x, y, z, open;
  };
  std::vector<std::vector<Sent>> send(static_cast<std::size_t>(comm.size()));
  for (std::size_t i = 0; i < nodes.size(); ++i)
    if (nodes[i].contact == contact) send[0].push_back({nodes[i].at[0], nodes[i].at[1], nodes[i].at[2], open[i] ? 1.0 : 0.0});
  std::vector<BandPoint> places;
  for (const auto& part : comm.exchange(send))
    for (const auto& p : part) places.push_back({Point(p.x, p.y, p.z), p.open > 0});
  return static_cast<int>(comm.max(static_cast<long long>(comm.root() ? widest_band(places) : 0)));
}

std::vector<Undecided::Band> bands(const DualProblem& problem, std::size_t contacts, const std::vector<bool>& open)
{
  const auto& comm = problem.communicator();
  const auto& nodes = problem.constraints().contacts.nodes;
  std::vector<double> counts(contacts, 0.0);
  for (std::size_t i = 0; i < nodes.size(); ++i) counts[static_cast<std::size_t>(nodes[i].contact)] += open[i];
  comm.sum_in_place(counts);
  std::vector<Undecided::Band> result(contacts);
  for (std::size_t c = 0; c < contacts; ++c)
    if (counts[c] > 0) result[c] = {std::llround(counts[c]), band(problem, static_cast<int>(c), open)};
  return result;
}

// The place of the point with the largest value on any rank; `value` < 0 where there is none.
Point position_of_largest(const DualProblem& problem, std::size_t point, double value)
{
  const auto& comm = problem.communicator();
  const double largest = comm.max(value);
  const auto winner = comm.min(static_cast<long long>(value == largest ? comm.rank() : comm.size()));
  std::array<double, 3> at{0, 0, 0};
  if (winner == comm.rank() && value >= 0) {
    const Point& p = problem.constraints().contacts.nodes[point].at;
    at = {p[0], p[1], p[2]};
  }
  comm.sum_in_place(at);
  return {at[0], at[1], at[2]};
}

// Points of a contact with a value of at least `least`: their number, the largest value and where it is.
std::optional<Stuck> worst_points(const DualProblem& problem, int contact, const std::vector<double>& value, double least)
{
  const auto& comm = problem.communicator();
  const auto& nodes = problem.constraints().contacts.nodes;
  long long count = 0;
  std::size_t worst = 0;
  double largest = -1;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (nodes[i].contact != contact || value[i] < least) continue;
    ++count;
    if (value[i] > largest) {
      largest = value[i];
      worst = i;
    }
  }
  count = comm.sum(count);
  if (count == 0) return {};
  Stuck result;
  result.contact = contact;
  result.points = count;
  result.place = position_of_largest(problem, worst, largest);
  result.turns = static_cast<int>(comm.max(largest));
  return result;
}

}  // namespace

std::vector<ContactStatus> states_at(const DualProblem& problem, const qp::FeasibleSet& set, const Vector& x)
{
  const double least = active_set_tolerance * x.normInf();
  const auto value = view(x);
  const auto& bonded = problem.constraints().contacts.bonded;
  std::vector<ContactStatus> states;
  for (std::size_t i = 0; i < bonded.size(); ++i) {
    const auto& rows = problem.node_rows()[i];
    if (bonded[i]) {
      states.push_back(ContactStatus::sticks);
    } else if (!(value[rows.normal] > least)) {
      states.push_back(ContactStatus::open);
    } else if (rows.disc < 0) {
      states.push_back(ContactStatus::closed);
    } else {
      const auto& disc = set.discs()[static_cast<std::size_t>(rows.disc)];
      const bool slips = qp::from_centre(disc, value).norm() >= (1 - edge) * disc.radius;
      states.push_back(slips ? ContactStatus::slips : ContactStatus::sticks);
    }
  }
  return states;
}

std::vector<Undecided> undecided(const DualProblem& problem, const qp::FeasibleSet& set, const Vector& x,
                                 const qp::PredictedSolution& predicted)
{
  const auto& nodes = problem.constraints().contacts.nodes;
  const Pressures pressures(problem, x);
  const Eigen::VectorXd change = problem.forces(predicted.change), argument = problem.forces(predicted.argument);
  const auto bounds = problem.slip_bounds(set);
  std::vector<bool> rim(nodes.size(), false), edge_of_stick(nodes.size(), false);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const auto& rows = problem.node_rows()[i];
    if (pressures.idle(pressures.part_of(i))) continue;
    const double largest = pressures.largest(pressures.part_of(i));
    const double off = std::abs(change[rows.normal]), at = argument[rows.normal];
    rim[i] = pressures.of(i, off) > negligible_change * largest && off >= std::abs(at);
    if (rows.disc < 0 || rim[i] || at <= 0) continue;
    const auto disc = static_cast<std::size_t>(rows.disc);
    const double moved = tangential(rows, change) + set.discs()[disc].coefficient * off;
    edge_of_stick[i] =
        pressures.of(i, moved) > negligible_change * largest && moved >= std::abs(tangential(rows, argument) - bounds[disc]);
  }
  const auto rims = bands(problem, static_cast<std::size_t>(contact_count(problem)), rim);
  const auto edges = bands(problem, rims.size(), edge_of_stick);
  std::vector<Undecided> result;
  for (std::size_t c = 0; c < rims.size(); ++c)
    if (rims[c].points + edges[c].points > 0) result.push_back({static_cast<int>(c), rims[c], edges[c]});
  return result;
}

std::vector<Stuck> stuck(const DualProblem& problem, const StateRecord& record, const Vector& x,
                         const qp::PredictedSolution* predicted)
{
  std::vector<Stuck> result;
  const int contacts = contact_count(problem);
  const auto changes = record.changes();
  const auto count = problem.constraints().contacts.nodes.size();
  std::vector<double> contact(count, 0.0), friction(count, 0.0);
  for (std::size_t i = 0; i < changes.size(); ++i) {
    contact[i] = changes[i].contact;
    friction[i] = changes[i].friction;
  }
  for (const double least : {2.0, 1.0}) {
    for (int c = 0; c < contacts; ++c)
      for (const auto& [values, states] : {std::pair{&contact, "open/closed"}, std::pair{&friction, "stick/slip"}})
        if (auto found = worst_points(problem, c, *values, least)) {
          found->states = states;
          found->of = record.steps();
          result.push_back(std::move(*found));
        }
    if (!result.empty()) return result;
  }
  if (!predicted) return result;
  const Pressures pressures(problem, x);
  const Eigen::VectorXd change = problem.forces(predicted->change);
  std::vector<double> parts(count, 0.0);
  for (std::size_t i = 0; i < count; ++i) {
    const auto& rows = problem.node_rows()[i];
    const double largest = pressures.largest(pressures.part_of(i));
    const double moved = std::hypot(change[rows.normal], tangential(rows, change));
    if (!pressures.idle(pressures.part_of(i)) && largest > 0) parts[i] = pressures.of(i, moved) / largest;
  }
  for (int c = 0; c < contacts; ++c)
    if (auto found = worst_points(problem, c, parts, at_rest)) {
      found->states = "at rest";
      found->turns = 0;
      found->of = record.steps();
      result.push_back(std::move(*found));
    }
  return result;
}

namespace {

// Walks from point to point of one contact.
class Walk {
 public:
  explicit Walk(std::span<const BandPoint> points) : points_(points)
  {
    for (const auto& p : points) same_ = std::max(same_, 1e-9 * (p.at - points.front().at).norm());
  }

  // Unit vectors to the neighbours of a point, each the nearest of those that are not in the direction of another.
  std::vector<Point> directions(const Point& from) const
  {
    std::vector<Point> found;
    while (found.size() < 6) {
      const auto next = nearest(from, [&](const Point& way) {
        return std::none_of(found.begin(), found.end(), [&](const Point& d) { return way.dot(d) >= across * way.norm(); });
      });
      if (!next || (!found.empty() && (next->at - from).norm() > far * first_)) break;
      if (found.empty()) first_ = (next->at - from).norm();
      found.push_back((next->at - from).normalized());
    }
    return found;
  }

  // Points on the way to the next decided one, that included; nothing if the surface ends before, or is closed.
  std::optional<int> steps(Point from, Point direction) const
  {
    double before = std::numeric_limits<double>::infinity();
    for (int count = 1; count < longest; ++count) {
      const auto next = nearest(from, [&](const Point& way) { return way.dot(direction) >= across * way.norm(); });
      if (!next || (next->at - from).norm() > far * before) return {};
      if (!next->open) return count;
      before = (next->at - from).norm();
      direction = (direction + (next->at - from) / before).normalized();
      from = next->at;
    }
    return {};
  }

 private:
  static constexpr double far = 5;     // times the step before: there is no surface between
  static constexpr int longest = 100;  // walk
  template <class Fits>
  std::optional<BandPoint> nearest(const Point& from, const Fits& fits) const
  {
    std::optional<BandPoint> found;
    double least = std::numeric_limits<double>::infinity();
    for (const auto& p : points_) {
      const Point way = p.at - from;
      const double distance = way.norm();
      if (!(distance > same_) || distance >= least || !fits(way)) continue;  // points at a kink have one place
      least = distance;
      found = p;
    }
    return found;
  }

  std::span<const BandPoint> points_;
  double same_ = 0;
  mutable double first_ = 0;
};

}  // namespace

int widest_band(std::span<const BandPoint> points)
{
  const Walk walk(points);
  const auto open = std::count_if(points.begin(), points.end(), [](const BandPoint& p) { return p.open; });
  const auto stride = std::max(1L, static_cast<long>(open) / probes);
  int widest = 0;
  long seen = 0;
  for (const auto& p : points) {
    if (!p.open || seen++ % stride != 0) continue;
    const auto directions = walk.directions(p.at);
    std::vector<std::optional<int>> steps;
    for (const auto& direction : directions) steps.push_back(walk.steps(p.at, direction));
    const auto sooner = [](const auto& a, const auto& b) { return a && (!b || *a < *b); };
    const auto first = std::min_element(steps.begin(), steps.end(), sooner);
    if (first == steps.end() || !*first) continue;
    // The other side: straight on, or, at a corner of the band, beside. At the end of the surface there is none.
    const Point& way = directions[static_cast<std::size_t>(first - steps.begin())];
    auto other = walk.steps(p.at, -way);
    for (std::size_t d = 0; other && d < directions.size(); ++d)
      if (steps[d] && directions[d].dot(way) <= beside) other = std::min(*other, *steps[d]);
    widest = std::max(widest, **first + other.value_or(0));
  }
  return widest > 0 ? widest : static_cast<int>(open);  // nothing is decided anywhere near
}

}  // namespace mortise::feti
