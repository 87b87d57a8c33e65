#pragma once

#include <fmt/format.h>

#include <string>
#include <vector>

#include "compiler/parse/parse.hpp"
#include "compiler/parse/print_tree.hpp"

/// A text, its tree and its diagnostics.
struct Reading {
  wale::SourceSet sources;
  wale::Diagnostics diagnostics;
  wale::SyntaxTree tree;

  explicit Reading(std::string text) {
    tree = wale::parse(sources, sources.add("test.wale", std::move(text)), diagnostics);
  }

  std::string printed() const { return print_tree(tree); }

  /// Every error as "W0103 2:5 message".
  std::vector<std::string> errors() const {
    std::vector<std::string> result;
    for (const wale::Diagnostic& each : diagnostics.all()) {
      const wale::LineColumn place = sources.place(each.span);
      result.push_back(fmt::format("{} {}:{} {}", code_name(each.code), place.line, place.column, each.message));
    }
    return result;
  }
};

/// The tree of `let a = TEXT`, or its first error.
inline std::string expression(const std::string& text) {
  const Reading reading("wale 1\nlet a = " + text + "\n");
  if (reading.diagnostics.has_errors()) return reading.diagnostics.all().front().message;
  const auto* constant = std::get_if<wale::Constant>(&reading.tree.declarations.at(0));
  return constant == nullptr ? "not a constant" : print_expression(reading.tree, constant->value);
}

/// The tree of the statements of a physical section, or the first error.
inline std::string physical(const std::string& text) {
  const Reading reading("wale 1\nmaterial m { physical {\n" + text + "\n} }\n");
  if (reading.diagnostics.has_errors()) return reading.diagnostics.all().front().message;
  const std::string printed = reading.printed();
  const std::string head = "(material m\n  (physical\n    ";
  return printed.starts_with(head) ? printed.substr(head.size(), printed.size() - head.size() - 3) : printed;
}
