#include "fem/held_faces.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "cell_stress.hpp"
#include "mesh/face_area.hpp"

namespace mortise::fem {

namespace {

constexpr double of_shear = 0.15;  // across the layer 0.16 at Poisson's ratio 0.3, 0.11 near 0.5; along it 0.27

constexpr double in_a_side = 0.7;  // cosine of the angle between a face and a side that it goes on as

Eigen::Matrix3d matrix_of(const Stress& s)
{
  return Eigen::Matrix3d{{s[0], s[3], s[5]}, {s[3], s[1], s[4]}, {s[5], s[4], s[2]}};
}

const mesh::Face& face_of(const mesh::Mesh& mesh, const HeldFace& face)
{
  return mesh::faces(mesh.cells.type[static_cast<std::size_t>(face.cell)])[static_cast<std::size_t>(face.face)];
}

bool is_between_cells(const HeldFace& face)
{
  return std::isnan(face.traction);
}

bool is_brick(mesh::CellType type)
{
  return type == mesh::CellType::quad4 || type == mesh::CellType::hex8;
}

// Where nodes slide, what stresses of triangles, tetrahedra and wedges jump by from cell to cell is no sign of what goes on along
// the layer. Where none does, jumps between cells are those of recovered stresses.
bool is_counted(mesh::CellType type, const HeldFace& face)
{
  return !is_between_cells(face) || (face.slides && is_brick(type));
}

struct FaceGeometry {
  Point normal = Point::Zero();  // unit, out of the cell
  double area = 0;
  double thickness = 0, length = 0;  // of the layer; of the cell, away from the face
};

FaceGeometry geometry_of(const mesh::Mesh& mesh, const HeldFace& face, Kinematics kinematics)
{
  const auto cell = mesh.cells[static_cast<std::size_t>(face.cell)];
  const auto& shape = face_of(mesh, face);
  std::vector<Local> nodes;
  for (const int k : shape.nodes) nodes.push_back(cell[static_cast<std::size_t>(k)]);
  const auto at = [&](std::size_t i) -> const Point& { return mesh.points[static_cast<std::size_t>(nodes[i])]; };
  Point vector = mesh::area_vector(mesh.points, nodes, shape.type);
  if (mesh::corner_count(shape.type) == 2) vector *= thickness(kinematics, (at(0)[0] + at(1)[0]) / 2);
  FaceGeometry result;
  result.area = vector.norm();
  if (result.area > 0) result.normal = vector / result.area;
  for (std::size_t i = 0; i < nodes.size(); ++i)
    result.thickness = std::max(result.thickness, std::abs((at(i) - at(0)).dot(face.across)));
  for (const Local n : cell)
    result.length = std::max(result.length, (at(0) - mesh.points[static_cast<std::size_t>(n)]).dot(result.normal));
  return result;
}

// The traction that the stress of its cell leaves on a face, less that which belongs there.
Point traction_left(const mesh::Mesh& mesh, const HeldFace& face, const Point& normal, const Stress& stress,
                    const Eigen::MatrixXd& recovered, std::size_t block)
{
  if (!is_between_cells(face)) return matrix_of(stress) * normal - face.traction * normal;
  const auto& nodes = face_of(mesh, face).nodes;
  Stress between = Stress::Zero();
  for (const int k : nodes) {
    const Local node = mesh.cells[static_cast<std::size_t>(face.cell)][static_cast<std::size_t>(k)];
    between += recovered.row(node).segment(6 * static_cast<Eigen::Index>(block), 6).transpose();
  }
  return matrix_of(stress - between / static_cast<double>(nodes.size())) * normal;
}

// For each material 0 up to a bulk modulus of ten times that of shear (Poisson's ratio 0.45), 1 from fifty times on (0.49).
std::vector<double> shares_of_locking(const Materials& materials, Kinematics kinematics)
{
  std::vector<double> result(materials.count(), 0.0);
  for (std::size_t m = 0; m < materials.count(); ++m) {
    const double nu = materials[m].poisson_ratio;
    const double stiffer = 2 * (1 + nu) / (3 * (1 - 2 * nu));
    if (!materials[m].orthotropic && kinematics != Kinematics::plane_stress && stiffer > 10)
      result[m] = std::min(std::log(stiffer / 10) / std::log(5.0), 1.0);
  }
  return result;
}

// What the face lacks if it is left this traction; x: a place in its cell.
double squared_error_of(const HeldFace& face, const FaceGeometry& at, const Point& traction, mesh::CellType type,
                        const Elasticity& law, const Point& x)
{
  const auto modulus = [&](const Point& direction) {
    return direction.dot(matrix_of(law.stress(direction * at.normal.transpose(), 0, x)) * at.normal);
  };
  const double shear_modulus = modulus((face.across - face.across.dot(at.normal) * at.normal).normalized());
  const double normal = traction.dot(at.normal), shear = (traction - normal * at.normal).norm();
  const double of_shear_alone = at.area * at.thickness * of_shear * shear * shear / shear_modulus;
  if (face.ends_inside) return of_shear_alone;
  double depth = at.thickness * std::sqrt(modulus(at.normal) / (12 * shear_modulus));
  if (face.slides && is_brick(type)) depth = std::min(depth, at.length) / 2;
  return at.area * at.thickness * at.thickness / (12 * depth) * normal * normal / shear_modulus + of_shear_alone;
}

}  // namespace

HeldFaceErrors errors_of_held_faces(const mesh::Mesh& mesh, const Materials& materials, Kinematics kinematics,
                                    const Eigen::VectorXd& u, const Eigen::MatrixXd& recovered, std::span<const HeldFace> faces,
                                    Formulation formulation, const Temperature& temperature_change)
{
  HeldFaceErrors result{Eigen::VectorXd::Zero(static_cast<Eigen::Index>(faces.size())), 0};
  const auto locking = shares_of_locking(materials, kinematics);
  const auto share = [&](const HeldFace& face) {
    return face.ends_inside ? locking[materials.index(static_cast<std::size_t>(face.cell))] : 1.0;
  };
  if (std::ranges::all_of(faces, [&](const HeldFace& face) { return share(face) == 0; })) return result;
  const auto visit = [&](std::size_t c, const CellGeometry& cell, const Stresses& stress, const Elasticity& law) {
    const auto own = std::ranges::equal_range(faces, static_cast<Local>(c), {}, &HeldFace::cell);
    if (own.empty()) return;
    const bool two_sided = std::ranges::any_of(own, [](const HeldFace& face) { return !face.ends_inside; });
    Stress mean = Stress::Zero();
    double volume = 0;
    for (std::size_t q = 0; q < cell.volumes().size(); ++q) {
      const Stress here = stress.col(static_cast<Eigen::Index>(q));
      mean += cell.volumes()[q] * here;
      volume += cell.volumes()[q];
      if (two_sided) result.norm += cell.volumes()[q] * law.complementary(here, place_for(law, cell, q));
    }
    mean /= volume;
    const auto type = mesh.cells.type[c];
    for (const auto& face : own) {
      const auto at = geometry_of(mesh, face, kinematics);
      if (!is_counted(type, face) || !(at.area > 0) || std::abs(face.across.dot(at.normal)) > in_a_side) continue;
      const Point left = traction_left(mesh, face, at.normal, mean, recovered, materials.index(c));
      result.squared[&face - faces.data()] = share(face) * squared_error_of(face, at, left, type, law, place_for(law, cell, 0));
    }
  };
  for_each_cell(mesh, materials, kinematics, formulation, temperature_change, u, visit);
  return result;
}

}  // namespace mortise::fem
