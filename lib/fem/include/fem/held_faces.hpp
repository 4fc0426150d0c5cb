// What one layer of cells of first order between two held sides lacks. All its nodes are on the sides, so that it cannot bulge,
// and the traction t that its stress leaves on a free face between the sides finds no node to balance it. Stresses are uniform,
// and recovered ones show nothing. Estimates by residuals weigh such a jump by size |t|^2 over a modulus [Verfuerth, A Posteriori
// Error Estimation Techniques for Finite Element Methods, Oxford (2013)]; how deep a layer of thickness h relieves it, the theory
// of bonded pads of rubber tells [Gent and Lindley, Proc. Instn. Mech. Engrs. 173 (1959)]: where displacements across the layer
// are a parabola, the part t of the normal stress obeys along the layer
//
//   t'' = t / d^2,   d = h sqrt(M / (12 mu)),
//
// M the modulus of uniaxial strain, mu that of shear. A free face of area A lacks with normal traction t and shear s
//
//   error^2 = A h (h t^2 / (12 d) + 0.15 s^2) / mu.
//
// On a side that nodes slide along, as in frictionless contact, cells relieve t themselves. Then displacements are linear across
// the layer where they should be a parabola, which jumps of stress between cells along it tell, t the half of a jump. With
// bricks and quadrilaterals the smaller one of d and the length of the cell serves, halved, for d.
//
// In two layers and more the nodes inside a free face relieve it; but near Poisson's ratio 0.5 cells beside a side cannot follow
// them without a change of volume, and keep their shear s. There its part counts of them, from a ratio of 0.45 to 0.49 more and
// more.
//
// Near Poisson's ratio 0.5 layers may be narrower than d, and lack no more than they have: see HeldFaceErrors::norm.
#pragma once

#include <Eigen/Core>
#include <span>

#include "fem/materials.hpp"
#include "fem/temperature.hpp"
#include "mesh/mesh.hpp"

namespace mortise::fem {

/// A face of a cell of first order that reaches from one side of its body to another one: all its nodes are held, by supports,
/// bonds or contacts.
struct HeldFace {
  Local cell;
  int face;          ///< among mesh::faces()
  Point across;      ///< unit, from one side to the other
  double traction;   ///< along its normal, that loads give to an outer face; not a number: cells lie on both sides
  bool slides;       ///< a node of it is held across its side alone
  bool ends_inside;  ///< only its nodes on one side are held: it belongs to one of several layers
};

/// Of some faces, in the squared energy norm.
struct HeldFaceErrors {
  Eigen::VectorXd squared;  ///< of each face, as if the layer went on without end
  double norm = 0;          ///< of the solution in their cells: twice the strain energy
};
/// `faces`: by cells, ascending. `recovered`: nodes x 6 blocks, whose mean is the stress between two cells. Others as in
/// squared_errors(), stress.hpp.
HeldFaceErrors errors_of_held_faces(const mesh::Mesh& mesh, const Materials& materials, Kinematics kinematics,
                                    const Eigen::VectorXd& u, const Eigen::MatrixXd& recovered, std::span<const HeldFace> faces,
                                    Formulation formulation = Formulation::standard, const Temperature& temperature_change = {});

}  // namespace mortise::fem
