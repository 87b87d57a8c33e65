#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "compiler/expression/check_expression.hpp"

namespace wale {

/// Reads the settings of one record by their keys. At the end, `report_keys` reports those that nobody read and those
/// that were missed.
class RecordReader {
 public:
  RecordReader(const SyntaxTree& tree, const RecordDecl& record, const SourceSet& sources,
               const Declarations& declarations, Diagnostics& diagnostics);

  std::vector<const Setting*> settings(const std::string& key);                 ///< all with that key
  const Setting* setting(const std::string& key);                               ///< the only one with that key, or null
  const Setting* required(const std::string& key, const std::string& example);  ///< null is reported by `report_keys`
  /// Whether a required setting is missing, which is reported when all are read.
  bool lacks_some() const { return !missing_.empty(); }

  /// Item `index` of a setting as a quantity of the named dimension ("number" for a plain one), in SI.
  std::optional<double> quantity(const Setting& setting, std::size_t index, const std::string& dimension);
  /// The same for a required setting that must be greater than zero; 0 after an error, which is reported.
  double positive(const std::string& key, std::size_t index, const std::string& dimension, const std::string& example);
  std::string text(const std::string& key);  ///< empty if there is none
  /// The value in SI of an expression, which must have the dimension; otherwise nothing, and an error is reported.
  std::optional<double> value(ExprId expr, const Dimension& dimension);
  struct Quantity {
    double value = 0;
    Dimension dimension;
  };
  /// The value in SI of an expression of any dimension; empty if it is not known at compile time, which is reported.
  std::optional<Quantity> constant(ExprId expr);
  std::vector<std::string> texts(const Setting& setting);  ///< texts of a list; other items are reported

  void report(Code code, Span span, std::string message, Advice advice);
  /// Reports an error about the record as a whole; its settings are then not read.
  void reject(Code code, Span span, std::string message, Advice advice);
  /// Reports the settings that nobody read, then those that are required and missing. A misspelt setting is one error:
  /// what it is meant for is not missing.
  void report_keys();

  const SyntaxTree& tree;
  const RecordDecl& record;
  const SourceSet& sources;
  const Declarations& declarations;
  Diagnostics& diagnostics;

 private:
  std::set<const Setting*> read_;
  std::set<std::string> asked_;
  std::map<std::string, std::string> missing_;  ///< required settings that are not there, each with an example
  bool rejected_ = false;
};

/// The leading words of an item: "lateral amplitude" for `lateral amplitude 194 pu`.
std::string words_of(const SettingItem& item);
/// Whether a setting marks its figure as unknown: `damping unknown`.
bool is_unknown(const Setting& setting);
/// Whether an item contains a word, before or after its value.
bool has_word(const SettingItem& item, std::string_view word);
/// The advice for a name that is already declared, at `declared`.
Advice another_name(Span declared);

/// Reads `realise roughness = lateral(…), by minsky1995.figure19` and enters each by its percept.
void read_realisations(RecordReader& reader, const Declarations& declarations, const std::string& owner,
                       std::map<std::string, Realisation>& realise);

/// Reads `usb`, `axes` and `motors` of a device, and what `read_response` reads: which USB devices it describes, and the
/// directions and forces of its axes and motors.
void read_wiring(RecordReader& reader, const DeviceProfile& profile, DeviceWiring& wiring,
                 std::vector<FigureInterval>& intervals);

/// Reads `gain`, `dead_band`, `nonlinearity`, `saturation` and `offset` of a device, with the 95 % intervals of those
/// that were calibrated. Reports figures that no device has (W0305), and then reads none of the last four.
void read_response(RecordReader& reader, const DeviceProfile& profile, DeviceWiring& wiring,
                   std::vector<FigureInterval>& intervals);

/// Reads `within 0.94 .. 0.96`: the 95 % interval of the figure before it. An empty one is reported.
std::optional<std::pair<double, double>> read_within(RecordReader& reader, const SettingItem& item,
                                                     const std::string& dimension);

/// Each enters one record of its kind.
void declare_percept(RecordReader& reader, Declarations& declarations);
void declare_map(RecordReader& reader, Declarations& declarations);
void declare_threshold(RecordReader& reader, Declarations& declarations);
void declare_rule(RecordReader& reader, Declarations& declarations);
void declare_class(RecordReader& reader, Declarations& declarations);
void declare_device(RecordReader& reader, Declarations& declarations);
void declare_levels(RecordReader& reader, Declarations& declarations);
void declare_hand(RecordReader& reader, Declarations& declarations);

}  // namespace wale
