#pragma once

#include <optional>
#include <string>
#include <vector>

#include "compiler/command/command.hpp"

/// Each is a verb, or a way of one, and gives the exit status.
namespace wale::command {

int build(const Choice& choice, const std::string& out);

/// What a material is after one of the compiler's stages.
int show_stage(const Choice& choice, const std::string& name, const std::string& out);

/// Every material of a file to a program of its own; says of each what became of it.
int build_collection(const Choice& choice, const std::string& folder);

int describe(const Choice& choice, const std::vector<std::string>& settings, bool exports, bool json);

/// Lists the materials of the library in which every text occurs, of that kind where one is given; all without either.
int find(const std::vector<std::string>& texts, const std::string& kind, const std::vector<std::string>& folders,
         bool json);

/// Each of `names` is a file with all of its materials, or FILE:MATERIAL. `with_table` prints how far all are from each
/// other, however many they are.
int compare(const Choice& choice, const std::vector<std::string>& names, bool with_table, bool json);

/// Proposes levels of a percept that are told apart.
int levels(const std::string& percept, const std::string& device, std::optional<std::size_t> steps, double apart,
           bool json);

int preview(const Choice& choice, const std::vector<std::string>& settings, const std::string& out);

}  // namespace wale::command
