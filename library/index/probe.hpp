#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "compiler/compare/compare.hpp"
#include "compiler/solve/law.hpp"
#include "library/index/felt_columns.hpp"
#include "wale/result.hpp"

namespace wale {

/// Which values of a quantity a material can have that is not too far.
struct ValueLimit {
  double low = -std::numeric_limits<double>::infinity(), high = std::numeric_limits<double>::infinity();
  bool may_be_absent = true;

  void narrow(const SizeRange& range, bool absent_may);
};

/// Something that is sought by how it feels. Safe from any thread.
class Probe {
 public:
  virtual ~Probe() = default;

  /// How far a material is from what is sought; nothing if it is not sought at all. `scratch` is for the callee, one for
  /// each thread.
  virtual std::optional<DistanceInterval> distance(const FeltColumns& columns, std::size_t row,
                                                   Cues& scratch) const = 0;
  /// Narrows `limits`, by the number of the quantity, so that no material within them is left out whose rank is at most
  /// `most`.
  virtual void narrow(const FeltColumns& columns, double most, std::vector<ValueLimit>& limits) const = 0;

  /// For people: the distance, and what of it is unknown.
  struct Told {
    double low = 0;
    double high = 0;                   ///< infinite if nothing bounds it
    std::vector<std::string> unknown;  ///< the cues or percepts that widen it
    std::string plainest;              ///< the cue or percept that differs most; empty if none differs
  };
  virtual Told tell(const FeltColumns& columns, std::size_t row) const = 0;
};

/// Materials that feel like one whose cues are known, by the comparison's distance (compiler/compare). The comparer must
/// outlive it.
class NearProbe final : public Probe {
 public:
  NearProbe(const Comparer& comparer, const Cues& target);
  std::optional<DistanceInterval> distance(const FeltColumns& columns, std::size_t row, Cues& scratch) const override;
  void narrow(const FeltColumns& columns, double most, std::vector<ValueLimit>& limits) const override;
  Told tell(const FeltColumns& columns, std::size_t row) const override;

 private:
  const Comparer& comparer_;
  Cues target_;
};

/// Materials between two others: the farther of the two distances counts. What is not nearer to each of the two than
/// they are to one another is not between them.
class BetweenProbe final : public Probe {
 public:
  BetweenProbe(const Comparer& comparer, const Cues& one, const Cues& other);
  std::optional<DistanceInterval> distance(const FeltColumns& columns, std::size_t row, Cues& scratch) const override;
  void narrow(const FeltColumns& columns, double most, std::vector<ValueLimit>& limits) const override;
  Told tell(const FeltColumns& columns, std::size_t row) const override;
  const NearProbe& one() const { return one_; }
  const NearProbe& other() const { return other_; }

 private:
  NearProbe one_, other_;
  double apart_ = 0;
};

/// What both of two probes seek: the larger distance counts, and all that is unknown.
class BothProbe final : public Probe {
 public:
  BothProbe(std::unique_ptr<Probe> one, std::unique_ptr<Probe> other) : one_(std::move(one)), other_(std::move(other)) {}
  std::optional<DistanceInterval> distance(const FeltColumns& columns, std::size_t row, Cues& scratch) const override;
  void narrow(const FeltColumns& columns, double most, std::vector<ValueLimit>& limits) const override;
  Told tell(const FeltColumns& columns, std::size_t row) const override;

 private:
  std::unique_ptr<Probe> one_, other_;
};

/// A level that is sought, or a range of levels.
struct SoughtLevel {
  std::string percept;  ///< or the name of its reversed scale
  double low = 0, high = 0;  ///< 0 .. 1; equal: materials near this level; otherwise only those that read within
};

/// Materials by levels of percepts. The distance of a percept is that of its carriers' sizes, by the map for the device
/// and the threshold of its cue; a material that has nothing of a percept has the size 0, or, of a percept
/// that says so, an unknown one. Of several percepts the
/// largest distance counts.
class LevelProbe final : public Probe {
 public:
  /// `declarations` must outlive it. Error: W0201 for an unknown percept, or one without such a
  /// level on the device.
  static Result<std::unique_ptr<LevelProbe>> make(const std::vector<SoughtLevel>& levels, const Declarations& declarations,
                                                  const std::string& device);
  std::optional<DistanceInterval> distance(const FeltColumns& columns, std::size_t row, Cues& scratch) const override;
  void narrow(const FeltColumns& columns, double most, std::vector<ValueLimit>& limits) const override;
  Told tell(const FeltColumns& columns, std::size_t row) const override;

 private:
  struct Part {
    std::string percept;
    double low = 0, high = 0;  ///< on the percept's own scale
    double size = 0;           ///< of the carrier at that level, SI; of a range, not used
    double none = 0, full = 0;  ///< sizes at the levels 0 and 1
    bool absent_is_unknown = false;  ///< as `Percept` says
    std::string asked_as;            ///< the percept's name or its antonym
    Discrimination people;

    bool is_range() const { return low < high; }
  };
  /// Calls `visit(part, level, size)`: nothing of both if the material has nothing of it.
  template <typename Visit>
  void each_part(const FeltColumns& columns, std::size_t row, const Visit& visit) const;

  std::vector<Part> parts_;
};

}  // namespace wale
