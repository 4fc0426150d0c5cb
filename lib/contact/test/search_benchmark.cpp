// How long the search takes, and what memory: two surfaces of n x n faces whose meshes do not match, flat or curved, or one ring
// that is the primary side of many rollers. Prints a sum over the bits of all rows that must not depend on the ranks.
//
//     search_benchmark flat|curved N        two surfaces of N x N faces
//     search_benchmark ring N ROLLERS       a ring of N x ROLLERS by 40 faces under ROLLERS rollers of N x 40
#include <fmt/format.h>
#include <sys/resource.h>

#include <bit>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <map>
#include <numbers>
#include <string>

#include "contact/mortar.hpp"

namespace mortise::contact {
namespace {

// (n + 1) x (m + 1) nodes at place(i / n, j / m); each rank holds a band of the faces.
mesh::Surface surface(int n, int m, Global first, const std::function<Point(double, double)>& place, const Communicator& comm)
{
  mesh::Surface result;
  const int begin = static_cast<int>(static_cast<long long>(n) * comm.rank() / comm.size());
  const int end = static_cast<int>(static_cast<long long>(n) * (comm.rank() + 1) / comm.size());
  const auto id = [&](int i, int j) { return first + static_cast<Global>(i) * (m + 1) + j; };
  if (begin == end) return result;
  for (int i = begin; i <= end; ++i)
    for (int j = 0; j <= m; ++j) {
      result.node_id.push_back(id(i, j));
      result.points.push_back(place(static_cast<double>(i) / n, static_cast<double>(j) / m));
    }
  const auto local = [&](int i, int j) { return static_cast<Local>((i - begin) * (m + 1) + j); };
  for (int i = begin; i < end; ++i)
    for (int j = 0; j < m; ++j) {
      const std::vector<Local> nodes{local(i, j), local(i + 1, j), local(i + 1, j + 1), local(i, j + 1)};
      result.faces.add(mesh::CellType::quad4, nodes);
      result.face_id.push_back(id(i, j));
      result.body.push_back(0);
    }
  return result;
}

std::vector<Pair> two_surfaces(bool curved, int n, const Communicator& comm)
{
  const auto lower = [=](double s, double t) {
    const double x = 1 - s, y = t;
    return Point(x, y, curved ? -0.3 * (x - 0.5) * (x - 0.5) - 0.2 * (y - 0.4) * (y - 0.4) : 0);
  };
  const auto upper = [=](double s, double t) { return Point(s, t, lower(1 - s, t)[2] + 1e-3); };
  Options options;
  options.law = Law::coulomb;
  // The lower one looks down and is turned over by its first coordinate.
  return {{options,
           surface(
               n, n, 0, [&](double s, double t) { return upper(s, t); }, comm),
           std::make_shared<const mesh::Surface>(surface(n + 7, n - 5, 1'000'000'000, lower, comm))}};
}

std::vector<Pair> ring(int n, int rollers, const Communicator& comm)
{
  const double pi = std::numbers::pi, radius = 100, small = 0.8 * pi * radius / rollers;
  const auto inside = [&](double s, double t) {
    return Point(radius * std::cos(2 * pi * s), radius * std::sin(2 * pi * s), 10 * t);
  };
  std::vector<Pair> pairs;
  const auto whole = std::make_shared<const mesh::Surface>(surface(
      n * rollers, 40, 1'000'000'000, [&](double s, double t) { return inside(-s, t); }, comm));
  for (int r = 0; r < rollers; ++r) {
    const double angle = 2 * pi * r / rollers;
    const Point centre((radius - small) * std::cos(angle), (radius - small) * std::sin(angle), 0);
    const auto roller = [&](double s, double t) {
      return Point(centre + Point(small * std::cos(2 * pi * s), small * std::sin(2 * pi * s), 10 * t));
    };
    Options options;
    options.search_distance = 0.3 * small;
    pairs.push_back({options, surface(n, 40, static_cast<Global>(r) * 1'000'000, roller, comm), whole});
  }
  return pairs;
}

unsigned long long mix(unsigned long long x)
{
  x ^= x >> 33U;
  x *= 0xff51afd7ed558ccdULL;
  x ^= x >> 33U;
  return x;
}

// Of all rows, in any order of the rows.
unsigned long long digest(const constraint::Contacts& contacts, const Communicator& comm)
{
  unsigned long long sum = 0;
  for (const auto& point : contacts.nodes)
    for (std::size_t r = point.row; r <= point.row + point.tangents.size(); ++r) {
      unsigned long long row = mix(static_cast<unsigned long long>(point.node) + 17 * static_cast<unsigned>(point.contact));
      const auto add = [&](double x) { row = mix(row * 31 + std::bit_cast<unsigned long long>(x)); };
      add(point.area);
      add(contacts.rows.bound[r]);
      for (const auto& e : contacts.rows[r]) {
        add(static_cast<double>(e.node) * 4 + e.component);
        add(e.coefficient);
      }
      sum += row;
    }
  unsigned long long total = 0;
  for (const auto part : comm.all_gather(std::vector{sum})) total += part;
  return total;
}

double processor_seconds()
{
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_utime.tv_sec) + 1e-6 * static_cast<double>(usage.ru_utime.tv_usec);
}

int run(int argc, char** argv)
{
  const Communicator comm;
  const std::string kind = argc > 1 ? argv[1] : "curved";
  const int n = argc > 2 ? std::atoi(argv[2]) : 316;
  const auto pairs = kind == "ring" ? ring(n, argc > 3 ? std::atoi(argv[3]) : 70, comm) : two_surfaces(kind == "curved", n, comm);
  const auto peak = [&] {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return comm.max(static_cast<double>(usage.ru_maxrss) / 1024);
  };
  const double memory = peak(), start = MPI_Wtime(), cpu = processor_seconds();
  const auto contacts = discretize(pairs, {}, fem::Kinematics::solid, comm);
  const double seconds = comm.max(MPI_Wtime() - start), busy = comm.max(processor_seconds() - cpu), after = peak();
  const auto points = comm.sum(static_cast<long long>(contacts.nodes.size()));
  const auto sum = digest(contacts, comm);
  if (comm.root())
    fmt::print(
        "{} {}: {} points, {:.2f} s ({:.2f} s of the processor) on {} ranks, peak {:.0f} MB a rank, {:.0f} MB before; rows "
        "{:016x}\n",
        kind, n, points, seconds, busy, comm.size(), after, memory, sum);
  return 0;
}

}  // namespace
}  // namespace mortise::contact

int main(int argc, char** argv)
{
  MPI_Init(&argc, &argv);
  const int status = mortise::contact::run(argc, argv);
  MPI_Finalize();
  return status;
}
