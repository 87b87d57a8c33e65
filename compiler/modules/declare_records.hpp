#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "compiler/expression/check_expression.hpp"

namespace wale {

/// Reads the settings of one record: each is read by its key, once; settings that were not read are reported at the
/// end.
class RecordReader {
 public:
  RecordReader(const SyntaxTree& tree, const RecordDecl& record, const SourceSet& sources,
               const Declarations& declarations, Diagnostics& diagnostics);

  std::vector<const Setting*> settings(const std::string& key);                 ///< all of that key
  const Setting* setting(const std::string& key);                               ///< the only one, or none
  const Setting* required(const std::string& key, const std::string& example);  ///< or none, reported

  /// Item `index` of a setting as a quantity of the named dimension ("number" for a plain one), in SI.
  std::optional<double> quantity(const Setting& setting, std::size_t index, const std::string& dimension);
  /// The same, of a setting that must be there and be greater than zero.
  double positive(const std::string& key, std::size_t index, const std::string& dimension, const std::string& example);
  std::string text(const std::string& key);  ///< empty when not written
  /// An expression's value in SI, of the dimension.
  std::optional<double> value(ExprId expr, const Dimension& dimension);
  struct Quantity {
    double value = 0;
    Dimension dimension;
  };
  /// An expression's value in SI, whatever its dimension; what is not known at compile time is reported.
  std::optional<Quantity> constant(ExprId expr);
  std::vector<std::string> texts(const Setting& setting);  ///< of a list in quotes; others are reported

  void report(Code code, Span span, std::string message, Advice advice);
  /// The same about the record as a whole, whose settings then are not read.
  void reject(Code code, Span span, std::string message, Advice advice);
  void report_unknown_settings();

  const SyntaxTree& tree;
  const RecordDecl& record;
  const SourceSet& sources;
  const Declarations& declarations;
  Diagnostics& diagnostics;

 private:
  std::set<const Setting*> read_;
  std::set<std::string> asked_;
  bool rejected_ = false;
};

/// "lateral amplitude" of `lateral amplitude 194 pu`.
std::string words_of(const SettingItem& item);
/// Whether a setting says that its figure is not known: `damping unknown`.
bool is_unknown(const Setting& setting);
/// Whether an item holds a word, before its value or behind it.
bool has_word(const SettingItem& item, std::string_view word);
/// The mend for a name that is declared already, at `declared`.
Advice another_name(Span declared);

/// `realise roughness = lateral(…), by minsky1995.figure19`: each entered by its percept.
void read_realisations(RecordReader& reader, const Declarations& declarations, const std::string& owner,
                       std::map<std::string, Realisation>& realise);

/// `usb`, `axes`, `motors` and `gain` of a device: which ones it is about, and how they lie on the desk.
void read_wiring(RecordReader& reader, const DeviceProfile& profile, DeviceWiring& wiring);

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
