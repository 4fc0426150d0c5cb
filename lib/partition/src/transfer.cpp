#include "transfer.hpp"

#include <numeric>

#include "base/packed.hpp"

namespace mortise::partition {

namespace {

void put(const std::vector<Point>& points, PackedWriter& to)
{
  std::vector<double> numbers;
  for (const Point& x : points) numbers.insert(numbers.end(), x.begin(), x.end());
  to.numbers(numbers);
}

// Of whole numbers or names of cells.
template <class T>
void put(const std::vector<T>& values, PackedWriter& to)
{
  std::vector<Global> list;
  for (const T& value : values) list.push_back(static_cast<Global>(value));
  to.integers(list);
}

void get(std::vector<Point>& points, PackedReader& from)
{
  const auto numbers = from.numbers();
  for (std::size_t i = 0; i < numbers.size(); i += 3) points.emplace_back(numbers[i], numbers[i + 1], numbers[i + 2]);
}

template <class T>
void get(std::vector<T>& values, PackedReader& from)
{
  const auto list = from.integers();
  values.resize(list.size());
  for (std::size_t i = 0; i < list.size(); ++i) values[i] = static_cast<T>(list[i]);
}

// Visits every vector of a mesh in one fixed order.
template <class M, class Visit>
void for_each_part(M& mesh, const Visit& visit)
{
  visit(mesh.node_id);
  visit(mesh.points);
  for (auto* cells : {&mesh.cells, &mesh.facets.cells}) {
    visit(cells->type);
    visit(cells->offset);
    visit(cells->nodes);
  }
  visit(mesh.cell_id);
  visit(mesh.cell_body);
  visit(mesh.cell_volume);
  visit(mesh.facets.parent);
  visit(mesh.facets.boundary);
}

}  // namespace

std::vector<Global> deal(const std::vector<long long>& weight, const std::vector<Global>& clusters, int ranks)
{
  const auto total = static_cast<double>(std::accumulate(weight.begin(), weight.end(), 0LL));
  const auto weight_of = [&](std::size_t cluster) {
    return static_cast<double>(std::accumulate(weight.begin() + clusters[cluster], weight.begin() + clusters[cluster + 1], 0LL));
  };
  std::vector<Global> first{0};
  double sum = 0;
  std::size_t next = 0;
  for (int r = 1; r < ranks; ++r) {
    const double aim = total * r / ranks;
    while (next + 1 < clusters.size() && sum + 0.5 * weight_of(next) < aim) sum += weight_of(next++);
    first.push_back(clusters[next]);
  }
  first.push_back(clusters.back());
  return first;
}

void pack(const Subdomain& subdomain, std::vector<char>& bytes)
{
  PackedWriter writer;
  writer.integers(std::vector<Global>{subdomain.id, subdomain.body, subdomain.skin ? 1 : 0});
  for (const auto* mesh : {&subdomain.mesh, &subdomain.inside})
    for_each_part(*mesh, [&](const auto& part) { put(part, writer); });
  const auto message = writer.take();
  bytes.insert(bytes.end(), message.begin(), message.end());
}

std::vector<Subdomain> unpack(const std::vector<char>& bytes)
{
  std::vector<Subdomain> result;
  for (PackedReader reader(bytes); !reader.at_end();) {
    Subdomain subdomain;
    const auto head = reader.integers();
    subdomain.id = head[0];
    subdomain.body = static_cast<int>(head[1]);
    subdomain.skin = head[2] != 0;
    for (auto* mesh : {&subdomain.mesh, &subdomain.inside}) for_each_part(*mesh, [&](auto& part) { get(part, reader); });
    result.push_back(std::move(subdomain));
  }
  return result;
}

}  // namespace mortise::partition
