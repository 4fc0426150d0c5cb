#include "rows_on_root.hpp"

#include "base/error.hpp"

namespace mortise::feti {

using Eigen::VectorXd;

// Whether all ranks have room for it is seen before any of them sends: one alone cannot stop.
std::vector<double> on_root(std::vector<double> values, const Communicator& comm)
{
  if (comm.size() == 1) return values;
  const auto arriving = static_cast<std::size_t>(comm.sum(static_cast<long long>(values.size())));
  collectively(comm, [&] {
    std::vector<double> room;
    room.reserve(values.size() + (comm.root() ? 3 * arriving : 0));  // as bytes, as numbers, and all of them
  });
  std::vector<std::vector<double>> send(static_cast<std::size_t>(comm.size()));
  send[0] = std::move(values);
  std::vector<double> all;
  for (const auto& part : comm.exchange(send)) all.insert(all.end(), part.begin(), part.end());
  return all;
}

std::vector<double> RowsOnRoot::to_root(const Eigen::Ref<const VectorXd>& own) const
{
  std::vector<double> entries;  // number and value of each row
  for (Eigen::Index i = 0; i < own.size(); ++i)
    if (const Global number = number_[static_cast<std::size_t>(i)]; number >= 0)
      entries.insert(entries.end(), {static_cast<double>(number), own[i]});
  entries = on_root(std::move(entries), comm_);
  std::vector<double> all(entries.size() / 2);
  for (std::size_t i = 0; i < entries.size(); i += 2) all[static_cast<std::size_t>(entries[i])] = entries[i + 1];
  return all;
}

VectorXd RowsOnRoot::from_root(std::vector<double> all) const
{
  comm_.broadcast(all);
  VectorXd own = VectorXd::Zero(static_cast<Eigen::Index>(number_.size()));
  for (Eigen::Index i = 0; i < own.size(); ++i)
    if (const Global number = number_[static_cast<std::size_t>(i)]; number >= 0) own[i] = all[static_cast<std::size_t>(number)];
  return own;
}

VectorXd RowsOnRoot::map_on_root(const Eigen::Ref<const VectorXd>& own, const std::function<VectorXd(const VectorXd&)>& map) const
{
  auto all = to_root(own);
  collectively(comm_, [&] {
    if (!comm_.root()) return;
    const VectorXd mapped = map(Eigen::Map<const VectorXd>(all.data(), static_cast<Eigen::Index>(all.size())));
    all.assign(mapped.begin(), mapped.end());
  });
  return from_root(std::move(all));
}

qp::FeasibleSet RowsOnRoot::to_root(const qp::FeasibleSet& set) const
{
  const auto number = [&](Local i) { return i < 0 ? -1.0 : static_cast<double>(number_[static_cast<std::size_t>(i)]); };
  std::vector<double> bounds, discs;
  for (const auto& bound : set.bounds()) bounds.insert(bounds.end(), {number(bound.index), bound.lower});
  for (const auto& disc : set.discs())
    discs.insert(discs.end(), {number(disc.index[0]), number(disc.index[1]), disc.radius, disc.centre[0], disc.centre[1],
                               number(disc.normal), disc.coefficient});
  bounds = on_root(std::move(bounds), comm_);
  discs = on_root(std::move(discs), comm_);
  std::vector<qp::Bound> all_bounds;
  std::vector<qp::Disc> all_discs;
  for (std::size_t i = 0; i < bounds.size(); i += 2) all_bounds.push_back({static_cast<Local>(bounds[i]), bounds[i + 1]});
  for (std::size_t i = 0; i < discs.size(); i += 7)
    all_discs.push_back({{static_cast<Local>(discs[i]), static_cast<Local>(discs[i + 1])},
                         discs[i + 2],
                         {discs[i + 3], discs[i + 4]},
                         static_cast<Local>(discs[i + 5]),
                         discs[i + 6]});
  return {std::move(all_bounds), std::move(all_discs)};
}

}  // namespace mortise::feti
