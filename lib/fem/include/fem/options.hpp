// The deck's sections `materials`, `bodies` and `loads`.
#pragma once

#include <array>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "deck/description.hpp"
#include "deck/formula.hpp"
#include "deck/local_axes.hpp"
#include "deck/place.hpp"
#include "mesh/cell.hpp"
#include "mesh/instances.hpp"

namespace mortise::fem {

/// Constants along three orthogonal directions 1, 2, 3. A stress along i strains j by -poisson_ij / E_i of it; poisson_ji / E_j =
/// poisson_ij / E_i.
struct Orthotropy {
  std::array<double, 3> young_modulus{}, poisson_ratio{}, shear_modulus{};  ///< E: 1, 2, 3; the others: 12, 13, 23
  std::optional<std::array<double, 3>> thermal_expansion;                   ///< strain per degree; none: that of the material
  std::string axes;                                                         ///< directions by name; none: those of the model
};
/// 3 x 3, one over stress: the strains 11, 22, 33 are this times the stresses 11, 22, 33.
Eigen::Matrix3d flexibility(const Orthotropy& m);

/// Linear elasticity, isotropic unless it is orthotropic. Stresses in the unit of Young's modulus.
struct Material {
  double young_modulus = 0;      ///< > 0; of an orthotropic one 0, see modulus()
  double poisson_ratio = 0;      ///< in (-1, 0.5)
  double density = 0;            ///< mass per volume; needed by accelerations only
  double thermal_expansion = 0;  ///< strain per degree
  std::optional<Orthotropy> orthotropic = {};
  std::shared_ptr<const deck::LocalAxes> directions = {};  ///< what orthotropic->axes names; none: the axes of the model

  /// Young's modulus, of an orthotropic material the smallest: what stresses and sizes are compared with.
  double modulus() const;
  /// Whether changes of temperature strain it.
  bool expands() const { return thermal_expansion != 0 || (orthotropic && orthotropic->thermal_expansion); }
};

/// Plane states have thickness 1. Axisymmetric bodies lie in x >= 0, r = x, and go once round the y axis: forces are those of the
/// whole turn; the stress ZZ is the hoop stress.
enum class Kinematics { solid, plane_strain, plane_stress, axisymmetric };

/// 3 for solids, else 2.
int dimension(Kinematics kinematics);
/// What a point at x stands for across the plane: 2 pi x in axisymmetry, else 1.
double thickness(Kinematics kinematics, double x);

/// See formulation.hpp.
enum class Formulation { standard, bbar, incompatible };

/// Whether a formulation exists for cells of this type.
bool applies(Formulation formulation, mesh::CellType type);

/// How a body is discretised: in its cells, or on its surface alone (module bem).
enum class Method { finite_elements, boundary_elements };

/// What a physical body is made of, and how it is discretised.
struct BodyOptions {
  std::string material;                          ///< of the whole body; empty: by `volumes`
  std::map<std::string, std::string> volumes;    ///< physical volumes that form the body together: the material of each
  std::vector<mesh::InstanceOptions> instances;  ///< where copies of the body are; empty: the body as it lies in the mesh
  Method method = Method::finite_elements;
  std::vector<std::string> surfaces;  ///< of boundary elements: what encloses the body, where the file has no cells of it
  Formulation formulation = Formulation::standard;  ///< of finite elements
};

/// The load of a body that turns about an axis: in plane models one along z, in axisymmetry that of revolution, y.
struct Centrifugal {
  std::array<double, 3> axis{0, 0, 1}, point{0, 0, 0};
  double speed = 0;  ///< angle per time, in radians
};

/// The acceleration that keeps x from its circle: speed^2 (x - its place on the axis).
Point centrifugal_acceleration(const Centrifugal& load, const Point& x);

/// Values at nodes or points of a file, see io/nodal_field.hpp.
struct TemperatureFile {
  std::string file;      ///< absolute by the time it gets here
  std::string field;     ///< empty: the only one, or `temperature`
  double reference = 0;  ///< the temperature without stress: what is taken from the file's
};

/// Degrees that a body is warmer than when it had no stress: a number or a formula, or what a file says.
struct TemperatureChange {
  deck::Formula formula;
  std::optional<TemperatureFile> file = {};

  bool is_constant() const { return !file && formula.is_constant(); }
};

/// One load; exactly one of the six quantities is given, `boundary` for the first three and `body` for the others. On a coupling
/// a force, a moment, or both.
struct LoadOptions {
  std::string boundary;
  std::string body;
  std::optional<deck::Formula> pressure;                 ///< force per area, positive into the body
  std::optional<std::array<deck::Formula, 3>> traction;  ///< force per area
  std::optional<std::array<double, 3>> force;            ///< resultant, spread evenly over the boundary (plane: per thickness)
  std::optional<std::array<double, 3>> acceleration;     ///< body force is density times this
  std::optional<Centrifugal> centrifugal = {};  ///< body force is density times speed squared times the distance from the axis
  std::optional<TemperatureChange> temperature_change = {};  ///< several on one body add
  std::string name = {};                                     ///< default: the boundary, the body or the coupling
  std::string coupling = {};                                 ///< its point takes `force` and `moment`
  std::optional<std::array<double, 3>> moment = {};          ///< about the point; in a plane z alone, per thickness
  std::string axes = {};                                     ///< name of local axes of a traction or a force
  std::vector<deck::Place> points = {};                      ///< instead of a boundary: the nodes that share `force`
};

/// The keywords.
void describe(deck::Description<Orthotropy>& d);
void describe(deck::Description<Material>& d);
void describe(deck::Description<BodyOptions>& d);
void describe(deck::Description<Centrifugal>& d);
void describe(deck::Description<TemperatureFile>& d);
void describe(deck::Description<LoadOptions>& d);

}  // namespace mortise::fem
