#include "compiler/cpp/shared_arithmetic.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <set>
#include <string_view>

#include "compiler/text/embedded_files.hpp"
#include "schema/fnv1a.hpp"

namespace wale {
namespace {

/// Macros that are parameters of nothing: the text has NAME in place of its own name until its hash is known.
constexpr std::string_view unnamed = "WALE_ARITHMETIC_NAME";

void replace_all(std::string& text, std::string_view from, std::string_view to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
}

/// A file without what only a separate file needs.
std::string without_includes(std::string_view file) {
  std::string text;
  for (std::size_t at = 0; at < file.size();) {
    const std::size_t end = std::min(file.find('\n', at), file.size());
    const std::string_view line = file.substr(at, end - at);
    const bool stays =
        line.ends_with("intrin.h>") || !(line.starts_with("#pragma once") || line.starts_with("#include"));
    if (stays) text.append(line) += '\n';
    at = end + 1;
  }
  return text.erase(0, text.find_first_not_of('\n'));
}

/// The includes of <xmmintrin.h> stand outside of the namespaces, as all includes must.
std::string all_files() {
  std::string text;
  for (const EmbeddedFile& each : embedded_arithmetic()) text += without_includes(each.text) + "\n";
  replace_all(text, "namespace wale {", fmt::format("namespace {} {{", unnamed));
  replace_all(text, "namespace wale::arithmetic {", fmt::format("namespace {}::arithmetic {{", unnamed));
  replace_all(text, "  // namespace wale::arithmetic\n", "\n");
  replace_all(text, "  // namespace wale\n", "\n");
  return text;
}

SharedArithmetic make_shared_arithmetic() {
  const std::string files = all_files();
  const std::uint32_t hash = Fnv1a<std::uint32_t>().take_all(files).hash();
  SharedArithmetic shared{.name = fmt::format("WALE_ARITHMETIC_{:08x}", hash), .text = {}};
  std::string space = shared.name;
  std::ranges::transform(space, space.begin(),
                         [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
  shared.text = fmt::format(
      "#if !defined({0})\n#if defined(WALE_MACHINE_MODE)\n#define {0} {1}_in_machine_mode\n#else\n"
      "#define {0} {1}\n#endif\n\n{2}#endif  // {0}\n",
      shared.name, space, files);
  replace_all(shared.text, unnamed, shared.name);
  return shared;
}

}  // namespace

const SharedArithmetic& shared_arithmetic() {
  static const SharedArithmetic shared = make_shared_arithmetic();
  return shared;
}

std::string using_arithmetic() {
  std::set<std::string, std::less<>> names{"held_within", "lattice_coordinate", "ranked_value", "extent_of",
                                           "PatchExtent", "SplineTable",        "SplineSample", "GridShape",
                                           "GridSample",  "sample_of",          "recall_of",    "cell_at"};
  const auto add_words = [&](std::string_view meaning) {
    std::string word;
    for (const char c : std::string(meaning) + ' ') {
      if ((c >= 'a' && c <= 'z') || c == '_' || (c >= '0' && c <= '9')) {
        word += c;
      } else {
        if (c == '(' && !word.empty()) names.insert(word);
        word.clear();
      }
    }
  };
#define INSTRUCTION(number, name, fields, results, cost, meaning, ...) add_words(#meaning);
#include "wale/instruction.def"
  const std::string& space = shared_arithmetic().name;
  std::string text = fmt::format("namespace arithmetic = ::{}::arithmetic;\n", space);
  for (const char* name : {"sum", "difference", "product", "quotient"})
    text += fmt::format("using ::{}::arithmetic::{};\n", space, name);
  for (const std::string& name : names) text += fmt::format("using ::{}::{};\n", space, name);
  return text;
}

}  // namespace wale
