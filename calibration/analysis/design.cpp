#include "calibration/analysis/design.hpp"
#include "calibration/analysis/refusal.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace wale::analysis {
namespace {

using Eigen::Index;
using Eigen::VectorXd;
using Kind = Term::Kind;

/// Builds the columns of one model.
class DesignBuilder {
 public:
  explicit DesignBuilder(const Trials& trials) : trials_(trials) {}

  Result<Design> build(const std::vector<Term>& terms) {
    if (const auto sound = require_sound(terms); !sound) return sound.error();
    for (const Term& term : terms)
      if (const auto added = add(term); !added) return added.error();
    Design design;
    design.names = std::move(names_);
    design.columns.resize(static_cast<Index>(trials_.size()), static_cast<Index>(columns_.size()));
    for (std::size_t i = 0; i < columns_.size(); ++i) design.columns.col(static_cast<Index>(i)) = columns_[i];
    return design;
  }

 private:
  /// A model is the same in all units only if each product and power has its lower terms.
  static Result<> require_sound(const std::vector<Term>& terms) {
    if (terms.empty() || terms.front().kind != Kind::constant)
      return refusal(Code::not_measured, "the model has no constant",
                     "through the origin, a fit of logarithms depends on the units: begin with the constant");
    const auto has = [&](Kind kind, const std::string& name) {
      return std::ranges::any_of(terms, [&](const Term& each) {
        return each.kind == kind && (kind == Kind::factor ? each.factor : each.size) == name;
      });
    };
    const auto lacks = [](const std::string& of, const std::string& what) {
      return refusal(Code::not_measured, "the " + of + " stands without " + what + ", so the fit depends on the units",
                     "add " + what + " to the model");
    };
    for (const Term& each : terms) {
      if ((each.kind == Kind::squared || each.kind == Kind::bent) && !has(Kind::size, each.size))
        return lacks(each.kind == Kind::squared ? "square" : "bend", "the " + each.size + " itself");
      if (each.kind == Kind::product)
        for (const std::string& size : {each.size, each.other})
          if (!has(Kind::size, size)) return lacks("product", "the " + size + " itself");
      if (each.kind == Kind::size_by_factor) {
        if (!has(Kind::size, each.size)) return lacks("product", "the " + each.size + " itself");
        if (!has(Kind::factor, each.factor)) return lacks("product", "the " + each.factor + " itself");
      }
    }
    return {};
  }

  Result<const VectorXd*> log_of(const std::string& name) {
    if (const auto known = logs_.find(name); known != logs_.end()) return &known->second;
    const SizeValues* size = trials_.size_named(name);
    if (!size) return refusal(Code::malformed_value, "there is no size `" + name + "` in the trials", "read it as a size");
    VectorXd logs(static_cast<Index>(size->values.size()));
    for (std::size_t i = 0; i < size->values.size(); ++i) {
      if (!(size->values[i] > 0))
        return Error{.code = Code::malformed_value,
                     .sentence = "a " + name + " of zero or below has no logarithm",
                     .mend = "leave such trials out by rule",
                     .place = trials_.place(i)};
      logs(static_cast<Index>(i)) = std::log10(size->values[i]);
    }
    logs.array() -= logs.mean();
    return &logs_.emplace(name, std::move(logs)).first->second;
  }

  Result<const FactorValues*> factor(const std::string& name) const {
    if (const FactorValues* found = trials_.factor_named(name)) return found;
    return refusal(Code::malformed_value, "there is no factor `" + name + "` in the trials", "read it as a factor");
  }

  void add_column(std::string name, VectorXd column) {
    names_.push_back(std::move(name));
    columns_.push_back(std::move(column));
  }

  /// The columns of all levels but the first, each times `of`.
  void add_levels(const FactorValues& factor, const std::string& prefix, const VectorXd* of) {
    for (std::size_t level = 1; level < factor.levels.size(); ++level) {
      VectorXd column = VectorXd::Zero(static_cast<Index>(trials_.size()));
      for (std::size_t i = 0; i < trials_.size(); ++i)
        if (factor.values[i] == level) column(static_cast<Index>(i)) = of ? (*of)(static_cast<Index>(i)) : 1;
      add_column(prefix + factor.name + " " + factor.levels[level], std::move(column));
    }
  }

  Result<> add(const Term& term) {
    const auto n = static_cast<Index>(trials_.size());
    if (term.kind == Kind::constant) {
      add_column("constant", VectorXd::Ones(n));
      return {};
    }
    if (term.kind == Kind::stimulus) {
      for (std::size_t stimulus = 1; stimulus < trials_.stimuli; ++stimulus) {
        VectorXd column = VectorXd::Zero(n);
        for (std::size_t i = 0; i < trials_.size(); ++i)
          if (trials_.stimulus[i] == stimulus) column(static_cast<Index>(i)) = 1;
        add_column("stimulus " + std::to_string(stimulus + 1), std::move(column));
      }
      return {};
    }
    if (term.kind == Kind::factor || term.kind == Kind::size_by_factor) {
      const auto found = factor(term.factor);
      if (!found) return found.error();
      if (term.kind == Kind::factor) {
        add_levels(**found, "", nullptr);
        return {};
      }
      const auto logs = log_of(term.size);
      if (!logs) return logs.error();
      add_levels(**found, "log10 " + term.size + " x ", *logs);
      return {};
    }
    const auto logs = log_of(term.size);
    if (!logs) return logs.error();
    const VectorXd& x = **logs;
    switch (term.kind) {
      case Kind::size: add_column("log10 " + term.size, x); break;
      case Kind::squared: add_column("log10 " + term.size + " squared", x.cwiseProduct(x)); break;
      case Kind::bent: {
        const double knot = std::log10(term.knot) - mean_log(*trials_.size_named(term.size));
        add_column("log10 " + term.size + " above the knot", (x.array() - knot).max(0.0).matrix());
        break;
      }
      case Kind::product: {
        const auto other = log_of(term.other);
        if (!other) return other.error();
        add_column("log10 " + term.size + " x log10 " + term.other, x.cwiseProduct(**other));
        break;
      }
      case Kind::size_before: {
        VectorXd before = VectorXd::Zero(n);
        std::map<std::pair<std::uint32_t, std::uint32_t>, double> last;
        for (std::size_t i = 0; i < trials_.size(); ++i) {
          const auto [at, first] = last.try_emplace({trials_.observer[i], trials_.run[i]}, 0.0);
          if (!first) before(static_cast<Index>(i)) = at->second;
          at->second = x(static_cast<Index>(i));
        }
        add_column("log10 " + term.size + " of the trial before", std::move(before));
        break;
      }
      default: break;
    }
    return {};
  }

  const Trials& trials_;
  std::map<std::string, VectorXd> logs_;
  std::vector<std::string> names_;
  std::vector<VectorXd> columns_;
};

}  // namespace

double mean_log(const SizeValues& size) {
  double sum = 0;
  for (const double each : size.values) sum += std::log10(each);
  return sum / static_cast<double>(size.values.size());
}

Result<Design> design_of(const Trials& trials, const std::vector<Term>& terms) {
  return DesignBuilder(trials).build(terms);
}

}  // namespace wale::analysis
