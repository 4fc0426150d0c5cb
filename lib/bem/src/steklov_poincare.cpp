#include "bem/steklov_poincare.hpp"

#include <Teuchos_BLAS.hpp>
#include <Teuchos_LAPACK.hpp>

#include "base/dense.hpp"
#include "base/error.hpp"
#include "bem/boundary_operators.hpp"
#include "bem/surface_stress.hpp"

namespace mortise::bem {

namespace {

constexpr double least_pivot = 1e-11;  // over the diagonal: nothing where two panels lie on each other

// U and T, D n and D m x D (D + 1): displacements that are linear in space, and their tractions.
struct LinearFields {
  Eigen::MatrixXd u, t;
};

template <int D>
LinearFields linear_fields(const PanelsIn<D>& panels, const fem::Material& material)
{
  constexpr int fields_count = D * (D + 1);
  Point low = panels.points.front(), high = low;
  for (const auto& p : panels.points) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const Point centre = (low + high) / 2, size = high - low;
  LinearFields fields{Eigen::MatrixXd(D * panels.node_count(), fields_count),
                      Eigen::MatrixXd::Zero(D * panels.size(), fields_count)};
  for (int c = 0; c < D; ++c) fields.u.col(c) = linear_field(panels, Point::Unit(c), Eigen::Matrix3d::Zero(), centre);
  for (int i = 0; i < D; ++i)
    for (int j = 0; j < D; ++j) {
      Eigen::Matrix3d gradient = Eigen::Matrix3d::Zero();
      gradient(i, j) = 1 / size[j];
      const Eigen::Matrix3d stress = hooke(material, gradient);
      const int column = D + D * i + j;
      fields.u.col(column) = linear_field(panels, Point::Zero(), gradient, centre);
      for (std::size_t p = 0; p < panels.corners.size(); ++p)
        fields.t.col(column).segment<D>(D * static_cast<Eigen::Index>(p)) = flattened<D>(stress * panels.normal[p]);
    }
  return fields;
}

BoundaryOperators operators(const Panels& panels, const fem::Material& material, double accuracy, Operators which)
{
  return boundary_operators(panels, material, accuracy, which);
}

BoundaryOperators operators(const PlanePanels& panels, const fem::Material& material, double, Operators which)
{
  return boundary_operators(panels, material, which);
}

// V and K, with which linear fields are exact.
void correct(const LinearFields& fields, const Eigen::MatrixXd& v, Eigen::MatrixXd& k)
{
  Eigen::MatrixXd lacking = v * fields.t;
  lacking -= k * fields.u;
  const Eigen::MatrixXd dual = dense::solve_symmetric(fields.u.transpose() * fields.u, fields.u.transpose());
  k.noalias() += lacking * dual;
}

// D likewise, after K: D U = M'T - K'T.
template <int D>
void correct(const LinearFields& fields, const PanelsIn<D>& panels, const Eigen::MatrixXd& k, Eigen::MatrixXd& d)
{
  const Eigen::MatrixXd dual = dense::solve_symmetric(fields.u.transpose() * fields.u, fields.u.transpose());
  Eigen::MatrixXd lacking(fields.u.rows(), fields.u.cols());
  for (Eigen::Index c = 0; c < lacking.cols(); ++c) lacking.col(c) = nodal_forces(panels, fields.t.col(c));
  lacking -= k.transpose() * fields.t;
  lacking -= d * fields.u;
  const Eigen::MatrixXd both = fields.u.transpose() * lacking;
  const Eigen::MatrixXd half = lacking * dual, mean = (both + both.transpose()) / 2;
  d += half + half.transpose();
  d.noalias() -= dual.transpose() * Eigen::MatrixXd(mean * dual);
}

// V = L L', in the lower triangle.
void factorize(Eigen::MatrixXd& v)
{
  int info = 0;
  const auto size = static_cast<int>(v.rows());
  const Eigen::VectorXd diagonal = v.diagonal();
  Teuchos::LAPACK<int, double>().POTRF('L', size, v.data(), size, &info);
  if (info != 0 || (v.diagonal().array().square() < least_pivot * diagonal.array()).any())
    throw Error(ExitStatus::bad_input,
                "the single layer of the surface is not positive definite: do faces of it cut each other or lie on each other?");
}

void solve_lower(const Eigen::MatrixXd& lower, Teuchos::ETransp transposed, Eigen::MatrixXd& b)
{
  const auto size = static_cast<int>(lower.rows());
  Teuchos::BLAS<int, double>().TRSM(Teuchos::LEFT_SIDE, Teuchos::LOWER_TRI, transposed, Teuchos::NON_UNIT_DIAG, size,
                                    static_cast<int>(b.cols()), 1.0, lower.data(), size, b.data(), size);
}

}  // namespace

template <int D>
Eigen::MatrixXd steklov_poincare(const PanelsIn<D>& panels, const fem::Material& material, double accuracy)
{
  auto [v, k, d] = operators(panels, material, accuracy, Operators::all);
  const auto fields = linear_fields(panels, material);
  correct(fields, v, k);
  correct(fields, panels, k, d);
  factorize(v);
  solve_lower(v, Teuchos::NO_TRANS, k);
  const auto n = static_cast<int>(d.rows()), m = static_cast<int>(k.rows());
  Teuchos::BLAS<int, double>().SYRK(Teuchos::LOWER_TRI, Teuchos::TRANS, n, m, 1.0, k.data(), m, 1.0, d.data(), n);
  d.template triangularView<Eigen::StrictlyUpper>() = d.transpose();
  return std::move(d);
}
template Eigen::MatrixXd steklov_poincare(const PanelsIn<2>&, const fem::Material&, double);
template Eigen::MatrixXd steklov_poincare(const PanelsIn<3>&, const fem::Material&, double);

template <int D>
Eigen::MatrixXd tractions(const PanelsIn<D>& panels, const fem::Material& material, const Eigen::MatrixXd& u, double accuracy)
{
  auto [v, k, d] = operators(panels, material, accuracy, Operators::of_tractions);
  correct(linear_fields(panels, material), v, k);
  Eigen::MatrixXd t = k * u;
  factorize(v);
  solve_lower(v, Teuchos::NO_TRANS, t);
  solve_lower(v, Teuchos::TRANS, t);
  return t;
}
template Eigen::MatrixXd tractions(const PanelsIn<2>&, const fem::Material&, const Eigen::MatrixXd&, double);
template Eigen::MatrixXd tractions(const PanelsIn<3>&, const fem::Material&, const Eigen::MatrixXd&, double);

}  // namespace mortise::bem
