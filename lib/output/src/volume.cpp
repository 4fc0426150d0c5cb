#include "output/volume.hpp"

#include <algorithm>
#include <utility>

#include "point_fields.hpp"

namespace mortise::output {

namespace {

// A subdomain as it is shown. Node n in material k is its point n * materials + k.
class Part {
 public:
  Part(const partition::Decomposition& decomposition, std::size_t s, const post::Fields& fields, std::size_t materials)
      : subdomain_(decomposition.subdomains[s]),
        fields_(fields),
        s_(s),
        materials_(materials),
        mesh_(fields.interior.nodes.empty() ? subdomain_.mesh : post::solid(subdomain_))
  {
  }

  const partition::Subdomain& subdomain() const { return subdomain_; }
  const mesh::Mesh& mesh() const { return mesh_; }
  std::size_t points() const { return mesh_.node_count() * materials_; }
  std::size_t node(std::size_t point) const { return point / materials_; }
  Global id(std::size_t point) const
  {
    return mesh_.node_id[node(point)] * static_cast<Global>(materials_) + static_cast<Global>(point % materials_);
  }
  // Of each point whether cells of its material meet there.
  std::vector<bool> used() const
  {
    if (materials_ == 1) return std::vector<bool>(points(), true);
    std::vector<bool> result(points(), false);
    for (std::size_t c = 0; c < mesh_.cells.size(); ++c)
      for (const std::size_t p : points_of_cell(c)) result[p] = true;
    return result;
  }
  std::vector<std::size_t> points_of_cell(std::size_t cell) const
  {
    const auto material = material_of(subdomain_, fields_.stress, s_, cell);
    std::vector<std::size_t> result;
    for (const Local n : mesh_.cells[cell]) result.push_back(static_cast<std::size_t>(n) * materials_ + material);
    return result;
  }

  // The nodes after those of the subdomain's own mesh are inside a skin.
  bool is_inside(std::size_t point) const { return node(point) >= subdomain_.mesh.node_count(); }
  Point displacement(std::size_t point, const Eigen::VectorXd& nodal) const
  {
    if (is_inside(point)) return fields_.interior.nodes[s_].displacement.row(row(point)).transpose();
    const auto dimension = nodal.size() / static_cast<Eigen::Index>(subdomain_.mesh.node_count());
    Point result = Point::Zero();
    result.head(dimension) = nodal.segment(dimension * row(point), dimension);
    return result;
  }
  fem::Stress stress(std::size_t point) const
  {
    if (is_inside(point)) return fields_.interior.nodes[s_].stress.row(row(point)).transpose();
    const auto& nodal = materials_ == 1 ? fields_.stress.nodal[s_] : fields_.stress.by_material[s_];
    return nodal.row(row(point)).segment(6 * static_cast<Eigen::Index>(point % materials_), 6).transpose();
  }
  const Eigen::VectorXd& von_mises_of_cells() const
  {
    return &mesh_ == &subdomain_.mesh ? fields_.stress.cell_von_mises[s_] : fields_.interior.cell_von_mises[s_];
  }

 private:
  Eigen::Index row(std::size_t point) const
  {
    return static_cast<Eigen::Index>(is_inside(point) ? node(point) - subdomain_.mesh.node_count() : node(point));
  }

  const partition::Subdomain& subdomain_;
  const post::Fields& fields_;
  std::size_t s_, materials_;
  const mesh::Mesh& mesh_;
};

std::vector<Global> ids_of_points(const std::vector<Part>& parts)
{
  std::vector<Global> ids;
  for (const auto& part : parts) {
    const auto used = part.used();
    for (std::size_t p = 0; p < used.size(); ++p)
      if (used[p]) ids.push_back(part.id(p));
  }
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  return ids;
}

// Of each part the places of its points among `ids`; -1 for those that are not used.
std::vector<std::vector<Local>> places_of_points(const std::vector<Part>& parts, const std::vector<Global>& ids)
{
  std::vector<std::vector<Local>> places;
  for (const auto& part : parts) {
    const auto used = part.used();
    auto& place = places.emplace_back(used.size(), -1);
    for (std::size_t p = 0; p < used.size(); ++p)
      if (used[p]) place[p] = static_cast<Local>(std::lower_bound(ids.begin(), ids.end(), part.id(p)) - ids.begin());
  }
  return places;
}

// Calls visit(part, its number, point, place) for each point that is used.
template <class Visit>
void for_each_point(const std::vector<Part>& parts, const std::vector<std::vector<Local>>& places, const Visit& visit)
{
  for (std::size_t s = 0; s < parts.size(); ++s)
    for (std::size_t p = 0; p < places[s].size(); ++p)
      if (places[s][p] >= 0) visit(parts[s], s, p, static_cast<std::size_t>(places[s][p]));
}

io::Field at_points(const NodeValues& values, const std::vector<Part>& parts, const std::vector<std::vector<Local>>& places,
                    std::size_t points)
{
  const auto components = static_cast<std::size_t>(values.components);
  io::Field field{values.name, values.components, std::vector<double>(components * points, 0.0)};
  for_each_point(parts, places, [&](const Part& part, std::size_t s, std::size_t p, std::size_t at) {
    if (part.is_inside(p)) return;
    const auto row = values.of_subdomain[s].row(static_cast<Eigen::Index>(part.node(p)));
    std::copy(row.begin(), row.end(), field.values.begin() + static_cast<std::ptrdiff_t>(components * at));
  });
  return field;
}

void add_cells(const std::vector<Part>& parts, const std::vector<std::vector<Local>>& places, bool with_von_mises,
               io::Piece& piece)
{
  io::Field von_mises{"von_mises", 1, {}}, body{"body", 1, {}, true}, owner{"subdomain", 1, {}, true};
  std::vector<Local> nodes;
  for (std::size_t s = 0; s < parts.size(); ++s) {
    const auto& part = parts[s];
    for (std::size_t c = 0; c < part.mesh().cells.size(); ++c) {
      nodes.clear();
      for (const std::size_t p : part.points_of_cell(c)) nodes.push_back(places[s][p]);
      piece.cells.add(part.mesh().cells.type[c], nodes);
      von_mises.values.push_back(part.von_mises_of_cells()[static_cast<Eigen::Index>(c)]);
      body.values.push_back(part.subdomain().body);
      owner.values.push_back(static_cast<double>(part.subdomain().id));
    }
  }
  if (with_von_mises) piece.cell_fields.push_back(std::move(von_mises));
  piece.cell_fields.push_back(std::move(body));
  piece.cell_fields.push_back(std::move(owner));
}

}  // namespace

Local Volume::point(Global node, std::size_t material) const
{
  const Global id = node * static_cast<Global>(materials) + static_cast<Global>(material);
  return static_cast<Local>(std::lower_bound(ids.begin(), ids.end(), id) - ids.begin());
}

std::size_t material_of(const partition::Subdomain& subdomain, const post::StressField& stress, std::size_t s, std::size_t cell)
{
  return subdomain.skin || stress.cell_block.empty() ? 0 : static_cast<std::size_t>(stress.cell_block[s][cell]);
}

Volume make_volume(const model::Deck& deck, const partition::Decomposition& decomposition,
                   const std::vector<Eigen::VectorXd>& displacement, const post::Fields& fields,
                   const std::vector<NodeValues>& more)
{
  Volume volume;
  const auto& by_material = fields.stress.by_material;
  if (!by_material.empty()) volume.materials = static_cast<std::size_t>(by_material.front().cols()) / 6;
  std::vector<Part> parts;
  for (std::size_t s = 0; s < decomposition.subdomains.size(); ++s)
    parts.emplace_back(decomposition, s, fields, volume.materials);
  volume.ids = ids_of_points(parts);
  const auto places = places_of_points(parts, volume.ids);
  auto& piece = volume.piece;
  piece.points.resize(volume.ids.size());
  PointFields shown(deck, volume.ids.size());
  for_each_point(parts, places, [&](const Part& part, std::size_t s, std::size_t p, std::size_t at) {
    piece.points[at] = part.mesh().points[part.node(p)];
    shown.set(at, piece.points[at], part.displacement(p, displacement[s]), part.stress(p));
  });
  shown.move_to(piece);
  for (const auto& values : more) piece.point_fields.push_back(at_points(values, parts, places, volume.ids.size()));
  add_cells(parts, places, deck.output.has_field("von_mises"), piece);
  return volume;
}

}  // namespace mortise::output
