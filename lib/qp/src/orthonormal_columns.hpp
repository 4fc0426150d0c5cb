// Many vectors made orthonormal at once, two sums over the ranks in place of two for each.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "base/communicator.hpp"

namespace mortise::qp {

// Q R = the columns `kept` of a matrix, Q'Q = I to 1e-8, R upper triangular.
struct OrthonormalColumns {
  Eigen::MatrixXd q, r;
  std::vector<Eigen::Index> kept;
};

// Of the matrix V whose rows on this rank are `v`. Left out are columns of which less than the part `least` is new beside those
// before them, and columns that would make the condition of V, its columns scaled to one length, larger than about 1e6. R is the
// Cholesky factor of V'V; where Q is not orthonormal by that alone, the factor of Q'Q follows [Yamamoto, Nakatsukasa, Yanagisawa
// and Fukaya, Roundoff error analysis of the CholeskyQR2 algorithm, Electron. Trans. Numer. Anal. 44 (2015)]. Collective.
OrthonormalColumns orthonormal_columns(Eigen::MatrixXd v, double least, const Communicator& comm);

}  // namespace mortise::qp
