// What Amesos2's interface costs: solutions with the factor of one cube of N x N x N cells by DirectSolver, which goes through
// Amesos2, beside the same sweep called as it is. CPU seconds of pairs in turn, the least of each; or, under
// `valgrind --tool=callgrind`, their instructions.
//
//     direct_solver_benchmark N COLUMNS SOLUTIONS [cholmod|cholmod_plain]
//
// Of a whole run the interface is the difference between what stands below Amesos2::SolverCore::solve and below
// SupernodalFactor::solve in
//
//     perf record --call-graph dwarf,16384 -e cpu-clock -F 400 build/release/app/mortise inputs/cantilever_3d/cantilever_3d.yaml
//     perf report --stdio --no-inline --children -g none
//
// in per cent of FaceNewton::solve. Figures: docs/design/amesos2.md.
//
//     direct_solver_benchmark dense NODES COLUMNS SOLUTIONS
//
// What products with nine dense subdomains cost, which together do not fit in a cache, beside reading what they read: half of a
// matrix.
#include <fmt/format.h>
#include <sys/resource.h>

#include <Tpetra_Core.hpp>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <limits>
#include <string>

#include "fem/stiffness.hpp"
#include "feti/dense_subdomain.hpp"
#include "feti/direct_solver.hpp"
#include "mesh/blocks.hpp"

namespace mortise::feti {
namespace {

SparseMatrix stiffness_of_cube(int cells)
{
  mesh::Options options;
  auto& cube = options.blocks["cube"];
  cube.cells = {cells, cells, cells};
  cube.size = {1, 1, 1};
  const auto mesh = mesh::generate(options, 3, 0, {0, 0, 0}, cube.cells);
  SparseMatrix k = fem::stiffness(mesh, fem::Material{2.1e5, 0.3, 0, 0}, fem::Kinematics::solid);
  k.diagonal() *= 1.001;  // K of a floating subdomain is singular
  return k;
}

double cpu_seconds()
{
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_utime.tv_sec) + 1e-6 * static_cast<double>(usage.ru_utime.tv_usec);
}

// Of `solutions` in a row, each of the same right-hand sides.
double seconds_of(const Eigen::MatrixXd& b, int solutions, const std::function<void(std::span<double* const>)>& solve)
{
  Eigen::MatrixXd x = b;
  std::vector<double*> columns;
  for (Eigen::Index c = 0; c < x.cols(); ++c) columns.push_back(x.col(c).data());
  const double start = cpu_seconds();
  for (int i = 0; i < solutions; ++i) {
    solve(columns);
    x = b;
  }
  return (cpu_seconds() - start) / solutions;
}

int compare_dense(int nodes, int columns, int solutions)
{
  constexpr int count = 9;
  const int unknowns = 3 * nodes;
  std::vector<Point> points;
  for (int i = 0; i < nodes; ++i) points.push_back(Point::Random());
  const Eigen::MatrixXd k = Eigen::MatrixXd::Identity(unknowns, unknowns);
  const Eigen::MatrixXd kernel = Eigen::Matrix3d::Identity().replicate(nodes, 1) / std::sqrt(nodes);
  std::vector<DenseSubdomain> subdomains;
  for (int i = 0; i < count; ++i) subdomains.emplace_back(k, kernel, points, 3);
  const Eigen::MatrixXd b = Eigen::MatrixXd::Random(unknowns, columns);
  const auto half = static_cast<Eigen::Index>(unknowns) * unknowns / 2;
  const std::vector<Eigen::VectorXd> numbers(count, Eigen::VectorXd::Ones(half));
  double least = std::numeric_limits<double>::infinity(), least_read = least, sum = 0;
  for (int pair = 0; pair < 5; ++pair) {
    least_read = std::min(least_read, seconds_of(b, solutions, [&](auto) {
                            for (const auto& n : numbers) sum += n.sum();
                          }));
    least = std::min(least, seconds_of(b, solutions, [&](auto x) {
                       for (const auto& s : subdomains) s.apply_inverse(x);
                     }));
  }
  fmt::print("{} dense subdomains of {} unknowns, {} columns: {:.2f} ms, reading {:.2f} ms: {:.2f} times\n", count, unknowns,
             columns, 1e3 * least, 1e3 * least_read, least / least_read);
  return sum > 0 ? 0 : 1;
}

}  // namespace
}  // namespace mortise::feti

int main(int argc, char** argv)
{
  using namespace mortise;
  if (argc < 4) return 1;
  const Tpetra::ScopeGuard tpetra(&argc, &argv);
  if (argv[1] == std::string("dense"))
    return argc < 5 ? 1 : feti::compare_dense(std::atoi(argv[2]), std::atoi(argv[3]), std::atoi(argv[4]));
  const int cells = std::atoi(argv[1]), count = std::atoi(argv[2]), solutions = std::atoi(argv[3]);
  const std::string name = argc > 4 ? argv[4] : "cholmod";
  const auto k = feti::stiffness_of_cube(cells);
  const feti::DirectSolver through(name, k, 3);
  Cholesky bare(k, 3);
  if (!bare.factorize(k)) return 1;
  if (name == "cholmod") bare.prepare_for_many_solves();
  const Eigen::MatrixXd b = Eigen::MatrixXd::Random(k.cols(), count);
  double least_through = std::numeric_limits<double>::infinity(), least_bare = least_through;
  for (int pair = 0; pair < 5; ++pair) {
    least_bare = std::min(least_bare, feti::seconds_of(b, solutions, [&](auto columns) { bare.solve(columns); }));
    least_through = std::min(least_through, feti::seconds_of(b, solutions, [&](auto columns) { through.solve(columns); }));
  }
  fmt::print("{} unknowns, {} columns, {}: bare {:.3f} ms, through Amesos2 {:.3f} ms: {:+.2f} %\n", k.cols(), count, name,
             1e3 * least_bare, 1e3 * least_through, 100 * (least_through / least_bare - 1));
  return 0;
}
