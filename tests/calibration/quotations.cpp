// Every figure of a map, a threshold or a rule that is graded measured or published stands in a passage that its record
// quotes, or is marked as assumed.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/parse/parse.hpp"
#include "tests/language/shipped.hpp"

namespace wale {
namespace {

/// A file, parsed.
struct ParsedRecords {
  SourceSet sources;
  Diagnostics diagnostics;
  SyntaxTree tree;

  explicit ParsedRecords(std::string text) {
    tree = parse(sources, sources.add("test.wale", std::move(text)), diagnostics);
  }
};

/// A number as it is written in a text, without its sign.
struct WrittenNumber {
  double value = 0;
  std::size_t begin = 0, end = 0;
};

bool is_letter_or_digit(char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; }
bool is_digit(char c) { return std::isdigit(static_cast<unsigned char>(c)); }

/// The numbers of a text: "0.76", ".6", "19%", "95,000"; not those within a name, as in `log10` and "Noise20".
std::vector<WrittenNumber> numbers_in(std::string_view text) {
  std::vector<WrittenNumber> found;
  for (std::size_t i = 0; i < text.size();) {
    const bool fraction = text[i] == '.' && i + 1 < text.size() && is_digit(text[i + 1]);
    if (!is_digit(text[i]) && !fraction) {
      // A name is skipped whole, so that its digits are not taken for a number.
      const bool name = is_letter_or_digit(text[i]);
      do ++i;
      while (name && i < text.size() && is_letter_or_digit(text[i]));
      continue;
    }
    std::string digits;
    const std::size_t begin = i;
    for (; i < text.size(); ++i) {
      const bool more = i + 1 < text.size() && is_digit(text[i + 1]);
      const bool thousands = text[i] == ',' && i + 3 < text.size() && std::all_of(&text[i + 1], &text[i + 4], is_digit);
      const bool point = text[i] == '.' && more && digits.find('.') == std::string::npos;
      if (is_digit(text[i]) || point)
        digits += text[i];
      else if (!thousands)
        break;
    }
    found.push_back({std::stod(digits), begin, i});
  }
  return found;
}

/// The numbers that a passage states, in digits or in words.
std::set<double> quoted_numbers(const std::string& passage) {
  static const std::map<std::string, double> words = {{"one", 1},   {"two", 2},     {"three", 3}, {"four", 4},
                                                      {"five", 5},  {"six", 6},     {"ten", 10},  {"eleven", 11},
                                                      {"seven", 7}, {"fifteen", 15}};
  std::set<double> found;
  for (const WrittenNumber& number : numbers_in(passage)) found.insert(number.value);
  std::string word;
  for (const char c : passage + " ") {
    if (std::isalpha(static_cast<unsigned char>(c))) {
      word += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    } else {
      if (const auto known = words.find(word); known != words.end()) found.insert(known->second);
      word.clear();
    }
  }
  return found;
}

/// The text of an item without its quoted texts.
std::string without_texts(std::string_view text) {
  std::string kept;
  bool inside = false;
  for (const char c : text) {
    if (c == '"') inside = !inside;
    if (!inside) kept += c;
  }
  return kept;
}

/// The figures of an item. `/ 1 N` only takes the unit away, and `(a + b) / 2` is the middle of two figures: neither
/// number is one.
std::vector<double> figures_of(std::string_view item) {
  const std::string text = without_texts(item);
  std::vector<double> figures;
  for (const WrittenNumber& number : numbers_in(text)) {
    const std::size_t before = text.find_last_not_of(' ', number.begin == 0 ? 0 : number.begin - 1);
    const bool divisor = number.begin > 0 && before != std::string::npos && text[before] == '/';
    const std::size_t divided = divisor && before > 0 ? text.find_last_not_of(' ', before - 1) : std::string::npos;
    const bool middle = number.value == 2 && divided != std::string::npos && text[divided] == ')';
    if (!(divisor && number.value == 1) && !middle) figures.push_back(number.value);
  }
  return figures;
}

/// The settings of each kind of record that hold figures from its source.
const std::map<std::string, std::set<std::string>> settings_with_figures = {
    {"map", {"law", "table", "valid", "scatter", "slope_error", "spread", "noise", "observers", "stimuli"}},
    {"threshold", {"weber", "criterion", "floor", "valid", "observers", "recognised"}},
    {"rule", {"case"}}};

/// What is wrong with the quotation of a record; empty if every figure stands in it.
std::vector<std::string> faults_of(const RecordDecl& record, const SyntaxTree& tree, const SourceSet& sources) {
  const auto kind = settings_with_figures.find(std::string(record.keyword.text));
  if (kind == settings_with_figures.end()) return {};
  bool published = false;
  std::string passage;
  for (const Setting& setting : record.settings) {
    const std::string text(sources.text(setting.span));
    // The grades of the slope and of a tied anchor are those of figures; the handle is a device.
    if (setting.key.text == "evidence")
      for (const char* grade : {"slope measured", "slope published", "anchor measured", "anchor published"})
        published = published || text.find(grade) != std::string::npos;
    // A rule has one grade.
    if (setting.key.text == "evidence" && kind->first == "rule")
      published = text.find("measured") != std::string::npos || text.find("published") != std::string::npos;
    if (setting.key.text == "quote")
      for (const SettingItem& item : setting.items)
        if (const auto* literal = std::get_if<TextLiteral>(&tree.expr(*item.value)))
          passage += std::string(literal->text) + " … ";
  }
  if (!published) return {};
  if (passage.empty()) return {"no quotation"};
  const std::set<double> quoted = quoted_numbers(passage);
  std::vector<std::string> faults;
  for (const Setting& setting : record.settings) {
    if (!kind->second.contains(std::string(setting.key.text))) continue;
    for (const SettingItem& item : setting.items) {
      const std::string text(sources.text(item.span));
      if (text.find("assumed") != std::string::npos) continue;
      for (const double figure : figures_of(text))
        if (!quoted.contains(figure)) faults.push_back(std::string(setting.key.text) + " " + text);
    }
  }
  return faults;
}

/// The faults of all records of a text, each after the record's name.
std::vector<std::string> faults_in(const std::string& text, std::size_t* records = nullptr) {
  const ParsedRecords parsed(text);
  EXPECT_FALSE(parsed.diagnostics.has_errors());
  std::vector<std::string> faults;
  for (const auto& declaration : parsed.tree.declarations)
    if (const auto* record = std::get_if<RecordDecl>(&declaration)) {
      if (records) *records += settings_with_figures.contains(std::string(record->keyword.text));
      for (const std::string& fault : faults_of(*record, parsed.tree, parsed.sources))
        faults.push_back(std::string(record->name.text) + ": " + fault);
    }
  return faults;
}

TEST(Quotations, HoldEveryFigureThatIsMeasuredOrPublished) {
  std::size_t records = 0;
  for (const auto& [name, text] : shipped_files()) {
    const auto faults = faults_in(text, &records);
    EXPECT_TRUE(faults.empty()) << name << ": " << (faults.empty() ? "" : faults.front());
  }
  EXPECT_GE(records, 30u) << "too few records were looked at";
}

std::string example_threshold(const std::string& settings) {
  return "wale 1\n\nthreshold push {\n  quantity force\n  task forced_choice\n" + settings +
         "\n  evidence slope published, handle transferred\n  on fingers\n  source \"an example\"\n}\n";
}

TEST(Quotations, MissNoFigureThatIsNotQuoted) {
  const std::string quote = "\n  quote \"a fraction of 19% from 2.5 to 10 N\", \"at 71% correct, in five subjects\"";
  const std::string rest = "\n  criterion 71 %\n  valid 2.5 N .. 10 N\n  observers 5";
  EXPECT_TRUE(faults_in(example_threshold("  weber 19 %" + rest + quote)).empty());
  EXPECT_EQ(faults_in(example_threshold("  weber 18 %" + rest + quote)).size(), 1u);
  EXPECT_EQ(faults_in(example_threshold("  weber 0.19" + rest + quote)).size(), 1u) << "in the quotation's own units";
  EXPECT_EQ(faults_in(example_threshold("  weber 19 %" + rest)).size(), 1u);
  EXPECT_EQ(faults_in(example_threshold("  weber 19 %\n  floor 0.1 N" + rest + quote)).size(), 1u);
  EXPECT_TRUE(faults_in(example_threshold("  weber 19 %\n  floor assumed 0.1 N" + rest + quote)).empty());
  EXPECT_EQ(faults_in(example_threshold("  weber 19 %\n  criterion 71 %\n  valid 2 N .. 12 N" + quote)).size(), 2u);
}

TEST(Quotations, NumbersAreThoseOfTheText) {
  const auto values = [](std::string_view text) {
    std::vector<double> found;
    for (const WrittenNumber& number : numbers_in(text)) found.push_back(number.value);
    return found;
  };
  EXPECT_EQ(values("log10 of Noise20 is -0.76, (.6) or 10-15%"), (std::vector<double>{0.76, 0.6, 10, 15}));
  EXPECT_EQ(values("10.3 to 95,000 centipoises, 2.5, 5"), (std::vector<double>{10.3, 95000, 2.5, 5}));
  EXPECT_EQ(quoted_numbers("Four of the fifteen"), (std::set<double>{4, 15}));
  EXPECT_EQ(figures_of("magnitude = (viscosity / 1 N s/m)^((0.42 + 0.46) / 2)"), (std::vector<double>{0.42, 0.46}));
}

}  // namespace
}  // namespace wale
