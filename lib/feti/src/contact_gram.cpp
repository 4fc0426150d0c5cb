#include "contact_gram.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "row_scaling.hpp"

namespace mortise::feti {

namespace {

constexpr double next_to_nothing = 1e-10;  // of entries beside the diagonal, which is 1

// Which of a list of rows hang together.
class Union {
 public:
  explicit Union(std::size_t size) : parent_(size) { std::iota(parent_.begin(), parent_.end(), std::size_t{0}); }
  std::size_t root(std::size_t i)
  {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::size_t a, std::size_t b) { parent_[std::max(root(a), root(b))] = std::min(root(a), root(b)); }

 private:
  std::vector<std::size_t> parent_;
};

std::size_t at(int i)
{
  return static_cast<std::size_t>(i);
}

// Zeros where the lower triangle of T'A T can have entries, whatever tangents T has at these pairs of unknowns.
SparseMatrix pattern_of(const SparseMatrix& a, std::span<const std::pair<int, int>> pairs)
{
  std::vector<Eigen::Triplet<double>> places;
  for (int i = 0; i < a.rows(); ++i) places.emplace_back(i, i, 1);
  for (const auto& [i, j] : pairs) places.insert(places.end(), {{i, j, 1}, {j, i, 1}});
  SparseMatrix t(a.rows(), a.rows());
  t.setFromTriplets(places.begin(), places.end());
  const SparseMatrix product = t * SparseMatrix(a.cwiseAbs()) * t;
  SparseMatrix lower = product.triangularView<Eigen::Lower>();
  std::fill_n(lower.valuePtr(), lower.nonZeros(), 0.0);
  return lower;
}

}  // namespace

ContactGram::ContactGram(const JumpOperator& jump, const std::vector<std::vector<double>>& nodal_stiffness, int dimension,
                         std::span<const qp::Disc> discs, const Communicator& comm)
    : jump_(jump), comm_(comm)
{
  const auto& ranges = jump.ranges();
  const auto count = static_cast<long long>(ranges.extra - ranges.contacts);
  first_ = comm.all_gather(std::vector<Global>{jump.contact_rows().first + static_cast<Global>(comm.offset(count))});
  auto entries = products(nodal_stiffness, dimension);
  for (const auto& disc : discs)
    if (disc.size() == 2) entries.push_back({row_of(disc.index[1]), row_of(disc.index[0]), 0});
  const bool coupled = std::any_of(entries.begin(), entries.end(), [](const Entry& e) { return e.row != e.column; });
  identity_ = !comm.any(coupled);
  if (identity_) return;
  place(entries, discs);
  factorize(true);
}

// The global number of an owned row.
Global ContactGram::row_of(Local row) const
{
  return first_[static_cast<std::size_t>(comm_.rank())] + row - jump_.ranges().contacts;
}

std::size_t ContactGram::owner(Global row) const
{
  return static_cast<std::size_t>(std::upper_bound(first_.begin(), first_.end(), row) - first_.begin()) - 1;
}

// The lower triangle over the rows that this rank owns, ascending. Collective.
std::vector<ContactGram::Entry> ContactGram::products(const std::vector<std::vector<double>>& nodal_stiffness,
                                                      int dimension) const
{
  const auto [first, end] = jump_.contact_rows();
  const auto touched = jump_.touched_rows()->getNodeElementList();
  std::vector<std::vector<Entry>> send(first_.size());
  for (std::size_t s = 0; s < jump_.blocks().size(); ++s) {
    const auto& block = jump_.blocks()[s];
    std::vector<Eigen::Triplet<double>> coefficients;
    std::vector<Global> rows;
    for (std::size_t r = 0; r < block.row.size(); ++r) {
      const Global row = touched[block.row[r]];
      if (row < first || row >= end) continue;
      for (std::size_t i = block.offset[r]; i < block.offset[r + 1]; ++i)
        coefficients.emplace_back(
            static_cast<int>(rows.size()), block.unknown[i],
            block.coefficient[i] / std::sqrt(nodal_stiffness[s][static_cast<std::size_t>(block.unknown[i] / dimension)]));
      rows.push_back(row);
    }
    if (rows.empty()) continue;
    SparseMatrix b(static_cast<int>(rows.size()), block.size);
    b.setFromTriplets(coefficients.begin(), coefficients.end());
    const SparseMatrix product = b * SparseMatrix(b.transpose());
    for (int c = 0; c < product.outerSize(); ++c)
      for (SparseMatrix::InnerIterator it(product, c); it; ++it)
        if (const Global row = rows[static_cast<std::size_t>(it.row())], column = rows[static_cast<std::size_t>(c)];
            row >= column)
          send[owner(row)].push_back({row, column, it.value()});
  }
  std::vector<Entry> parts, entries;
  for (const auto& part : comm_.exchange(send)) parts.insert(parts.end(), part.begin(), part.end());
  const auto key = [](const Entry& e) { return std::pair(e.row, e.column); };
  std::stable_sort(parts.begin(), parts.end(), [&](const Entry& a, const Entry& b) { return key(a) < key(b); });
  for (const auto& part : parts) {
    if (entries.empty() || key(entries.back()) != key(part))
      entries.push_back(part);
    else
      entries.back().value += part.value;
  }
  const Global mine = first_[static_cast<std::size_t>(comm_.rank())];
  for (auto& entry : entries)
    if (entry.row == entry.column)
      entry.value += RowScaling::compliance_of(jump_)[jump_.ranges().contacts + static_cast<Local>(entry.row - mine)];
  std::erase_if(entries, [](const Entry& e) { return e.row != e.column && !(std::abs(e.value) > next_to_nothing); });
  return entries;
}

// Of each row that has entries beside the diagonal here: {row, first row of its block}, ascending. Rows that hang together on one
// rank are joined there; first rows then travel from rank to rank. Collective.
std::vector<std::pair<Global, Global>> ContactGram::blocks_of(const std::vector<Entry>& entries) const
{
  std::vector<Global> rows;
  for (const auto& e : entries)
    if (e.row != e.column) rows.insert(rows.end(), {e.row, e.column});
  const auto unique = [&] {
    std::sort(rows.begin(), rows.end());
    rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
  };
  unique();
  // Owners hear of rows that only others' entries speak of.
  std::vector<std::vector<Global>> asked(first_.size());
  for (const Global row : rows)
    if (owner(row) != static_cast<std::size_t>(comm_.rank())) asked[owner(row)].push_back(row);
  const auto heard = comm_.exchange(asked);
  for (const auto& part : heard) rows.insert(rows.end(), part.begin(), part.end());
  unique();
  const auto place = [&](Global row) {
    return static_cast<std::size_t>(std::lower_bound(rows.begin(), rows.end(), row) - rows.begin());
  };
  Union joined(rows.size());
  for (const auto& e : entries)
    if (e.row != e.column) joined.join(place(e.row), place(e.column));
  std::vector<Global> label = rows;  // of roots
  bool changed = true;
  while (comm_.any(changed)) {
    changed = false;
    const auto lower = [&](Global row, Global to) {
      auto& now = label[joined.root(place(row))];
      changed = changed || to < now;
      now = std::min(now, to);
    };
    const auto pass = [&](const std::vector<std::vector<Global>>& from, const std::vector<std::vector<Global>>& to) {
      std::vector<std::vector<Global>> send(from.size());
      for (std::size_t r = 0; r < from.size(); ++r)
        for (const Global row : from[r]) send[r].push_back(label[joined.root(place(row))]);
      const auto got = comm_.exchange(send);
      for (std::size_t r = 0; r < to.size(); ++r)
        for (std::size_t i = 0; i < to[r].size(); ++i) lower(to[r][i], got[r][i]);
    };
    pass(asked, heard);
    pass(heard, asked);
  }
  std::vector<std::pair<Global, Global>> result;
  for (const Global row : rows) result.emplace_back(row, label[joined.root(place(row))]);
  return result;
}

// Brings the blocks to their ranks. Collective.
void ContactGram::place(const std::vector<Entry>& entries, std::span<const qp::Disc> discs)
{
  const auto blocks = blocks_of(entries);
  const auto me = static_cast<std::size_t>(comm_.rank());
  const auto target = [&](Global row) -> std::optional<std::size_t> {
    const auto found = std::lower_bound(blocks.begin(), blocks.end(), std::pair(row, std::numeric_limits<Global>::min()));
    if (found == blocks.end() || found->first != row) return {};
    return owner(found->second);
  };
  std::vector<std::vector<Entry>> send(first_.size());
  for (const auto& e : entries)
    if (const auto to = target(e.row)) send[*to].push_back(e);
  std::vector<std::vector<Global>> numbers(first_.size());
  sent_.assign(first_.size(), {});
  for (const auto& [row, block] : blocks)
    if (owner(row) == me) {
      numbers[owner(block)].push_back(row);
      sent_[owner(block)].push_back(jump_.ranges().contacts + static_cast<Local>(row - first_[me]));
    }
  std::vector<std::vector<Global>> pairs_of(first_.size());
  for (const auto& disc : discs)
    if (disc.size() == 2)
      if (const auto to = target(row_of(disc.index[0]))) pairs_of[*to].push_back(row_of(disc.index[0]));
  const auto all = comm_.exchange(numbers);
  std::vector<Global> rows;
  for (const auto& part : all) rows.insert(rows.end(), part.begin(), part.end());
  std::sort(rows.begin(), rows.end());
  const auto position = [&](Global row) {
    return static_cast<int>(std::lower_bound(rows.begin(), rows.end(), row) - rows.begin());
  };
  got_.assign(all.size(), {});
  for (std::size_t r = 0; r < all.size(); ++r)
    for (const Global row : all[r]) got_[r].push_back(position(row));
  std::vector<Eigen::Triplet<double>> triplets;
  for (const auto& part : comm_.exchange(send))
    for (const auto& e : part) triplets.emplace_back(position(e.row), position(e.column), e.value);
  const auto size = static_cast<int>(rows.size());
  SparseMatrix lower(size, size);
  lower.setFromTriplets(triplets.begin(), triplets.end());
  for (int i = 0; i < size; ++i)  // of a pair one row may have no entry, where supports hold both sides
    if (lower.coeff(i, i) == 0) lower.coeffRef(i, i) = 1;
  lower.makeCompressed();
  freedom_.assign(rows.size(), {});
  std::vector<std::pair<int, int>> pairs;
  for (const auto& part : comm_.exchange(pairs_of))
    for (const Global row : part) pairs.emplace_back(position(row), position(row + 1));
  pattern_ = pattern_of(lower.selfadjointView<Eigen::Lower>(), pairs);
  matrix_ = std::move(lower);
}

void ContactGram::fix(std::span<const Local> fixed, std::span<const qp::SlipDirection> slips)
{
  if (identity_) return;
  slips_.assign(slips.begin(), slips.end());
  const auto& ranges = jump_.ranges();
  std::vector<Freedom> mine(static_cast<std::size_t>(ranges.extra - ranges.contacts));
  for (const Local i : fixed)
    if (i >= ranges.contacts && i < ranges.extra) mine[static_cast<std::size_t>(i - ranges.contacts)] = {Freedom::none};
  for (const auto& slip : slips_)
    for (const int k : {0, 1})
      mine[static_cast<std::size_t>(slip.index[static_cast<std::size_t>(k)] - ranges.contacts)] = {
          k == 0 ? Freedom::first : Freedom::second, slip.tangent[k], slip.curvature};
  std::vector<std::vector<Freedom>> send(sent_.size());
  for (std::size_t r = 0; r < sent_.size(); ++r)
    for (const Local i : sent_[r]) send[r].push_back(mine[static_cast<std::size_t>(i - ranges.contacts)]);
  const auto got = comm_.exchange(send);
  bool changed = false;
  for (std::size_t r = 0; r < got.size(); ++r)
    for (std::size_t i = 0; i < got[r].size(); ++i) {
      auto& now = freedom_[static_cast<std::size_t>(got_[r][i])];
      changed = changed || !(now == got[r][i]);
      now = got[r][i];
    }
  if (comm_.any(changed)) factorize(changed);
}

// The unknown that a row belongs to.
int ContactGram::unknown(int row) const
{
  return freedom_[at(row)].kind == Freedom::second ? row - 1 : row;
}

// The lower triangle of T'(B D^-1 B' + E) T + Sigma, with 1 where T is zero.
SparseMatrix ContactGram::free_part() const
{
  SparseMatrix free = pattern_;
  for (int c = 0; c < matrix_.outerSize(); ++c) {
    const auto& of_column = freedom_[at(c)];
    if (of_column.kind == Freedom::none) continue;
    SparseMatrix::InnerIterator place(free, c);
    for (SparseMatrix::InnerIterator it(matrix_, c); it; ++it) {
      const auto& of_row = freedom_[at(static_cast<int>(it.row()))];
      if (of_row.kind == Freedom::none) continue;
      if (of_row.kind == Freedom::all && of_column.kind == Freedom::all) {
        while (place.row() < it.row()) ++place;
        place.valueRef() += it.value();
        continue;
      }
      const auto [column, row] = std::minmax({unknown(c), unknown(static_cast<int>(it.row()))});
      const double twice = row == column && it.row() != c ? 2 : 1;
      free.coeffRef(row, column) += twice * of_row.along * it.value() * of_column.along;
    }
  }
  for (int i = 0; i < matrix_.rows(); ++i) {
    const auto& freedom = freedom_[at(i)];
    if (freedom.kind == Freedom::none || freedom.kind == Freedom::second) free.coeffRef(i, i) = 1;
    if (freedom.kind == Freedom::first) free.coeffRef(i, i) += freedom.curvature;
  }
  return free;
}

// `changed`: here. Collective.
void ContactGram::factorize(bool changed)
{
  // Rows that depend on each other (bonded contacts round a common edge, a pair named twice) need a trace more; on all ranks the
  // same.
  const bool known = !changed && usable_;
  const double before = trace_;
  const SparseMatrix free = free_part();
  if (matrix_.rows() > 0 && !factor_) factor_.emplace(free);
  usable_ = false;
  for (double trace = 0; !usable_ && trace <= 1e-2; trace = trace == 0 ? 1e-8 : 1e2 * trace) {
    trace_ = trace;
    bool done = true;
    if (factor_ && !(known && trace == before)) {
      SparseMatrix matrix = free;
      for (int c = 0; c < matrix.outerSize(); ++c)
        for (SparseMatrix::InnerIterator it(matrix, c); it; ++it)
          if (it.row() == c) it.valueRef() *= 1 + trace;
      done = factor_->factorize(matrix);
    }
    usable_ = !comm_.any(!done);
  }
}

void ContactGram::apply_inverse(Vector& x) const
{
  if (identity_ || !usable_) return;
  const auto values = view(x);
  std::vector<std::vector<double>> send(sent_.size());
  for (std::size_t r = 0; r < sent_.size(); ++r)
    for (const Local i : sent_[r]) send[r].push_back(values[i]);
  auto parts = comm_.exchange(send);
  if (factor_) {
    Eigen::VectorXd right(matrix_.rows());
    for (std::size_t r = 0; r < parts.size(); ++r)
      for (std::size_t i = 0; i < parts[r].size(); ++i) right[got_[r][i]] = parts[r][i];
    Eigen::VectorXd felt = Eigen::VectorXd::Zero(right.size());  // T'right
    for (int i = 0; i < right.size(); ++i) felt[unknown(i)] += freedom_[at(i)].along * right[i];
    const Eigen::VectorXd x_free = factor_->solve(felt);
    Eigen::VectorXd solved(right.size());
    for (int i = 0; i < right.size(); ++i) solved[i] = freedom_[at(i)].along * x_free[unknown(i)];
    for (std::size_t r = 0; r < parts.size(); ++r)
      for (std::size_t i = 0; i < parts[r].size(); ++i) parts[r][i] = solved[got_[r][i]];
  }
  parts = comm_.exchange(parts);
  auto result = view(x);
  const auto& ranges = jump_.ranges();
  if (trace_ > 0) result.segment(ranges.contacts, ranges.extra - ranges.contacts) /= 1 + trace_;
  for (std::size_t r = 0; r < sent_.size(); ++r)
    for (std::size_t i = 0; i < sent_[r].size(); ++i) result[sent_[r][i]] = parts[r][i];
}

void ContactGram::add_curvature(const Vector& x, Vector& y) const
{
  if (!usable_) return;
  const auto in = view(x);
  auto out = view(y);
  for (const auto& slip : slips_) {
    const auto [i, j] = slip.index;
    const double force = slip.curvature * (in[i] * slip.tangent[0] + in[j] * slip.tangent[1]);
    out[i] += force * slip.tangent[0];
    out[j] += force * slip.tangent[1];
  }
}

}  // namespace mortise::feti
