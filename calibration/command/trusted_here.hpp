#pragma once

#include <string>
#include <vector>

#include "calibration/feel/trusted_declarations.hpp"

namespace CLI {
class App;
}

namespace wale::command {

/// --devices FILE, which may be repeated.
void offer_trusted_files(CLI::App& verb, std::vector<std::string>& files);

/// Where the person at this terminal keeps declarations of their own devices; empty where they have no home.
std::string owners_file();

/// Warns of what is not used: the owner's file if it has an error, and devices with the name of an earlier one.
void warn_of_unused(const TrustedDeclarations& trusted);

/// What this person trusts: the declarations in `files`, then those in their own file, then the shipped ones. An error
/// in their own file is in `owners_problem`.
Result<TrustedDeclarations> trusted_here(const std::vector<std::string>& files);

}  // namespace wale::command
