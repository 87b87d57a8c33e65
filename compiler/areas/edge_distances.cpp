#include "compiler/areas/edge_distances.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace wale {
namespace {

template <class Id>
class EdgeDistances {
 public:
  EdgeDistances(std::span<const Id> numbers, std::size_t width, std::size_t height)
      : numbers_(numbers), width_(static_cast<int>(width)), height_(static_cast<int>(height)) {
    measure_columns();
    for (int y = 0; y < height_; ++y)
      for (int begin = 0; begin < width_;) {
        int end = begin + 1;
        while (end < width_ && number(end, y) == number(begin, y)) ++end;
        measure_run(begin, end, y);
        begin = end;
      }
  }

  std::vector<double> taken() { return std::move(squared_); }

 private:
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
  }
  Id number(int x, int y) const { return numbers_[index(x, y)]; }

  /// The distance up or down to another number.
  void measure_columns() {
    up_or_down_.resize(numbers_.size());
    for (int x = 0; x < width_; ++x) {
      for (int y = 0; y < height_; ++y)
        up_or_down_[index(x, y)] = y > 0 && number(x, y - 1) == number(x, y) ? up_or_down_[index(x, y - 1)] + 1 : 1;
      for (int y = height_ - 2; y >= 0; --y)
        if (number(x, y + 1) == number(x, y))
          up_or_down_[index(x, y)] = std::min(up_or_down_[index(x, y)], up_or_down_[index(x, y + 1)] + 1);
        else
          up_or_down_[index(x, y)] = 1;
    }
    squared_.resize(numbers_.size());
  }

  /// Columns begin up to but not including end of a row have one number. Behind the ends, another one begins, and no
  /// place beyond is nearer: the distance is the lower envelope of a parabola for each column (Felzenszwalb and
  /// Huttenlocher 2012, Distance transforms of sampled functions).
  void measure_run(int begin, int end, int y) {
    places_.clear(), starts_.clear();
    for (int x = begin - 1; x <= end; ++x) {
      const double height = height_at(x, begin, end, y);
      double start = -std::numeric_limits<double>::infinity();
      while (!places_.empty()) {
        const double other = places_.back(), of_other = height_at(places_.back(), begin, end, y);
        start = (height + 1.0 * x * x - of_other - other * other) / (2 * (x - other));
        if (start > starts_.back()) break;
        places_.pop_back(), starts_.pop_back();
        start = -std::numeric_limits<double>::infinity();
      }
      places_.push_back(x), starts_.push_back(start);
    }
    std::size_t lowest = 0;
    for (int x = begin; x < end; ++x) {
      while (lowest + 1 < places_.size() && starts_[lowest + 1] <= x) ++lowest;
      const double away = x - places_[lowest];
      squared_[index(x, y)] = away * away + height_at(places_[lowest], begin, end, y);
    }
  }

  double height_at(int x, int begin, int end, int y) const {
    if (x < begin || x >= end) return 0;
    const double distance = up_or_down_[index(x, y)];
    return distance * distance;
  }

  std::span<const Id> numbers_;
  int width_, height_;
  std::vector<int> up_or_down_;
  std::vector<double> squared_;
  std::vector<int> places_;     ///< of the parabolas of the envelope
  std::vector<double> starts_;  ///< from which on each is the lowest
};

}  // namespace

template <class Id>
std::vector<double> squared_edge_distances(std::span<const Id> numbers, std::size_t width, std::size_t height) {
  return EdgeDistances<Id>(numbers, width, height).taken();
}

template std::vector<double> squared_edge_distances(std::span<const std::uint8_t>, std::size_t, std::size_t);
template std::vector<double> squared_edge_distances(std::span<const int>, std::size_t, std::size_t);

}  // namespace wale
