#include "qp/active_set.hpp"

#include <cmath>
#include <limits>
#include <set>

#include "base/error.hpp"

namespace mortise::qp {

namespace {

constexpr double tiny_disc = 1e-9;  // radii below this, relative to the largest, pin their unknowns

double largest_distance(const FeasibleSet& set, const Eigen::Ref<const Eigen::VectorXd>& w, const Communicator& comm)
{
  double largest = 0;
  for (const auto& bound : set.bounds())
    if (std::isfinite(bound.lower)) largest = std::max(largest, w[bound.index] - bound.lower);
  return comm.max(largest);
}

double largest_radius(const FeasibleSet& set, const Communicator& comm)
{
  double largest = 0;
  for (const auto& disc : set.discs())
    if (std::isfinite(disc.radius)) largest = std::max(largest, disc.radius);
  return comm.max(largest);
}

// Rows of G that no free direction feels make the matrix singular; a trace of G G' does no harm, for sweeps are repeated.
CoarseMatrix::Factor factorize(CoarseMatrix& matrix, const std::vector<DowndateBlock>& downdates)
{
  for (double regularisation = 1e-13;; regularisation *= 100) {
    if (auto factor = matrix.factorize(downdates, regularisation)) return std::move(*factor);
    if (regularisation > 1e-3) throw Error(ExitStatus::not_converged, "the coarse matrix of an active set cannot be factorized");
  }
}

}  // namespace

ActiveSet::ActiveSet(Projector& projector, const FeasibleSet& set, const Vector& argument, double step,
                     std::span<const double> stiffness, double active_set_tolerance, bool coupled)
    : equality_(projector.equality())
{
  const auto w = view(argument);
  std::vector<DowndateBlock> downdates;
  const double nothing = active_set_tolerance * largest_distance(set, w, equality_.communicator());
  for (const auto& bound : set.bounds())
    if (w[bound.index] <= bound.lower + nothing) {
      fixed_.push_back(bound.index);
      ++active_bounds;
    }
  const std::set<Local> open(fixed_.begin(), fixed_.end());
  const double tiny = tiny_disc * largest_radius(set, equality_.communicator());
  for (std::size_t d = 0; d < set.discs().size(); ++d) {
    const auto& disc = set.discs()[d];
    const Eigen::Vector2d y = from_centre(disc, w);
    const double r = y.norm();
    if (r <= disc.radius && disc.radius > tiny) continue;
    ++slipping;
    const Eigen::Vector2d normal = y / std::max(r, std::numeric_limits<double>::min());
    const bool follows = coupled && disc.coefficient > 0 && disc.radius > tiny && !open.contains(disc.normal);
    if (follows) couplings_.push_back({disc.normal, disc.index, disc.coefficient * normal});
    if (disc.size() == 1 || disc.radius <= tiny) {
      fixed_.insert(fixed_.end(), disc.index.begin(), disc.index.begin() + disc.size());
      continue;
    }
    const double curvature = (r - disc.radius) / (step * disc.radius);
    slips_.push_back({disc.index, Eigen::Vector2d(-y[1], y[0]) / r, curvature});
    weights_.push_back(std::sqrt(stiffness[d] / (stiffness[d] + curvature)));
  }
  for (const Local i : fixed_) {
    auto& block = downdates.emplace_back();
    block.index[0] = i;
    block.matrix(0, 0) = 1;
  }
  for (std::size_t i = 0; i < slips_.size(); ++i) {
    const auto& tangent = slips_[i].tangent;
    auto& block = downdates.emplace_back();
    block.index = {slips_[i].index[0], slips_[i].index[1], -1};
    block.matrix.topLeftCorner<2, 2>() = Eigen::Matrix2d::Identity() - weights_[i] * weights_[i] * tangent * tangent.transpose();
  }
  factor_ = factorize(projector.matrix(), downdates);
  if (!coupled || equality_.communicator().sum(static_cast<long long>(couplings_.size())) == 0) return;
  // I - T w^2 T': what I - w^2 Pi takes away, less the rest of (1, c)(1, c)'.
  for (const auto& coupling : couplings_) {
    const Eigen::Vector3d e(coupling.direction[0], 1, coupling.direction[1]);
    auto& block = downdates.emplace_back();
    block.index = {coupling.index[0], coupling.normal, coupling.index[1]};
    block.matrix = -e * e.transpose();
    block.matrix(1, 1) = 0;
  }
  trial_factor_ = factorize(projector.trial_matrix(), downdates);
}

void ActiveSet::restrict(Vector& x, int power) const
{
  auto values = view(x);
  for (const Local i : fixed_) values[i] = 0;
  const auto scale = [power](double w) { return power == 0 ? 1 : power == 1 ? w : power == 2 ? w * w : 1 / (w * w); };
  for (std::size_t i = 0; i < slips_.size(); ++i) {
    const auto& slip = slips_[i];
    const double along = (values[slip.index[0]] * slip.tangent[0] + values[slip.index[1]] * slip.tangent[1]) * scale(weights_[i]);
    values[slip.index[0]] = along * slip.tangent[0];
    values[slip.index[1]] = along * slip.tangent[1];
  }
}

Vector ActiveSet::reduce(Vector& x) const
{
  Vector part(x, Teuchos::Copy);
  for (int repeat = 0; repeat < 2 && equality_.size() > 0; ++repeat) {
    restrict(part, 2);
    equality_.add_transpose(-1, factor_->solve(equality_.apply(part)), x);
    part.assign(x);
  }
  restrict(part, 0);
  auto values = view(part);
  for (const auto& slip : slips_) values[slip.index[0]] = values[slip.index[1]] = 0;
  return part;
}

void ActiveSet::extend(Vector& x) const
{
  auto values = view(x);
  for (const auto& coupling : couplings_)
    for (std::size_t k = 0; k < 2; ++k)
      if (coupling.index[k] >= 0)
        values[coupling.index[k]] += coupling.direction[static_cast<Eigen::Index>(k)] * values[coupling.normal];
}

void ActiveSet::extend_transpose(Vector& x) const
{
  auto values = view(x);
  for (const auto& coupling : couplings_)
    for (std::size_t k = 0; k < 2; ++k)
      if (coupling.index[k] >= 0)
        values[coupling.normal] += coupling.direction[static_cast<Eigen::Index>(k)] * values[coupling.index[k]];
}

void ActiveSet::add_constrained(double factor, const Vector& x, Vector& y) const
{
  const auto in = view(x);
  auto out = view(y);
  for (const Local i : fixed_) out[i] += factor * in[i];
  for (const auto& slip : slips_) {
    const double along = in[slip.index[0]] * slip.tangent[0] + in[slip.index[1]] * slip.tangent[1];
    for (std::size_t k = 0; k < 2; ++k)
      out[slip.index[k]] += factor * (in[slip.index[k]] - along * slip.tangent[static_cast<Eigen::Index>(k)]);
  }
  for (const auto& coupling : couplings_)
    for (std::size_t k = 0; k < 2; ++k)
      if (coupling.index[k] >= 0)
        out[coupling.index[k]] -= factor * coupling.direction[static_cast<Eigen::Index>(k)] * in[coupling.normal];
}

void ActiveSet::project_trial(Vector& x, const Vector& constrained) const
{
  restrict(x, 0);
  extend(x);
  x.update(1, constrained, 1);
  if (equality_.size() == 0) return;
  Vector part(x.getMap());
  const auto& factor = trial_factor_ ? *trial_factor_ : *factor_;
  for (int repeat = 0; repeat < 2; ++repeat) {
    const Eigen::VectorXd nu = factor.solve(equality_.apply(x));
    part.putScalar(0);
    equality_.add_transpose(1, nu, part);
    extend_transpose(part);
    restrict(part, 2);
    extend(part);
    x.update(-1, part, 1);
  }
}

void ActiveSet::scale(Vector& x) const
{
  restrict(x, 1);
}

void ActiveSet::add_curvature(const Vector& x, Vector& y) const
{
  const auto in = view(x);
  auto out = view(y);
  for (const auto& slip : slips_) {
    const double along = slip.curvature * (in[slip.index[0]] * slip.tangent[0] + in[slip.index[1]] * slip.tangent[1]);
    out[slip.index[0]] += along * slip.tangent[0];
    out[slip.index[1]] += along * slip.tangent[1];
  }
}

void ActiveSet::sweep(Vector& x, bool direction, int sweeps) const
{
  restrict(x, 0);
  if (equality_.size() == 0) return;
  for (int repeat = 0; repeat < sweeps; ++repeat) {
    if (!direction) restrict(x, 2);
    const Eigen::VectorXd nu = factor_->solve(equality_.apply(x));
    restrict(x, -2);
    equality_.add_transpose(-1, nu, x);
    restrict(x, direction ? 2 : 0);
  }
}

}  // namespace mortise::qp
