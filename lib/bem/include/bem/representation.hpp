// Displacements and stresses inside a body from those of its surface: Somigliana's identity
//
//     u(x) = I U t - I T u,     sigma(x) = Hooke's law of its gradient       (body without body forces; boundary_operators.hpp)
//
// with u linear and t constant on each panel. By Stokes' theorem, as for K, with m = M u and d = x - y
//
//     u(x)      = I U (t - 2 mu m) + I m / (4 pi r) - I n.d u / (4 pi r^3)
//     d_i u(x)  = I d_i U (t - 2 mu m) - I d_i m / (4 pi r^3) - I ((n.d) d_i u - n_i (d.grad) u) / (4 pi r^3):
//
// nothing is more singular than 1 / r^2, and t, m and the surface gradient of u are constant on a panel. Far panels are
// integrated by rules, near ones in closed form, so that no distance from the surface is too small. The linear field that the
// nearest panel has, which the formulas reproduce, is taken off before and added after: large rotations do no harm to stresses.
//
// In a plane -ln (r / unit) / (2 pi) stands for 1 / (4 pi r), d / (2 pi r^2) for d / (4 pi r^3); all panels are integrated in
// closed form. Plane models: plane strain; for plane stress see plane_state.hpp.
#pragma once

#include <Eigen/Core>
#include <span>
#include <utility>
#include <vector>

#include "bem/panels.hpp"
#include "bem/stress_recovery.hpp"
#include "fem/options.hpp"

namespace mortise::bem {

/// Where a point lies.
struct Location {
  bool inside;        ///< by the angle that the surface fills, 4 pi (in a plane 2 pi) inside and 0 outside
  double distance;    ///< from the surface, >= 0
  std::size_t panel;  ///< the nearest one
};

struct InteriorField {
  Eigen::MatrixXd displacement;  ///< points x 3
  Eigen::MatrixXd stress;        ///< points x 6, XX YY ZZ XY YZ XZ
};

template <int D>
class Representation;
template <int D>
Representation(const PanelsIn<D>&, const fem::Material&) -> Representation<D>;
template <int D>
Representation(const PanelsIn<D>&, const fem::Material&, double) -> Representation<D>;

template <>
class Representation<3> {
 public:
  /// Keeps a reference to `panels`. `accuracy` of the quadrature, relative to how far strains differ from those of the nearest
  /// panel.
  Representation(const Panels& panels, const fem::Material& material, double accuracy = 1e-5);

  /// Where any point lies; work grows with the number of panels.
  Location locate(const Point& x) const;

  /// At points inside or on the surface, of displacements u (3 n) and tractions t (3 m). A linear u with its t is exact. On the
  /// surface this is the limit from inside. Outside the identity does not hold and the result is no more than a continuation of
  /// the nearest panel's fields: ask locate(). Stresses in the unit of Young's modulus. As t and grad u jump between panels, the
  /// identity's stresses next to them are of first order and have a logarithm of the distance from each edge. Within a panel's
  /// size from the surface `recovered`, the stresses round the nodes (stress_recovery.hpp), replace them little by little: on the
  /// surface they are alone.
  InteriorField evaluate(std::span<const Point> points, const Eigen::VectorXd& u, const Eigen::VectorXd& t,
                         std::span<const LinearStress> recovered) const;

 private:
  static constexpr int lanes = 4;  // panels side by side
  static constexpr int rules = 4;  // of triangles, for panels that are not near
  using Lane = Eigen::Array<double, lanes, 1>;
  using Lane3 = std::array<Lane, 3>;

  // Panels that lie side by side in space; the last block repeats a panel without area.
  struct Block {
    Lane3 centre, normal;
    Lane radius, area, offset;
    std::array<std::size_t, lanes> panel;
    int size;
  };
  // Surface gradient (row: component), t - 2 mu m, m and u in the centre.
  struct Fields {
    std::array<Lane3, 3> gradient;
    Lane3 force, moment, u;
  };
  struct Nearest {
    std::size_t panel;
    double squared_distance;
  };
  struct Sum;

  Nearest nearest(const Point& x) const;
  int rule_for(const Block& block, const Point& x) const;
  std::vector<Fields> fields(const Eigen::VectorXd& u, const Eigen::VectorXd& t) const;
  void add_far(std::size_t block, int rule, const Fields& rest, const Point& x, Sum& sum) const;
  void add_near(const Block& block, const Fields& rest, const Point& x, Sum& sum) const;

  const Panels& panels_;
  fem::Material material_;
  std::array<double, rules> largest_;  // radius / distance of a panel for each rule
  std::vector<Block> blocks_;
  std::array<std::vector<Lane3>, rules> points_;  // of the rules: block * points + point
};

template <>
class Representation<2> {
 public:
  /// Keeps a reference to `panels`.
  Representation(const PlanePanels& panels, const fem::Material& material);

  /// Where any point lies; work grows with the number of panels.
  Location locate(const Point& x) const;

  /// As in space, of u (2 n) and t (2 m), for points of the plane z = 0; the stress across the plane is that of plane strain. For
  /// stresses t and du / ds are made linear on each panel: the gradient that a panel has in its middle changes along it as
  /// those of its neighbours tell, as far as there is no corner. So a linear stress is exact up to the surface, on it as well.
  /// Where stresses jump from panel to panel all the same their logarithm is cut off at a twentieth of a panel from the node.
  /// Outside, not farther than the nearest panel is long, what is found on that panel.
  InteriorField evaluate(std::span<const Point> points, const Eigen::VectorXd& u, const Eigen::VectorXd& t) const;

 private:
  struct Nearest {
    std::size_t panel;
    double squared_distance;
  };
  Nearest nearest(const Point& x) const;
  bool encloses(const Point& x) const;
  // x, or where it is on the surface or beside it outside the nearest point a little inside; and the nearest panel.
  std::pair<Point, std::size_t> evaluated_at(const Point& x) const;

  const PlanePanels& panels_;
  fem::Material material_;
  double unit_;                                   // of length
  std::vector<std::vector<std::size_t>> around_;  // panels of each node
};

}  // namespace mortise::bem
