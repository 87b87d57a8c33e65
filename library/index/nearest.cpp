#include "library/index/nearest.hpp"

#include <algorithm>
#include <mutex>
#include <tuple>

#include "runtime/machine/parallel.hpp"

namespace wale {
namespace {

/// The best rows of a part of the columns.
class BestRows {
  auto nearer() const {
    return [this](const NearRow& a, const NearRow& b) { return is_nearer(a, b); };
  }

 public:
  BestRows(const FeltColumns& columns, const Probe& probe, std::size_t most)
      : columns_(columns), probe_(probe), most_(most), limits_(columns.quantity_names().size()) {
    narrow(std::numeric_limits<double>::infinity());
  }

  void look_at(std::size_t row) {
    if (!columns_.is_built(row) || !is_within_limits(row)) return;
    if (const auto distance = probe_.distance(columns_, row, scratch_)) take({row, *distance});
  }

  void take(const NearRow& row) {
    if (rows_.size() == most_ && !is_nearer(row, rows_.front())) return;
    if (rows_.size() == most_) std::ranges::pop_heap(rows_, nearer()), rows_.pop_back();
    rows_.push_back(row);
    std::ranges::push_heap(rows_, nearer());
    if (rows_.size() == most_) narrow(rows_.front().distance.rank());
  }

  std::vector<NearRow> sorted() && {
    std::ranges::sort_heap(rows_, nearer());
    return std::move(rows_);
  }
  const std::vector<NearRow>& rows() const { return rows_; }

 private:
  bool is_within_limits(std::size_t row) const {
    const auto quantities = columns_.quantities(row);
    const auto values = columns_.values(row);
    std::size_t required = 0;
    for (std::size_t i = 0; i < quantities.size(); ++i) {
      const Limit& limit = limits_[quantities[i]];
      if (values[i] < limit.low || values[i] > limit.high) return false;  // an unknown value is neither
      required += limit.required;
    }
    return required == required_;
  }

  /// Leaves out what is farther than this.
  void narrow(double rank) {
    if (rank == narrowed_to_) return;
    narrowed_to_ = rank;
    std::vector<ValueLimit> limits(limits_.size());
    probe_.narrow(columns_, rank, limits);
    required_ = 0;
    for (std::size_t i = 0; i < limits.size(); ++i) {
      // Rounded outwards, as the values are in single precision.
      constexpr float infinite = std::numeric_limits<float>::infinity();
      limits_[i] = {std::nextafter(static_cast<float>(limits[i].low), -infinite),
                    std::nextafter(static_cast<float>(limits[i].high), infinite), !limits[i].may_be_absent};
      required_ += limits_[i].required;
    }
  }

  bool is_nearer(const NearRow& a, const NearRow& b) const {
    const double rank = a.distance.rank(), other = b.distance.rank();
    if (rank != other) return rank < other;
    return std::tuple(columns_.name(a.row), columns_.module(a.row), a.row) <
           std::tuple(columns_.name(b.row), columns_.module(b.row), b.row);
  }

  struct Limit {
    float low, high;
    bool required;
  };

  const FeltColumns& columns_;
  const Probe& probe_;
  std::size_t most_;
  std::vector<NearRow> rows_;  ///< a heap, the farthest on top
  std::vector<Limit> limits_;
  std::size_t required_ = 0;  ///< how many limits only a value keeps
  double narrowed_to_ = -1;
  Cues scratch_;
};

}  // namespace

std::vector<NearRow> nearest(const FeltColumns& columns, const Probe& probe, std::size_t most,
                             const std::function<bool(std::size_t row)>& may) {
  if (most == 0) return {};
  constexpr std::size_t too_few = 1 << 12;  // to begin a thread
  BestRows best(columns, probe, most);
  std::mutex mutex;
  const auto look = [&](std::size_t begin, std::size_t end) {
    BestRows here(columns, probe, most);
    for (std::size_t row = begin; row < end; ++row)
      if (!may || may(row)) here.look_at(row);
    const std::scoped_lock lock(mutex);
    for (const NearRow& row : here.rows()) best.take(row);
  };
  if (columns.size() < too_few)
    look(0, columns.size());
  else
    in_parallel(columns.size(), look);
  return std::move(best).sorted();
}

}  // namespace wale
