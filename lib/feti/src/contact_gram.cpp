#include "contact_gram.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

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

}  // namespace

ContactGram::ContactGram(const JumpOperator& jump, const std::vector<std::vector<double>>& nodal_stiffness, int dimension,
                         const Communicator& comm)
    : jump_(jump), comm_(comm)
{
  const auto& ranges = jump.ranges();
  const auto count = static_cast<long long>(ranges.extra - ranges.contacts);
  first_ = comm.all_gather(std::vector<Global>{jump.contact_rows().first + static_cast<Global>(comm.offset(count))});
  const auto entries = products(nodal_stiffness, dimension);
  const bool coupled = std::any_of(entries.begin(), entries.end(), [](const Entry& e) { return e.row != e.column; });
  identity_ = !comm.any(coupled);
  if (identity_) return;
  place(entries);
  if (matrix_.rows() > 0) factor_.emplace(matrix_);
  factorize(true);
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
      entry.value += jump_.compliance()[jump_.ranges().contacts + static_cast<Local>(entry.row - mine)];
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
void ContactGram::place(const std::vector<Entry>& entries)
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
  matrix_.resize(size, size);
  matrix_.setFromTriplets(triplets.begin(), triplets.end());
  fixed_.assign(rows.size(), 0);
}

void ContactGram::fix(std::span<const Local> fixed)
{
  if (identity_) return;
  const auto& ranges = jump_.ranges();
  std::vector<char> mine(static_cast<std::size_t>(ranges.extra - ranges.contacts), 0);
  for (const Local i : fixed)
    if (i >= ranges.contacts && i < ranges.extra) mine[static_cast<std::size_t>(i - ranges.contacts)] = 1;
  std::vector<std::vector<char>> send(sent_.size());
  for (std::size_t r = 0; r < sent_.size(); ++r)
    for (const Local i : sent_[r]) send[r].push_back(mine[static_cast<std::size_t>(i - ranges.contacts)]);
  const auto flags = comm_.exchange(send);
  bool changed = false;
  for (std::size_t r = 0; r < flags.size(); ++r)
    for (std::size_t i = 0; i < flags[r].size(); ++i) {
      auto& now = fixed_[static_cast<std::size_t>(got_[r][i])];
      changed = changed || now != flags[r][i];
      now = flags[r][i];
    }
  if (comm_.any(changed)) factorize(changed);
}

// `changed`: here. Collective.
void ContactGram::factorize(bool changed)
{
  SparseMatrix free = matrix_;
  for (int c = 0; c < free.outerSize(); ++c)
    for (SparseMatrix::InnerIterator it(free, c); it; ++it)
      if (fixed_[static_cast<std::size_t>(it.row())] || fixed_[static_cast<std::size_t>(c)])
        it.valueRef() = it.row() == c ? 1 : 0;
  // Rows that depend on each other (bonded contacts round a common edge, a pair named twice) need a trace more; on all ranks the
  // same.
  const bool known = !changed && usable_;
  const double before = trace_;
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
    const Eigen::VectorXd solved = factor_->solve(right);
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

}  // namespace mortise::feti
