#pragma once

#include <map>
#include <set>
#include <string>
#include <unordered_set>
#include <vector>

#include "compiler/diagnostics/advice.hpp"
#include "compiler/solve/choose_map.hpp"
#include "compiler/solve/copy_terms.hpp"
#include "compiler/solve/law.hpp"
#include "compiler/solve/solve.hpp"

namespace wale {

/// Ties the percepts of one material to the carriers in its force, and solves those that are left open.
///
/// Carriers are independent, so each open size belongs to one percept. The system is triangular: the percepts that a
/// law couples are solved before it. If the forces together would exceed the device's, the percept that the author put
/// last is reduced first.
class PerceptSolver {
 public:
  PerceptSolver(const CheckedMaterial& material, const Declarations& declarations, const DeviceDeclaration& device,
                const BandShares& shares, Diagnostics& diagnostics)
      : material_(material), declarations_(declarations), device_(device), shares_(shares), diagnostics_(diagnostics) {}

  /// Matches the percepts asked for, except lost ones, with carriers and maps; errors are reported. Adds a parameter
  /// for each solved percept. `realised` are those that the device renders by its own rule, each with the rule's force
  /// as written.
  void plan(const Terms& terms, const std::vector<Carrier>& carriers, const std::array<TermId, 2>& force,
            const std::map<std::string, std::string>& realised, const std::map<std::string, std::string>& lost,
            std::vector<Parameter>& parameters);

  /// Whether an open quantity is solved, or an error about it has been reported.
  bool settled(std::uint32_t open) const { return settled_.contains(open); }

  /// Builds the size of every solved open quantity as setup expressions in `solved`; `copy` copies the author's terms
  /// there.
  std::map<std::uint32_t, TermId> sizes(SolvedMaterial& solved, TermCopier& copy);

  /// The outcome for a percept that was asked for and planned without an error.
  FateRecord fate(const AskedPercept& asked) const;

  /// Adds a record for every percept that a carrier tells of: first those asked for, in their order, then the others.
  void describe(SolvedMaterial& solved);

 private:
  static constexpr std::size_t none = ~std::size_t{0};

  /// A carrier in the force and the percept that it tells of.
  struct Told {
    const Percept* percept = nullptr;
    const AskedPercept* asked = nullptr;  ///< null if it was not asked for
    const Map* map = nullptr;
    std::size_t carrier = 0;
    std::optional<Law> law;  ///< the map's law, once it is needed
    bool solved = false;     ///< its size was open; otherwise the author fixed it
    std::uint32_t parameter =
        0;            ///< for a solved percept: its level; for a blended one: the first of its components' levels
    double size = 0;  ///< at the parameters' defaults, SI; not-a-number if it is not known
    std::vector<std::size_t> couples;  ///< for each of the map's couplings: its index in `told_`, or `none`
    std::size_t shares = none;         ///< index in `told_` of an earlier percept with the same carrier, or `none`
    std::optional<TermId> term;        ///< its size in the solved terms, once it is built
  };

  /// The percept as this device carries it. If only a share of its force counts, that exerts more.
  const Percept& percept(const std::string& name);
  void find_told_carriers();
  void find_summands();
  bool is_summand(const Carrier& carrier);
  bool is_whole(const Carrier& carrier);
  bool is_only_force(const Carrier& carrier);
  void match(const AskedPercept& asked);
  std::string chosen_by(const std::string& percept) const;  ///< the map that the device's rule names; may be empty
  const Map* map_for(const Percept& percept, const AskedPercept& asked);
  [[gnu::cold]] void report_choice(const Percept& percept, const AskedPercept& asked, const MapChoice& choice,
                                   const std::string& by);
  void solve_size(Told& told, std::vector<Parameter>& parameters);
  void add_level(const std::string& name, double level, const std::string& of, std::vector<Parameter>& parameters);
  TermId level_term(const Told& told, Terms& terms, TermCopier& copy) const;
  void tell(Told told);
  /// The force of a carrier of size 1; 0 if it exerts none or an earlier percept with the same carrier counts it.
  static double exertion(const Told& told) { return told.shares == none ? told.percept->exerts : 0; }
  void check_conflict(const Told& told);
  void mark_decalibrating(std::vector<Parameter>& parameters) const;
  std::set<std::uint32_t> parameters_of(TermId id, const std::array<TermId, 2>& beyond) const;
  bool is_made_of(TermId id, const std::array<TermId, 2>& parts) const;
  void couple();
  bool order_from(std::size_t index, std::vector<int>& state);
  void work_out_sizes();
  void warn_of_range(const Told& told);
  std::vector<std::size_t> by_priority() const;
  bool serves_out_of_order(const std::vector<std::size_t>& order) const;
  /// The position of each of `told_` in the order, counted from 0; also 0 for those that are not served.
  std::vector<double> turns(const std::vector<std::size_t>& order) const;
  /// Sets all sizes for percepts `served` so far, and returns the sum of their forces in the unit of the device's
  /// limit.
  double serve(const std::vector<std::size_t>& order, double served);
  TermId serve(const std::vector<std::size_t>& order, TermId served, SolvedMaterial& solved, TermCopier& copy);
  void serve_jointly(const std::vector<std::size_t>& order, SolvedMaterial& solved, TermCopier& copy);
  void reduce();
  void report_reduced(const Told& told, double used, const std::vector<std::string>& before);
  void reduce(SolvedMaterial& solved, TermCopier& copy);
  TermId asked_size(const Told& told, SolvedMaterial& solved, TermCopier& copy) const;
  bool may_exceed() const;
  /// The device's limit for all percepts together, in N or m/s^2. Where a pad shakes at one frequency, whatever its
  /// parameters, the limit is that at this frequency: the actuator gives less there than at its best. Several percepts
  /// shake together at the rate of the strongest.
  double most() const { return most_; }
  void find_most();
  /// That for one percept alone, at the parameters' defaults.
  double most(const Told& told) const;
  double most_at(const std::optional<double>& rate) const;
  double most_size(const Told& told) const;
  std::vector<double> coupled_sizes(const Told& told) const;
  Law::Sizes coupled_terms(const Told& told, SolvedMaterial& solved) const;
  PerceptRecord record(const Told& told);
  /// The carrier's size over the amplitude of its force.
  double band_share(const Told& told) const {
    const auto found = shares_.find(told.percept->name);
    return told.solved && found != shares_.end() ? found->second : 1;
  }
  std::string unit(const Percept& percept) const {
    return percept.extractor == Extractor::acceleration ? "m/s^2"
                                                        : declarations_.names().unit(percept.carrier_dimension);
  }
  void settle(const Carrier& carrier) {
    if (carrier.open) settled_.insert((*terms_)[carrier.size].index);
  }
  [[gnu::cold, gnu::noinline]] void report(Code code, Span span, std::string message, Advice advice) {
    diagnostics_.report(std::move(advice).about(code, span, std::move(message)));
  }

  const CheckedMaterial& material_;
  const Declarations& declarations_;
  const DeviceDeclaration& device_;
  const BandShares& shares_;
  Diagnostics& diagnostics_;
  const Terms* terms_ = nullptr;
  const std::vector<Carrier>* carriers_ = nullptr;
  std::array<TermId, 2> force_{};
  std::map<std::string, std::string> realised_;
  std::map<std::string, Percept> percepts_;  ///< as this device and this force carry them: see `percept`
  std::vector<std::size_t> candidates_;      ///< carriers that tell of a percept
  std::vector<Told> told_;
  std::vector<std::size_t> order_;  ///< indices into `told_`: coupled percepts before those that couple them
  double most_ = 0;
  std::set<std::uint32_t> settled_;
  std::unordered_set<std::uint64_t> summands_;  ///< the x and y terms of what the force adds up, once it is needed
  ParameterNames names_;                        ///< of the parameters
};

}  // namespace wale
